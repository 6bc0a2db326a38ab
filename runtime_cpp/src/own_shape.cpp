// See own_shape.h.
#include "own_shape.h"

#include "embree_library.h"
#include "matrix.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace oxrt {

namespace {

enum RayField { ORIGIN = 0, TNEAR = 3, DIRECTION = 4, TIME = 7, TFAR = 8 };
enum HitField { NORMAL = 0, U = 3, V = 4, PRIMITIVE = 5, GEOMETRY = 6, INSTANCE = 7, INSTANCE_PRIMITIVE = 8, HIT_FIELDS = 9 };
constexpr unsigned rayFields = 12;
constexpr unsigned widest = 16;

// A hit in Embree's layout for packets of `width`, for one lane of it.
struct alignas(64) HitPacket {
    float words[HIT_FIELDS * widest];

    void set(unsigned field, unsigned width, unsigned lane, float value) { words[field * width + lane] = value; }
    void set(unsigned field, unsigned width, unsigned lane, unsigned value)
    {
        std::memcpy(words + field * width + lane, &value, sizeof value);
    }
    void enter(const LaneHit& hit, const RTCRayQueryContext& context, unsigned width, unsigned lane)
    {
        set(NORMAL, width, lane, hit.normal.x);
        set(NORMAL + 1, width, lane, hit.normal.y);
        set(NORMAL + 2, width, lane, hit.normal.z);
        set(U, width, lane, hit.u);
        set(V, width, lane, hit.v);
        set(PRIMITIVE, width, lane, hit.primitive);
        set(GEOMETRY, width, lane, hit.geometry);
        set(INSTANCE, width, lane, context.instID[0]);
        set(INSTANCE_PRIMITIVE, width, lane, context.instPrimID[0]);
    }
};

// Embree's callbacks of a geometry: for queries that bring none of their own, and so no filter.
void intersectUnfiltered(const RTCIntersectFunctionNArguments* arguments)
{
    static_cast<const OxrtGeometry*>(arguments->geometryUserPtr)->ownShape->intersect(arguments, nullptr);
}
void occludeUnfiltered(const RTCOccludedFunctionNArguments* arguments)
{
    static_cast<const OxrtGeometry*>(arguments->geometryUserPtr)->ownShape->occluded(arguments, nullptr);
}

} // namespace

LaneHits::LaneHits(const RTCIntersectFunctionNArguments& callback, unsigned number, OwnFilter filter)
    : judge(filter), isOcclusion(false), rays(static_cast<float*>(callback.rayhit)), width(callback.N), lane(number),
      userPointer(callback.geometryUserPtr), context(callback.context)
{
    readRay();
}

LaneHits::LaneHits(const RTCOccludedFunctionNArguments& callback, unsigned number, OwnFilter filter)
    : judge(filter), isOcclusion(true), rays(static_cast<float*>(callback.ray)), width(callback.N), lane(number),
      userPointer(callback.geometryUserPtr), context(callback.context)
{
    readRay();
}

void LaneHits::readRay()
{
    ray.origin = {field(ORIGIN), field(ORIGIN + 1), field(ORIGIN + 2), 0};
    ray.direction = {field(DIRECTION), field(DIRECTION + 1), field(DIRECTION + 2), 0};
    ray.tnear = field(TNEAR);
    ray.tfar = field(TFAR);
    ray.time = field(TIME);
}

bool LaneHits::offer(const LaneHit& hit)
{
    if (!(hit.t >= ray.tnear && hit.t < ray.tfar)) return true; // of hits at one distance the first counts
    HitPacket packet;
    packet.enter(hit, *context, width, lane);
    alignas(64) int valid[widest] = {};
    valid[lane] = -1;
    field(TFAR) = hit.t;
    const RTCFilterFunctionNArguments filter = {valid, userPointer, context, rays, packet.words, width};
    if (judge) judge(&filter);
    if (valid[lane] != -1) {
        field(TFAR) = ray.tfar;
        return true;
    }
    if (isOcclusion) {
        field(TFAR) = -std::numeric_limits<float>::infinity();
        return false;
    }
    float* const hits = rays + rayFields * width;
    for (unsigned number = 0; number < HIT_FIELDS; ++number) hits[number * width + lane] = packet.words[number * width + lane];
    ray.tfar = field(TFAR); // the filter may have ended the ray
    return ray.tfar == hit.t;
}

KeyPosition keyPosition(std::uint32_t keyCount, float time)
{
    if (keyCount < 2) return {0, 0};
    const float position = std::clamp(time, 0.0f, 1.0f) * static_cast<float>(keyCount - 1);
    const std::uint32_t key = std::min(static_cast<std::uint32_t>(position), keyCount - 2);
    return {key, position - static_cast<float>(key)};
}

const RTCBounds& kept(const OxrtGeometry& view, std::uint32_t primitive, const RTCBounds& bounds)
{
    if (view.boxes) storeBox(bounds, const_cast<float*>(view.boxes) + 6 * std::size_t(primitive));
    return bounds;
}

void setOwnShape(const EmbreeLibrary& embree, RTCGeometry geometry, OxrtGeometry& view, const OxrtOwnShape& shape, RTCBoundsFunction bounds,
                 std::uint32_t count, std::uint32_t keyCount)
{
    view.ownShape = &shape;
    embree.rtcSetGeometryTimeStepCount(geometry, keyCount);
    embree.rtcSetGeometryUserPrimitiveCount(geometry, count);
    embree.rtcSetGeometryBoundsFunction(geometry, bounds, &view);
    embree.rtcSetGeometryIntersectFunction(geometry, intersectUnfiltered);
    embree.rtcSetGeometryOccludedFunction(geometry, occludeUnfiltered);
}

} // namespace oxrt
