/* Made by optixc. Compiled features:
   closesthit programs: shader.py:60
   intersection programs: shader.py:48
   array bounds checks: shader.py:44
*/
#include <oxrt/device.h>

#include <oxrt/lanes_trace.h>

namespace {

enum { LANES = 16 };
template <class T> using Wide = oxrt::Wide<T, LANES>;
using Mask = oxrt::Lanes<bool, LANES>;
using Lanes = oxrt::LanesThread<LANES>;
using Rays = oxrt::RayLanes<LANES>;

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

struct ParamsWide;
struct SphereWide;
struct SpherePointWide;
struct DistanceWide;
}  // namespace
template <> struct oxrt::WideType<Params, 16> { using Type = ParamsWide; };
template <> struct oxrt::WideType<Sphere, 16> { using Type = SphereWide; };
template <> struct oxrt::WideType<SpherePoint, 16> { using Type = SpherePointWide; };
template <> struct oxrt::WideType<Distance, 16> { using Type = DistanceWide; };
namespace {

struct ParamsWide {
    using IsWideStruct = void;
    Wide<oxrt::Array<float, 1>> depth;
    Wide<uint64_t> scene;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.depth...); f(s.scene...); }
};

struct SphereWide {
    using IsWideStruct = void;
    Wide<oxrt::float3> center;
    Wide<float> radius;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.center...); f(s.radius...); }
};

struct SpherePointWide {
    using IsWideStruct = void;
    static constexpr bool hasWrappedFields = false;
    Wide<oxrt::float3> normal;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.normal...); }
};

struct DistanceWide {
    using IsWideStruct = void;
    Wide<float> t;
    Wide<bool> back;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.t...); f(s.back...); }
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

struct DistanceProgramsLanes : oxrt::NoLanePrograms {
    using Scalar = DistancePrograms;
    using Payload = Wide<Distance>;
    static constexpr int attributeWords = 3;
    static void closestHit(Rays& trace, Mask mask, Payload& payload);
    static void intersection(Rays& trace, Mask mask, Payload& payload, const OxrtRecordHeader& record);
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
        bool result_ = report_root<Programs>(trace, (-b - root) / a, sphere.center);
#line 55 "shader.py"
        if (oxrt::hasEnded(trace))
            return;
#line 55 "shader.py"
        if (!result_) {
            oxrt::reportIntersection<Programs>(trace, (-b + root) / a, 2u, oxrt::attributeWords(oxrt::floatAsUint(root), 7u));
#line 56 "shader.py"
            if (oxrt::hasEnded(trace))
                return;
        }
    }
}

#line 134 "pipeline.cpp"
template <class Programs> Wide<bool> report_root_lanes([[maybe_unused]] Rays& trace, [[maybe_unused]] Mask mask, Wide<float> t,
        const oxrt::float3& center);

#line 40 "shader.py"
void raygen_depth_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 41 "shader.py"
    Wide<oxrt::uint3> i = oxrt::getLaunchIndex(thread);
    Wide<Distance> found = oxrt::spread<16>(Distance{-1.0f, false});
    oxrt::trace<DistanceProgramsLanes>(thread, mask, params.scene, Wide<oxrt::float3>(oxrt::convert<float>(i.x), oxrt::convert<float>(i.y),
            -10.0f), oxrt::float3(0.0f, 0.0f, 1.0f), 0.0f, __builtin_inff(), 0.0f, 255u, oxrt::KnownFlags<0>(), 0u, 1u, 0u, found);
#line 44 "shader.py"
    oxrt::checked(thread, mask).store(oxrt::select(Wide<bool>(found.back), -found.t, found.t), params.depth, i.x);
}

#line 34 "shader.py"
template <class Programs> Wide<bool> report_root_lanes([[maybe_unused]] Rays& trace, [[maybe_unused]] Mask mask, Wide<float> t,
        const oxrt::float3& center) {
    [[maybe_unused]] Lanes& thread = *trace.thread;
    Wide<bool> result{};
#line 35 "shader.py"
    Wide<oxrt::float3> n = oxrt::normalize(oxrt::getObjectRayOrigin(trace) + t * oxrt::getObjectRayDirection(trace) - center);
    Wide<bool> accepted = oxrt::reportIntersection<Programs>(trace, mask, t, 1u, oxrt::attributesToLanes<SpherePoint,
            LANES>(Wide<SpherePoint>{n}));
#line 36 "shader.py"
    mask = oxrt::without(mask, oxrt::endedLanes(trace));
    if (oxrt::any(mask)) {
#line 36 "shader.py"
        oxrt::assign(mask, result, accepted);
#line 36 "shader.py"
        mask = false;
    }
    return result;
}

#line 48 "shader.py"
template <class Programs> void intersection_sphere_lanes([[maybe_unused]] Rays& trace, [[maybe_unused]] Mask mask, const Sphere& sphere) {
    [[maybe_unused]] Lanes& thread = *trace.thread;
#line 49 "shader.py"
    Wide<oxrt::float3> o = oxrt::getObjectRayOrigin(trace) - sphere.center;
    Wide<oxrt::float3> d = oxrt::getObjectRayDirection(trace);
    Wide<float> a = oxrt::dot(d, d);
#line 51 "shader.py"
    Wide<float> b = oxrt::dot(o, d);
    Wide<float> discriminant = b * b - a * (oxrt::dot(o, o) - sphere.radius * sphere.radius);
    const Mask test = discriminant >= 0.0f;
#line 53 "shader.py"
    Mask mask_ = mask & test;
#line 53 "shader.py"
    if (oxrt::any(mask_)) {
        Wide<float> root = oxrt::sqrt(discriminant);
        Wide<bool> result_ = report_root_lanes<Programs>(trace, mask_, (-b - root) / a, sphere.center);
#line 55 "shader.py"
        mask_ = oxrt::without(mask_, oxrt::endedLanes(trace));
        if (oxrt::any(mask_)) {
            const Mask test_ = !result_;
#line 55 "shader.py"
            Mask mask_2 = mask_ & test_;
#line 55 "shader.py"
            if (oxrt::any(mask_2)) {
                oxrt::reportIntersection<Programs>(trace, mask_2, (-b + root) / a, 2u, oxrt::attributeLanes<LANES>(oxrt::floatAsUint(root),
                        Wide<uint32_t>(7u)));
#line 56 "shader.py"
                mask_2 = oxrt::without(mask_2, oxrt::endedLanes(trace));
            }
            mask_ = mask_2 | oxrt::without(mask_, test_);
        }
    }
    mask = mask_ | oxrt::without(mask, test);
}

#line 60 "shader.py"
void closesthit_sphere_lanes([[maybe_unused]] Rays& trace, [[maybe_unused]] Mask mask, Wide<Distance>& found,
        const Wide<SpherePoint>& point) {
    [[maybe_unused]] Lanes& thread = *trace.thread;
#line 61 "shader.py"
    oxrt::assign(mask, found.t, oxrt::getRayTmax(trace));
    oxrt::assign(mask, found.back, (oxrt::getHitKind(trace) == 2u) | (point.normal.z > 0.0f));
}

#line 215 "pipeline.cpp"
void DistancePrograms::intersection(oxrt::Ray& trace, Payload&, const OxrtRecordHeader& record) {
    if (record.programs[oxrt::SLOT_INTERSECTION] == number::intersection_sphere)
        intersection_sphere<DistancePrograms>(trace, oxrt::recordData<Sphere>(record));
}

void DistanceProgramsLanes::closestHit(Rays& trace, Mask mask, Payload& payload) {
    const Wide<int32_t> program = oxrt::recordPrograms(trace.records, mask, oxrt::SLOT_CLOSESTHIT);
    if (const Mask own = mask & (program == int32_t(number::closesthit_sphere)); oxrt::any(own))
        closesthit_sphere_lanes(trace, own, payload, oxrt::getAttributes<SpherePoint>(trace));
}

void DistanceProgramsLanes::intersection(Rays& trace, Mask mask, Payload&, const OxrtRecordHeader& record) {
    switch (record.programs[oxrt::SLOT_INTERSECTION]) {
        case number::intersection_sphere: intersection_sphere_lanes<DistanceProgramsLanes>(trace, mask,
                oxrt::recordData<Sphere>(record)); break;
        default: break;
    }
}

void run_raygen_depth(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::runBlocks<LANES>(*thread, *tile, [](Lanes& lanes, Mask mask) {
        raygen_depth_lanes(lanes, mask);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__depth", OXRT_KIND_RAYGEN, 0, run_raygen_depth},
    {"__intersection__sphere", OXRT_KIND_INTERSECTION, sizeof(Sphere), nullptr},
    {"__closesthit__sphere", OXRT_KIND_CLOSESTHIT, 0, nullptr},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 16, programs, 3}};
static_assert(sizeof(Params) == 24);
static_assert(sizeof(Sphere) == 16);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 24, 1, "0.1.0"};
