// An acceleration structure: copies of the build inputs, the Embree scene over them, and the view of both that kernels read.
#pragma once

#include "context.h"
#include "geometry.h"
#include "instance.h"
#include "oxrt/embree.h"
#include "oxrt/oxrt.h"
#include "oxrt/pipeline.h"
#include "traversable.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace oxrt {

class Accel final : public Traversable, public std::enable_shared_from_this<Accel> {
public:
    // Throws Failure and leaves nothing behind.
    static std::shared_ptr<Accel> make(std::shared_ptr<Context> context, const OxrtAccelBuildOptions& options,
                                       std::span<const OxrtBuildInput> inputs);
    // Use make(): this only prepares.
    Accel(std::shared_ptr<Context> owner, const OxrtAccelBuildOptions& options);
    ~Accel() override;

    // Hit like this one, under another handle. An IAS gets `children`, one for each instance, unless there are none.
    std::shared_ptr<Accel> copy(std::span<const OxrtTraversableHandle> children) const;
    bool mayCompact() const { return (buildFlags & OXRT_BUILD_FLAG_ALLOW_COMPACTION) != 0; }

    void update(std::span<const OxrtBuildInput> inputs);
    // Makes the handles stale; may be called again.
    void invalidate();

    OxrtAccelInfo info() const;
    RTCBounds boundsDuring(float begin, float end) const override;
    // At one motion key.
    RTCBounds boundsAt(std::uint32_t key) const;
    std::uint32_t keyCount() const { return motion.numKeys; }

    const std::shared_ptr<Context> context;

private:
    void build(std::span<const OxrtBuildInput> inputs, const Accel* original = nullptr);
    void copyGeometries(const Accel& original);
    void makeScene();
    void share(std::shared_ptr<const Accel> original);
    std::vector<OxrtInstance> instanceInputs(std::span<const OxrtTraversableHandle> children) const;
    void buildGeometries(std::span<const OxrtBuildInput> inputs);
    void describe();
    void checkSameShape(std::span<const OxrtBuildInput> inputs) const;
    RTCBuildQuality geometryQuality() const;
    void setUpScene();
    void commit();
    bool updatable() const { return (buildFlags & OXRT_BUILD_FLAG_ALLOW_UPDATE) != 0; }
    bool isRefitted() const;
    bool isBuiltFast() const;

    const std::uint32_t buildFlags;
    const OxrtMotionOptions motion; // numKeys 1 if static
    std::vector<std::unique_ptr<Geometry>> geometries;
    std::vector<OxrtGeometry> geometryViews;
    std::unique_ptr<Instances> instances;
    std::shared_ptr<const Accel> source; // whose structure this one shares
    RTCScene scene = nullptr;
    RTCBounds bounds = {};
    std::int64_t embreeBytes = 0;
};

} // namespace oxrt
