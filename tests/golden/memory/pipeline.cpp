/* Made by optixc. Compiled features:
   atomics: shader.py:41
   textures: shader.py:49
   array bounds checks: shader.py:41
*/
#include <oxrt/device.h>
#include <oxrt/device_texture.h>

namespace {

struct Photon {
    oxrt::float3 position;
    oxrt::float3 power;
    uint8_t flags;
};

struct Store {
    oxrt::Array<Photon, 1> photons;
    oxrt::Array<uint32_t, 1> count;
};

struct Params {
    Store store;
    oxrt::Array<float, 1> sums;
    oxrt::Array<oxrt::half4, 2> halves;
    oxrt::Array<uint16_t, 3> volume;
    uint64_t image;
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_store, raygen_items };
}

#line 33 "shader.py"
float next_float(Photon& state) {
    state.position.x = state.position.x + 0.5f;
    return state.position.x;
}

#line 39 "shader.py"
void raygen_store(OxrtThread& thread) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 40 "shader.py"
    oxrt::uint3 i = oxrt::getLaunchIndex(thread);
    uint32_t slot = oxrt::checked(thread).contains(params.store.count, 0) ? oxrt::atomicAdd(params.store.count.at(0), 1u) : uint32_t();
    Photon photon = Photon{oxrt::float3(1.0f), oxrt::float3(0.5f), uint8_t(3u)};
    float result = next_float(photon);
#line 43 "shader.py"
    float result_2 = next_float(photon);
#line 43 "shader.py"
    oxrt::float2 uv = oxrt::float2(result, result_2);
    if (int32_t(slot) < int32_t(params.store.photons.shape[0])) {
        if (oxrt::checked(thread).contains(params.store.photons, slot))
#line 45 "shader.py"
            params.store.photons.at(slot) = photon;
        if (oxrt::checked(thread).contains(params.store.photons, slot))
#line 46 "shader.py"
            params.store.photons.at(slot).flags = uint32_t(oxrt::checked(thread).load(params.store.photons, 0).flags) + 1u;
        if (oxrt::checked(thread).contains(params.store.photons, slot))
#line 47 "shader.py"
            params.store.photons.at(slot).power.y = 2.0f;
    }
#line 48 "shader.py"
    oxrt::checked(thread).contains(params.sums, slot) ? oxrt::atomicMax(params.sums.at(slot), uv.x) : float();
    oxrt::float4 texel = oxrt::tex2d(thread, params.image, uv.x, uv.y);
    if (oxrt::checked(thread).contains(params.halves, i.y, i.x))
#line 50 "shader.py"
        params.halves.at(i.y, i.x) = oxrt::convert<oxrt::half>(oxrt::float4(float(oxrt::half(texel.x)), float(oxrt::half(texel.y)),
                float(oxrt::half(texel.z)), float(oxrt::half(texel.w))));
#line 51 "shader.py"
    if (oxrt::checked(thread).contains(params.volume, i.z, i.y, i.x))
#line 51 "shader.py"
        params.volume.at(i.z, i.y, i.x) = oxrt::convert<uint32_t>(texel.x);
    Photon copied = photon;
    copied.power = oxrt::swizzle<0, 1, 2>(oxrt::convert<float>(oxrt::checked(thread).load(params.halves, 0, 0)));
    if (oxrt::checked(thread).contains(params.store.photons, 0))
#line 54 "shader.py"
        params.store.photons.at(0) = copied;
}

#line 83 "pipeline.cpp"
// Items that a helper changes, by indices that differ and that do not; parts of storage vectors; shifts of literals.
#line 58 "shader.py"
void raygen_items(OxrtThread& thread) {
    const Params& params = oxrt::launchParams<Params>(thread);
    uint32_t i = oxrt::getLaunchIndex(thread).x;
    oxrt::FixedArray<Photon, 2> photons = oxrt::FixedArray<Photon, 2>{};
    oxrt::FixedArray<oxrt::FixedArray<uint32_t, 2>, 4> grid = oxrt::FixedArray<oxrt::FixedArray<uint32_t, 2>, 4>{};
    grid[i & 3u][(i >> 2u) & 1u] = oxrt::shiftLeft(1u, i & 31u);
    float result = next_float(photons[i & 1u]);
#line 64 "shader.py"
    float result_2 = next_float(photons[0]);
#line 64 "shader.py"
    float x = result + result_2;
    photons[1].flags = grid[2][i & 1u] & 4294967291u;
    if (oxrt::checked(thread).contains(params.halves, 0, i))
#line 66 "shader.py"
        params.halves.at(0, i).y = x;
    if (oxrt::checked(thread).contains(params.sums, i))
#line 67 "shader.py"
        params.sums.at(i) = photons[i & 1u].position.x;
}

#line 106 "pipeline.cpp"
void run_raygen_store(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::forEachIndex(*thread, *tile, [thread] {
        raygen_store(*thread);
    });
}

void run_raygen_items(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::forEachIndex(*thread, *tile, [thread] {
        raygen_items(*thread);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__store", OXRT_KIND_RAYGEN, 0, run_raygen_store},
    {"__raygen__items", OXRT_KIND_RAYGEN, 0, run_raygen_items},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 1, programs, 2}};
static_assert(sizeof(Params) == 112);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 112, 1, "0.1.0"};
