/* Made by optixc. Compiled features:
   atomics: shader.py:41
   textures: shader.py:49
   array bounds checks: shader.py:41
*/
#include <oxrt/device.h>
#include <oxrt/device_texture.h>

#include <oxrt/lanes_trace.h>

namespace {

enum { LANES = 16 };
template <class T> using Wide = oxrt::Wide<T, LANES>;
using Mask = oxrt::Lanes<bool, LANES>;
using Lanes = oxrt::LanesThread<LANES>;
using Rays = oxrt::RayLanes<LANES>;

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

struct PhotonWide;
struct StoreWide;
struct ParamsWide;
}  // namespace
template <> struct oxrt::WideType<Photon, 16> { using Type = PhotonWide; };
template <> struct oxrt::WideType<Store, 16> { using Type = StoreWide; };
template <> struct oxrt::WideType<Params, 16> { using Type = ParamsWide; };
namespace {

struct PhotonWide {
    using IsWideStruct = void;
    Wide<oxrt::float3> position;
    Wide<oxrt::float3> power;
    Wide<uint8_t> flags;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.position...); f(s.power...); f(s.flags...); }
};

struct StoreWide {
    using IsWideStruct = void;
    Wide<oxrt::Array<Photon, 1>> photons;
    Wide<oxrt::Array<uint32_t, 1>> count;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.photons...); f(s.count...); }
};

struct ParamsWide {
    using IsWideStruct = void;
    Wide<Store> store;
    Wide<oxrt::Array<float, 1>> sums;
    Wide<oxrt::Array<oxrt::half4, 2>> halves;
    Wide<oxrt::Array<uint16_t, 3>> volume;
    Wide<uint64_t> image;
    template <class F, class... S> static OXRT_INLINE void each(const F& f,
            S&... s) { f(s.store...); f(s.sums...); f(s.halves...); f(s.volume...); f(s.image...); }
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

#line 85 "pipeline.cpp"
Wide<float> next_float_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, Wide<Photon>& state);

#line 39 "shader.py"
void raygen_store_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask) {
    const Params& params = oxrt::launchParams<Params>(thread);
#line 40 "shader.py"
    Wide<oxrt::uint3> i = oxrt::getLaunchIndex(thread);
    Wide<uint32_t> slot = oxrt::mapActive(oxrt::checked(thread, mask).inside(params.store.count, 0),
            [&]([[maybe_unused]] int lane) { return oxrt::atomicAdd(oxrt::inLane(params.store.count, lane).at(oxrt::inLane(0, lane)),
            oxrt::inLane(1u, lane)); });
#line 42 "shader.py"
    Photon photon = Photon{oxrt::float3(1.0f), oxrt::float3(0.5f), uint8_t(3u)};
    float result_ = next_float(photon);
#line 43 "shader.py"
    float result_2 = next_float(photon);
#line 43 "shader.py"
    oxrt::float2 uv = oxrt::float2(result_, result_2);
    const Mask test = oxrt::convert<int32_t>(slot) < int32_t(params.store.photons.shape[0]);
#line 44 "shader.py"
    Mask mask_ = mask & test;
#line 44 "shader.py"
    if (oxrt::any(mask_)) {
        oxrt::checked(thread, mask_).store(oxrt::spread<16>(photon), params.store.photons, slot);
        oxrt::eachElement<LANES>(oxrt::checked(thread, mask_).inside(params.store.photons, slot), [&,
                value = Wide<uint32_t>(uint32_t(oxrt::checkedCommon(thread, mask_).load(params.store.photons,
                0).flags) + 1u)](auto& element, int lane) { oxrt::extractLane(element.flags, value, lane); }, params.store.photons, slot);
#line 47 "shader.py"
        oxrt::eachElement<LANES>(oxrt::checked(thread, mask_).inside(params.store.photons, slot), [&,
                value = Wide<float>(2.0f)](auto& element, int lane) { oxrt::extractLane(element.power.y, value, lane); },
                params.store.photons, slot);
    }
#line 48 "shader.py"
    oxrt::eachLane(oxrt::checked(thread, mask).inside(params.sums, slot),
            [&]([[maybe_unused]] int lane) { oxrt::atomicMax(oxrt::inLane(params.sums, lane).at(oxrt::inLane(slot, lane)),
            oxrt::inLane(uv.x, lane)); });
#line 49 "shader.py"
    oxrt::float4 texel = oxrt::tex2d(*thread.thread, params.image, uv.x, uv.y);
    oxrt::checked(thread, mask).store(Wide<oxrt::float4>(oxrt::float4(float(oxrt::half(texel.x)), float(oxrt::half(texel.y)),
            float(oxrt::half(texel.z)), float(oxrt::half(texel.w)))), params.halves, i.y, i.x);
#line 51 "shader.py"
    oxrt::checked(thread, mask).store(Wide<uint32_t>(oxrt::convert<uint32_t>(texel.x)), params.volume, i.z, i.y, i.x);
    Photon copied = photon;
    copied.power = oxrt::swizzle<0, 1, 2>(oxrt::convert<float>(oxrt::checkedCommon(thread, mask).load(params.halves, 0, 0)));
    oxrt::checked(thread, mask).store(oxrt::spread<16>(copied), params.store.photons, 0);
}

#line 33 "shader.py"
Wide<float> next_float_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, Wide<Photon>& state) {
    oxrt::assign(mask, state.position.x, state.position.x + 0.5f);
    return state.position.x;
}

#line 138 "pipeline.cpp"
// Items that a helper changes, by indices that differ and that do not; parts of storage vectors; shifts of literals.
#line 58 "shader.py"
void raygen_items_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask) {
    const Params& params = oxrt::launchParams<Params>(thread);
    Wide<uint32_t> i = oxrt::getLaunchIndex(thread).x;
    Wide<oxrt::FixedArray<Photon, 2>> photons = oxrt::spread<16>(oxrt::FixedArray<Photon, 2>{});
    Wide<oxrt::FixedArray<oxrt::FixedArray<uint32_t, 2>, 4>> grid = oxrt::spread<16>(oxrt::FixedArray<oxrt::FixedArray<uint32_t, 2>, 4>{});
    oxrt::eachItem(mask, grid, i & 3u, [&, value = oxrt::shiftLeft(1u, i & 31u)](auto& item, Mask own) { oxrt::eachItem(own, item,
            (i >> 2u) & 1u, [&](auto& item_2, Mask own_2) { oxrt::assign(own_2, item_2, value); }); });
#line 64 "shader.py"
    Wide<float> result_{};
#line 64 "shader.py"
    oxrt::eachItem(mask, photons, i & 1u, [&](auto& item, Mask own) { oxrt::assign(own, result_, next_float_lanes(thread, own, item)); });
#line 64 "shader.py"
    Wide<float> result_2 = next_float_lanes(thread, mask, photons[0]);
#line 64 "shader.py"
    Wide<float> x = result_ + result_2;
    photons[1].flags = oxrt::convert<uint8_t>(oxrt::loadItem<LANES>(grid[2], i & 1u) & 4294967291u);
    oxrt::eachElement<LANES>(oxrt::checked(thread, mask).inside(params.halves, 0, i), [&, value = x](auto& element,
            int lane) { oxrt::extractLane(element.y, value, lane); }, params.halves, 0, i);
#line 67 "shader.py"
    oxrt::checked(thread, mask).store(oxrt::loadItem<LANES>(photons, i & 1u).position.x, params.sums, i);
}

#line 163 "pipeline.cpp"
void run_raygen_store(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::runBlocks<LANES>(*thread, *tile, [](Lanes& lanes, Mask mask) {
        raygen_store_lanes(lanes, mask);
    });
}

void run_raygen_items(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::runBlocks<LANES>(*thread, *tile, [](Lanes& lanes, Mask mask) {
        raygen_items_lanes(lanes, mask);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__store", OXRT_KIND_RAYGEN, 0, run_raygen_store},
    {"__raygen__items", OXRT_KIND_RAYGEN, 0, run_raygen_items},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 16, programs, 2}};
static_assert(sizeof(Params) == 112);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 112, 1, "0.1.0"};
