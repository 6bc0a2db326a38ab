/* The C interface of liboxrt, the runtime of optixc pipelines: contexts, acceleration structures, pipelines, SBTs, launches.
 *
 * Objects are opaque; whoever creates one destroys it. Every function returns an OxrtResult; a sentence about the last failure on the
 * calling thread is given by oxrtGetLastErrorMessage. Functions may be called from any thread; calls on one object that change it may
 * not overlap, launches of one pipeline are serialised. Arrays passed in are copied unless their comment says otherwise.
 *
 * This very file is read by cffi, so it holds no inline functions, no macros as sizes and no aligned attributes.
 */
#ifndef OXRT_OXRT_H
#define OXRT_OXRT_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define OXRT_API __attribute__((visibility("default")))
#else
#define OXRT_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* OptiX's result codes with OptiX's values. */
typedef enum OxrtResult {
    OXRT_SUCCESS = 0,
    OXRT_ERROR_INVALID_VALUE = 7001,
    OXRT_ERROR_HOST_OUT_OF_MEMORY = 7002,
    OXRT_ERROR_INVALID_OPERATION = 7003,
    OXRT_ERROR_FILE_IO_ERROR = 7004,
    OXRT_ERROR_INVALID_FILE_FORMAT = 7005,
    OXRT_ERROR_INVALID_DEVICE_CONTEXT = 7051,
    OXRT_ERROR_VALIDATION_FAILURE = 7053,
    OXRT_ERROR_LAUNCH_FAILURE = 7050,
    OXRT_ERROR_PIPELINE_LINK_ERROR = 7251,
    OXRT_ERROR_NOT_SUPPORTED = 7800,
    OXRT_ERROR_UNSUPPORTED_ABI_VERSION = 7801,
    OXRT_ERROR_LIBRARY_NOT_FOUND = 7804,
    OXRT_ERROR_ENTRY_SYMBOL_NOT_FOUND = 7805,
    OXRT_ERROR_LAUNCH_CANCELLED = 7900,
    OXRT_ERROR_INTERNAL_ERROR = 7990
} OxrtResult;

typedef struct OxrtContextImpl* OxrtContext;
typedef struct OxrtAccelImpl* OxrtAccel;
typedef struct OxrtTransformImpl* OxrtTransform;
typedef struct OxrtPipelineImpl* OxrtPipeline;
typedef uint64_t OxrtTraversableHandle;

OXRT_API const char* oxrtGetErrorName(OxrtResult result);
OXRT_API const char* oxrtGetErrorString(OxrtResult result);
/* The sentence that explains the last failure on this thread; valid until the thread's next call. Never NULL. */
OXRT_API const char* oxrtGetLastErrorMessage(void);
OXRT_API const char* oxrtGetVersion(void);

/* ---- context ---------------------------------------------------------------------------------------------------------------- */

/* level 1 fatal, 2 error, 3 warning, 4 print. Called on the thread that has something to say; must not call back into oxrt. */
typedef void (*OxrtLogCallback)(unsigned level, const char* tag, const char* message, void* data);

typedef struct OxrtContextOptions {
    OxrtLogCallback logCallback; /* may be NULL */
    void* logCallbackData;
    unsigned logCallbackLevel;   /* 0 to 4 */
    unsigned validation;         /* 0 or 1 */
    unsigned threads;            /* bounds launches and builds; 0: as many as the process may use */
    const char* embreePath;      /* libembree4 to load; NULL: OXRT_EMBREE, else the system's. One that is loaded already wins */
} OxrtContextOptions;

OXRT_API OxrtResult oxrtContextCreate(const OxrtContextOptions* options, OxrtContext* context);
/* Destroys everything that was made from the context as well. Waits for launches. */
OXRT_API OxrtResult oxrtContextDestroy(OxrtContext context);
OXRT_API OxrtResult oxrtContextSetLogCallback(OxrtContext context, OxrtLogCallback callback, void* data, unsigned level);

typedef struct OxrtContextInfo {
    unsigned threads;
    unsigned embreeVersion;         /* 40400 for 4.4.0 */
    unsigned embreeMaxInstanceLevels;
    unsigned embreeBackfaceCulling;
    unsigned isa;                   /* OXRT_ISA_... of pipeline.h: the best that this machine runs */
    char embreePath[512];
} OxrtContextInfo;

OXRT_API OxrtResult oxrtContextGetInfo(OxrtContext context, OxrtContextInfo* info);

/* ---- acceleration structures -------------------------------------------------------------------------------------------------- */

enum { OXRT_BUILD_FLAG_ALLOW_UPDATE = 1, OXRT_BUILD_FLAG_ALLOW_COMPACTION = 2, OXRT_BUILD_FLAG_PREFER_FAST_TRACE = 4,
       OXRT_BUILD_FLAG_PREFER_FAST_BUILD = 8, OXRT_BUILD_FLAG_ALLOW_RANDOM_VERTEX_ACCESS = 16,
       OXRT_BUILD_FLAG_ALLOW_RANDOM_INSTANCE_ACCESS = 32, OXRT_BUILD_FLAG_ALLOW_OPACITY_MICROMAP_UPDATE = 64,
       OXRT_BUILD_FLAG_ALLOW_DISABLE_OPACITY_MICROMAPS = 128,
       OXRT_BUILD_FLAG_NOT_ROBUST = 65536 /* ours: Embree's fast mode, which leaks at edges */ };

enum { OXRT_BUILD_INPUT_TRIANGLES = 0x2141, OXRT_BUILD_INPUT_CUSTOM_PRIMITIVES = 0x2142, OXRT_BUILD_INPUT_INSTANCES = 0x2143,
       OXRT_BUILD_INPUT_CURVES = 0x2145, OXRT_BUILD_INPUT_SPHERES = 0x2146 };

typedef struct OxrtMotionOptions {
    uint16_t numKeys; /* 0 or 1: static */
    uint16_t flags;
    float timeBegin, timeEnd;
} OxrtMotionOptions;

typedef struct OxrtInstance {
    float transform[12]; /* object to world, 3x4 row major */
    uint32_t instanceId;
    uint32_t sbtOffset;
    uint32_t visibilityMask;
    uint32_t flags;
    OxrtTraversableHandle traversable;
} OxrtInstance;

/* ---- opacity micromaps: how opaque the parts of a triangle are, so that any-hit programs run only where they must decide --------------- */

enum { OXRT_OPACITY_MICROMAP_FORMAT_2_STATE = 1, OXRT_OPACITY_MICROMAP_FORMAT_4_STATE = 2, OXRT_OPACITY_MICROMAP_MAX_LEVEL = 12 };

/* One micromap: 4^subdivisionLevel states of 1 or 2 bits from byteOffset on, index 0 in the lowest bits. */
typedef struct OxrtOpacityMicromapDesc {
    uint32_t byteOffset;
    uint16_t subdivisionLevel;
    uint16_t format;
} OxrtOpacityMicromapDesc;

/* How many micromaps have this level and format. In histograms of arrays and in usage counts of build inputs. */
typedef struct OxrtOpacityMicromapCount {
    uint32_t count;
    uint32_t subdivisionLevel;
    uint32_t format;
} OxrtOpacityMicromapCount;

typedef struct OxrtOpacityMicromapArrayOptions {
    uint32_t flags;                            /* 1 PREFER_FAST_TRACE, 2 PREFER_FAST_BUILD: no difference here */
    uint32_t numDescs;
    const uint8_t* data;
    size_t dataSize;
    const OxrtOpacityMicromapDesc* descs;
    const OxrtOpacityMicromapCount* histogram; /* must agree with the descriptors; rows of one level and format are added up */
    uint32_t numHistogramEntries;
} OxrtOpacityMicromapArrayOptions;

typedef struct OxrtOpacityMicromapArrayImpl* OxrtOpacityMicromapArray;

OXRT_API OxrtResult oxrtOpacityMicromapArrayBuild(OxrtContext context, const OxrtOpacityMicromapArrayOptions* options,
                                                  OxrtOpacityMicromapArray* array);
/* Accels that use the array keep it. */
OXRT_API OxrtResult oxrtOpacityMicromapArrayDestroy(OxrtOpacityMicromapArray array);

enum { OXRT_OPACITY_MICROMAP_INDEXING_LINEAR = 1, OXRT_OPACITY_MICROMAP_INDEXING_INDEXED = 2 };

/* Which micromap of the array each triangle has. */
typedef struct OxrtOpacityMicromapInput {
    OxrtOpacityMicromapArray array;              /* NULL: all indices are predefined ones */
    uint32_t indexingMode;                       /* linear: triangle i has micromap i + indexOffset */
    uint32_t indexOffset;                        /* added to indices that are not negative */
    const int32_t* indices;                      /* indexed: one per triangle; -1 transparent, -2 opaque, -3 and -4 unknown for all of it */
    const OxrtOpacityMicromapCount* usageCounts; /* must agree with the indices; NULL: not checked */
    uint32_t numUsageCounts;
} OxrtOpacityMicromapInput;

/* ---- build inputs --------------------------------------------------------------------------------------------------------------- */

/* One build input; `type` says which members count. flags: numSbtRecords words, NULL = all 0.
   sbtIndexOffsets: one uint32 per primitive or NULL. */
typedef struct OxrtBuildInput {
    uint32_t type;
    uint32_t numSbtRecords;             /* at least 1 */
    const uint32_t* flags;
    const uint32_t* sbtIndexOffsets;
    uint32_t primitiveIndexOffset;
    uint32_t numKeys;                   /* entries of `vertices`, `radii`, `normals`, `aabbs`; at least 1 */
    const float* const* vertices;       /* triangles, spheres, curves: one pointer per key to numVertices x 3 floats */
    uint64_t numVertices;
    const uint32_t* indices;            /* triangles: numPrimitives x 3, NULL: vertices in threes; curves: first control points */
    const float* preTransform;          /* triangles: 3x4 row major or NULL */
    const float* const* aabbs;          /* custom primitives: one pointer per key to numPrimitives x 6 floats */
    uint64_t numPrimitives;
    const OxrtInstance* instances;      /* instances: numPrimitives */
    const float* const* radii;          /* spheres, curves: one pointer per key to numVertices floats */
    uint32_t singleRadius;              /* spheres: 1: one radius per key */
    uint32_t curveType;                 /* curves: OXRT_PRIMITIVE_... of pipeline.h */
    const float* const* normals;        /* ribbons: one pointer per key to numVertices x 3 floats; NULL: from the shape of the curve */
    uint32_t endcapFlags;               /* curves: 1: flat discs at both ends of each strand */
    const OxrtOpacityMicromapInput* opacityMicromap; /* triangles, or NULL */
} OxrtBuildInput;

typedef struct OxrtAccelBuildOptions {
    uint32_t buildFlags;
    OxrtMotionOptions motion;
} OxrtAccelBuildOptions;

typedef struct OxrtAccelInfo {
    OxrtTraversableHandle handle;
    float aabb[6];          /* min xyz, max xyz; min > max if empty */
    uint64_t memoryUsage;   /* bytes: Embree's and ours */
    uint64_t primitiveCount;
    uint32_t isGas;
    uint32_t needs;         /* OXRT_SCENE_... of pipeline.h */
    uint32_t hasNativeInstances; /* an IAS that Embree walks through by itself: one level over static structures */
} OxrtAccelInfo;

/* Builds at once; on failure nothing is made. An IAS keeps its children alive. */
OXRT_API OxrtResult oxrtAccelBuild(OxrtContext context, const OxrtAccelBuildOptions* options, const OxrtBuildInput* inputs,
                                   unsigned numInputs, OxrtAccel* accel);
/* Same inputs with other coordinates, needs ALLOW_UPDATE; handle stays. An error while a launch of the context runs. An IAS over an updated
   accel must be updated as well. */
OXRT_API OxrtResult oxrtAccelUpdate(OxrtAccel accel, const OxrtBuildInput* inputs, unsigned numInputs);
OXRT_API OxrtResult oxrtAccelGetInfo(OxrtAccel accel, OxrtAccelInfo* info);
/* Another accel that is hit like this one, under a handle of its own; this one may be destroyed and is not changed by updates of the other.
   Needs ALLOW_COMPACTION. Embree's structures are compact as built: what cannot be updated shares its memory. */
OXRT_API OxrtResult oxrtAccelCompact(OxrtAccel accel, OxrtAccel* compacted);
/* The same without that flag; of an IAS with other children where `children` is not NULL: one handle for each instance. */
OXRT_API OxrtResult oxrtAccelRelocate(OxrtAccel accel, const OxrtTraversableHandle* children, uint64_t numChildren, OxrtAccel* relocated);
enum { OXRT_PROPERTY_TYPE_COMPACTED_SIZE = 0x2181, OXRT_PROPERTY_TYPE_AABBS = 0x2182 };

/* One property of a structure as it is now. COMPACTED_SIZE: one uint64, needs ALLOW_COMPACTION. AABBS: for each motion key 6 floats, min xyz
   and max xyz (min > max if nothing can be hit). `resultSize` is just that many bytes. */
OXRT_API OxrtResult oxrtAccelEmitProperty(OxrtAccel accel, uint32_t type, void* result, size_t resultSize);
/* The handle is stale from here on; memory goes when no IAS and no launch uses it. */
OXRT_API OxrtResult oxrtAccelDestroy(OxrtAccel accel);

/* ---- transforms ---------------------------------------------------------------------------------------------------------------- */

enum { OXRT_TRANSFORM_STATIC = 1, OXRT_TRANSFORM_MATRIX_MOTION = 2, OXRT_TRANSFORM_SRT_MOTION = 3 }; /* OptiX's OptixTransformType */

/* keys: static 12 floats, a 3x4 row-major matrix; matrix motion 12 for each key; SRT motion 16 for each key in OptiX's order
   (sx a b pvx sy c pvy sz pvz qx qy qz qw tx ty tz). Copied. */
typedef struct OxrtTransformOptions {
    uint32_t type;
    OxrtTraversableHandle child;
    const float* keys;
    OxrtMotionOptions motion; /* of motion transforms: at least two keys, timeBegin before timeEnd */
} OxrtTransformOptions;

/* A traversable above another one, which it keeps alive; child of instances and transforms, or root of traces. */
OXRT_API OxrtResult oxrtTransformCreate(OxrtContext context, const OxrtTransformOptions* options, OxrtTransform* transform);
OXRT_API OxrtResult oxrtTransformGetHandle(OxrtTransform transform, OxrtTraversableHandle* handle);
OXRT_API OxrtResult oxrtTransformDestroy(OxrtTransform transform);

/* ---- textures ----------------------------------------------------------------------------------------------------------------- */

typedef struct OxrtTextureOptions {
    const void* texels;  /* copied; height x width x channels */
    uint32_t width, height, channels; /* channels 1 to 4 */
    uint32_t format, filter, wrapU, wrapV; /* OXRT_TEXTURE_..., OXRT_FILTER_..., OXRT_WRAP_... of pipeline.h */
    uint32_t srgb;       /* decode sRGB when reading uint8 colour */
} OxrtTextureOptions;

/* Programs of every context may read a texture. It dies with `context`; with NULL it lives until it is destroyed. */
OXRT_API OxrtResult oxrtTextureCreate(OxrtContext context, const OxrtTextureOptions* options, uint64_t* handle);
OXRT_API OxrtResult oxrtTextureDestroy(OxrtContext context, uint64_t handle);

/* ---- matrices of cooperative vectors -------------------------------------------------------------------------------------------- */

/* OptiX's numbers. */
enum { OXRT_COOP_VEC_ELEM_TYPE_FLOAT16 = 0x2A01, OXRT_COOP_VEC_ELEM_TYPE_FLOAT32 = 0x2A03, OXRT_COOP_VEC_ELEM_TYPE_UINT8 = 0x2A04,
       OXRT_COOP_VEC_ELEM_TYPE_INT8 = 0x2A05, OXRT_COOP_VEC_ELEM_TYPE_UINT32 = 0x2A08, OXRT_COOP_VEC_ELEM_TYPE_INT32 = 0x2A09,
       OXRT_COOP_VEC_ELEM_TYPE_FLOAT8_E4M3 = 0x2A0A, OXRT_COOP_VEC_ELEM_TYPE_FLOAT8_E5M2 = 0x2A0B };
enum { OXRT_COOP_VEC_MATRIX_LAYOUT_ROW_MAJOR = 0x2A40, OXRT_COOP_VEC_MATRIX_LAYOUT_COLUMN_MAJOR = 0x2A41,
       OXRT_COOP_VEC_MATRIX_LAYOUT_INFERENCING_OPTIMAL = 0x2A42, OXRT_COOP_VEC_MATRIX_LAYOUT_TRAINING_OPTIMAL = 0x2A43 };

/* n rows and k columns at an offset that is a multiple of 64. rowColumnStrideInBytes: a multiple of 16, 0: no gaps; not looked at in optimal
   layouts. sizeInBytes: 0 or at least what oxrtCoopVecMatrixComputeSize tells. */
typedef struct OxrtCoopVecMatrixDescription {
    uint32_t n, k;
    uint32_t offsetInBytes;
    uint32_t elementType;
    uint32_t layout;
    uint32_t rowColumnStrideInBytes;
    uint32_t sizeInBytes;
} OxrtCoopVecMatrixDescription;

typedef struct OxrtNetworkDescription {
    const OxrtCoopVecMatrixDescription* layers;
    uint32_t numLayers;
} OxrtNetworkDescription;

/* Bytes of a matrix, a multiple of 64. */
OXRT_API OxrtResult oxrtCoopVecMatrixComputeSize(OxrtContext context, uint32_t n, uint32_t k, uint32_t elementType, uint32_t layout,
                                                 uint32_t rowColumnStrideInBytes, size_t* sizeInBytes);
/* Writes every matrix of every network as the output's description says, when the call returns. Both memories are the caller's and hold what
   the descriptions tell; they may be the same. The strides lie between networks and are not looked at for one network. */
OXRT_API OxrtResult oxrtCoopVecMatrixConvert(OxrtContext context, uint32_t numNetworks, const OxrtNetworkDescription* inputNetwork,
                                             const void* input, size_t inputStrideInBytes, const OxrtNetworkDescription* outputNetwork,
                                             void* output, size_t outputStrideInBytes);

/* ---- pipelines, program groups, SBT ------------------------------------------------------------------------------------------- */

/* Loads a compiled pipeline (.so made by optixc). */
OXRT_API OxrtResult oxrtPipelineLoad(OxrtContext context, const char* path, OxrtPipeline* pipeline);
OXRT_API OxrtResult oxrtPipelineDestroy(OxrtPipeline pipeline);

typedef struct OxrtPipelineInfo {
    uint32_t lanes;
    uint32_t isa;
    uint32_t programCount;
    uint32_t paramsSize;
    uint32_t maxTraceDepth;
    uint32_t uid;
    uint32_t stackSize; /* bytes of the stack of a thread that runs launches */
} OxrtPipelineInfo;

OXRT_API OxrtResult oxrtPipelineGetInfo(OxrtPipeline pipeline, OxrtPipelineInfo* info);
/* Bytes that launches leave on each stack for Embree's traversals of graphs of many levels and for its callbacks, where the stack has so
   much four times over. */
enum { OXRT_STACK_RESERVE = 2097152 };
/* Bytes of stack that all functions of the pipeline take together, as the C++ compiler tells; 0, as at first, if nobody knows. Launches
   keep as much of each stack free where they look for overflows. */
OXRT_API OxrtResult oxrtPipelineSetFrames(OxrtPipeline pipeline, uint64_t bytes);
/* How many traces may nest on the stack that is configured, and how many traversables may lie one below the other in what they trace
   against; more are stack overflows and trace depth exceptions in pipelines compiled to notice them. */
OXRT_API OxrtResult oxrtPipelineSetStackDepths(OxrtPipeline pipeline, uint32_t traceDepth, uint32_t graphDepth);
/* The number of the program with this full name, -1 if there is none. */
OXRT_API OxrtResult oxrtPipelineFindProgram(OxrtPipeline pipeline, const char* name, int32_t* program);

typedef enum OxrtProgramGroupKind {
    OXRT_PROGRAM_GROUP_KIND_RAYGEN = 0x2421,
    OXRT_PROGRAM_GROUP_KIND_MISS = 0x2422,
    OXRT_PROGRAM_GROUP_KIND_EXCEPTION = 0x2423,
    OXRT_PROGRAM_GROUP_KIND_HITGROUP = 0x2424,
    OXRT_PROGRAM_GROUP_KIND_CALLABLES = 0x2425
} OxrtProgramGroupKind;

/* Names with their prefix; NULL for none. */
typedef struct OxrtProgramGroupDesc {
    OxrtProgramGroupKind kind;
    const char* raygen;
    const char* miss;
    const char* exception;
    const char* closesthit;
    const char* anyhit;
    const char* intersection;
    const char* directCallable;
    const char* continuationCallable;
} OxrtProgramGroupDesc;

/* Writes the 32-byte header of a record that runs this group in this pipeline. `dataSize`: bytes that follow the header. */
OXRT_API OxrtResult oxrtSbtRecordPackHeader(OxrtPipeline pipeline, const OxrtProgramGroupDesc* group, uint32_t dataSize, void* record);

/* Records: 16-byte aligned, strides multiples of 16. The memory stays the caller's and must live until the launch ended. */
typedef struct OxrtShaderBindingTable {
    const void* raygenRecord;
    const void* exceptionRecord;
    const void* missRecords;
    uint32_t missStride, missCount;
    const void* hitgroupRecords;
    uint32_t hitgroupStride, hitgroupCount;
    const void* callableRecords;
    uint32_t callableStride, callableCount;
} OxrtShaderBindingTable;

/* ---- launch ------------------------------------------------------------------------------------------------------------------- */

typedef struct OxrtLaunchReport {
    int32_t faultCode;        /* OXRT_FAULT_... of pipeline.h, 0 if the launch was fine */
    uint32_t index[3];        /* launch index of the fault */
    uint32_t line;
    char path[256];
    char message[512];
} OxrtLaunchReport;

/* Runs width x height x depth launch indices, on the calling thread too, and returns when all are done. `params` is copied and must have
   the pipeline's paramsSize bytes. */
OXRT_API OxrtResult oxrtLaunch(OxrtPipeline pipeline, const void* params, size_t paramsSize, const OxrtShaderBindingTable* sbt,
                               uint32_t width, uint32_t height, uint32_t depth);
/* The same in steps, for a caller that must stay responsive: begin, then wait until *done is 1. A begun launch must be waited for. */
OXRT_API OxrtResult oxrtLaunchBegin(OxrtPipeline pipeline, const void* params, size_t paramsSize, const OxrtShaderBindingTable* sbt,
                                    uint32_t width, uint32_t height, uint32_t depth);
/* Waits at most timeoutMs; the result is the launch's once *done is 1. The calling thread runs no programs here, so that it returns in time
   even if one of them never ends; a worker takes its place while it sleeps. */
OXRT_API OxrtResult oxrtLaunchWait(OxrtPipeline pipeline, unsigned timeoutMs, int* done);
OXRT_API OxrtResult oxrtLaunchCancel(OxrtPipeline pipeline);
/* About the last launch of the pipeline that failed. */
OXRT_API OxrtResult oxrtPipelineGetLaunchReport(OxrtPipeline pipeline, OxrtLaunchReport* report);
/* Progress of the launch that runs: launch indices done and all. */
OXRT_API OxrtResult oxrtLaunchGetProgress(OxrtPipeline pipeline, uint64_t* done, uint64_t* total);

#ifdef __cplusplus
}
#endif
#endif
