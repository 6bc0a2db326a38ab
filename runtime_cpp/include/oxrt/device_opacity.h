/* Opacity micromaps: which part of a triangle a point lies in, and how opaque that part is. */
#ifndef OXRT_DEVICE_OPACITY_H
#define OXRT_DEVICE_OPACITY_H

#include <oxrt/device_ray.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* Of a small number that is not negative. */
OXRT_INLINE int32_t wholePart(float x) { return int32_t(x); }

/* The micro-triangle that holds a point: its place in OxrtMicromapView's order. Points on the long side belong to the lower micro-triangle
   of their square. `side` is 2^level. For a number and for lanes. */
template <class F> OXRT_INLINE auto micromapIndex(F u, F v, F side) {
    const F scaledU = u * side;
    const F scaledV = v * side;
    const auto count = wholePart(side);
    auto iu = wholePart(scaledU);
    auto iv = wholePart(scaledV);
    const auto isUpper = (scaledU - convert<float>(iu)) + (scaledV - convert<float>(iv)) > 1.0f;
    /* u + v is 1 at most, but for rounding; on the long side the sum is one too large */
    const auto isOver = iu + iv >= count;
    const auto isNearU = iu > iv;
    iu = select(isOver & isNearU, iu - 1, iu);
    iv = select(isOver & !isNearU, iv - 1, iv);
    const auto index = iv * (2 * count - iv) + 2 * iu;
    /* the last square of a row has a lower micro-triangle only; what is no number must not lead out of the micromap */
    return convert<uint32_t>(select(isUpper & (iu + iv < count - 1), index + 1, index) & (count * count - 1));
}

/* OXRT_OPACITY_...: of the point of the primitive. */
OXRT_INLINE uint32_t opacityAt(const OxrtGeometry& geometry, uint32_t primitive, float u, float v) {
    const OxrtMicromapView& map = geometry.opacityMicromaps[primitive];
    const uint32_t isFourState = map.shape & 1;
    const uint32_t bit = micromapIndex(u, v, uintAsFloat(map.shape & ~1u)) << isFourState;
    return geometry.micromapStates[map.firstWord + (bit >> 5)] >> (bit & 31) & (1 + 2 * isFourState);
}

/* What micromaps make of a candidate: false where it is transparent; else its geometry flags, in which the state decides about any-hit
   programs. */
OXRT_INLINE bool passesMicromap(const Ray& ray, uint32_t instanceFlags, uint32_t& geometryFlags) {
    if (!ray.geometry->opacityMicromaps || (instanceFlags & INSTANCE_DISABLE_MICROMAPS))
        return true;
    uint32_t state = opacityAt(*ray.geometry, ray.primitive, ray.u, ray.v);
    if ((instanceFlags & INSTANCE_FORCE_MICROMAP_2_STATE) || (ray.flags & RAY_FORCE_MICROMAP_2_STATE))
        state &= 1;
    geometryFlags = state == OXRT_OPACITY_OPAQUE ? geometryFlags | GEOMETRY_DISABLE_ANYHIT : geometryFlags & ~uint32_t(GEOMETRY_DISABLE_ANYHIT);
    return state != OXRT_OPACITY_TRANSPARENT;
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
