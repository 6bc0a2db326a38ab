/* Made by optixc. Compiled features:
   array bounds checks: shader.py:25
*/
#include <oxrt/device.h>

namespace {

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

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_main };
}

#line 24 "shader.py"
void raygen_main(OxrtThread& thread) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 25 "shader.py"
    int32_t a = oxrt::checked(thread).load(params.i, 0);
#line 25 "shader.py"
    int32_t b = oxrt::checked(thread).load(params.i, 1);
    uint32_t x = oxrt::checked(thread).load(params.u, 0);
#line 26 "shader.py"
    uint32_t y = oxrt::checked(thread).load(params.u, 1);
    float s = oxrt::checked(thread).load(params.f, 0);
#line 27 "shader.py"
    float t = oxrt::checked(thread).load(params.f, 1);
    if (oxrt::checked(thread).contains(params.i, 2))
#line 28 "shader.py"
        params.i.at(2) = a - (b - 1) - (a + b) * -a;
    if (oxrt::checked(thread).contains(params.i, 3))
#line 29 "shader.py"
        params.i.at(3) = oxrt::floorDivide(a, b) + oxrt::modulo(a, b) + oxrt::floorDivide(a, 4) + (a << 3u) + oxrt::shiftRight(a, b);
    if (oxrt::checked(thread).contains(params.i, 4))
#line 30 "shader.py"
        params.i.at(4) = (a & b) | (a ^ ~b);
    if (oxrt::checked(thread).contains(params.i, 5))
#line 31 "shader.py"
        params.i.at(5) = oxrt::convert<int32_t>(s) + int32_t(x) + int32_t(a < b) + INT32_MIN;
    if (oxrt::checked(thread).contains(params.u, 2))
#line 32 "shader.py"
        params.u.at(2) = x / 16u + x % 10u + (x >> 4u) + oxrt::shiftLeft(x, y);
    if (oxrt::checked(thread).contains(params.u, 3))
#line 33 "shader.py"
        params.u.at(3) = oxrt::convert<uint32_t>(s) | uint32_t(a);
    if (oxrt::checked(thread).contains(params.f, 2))
#line 34 "shader.py"
        params.f.at(2) = float(a) / float(b) + s / t - oxrt::modulo(s, t) + oxrt::power(s, 2.0f) + float(x);
    if (oxrt::checked(thread).contains(params.f, 3))
#line 35 "shader.py"
        params.f.at(3) = (a < b && b <= 5 && !params.flag) || x == y ? s : -t;
    if (oxrt::checked(thread).contains(params.f, 4))
#line 36 "shader.py"
        params.f.at(4) = oxrt::min(s, 1.0f) + oxrt::max(s, oxrt::max(t, 0.25f)) + oxrt::abs(-s) + 0.1f + 1e-30f + 3.0f;
    if (oxrt::checked(thread).contains(params.d, 0))
#line 37 "shader.py"
        params.d.at(0) = double(s) * 0.1 + oxrt::checked(thread).load(params.d, 1);
    if (oxrt::checked(thread).contains(params.i, 6))
#line 38 "shader.py"
        params.i.at(6) = int32_t(params.wide >> 2u) + int32_t(params.huge % UINT64_C(1000));
    oxrt::float3 v = oxrt::float3(s, t, 1.0f);
    oxrt::float4 w = oxrt::float4(oxrt::swizzle<2, 1, 0>(v), 0.5f);
    oxrt::float3 q = oxrt::multiply(params.m, w);
    oxrt::float3x4 c = oxrt::float3x4{{w, oxrt::swizzle<3, 2, 1, 0>(w), oxrt::float4(0.0f)}};
    if (oxrt::checked(thread).contains(params.f, 5))
#line 43 "shader.py"
        params.f.at(5) = q.x + c[1].y + oxrt::dot(v, oxrt::swizzle<1, 2, 0>(v)) + w[2];
    oxrt::uint2 n = oxrt::uint2(x, y) * 2u + 1u;
    if (oxrt::checked(thread).contains(params.u, 4))
#line 45 "shader.py"
        params.u.at(4) = n == oxrt::uint2(1u, 2u) ? n.x : n.y;
    oxrt::uint4 colour = oxrt::convert<uint32_t>(oxrt::checked(thread).load(params.bytes, 0, a));
    if (oxrt::checked(thread).contains(params.f, 6))
#line 47 "shader.py"
        params.f.at(6) = float(colour.x) / 255.0f + float(oxrt::popcount(x)) + oxrt::uintAsFloat(x);
    oxrt::float2 ratio = oxrt::float2(float(colour.y), oxrt::sqrt(s)) / 2.0f;
    if (oxrt::checked(thread).contains(params.f, 7))
#line 49 "shader.py"
        params.f.at(7) = ratio.x * ratio.y;
}

#line 93 "pipeline.cpp"
void run_raygen_main(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::forEachIndex(*thread, *tile, [thread] {
        raygen_main(*thread);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__main", OXRT_KIND_RAYGEN, 0, run_raygen_main},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 1, programs, 1}};
static_assert(sizeof(Params) == 160);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 160, 1, "0.1.0"};
