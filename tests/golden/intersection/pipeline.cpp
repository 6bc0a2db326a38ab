/* Made by optixc. Compiled features:
   closesthit programs: shader.py:60
   intersection programs: shader.py:48
   array bounds checks: shader.py:44
*/
#include <oxrt/device.h>

namespace {

struct Params {
    oxrt::Array<float, 1> depth;
    uint64_t scene;
};

struct Sphere {
    oxrt::float3 center;
    float radius;
};

struct SpherePoint {
    oxrt::float3 normal;
};

struct Distance {
    float t;
    oxrt::Word<bool> back;
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_depth, intersection_sphere, closesthit_sphere };
}

/* What a trace with a Distance payload can run. */
struct DistancePrograms : oxrt::NoPrograms {
    using Payload = Distance;
    static constexpr bool hasClosestHit = true;
    static constexpr bool hasIntersection = true;
    static void closestHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
    static void intersection(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);
};

#line 34 "shader.py"
template <class Programs> bool report_root(oxrt::Ray& trace, float t, oxrt::float3 center) {
    oxrt::float3 n = oxrt::normalize(oxrt::getObjectRayOrigin(trace) + t * oxrt::getObjectRayDirection(trace) - center);
    bool accepted = oxrt::reportIntersection<Programs>(trace, t, 1u, SpherePoint{n});
#line 36 "shader.py"
    if (oxrt::hasEnded(trace))
        return {};
#line 36 "shader.py"
    return accepted;
}

#line 40 "shader.py"
void raygen_depth(OxrtThread& thread) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 41 "shader.py"
    oxrt::uint3 i = oxrt::getLaunchIndex(thread);
    Distance found = Distance{-1.0f, false};
    oxrt::trace<DistancePrograms>(thread, params.scene, oxrt::float3(float(i.x), float(i.y), -10.0f), oxrt::float3(0.0f, 0.0f, 1.0f), 0.0f,
            __builtin_inff(), 0.0f, 255u, oxrt::KnownFlags<0>(), 0u, 1u, 0u, found);
#line 44 "shader.py"
    if (oxrt::checked(thread).contains(params.depth, i.x))
#line 44 "shader.py"
        params.depth.at(i.x) = bool(found.back) ? -found.t : found.t;
}

#line 48 "shader.py"
template <class Programs> void intersection_sphere(oxrt::Ray& trace, const Sphere& sphere) {
    oxrt::float3 o = oxrt::getObjectRayOrigin(trace) - sphere.center;
    oxrt::float3 d = oxrt::getObjectRayDirection(trace);
    float a = oxrt::dot(d, d);
#line 51 "shader.py"
    float b = oxrt::dot(o, d);
    float discriminant = b * b - a * (oxrt::dot(o, o) - sphere.radius * sphere.radius);
    if (discriminant >= 0.0f) {
        float root = oxrt::sqrt(discriminant);
        bool result = report_root<Programs>(trace, (-b - root) / a, sphere.center);
#line 55 "shader.py"
        if (oxrt::hasEnded(trace))
            return;
#line 55 "shader.py"
        if (!result) {
            oxrt::reportIntersection<Programs>(trace, (-b + root) / a, 2u, oxrt::attributeWords(oxrt::floatAsUint(root), 7u));
#line 56 "shader.py"
            if (oxrt::hasEnded(trace))
                return;
        }
    }
}

#line 60 "shader.py"
void closesthit_sphere(oxrt::Ray& trace, Distance& found, const SpherePoint& point) {
    found.t = oxrt::getRayTmax(trace);
    found.back = oxrt::getHitKind(trace) == 2u || point.normal.z > 0.0f;
}

#line 99 "pipeline.cpp"
void DistancePrograms::closestHit(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record) {
    if (record.programs[oxrt::SLOT_CLOSESTHIT] == number::closesthit_sphere)
        closesthit_sphere(trace, payload, oxrt::getAttributes<SpherePoint>(trace));
}

void DistancePrograms::intersection(oxrt::Ray& trace, Payload&, const OxrtRecordHeader& record) {
    if (record.programs[oxrt::SLOT_INTERSECTION] == number::intersection_sphere)
        intersection_sphere<DistancePrograms>(trace, oxrt::recordData<Sphere>(record));
}

void run_raygen_depth(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::forEachIndex(*thread, *tile, [thread] {
        raygen_depth(*thread);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__depth", OXRT_KIND_RAYGEN, 0, run_raygen_depth},
    {"__intersection__sphere", OXRT_KIND_INTERSECTION, sizeof(Sphere), nullptr},
    {"__closesthit__sphere", OXRT_KIND_CLOSESTHIT, 0, nullptr},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 1, programs, 3}};
static_assert(sizeof(Params) == 24);
static_assert(sizeof(Sphere) == 16);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 24, 1, "0.1.0"};
