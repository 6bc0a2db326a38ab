// See instance.h.
#include "instance.h"

#include "accel.h"
#include "context.h"
#include "error.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace oxrt {

namespace {

constexpr std::size_t maxInstances = std::size_t(1) << 28;
constexpr std::uint32_t idLimit = 1u << 28;
constexpr std::uint32_t fullMask = 0xFF;

unsigned long long printable(std::size_t number)
{
    return number;
}

void checkInstance(const OxrtInstance& instance, std::size_t number)
{
    for (int i = 0; i < 12; ++i)
        if (!std::isfinite(instance.transform[i]))
            fail(OXRT_ERROR_INVALID_VALUE, "instance %llu: transform[%d][%d] is not finite", printable(number), i / 4, i % 4);
    if (instance.instanceId >= idLimit)
        fail(OXRT_ERROR_INVALID_VALUE, "instance %llu: instanceId %u does not fit 28 bits", printable(number), instance.instanceId);
    if (instance.sbtOffset >= idLimit)
        fail(OXRT_ERROR_INVALID_VALUE, "instance %llu: sbtOffset %u does not fit 28 bits", printable(number), instance.sbtOffset);
    if (instance.visibilityMask > fullMask)
        fail(OXRT_ERROR_INVALID_VALUE, "instance %llu: visibilityMask 0x%x does not fit 8 bits", printable(number),
             instance.visibilityMask);
}

// In double precision; false where no finite inverse exists.
bool invert(const float (&matrix)[12], float (&inverse)[12])
{
    const auto m = [&matrix](int row, int column) { return static_cast<double>(matrix[4 * row + column]); };
    double cofactors[9];
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
            const int r0 = (row + 1) % 3;
            const int r1 = (row + 2) % 3;
            const int c0 = (column + 1) % 3;
            const int c1 = (column + 2) % 3;
            cofactors[3 * row + column] = m(r0, c0) * m(r1, c1) - m(r0, c1) * m(r1, c0);
        }
    const double determinant = m(0, 0) * cofactors[0] + m(0, 1) * cofactors[1] + m(0, 2) * cofactors[2];
    bool finite = determinant != 0;
    for (int row = 0; row < 3; ++row) {
        double translation = 0;
        for (int column = 0; column < 3; ++column) {
            const double element = cofactors[3 * column + row] / determinant;
            inverse[4 * row + column] = static_cast<float>(element);
            translation -= element * m(column, 3);
        }
        inverse[4 * row + 3] = static_cast<float>(translation);
        for (int column = 0; column < 4; ++column) finite = finite && std::isfinite(inverse[4 * row + column]);
    }
    if (!finite) std::fill(std::begin(inverse), std::end(inverse), 0.0f);
    return finite;
}

} // namespace

Instances::Instances(const Context& context, std::span<const OxrtInstance> instances)
{
    if (instances.size() > maxInstances)
        fail(OXRT_ERROR_INVALID_VALUE, "%llu instances; an IAS holds at most 2^28", printable(instances.size()));
    for (std::size_t i = 0; i < instances.size(); ++i) checkInstance(instances[i], i);

    views = Array<OxrtInstanceView>(instances.size());
    traversables = Array<OxrtTraversableView>(instances.size());
    usable = Array<std::uint8_t>(instances.size());

    // Most scenes have many instances of few children.
    std::unordered_map<std::uint64_t, const Accel*> known;
    for (std::size_t i = 0; i < instances.size(); ++i) {
        const std::uint64_t handle = instances[i].traversable;
        if (handle != 0) { // a null child is allowed and never hit
            auto [entry, isNew] = known.try_emplace(handle, nullptr);
            if (isNew) entry->second = &child(context, handle, i);
            views[i].child = &entry->second->traversable();
        }
        describe(instances[i], views[i]);
    }
}

const Accel& Instances::child(const Context& context, std::uint64_t handle, std::size_t number)
{
    std::shared_ptr<const Accel> accel = context.findAccel(handle);
    if (!accel)
        fail(OXRT_ERROR_INVALID_VALUE,
             "instance %llu: traversable 0x%llx is not alive in this context (destroyed, never built, or of another context)",
             printable(number), static_cast<unsigned long long>(handle));
    if (accel->traversable().type != OXRT_TRAVERSABLE_GAS)
        fail(OXRT_ERROR_NOT_SUPPORTED, "instance %llu: its traversable is an IAS; this version instances geometry (GAS) only",
             printable(number));
    sceneNeeds |= accel->traversable().needs;
    children.push_back(std::move(accel));
    return *children.back();
}

void Instances::describe(const OxrtInstance& instance, OxrtInstanceView& view)
{
    const auto number = static_cast<std::size_t>(&view - views.data());
    std::copy_n(instance.transform, 12, view.objectToWorld);
    view.instanceId = instance.instanceId;
    view.sbtOffset = instance.sbtOffset;
    view.visibilityMask = instance.visibilityMask;
    view.flags = instance.flags;
    const bool invertible = invert(view.objectToWorld, view.worldToObject);
    usable[number] = invertible && view.child;
    singular += !invertible;
    if (instance.flags != 0) sceneNeeds |= OXRT_SCENE_HAS_INSTANCE_FLAGS;
    if (instance.visibilityMask != fullMask) sceneNeeds |= OXRT_SCENE_HAS_MASKS;
}

void Instances::attach(const EmbreeLibrary& embree, RTCDevice device, RTCScene scene, bool updatable) const
{
    for (std::uint32_t i = 0; i < size(); ++i) {
        if (!views[i].child || !views[i].child->scene) continue; // the number stays reserved
        const RTCGeometry geometry = embree.rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
        embree.rtcSetGeometryInstancedScene(geometry, static_cast<RTCScene>(views[i].child->scene));
        embree.rtcSetGeometryBuildQuality(geometry, updatable ? RTC_BUILD_QUALITY_REFIT : RTC_BUILD_QUALITY_MEDIUM);
        embree.rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, views[i].objectToWorld);
        embree.rtcSetGeometryMask(geometry, views[i].visibilityMask);
        embree.rtcCommitGeometry(geometry);
        embree.rtcAttachGeometryByID(scene, geometry, i);
        if (!usable[i]) embree.rtcDisableGeometry(geometry);
        embree.rtcReleaseGeometry(geometry);
    }
}

void Instances::update(std::span<const OxrtInstance> instances)
{
    for (std::size_t i = 0; i < instances.size(); ++i) {
        checkInstance(instances[i], i);
        const std::uint64_t handle = views[i].child ? views[i].child->handle : 0;
        if (instances[i].traversable != handle)
            fail(OXRT_ERROR_INVALID_VALUE, "instance %llu: an update keeps the traversables of the build; build a new accel instead",
                 printable(i));
    }
    sceneNeeds = 0;
    singular = 0;
    for (const auto& accel : children) sceneNeeds |= accel->traversable().needs;
    for (std::size_t i = 0; i < instances.size(); ++i) describe(instances[i], views[i]);
}

void Instances::refit(const EmbreeLibrary& embree, RTCScene scene) const
{
    for (std::uint32_t i = 0; i < size(); ++i) {
        if (!views[i].child || !views[i].child->scene) continue;
        const RTCGeometry geometry = embree.rtcGetGeometry(scene, i);
        embree.rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, views[i].objectToWorld);
        embree.rtcSetGeometryMask(geometry, views[i].visibilityMask);
        embree.rtcCommitGeometry(geometry);
        if (usable[i])
            embree.rtcEnableGeometry(geometry);
        else
            embree.rtcDisableGeometry(geometry);
    }
}

void Instances::addHandles(Context& context)
{
    for (std::uint32_t i = 0; i < size(); ++i) {
        OxrtTraversableView& view = traversables[i];
        view.type = OXRT_TRAVERSABLE_INSTANCE;
        view.instances = &views[i];
        view.instanceCount = 1;
        view.keyCount = 1;
        view.handle = context.traversables.add(&view);
        views[i].handle = view.handle;
    }
}

void Instances::removeHandles(Context& context)
{
    for (std::uint32_t i = 0; i < size(); ++i) context.traversables.remove(traversables[i].handle);
}

std::size_t Instances::bytes() const
{
    return views.bytes() + traversables.bytes() + usable.bytes();
}

} // namespace oxrt
