// What a build input of spheres or curves keeps, and the Embree geometries that stand for it.
#pragma once

#include "embree_library.h"
#include "oxrt/oxrt.h"
#include "oxrt/pipeline.h"

#include <cstddef>
#include <cstdint>
#include <memory>

namespace oxrt {

class Shape {
public:
    Shape() = default;
    virtual ~Shape() = default;

    virtual std::unique_ptr<Shape> clone() const = 0;
    // Copies the coordinates of the input: at the construction, and again at updates with input of the same shape.
    virtual void copy(const OxrtBuildInput& input) = 0;
    // Enters what kernels read.
    virtual void describe(OxrtGeometry& view) const = 0;
    // An Embree geometry with its buffers and callbacks, not committed. `view` is the geometry's user pointer.
    virtual RTCGeometry make(const EmbreeLibrary& embree, RTCDevice device, OxrtGeometry& view) = 0;
    // Tells Embree that the coordinates have changed.
    virtual void refit(const EmbreeLibrary& embree, RTCGeometry geometry) const = 0;
    virtual std::size_t bytes() const = 0;
    // Whether it is user geometry, which the runtime intersects by itself.
    virtual bool isOwn() const { return false; }
    // A box around one primitive at one motion key.
    virtual RTCBounds boundsAt(const OxrtGeometry& view, std::uint32_t primitive, std::uint32_t key) const = 0;

    // Primitives that Embree does not know as part of the first geometry: flat ends of curves. They report the first geometry's number.
    virtual std::uint32_t extraCount() const { return 0; }
    virtual RTCGeometry makeExtra(const EmbreeLibrary&, RTCDevice, unsigned /* geomID */, const OxrtGeometry&, OxrtGeometry& /* extra */)
    {
        return nullptr;
    }
};

// Throw Failure for input that cannot be built.
void checkSpheres(const OxrtBuildInput& input, unsigned number);
void checkCurves(const OxrtBuildInput& input, unsigned number);
// One array per motion key.
void checkKeys(const float* const* keys, const OxrtBuildInput& input, unsigned number, const char* name);

// `input` passed the check of its type.
std::unique_ptr<Shape> makeSpheres(const OxrtBuildInput& input);
std::unique_ptr<Shape> makeCurves(const OxrtBuildInput& input);
std::unique_ptr<Shape> makeRoundedCurves(const OxrtBuildInput& input);
std::unique_ptr<Shape> makeRibbons(const OxrtBuildInput& input);

// Geometry filter: drops candidates that the ray leaves through instead of entering.
void dropBackFaces(const RTCFilterFunctionNArguments* arguments);
void setFilter(const EmbreeLibrary& embree, RTCGeometry geometry, RTCFilterFunctionN filter);

} // namespace oxrt
