/* Made by optixc. Compiled features:
   array bounds checks: shader.py:25
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
    oxrt::Array<float, 1> f;
    oxrt::Array<double, 1> d;
    oxrt::Array<int32_t, 1> i;
    oxrt::Array<uint32_t, 1> u;
    oxrt::Array<oxrt::uchar4, 2> bytes;
    oxrt::float3x4 m;
    bool flag;
    int64_t wide;
    uint64_t huge;
};

struct ParamsWide;
}  // namespace
template <> struct oxrt::WideType<Params, 16> { using Type = ParamsWide; };
namespace {

struct ParamsWide {
    using IsWideStruct = void;
    Wide<oxrt::Array<float, 1>> f;
    Wide<oxrt::Array<double, 1>> d;
    Wide<oxrt::Array<int32_t, 1>> i;
    Wide<oxrt::Array<uint32_t, 1>> u;
    Wide<oxrt::Array<oxrt::uchar4, 2>> bytes;
    Wide<oxrt::float3x4> m;
    Wide<bool> flag;
    Wide<int64_t> wide;
    Wide<uint64_t> huge;
    template <class F, class... S> static OXRT_INLINE void each(const F& f,
            S&... s) { f(s.f...); f(s.d...); f(s.i...); f(s.u...); f(s.bytes...); f(s.m...); f(s.flag...); f(s.wide...); f(s.huge...); }
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_main };
}


#line 24 "shader.py"
void raygen_main_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 25 "shader.py"
    int32_t a = oxrt::checkedCommon(thread, mask).load(params.i, 0);
#line 25 "shader.py"
    int32_t b = oxrt::checkedCommon(thread, mask).load(params.i, 1);
    uint32_t x = oxrt::checkedCommon(thread, mask).load(params.u, 0);
#line 26 "shader.py"
    uint32_t y = oxrt::checkedCommon(thread, mask).load(params.u, 1);
    float s = oxrt::checkedCommon(thread, mask).load(params.f, 0);
#line 27 "shader.py"
    float t = oxrt::checkedCommon(thread, mask).load(params.f, 1);
    oxrt::checked(thread, mask).store(Wide<int32_t>(a - (b - 1) - (a + b) * -a), params.i, 2);
    oxrt::checked(thread, mask).store(Wide<int32_t>(oxrt::floorDivide(a, b) + oxrt::modulo(a, b) + oxrt::floorDivide(a,
            4) + (a << 3u) + oxrt::shiftRight(a, b)), params.i, 3);
#line 30 "shader.py"
    oxrt::checked(thread, mask).store(Wide<int32_t>((a & b) | (a ^ ~b)), params.i, 4);
    oxrt::checked(thread, mask).store(Wide<int32_t>(oxrt::convert<int32_t>(s) + int32_t(x) + int32_t(a < b) + INT32_MIN), params.i, 5);
    oxrt::checked(thread, mask).store(Wide<uint32_t>(x / 16u + x % 10u + (x >> 4u) + oxrt::shiftLeft(x, y)), params.u, 2);
    oxrt::checked(thread, mask).store(Wide<uint32_t>(oxrt::convert<uint32_t>(s) | uint32_t(a)), params.u, 3);
    oxrt::checked(thread, mask).store(Wide<float>(float(a) / float(b) + s / t - oxrt::modulo(s, t) + oxrt::power(s, 2.0f) + float(x)),
            params.f, 2);
#line 35 "shader.py"
    oxrt::checked(thread, mask).store(Wide<float>((a < b && b <= 5 && !params.flag) || x == y ? s : -t), params.f, 3);
    oxrt::checked(thread, mask).store(Wide<float>(oxrt::min(s, 1.0f) + oxrt::max(s, oxrt::max(t,
            0.25f)) + oxrt::abs(-s) + 0.1f + 1e-30f + 3.0f), params.f, 4);
#line 37 "shader.py"
    oxrt::checked(thread, mask).store(Wide<double>(double(s) * 0.1 + oxrt::checkedCommon(thread, mask).load(params.d, 1)), params.d, 0);
    oxrt::checked(thread, mask).store(Wide<int32_t>(int32_t(params.wide >> 2u) + int32_t(params.huge % UINT64_C(1000))), params.i, 6);
    oxrt::float3 v = oxrt::float3(s, t, 1.0f);
    oxrt::float4 w = oxrt::float4(oxrt::swizzle<2, 1, 0>(v), 0.5f);
    oxrt::float3 q = oxrt::multiply(params.m, w);
    oxrt::float3x4 c = oxrt::float3x4{{w, oxrt::swizzle<3, 2, 1, 0>(w), oxrt::float4(0.0f)}};
    oxrt::checked(thread, mask).store(Wide<float>(q.x + c[1].y + oxrt::dot(v, oxrt::swizzle<1, 2, 0>(v)) + w[2]), params.f, 5);
    oxrt::uint2 n = oxrt::uint2(x, y) * 2u + 1u;
    oxrt::checked(thread, mask).store(Wide<uint32_t>(n == oxrt::uint2(1u, 2u) ? n.x : n.y), params.u, 4);
    oxrt::uint4 colour = oxrt::convert<uint32_t>(oxrt::checkedCommon(thread, mask).load(params.bytes, 0, a));
    oxrt::checked(thread, mask).store(Wide<float>(float(colour.x) / 255.0f + float(oxrt::popcount(x)) + oxrt::uintAsFloat(x)), params.f, 6);
    oxrt::float2 ratio = oxrt::float2(float(colour.y), oxrt::sqrt(s)) / 2.0f;
    oxrt::checked(thread, mask).store(Wide<float>(ratio.x * ratio.y), params.f, 7);
}

#line 98 "pipeline.cpp"
void run_raygen_main(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::runBlocks<LANES>(*thread, *tile, [](Lanes& lanes, Mask mask) {
        raygen_main_lanes(lanes, mask);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__main", OXRT_KIND_RAYGEN, 0, run_raygen_main},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 16, programs, 1}};
static_assert(sizeof(Params) == 160);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 160, 1, "0.1.0"};
