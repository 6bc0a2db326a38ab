/* What hit objects of one lane and of many tell of a hit: X(type, name) for each getter, X(name) for each transform. */
#ifndef OXRT_HIT_GETTERS_H
#define OXRT_HIT_GETTERS_H

/* Those that lanes answer together. */
#define OXRT_HIT_GETTERS(X)             \
    X(uint64_t, GASTraversableHandle)   \
    X(uint32_t, TransformListSize)      \
    X(uint32_t, PrimitiveIndex)         \
    X(uint32_t, SbtGASIndex)            \
    X(uint32_t, InstanceId)             \
    X(uint32_t, InstanceIndex)          \
    X(uint32_t, HitKind)                \
    X(float2, TriangleBarycentrics)     \
    X(float, CurveParameter)            \
    X(TriangleVertices, TriangleVertexData) \
    X(uint32_t, Attribute_0)            \
    X(uint32_t, Attribute_1)            \
    X(uint32_t, Attribute_2)            \
    X(uint32_t, Attribute_3)            \
    X(uint32_t, Attribute_4)            \
    X(uint32_t, Attribute_5)            \
    X(uint32_t, Attribute_6)            \
    X(uint32_t, Attribute_7)

/* Those that each lane answers by itself. */
#define OXRT_SINGLE_HIT_GETTERS(X)                               \
    X(float4, SphereData)                                        \
    X(float2, RibbonParameters)                                  \
    X(ControlPoints<2>::Type, LinearCurveVertexData)             \
    X(ControlPoints<3>::Type, QuadraticBSplineVertexData)        \
    X(ControlPoints<3>::Type, QuadraticBSplineRocapsVertexData)  \
    X(ControlPoints<4>::Type, CubicBSplineVertexData)            \
    X(ControlPoints<4>::Type, CubicBSplineRocapsVertexData)      \
    X(ControlPoints<4>::Type, CatmullRomVertexData)              \
    X(ControlPoints<4>::Type, CatmullRomRocapsVertexData)        \
    X(ControlPoints<4>::Type, CubicBezierVertexData)             \
    X(ControlPoints<4>::Type, CubicBezierRocapsVertexData)       \
    X(ControlPoints<3>::Type, RibbonVertexData)

#define OXRT_HIT_TRANSFORMS(X)       \
    X(PointFromWorldToObjectSpace)   \
    X(PointFromObjectToWorldSpace)   \
    X(VectorFromWorldToObjectSpace)  \
    X(VectorFromObjectToWorldSpace)  \
    X(NormalFromWorldToObjectSpace)  \
    X(NormalFromObjectToWorldSpace)

#endif
