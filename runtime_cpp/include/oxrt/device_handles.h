/* What a handle names, asked without a ray: instances and transforms, corners of primitives, motion options. */
#ifndef OXRT_DEVICE_HANDLES_H
#define OXRT_DEVICE_HANDLES_H

#include <oxrt/device_trace.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* OptiX's OptixTransformType; 0 for structures and for handles that name nothing. */
OXRT_INLINE uint32_t getTransformTypeFromHandle(const OxrtThread& thread, uint64_t handle) {
    const OxrtTraversableView* view = findTraversable(*thread.launch, handle);
    if (!view)
        return 0;
    switch (view->type) {
    case OXRT_TRAVERSABLE_STATIC: return 1;
    case OXRT_TRAVERSABLE_MATRIX_MOTION: return 2;
    case OXRT_TRAVERSABLE_SRT_MOTION: return 3;
    case OXRT_TRAVERSABLE_INSTANCE: return 4;
    default: return 0;
    }
}

/* Of validated launches: whether the structure was built for questions by handle, and holds what is asked for. */
__attribute__((noinline, cold, unused)) static void checkAccess(OxrtThread& thread, const OxrtTraversableView& view, uint32_t flag, uint32_t index,
                                                                uint32_t count, Place place) {
    if (!(view.buildFlags & flag))
        fault(thread, OXRT_FAULT_DATA_ACCESS,
              flag == OXRT_BUILD_ALLOWS_VERTEX_ACCESS ? "the structure was built without BuildFlags.ALLOW_RANDOM_VERTEX_ACCESS"
                                                      : "the structure was built without BuildFlags.ALLOW_RANDOM_INSTANCE_ACCESS",
              place);
    else if (index >= count)
        faultWithValues(thread, OXRT_FAULT_DATA_ACCESS, "index \1 is not below the number of primitives or instances, \1", place, index, count);
}

/* The instance that the handle names, null if it names something else. */
OXRT_INLINE const OxrtInstanceView* findInstance(const OxrtThread& thread, uint64_t handle) {
    const OxrtTraversableView* view = findTraversable(*thread.launch, handle);
    return view && view->type == OXRT_TRAVERSABLE_INSTANCE ? view->instances : nullptr;
}
OXRT_INLINE uint32_t getInstanceIdFromHandle(const OxrtThread& thread, uint64_t handle) {
    const OxrtInstanceView* instance = findInstance(thread, handle);
    return instance ? instance->instanceId : 0;
}
OXRT_INLINE uint64_t getInstanceChildFromHandle(const OxrtThread& thread, uint64_t handle) {
    const OxrtInstanceView* instance = findInstance(thread, handle);
    return instance && instance->child ? instance->child->handle : 0;
}
OXRT_INLINE float3x4 getInstanceTransformFromHandle(const OxrtThread& thread, uint64_t handle) {
    const OxrtInstanceView* instance = findInstance(thread, handle);
    return instance ? matrixFrom(instance->objectToWorld) : float3x4{};
}
OXRT_INLINE float3x4 getInstanceInverseTransformFromHandle(const OxrtThread& thread, uint64_t handle) {
    const OxrtInstanceView* instance = findInstance(thread, handle);
    return instance ? matrixFrom(instance->worldToObject) : float3x4{};
}
OXRT_INLINE uint64_t getInstanceTraversableFromIAS(OxrtThread& thread, uint64_t handle, uint32_t index, Place place = Place::current()) {
    const OxrtTraversableView* view = findTraversable(*thread.launch, handle);
    if (!view || view->type != OXRT_TRAVERSABLE_IAS)
        return 0;
    if (thread.launch->validation)
        checkAccess(thread, *view, OXRT_BUILD_ALLOWS_INSTANCE_ACCESS, index, view->instanceCount, place);
    return index < view->instanceCount ? view->instances[index].handle : 0;
}

/* ---- transforms ------------------------------------------------------------------------------------------------------------------- */

OXRT_INLINE const OxrtTraversableView* findTransform(const OxrtThread& thread, uint64_t handle, uint32_t type) {
    const OxrtTraversableView* view = findTraversable(*thread.launch, handle);
    return view && view->type == type ? view : nullptr;
}

OXRT_INLINE Tuple<uint64_t, float3x4, float3x4> getStaticTransformFromHandle(const OxrtThread& thread, uint64_t handle) {
    const OxrtTraversableView* view = findTransform(thread, handle, OXRT_TRAVERSABLE_STATIC);
    if (!view)
        return makeTuple(uint64_t(0), float3x4{}, float3x4{});
    return makeTuple(view->child->handle, matrixFrom(view->transformKeys), matrixFrom(view->transformKeys + 12));
}

/* Child, number of keys, flags, begin, end, and a key; the last one where `key` is too large. */
template <class Key> using MotionTransformData = Tuple<uint64_t, uint32_t, uint32_t, float, float, Key>;
template <class Key> OXRT_INLINE MotionTransformData<Key> motionTransformData(const OxrtTraversableView* view, uint32_t key) {
    Key numbers = {};
    if (!view)
        return makeTuple(uint64_t(0), 0u, 0u, 0.0f, 0.0f, numbers);
    const uint32_t last = view->keyCount - 1;
    __builtin_memcpy(&numbers, view->transformKeys + uint64_t(key < last ? key : last) * (sizeof(Key) / sizeof(float)), sizeof(Key));
    return makeTuple(view->child->handle, view->keyCount, view->motionFlags, view->timeBegin, view->timeEnd, numbers);
}
OXRT_INLINE MotionTransformData<float3x4> getMatrixMotionTransformFromHandle(const OxrtThread& thread, uint64_t handle, uint32_t key) {
    return motionTransformData<float3x4>(findTransform(thread, handle, OXRT_TRAVERSABLE_MATRIX_MOTION), key);
}
/* The key in OptiX's order: sx a b pvx sy c pvy sz pvz qx qy qz qw tx ty tz. */
OXRT_INLINE MotionTransformData<float4x4> getSRTMotionTransformFromHandle(const OxrtThread& thread, uint64_t handle, uint32_t key) {
    return motionTransformData<float4x4>(findTransform(thread, handle, OXRT_TRAVERSABLE_SRT_MOTION), key);
}

/* ---- geometry --------------------------------------------------------------------------------------------------------------------- */

/* What the structure is kept under in memory, 0 of other handles: no two that are alive have the same. */
OXRT_INLINE uint64_t getGASPointerFromHandle(const OxrtThread& thread, uint64_t gas) {
    const OxrtTraversableView* view = findTraversable(*thread.launch, gas);
    return view && view->type == OXRT_TRAVERSABLE_GAS ? reinterpret_cast<uint64_t>(view) : 0;
}

/* The motion options of the build; a static structure has none: zeros. */
OXRT_INLINE float getGASMotionTimeBegin(const OxrtThread& thread, uint64_t gas) {
    const OxrtTraversableView* view = findTraversable(*thread.launch, gas);
    return view && view->keyCount > 1 ? view->timeBegin : 0.0f;
}
OXRT_INLINE float getGASMotionTimeEnd(const OxrtThread& thread, uint64_t gas) {
    const OxrtTraversableView* view = findTraversable(*thread.launch, gas);
    return view && view->keyCount > 1 ? view->timeEnd : 0.0f;
}
OXRT_INLINE uint32_t getGASMotionStepCount(const OxrtThread& thread, uint64_t gas) {
    const OxrtTraversableView* view = findTraversable(*thread.launch, gas);
    return view && view->keyCount > 1 ? view->keyCount : 0;
}

/* The build input of a structure that holds an SBT GAS index, null if there is none. */
OXRT_INLINE const OxrtGeometry* findGeometry(const OxrtTraversableView& view, uint32_t sbtGasIndex) {
    for (uint32_t i = 0; i < view.geometryCount; ++i) {
        const OxrtGeometry& geometry = view.geometries[i];
        if (sbtGasIndex >= geometry.recordBase && sbtGasIndex - geometry.recordBase < geometry.recordCount)
            return &geometry;
    }
    return nullptr;
}

/* The primitive that a handle names; its geometry is null if there is none of the type. An index out of range means the nearest primitive,
   as in OptiX. */
struct NamedPrimitive {
    const OxrtTraversableView* view;
    const OxrtGeometry* geometry;
    uint32_t primitive;
};
OXRT_INLINE NamedPrimitive findPrimitive(OxrtThread& thread, uint64_t gas, uint32_t primitive, uint32_t sbtGasIndex, uint32_t type, Place place) {
    const OxrtTraversableView* view = findTraversable(*thread.launch, gas);
    if (!view || view->type != OXRT_TRAVERSABLE_GAS)
        return {nullptr, nullptr, 0};
    const OxrtGeometry* geometry = findGeometry(*view, sbtGasIndex);
    if (!geometry || geometry->primitiveType != type || geometry->primitiveCount == 0)
        return {view, nullptr, 0};
    const uint32_t index = primitive - geometry->primitiveIndexOffset;
    if (thread.launch->validation)
        checkAccess(thread, *view, OXRT_BUILD_ALLOWS_VERTEX_ACCESS, index, geometry->primitiveCount, place);
    const uint32_t last = geometry->primitiveCount - 1;
    return {view, geometry, primitive < geometry->primitiveIndexOffset ? 0 : index < last ? index : last};
}

/* The true corners, of triangles without area too (recorded: 13_degenerate). */
OXRT_INLINE TriangleVertices getTriangleVertexDataFromHandle(OxrtThread& thread, uint64_t gas, uint32_t primitive, uint32_t sbtGasIndex, float time,
                                                             Place place = Place::current()) {
    const NamedPrimitive named = findPrimitive(thread, gas, primitive, sbtGasIndex, OXRT_PRIMITIVE_TRIANGLE, place);
    return named.geometry ? triangleVerticesAt(*named.view, *named.geometry, named.primitive, time) : makeTuple(float3{}, float3{}, float3{});
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
