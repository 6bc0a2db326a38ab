// See transform.h.
#include "transform.h"

#include "context.h"
#include "matrix.h"
#include "motion.h"
#include "objects.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace oxrt {

namespace {

constexpr std::size_t matrixFloats = 12;
constexpr std::size_t srtFloats = 16;
constexpr std::size_t firstOfQuaternion = 9;

std::size_t floatsPerKey(const OxrtTransformOptions& options)
{
    return options.type == OXRT_TRANSFORM_SRT_MOTION ? srtFloats : matrixFloats;
}

std::size_t keyCount(const OxrtTransformOptions& options)
{
    return options.type == OXRT_TRANSFORM_STATIC ? 1 : options.motion.numKeys;
}

void checkKeys(const OxrtTransformOptions& options)
{
    if (!options.keys) fail(OXRT_ERROR_INVALID_VALUE, "keys is NULL");
    checkAligned(options.keys, alignof(float), "keys");
    const std::size_t floats = floatsPerKey(options);
    for (std::size_t key = 0; key < keyCount(options); ++key) {
        const float* values = options.keys + floats * key;
        for (std::size_t i = 0; i < floats; ++i)
            if (!std::isfinite(values[i])) fail(OXRT_ERROR_INVALID_VALUE, "key %zu: number %zu is not finite", key, i);
        if (options.type != OXRT_TRANSFORM_SRT_MOTION) continue;
        const float* q = values + firstOfQuaternion;
        if (q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0)
            fail(OXRT_ERROR_INVALID_VALUE, "key %zu: the quaternion has length zero; no rotation is (0, 0, 0, 1)", key);
        // Kernels normalise in binary32.
        if (!std::isnormal(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]))
            fail(OXRT_ERROR_INVALID_VALUE, "key %zu: the squared length of the quaternion is no number of binary32; normalise it", key);
    }
}

void checkOptions(const OxrtTransformOptions& options)
{
    switch (options.type) {
    case OXRT_TRANSFORM_STATIC: break;
    case OXRT_TRANSFORM_MATRIX_MOTION:
    case OXRT_TRANSFORM_SRT_MOTION: checkTransformMotion(options.motion); break;
    default: fail(OXRT_ERROR_INVALID_VALUE, "type is %u, which is no transform; give OXRT_TRANSFORM_...", options.type);
    }
    checkKeys(options);
}

std::uint32_t viewType(std::uint32_t type)
{
    return type == OXRT_TRANSFORM_STATIC          ? OXRT_TRAVERSABLE_STATIC
           : type == OXRT_TRANSFORM_MATRIX_MOTION ? OXRT_TRAVERSABLE_MATRIX_MOTION
                                                  : OXRT_TRAVERSABLE_SRT_MOTION;
}

} // namespace

std::shared_ptr<Transform> Transform::make(std::shared_ptr<Context> context, const OxrtTransformOptions& options)
{
    checkOptions(options);
    std::shared_ptr<const Traversable> below = context->findTraversable(options.child);
    if (!below)
        fail(OXRT_ERROR_INVALID_VALUE,
             "child 0x%llx is not a traversable that is alive in this context (destroyed, an instance's handle, or of another context)",
             static_cast<unsigned long long>(options.child));
    if (below->graphDepth() >= maxGraphDepth)
        fail(OXRT_ERROR_INVALID_VALUE, "the graph would be %u traversables deep; the limit is %u", below->graphDepth() + 1, maxGraphDepth);
    auto transform = std::make_shared<Transform>(context, options, std::move(below));
    transform->view.handle = context->traversables.add(&transform->view);
    context->addTraversable(transform->handle(), transform);
    return transform;
}

Transform::Transform(std::shared_ptr<Context> owner, const OxrtTransformOptions& options, std::shared_ptr<const Traversable> below)
    : context(std::move(owner)), motion(options.motion), child(std::move(below))
{
    const std::size_t floats = floatsPerKey(options) * keyCount(options);
    const bool isStatic = options.type == OXRT_TRANSFORM_STATIC;
    keys = Array<float>(isStatic ? 2 * matrixFloats : floats);
    std::copy_n(options.keys, floats, keys.data());
    bool usable = true;
    if (isStatic) {
        float matrix[matrixFloats];
        float inverse[matrixFloats];
        std::copy_n(options.keys, matrixFloats, matrix);
        usable = invert(matrix, inverse);
        std::copy_n(inverse, matrixFloats, keys.data() + matrixFloats);
    }
    view.graphDepth = child->graphDepth() + 1;
    view.type = viewType(options.type);
    view.needs = child->traversable().needs | OXRT_SCENE_MULTI_LEVEL | (isStatic ? 0u : std::uint32_t(OXRT_SCENE_HAS_MOTION));
    view.child = &child->traversable();
    view.scene = usable ? view.child->scene : nullptr;
    view.transformKeys = keys.data();
    view.keyCount = static_cast<std::uint32_t>(keyCount(options));
    if (isStatic) return;
    view.motionFlags = motion.flags;
    view.timeBegin = motion.timeBegin;
    view.timeEnd = motion.timeEnd;
}

Transform::~Transform()
{
    invalidate();
}

void Transform::invalidate()
{
    context->removeTraversable(view.handle);
    context->traversables.remove(view.handle);
}

RTCBounds Transform::boundsDuring(float begin, float end) const
{
    const RTCBounds below = child->boundsDuring(begin, end);
    if (isEmpty(below) || !view.scene) return emptyBounds();
    if (view.type == OXRT_TRAVERSABLE_STATIC) return imageOf(keys.data(), below);
    const double from = keyPosition(motion, begin);
    const double to = keyPosition(motion, end);
    return view.type == OXRT_TRAVERSABLE_MATRIX_MOTION ? sweptByMatrices(keys.data(), from, to, below)
                                                       : sweptBySrt(keys.data(), from, to, below);
}

} // namespace oxrt

using namespace oxrt;

OxrtResult oxrtTransformCreate(OxrtContext context, const OxrtTransformOptions* options, OxrtTransform* transform)
{
    return guard([&] {
        const auto owner = find(context);
        owner->attempt("ACCEL", [&] {
            if (!transform) fail(OXRT_ERROR_INVALID_VALUE, "the result pointer `transform` is NULL");
            *transform = nullptr;
            if (!options) fail(OXRT_ERROR_INVALID_VALUE, "options is NULL");
            *transform = publish(Transform::make(owner, *options));
        });
    });
}

OxrtResult oxrtTransformGetHandle(OxrtTransform transform, OxrtTraversableHandle* handle)
{
    return guard([&] {
        const auto self = find(transform);
        if (!handle) fail(OXRT_ERROR_INVALID_VALUE, "the result pointer `handle` is NULL");
        *handle = self->handle();
    });
}

OxrtResult oxrtTransformDestroy(OxrtTransform transform)
{
    return guard([&] {
        std::shared_ptr<Transform> self = withdraw(transform);
        self->invalidate();
        const std::shared_ptr<Context> context = self->context;
        context->retire(std::move(self));
    });
}
