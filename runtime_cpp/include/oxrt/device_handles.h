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
                                                             float) {
    const OxrtGeometry* geometry = findGeometry(thread, gas, sbtGasIndex);
    if (!geometry || geometry->primitiveType != OXRT_PRIMITIVE_TRIANGLE || geometry->primitiveCount == 0)
        return makeTuple(float3{}, float3{}, float3{});
    const uint32_t index = primitive < geometry->primitiveIndexOffset ? 0 : primitive - geometry->primitiveIndexOffset;
    return triangleVertices(*geometry, index < geometry->primitiveCount ? index : geometry->primitiveCount - 1);
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
