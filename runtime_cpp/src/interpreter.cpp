// The C interface of oxrt/interpret.h: a launch that an interpreter runs index by index.
#include "oxrt/interpret.h"

#include "context.h"
#include "cpu.h"
#include "error.h"
#include "interpreted_trace.h"
#include "objects.h"
#include "pipeline.h"
#include "stack.h"

#include <cstdint>
#include <memory>
#include <vector>

struct OxrtInterpreterImpl {
    oxrt::InterpretedThread owner = {};
    std::shared_ptr<oxrt::Pipeline> pipeline;
    std::unique_ptr<oxrt::Launch> launch;
    std::uint64_t ticket = 0; // keeps what accels free until it ends
    std::vector<void*> hitObjects;

    ~OxrtInterpreterImpl()
    {
        for (void* object : hitObjects) oxrt::freeHitObject(object);
    }
};

using namespace oxrt;

namespace {

// What CPython and its modules take behind a callback, and Embree for each level of a graph; both several times of what was measured.
constexpr std::size_t stackOfPrograms = 64 << 10;
constexpr std::size_t stackOfLevel = 8 << 10;

} // namespace

OxrtResult oxrtInterpreterCreate(OxrtPipeline pipeline, const void* params, size_t paramsSize, const OxrtShaderBindingTable* sbt,
                                 uint32_t width, uint32_t height, uint32_t depth, int usesMotion, int usesMicromaps,
                                 OxrtProgramCallback callback, void* data, OxrtInterpreter* interpreter)
{
    return guard([&] {
        if (!interpreter) fail(OXRT_ERROR_INVALID_VALUE, "the result pointer `interpreter` is NULL");
        *interpreter = nullptr;
        if (!callback) fail(OXRT_ERROR_INVALID_VALUE, "the program callback is NULL");
        auto made = std::make_unique<OxrtInterpreterImpl>();
        made->pipeline = find(pipeline);
        made->launch = made->pipeline->makeLaunch(params, paramsSize, sbt, {width, height, depth});
        made->owner.thread.launch = &made->launch->description();
        made->owner.thread.params = made->launch->description().params;
        made->owner.thread.runtime = made->launch.get();
        made->owner.callback = callback;
        made->owner.data = data;
        made->owner.usesTime = usesMotion != 0;
        made->owner.usesMicromaps = usesMicromaps != 0;
        made->ticket = made->pipeline->context->beginLaunch();
        *interpreter = made.release();
    });
}

void oxrtInterpreterDestroy(OxrtInterpreter interpreter)
{
    if (!interpreter) return;
    interpreter->pipeline->context->endLaunch(interpreter->ticket);
    delete interpreter;
}

void oxrtInterpreterSetIndex(OxrtInterpreter interpreter, uint32_t x, uint32_t y, uint32_t z)
{
    const uint32_t index[3] = {x, y, z};
    for (int axis = 0; axis < 3; ++axis) interpreter->owner.thread.index[axis] = index[axis];
}

void* oxrtInterpreterThread(OxrtInterpreter interpreter)
{
    return &interpreter->owner.thread;
}

void oxrtInterpreterTrace(OxrtInterpreter interpreter, const OxrtRayArguments* arguments, uint32_t* payload)
{
    const KernelFloatState floatState;
    traceInterpreted(interpreter->owner, *arguments, payload);
}

void* oxrtInterpreterNewHitObject(OxrtInterpreter interpreter)
{
    void* object = newHitObject(interpreter->owner);
    interpreter->hitObjects.push_back(object);
    return object;
}

void oxrtInterpreterFreeHitObject(OxrtInterpreter interpreter, void* object)
{
    if (std::erase(interpreter->hitObjects, object) != 0) freeHitObject(object);
}

void oxrtInterpreterTraverse(OxrtInterpreter interpreter, void* object, const OxrtRayArguments* arguments, uint32_t* payload)
{
    const KernelFloatState floatState;
    traverseInterpreted(interpreter->owner, object, *arguments, payload);
}

void oxrtInterpreterInvoke(OxrtInterpreter interpreter, void* object, uint32_t* payload)
{
    const KernelFloatState floatState;
    invokeInterpreted(interpreter->owner, object, payload);
}

int oxrtInterpreterIsTooDeep(OxrtInterpreter interpreter, uint64_t handle)
{
    return isTooDeepInterpreted(interpreter->owner, handle);
}

int oxrtInterpreterHasStack(OxrtInterpreter interpreter, uint64_t handle)
{
    return stackLeft() >= stackOfPrograms + stackOfLevel * graphDepthInterpreted(interpreter->owner, handle);
}

void oxrtInterpreterThrow(OxrtInterpreter interpreter, int32_t code, const uint32_t* details, unsigned count)
{
    OxrtThread& thread = interpreter->owner.thread;
    for (unsigned i = 0; i < count && i < 8; ++i) thread.exceptionDetails[i] = details[i];
    thread.exceptionCode = code;
    thread.exceptionPending = 1;
}

void oxrtInterpreterClear(OxrtInterpreter interpreter)
{
    interpreter->owner.thread.exceptionPending = 0;
}

const void* oxrtInterpreterCallableRecord(OxrtInterpreter interpreter, uint32_t index)
{
    const OxrtLaunch& launch = interpreter->launch->description();
    if (index >= launch.callableCount) return nullptr;
    const auto* header = reinterpret_cast<const OxrtRecordHeader*>(launch.callableRecords + std::size_t(launch.callableStride) * index);
    return header->pipelineUid == launch.pipelineUid ? header : nullptr;
}
