/* Opacity micromaps: which part of a triangle a point lies in, and how opaque that part is. */
#ifndef OXRT_DEVICE_OPACITY_H
#define OXRT_DEVICE_OPACITY_H

#include <oxrt/device_ray.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* Bit i of the result: the parity of the bits i and above. */
OXRT_INLINE constexpr uint32_t parityAbove(uint32_t x) {
    x ^= x >> 1;
    x ^= x >> 2;
    x ^= x >> 4;
    return x ^ x >> 8;
}
/* The low 12 bits, each followed by a zero. */
OXRT_INLINE constexpr uint32_t spreadBits(uint32_t x) {
    x = (x | x << 8) & 0x00FF00FF;
    x = (x | x << 4) & 0x0F0F0F0F;
    x = (x | x << 2) & 0x33333333;
    return (x | x << 1) & 0x55555555;
}

/* The micro-triangle that holds a point, in the order of the micromap curve: the inverse of what the OptiX header
   micromap/optix_micromap_impl.h does from index to corners. Points on the long side belong to the lower micro-triangle of their square. */
OXRT_INLINE constexpr uint32_t micromapIndex(float u, float v, uint32_t level) {
    const uint32_t last = (1u << level) - 1;
    const float scale = float(1u << level);
    const float scaledU = u > 0.0f ? u * scale : 0.0f;
    const float scaledV = v > 0.0f ? v * scale : 0.0f;
    uint32_t iu = scaledU < float(last) ? uint32_t(scaledU) : last;
    uint32_t iv = scaledV < float(last) ? uint32_t(scaledV) : last;
    while (iu + iv > last)
        --(iu > iv ? iu : iv);
    const float partU = scaledU - float(iu);
    const float partV = scaledV - float(iv);
    uint32_t iw = ~(iu + iv) & last;
    if (partU + partV > 1.0f && iu + iv < last)
        iw = (iw - 1) & last;
    const uint32_t b0 = ~(iu ^ iw) & last;
    const uint32_t t = (iu ^ iv) & b0;
    const uint32_t b1 = (((parityAbove(t) ^ iu) & ~b0) | t) & last;
    return spreadBits(b0) | spreadBits(b1) << 1;
}

/* OXRT_OPACITY_...: of the point of the triangle. */
OXRT_INLINE uint32_t opacityAt(const OxrtMicromapView& map, float u, float v) {
    if (!map.states)
        return map.state;
    const uint32_t index = micromapIndex(u, v, map.level);
    if (map.isFourState)
        return map.states[index >> 2] >> (2 * (index & 3)) & 3;
    return map.states[index >> 3] >> (index & 7) & 1;
}

/* What micromaps make of a candidate: false where it is transparent; else its geometry flags, in which the state decides about any-hit
   programs. */
OXRT_INLINE bool passesMicromap(const Ray& ray, uint32_t instanceFlags, uint32_t& geometryFlags) {
    if (!ray.geometry->opacityMicromaps || (instanceFlags & INSTANCE_DISABLE_MICROMAPS))
        return true;
    uint32_t state = opacityAt(ray.geometry->opacityMicromaps[ray.primitive], ray.u, ray.v);
    if ((instanceFlags & INSTANCE_FORCE_MICROMAP_2_STATE) || (ray.flags & RAY_FORCE_MICROMAP_2_STATE))
        state &= 1;
    geometryFlags = state == OXRT_OPACITY_OPAQUE ? geometryFlags | GEOMETRY_DISABLE_ANYHIT : geometryFlags & ~uint32_t(GEOMETRY_DISABLE_ANYHIT);
    return state != OXRT_OPACITY_TRANSPARENT;
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
