/* Hit objects that a program makes: from the data of an earlier traversal, or from numbers.
 *
 * The way to the hit is told again, by the handles of its transforms, since scenes may change between launches; what does not lead to a
 * primitive makes a nop (a fault in validation).
 */
#ifndef OXRT_DEVICE_MAKE_HIT_H
#define OXRT_DEVICE_MAKE_HIT_H

#include <oxrt/device_handles.h>
#include <oxrt/device_hit_object.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* A hit as words that can be stored: OptiX's OptixTraverseData, opaque to programs. */
using TraverseData = FixedArray<uint32_t, 20>;

/* What the words are. */
struct TraverseWords {
    uint32_t isHit;
    uint32_t geometry; /* index in its GAS */
    uint32_t primitive, instance, recordIndex, kind;
    float t, u, v;
    float3 normal;
    uint32_t attributes[8];
};
static_assert(sizeof(TraverseWords) == sizeof(TraverseData));

inline __attribute__((noinline)) TraverseData hitObjectGetTraverseData(const HitObject& object) {
    TraverseWords words = {};
    if (hitObjectIsHit(object)) {
        const Ray& ray = object.ray;
        words = {1, uint32_t(ray.geometry - holderOf(ray).geometries), ray.primitive, getInstanceIndex(ray), object.recordIndex, getHitKind(ray), ray.t,
                 ray.u, ray.v, ray.normal, {}};
        if (isCustomGeometry(ray))
            __builtin_memcpy(words.attributes, ray.attributes, sizeof(words.attributes));
    }
    TraverseData data;
    __builtin_memcpy(&data, &words, sizeof(data));
    return data;
}

/* ---- the way to the hit -------------------------------------------------------------------------------------------------------------- */

/* Follows the transforms from the root of a graph; false where they do not lead to a GAS. */
inline __attribute__((noinline)) bool followPath(Ray& ray, GraphPath& path, const uint64_t* transforms, uint32_t count) {
    path.native = nullptr;
    path.instance = nullptr;
    path.instanceIndex = 0;
    path.sbtOffset = 0;
    path.size = 0;
    const OxrtTraversableView* view = ray.root;
    uint32_t next = 0;
    while (view && path.size < MAX_PATH_NODES) {
        if (view->type == OXRT_TRAVERSABLE_GAS || view->type == OXRT_TRAVERSABLE_IAS) {
            path.structure = view;
            if (view->type == OXRT_TRAVERSABLE_GAS)
                return true;
            const OxrtInstanceView* instance = next < count ? findInstance(*ray.thread, transforms[next++]) : nullptr;
            if (!instance || instance < view->instances || instance >= view->instances + view->instanceCount || !instance->child)
                return false;
            if (view->hasNativeInstances) {
                path.native = instance;
                return true;
            }
            path.instance = instance;
            path.instanceIndex = uint32_t(instance - view->instances);
            path.sbtOffset += instance->sbtOffset;
            path.nodes[path.size++] = view->instanceTraversables + path.instanceIndex;
            view = instance->child;
        } else {
            path.nodes[path.size++] = view;
            view = view->child;
            ++next;
        }
    }
    return false;
}

/* Enters the way from the ray's root to the primitive. */
OXRT_INLINE bool enterPath(Ray& ray, GraphPath& path, const uint64_t* transforms, uint32_t count, uint32_t instance) {
    ray.path = nullptr;
    ray.instance = nullptr;
    if (!ray.root)
        return false;
    if (isGraph(*ray.root)) {
        if (!followPath(ray, path, transforms, count))
            return false;
        const OxrtInstanceView* native = path.native;
        path.native = nullptr;
        path.direction = path.size == 0 ? ray.direction : transformVector(worldToObjectAlong(path, ray.time).m, ray.direction);
        path.native = native;
        ray.path = &path;
        ray.instance = native ? native : path.instance;
        return true;
    }
    if (ray.root->type != OXRT_TRAVERSABLE_IAS)
        return ray.root->type == OXRT_TRAVERSABLE_GAS;
    if (instance >= ray.root->instanceCount || !ray.root->instances[instance].child)
        return false;
    ray.instance = ray.root->instances + instance;
    return true;
}

/* The build input of the hit that holds an SBT GAS index, null if there is none. */
OXRT_INLINE const OxrtGeometry* geometryOfRecord(const OxrtTraversableView& gas, uint32_t sbtGasIndex) {
    for (uint32_t i = 0; i < gas.geometryCount; ++i)
        if (sbtGasIndex >= gas.geometries[i].recordBase && sbtGasIndex - gas.geometries[i].recordBase < gas.geometries[i].recordCount)
            return gas.geometries + i;
    return nullptr;
}

/* Which side of a triangle was hit is told, not computed: where its normal says otherwise, one that agrees. */
OXRT_INLINE void turnTowards(Ray& ray, uint32_t hitKind) {
    if (getHitKind(ray) == hitKind)
        return;
    ray.normal = objectDirection(ray);
    if (getHitKind(ray) != hitKind)
        ray.normal = -ray.normal;
}

/* ---- making ---------------------------------------------------------------------------------------------------------------------------- */

OXRT_INLINE void beginHit(HitObject& object, uint64_t handle, const float3& origin, const float3& direction, float tmin, float time, uint32_t flags) {
    Ray& ray = object.ray;
    object.kind = HitObject::Kind::Nop;
    ray.thread = object.thread;
    ray.root = findTraversable(*object.thread->launch, handle);
    ray.origin = origin;
    ray.direction = direction;
    ray.tmin = tmin;
    ray.time = time;
    ray.flags = flags & 0xFFFF;
    ray.mask = 0xFF;
    ray.sbtOffset = ray.missIndex = 0;
    ray.sbtStride = 1;
}

inline constexpr const char* NO_SUCH_HIT = "make_hit_object: the handle, transforms and indices lead to no primitive";

/* Makes the object a hit if what was said of it is true. */
OXRT_INLINE void endHit(HitObject& object, bool isThere, Place place) {
    if (isThere)
        object.kind = HitObject::Kind::Hit;
    else if (object.thread->launch->validation)
        fault(*object.thread, OXRT_FAULT_DATA_ACCESS, NO_SUCH_HIT, place);
}

/* `transforms`: the first `count` handles of the transform list, outermost first. */
template <int SIZE>
void makeHitObject(HitObject& object, uint64_t handle, const float3& origin, const float3& direction, float tmin, float time, uint32_t flags,
                   const TraverseData& data, const FixedArray<uint64_t, SIZE>& transforms, uint32_t count, Place place = Place::current()) {
    TraverseWords words;
    __builtin_memcpy(&words, &data, sizeof(words));
    beginHit(object, handle, origin, direction, tmin, time, flags);
    Ray& ray = object.ray;
    bool isThere = words.isHit && enterPath(ray, object.path, transforms.items, count < SIZE ? count : SIZE, words.instance);
    isThere = isThere && words.geometry < holderOf(ray).geometryCount;
    if (isThere) {
        ray.geometry = holderOf(ray).geometries + words.geometry;
        isThere = words.primitive < ray.geometry->primitiveCount;
    }
    ray.normal = words.normal;
    if (isThere && isTriangleGeometry(ray))
        turnTowards(ray, words.kind);
    ray.primitive = words.primitive;
    ray.t = ray.tmax = words.t;
    ray.u = words.u;
    ray.v = words.v;
    ray.kind = words.kind;
    __builtin_memcpy(ray.committedAttributes, words.attributes, sizeof(ray.committedAttributes));
    ray.attributes = ray.committedAttributes;
    object.recordIndex = words.recordIndex;
    endHit(object, isThere, place);
}

/* The hit of given numbers; false if there is no such primitive. Its record is left open. */
inline __attribute__((noinline)) bool enterNumbers(HitObject& object, const uint64_t* transforms, uint32_t count, uint32_t instance,
                                                   uint32_t sbtGasIndex, uint32_t primitive, uint32_t hitKind, float t,
                                                   const uint32_t* attributes) {
    Ray& ray = object.ray;
    if (!enterPath(ray, object.path, transforms, count, instance))
        return false;
    const OxrtTraversableView& gas = holderOf(ray);
    ray.geometry = geometryOfRecord(gas, sbtGasIndex);
    if (!ray.geometry || primitive - ray.geometry->primitiveIndexOffset >= ray.geometry->primitiveCount)
        return false;
    ray.primitive = primitive - ray.geometry->primitiveIndexOffset;
    ray.t = ray.tmax = t;
    ray.u = uintAsFloat(attributes[0]);
    ray.v = uintAsFloat(attributes[1]);
    ray.kind = hitKind;
    __builtin_memcpy(ray.committedAttributes, attributes, sizeof(ray.committedAttributes));
    ray.attributes = ray.committedAttributes;
    ray.normal = {0.0f, 0.0f, 0.0f};
    if (isTriangleGeometry(ray)) {
        const TriangleVertices corners = getTriangleVertexData(ray);
        ray.normal = cross(get<1>(corners) - get<0>(corners), get<2>(corners) - get<0>(corners));
        turnTowards(ray, hitKind);
    }
    return true;
}

/* OptiX 8's forms: from numbers, the record by the formula or (WithRecord) by its index. */
template <int SIZE>
void makeHitObject(HitObject& object, uint64_t handle, const float3& origin, const float3& direction, float tmin, float t, float time,
                   uint32_t sbtOffset, uint32_t sbtStride, uint32_t instance, const FixedArray<uint64_t, SIZE>& transforms, uint32_t count,
                   uint32_t sbtGasIndex, uint32_t primitive, uint32_t hitKind, uint32_t a0, uint32_t a1, uint32_t a2, uint32_t a3, uint32_t a4,
                   uint32_t a5, uint32_t a6, uint32_t a7, Place place = Place::current()) {
    const uint32_t attributes[8] = {a0, a1, a2, a3, a4, a5, a6, a7};
    beginHit(object, handle, origin, direction, tmin, time, 0);
    const bool isThere = enterNumbers(object, transforms.items, count < SIZE ? count : SIZE, instance, sbtGasIndex, primitive, hitKind, t, attributes);
    if (isThere)
        object.recordIndex = instanceSbtOffset(object.ray) + sbtGasIndex * (sbtStride & 15) + (sbtOffset & 15);
    endHit(object, isThere, place);
}
OXRT_INLINE void makeHitObject(HitObject& object, uint64_t handle, const float3& origin, const float3& direction, float tmin, float t, float time,
                               uint32_t sbtOffset, uint32_t sbtStride, uint32_t instance, uint32_t sbtGasIndex, uint32_t primitive,
                               uint32_t hitKind, uint32_t a0, uint32_t a1, uint32_t a2, uint32_t a3, uint32_t a4, uint32_t a5, uint32_t a6,
                               uint32_t a7, Place place = Place::current()) {
    /* Without transforms only scenes of one level are meant: there the index of the instance says it all. */
    const FixedArray<uint64_t, 1> none = {};
    makeHitObject(object, handle, origin, direction, tmin, t, time, sbtOffset, sbtStride, instance, none, 0, sbtGasIndex, primitive, hitKind, a0, a1,
                  a2, a3, a4, a5, a6, a7, place);
}
template <int SIZE>
void makeHitObjectWithRecord(HitObject& object, uint64_t handle, const float3& origin, const float3& direction, float tmin, float t, float time,
                             uint32_t recordIndex, uint32_t instance, const FixedArray<uint64_t, SIZE>& transforms, uint32_t count,
                             uint32_t sbtGasIndex, uint32_t primitive, uint32_t hitKind, uint32_t a0, uint32_t a1, uint32_t a2, uint32_t a3,
                             uint32_t a4, uint32_t a5, uint32_t a6, uint32_t a7, Place place = Place::current()) {
    makeHitObject(object, handle, origin, direction, tmin, t, time, 0, 0, instance, transforms, count, sbtGasIndex, primitive, hitKind, a0, a1, a2, a3,
                  a4, a5, a6, a7, place);
    object.recordIndex = recordIndex;
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
