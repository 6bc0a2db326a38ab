/* Running one launch index outside of a compiled kernel: an interpreter runs the programs, rays and device functions are the compiled ones.
 *
 * The interpreter makes an OxrtInterpreter for a launch, calls the ray generation program itself, and traces through the functions below;
 * the runtime calls back for every program that a ray reaches. `ray` and `object` are opaque and live as long as the callback or the
 * interpreter. Nothing here is thread-safe. cffi reads this file after oxrt.h.
 */
#ifndef OXRT_INTERPRET_H
#define OXRT_INTERPRET_H

#include <oxrt/oxrt.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct OxrtInterpreterImpl* OxrtInterpreter;

/* Runs program number `program` of the pipeline about `ray`; kind is OXRT_KIND_... of pipeline.h, record its header. */
typedef void (*OxrtProgramCallback)(void* data, void* ray, uint32_t kind, int32_t program, const void* record);

typedef struct OxrtRayArguments {
    uint64_t handle;
    float origin[3];
    float direction[3];
    float tmin, tmax, time;
    uint32_t visibilityMask, rayFlags, sbtOffset, sbtStride, missIndex;
} OxrtRayArguments;

enum { OXRT_PAYLOAD_WORDS = 32 };

/* `params` is copied; the records of `sbt` must live as long as the interpreter. `usesMotion` and
   `usesMicromaps` are 1 if the pipeline was compiled for them. */
OXRT_API OxrtResult oxrtInterpreterCreate(OxrtPipeline pipeline, const void* params, size_t paramsSize, const OxrtShaderBindingTable* sbt,
                                          uint32_t width, uint32_t height, uint32_t depth, int usesMotion, int usesMicromaps,
                                          OxrtProgramCallback callback, void* data, OxrtInterpreter* interpreter);
OXRT_API void oxrtInterpreterDestroy(OxrtInterpreter interpreter);
OXRT_API void oxrtInterpreterSetIndex(OxrtInterpreter interpreter, uint32_t x, uint32_t y, uint32_t z);
/* The state that device functions of a thread take. */
OXRT_API void* oxrtInterpreterThread(OxrtInterpreter interpreter);

/* Traversal and then the closest-hit or miss program; `payload` holds OXRT_PAYLOAD_WORDS words. */
OXRT_API void oxrtInterpreterTrace(OxrtInterpreter interpreter, const OxrtRayArguments* arguments, uint32_t* payload);
/* The outgoing hit object of a program; starts as a nop. Freed with the interpreter or by oxrtInterpreterFreeHitObject. */
OXRT_API void* oxrtInterpreterNewHitObject(OxrtInterpreter interpreter);
OXRT_API void oxrtInterpreterFreeHitObject(OxrtInterpreter interpreter, void* object);
OXRT_API void oxrtInterpreterTraverse(OxrtInterpreter interpreter, void* object, const OxrtRayArguments* arguments, uint32_t* payload);
OXRT_API void oxrtInterpreterInvoke(OxrtInterpreter interpreter, void* object, uint32_t* payload);

/* 1 if the handle leads to a graph that is deeper than the pipeline's configured stack has room for. */
OXRT_API int oxrtInterpreterIsTooDeep(OxrtInterpreter interpreter, uint64_t handle);

/* 1 if the calling thread's stack has room for a trace against this handle and for the programs that it calls back for; handle 0: for a
   program that traces nothing. */
OXRT_API int oxrtInterpreterHasStack(OxrtInterpreter interpreter, uint64_t handle);

/* Within an intersection program: 0 rejected, 1 accepted, 2 accepted and the program ends. At most 8 attribute words. */
OXRT_API int oxrtInterpreterReport(void* ray, float t, uint32_t kind, const uint32_t* attributes, unsigned count);
/* Within an any-hit program, which ends with it: drops the candidate, or accepts it and ends the traversal. */
OXRT_API void oxrtInterpreterIgnore(void* ray);
OXRT_API void oxrtInterpreterTerminate(void* ray);

/* An exception is on its way: traversal stops and no further program runs until it is cleared. */
OXRT_API void oxrtInterpreterThrow(OxrtInterpreter interpreter, int32_t code, const uint32_t* details, unsigned count);
OXRT_API void oxrtInterpreterClear(OxrtInterpreter interpreter);
/* What the program callback's program may be, for records given by number: the header of callables record `index`, NULL if there is none. */
OXRT_API const void* oxrtInterpreterCallableRecord(OxrtInterpreter interpreter, uint32_t index);

/* A pure device function or piece of mathematics of oxrt/device.h. `state` is the ray, hit object or thread that the function reads, or
   NULL; arguments and result are pointers to values as C lays them out. */
typedef void (*OxrtDeviceFunction)(const void* state, const void* const* arguments, void* result);
/* By the name of the function table; functions that exist for several types carry it: "get_ray_tmin", "sin:float32", "dot:float3".
   NULL if there is none. */
OXRT_API OxrtDeviceFunction oxrtFindDeviceFunction(const char* name);

#ifdef __cplusplus
}
#endif
#endif
