// See instance.h.
#include "instance.h"

#include "context.h"
#include "error.h"
#include "matrix.h"
#include "traversable.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

namespace oxrt {

namespace {

constexpr std::size_t maxInstances = std::size_t(1) << 28;
constexpr std::uint32_t idLimit = 1u << 28;
constexpr std::uint32_t fullMask = 0xFF;
// So many that the time of a build counts.
constexpr std::size_t manyInstances = 4096;

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

} // namespace

Instances::Instances(const Context& context, std::span<const OxrtInstance> instances, const OxrtMotionOptions& motionOptions,
                     bool prefersOwn, const Instances* original)
    : motion(motionOptions), mayBeNative(!prefersOwn || instances.size() < manyInstances)
{
    if (instances.size() > maxInstances)
        fail(OXRT_ERROR_INVALID_VALUE, "%llu instances; an IAS holds at most 2^28", printable(instances.size()));
    for (std::size_t i = 0; i < instances.size(); ++i) checkInstance(instances[i], i);

    views = Array<OxrtInstanceView>(instances.size());
    ownTraversables = Array<OxrtTraversableView>(instances.size());
    childNumbers = Array<std::uint32_t>(instances.size());
    usable = Array<std::uint8_t>(instances.size());

    // Most scenes have many instances of few children.
    std::unordered_map<std::uint64_t, std::uint32_t> known;
    for (std::size_t i = 0; i < instances.size(); ++i) {
        const std::uint64_t handle = instances[i].traversable;
        if (handle != 0) { // a null child is allowed and never hit
            auto [entry, isNew] = known.try_emplace(handle, 0);
            if (isNew) entry->second = addChild(context, handle, i, original);
            childNumbers[i] = entry->second;
            views[i].child = &children[entry->second].traversable->traversable();
        }
        describe(instances[i], views[i]);
    }
    gatherNeeds();
    if (graphDepth() >= maxGraphDepth)
        fail(OXRT_ERROR_INVALID_VALUE, "the graph would be %u traversables deep; the limit is %u", graphDepth() + 1, maxGraphDepth);
}

std::uint32_t Instances::addChild(const Context& context, std::uint64_t handle, std::size_t number, const Instances* original)
{
    std::shared_ptr<const Traversable> traversable = context.findTraversable(handle);
    if (original && !traversable)
        for (const Child& child : original->children)
            if (child.traversable->handle() == handle) traversable = child.traversable;
    if (!traversable)
        fail(OXRT_ERROR_INVALID_VALUE,
             "instance %llu: traversable 0x%llx is not alive in this context (destroyed, never built, an instance's handle, or of another "
             "context)",
             printable(number), static_cast<unsigned long long>(handle));
    children.push_back({std::move(traversable), {}});
    return static_cast<std::uint32_t>(children.size() - 1);
}

unsigned Instances::graphDepth() const
{
    unsigned deepest = 0;
    for (const Child& child : children) deepest = std::max(deepest, child.traversable->graphDepth());
    return deepest;
}

// Embree's own instances know one level, no vanishing, and one time for everything below. It builds again over them at every update, where
// it refits ours, and takes longer for the first build too; rays go through them more quickly.
void Instances::gatherNeeds()
{
    native = mayBeNative && (motion.numKeys < 2 || motion.flags == 0);
    for (const Child& child : children) {
        const OxrtTraversableView& view = child.traversable->traversable();
        sceneNeeds |= view.needs;
        native = native && view.type == OXRT_TRAVERSABLE_GAS && view.keyCount < 2;
    }
    if (!native) sceneNeeds |= OXRT_SCENE_MULTI_LEVEL;
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
    usable[number] = invertible && view.child && view.child->scene;
    singular += !invertible;
    if (instance.flags != 0) sceneNeeds |= OXRT_SCENE_HAS_INSTANCE_FLAGS;
    if (instance.visibilityMask != fullMask) sceneNeeds |= OXRT_SCENE_HAS_MASKS;
}

void Instances::attach(const EmbreeLibrary& embree, RTCDevice device, RTCScene scene, RTCBuildQuality quality)
{
    if (native)
        attachNative(embree, device, scene, quality);
    else if (size() != 0)
        attachOwn(embree, device, scene, quality);
}

void Instances::attachNative(const EmbreeLibrary& embree, RTCDevice device, RTCScene scene, RTCBuildQuality quality) const
{
    for (std::uint32_t i = 0; i < size(); ++i) {
        if (!views[i].child || !views[i].child->scene) continue; // the number stays reserved
        const RTCGeometry geometry = embree.rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
        embree.rtcSetGeometryInstancedScene(geometry, static_cast<RTCScene>(views[i].child->scene));
        embree.rtcSetGeometryBuildQuality(geometry, quality);
        embree.rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, views[i].objectToWorld);
        embree.rtcSetGeometryMask(geometry, views[i].visibilityMask);
        embree.rtcCommitGeometry(geometry);
        embree.rtcAttachGeometryByID(scene, geometry, i);
        if (!usable[i]) embree.rtcDisableGeometry(geometry);
        embree.rtcReleaseGeometry(geometry);
    }
}

// More keys than Embree takes only make the boxes of each step hold for longer.
unsigned Instances::timeSteps() const
{
    return std::min<unsigned>(motion.numKeys, RTC_MAX_TIME_STEP_COUNT);
}

// Boxes at time steps are blended between them, so each holds for the intervals on both sides; the first and last also for all time before
// and after, since the range of a structure does not stop what is below.
void Instances::boundChildren()
{
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const unsigned steps = timeSteps();
    const auto timeOf = [&](unsigned step) {
        return motion.timeBegin + (motion.timeEnd - motion.timeBegin) * static_cast<float>(step) / static_cast<float>(steps - 1);
    };
    for (Child& child : children) {
        child.bounds.clear();
        for (unsigned step = 0; step < steps; ++step)
            child.bounds.push_back(
                child.traversable->boundsDuring(step == 0 ? -infinity : timeOf(step - 1), step + 1 == steps ? infinity : timeOf(step + 1)));
    }
}

RTCBounds Instances::boundsOf(std::uint32_t number, unsigned step) const
{
    if (usable[number]) return imageOf(views[number].objectToWorld, children[childNumbers[number]].bounds[step]);
    // a refit brings back no primitive that the build dropped, so one that may be usable later keeps a place
    return keepsUnusable ? RTCBounds{} : emptyBounds();
}

// In their order, which is quicker than in that of Embree's structure.
void Instances::boundInstances()
{
    boundChildren();
    for (std::uint32_t i = 0; i < ownBoxes.size() / 6; ++i) storeBox(boundsOf(i, 0), ownBoxes.data() + 6 * std::size_t(i));
}

void Instances::boundInstance(const RTCBoundsFunctionArguments* arguments)
{
    const auto& self = *static_cast<const Instances*>(arguments->geometryUserPtr);
    if (self.ownBoxes.size() == 0) {
        *arguments->bounds_o = self.boundsOf(arguments->primID, arguments->timeStep);
    } else {
        const float* const box = self.ownBoxes.data() + 6 * std::size_t(arguments->primID);
        *arguments->bounds_o = {box[0], box[1], box[2], 0, box[3], box[4], box[5], 0};
    }
}

RTCBounds Instances::boundsAt(float time) const
{
    std::vector<RTCBounds> below;
    for (const Child& child : children) below.push_back(child.traversable->boundsDuring(time, time));
    RTCBounds all = emptyBounds();
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (!usable[i]) continue;
        const RTCBounds own = imageOf(views[i].objectToWorld, below[childNumbers[i]]);
        if (!isEmpty(own)) extend(all, own);
    }
    return all;
}

void Instances::attachOwn(const EmbreeLibrary& embree, RTCDevice device, RTCScene scene, RTCBuildQuality quality)
{
    keepsUnusable = quality == RTC_BUILD_QUALITY_REFIT;
    needsBoxes = quality != RTC_BUILD_QUALITY_MEDIUM; // otherwise Embree offers an instance only where its box is met
    if (timeSteps() == 1) ownBoxes = Array<float>(6 * std::size_t(size()));
    boundInstances();
    const RTCGeometry geometry = embree.rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    embree.rtcSetGeometryUserPrimitiveCount(geometry, size());
    embree.rtcSetGeometryTimeStepCount(geometry, timeSteps());
    embree.rtcSetGeometryUserData(geometry, this);
    embree.rtcSetGeometryMask(geometry, ~0u); // kernels look at the mask of each instance
    embree.rtcSetGeometryBuildQuality(geometry, quality);
    embree.rtcSetGeometryBoundsFunction(geometry, boundInstance, this);
    embree.rtcSetGeometryIntersectFunction(geometry, [](const RTCIntersectFunctionNArguments*) {}); // kernels bring their own
    embree.rtcSetGeometryOccludedFunction(geometry, [](const RTCOccludedFunctionNArguments*) {});
    embree.rtcCommitGeometry(geometry);
    embree.rtcAttachGeometryByID(scene, geometry, 0);
    embree.rtcReleaseGeometry(geometry);
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
    for (std::size_t i = 0; i < instances.size(); ++i) describe(instances[i], views[i]);
    gatherNeeds();
}

void Instances::refit(const EmbreeLibrary& embree, RTCScene scene)
{
    if (!native && size() != 0) {
        boundInstances();
        embree.rtcCommitGeometry(embree.rtcGetGeometry(scene, 0));
    }
    for (std::uint32_t i = 0; native && i < size(); ++i) {
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
        OxrtTraversableView& view = ownTraversables[i];
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
    for (std::uint32_t i = 0; i < size(); ++i) context.traversables.remove(ownTraversables[i].handle);
}

std::size_t Instances::bytes() const
{
    return views.bytes() + ownTraversables.bytes() + ownBoxes.bytes() + childNumbers.bytes() + usable.bytes();
}

} // namespace oxrt
