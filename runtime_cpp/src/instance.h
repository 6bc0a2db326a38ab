// The instances of an instance acceleration structure: checked, resolved to their children, inverted, and given to Embree. Above static
// geometry they are Embree's own instances (one level); above anything else one user geometry with a primitive for each instance, which
// kernels walk through themselves.
#pragma once

#include "array.h"
#include "embree_library.h"
#include "oxrt/oxrt.h"
#include "oxrt/pipeline.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace oxrt {

class Traversable;
class Context;

class Instances {
public:
    // Throws Failure for instances that cannot be built. Keeps the children alive.
    // `prefersOwn`: the build and its updates are to be quick, which makes them our own where there are many.
    // `original`: whose children may be named as well when their handles are stale.
    Instances(const Context& context, std::span<const OxrtInstance> instances, const OxrtMotionOptions& motion, bool prefersOwn,
              const Instances* original = nullptr);

    void attach(const EmbreeLibrary& embree, RTCDevice device, RTCScene scene, RTCBuildQuality quality);

    // Other transforms, ids, offsets, masks and flags of the same children.
    void update(std::span<const OxrtInstance> instances);
    void refit(const EmbreeLibrary& embree, RTCScene scene);

    // Gives each instance its handle, and takes them back.
    void addHandles(Context& context);
    void removeHandles(Context& context);

    const OxrtInstanceView* data() const { return views.data(); }
    const OxrtTraversableView* traversables() const { return ownTraversables.data(); }
    std::uint32_t size() const { return static_cast<std::uint32_t>(views.size()); }
    std::uint32_t needs() const { return sceneNeeds; }
    bool isNative() const { return native; }
    // What kernels look at before they enter an instance; null where Embree has done so.
    const float* boxes() const { return needsBoxes ? ownBoxes.data() : nullptr; }
    unsigned graphDepth() const; // of the deepest child
    std::size_t singularCount() const { return singular; }
    std::size_t bytes() const;
    // Around all instances at one time.
    RTCBounds boundsAt(float time) const;

private:
    struct Child {
        std::shared_ptr<const Traversable> traversable;
        std::vector<RTCBounds> bounds; // one for each time step of the user geometry
    };

    std::uint32_t addChild(const Context& context, std::uint64_t handle, std::size_t number, const Instances* original);
    void describe(const OxrtInstance& instance, OxrtInstanceView& view);
    void gatherNeeds();
    void boundChildren();
    void boundInstances();
    RTCBounds boundsOf(std::uint32_t number, unsigned step) const;
    static void boundInstance(const RTCBoundsFunctionArguments* arguments);
    void attachNative(const EmbreeLibrary& embree, RTCDevice device, RTCScene scene, RTCBuildQuality quality) const;
    void attachOwn(const EmbreeLibrary& embree, RTCDevice device, RTCScene scene, RTCBuildQuality quality);
    unsigned timeSteps() const;

    Array<OxrtInstanceView> views;
    Array<OxrtTraversableView> ownTraversables; // what an instance's handle leads to
    Array<std::uint32_t> childNumbers;          // of each instance
    Array<std::uint8_t> usable;                 // 0: no child, or a transform that nothing survives
    Array<float> ownBoxes;                      // 6 floats for each of ours that does not move by itself
    std::vector<Child> children;
    const OxrtMotionOptions motion;
    const bool mayBeNative;
    bool native = true;
    bool keepsUnusable = false;
    bool needsBoxes = false;
    std::uint32_t sceneNeeds = 0;
    std::size_t singular = 0;
};

} // namespace oxrt
