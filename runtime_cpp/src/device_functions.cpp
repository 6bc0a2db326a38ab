// The pure device functions by name, for oxrt/interpret.h: each a small adapter around the function of oxrt/device.h that compiled
// kernels use. Compiled with the floating-point flags of kernels.
#include "oxrt/device.h"
#include "oxrt/device_make_hit.h"
#include "oxrt/device_texture.h"
#include "oxrt/interpret.h"

#include <cstring>
#include <string_view>
#include <unordered_map>

namespace oxrt {

namespace {

using State = const void*;
using Arguments = const void* const*;

template <class T>
T take(Arguments arguments, int index)
{
    T value;
    std::memcpy(static_cast<void*>(&value), arguments[index], sizeof(T));
    return value;
}

template <class T>
void give(void* result, const T& value)
{
    std::memcpy(result, &value, sizeof(T));
}

// What the interpreter gave the address of: some functions change the hit object or tell the thread of a fault.
template <class T>
T& of(State state)
{
    return *static_cast<T*>(const_cast<void*>(state));
}

// OF: the state that the function reads. The number: how many arguments follow; their types come after the C++ name.
#define OF0(OF, name, function) \
    {#name, [](State state, Arguments, void* result) { give(result, function(of<OF>(state))); }},
#define OF1(OF, name, function, A) \
    {#name, [](State state, Arguments a, void* result) { give(result, function(of<OF>(state), take<A>(a, 0))); }},
#define OF2(OF, name, function, A, B)                                         \
    {#name, [](State state, Arguments a, void* result) {                      \
         give(result, function(of<OF>(state), take<A>(a, 0), take<B>(a, 1))); \
     }},
#define OF3(OF, name, function, A, B, C)                                                     \
    {#name, [](State state, Arguments a, void* result) {                                     \
         give(result, function(of<OF>(state), take<A>(a, 0), take<B>(a, 1), take<C>(a, 2))); \
     }},
#define OF4(OF, name, function, A, B, C, D)                                                                 \
    {#name, [](State state, Arguments a, void* result) {                                                    \
         give(result, function(of<OF>(state), take<A>(a, 0), take<B>(a, 1), take<C>(a, 2), take<D>(a, 3))); \
     }},
#define PURE1(name, function, A) {name, [](State, Arguments a, void* result) { give(result, function(take<A>(a, 0))); }},
#define PURE2(name, function, A, B) \
    {name, [](State, Arguments a, void* result) { give(result, function(take<A>(a, 0), take<B>(a, 1))); }},
#define PURE3(name, function, A, B, C) \
    {name, [](State, Arguments a, void* result) { give(result, function(take<A>(a, 0), take<B>(a, 1), take<C>(a, 2))); }},

#define FLOATS1(name) PURE1(#name ":float32", oxrt::name, float) PURE1(#name ":float64", oxrt::name, double)
#define FLOATS2(name) PURE2(#name ":float32", oxrt::name, float, float) PURE2(#name ":float64", oxrt::name, double, double)
#define FLOATS3(name) \
    PURE3(#name ":float32", oxrt::name, float, float, float) PURE3(#name ":float64", oxrt::name, double, double, double)

#define VECTORS1(name, function)                                                                                \
    PURE1(#name ":float2", oxrt::function, float2) PURE1(#name ":float3", oxrt::function, float3)               \
    PURE1(#name ":float4", oxrt::function, float4) PURE1(#name ":double2", oxrt::function, double2)             \
    PURE1(#name ":double3", oxrt::function, double3) PURE1(#name ":double4", oxrt::function, double4)
#define VECTORS2(name, function)                                                                                              \
    PURE2(#name ":float2", oxrt::function, float2, float2) PURE2(#name ":float3", oxrt::function, float3, float3)             \
    PURE2(#name ":float4", oxrt::function, float4, float4) PURE2(#name ":double2", oxrt::function, double2, double2)          \
    PURE2(#name ":double3", oxrt::function, double3, double3) PURE2(#name ":double4", oxrt::function, double4, double4)

// Makers of hits: the interpreter gives as many transforms as there can be.
using Transforms = FixedArray<uint64_t, MAX_PATH_NODES>;

template <int FIRST, class... GIVEN>
void makeFromNumbers(HitObject& object, Arguments a, GIVEN... given)
{
    const auto word = [a](int index) { return take<uint32_t>(a, FIRST + index); };
    makeHitObject(object, take<uint64_t>(a, 0), take<float3>(a, 1), take<float3>(a, 2), take<float>(a, 3), take<float>(a, 4),
                  take<float>(a, 5), given..., word(0), word(1), word(2), word(3), word(4), word(5), word(6), word(7), word(8), word(9),
                  word(10));
}

// The functions that read the hit, once for the ray in flight and once for the outgoing hit object.
#define OF_HIT0(name, function) OF0(Ray, get_##name, get##function) OF0(HitObject, hit_object_get_##name, hitObjectGet##function)
#define OF_HIT_TRANSFORM(name, function)                                       \
    OF1(Ray, transform_##name, transform##function, float3)                    \
    OF1(HitObject, hit_object_transform_##name, hitObjectTransform##function, float3)

// The control points of the hit curve, of the outgoing hit object's, and of any curve by handle.
#define OF_CURVE(name, function)                                                                                                   \
    OF_HIT0(name##_vertex_data, function##VertexData)                                                                              \
    OF4(OxrtThread, get_##name##_vertex_data_from_handle, get##function##VertexDataFromHandle, uint64_t, uint32_t, uint32_t, float) \
    OF4(OxrtThread, get_##name##_vertex_data_of_geometry, get##function##VertexDataFromHandle, uint64_t, uint32_t, uint32_t, float)

const std::unordered_map<std::string_view, OxrtDeviceFunction>& functions()
{
    static const std::unordered_map<std::string_view, OxrtDeviceFunction> table = {
        OF0(OxrtThread, get_launch_index, getLaunchIndex)
        OF0(OxrtThread, get_launch_dimensions, getLaunchDimensions)
        OF0(OxrtThread, get_exception_code, getExceptionCode)
        OF0(OxrtThread, get_exception_detail_0, getExceptionDetail_0)
        OF0(OxrtThread, get_exception_detail_1, getExceptionDetail_1)
        OF0(OxrtThread, get_exception_detail_2, getExceptionDetail_2)
        OF0(OxrtThread, get_exception_detail_3, getExceptionDetail_3)
        OF0(OxrtThread, get_exception_detail_4, getExceptionDetail_4)
        OF0(OxrtThread, get_exception_detail_5, getExceptionDetail_5)
        OF0(OxrtThread, get_exception_detail_6, getExceptionDetail_6)
        OF0(OxrtThread, get_exception_detail_7, getExceptionDetail_7)
        OF1(OxrtThread, get_transform_type_from_handle, getTransformTypeFromHandle, uint64_t)
        OF1(OxrtThread, get_instance_id_from_handle, getInstanceIdFromHandle, uint64_t)
        OF1(OxrtThread, get_instance_child_from_handle, getInstanceChildFromHandle, uint64_t)
        OF1(OxrtThread, get_instance_transform_from_handle, getInstanceTransformFromHandle, uint64_t)
        OF1(OxrtThread, get_instance_inverse_transform_from_handle, getInstanceInverseTransformFromHandle, uint64_t)
        OF1(OxrtThread, get_static_transform_from_handle, getStaticTransformFromHandle, uint64_t)
        OF2(OxrtThread, get_matrix_motion_transform_from_handle, getMatrixMotionTransformFromHandle, uint64_t, uint32_t)
        OF2(OxrtThread, get_srt_motion_transform_from_handle, getSRTMotionTransformFromHandle, uint64_t, uint32_t)
        OF1(OxrtThread, get_gas_pointer_from_handle, getGASPointerFromHandle, uint64_t)
        OF1(OxrtThread, get_gas_motion_time_begin, getGASMotionTimeBegin, uint64_t)
        OF1(OxrtThread, get_gas_motion_time_end, getGASMotionTimeEnd, uint64_t)
        OF1(OxrtThread, get_gas_motion_step_count, getGASMotionStepCount, uint64_t)
        OF2(OxrtThread, get_instance_traversable_from_ias, getInstanceTraversableFromIAS, uint64_t, uint32_t)
        OF3(OxrtThread, tex2d, tex2d, uint64_t, float, float)
        OF4(OxrtThread, get_triangle_vertex_data_from_handle, getTriangleVertexDataFromHandle, uint64_t, uint32_t, uint32_t, float)
        OF4(OxrtThread, get_triangle_vertex_data_of_geometry, getTriangleVertexDataFromHandle, uint64_t, uint32_t, uint32_t, float)

        OF0(Ray, get_object_ray_origin, getObjectRayOrigin)
        OF0(Ray, get_object_ray_direction, getObjectRayDirection)
        OF0(Ray, get_ray_visibility_mask, getRayVisibilityMask)
        OF0(Ray, get_primitive_type, getPrimitiveType)
        OF0(Ray, get_geometric_normal, getGeometricNormal)
        OF0(Ray, is_front_face_hit, isFrontFaceHit)
        OF0(Ray, is_back_face_hit, isBackFaceHit)
        OF0(Ray, is_triangle_hit, isTriangleHit)
        OF0(Ray, is_triangle_front_face_hit, isTriangleFrontFaceHit)
        OF0(Ray, is_triangle_back_face_hit, isTriangleBackFaceHit)
        OF0(HitObject, hit_object_is_hit, hitObjectIsHit)
        OF0(HitObject, hit_object_is_miss, hitObjectIsMiss)
        OF0(HitObject, hit_object_is_nop, hitObjectIsNop)
        OF0(HitObject, hit_object_get_sbt_record_index, hitObjectGetSbtRecordIndex)

        OF_HIT0(world_ray_origin, WorldRayOrigin)
        OF_HIT0(world_ray_direction, WorldRayDirection)
        OF_HIT0(ray_tmin, RayTmin)
        OF_HIT0(ray_tmax, RayTmax)
        OF_HIT0(ray_time, RayTime)
        OF_HIT0(ray_flags, RayFlags)
        OF_HIT0(primitive_index, PrimitiveIndex)
        OF_HIT0(sbt_gas_index, SbtGASIndex)
        OF_HIT0(instance_id, InstanceId)
        OF_HIT0(instance_index, InstanceIndex)
        OF_HIT0(cluster_id, ClusterId)
        OF_HIT0(hit_kind, HitKind)
        OF_HIT0(gas_traversable_handle, GASTraversableHandle)
        OF_HIT0(triangle_barycentrics, TriangleBarycentrics)
        OF_HIT0(triangle_vertex_data, TriangleVertexData)
        OF_HIT0(curve_parameter, CurveParameter)
        OF_CURVE(linear_curve, LinearCurve)
        OF_CURVE(quadratic_bspline, QuadraticBSpline)
        OF_CURVE(quadratic_bspline_rocaps, QuadraticBSplineRocaps)
        OF_CURVE(cubic_bspline, CubicBSpline)
        OF_CURVE(cubic_bspline_rocaps, CubicBSplineRocaps)
        OF_CURVE(catmull_rom, CatmullRom)
        OF_CURVE(catmull_rom_rocaps, CatmullRomRocaps)
        OF_CURVE(cubic_bezier, CubicBezier)
        OF_CURVE(cubic_bezier_rocaps, CubicBezierRocaps)
        OF_CURVE(ribbon, Ribbon)
        OF_HIT0(sphere_data, SphereData)
        OF4(OxrtThread, get_sphere_data_from_handle, getSphereDataFromHandle, uint64_t, uint32_t, uint32_t, float)
        OF4(OxrtThread, get_sphere_data_of_geometry, getSphereDataFromHandle, uint64_t, uint32_t, uint32_t, float)
        OF_HIT0(ribbon_parameters, RibbonParameters)
        OF1(Ray, get_ribbon_normal, getRibbonNormal, float2)
        OF1(HitObject, hit_object_get_ribbon_normal, hitObjectGetRibbonNormal, float2)
        {"get_ribbon_normal_from_handle",
         [](State state, Arguments a, void* result) {
             give(result, getRibbonNormalFromHandle(of<OxrtThread>(state), take<uint64_t>(a, 0), take<uint32_t>(a, 1),
                                                    take<uint32_t>(a, 2), take<float>(a, 3), take<float2>(a, 4)));
         }},
        OF_HIT0(transform_list_size, TransformListSize)
        OF_HIT0(object_to_world_transform_matrix, ObjectToWorldTransformMatrix)
        OF_HIT0(world_to_object_transform_matrix, WorldToObjectTransformMatrix)
        OF_HIT0(attribute_0, Attribute_0)
        OF_HIT0(attribute_1, Attribute_1)
        OF_HIT0(attribute_2, Attribute_2)
        OF_HIT0(attribute_3, Attribute_3)
        OF_HIT0(attribute_4, Attribute_4)
        OF_HIT0(attribute_5, Attribute_5)
        OF_HIT0(attribute_6, Attribute_6)
        OF_HIT0(attribute_7, Attribute_7)
        OF1(Ray, get_transform_list_handle, getTransformListHandle, uint32_t)
        OF1(HitObject, hit_object_get_transform_list_handle, hitObjectGetTransformListHandle, uint32_t)
        OF_HIT_TRANSFORM(point_from_world_to_object_space, PointFromWorldToObjectSpace)
        OF_HIT_TRANSFORM(point_from_object_to_world_space, PointFromObjectToWorldSpace)
        OF_HIT_TRANSFORM(vector_from_world_to_object_space, VectorFromWorldToObjectSpace)
        OF_HIT_TRANSFORM(vector_from_object_to_world_space, VectorFromObjectToWorldSpace)
        OF_HIT_TRANSFORM(normal_from_world_to_object_space, NormalFromWorldToObjectSpace)
        OF_HIT_TRANSFORM(normal_from_object_to_world_space, NormalFromObjectToWorldSpace)

        {"make_nop_hit_object", [](State state, Arguments, void*) { makeNopHitObject(of<HitObject>(state)); }},
        {"hit_object_set_sbt_record_index",
         [](State state, Arguments a, void*) { hitObjectSetSbtRecordIndex(of<HitObject>(state), take<uint32_t>(a, 0)); }},
        {"hit_object_get_traverse_data",
         [](State state, Arguments, void* result) { give(result, hitObjectGetTraverseData(of<HitObject>(state))); }},
        {"make_hit_object",
         [](State state, Arguments a, void*) {
             makeHitObject(of<HitObject>(state), take<uint64_t>(a, 0), take<float3>(a, 1), take<float3>(a, 2), take<float>(a, 3),
                           take<float>(a, 4), take<uint32_t>(a, 5), take<TraverseData>(a, 6), take<Transforms>(a, 7), take<uint32_t>(a, 8));
         }},
        {"make_hit_object_of_instance",
         [](State state, Arguments a, void*) {
             makeFromNumbers<9>(of<HitObject>(state), a, take<uint32_t>(a, 6), take<uint32_t>(a, 7), take<uint32_t>(a, 8));
         }},
        {"make_hit_object_below_transforms",
         [](State state, Arguments a, void*) {
             makeFromNumbers<11>(of<HitObject>(state), a, take<uint32_t>(a, 6), take<uint32_t>(a, 7), take<uint32_t>(a, 8),
                                 take<Transforms>(a, 9), take<uint32_t>(a, 10));
         }},
        {"make_hit_object_with_record",
         [](State state, Arguments a, void*) {
             makeFromNumbers<10>(of<HitObject>(state), a, 0u, 0u, take<uint32_t>(a, 7), take<Transforms>(a, 8), take<uint32_t>(a, 9));
             hitObjectSetSbtRecordIndex(of<HitObject>(state), take<uint32_t>(a, 6));
         }},
        {"make_miss_hit_object",
         [](State state, Arguments a, void*) {
             makeMissHitObject(of<HitObject>(state), take<uint32_t>(a, 0), take<float3>(a, 1), take<float3>(a, 2), take<float>(a, 3),
                               take<float>(a, 4), take<float>(a, 5), take<uint32_t>(a, 6));
         }},

        PURE1("get_primitive_type_of_kind", oxrt::getPrimitiveType, uint32_t)
        PURE1("is_front_face_hit_of_kind", oxrt::isFrontFaceHit, uint32_t)
        PURE1("is_back_face_hit_of_kind", oxrt::isBackFaceHit, uint32_t)

        FLOATS1(sqrt) FLOATS1(rsqrt) FLOATS1(sin) FLOATS1(cos) FLOATS1(tan) FLOATS1(asin) FLOATS1(acos) FLOATS1(atan)
        FLOATS1(sinh) FLOATS1(cosh) FLOATS1(tanh) FLOATS1(exp) FLOATS1(exp2) FLOATS1(log) FLOATS1(log2) FLOATS1(log10)
        FLOATS1(floor) FLOATS1(ceil) FLOATS1(trunc) FLOATS1(round) FLOATS1(fract) FLOATS1(saturate) FLOATS1(radians) FLOATS1(degrees)
        FLOATS1(abs) FLOATS1(sign) FLOATS1(isnan) FLOATS1(isinf) FLOATS1(isfinite)
        FLOATS2(atan2) FLOATS2(pow) FLOATS2(fmod) FLOATS2(hypot) FLOATS2(copysign) FLOATS2(step) FLOATS2(min) FLOATS2(max)
        FLOATS2(power) FLOATS2(modulo) FLOATS2(floorDivide)
        FLOATS3(fma) FLOATS3(lerp) FLOATS3(mix) FLOATS3(smoothstep) FLOATS3(clamp)

        VECTORS2(dot, dot) VECTORS1(length, length) VECTORS1(length_squared, lengthSquared) VECTORS2(distance, distance)
        VECTORS1(normalize, normalize) VECTORS2(reflect, reflect)
        PURE2("cross:float3", oxrt::cross, float3, float3) PURE2("cross:double3", oxrt::cross, double3, double3)
        PURE3("refract:float2", oxrt::refract, float2, float2, float) PURE3("refract:float3", oxrt::refract, float3, float3, float)
        PURE3("refract:float4", oxrt::refract, float4, float4, float) PURE3("refract:double2", oxrt::refract, double2, double2, double)
        PURE3("refract:double3", oxrt::refract, double3, double3, double)
        PURE3("refract:double4", oxrt::refract, double4, double4, double)
        PURE3("faceforward:float2", oxrt::faceforward, float2, float2, float2)
        PURE3("faceforward:float3", oxrt::faceforward, float3, float3, float3)
        PURE3("faceforward:float4", oxrt::faceforward, float4, float4, float4)
        PURE3("faceforward:double2", oxrt::faceforward, double2, double2, double2)
        PURE3("faceforward:double4", oxrt::faceforward, double4, double4, double4)
        PURE3("faceforward:double3", oxrt::faceforward, double3, double3, double3)
        PURE1("transpose:float3x3", oxrt::transpose, float3x3) PURE1("determinant:float3x3", oxrt::determinant, float3x3)
        PURE1("inverse:float3x3", oxrt::inverse, float3x3)
        PURE2("matmul:float3x3:float3", oxrt::multiply, float3x3, float3)
        PURE2("matmul:float3x4:float4", oxrt::multiply, float3x4, float4)
        PURE2("matmul:float4x4:float4", oxrt::multiply, float4x4, float4)
        PURE2("matmul:float3x3:float3x3", oxrt::multiply, float3x3, float3x3)
        PURE2("matmul:float3x3:float3x4", oxrt::multiply, float3x3, float3x4)
        PURE2("matmul:float3x4:float4x4", oxrt::multiply, float3x4, float4x4)
        PURE2("matmul:float4x4:float4x4", oxrt::multiply, float4x4, float4x4)
    };
    return table;
}

} // namespace

} // namespace oxrt

OxrtDeviceFunction oxrtFindDeviceFunction(const char* name)
{
    const auto& table = oxrt::functions();
    const auto found = table.find(name);
    return found == table.end() ? nullptr : found->second;
}
