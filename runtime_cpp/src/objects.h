// The objects behind the opaque handles of the C interface. Each handle is looked up before use, so that a null, destroyed or foreign
// pointer is an error and an object cannot vanish under a call that uses it.
#pragma once

#include "error.h"
#include "oxrt/oxrt.h"

#include <memory>
#include <vector>

namespace oxrt {

class Context;
class Accel;
class Transform;
class MicromapArray;
class Pipeline;

OxrtContext publish(std::shared_ptr<Context> context);
OxrtAccel publish(std::shared_ptr<Accel> accel);
OxrtTransform publish(std::shared_ptr<Transform> transform);
OxrtOpacityMicromapArray publish(std::shared_ptr<MicromapArray> array);
OxrtPipeline publish(std::shared_ptr<Pipeline> pipeline);

// Throw for a handle that is not alive, and after fork().
std::shared_ptr<Context> find(OxrtContext handle);
std::shared_ptr<Accel> find(OxrtAccel handle);
std::shared_ptr<Transform> find(OxrtTransform handle);
std::shared_ptr<MicromapArray> find(OxrtOpacityMicromapArray handle);
std::shared_ptr<Pipeline> find(OxrtPipeline handle);

// The caller's reference keeps the object alive; the handle is dead from here on.
std::shared_ptr<Accel> withdraw(OxrtAccel handle);
std::shared_ptr<Transform> withdraw(OxrtTransform handle);
std::shared_ptr<MicromapArray> withdraw(OxrtOpacityMicromapArray handle);
std::shared_ptr<Pipeline> withdraw(OxrtPipeline handle);

struct ContextObjects {
    std::shared_ptr<Context> context;
    std::vector<std::shared_ptr<Accel>> accels;
    std::vector<std::shared_ptr<Transform>> transforms;
    std::vector<std::shared_ptr<MicromapArray>> micromapArrays;
    std::vector<std::shared_ptr<Pipeline>> pipelines;
};

// The context and all that was made from it.
ContextObjects withdraw(OxrtContext handle);

std::vector<std::shared_ptr<Context>> liveContexts();

// How often fork() made a new process since this library was loaded.
unsigned forkCount();

} // namespace oxrt
