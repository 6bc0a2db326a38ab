/* Opacity micromaps over lanes: what device_opacity.h does for one candidate. */
#ifndef OXRT_LANES_OPACITY_H
#define OXRT_LANES_OPACITY_H

#include <oxrt/device_opacity.h>
#include <oxrt/lanes_ray.h>

namespace oxrt {
inline namespace OXRT_ISA {

template <int W> OXRT_INLINE Lanes<int32_t, W> wholePart(Lanes<float, W> x) { return convert<int32_t>(x); }

/* Where the micromaps of the lanes' primitives are, the states of lanes, the words of lanes; of one geometry or of several. */
template <int W> struct CommonMicromaps {
    const OxrtGeometry& geometry;
    OXRT_INLINE auto maps(Lanes<uint32_t, W> primitive) const {
        return placesIn<OxrtMicromapView, W>(geometry.opacityMicromaps, primitive);
    }
    OXRT_INLINE auto states(Lanes<uint32_t, W> word) const { return placesIn<uint32_t, W>(geometry.micromapStates, word); }
};
template <int W> struct MicromapLanes {
    Lanes<uint64_t, W> opacityMicromaps, micromapStates;
    OXRT_INLINE AddressPlaces<W> maps(Lanes<uint32_t, W> primitive) const {
        return {opacityMicromaps + convert<uint64_t>(primitive) * uint64_t(sizeof(OxrtMicromapView))};
    }
    OXRT_INLINE AddressPlaces<W> states(Lanes<uint32_t, W> word) const { return {micromapStates + convert<uint64_t>(word) * uint64_t(4)}; }
};

/* OXRT_OPACITY_...: of the points of the primitives that were hit. */
template <class Micromaps, int W>
OXRT_INLINE Lanes<uint32_t, W> opacityAt(const Micromaps& micromaps, const RayLanes<W>& ray, Lanes<bool, W> mask) {
    const auto& hit = ray.packet.hit;
    const auto maps = micromaps.maps(packetLanes<W>(hit.primID));
    const Lanes<uint32_t, W> firstWord = gather<uint32_t, W>(maps, OXRT_FIELD_OFFSET(OxrtMicromapView, firstWord), mask);
    const Lanes<uint32_t, W> shape = gather<uint32_t, W>(maps, OXRT_FIELD_OFFSET(OxrtMicromapView, shape), mask);
    const Lanes<uint32_t, W> isFourState = shape & 1u;
    const Lanes<uint32_t, W> bit = micromapIndex(packetLanes<W>(hit.u), packetLanes<W>(hit.v), uintAsFloat(shape & ~1u)) << isFourState;
    const Lanes<uint32_t, W> word = gather<uint32_t, W>(micromaps.states(firstWord + (bit >> 5u)), 0, mask);
    return (word >> (bit & 31u)) & (1u + (isFourState << 1u));
}

/* The lanes of the mask whose candidates are not transparent. In the flag words of their records the states decide about any-hit
   programs. */
template <int W>
OXRT_INLINE Lanes<bool, W> passesMicromaps(const RayLanes<W>& ray, Lanes<bool, W> mask, Lanes<uint32_t, W> instanceFlags,
                                           Lanes<uint32_t, W>& geometryFlags) {
    const Lanes<uint64_t, W> maps = OXRT_GEOMETRY_FIELD(uint64_t, ray, opacityMicromaps);
    const Lanes<bool, W> asked = mask & (maps != uint64_t(0)) & ((instanceFlags & INSTANCE_DISABLE_MICROMAPS) == 0u);
    if (none(asked))
        return mask;
    Lanes<uint32_t, W> state;
    if (ray.commonGeometry)
        state = opacityAt(CommonMicromaps<W>{*ray.commonGeometry}, ray, asked);
    else
        state = opacityAt(MicromapLanes<W>{maps, OXRT_GEOMETRY_FIELD(uint64_t, ray, micromapStates)}, ray, asked);
    const bool isForcedByRay = ray.flags & RAY_FORCE_MICROMAP_2_STATE;
    const Lanes<bool, W> isForced = ((instanceFlags & INSTANCE_FORCE_MICROMAP_2_STATE) != 0u) | isForcedByRay;
    state = select(isForced, state & 1u, state);
    const Lanes<uint32_t, W> enabled = geometryFlags & ~uint32_t(GEOMETRY_DISABLE_ANYHIT);
    const Lanes<bool, W> isOpaque = state == uint32_t(OXRT_OPACITY_OPAQUE);
    geometryFlags = select(asked, select(isOpaque, enabled | GEOMETRY_DISABLE_ANYHIT, enabled), geometryFlags);
    return without(mask, asked & (state == uint32_t(OXRT_OPACITY_TRANSPARENT)));
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
