// One build input of a geometry acceleration structure: checked, copied, and given to Embree as the geometry with the input's number.
#pragma once

#include "array.h"
#include "embree_library.h"
#include "oxrt/oxrt.h"
#include "oxrt/pipeline.h"
#include "opacity.h"
#include "shape.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace oxrt {

// As OptiX does it: boxes that are inverted, NaN or a single point are never visited (empty bounds), infinite ones always.
RTCBounds boundsOfBox(const float* box);

class Geometry {
public:
    // Throws Failure for input that cannot be built; `number` is the input's place in the caller's list.
    static void check(const Context& context, const OxrtBuildInput& input, unsigned number);

    // `input` passed check().
    Geometry(const OxrtBuildInput& input, std::uint32_t recordBase, RTCBuildQuality quality);
    // With arrays of its own.
    Geometry(const Geometry& original);

    // `target` is what kernels see; it becomes the user pointer of the Embree geometry and must outlive it.
    void attach(const EmbreeLibrary& embree, RTCDevice device, RTCScene scene, unsigned geomID, OxrtGeometry& target) const;
    // A second Embree geometry for what the first cannot hold (the flat ends of curves); its number is no build input's.
    bool hasExtra() const { return shape && shape->extraCount() != 0; }
    void attachExtra(const EmbreeLibrary& embree, RTCDevice device, RTCScene scene, unsigned geomID, unsigned extraID,
                     const OxrtGeometry& target, OxrtGeometry& extra) const;

    // Other coordinates, flags and offsets; the shape is that of the construction.
    void update(const OxrtBuildInput& input);
    void refit(const EmbreeLibrary& embree, RTCScene scene, unsigned geomID) const;
    void refitExtra(const EmbreeLibrary& embree, RTCScene scene, unsigned extraID) const;

    bool hasSameMicromaps(const OxrtBuildInput& input) const { return micromaps.isSame(input); }

    const OxrtGeometry& geometry() const { return view; }
    std::uint32_t buildInputType() const { return inputType; }
    std::uint32_t needs() const;
    // Around all primitives at one motion key; empty if none can be hit.
    RTCBounds boundsAt(std::uint32_t key) const;
    std::size_t bytes() const;

private:
    void describe();
    void copyRecords(const OxrtBuildInput& input);
    void copyTriangles(const OxrtBuildInput& input);
    void copyBoxes(const OxrtBuildInput& input);
    bool anyHitPossible() const;
    void prepare(const EmbreeLibrary& embree, RTCGeometry geometry, const OxrtGeometry& target) const;
    RTCGeometry makeTriangles(const EmbreeLibrary& embree, RTCDevice device) const;
    RTCGeometry makeBoxes(const EmbreeLibrary& embree, RTCDevice device, OxrtGeometry& target) const;

    std::uint32_t inputType;
    RTCBuildQuality quality;
    OxrtGeometry view = {};
    Array<std::uint32_t> recordFlags;
    Array<std::uint32_t> recordOffsets;
    Array<float> vertices;
    Array<std::uint32_t> indices;
    Array<float> boxes; // see OxrtGeometry; the bounds callbacks enter them
    std::unique_ptr<Shape> shape; // spheres and curves
    Micromaps micromaps;
    bool indicesChanged = false; // by the last update
};

} // namespace oxrt
