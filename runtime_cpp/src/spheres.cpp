// Spheres: Embree's points of type sphere. OptiX offers only the hit where the ray enters; the sign of a radius does not count.
#include "array.h"
#include "error.h"
#include "filter_lanes.h"
#include "own_shape.h"
#include "shape.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace oxrt {

namespace {

constexpr std::size_t floatsPerSphere = 4;

// Embree computes a distance with an error relative to the radius. Where the ray begins nearer to the sphere than that, the distance is
// computed again: in double precision, and without the difference of two large numbers.
double entryDistance(const Point4& sphere, const RTCFilterFunctionNArguments& arguments, unsigned lane)
{
    const double center[3] = {sphere.x, sphere.y, sphere.z};
    double away[3];
    double direction[3];
    double along = 0, lengthSquared = 0, distanceSquared = 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
        away[axis] = center[axis] - fieldOf(arguments.ray, ORIGIN + axis, arguments.N, lane);
        direction[axis] = fieldOf(arguments.ray, DIRECTION + axis, arguments.N, lane);
        along += away[axis] * direction[axis];
        lengthSquared += direction[axis] * direction[axis];
        distanceSquared += away[axis] * away[axis];
    }
    double acrossSquared = 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
        const double across = away[axis] - along / lengthSquared * direction[axis];
        acrossSquared += across * across;
    }
    const double radius = sphere.w;
    const double half = std::sqrt(std::max(0.0, (radius * radius - acrossSquared) * lengthSquared));
    return (distanceSquared - radius * radius) / (along + half);
}

// Corrects the distance of a hit that is nearer to the ray's origin than the radius; false if it is before the ray's interval then.
bool correctDistance(const RTCFilterFunctionNArguments& arguments, unsigned lane)
{
    const auto& view = *static_cast<const OxrtGeometry*>(arguments.geometryUserPtr);
    std::uint32_t primitive;
    std::memcpy(&primitive, &fieldOf(arguments.hit, PRIMITIVE, arguments.N, lane), sizeof primitive);
    const KeyPosition at = keyPosition(view.keyCount, fieldOf(arguments.ray, TIME, arguments.N, lane));
    const auto* sphere = reinterpret_cast<const Point4*>(view.vertices) + primitive + view.vertexCount * at.key;
    const Point4 now = at.fraction == 0 ? *sphere : *sphere * (1 - at.fraction) + sphere[view.vertexCount] * at.fraction;
    const auto entry = static_cast<float>(entryDistance(now, arguments, lane));
    if (!(entry >= fieldOf(arguments.ray, TNEAR, arguments.N, lane))) return false;
    fieldOf(arguments.ray, TFAR, arguments.N, lane) = entry;
    return true;
}

// The normal is the way from the centre to the hit, as long as the radius.
void enterSpheres(const RTCFilterFunctionNArguments* arguments)
{
    const unsigned width = arguments->N;
    eachValidLane(*arguments, [&](unsigned lane) {
        const float* const direction = &fieldOf(arguments->ray, DIRECTION, width, lane);
        const float* const normal = &fieldOf(arguments->hit, NORMAL, width, lane);
        const float t = fieldOf(arguments->ray, TFAR, width, lane);
        float cosine = 0, lengthSquared = 0, radiusSquared = 0;
        for (unsigned axis = 0; axis < 3; ++axis) {
            const float d = direction[axis * width];
            const float n = normal[axis * width];
            cosine += d * n;
            lengthSquared += d * d;
            radiusSquared += n * n;
        }
        if (!(cosine < 0) || (t * t * lengthSquared < radiusSquared && !correctDistance(*arguments, lane))) arguments->valid[lane] = 0;
    });
}

class Spheres final : public Shape {
public:
    explicit Spheres(const OxrtBuildInput& input)
        : count(input.numPrimitives), keyCount(std::max(1u, input.numKeys)), spheres(floatsPerSphere * count * keyCount)
    {}

    std::unique_ptr<Shape> clone() const override { return std::make_unique<Spheres>(*this); }

    void copy(const OxrtBuildInput& input) override
    {
        for (std::uint32_t key = 0; key < keyCount; ++key)
            for (std::uint64_t i = 0; i < count; ++i) {
                float* sphere = spheres.data() + floatsPerSphere * (count * key + i);
                const float* const center = input.vertices[key] + 3 * i;
                for (int axis = 0; axis < 3; ++axis) sphere[axis] = center[axis];
                const float radius = std::fabs(input.radii[key][input.singleRadius ? 0 : i]);
                sphere[3] = std::isnan(radius) ? 0.0f : radius; // a hit on radius 0 has no front face, so it is dropped
            }
    }

    void describe(OxrtGeometry& view) const override
    {
        view.primitiveType = OXRT_PRIMITIVE_SPHERE;
        view.vertexCount = count;
        view.vertices = spheres.data();
    }

    RTCGeometry make(const EmbreeLibrary& embree, RTCDevice device, OxrtGeometry&) override
    {
        const RTCGeometry geometry = embree.rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
        embree.rtcSetGeometryTimeStepCount(geometry, keyCount);
        for (std::uint32_t key = 0; key < keyCount; ++key)
            embree.rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, key, RTC_FORMAT_FLOAT4, spheres.data(),
                                              sizeof(float) * floatsPerSphere * count * key, sizeof(float) * floatsPerSphere, count);
        setFilter(embree, geometry, enterSpheres);
        return geometry;
    }

    void refit(const EmbreeLibrary& embree, RTCGeometry geometry) const override
    {
        for (std::uint32_t key = 0; key < keyCount; ++key) embree.rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, key);
    }

    std::size_t bytes() const override { return spheres.bytes(); }

    RTCBounds boundsAt(const OxrtGeometry&, std::uint32_t primitive, std::uint32_t key) const override
    {
        const float* s = spheres.data() + floatsPerSphere * (count * key + primitive);
        return {s[0] - s[3], s[1] - s[3], s[2] - s[3], 0, s[0] + s[3], s[1] + s[3], s[2] + s[3], 0};
    }

private:
    const std::uint64_t count;
    const std::uint32_t keyCount;
    Array<float> spheres;
};

} // namespace

void checkSpheres(const OxrtBuildInput& input, unsigned number)
{
    if (input.numPrimitives == 0) return;
    if (input.numVertices != input.numPrimitives)
        fail(OXRT_ERROR_INVALID_VALUE, "input %u: %llu spheres but %llu vertices; give one for each", number,
             static_cast<unsigned long long>(input.numPrimitives), static_cast<unsigned long long>(input.numVertices));
    checkKeys(input.vertices, input, number, "vertices");
    checkKeys(input.radii, input, number, "radii");
    if (input.singleRadius > 1) fail(OXRT_ERROR_INVALID_VALUE, "input %u: singleRadius is %u; give 0 or 1", number, input.singleRadius);
}

std::unique_ptr<Shape> makeSpheres(const OxrtBuildInput& input)
{
    return std::make_unique<Spheres>(input);
}

void dropBackFaces(const RTCFilterFunctionNArguments* arguments)
{
    eachValidLane(*arguments, [&](unsigned lane) { arguments->valid[lane] = isEntered(*arguments, lane) ? -1 : 0; });
}

void setFilter(const EmbreeLibrary& embree, RTCGeometry geometry, RTCFilterFunctionN filter)
{
    embree.rtcSetGeometryIntersectFilterFunction(geometry, filter);
    embree.rtcSetGeometryOccludedFilterFunction(geometry, filter);
}

} // namespace oxrt
