/* The part of Embree 4's binary interface that the runtime and compiled pipelines use.
 *
 * For a build with one instance level and instance arrays (Embree's default); the runtime checks at start-up that the library it found
 * lays out hits this way. Needs no C++ standard header and no Embree header; do not include it together with <embree4/rtcore.h>.
 * Names and values are Embree's, see its manual for their meaning.
 */
#ifndef OXRT_EMBREE_H
#define OXRT_EMBREE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#else
#include <stdbool.h>
#endif

#define OXRT_ALIGNED(bytes) __attribute__((aligned(bytes)))

typedef struct RTCDeviceTy* RTCDevice;
typedef struct RTCSceneTy* RTCScene;
typedef struct RTCGeometryTy* RTCGeometry;
typedef struct RTCBufferTy* RTCBuffer;

/* ---- constants ---------------------------------------------------------------------------------------------------------------- */

#define RTC_INVALID_GEOMETRY_ID 0xFFFFFFFFu
#define RTC_FEATURE_FLAG_ALL 0xFFFFFFFFu
enum { RTC_MAX_INSTANCE_LEVEL_COUNT = 1, RTC_MAX_TIME_STEP_COUNT = 129 };

enum RTCError { RTC_ERROR_NONE = 0, RTC_ERROR_UNKNOWN = 1, RTC_ERROR_INVALID_ARGUMENT = 2, RTC_ERROR_INVALID_OPERATION = 3,
                RTC_ERROR_OUT_OF_MEMORY = 4, RTC_ERROR_UNSUPPORTED_CPU = 5, RTC_ERROR_CANCELLED = 6 };

enum RTCDeviceProperty {
    RTC_DEVICE_PROPERTY_VERSION = 0,
    RTC_DEVICE_PROPERTY_VERSION_MAJOR = 1,
    RTC_DEVICE_PROPERTY_VERSION_MINOR = 2,
    RTC_DEVICE_PROPERTY_VERSION_PATCH = 3,
    RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED = 32,
    RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED = 33,
    RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED = 34,
    RTC_DEVICE_PROPERTY_BACKFACE_CULLING_SPHERES_ENABLED = 62,
    RTC_DEVICE_PROPERTY_BACKFACE_CULLING_CURVES_ENABLED = 63,
    RTC_DEVICE_PROPERTY_RAY_MASK_SUPPORTED = 64,
    RTC_DEVICE_PROPERTY_BACKFACE_CULLING_ENABLED = 65,
    RTC_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED = 66,
    RTC_DEVICE_PROPERTY_IGNORE_INVALID_RAYS_ENABLED = 67,
    RTC_DEVICE_PROPERTY_COMPACT_POLYS_ENABLED = 68,
    RTC_DEVICE_PROPERTY_TRIANGLE_GEOMETRY_SUPPORTED = 96,
    RTC_DEVICE_PROPERTY_CURVE_GEOMETRY_SUPPORTED = 99,
    RTC_DEVICE_PROPERTY_USER_GEOMETRY_SUPPORTED = 100,
    RTC_DEVICE_PROPERTY_POINT_GEOMETRY_SUPPORTED = 101,
    RTC_DEVICE_PROPERTY_TASKING_SYSTEM = 128,
    RTC_DEVICE_PROPERTY_JOIN_COMMIT_SUPPORTED = 129
};

enum RTCFormat {
    RTC_FORMAT_UCHAR = 0x1001,
    RTC_FORMAT_UINT = 0x5001,
    RTC_FORMAT_UINT2 = 0x5002,
    RTC_FORMAT_UINT3 = 0x5003,
    RTC_FORMAT_UINT4 = 0x5004,
    RTC_FORMAT_FLOAT = 0x9001,
    RTC_FORMAT_FLOAT2 = 0x9002,
    RTC_FORMAT_FLOAT3 = 0x9003,
    RTC_FORMAT_FLOAT4 = 0x9004,
    RTC_FORMAT_FLOAT3X4_ROW_MAJOR = 0x9134,
    RTC_FORMAT_FLOAT4X4_ROW_MAJOR = 0x9144,
    RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR = 0x9234,
    RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR = 0x9244,
    RTC_FORMAT_QUATERNION_DECOMPOSITION = 0xB001
};

enum RTCBufferType { RTC_BUFFER_TYPE_INDEX = 0, RTC_BUFFER_TYPE_VERTEX = 1, RTC_BUFFER_TYPE_VERTEX_ATTRIBUTE = 2,
                     RTC_BUFFER_TYPE_NORMAL = 3, RTC_BUFFER_TYPE_TANGENT = 4, RTC_BUFFER_TYPE_NORMAL_DERIVATIVE = 5,
                     RTC_BUFFER_TYPE_TRANSFORM = 23, RTC_BUFFER_TYPE_FLAGS = 32 };

enum RTCGeometryType {
    RTC_GEOMETRY_TYPE_TRIANGLE = 0,
    RTC_GEOMETRY_TYPE_QUAD = 1,
    RTC_GEOMETRY_TYPE_CONE_LINEAR_CURVE = 15,
    RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE = 16,
    RTC_GEOMETRY_TYPE_FLAT_LINEAR_CURVE = 17,
    RTC_GEOMETRY_TYPE_ROUND_BEZIER_CURVE = 24,
    RTC_GEOMETRY_TYPE_FLAT_BEZIER_CURVE = 25,
    RTC_GEOMETRY_TYPE_NORMAL_ORIENTED_BEZIER_CURVE = 26,
    RTC_GEOMETRY_TYPE_ROUND_BSPLINE_CURVE = 32,
    RTC_GEOMETRY_TYPE_FLAT_BSPLINE_CURVE = 33,
    RTC_GEOMETRY_TYPE_NORMAL_ORIENTED_BSPLINE_CURVE = 34,
    RTC_GEOMETRY_TYPE_SPHERE_POINT = 50,
    RTC_GEOMETRY_TYPE_DISC_POINT = 51,
    RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT = 52,
    RTC_GEOMETRY_TYPE_ROUND_CATMULL_ROM_CURVE = 58,
    RTC_GEOMETRY_TYPE_FLAT_CATMULL_ROM_CURVE = 59,
    RTC_GEOMETRY_TYPE_NORMAL_ORIENTED_CATMULL_ROM_CURVE = 60,
    RTC_GEOMETRY_TYPE_USER = 120,
    RTC_GEOMETRY_TYPE_INSTANCE = 121,
    RTC_GEOMETRY_TYPE_INSTANCE_ARRAY = 122
};

enum RTCCurveFlags { RTC_CURVE_FLAG_NEIGHBOR_LEFT = 1, RTC_CURVE_FLAG_NEIGHBOR_RIGHT = 2 };

enum RTCBuildQuality { RTC_BUILD_QUALITY_LOW = 0, RTC_BUILD_QUALITY_MEDIUM = 1, RTC_BUILD_QUALITY_HIGH = 2, RTC_BUILD_QUALITY_REFIT = 3 };

enum RTCSceneFlags { RTC_SCENE_FLAG_NONE = 0, RTC_SCENE_FLAG_DYNAMIC = 1, RTC_SCENE_FLAG_COMPACT = 2, RTC_SCENE_FLAG_ROBUST = 4,
                     RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS = 8 };

enum RTCRayQueryFlags { RTC_RAY_QUERY_FLAG_NONE = 0, RTC_RAY_QUERY_FLAG_INCOHERENT = 0, RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER = 1 << 1,
                        RTC_RAY_QUERY_FLAG_COHERENT = 1 << 16 };

/* ---- rays and hits ------------------------------------------------------------------------------------------------------------- */

struct OXRT_ALIGNED(16) RTCBounds {
    float lower_x, lower_y, lower_z, align0;
    float upper_x, upper_y, upper_z, align1;
};

struct OXRT_ALIGNED(16) RTCLinearBounds {
    struct RTCBounds bounds0, bounds1;
};

struct OXRT_ALIGNED(16) RTCQuaternionDecomposition {
    float scale_x, scale_y, scale_z;
    float skew_xy, skew_xz, skew_yz;
    float shift_x, shift_y, shift_z;
    float quaternion_r, quaternion_i, quaternion_j, quaternion_k;
    float translation_x, translation_y, translation_z;
};

struct OXRT_ALIGNED(16) RTCRay {
    float org_x, org_y, org_z, tnear;
    float dir_x, dir_y, dir_z, time;
    float tfar;
    unsigned mask, id, flags;
};

/* The normal is not normalised and lies in object space. */
struct OXRT_ALIGNED(16) RTCHit {
    float Ng_x, Ng_y, Ng_z;
    float u, v;
    unsigned primID, geomID;
    unsigned instID[1];
    unsigned instPrimID[1];
};

struct RTCRayHit {
    struct RTCRay ray;
    struct RTCHit hit;
};

#define OXRT_EMBREE_PACKET(N, BYTES)                                                                                                      \
    struct OXRT_ALIGNED(BYTES) RTCRay##N {                                                                                                \
        float org_x[N], org_y[N], org_z[N], tnear[N];                                                                                     \
        float dir_x[N], dir_y[N], dir_z[N], time[N];                                                                                      \
        float tfar[N];                                                                                                                    \
        unsigned mask[N], id[N], flags[N];                                                                                                \
    };                                                                                                                                    \
    struct OXRT_ALIGNED(BYTES) RTCHit##N {                                                                                                \
        float Ng_x[N], Ng_y[N], Ng_z[N];                                                                                                  \
        float u[N], v[N];                                                                                                                 \
        unsigned primID[N], geomID[N];                                                                                                    \
        unsigned instID[1][N];                                                                                                            \
        unsigned instPrimID[1][N];                                                                                                        \
    };                                                                                                                                    \
    struct RTCRayHit##N {                                                                                                                 \
        struct RTCRay##N ray;                                                                                                             \
        struct RTCHit##N hit;                                                                                                             \
    };
OXRT_EMBREE_PACKET(4, 16)
OXRT_EMBREE_PACKET(8, 32)
OXRT_EMBREE_PACKET(16, 64)
#undef OXRT_EMBREE_PACKET

/* ---- queries and their callbacks ----------------------------------------------------------------------------------------------- */

/* First member of the caller's own per-query struct; callbacks get this pointer back. Both ids start as RTC_INVALID_GEOMETRY_ID. */
struct RTCRayQueryContext {
    unsigned instID[1];
    unsigned instPrimID[1];
};

/* `ray` and `hit` are packets of N in Embree's field order: field f of lane i is ((float*)ray)[f * N + i]. valid: -1 active, 0 not. */
struct RTCFilterFunctionNArguments {
    int* valid;
    void* geometryUserPtr;
    struct RTCRayQueryContext* context;
    void* ray;
    void* hit;
    unsigned N;
};

struct RTCIntersectFunctionNArguments {
    int* valid;
    void* geometryUserPtr;
    unsigned primID;
    struct RTCRayQueryContext* context;
    void* rayhit;
    unsigned N;
    unsigned geomID;
};

struct RTCOccludedFunctionNArguments {
    int* valid;
    void* geometryUserPtr;
    unsigned primID;
    struct RTCRayQueryContext* context;
    void* ray;
    unsigned N;
    unsigned geomID;
};

struct RTCBoundsFunctionArguments {
    void* geometryUserPtr;
    unsigned primID;
    unsigned timeStep;
    struct RTCBounds* bounds_o;
};

typedef void (*RTCFilterFunctionN)(const struct RTCFilterFunctionNArguments* arguments);
typedef void (*RTCIntersectFunctionN)(const struct RTCIntersectFunctionNArguments* arguments);
typedef void (*RTCOccludedFunctionN)(const struct RTCOccludedFunctionNArguments* arguments);
typedef void (*RTCBoundsFunction)(const struct RTCBoundsFunctionArguments* arguments);
typedef void (*RTCErrorFunction)(void* userPtr, enum RTCError code, const char* text);
typedef bool (*RTCMemoryMonitorFunction)(void* userPtr, ptrdiff_t bytes, bool post);
typedef bool (*RTCProgressMonitorFunction)(void* userPtr, double fraction);

/* minWidth is read only by builds with RTC_MIN_WIDTH; carrying it costs nothing. */
struct RTCIntersectArguments {
    unsigned flags;
    unsigned feature_mask;
    struct RTCRayQueryContext* context;
    RTCFilterFunctionN filter;
    RTCIntersectFunctionN intersect;
    float minWidth;
};

struct RTCOccludedArguments {
    unsigned flags;
    unsigned feature_mask;
    struct RTCRayQueryContext* context;
    RTCFilterFunctionN filter;
    RTCOccludedFunctionN occluded;
    float minWidth;
};

/* ---- functions ----------------------------------------------------------------------------------------------------------------- */

RTCDevice rtcNewDevice(const char* config);
void rtcReleaseDevice(RTCDevice device);
ptrdiff_t rtcGetDeviceProperty(RTCDevice device, enum RTCDeviceProperty property);
enum RTCError rtcGetDeviceError(RTCDevice device);
void rtcSetDeviceErrorFunction(RTCDevice device, RTCErrorFunction function, void* userPtr);
void rtcSetDeviceMemoryMonitorFunction(RTCDevice device, RTCMemoryMonitorFunction function, void* userPtr);

RTCScene rtcNewScene(RTCDevice device);
void rtcRetainScene(RTCScene scene);
void rtcReleaseScene(RTCScene scene);
void rtcSetSceneFlags(RTCScene scene, enum RTCSceneFlags flags);
void rtcSetSceneBuildQuality(RTCScene scene, enum RTCBuildQuality quality);
void rtcSetSceneProgressMonitorFunction(RTCScene scene, RTCProgressMonitorFunction function, void* userPtr);
void rtcCommitScene(RTCScene scene);
void rtcJoinCommitScene(RTCScene scene);
void rtcGetSceneBounds(RTCScene scene, struct RTCBounds* bounds);
void rtcGetSceneLinearBounds(RTCScene scene, struct RTCLinearBounds* bounds);
unsigned rtcAttachGeometry(RTCScene scene, RTCGeometry geometry);
void rtcAttachGeometryByID(RTCScene scene, RTCGeometry geometry, unsigned geomID);
void rtcDetachGeometry(RTCScene scene, unsigned geomID);
RTCGeometry rtcGetGeometry(RTCScene scene, unsigned geomID);

RTCGeometry rtcNewGeometry(RTCDevice device, enum RTCGeometryType type);
void rtcReleaseGeometry(RTCGeometry geometry);
void rtcCommitGeometry(RTCGeometry geometry);
void rtcEnableGeometry(RTCGeometry geometry);
void rtcDisableGeometry(RTCGeometry geometry);
void rtcSetGeometryBuildQuality(RTCGeometry geometry, enum RTCBuildQuality quality);
void rtcSetGeometryTimeStepCount(RTCGeometry geometry, unsigned count);
void rtcSetGeometryTimeRange(RTCGeometry geometry, float begin, float end);
void rtcSetGeometryMask(RTCGeometry geometry, unsigned mask);
void rtcSetGeometryUserData(RTCGeometry geometry, void* userPtr);
void* rtcGetGeometryUserData(RTCGeometry geometry);
void rtcSetGeometryMaxRadiusScale(RTCGeometry geometry, float scale);
void rtcSetGeometryVertexAttributeCount(RTCGeometry geometry, unsigned count);
void* rtcSetNewGeometryBuffer(RTCGeometry geometry, enum RTCBufferType type, unsigned slot, enum RTCFormat format, size_t stride,
                              size_t count);
void rtcSetSharedGeometryBuffer(RTCGeometry geometry, enum RTCBufferType type, unsigned slot, enum RTCFormat format, const void* data,
                                size_t offset, size_t stride, size_t count);
void* rtcGetGeometryBufferData(RTCGeometry geometry, enum RTCBufferType type, unsigned slot);
void rtcUpdateGeometryBuffer(RTCGeometry geometry, enum RTCBufferType type, unsigned slot);
void rtcSetGeometryIntersectFilterFunction(RTCGeometry geometry, RTCFilterFunctionN filter);
void rtcSetGeometryOccludedFilterFunction(RTCGeometry geometry, RTCFilterFunctionN filter);
void rtcSetGeometryEnableFilterFunctionFromArguments(RTCGeometry geometry, bool enable);
void rtcSetGeometryUserPrimitiveCount(RTCGeometry geometry, unsigned count);
void rtcSetGeometryBoundsFunction(RTCGeometry geometry, RTCBoundsFunction bounds, void* userPtr);
void rtcSetGeometryIntersectFunction(RTCGeometry geometry, RTCIntersectFunctionN intersect);
void rtcSetGeometryOccludedFunction(RTCGeometry geometry, RTCOccludedFunctionN occluded);
void rtcSetGeometryInstancedScene(RTCGeometry geometry, RTCScene scene);
void rtcSetGeometryInstancedScenes(RTCGeometry geometry, RTCScene* scenes, size_t count);
void rtcSetGeometryTransform(RTCGeometry geometry, unsigned timeStep, enum RTCFormat format, const void* matrix);
void rtcSetGeometryTransformQuaternion(RTCGeometry geometry, unsigned timeStep, const struct RTCQuaternionDecomposition* decomposition);

void rtcIntersect1(RTCScene scene, struct RTCRayHit* rayhit, struct RTCIntersectArguments* arguments);
void rtcIntersect8(const int* valid, RTCScene scene, struct RTCRayHit8* rayhit, struct RTCIntersectArguments* arguments);
void rtcIntersect16(const int* valid, RTCScene scene, struct RTCRayHit16* rayhit, struct RTCIntersectArguments* arguments);
void rtcOccluded1(RTCScene scene, struct RTCRay* ray, struct RTCOccludedArguments* arguments);
void rtcOccluded8(const int* valid, RTCScene scene, struct RTCRay8* ray, struct RTCOccludedArguments* arguments);
void rtcOccluded16(const int* valid, RTCScene scene, struct RTCRay16* ray, struct RTCOccludedArguments* arguments);

#ifdef __cplusplus
}
#endif
#endif
