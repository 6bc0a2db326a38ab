// See accel.h.
#include "accel.h"

#include "accel_check.h"
#include "matrix.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace oxrt {

namespace {

OxrtMotionOptions normalForm(const OxrtMotionOptions& motion)
{
    return motion.numKeys > 1 ? motion : OxrtMotionOptions{1, 0, 0.0f, 0.0f};
}

std::span<const OxrtInstance> instancesOf(const OxrtBuildInput& input)
{
    if (!input.instances && input.numPrimitives != 0)
        fail(OXRT_ERROR_INVALID_VALUE, "input 0: instances is NULL but numPrimitives is %llu",
             static_cast<unsigned long long>(input.numPrimitives));
    checkAligned(input.instances, alignof(OxrtInstance), "input 0: instances");
    return {input.instances, input.numPrimitives};
}

} // namespace

std::shared_ptr<Accel> Accel::make(std::shared_ptr<Context> context, const OxrtAccelBuildOptions& options,
                                   std::span<const OxrtBuildInput> inputs)
{
    checkBuildOptions(options);
    checkBuildInputs(*context, inputs, normalForm(options.motion));
    auto accel = std::make_shared<Accel>(context, options);
    accel->build(inputs);
    context->addTraversable(accel->handle(), accel);
    return accel;
}

Accel::Accel(std::shared_ptr<Context> owner, const OxrtAccelBuildOptions& options)
    : context(std::move(owner)), buildFlags(options.buildFlags), motion(normalForm(options.motion))
{}

Accel::~Accel()
{
    invalidate();
    if (scene) context->embree.rtcReleaseScene(scene);
}

void Accel::invalidate()
{
    context->removeTraversable(view.handle);
    context->traversables.remove(view.handle);
    if (instances) instances->removeHandles(*context);
}

std::vector<OxrtInstance> Accel::instanceInputs(std::span<const OxrtTraversableHandle> children) const
{
    if (!children.empty() && children.size() != instances->size())
        fail(OXRT_ERROR_INVALID_VALUE, "%zu children for %u instances; give one for each, or none to keep them", children.size(),
             instances->size());
    std::vector<OxrtInstance> inputs(instances->size());
    for (std::uint32_t i = 0; i < instances->size(); ++i) {
        const OxrtInstanceView& made = instances->data()[i];
        std::copy_n(made.objectToWorld, 12, inputs[i].transform);
        inputs[i].instanceId = made.instanceId;
        inputs[i].sbtOffset = made.sbtOffset;
        inputs[i].visibilityMask = made.visibilityMask;
        inputs[i].flags = made.flags;
        inputs[i].traversable = !children.empty() ? children[i] : made.child ? made.child->handle : 0;
    }
    return inputs;
}

// What no update changes is shared, the rest built again from the copies of the inputs.
std::shared_ptr<Accel> Accel::copy(std::span<const OxrtTraversableHandle> children) const
{
    if (source && children.empty()) return source->copy({});
    if (view.type == OXRT_TRAVERSABLE_GAS && !children.empty())
        fail(OXRT_ERROR_INVALID_VALUE, "%zu children for a structure of geometry, which has none", children.size());
    auto made = std::make_shared<Accel>(context, OxrtAccelBuildOptions{buildFlags, motion});
    if (!updatable() && children.empty()) {
        made->share(shared_from_this());
    } else if (source) {
        return source->copy(children);
    } else if (instances) {
        const std::vector<OxrtInstance> kept = instanceInputs(children);
        OxrtBuildInput input = {};
        input.type = OXRT_BUILD_INPUT_INSTANCES;
        input.numSbtRecords = 1;
        input.instances = kept.data();
        input.numPrimitives = kept.size();
        made->build({&input, 1}, this);
    } else {
        made->copyGeometries(*this);
        made->makeScene();
    }
    context->addTraversable(made->handle(), made);
    return made;
}

void Accel::share(std::shared_ptr<const Accel> original)
{
    view = original->view;
    bounds = original->bounds;
    source = std::move(original);
    view.handle = context->traversables.add(&view);
}

void Accel::build(std::span<const OxrtBuildInput> inputs, const Accel* original)
{
    const auto begin = std::chrono::steady_clock::now();
    if (inputs[0].type == OXRT_BUILD_INPUT_INSTANCES)
        instances = std::make_unique<Instances>(*context, instancesOf(inputs[0]), motion,
                                                (buildFlags & OXRT_BUILD_FLAG_PREFER_FAST_BUILD) != 0,
                                                original ? original->instances.get() : nullptr);
    else
        buildGeometries(inputs);
    makeScene();

    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - begin;
    const OxrtAccelInfo made = info();
    context->log(4, "ACCEL",
                 formatText("%s of %llu %s built in %.2f ms, %.2f MiB", made.isGas ? "GAS" : "IAS",
                            static_cast<unsigned long long>(made.primitiveCount), made.isGas ? "primitives" : "instances", elapsed.count(),
                            static_cast<double>(made.memoryUsage) / (1 << 20)));
    if (instances && instances->singularCount() != 0)
        context->log(3, "ACCEL", formatText("%zu instances have a singular transform and are never hit", instances->singularCount()));
}

// Over the instances or geometries that are there, with handles.
void Accel::makeScene()
{
    const std::lock_guard lock(context->buildMutex);
    const std::int64_t bytesBefore = context->embreeBytes;
    setUpScene();
    commit();
    embreeBytes = context->embreeBytes - bytesBefore;

    if (instances) instances->addHandles(*context);
    view.handle = context->traversables.add(&view);
}

void Accel::copyGeometries(const Accel& original)
{
    for (const auto& geometry : original.geometries) geometries.push_back(std::make_unique<Geometry>(*geometry));
    geometryViews.resize(original.geometryViews.size());
}

void Accel::buildGeometries(std::span<const OxrtBuildInput> inputs)
{
    std::uint32_t recordBase = 0;
    for (const OxrtBuildInput& input : inputs) {
        geometries.push_back(std::make_unique<Geometry>(input, recordBase, geometryQuality()));
        recordBase += input.numSbtRecords;
    }
    std::size_t extras = 0;
    for (const auto& geometry : geometries) extras += geometry->hasExtra();
    geometryViews.resize(geometries.size() + extras); // never again: Embree keeps pointers to them
}

// Embree refits instead of building again where the scene's quality is low and the geometry's says so.
RTCBuildQuality Accel::geometryQuality() const
{
    if (updatable()) return RTC_BUILD_QUALITY_REFIT;
    return buildFlags & OXRT_BUILD_FLAG_PREFER_FAST_BUILD ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM;
}

void Accel::setUpScene()
{
    const EmbreeLibrary& embree = context->embree;
    scene = embree.rtcNewScene(context->device);
    if (!scene) context->checkEmbree("making a scene");
    unsigned flags = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
    if (!(buildFlags & OXRT_BUILD_FLAG_NOT_ROBUST)) flags |= RTC_SCENE_FLAG_ROBUST;
    RTCBuildQuality quality = RTC_BUILD_QUALITY_MEDIUM;
    if (buildFlags & OXRT_BUILD_FLAG_PREFER_FAST_TRACE) quality = RTC_BUILD_QUALITY_HIGH;
    if (isBuiltFast()) quality = RTC_BUILD_QUALITY_LOW;
    if (isRefitted()) flags |= RTC_SCENE_FLAG_DYNAMIC; // with low quality the only combination in which Embree does not build again
    embree.rtcSetSceneFlags(scene, static_cast<RTCSceneFlags>(flags));
    embree.rtcSetSceneBuildQuality(scene, quality);

    if (instances) instances->attach(embree, context->device, scene, geometryQuality());
    for (unsigned i = 0; i < geometries.size(); ++i)
        geometries[i]->attach(embree, context->device, scene, i, geometryViews[i]);
    auto extra = static_cast<unsigned>(geometries.size());
    for (unsigned i = 0; i < geometries.size(); ++i)
        if (geometries[i]->hasExtra()) {
            geometries[i]->attachExtra(embree, context->device, scene, i, extra, geometryViews[i], geometryViews[extra]);
            ++extra;
        }
}

void Accel::commit()
{
    const EmbreeLibrary& embree = context->embree;
    // On a device of one thread, where another device has built before, TBB would leave a worker that spins for ever.
    if (context->threads == 1)
        embree.rtcJoinCommitScene(scene);
    else
        embree.rtcCommitScene(scene);
    context->checkEmbree("building the accel");
    embree.rtcGetSceneBounds(scene, &bounds);
    describe();
}

// Embree never refits its own instances: it builds over them again, and quickly.
bool Accel::isRefitted() const
{
    return updatable() && !(instances && instances->isNative());
}

// With several boxes in a leaf, all of which Embree offers: kernels test those at rest.
bool Accel::isBuiltFast() const
{
    const bool holdsMovingBoxes = motion.numKeys > 1 && std::any_of(geometries.begin(), geometries.end(), [](const auto& one) {
        return (one->needs() & OXRT_SCENE_HAS_CUSTOM) != 0;
    });
    return isRefitted() || ((buildFlags & OXRT_BUILD_FLAG_PREFER_FAST_BUILD) && !holdsMovingBoxes);
}

// One over the mean area of some of the triangles, evenly spread over all; 0 without any.
static float densityOf(std::span<const OxrtGeometry> geometries)
{
    constexpr std::uint32_t samples = 4096;
    double area = 0.0;
    std::uint64_t count = 0;
    for (const OxrtGeometry& geometry : geometries) {
        if (geometry.primitiveType != OXRT_PRIMITIVE_TRIANGLE) continue;
        const std::uint32_t step = geometry.primitiveCount / samples + 1;
        for (std::uint32_t i = 0; i < geometry.primitiveCount; i += step) {
            const std::uint32_t* corners = geometry.indices + 3 * std::size_t(i);
            const auto at = [&](std::uint32_t vertex) { return geometry.vertices + 3 * std::size_t(vertex); };
            const float *a = at(corners[0]), *b = at(corners[1]), *c = at(corners[2]);
            const double u[3] = {double(b[0]) - a[0], double(b[1]) - a[1], double(b[2]) - a[2]};
            const double v[3] = {double(c[0]) - a[0], double(c[1]) - a[1], double(c[2]) - a[2]};
            const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
            area += 0.5 * std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
            count++;
        }
    }
    const double density = area > 0.0 ? static_cast<double>(count) / area : 0.0;
    return std::isfinite(density) ? static_cast<float>(density) : 0.0f;
}

void Accel::describe()
{
    view.scene = scene;
    view.needs = instances ? instances->needs() : motion.numKeys > 1 ? std::uint32_t(OXRT_SCENE_HAS_MOTION) : 0u;
    for (const auto& geometry : geometries) view.needs |= geometry->needs();
    view.type = instances ? OXRT_TRAVERSABLE_IAS : OXRT_TRAVERSABLE_GAS;
    view.geometries = geometryViews.data();
    view.geometryCount = static_cast<std::uint32_t>(geometries.size());
    const bool isLone = geometries.size() == 1 && geometryViews[0].primitiveCount == 1;
    for (OxrtGeometry& one : geometryViews) one.hasUntestedBoxes = one.keyCount == 1 && (isLone || isBuiltFast());
    view.keyCount = motion.numKeys;
    view.motionFlags = motion.flags;
    view.timeBegin = motion.timeBegin;
    view.timeEnd = motion.timeEnd;
    view.buildFlags = buildFlags;
    view.instances = instances ? instances->data() : nullptr;
    view.instanceTraversables = instances ? instances->traversables() : nullptr;
    view.instanceBoxes = instances ? instances->boxes() : nullptr;
    view.hasNativeInstances = instances && instances->isNative();
    view.graphDepth = instances ? instances->graphDepth() + 1 : 1;
    view.instanceCount = instances ? instances->size() : 0;
    view.triangleDensity = densityOf(geometryViews);
}

void Accel::checkSameShape(std::span<const OxrtBuildInput> inputs) const
{
    if (instances) {
        if (inputs[0].type != OXRT_BUILD_INPUT_INSTANCES || inputs[0].numPrimitives != instances->size())
            fail(OXRT_ERROR_INVALID_VALUE, "an update keeps the shape of the build, which had %u instances", instances->size());
        return;
    }
    if (inputs.size() != geometries.size())
        fail(OXRT_ERROR_INVALID_VALUE, "an update keeps the shape of the build, which had %zu inputs, not %zu", geometries.size(),
             inputs.size());
    for (unsigned i = 0; i < inputs.size(); ++i) {
        const OxrtBuildInput& input = inputs[i];
        const OxrtGeometry& built = geometries[i]->geometry();
        const std::uint64_t vertexCount = input.numPrimitives == 0                           ? 0
                                          : input.type == OXRT_BUILD_INPUT_CUSTOM_PRIMITIVES ? input.numPrimitives
                                                                                             : input.numVertices;
        if (input.type != geometries[i]->buildInputType() || input.numPrimitives != built.primitiveCount ||
            vertexCount != built.vertexCount || input.numSbtRecords != built.recordCount || std::max(1u, input.numKeys) != built.keyCount ||
            input.primitiveIndexOffset != built.primitiveIndexOffset)
            fail(OXRT_ERROR_INVALID_VALUE,
                 "input %u: an update keeps type, primitive, vertex, record and key counts of the build (%u primitives, %llu vertices, %u "
                 "records)",
                 i, built.primitiveCount, static_cast<unsigned long long>(built.vertexCount), built.recordCount);
        if (!(buildFlags & OXRT_BUILD_FLAG_ALLOW_OPACITY_MICROMAP_UPDATE) && !geometries[i]->hasSameMicromaps(input))
            fail(OXRT_ERROR_INVALID_VALUE, "input %u: an update with other opacity micromaps needs ALLOW_OPACITY_MICROMAP_UPDATE", i);
    }
}

void Accel::update(std::span<const OxrtBuildInput> inputs)
{
    if (!updatable()) fail(OXRT_ERROR_INVALID_VALUE, "the accel was built without ALLOW_UPDATE; build it with that flag to update it");
    checkBuildInputs(*context, inputs, motion);
    checkSameShape(inputs);

    context->beginChange("updating an accel");
    const struct EndChange {
        Context& context;
        ~EndChange() { context.endChange(); }
    } end{*context};
    const std::lock_guard lock(context->buildMutex);
    const std::int64_t bytesBefore = context->embreeBytes;
    if (instances) {
        instances->update(instancesOf(inputs[0]));
        instances->refit(context->embree, scene);
    }
    for (unsigned i = 0; i < geometries.size(); ++i) {
        geometries[i]->update(inputs[i]);
        geometries[i]->refit(context->embree, scene, i);
        geometryViews[i].opacityMicromaps = geometries[i]->geometry().opacityMicromaps;
        geometryViews[i].micromapStates = geometries[i]->geometry().micromapStates;
    }
    auto extra = static_cast<unsigned>(geometries.size());
    for (const auto& geometry : geometries)
        if (geometry->hasExtra()) geometry->refitExtra(context->embree, scene, extra++);
    commit();
    embreeBytes += context->embreeBytes - bytesBefore;
}

RTCBounds Accel::boundsDuring(float, float) const
{
    return isEmpty(bounds) ? emptyBounds() : bounds;
}

RTCBounds Accel::boundsAt(std::uint32_t key) const
{
    if (source) return source->boundsAt(key);
    if (instances) {
        if (motion.numKeys < 2) return boundsDuring(0, 0);
        const float fraction = static_cast<float>(key) / static_cast<float>(motion.numKeys - 1);
        return instances->boundsAt(motion.timeBegin + (motion.timeEnd - motion.timeBegin) * fraction);
    }
    RTCBounds all = emptyBounds();
    for (const auto& geometry : geometries) {
        const RTCBounds own = geometry->boundsAt(key);
        if (!isEmpty(own)) extend(all, own);
    }
    return all;
}

OxrtAccelInfo Accel::info() const
{
    constexpr float infinity = std::numeric_limits<float>::infinity();
    OxrtAccelInfo result = source ? source->info() : OxrtAccelInfo{};
    if (source) {
        result.handle = view.handle;
        return result;
    }
    result.handle = view.handle;
    const bool empty = !(bounds.lower_x <= bounds.upper_x);
    const float box[6] = {bounds.lower_x, bounds.lower_y, bounds.lower_z, bounds.upper_x, bounds.upper_y, bounds.upper_z};
    for (int i = 0; i < 6; ++i) result.aabb[i] = empty ? (i < 3 ? infinity : -infinity) : box[i];
    result.isGas = view.type == OXRT_TRAVERSABLE_GAS;
    result.needs = view.needs;
    result.hasNativeInstances = view.hasNativeInstances;
    result.memoryUsage = static_cast<std::uint64_t>(std::max<std::int64_t>(embreeBytes, 0)) + sizeof *this;
    result.primitiveCount = instances ? instances->size() : 0;
    if (instances) result.memoryUsage += instances->bytes();
    for (const auto& geometry : geometries) {
        result.primitiveCount += geometry->geometry().primitiveCount;
        result.memoryUsage += geometry->bytes() + sizeof(Geometry) + sizeof(OxrtGeometry);
    }
    return result;
}

} // namespace oxrt
