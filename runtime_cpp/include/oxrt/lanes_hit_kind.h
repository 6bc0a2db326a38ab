/* What was hit, and from which side: device_ray.h for lanes. */
#ifndef OXRT_LANES_HIT_KIND_H
#define OXRT_LANES_HIT_KIND_H

#include <oxrt/lanes_ray.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* Which side of a triangle with this normal each ray meets, both in object space: see isFrontFacing of scalars. */
template <int W>
OXRT_INLINE Lanes<uint32_t, W> triangleKind(const RayLanes<W>& ray, const Wide<float3, W>& normal, const Wide<float3, W>& direction) {
    const Lanes<float, W> cosine = normal.x * direction.x + normal.y * direction.y + normal.z * direction.z;
    const Lanes<uint32_t, W> isBack = select(cosine < 0.0f, Lanes<uint32_t, W>(0u), Lanes<uint32_t, W>(1u));
    const Lanes<uint32_t, W> flags = instanceField<uint32_t>(ray, OXRT_FIELD_OFFSET(OxrtInstanceView, flags), 0u);
    static_assert(INSTANCE_FLIP_FACING == 2 && HIT_KIND_TRIANGLE_BACK_FACE == HIT_KIND_TRIANGLE_FRONT_FACE + 1);
    return uint32_t(HIT_KIND_TRIANGLE_FRONT_FACE) | (isBack ^ ((flags >> 1u) & 1u));
}
template <int W> OXRT_INLINE Lanes<uint32_t, W> getHitKind(const RayLanes<W>& ray) {
    if (ray.paths || (ray.root->needs & (OXRT_SCENE_HAS_CURVES | OXRT_SCENE_HAS_SPHERES)))
        return mapHits(ray, [](const Ray& one, int) { return getHitKind(one); });
    const auto& hit = ray.packet.hit;
    const Wide<float3, W> normal = {packetLanes<W>(hit.Ng_x), packetLanes<W>(hit.Ng_y), packetLanes<W>(hit.Ng_z)};
    Lanes<bool, W> triangles = ray.active;
    if (ray.root->needs & OXRT_SCENE_HAS_CUSTOM)
        triangles &= geometryType(ray) == uint32_t(OXRT_PRIMITIVE_TRIANGLE);
    const Lanes<uint32_t, W> kind = triangleKind(ray, normal, transformVectorFromWorldToObjectSpace(ray, getWorldRayDirection(ray)));
    return select(ray.active, select(triangles, kind, ray.kind), 0u);
}
template <int W> OXRT_INLINE Lanes<bool, W> isTriangleHit(const RayLanes<W>& ray) { return getHitKind(ray) >= uint32_t(HIT_KIND_TRIANGLE_FRONT_FACE); }
template <int W> OXRT_INLINE Lanes<bool, W> isTriangleFrontFaceHit(const RayLanes<W>& ray) {
    return getHitKind(ray) == uint32_t(HIT_KIND_TRIANGLE_FRONT_FACE);
}
template <int W> OXRT_INLINE Lanes<bool, W> isTriangleBackFaceHit(const RayLanes<W>& ray) {
    return getHitKind(ray) == uint32_t(HIT_KIND_TRIANGLE_BACK_FACE);
}
template <int W> OXRT_INLINE Lanes<bool, W> isBackFaceHit(const RayLanes<W>& ray) { return ray.active & ((getHitKind(ray) & 1u) != 0u); }
template <int W> OXRT_INLINE Lanes<bool, W> isFrontFaceHit(const RayLanes<W>& ray) { return ray.active & ((getHitKind(ray) & 1u) == 0u); }

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
