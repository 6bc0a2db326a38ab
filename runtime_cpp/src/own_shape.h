// Primitives that the runtime intersects by itself, as Embree's user geometry: the frame around an intersector of one ray.
#pragma once

#include "curve_basis.h"
#include "oxrt/device_box.h"
#include "oxrt/embree.h"
#include "oxrt/pipeline.h"

#include <cstddef>
#include <cstdint>

namespace oxrt {

// One lane of Embree's packet; a packet of 1 is a single ray.
struct LaneRay {
    Point4 origin, direction;
    float tnear, tfar, time;
};

struct LaneHit {
    float t, u, v;
    Point4 normal;
    unsigned geometry, primitive;
};

// As in OxrtOwnShape; null accepts everything.
using OwnFilter = void (*)(const void* filterArguments);

// Where hits of one lane go: through the filters, and if they accept into the ray.
class LaneHits {
public:
    LaneHits(const RTCIntersectFunctionNArguments& callback, unsigned lane, OwnFilter filter);
    LaneHits(const RTCOccludedFunctionNArguments& callback, unsigned lane, OwnFilter filter);
    // False if the ray misses the primitive's box.
    bool mayMeet(const OxrtGeometry& view, unsigned primitive) const
    {
        if (!view.boxes) return true;
        const float* const box = view.boxes + 6 * std::size_t(primitive);
        return meetsBox(quadAt(&ray.origin.x), quadAt(&ray.direction.x), box, ray.tnear, ray.tfar);
    }
    // True while the ray goes on. Hits outside of the ray's interval are dropped.
    bool offer(const LaneHit& hit);

    LaneRay ray;

private:
    void readRay();
    float& field(unsigned number) { return rays[number * width + lane]; }

    const OwnFilter judge;
    const bool isOcclusion;
    float* const rays;
    const unsigned width;
    const unsigned lane;
    void* const userPointer;
    RTCRayQueryContext* const context;
};

// The position between the motion keys of a time in [0, 1].
struct KeyPosition {
    std::uint32_t key;
    float fraction;
};
KeyPosition keyPosition(std::uint32_t keyCount, float time);

// F(view, geometry, primitive, hits of the lane) in every active lane.
template <auto F, class Callback>
void eachLane(const void* given, OwnFilter filter)
{
    const auto& callback = *static_cast<const Callback*>(given);
    const auto& view = *static_cast<const OxrtGeometry*>(callback.geometryUserPtr);
    for (unsigned lane = 0; lane < callback.N; ++lane)
        if (callback.valid[lane] == -1) {
            LaneHits hits(callback, lane, filter);
            if (hits.mayMeet(view, callback.primID)) F(view, callback.geomID, callback.primID, hits);
        }
}
template <auto F>
inline constexpr OxrtOwnShape ownShapeOf = {eachLane<F, RTCIntersectFunctionNArguments>, eachLane<F, RTCOccludedFunctionNArguments>};

// Keeps the box of a primitive for the kernels, where they need it.
const RTCBounds& kept(const OxrtGeometry& view, std::uint32_t primitive, const RTCBounds& bounds);

struct EmbreeLibrary;

// Sets the callbacks of a new user geometry with `count` primitives.
void setOwnShape(const EmbreeLibrary& embree, RTCGeometry geometry, OxrtGeometry& view, const OxrtOwnShape& shape, RTCBoundsFunction bounds,
                 std::uint32_t count, std::uint32_t keyCount);

} // namespace oxrt
