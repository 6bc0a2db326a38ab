/* The binary interface between liboxrt and a compiled pipeline.
 *
 * A compiled pipeline is a shared object that exports one symbol, `oxrt_pipeline_v1`, of type OxrtPipelineBinary. It links against
 * nothing: Embree and the runtime reach it through OxrtServices. Everything here is plain C, so that the generated code needs no C++
 * standard header. Both sides are built from this file; OXRT_PIPELINE_ABI changes with every change of a layout.
 */
#ifndef OXRT_PIPELINE_H
#define OXRT_PIPELINE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { OXRT_PIPELINE_ABI = 7 };

/* ---- SBT records -------------------------------------------------------------------------------------------------------------- */

enum { OXRT_SBT_RECORD_HEADER_SIZE = 32, OXRT_SBT_RECORD_ALIGNMENT = 16, OXRT_NO_PROGRAM = -1 };

/* The 32 bytes before a record's data. Program numbers index OxrtPipelineVariant.programs of the pipeline with this uid.
   raygen, miss, exception: programs[0]. hit group: closest hit, any hit, intersection. callables: direct, continuation. */
typedef struct OxrtRecordHeader {
    int32_t programs[3];
    uint32_t pipelineUid; /* 0: an empty record */
    uint32_t kind;        /* OxrtProgramGroupKind */
    uint32_t dataSize;    /* bytes of data that follow */
    uint64_t reserved;
} OxrtRecordHeader;

/* ---- what device code sees of a scene ----------------------------------------------------------------------------------------- */

enum { OXRT_TRAVERSABLE_GAS = 0, OXRT_TRAVERSABLE_IAS = 1, OXRT_TRAVERSABLE_STATIC = 2, OXRT_TRAVERSABLE_MATRIX_MOTION = 3,
       OXRT_TRAVERSABLE_SRT_MOTION = 4, OXRT_TRAVERSABLE_INSTANCE = 5 };

enum { OXRT_PRIMITIVE_CUSTOM = 0x2500, OXRT_PRIMITIVE_QUADRATIC_BSPLINE = 0x2501, OXRT_PRIMITIVE_CUBIC_BSPLINE = 0x2502,
       OXRT_PRIMITIVE_LINEAR = 0x2503, OXRT_PRIMITIVE_CATMULL_ROM = 0x2504, OXRT_PRIMITIVE_FLAT_QUADRATIC_BSPLINE = 0x2505,
       OXRT_PRIMITIVE_SPHERE = 0x2506, OXRT_PRIMITIVE_CUBIC_BEZIER = 0x2507, OXRT_PRIMITIVE_QUADRATIC_BSPLINE_ROCAPS = 0x2508,
       OXRT_PRIMITIVE_CUBIC_BSPLINE_ROCAPS = 0x2509, OXRT_PRIMITIVE_CATMULL_ROM_ROCAPS = 0x250A,
       OXRT_PRIMITIVE_CUBIC_BEZIER_ROCAPS = 0x250B, OXRT_PRIMITIVE_TRIANGLE = 0x2531 };

/* The opacity of a triangle: 4^level states of 1 bit, or of 2 bits in the format of four states, row after row along u from v = 0 on, in
   each square the lower micro-triangle first. */
typedef struct OxrtMicromapView {
    uint32_t firstWord; /* of the geometry's micromapStates */
    uint32_t shape;     /* the bits of the float 2^level, and 1 more with four states */
} OxrtMicromapView;

enum { OXRT_OPACITY_TRANSPARENT = 0, OXRT_OPACITY_OPAQUE = 1, OXRT_OPACITY_UNKNOWN_TRANSPARENT = 2, OXRT_OPACITY_UNKNOWN_OPAQUE = 3 };

/* Primitives of Embree's user geometry that the runtime intersects by itself; called with the arguments of Embree's callback and the
   RTCFilterFunctionN that judges the hits (it gets packets as wide as the callback's), or NULL. */
typedef struct OxrtOwnShape {
    void (*intersect)(const void* arguments, void (*filter)(const void* filterArguments));
    void (*occluded)(const void* arguments, void (*filter)(const void* filterArguments));
} OxrtOwnShape;

/* One build input of a GAS; Embree's geomID is its index, and the geometry's user pointer (geometryUserPtr in callbacks) leads here. Arrays
   belong to the accel and are 16-byte padded at the end. Embree calls an argument filter for geometries of which some record allows any
   hit; for the others (ENFORCE_ANYHIT, face culling) the query needs RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER. */
typedef struct OxrtGeometry {
    uint32_t primitiveType;
    uint32_t primitiveCount;
    uint32_t primitiveIndexOffset;
    uint32_t recordBase;           /* first SBT GAS index of this input (prefix sum) */
    uint32_t recordCount;
    uint32_t keyCount;             /* motion keys, 1 if static */
    const uint32_t* recordFlags;   /* recordCount geometry flag words */
    const uint32_t* recordOffsets; /* one per primitive, clamped to recordCount - 1; NULL: all 0 */
    const float* vertices;         /* floats apart: 3 triangles (xyz), 4 spheres and curves (xyzr), 6 custom primitives (boxes) */
    uint64_t vertexCount;          /* vertices (or boxes) per key; key k begins vertexCount * k further */
    const uint32_t* indices;       /* triangles: 3 per primitive, never NULL; curves: first control point; else NULL */
    const OxrtMicromapView* opacityMicromaps; /* one per primitive; NULL without */
    const uint32_t* micromapStates;
    const OxrtOwnShape* ownShape;  /* not NULL: Embree's intersection callbacks hand over to it */
    const float* widths;           /* ribbons: 8 floats per primitive and key: unit vectors across, at the beginning and at the end of each
                                      segment, and how much of the way along the axis is added from the one and from the other */
    const float* boxes;            /* 6 floats per primitive where Embree offers primitives whose boxes a ray misses; else NULL */
    uint32_t hasEndcaps;           /* curves */
    uint32_t hasUntestedBoxes;     /* custom primitives at rest that Embree offers without a look at each box: the only one, or built fast */
    const void* shape;             /* the runtime's own */
} OxrtGeometry;

/* One instance of an IAS; Embree's instID is its index. */
typedef struct OxrtInstanceView {
    float objectToWorld[12]; /* 3x4 row major */
    float worldToObject[12];
    uint32_t instanceId;
    uint32_t sbtOffset;
    uint32_t visibilityMask;
    uint32_t flags;
    uint64_t handle;                        /* of the instance itself, as it stands in transform lists */
    const struct OxrtTraversableView* child;
} OxrtInstanceView;

/* needs of a scene, OR of the following. One with HAS_MOTION or MULTI_LEVEL is walked through by the kernels themselves: Embree sees one
   structure at a time. */
enum { OXRT_SCENE_HAS_CUSTOM = 1, OXRT_SCENE_HAS_MICROMAPS = 2, OXRT_SCENE_HAS_GEOMETRY_FLAGS = 4, OXRT_SCENE_HAS_INSTANCE_FLAGS = 8,
       OXRT_SCENE_HAS_MASKS = 16, OXRT_SCENE_HAS_CURVES = 32, OXRT_SCENE_HAS_SPHERES = 64, OXRT_SCENE_HAS_MOTION = 128,
       OXRT_SCENE_MULTI_LEVEL = 256, OXRT_SCENE_HAS_MANY_CUSTOM = 512 };

/* What validated launches look for in buildFlags before they answer questions by handle. */
enum { OXRT_BUILD_ALLOWS_VERTEX_ACCESS = 16, OXRT_BUILD_ALLOWS_INSTANCE_ACCESS = 32 };

typedef struct OxrtTraversableView {
    void* scene;     /* RTCScene, NULL where nothing can be hit; of transforms that of the child, which is in another space */
    uint32_t type;
    uint32_t needs;  /* of this traversable and everything below */
    const OxrtGeometry* geometries;    /* GAS */
    const OxrtInstanceView* instances; /* IAS: instanceCount */
    uint32_t geometryCount;
    uint32_t instanceCount;
    uint64_t handle;
    uint32_t keyCount;
    uint32_t motionFlags;
    float timeBegin, timeEnd;
    const struct OxrtTraversableView* child; /* transforms */
    const float* transformKeys;              /* static: matrix and inverse, 12 floats each; matrix motion: 12 per key; SRT motion: 16 */
    const struct OxrtTraversableView* instanceTraversables; /* IAS: what the handle of each instance leads to */
    const float* instanceBoxes; /* as the boxes of an OxrtGeometry */
    uint32_t hasNativeInstances; /* IAS: `scene` holds Embree's instances, else one user geometry with a primitive for each instance */
    uint32_t buildFlags;
    uint32_t graphDepth; /* traversables on the longest way down, this one included */
    float triangleDensity; /* GAS: one over the mean area of its triangles, about; 0: not known */
} OxrtTraversableView;

/* handle = generation << 32 | slot; a handle whose generation is not the slot's is stale. Generation 0 is never used. */
typedef struct OxrtTraversableSlot {
    const OxrtTraversableView* view;
    uint32_t generation;
    uint32_t reserved;
} OxrtTraversableSlot;

enum { OXRT_TEXTURE_FLOAT32 = 0, OXRT_TEXTURE_UINT8 = 1 };
enum { OXRT_FILTER_NEAREST = 0, OXRT_FILTER_LINEAR = 1 };
enum { OXRT_WRAP_REPEAT = 0, OXRT_WRAP_CLAMP = 1, OXRT_WRAP_MIRROR = 2, OXRT_WRAP_BORDER = 3 };

typedef struct OxrtTextureView {
    const void* texels; /* rows from v = 0, channels interleaved */
    uint32_t width, height, channels;
    uint32_t format, filter, wrapU, wrapV;
    uint32_t srgb;
} OxrtTextureView;

typedef struct OxrtTextureSlot {
    const OxrtTextureView* view;
    uint32_t generation;
    uint32_t reserved;
} OxrtTextureSlot;

/* ---- a launch ------------------------------------------------------------------------------------------------------------------ */

/* Why a launch failed; 0 is fine. Negative codes are OptiX's own, codes from 1 are ours. */
enum { OXRT_FAULT_NONE = 0, OXRT_FAULT_STACK_OVERFLOW = -1, OXRT_FAULT_TRACE_DEPTH = -2, OXRT_FAULT_TRAVERSAL_DEPTH = -3,
       OXRT_FAULT_INVALID_TRAVERSABLE = -5, OXRT_FAULT_MISS_SBT = -6, OXRT_FAULT_HIT_SBT = -7, OXRT_FAULT_PRIMITIVE_TYPE = -8,
       OXRT_FAULT_INVALID_RAY = -9, OXRT_FAULT_CALLABLE_ARGUMENTS = -10, OXRT_FAULT_CALLABLE_SBT = -12, OXRT_FAULT_NO_DIRECT = -13,
       OXRT_FAULT_NO_CONTINUATION = -14, OXRT_FAULT_SINGLE_LEVEL_GAS = -15, OXRT_FAULT_DATA_ACCESS = -32, OXRT_FAULT_PAYLOAD_MISMATCH = -33,
       OXRT_FAULT_ASSERT = 1, OXRT_FAULT_BOUNDS = 2, OXRT_FAULT_BOUND_VALUE = 3, OXRT_FAULT_NAN = 4 };

typedef struct OxrtThread OxrtThread;

enum { OXRT_PRINT_STRING = 0, OXRT_PRINT_BOOL = 1, OXRT_PRINT_INT = 2, OXRT_PRINT_UINT = 3, OXRT_PRINT_FLOAT32 = 4,
       OXRT_PRINT_FLOAT64 = 5 };

/* One item of a print: `count` values of one type, in parentheses if more than one. Pointers live as long as the call. */
typedef struct OxrtPrintItem {
    uint32_t type;
    uint32_t count;
    const void* values; /* int64, uint64, float, double, bytes of bool, or UTF-8 text ended by 0 */
} OxrtPrintItem;

/* What a pipeline may call. Signatures of the Embree functions are those of oxrt/embree.h with void* for opaque types. */
typedef struct OxrtServices {
    void (*intersect1)(void* scene, void* rayhit, void* arguments);
    void (*occluded1)(void* scene, void* ray, void* arguments);
    void (*intersect8)(const int* valid, void* scene, void* rayhit, void* arguments);
    void (*occluded8)(const int* valid, void* scene, void* ray, void* arguments);
    void (*intersect16)(const int* valid, void* scene, void* rayhit, void* arguments);
    void (*occluded16)(const int* valid, void* scene, void* ray, void* arguments);
    /* Records the first fault of the launch (later ones are dropped) and sets the cancel word. `message` is static text. */
    void (*fault)(OxrtThread* thread, int32_t code, const char* path, uint32_t line, const char* message, const double* values,
                  uint32_t valueCount);
    /* Writes one line of a print() to standard output, whole. */
    void (*print)(OxrtThread* thread, const OxrtPrintItem* items, uint32_t count, const char* separator, const char* end);
} OxrtServices;

/* One launch, read by all threads. Section pointers are NULL and counts 0 where absent. */
typedef struct OxrtLaunch {
    const void* params;
    uint32_t width, height, depth;
    uint32_t pipelineUid;
    const uint8_t* raygenRecord;
    const uint8_t* exceptionRecord;
    const uint8_t* missRecords;
    const uint8_t* hitgroupRecords;
    const uint8_t* callableRecords;
    uint32_t missStride, missCount;
    uint32_t hitgroupStride, hitgroupCount;
    uint32_t callableStride, callableCount;
    const OxrtTraversableSlot* traversables;
    const OxrtTextureSlot* textures;
    uint32_t traversableCount;
    uint32_t textureCount;
    const OxrtServices* services;
    uint32_t* cancel; /* non-zero: stop soon; read relaxed, polled by loops without a provable bound and between blocks */
    uint32_t maxTraceDepth; /* traces that may nest on the configured stack; the pipeline's own limit is compiled in */
    uint32_t validation;
    uint32_t maxGraphDepth; /* traces into deeper graphs are exceptions in pipelines compiled to notice them */
    uint32_t reserved;
    uint32_t* exceptionsTold; /* exceptions without a program so far; the first five are printed */
} OxrtLaunch;

/* What one worker thread owns during a launch; the runtime makes it, generated code writes the fields after `launch`. */
struct OxrtThread {
    const OxrtLaunch* launch;
    const void* params;
    uint32_t index[3];    /* scalar kernels: the launch index */
    uint32_t traceDepth;
    int32_t exceptionCode;
    uint32_t exceptionPending; /* 1 between throw and the exception program */
    uint32_t exceptionDetails[8];
    const char* exceptionLine;
    void* runtime;        /* the runtime's own */
    const void* stackLimit; /* frames below this address leave too little of the thread's stack */
};

/* A box of launch indices: begin inclusive, end exclusive. */
typedef struct OxrtTile {
    uint32_t begin[3];
    uint32_t end[3];
} OxrtTile;

/* ---- a compiled pipeline ------------------------------------------------------------------------------------------------------ */

enum { OXRT_KIND_RAYGEN = 0, OXRT_KIND_MISS = 1, OXRT_KIND_CLOSESTHIT = 2, OXRT_KIND_ANYHIT = 3, OXRT_KIND_INTERSECTION = 4,
       OXRT_KIND_EXCEPTION = 5, OXRT_KIND_DIRECT_CALLABLE = 6, OXRT_KIND_CONTINUATION_CALLABLE = 7 };

typedef struct OxrtProgram {
    const char* name;       /* with its prefix */
    uint32_t kind;
    uint32_t recordSize;    /* bytes of its SBT data struct, 0 without */
    void (*run)(OxrtThread* thread, const OxrtTile* tile); /* ray generation: runs every index of the tile; NULL for the others */
} OxrtProgram;

/* What a kernel's machine code may use, an OR of bits: the levels of x86-64, and what compilers use beyond them by themselves. */
enum { OXRT_ISA_ANY = 0, OXRT_ISA_X86_64_V3 = 1, OXRT_ISA_X86_64_V4 = 3, OXRT_ISA_AVX512_VBMI = 4, OXRT_ISA_AVX512_VBMI2 = 8,
       OXRT_ISA_AVX512_VNNI = 16, OXRT_ISA_AVX512_BITALG = 32, OXRT_ISA_AVX512_VPOPCNTDQ = 64, OXRT_ISA_AVX512_IFMA = 128,
       OXRT_ISA_GFNI = 256 };

/* The kernels for one instruction set. The runtime takes the last one all of whose bits the machine has. */
typedef struct OxrtPipelineVariant {
    uint32_t isa;   /* OXRT_ISA_... */
    uint32_t lanes; /* 1, 8 or 16 */
    const OxrtProgram* programs;
    uint32_t programCount;
} OxrtPipelineVariant;

typedef struct OxrtPipelineBinary {
    uint32_t abi;           /* OXRT_PIPELINE_ABI */
    uint32_t variantCount;
    const OxrtPipelineVariant* variants;
    uint32_t paramsSize;    /* 0 without launch parameters */
    uint32_t maxTraceDepth;
    const char* version;    /* of the optixc that made it */
} OxrtPipelineBinary;

#ifdef __cplusplus
}
#endif
#endif
