// The instances of an instance acceleration structure: checked, resolved to their children, inverted, and given to Embree as native
// instances (one level).
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

class Accel;
class Context;

class Instances {
public:
    // Throws Failure for instances that cannot be built. Keeps the children alive.
    Instances(const Context& context, std::span<const OxrtInstance> instances);

    void attach(const EmbreeLibrary& embree, RTCDevice device, RTCScene scene, bool updatable) const;

    // Other transforms, ids, offsets, masks and flags of the same children.
    void update(std::span<const OxrtInstance> instances);
    void refit(const EmbreeLibrary& embree, RTCScene scene) const;

    // Gives each instance its handle, and takes them back.
    void addHandles(Context& context);
    void removeHandles(Context& context);

    const OxrtInstanceView* data() const { return views.data(); }
    std::uint32_t size() const { return static_cast<std::uint32_t>(views.size()); }
    std::uint32_t needs() const { return sceneNeeds; }
    std::size_t singularCount() const { return singular; }
    std::size_t bytes() const;

private:
    const Accel& child(const Context& context, std::uint64_t handle, std::size_t number);
    void describe(const OxrtInstance& instance, OxrtInstanceView& view);

    Array<OxrtInstanceView> views;
    Array<OxrtTraversableView> traversables; // what an instance's handle leads to
    Array<std::uint8_t> usable;              // 0: no child, or a transform that nothing survives
    std::vector<std::shared_ptr<const Accel>> children;
    std::uint32_t sceneNeeds = 0;
    std::size_t singular = 0;
};

} // namespace oxrt
