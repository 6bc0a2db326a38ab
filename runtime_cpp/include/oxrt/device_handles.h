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
OXRT_INLINE uint64_t getInstanceTraversableFromIAS(const OxrtThread& thread, uint64_t handle, uint32_t index) {
    const OxrtTraversableView* view = findTraversable(*thread.launch, handle);
    return view && view->type == OXRT_TRAVERSABLE_IAS && index < view->instanceCount ? view->instances[index].handle : 0;
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

/* The build input that holds an SBT GAS index, null if there is none. */
OXRT_INLINE const OxrtGeometry* findGeometry(const OxrtThread& thread, uint64_t gas, uint32_t sbtGasIndex) {
    const OxrtTraversableView* view = findTraversable(*thread.launch, gas);
    if (!view || view->type != OXRT_TRAVERSABLE_GAS)
        return nullptr;
    for (uint32_t i = 0; i < view->geometryCount; ++i) {
        const OxrtGeometry& geometry = view->geometries[i];
        if (sbtGasIndex >= geometry.recordBase && sbtGasIndex - geometry.recordBase < geometry.recordCount)
            return &geometry;
    }
    return nullptr;
}

/* Corners by handle. An index out of range means the nearest primitive, as in OptiX. */
OXRT_INLINE TriangleVertices getTriangleVertexDataFromHandle(const OxrtThread& thread, uint64_t gas, uint32_t primitive, uint32_t sbtGasIndex,
                                                             float time) {
    const OxrtGeometry* geometry = findGeometry(thread, gas, sbtGasIndex);
    if (!geometry || geometry->primitiveType != OXRT_PRIMITIVE_TRIANGLE || geometry->primitiveCount == 0)
        return makeTuple(float3{}, float3{}, float3{});
    const uint32_t index = primitive < geometry->primitiveIndexOffset ? 0 : primitive - geometry->primitiveIndexOffset;
    return triangleVerticesAt(*findTraversable(*thread.launch, gas), *geometry,
                              index < geometry->primitiveCount ? index : geometry->primitiveCount - 1, time);
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
