// The device library as an interpreter uses it: traces whose programs are callbacks. Apart from the runtime's own headers, because the
// device library has types of the same names.
#pragma once

#include "oxrt/interpret.h"
#include "oxrt/pipeline.h"

namespace oxrt {

// What a thread of device code is, with whom to call for programs behind it.
struct InterpretedThread {
    OxrtThread thread; // first: device code hands out its address
    OxrtProgramCallback callback;
    void* data;
    bool usesTime;
    bool usesMicromaps;
};

void traceInterpreted(InterpretedThread& owner, const OxrtRayArguments& arguments, uint32_t* payload);
bool isTooDeepInterpreted(const InterpretedThread& owner, uint64_t handle);
// Traversables one below the other under a handle.
uint32_t graphDepthInterpreted(const InterpretedThread& owner, uint64_t handle);
void* newHitObject(InterpretedThread& owner);
void freeHitObject(void* object);
void traverseInterpreted(InterpretedThread& owner, void* object, const OxrtRayArguments& arguments, uint32_t* payload);
void invokeInterpreted(InterpretedThread& owner, void* object, uint32_t* payload);

} // namespace oxrt
