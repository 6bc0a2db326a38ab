// A pipeline written by hand against pipeline.h, as small as shows every service of the runtime.
#include "oxrt/embree.h"
#include "tiny_params.h"

#include <cmath>
#include <cstdint>
#include <xmmintrin.h>

// In graph_program.cpp.
void runGraph(OxrtThread* thread, const OxrtTile* tile);

namespace {

const TinyParams& paramsOf(const OxrtThread* thread)
{
    return *static_cast<const TinyParams*>(thread->params);
}

const OxrtTraversableView* resolve(const OxrtLaunch* launch, std::uint64_t handle)
{
    const auto slot = static_cast<std::uint32_t>(handle);
    const auto generation = static_cast<std::uint32_t>(handle >> 32);
    if (slot >= launch->traversableCount) return nullptr;
    // As other threads may destroy the accel: the view stays readable until the launch ends.
    const OxrtTraversableSlot& entry = launch->traversables[slot];
    if (__atomic_load_n(&entry.generation, __ATOMIC_ACQUIRE) != generation) return nullptr;
    return __atomic_load_n(&entry.view, __ATOMIC_ACQUIRE);
}

void intersectBox(const RTCIntersectFunctionNArguments* arguments)
{
    const auto* geometry = static_cast<const OxrtGeometry*>(arguments->geometryUserPtr);
    auto* rayhit = static_cast<RTCRayHit*>(arguments->rayhit);
    const float* box = geometry->vertices + 6 * arguments->primID;
    const float t = (box[2] - rayhit->ray.org_z) / rayhit->ray.dir_z;
    if (!(t > rayhit->ray.tnear && t < rayhit->ray.tfar)) return;
    rayhit->ray.tfar = t;
    rayhit->hit.geomID = arguments->geomID;
    rayhit->hit.primID = arguments->primID;
    rayhit->hit.instID[0] = arguments->context->instID[0];
}

TinyHit trace(OxrtThread* thread, std::uint32_t index)
{
    const TinyParams& params = paramsOf(thread);
    TinyHit result = {-1, 0, ~0u, ~0u, ~0u, ~0u};
    const OxrtTraversableView* view = resolve(thread->launch, params.scene);
    if (!view || !view->scene) return result;

    RTCRayQueryContext context = {{RTC_INVALID_GEOMETRY_ID}, {RTC_INVALID_GEOMETRY_ID}};
    RTCIntersectArguments arguments = {};
    arguments.feature_mask = RTC_FEATURE_FLAG_ALL;
    arguments.context = &context;
    if (params.useIntersection) arguments.intersect = intersectBox;
    RTCRayHit rayhit = {};
    rayhit.ray.org_x = (static_cast<float>(thread->index[0]) + 0.5f) * params.cellSize;
    rayhit.ray.org_y = (static_cast<float>(thread->index[1]) + 0.5f) * params.cellSize;
    rayhit.ray.org_z = -1;
    rayhit.ray.dir_z = 1;
    rayhit.ray.tnear = std::nextafter(0.0f, 1.0f);
    rayhit.ray.tfar = 1000;
    rayhit.ray.mask = params.rayMask;
    rayhit.hit.geomID = rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    thread->launch->services->intersect1(view->scene, &rayhit, &arguments);
    if (rayhit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return result;

    result.t = rayhit.ray.tfar;
    result.primitive = rayhit.hit.primID;
    result.geometry = rayhit.hit.geomID;
    result.instance = rayhit.hit.instID[0];
    std::uint32_t record = 0;
    if (view->type == OXRT_TRAVERSABLE_IAS) {
        record = view->instances[result.instance].sbtOffset;
        view = view->instances[result.instance].child;
    }
    const OxrtGeometry& geometry = view->geometries[result.geometry];
    record += geometry.recordBase + (geometry.recordOffsets ? geometry.recordOffsets[result.primitive] : 0);
    result.record = record;
    static_cast<void>(index);
    return result;
}

template <class Body>
void forTile(OxrtThread* thread, const OxrtTile* tile, Body&& body)
{
    const OxrtLaunch* launch = thread->launch;
    for (std::uint32_t z = tile->begin[2]; z < tile->end[2]; ++z)
        for (std::uint32_t y = tile->begin[1]; y < tile->end[1]; ++y)
            for (std::uint32_t x = tile->begin[0]; x < tile->end[0]; ++x) {
                thread->index[0] = x;
                thread->index[1] = y;
                thread->index[2] = z;
                body((z * launch->height + y) * launch->width + x);
            }
}

void runTrace(OxrtThread* thread, const OxrtTile* tile)
{
    forTile(thread, tile, [&](std::uint32_t index) { paramsOf(thread).hits[index] = trace(thread, index); });
}

void runCount(OxrtThread* thread, const OxrtTile* tile)
{
    forTile(thread, tile, [&](std::uint32_t index) { ++paramsOf(thread).visits[index]; });
}

void runEmpty(OxrtThread*, const OxrtTile*)
{}

void runEndless(OxrtThread* thread, const OxrtTile*)
{
    ++*paramsOf(thread).started;
    while (__atomic_load_n(thread->launch->cancel, __ATOMIC_RELAXED) == 0) __builtin_ia32_pause();
}

// Ends when the test sets visits[0].
void runGate(OxrtThread* thread, const OxrtTile* tile)
{
    ++*paramsOf(thread).started;
    while (__atomic_load_n(&paramsOf(thread).visits[0], __ATOMIC_ACQUIRE) == 0) __builtin_ia32_pause();
    runTrace(thread, tile);
}

void runFault(OxrtThread* thread, const OxrtTile* tile)
{
    static const double values[2] = {1.5, -2};
    forTile(thread, tile, [&](std::uint32_t index) {
        if (index >= paramsOf(thread).faultIndex)
            thread->launch->services->fault(thread, OXRT_FAULT_ASSERT, "shader.py", 12, "assertion failed", values, 2);
    });
}

void runPrint(OxrtThread* thread, const OxrtTile* tile)
{
    forTile(thread, tile, [&](std::uint32_t index) {
        const std::int64_t number = index;
        const float vector[3] = {1, 0.1f, 1e-7f};
        const std::uint8_t yes = 1;
        const double big = 1e16;
        const OxrtPrintItem items[] = {{OXRT_PRINT_STRING, 1, "i"},
                                       {OXRT_PRINT_INT, 1, &number},
                                       {OXRT_PRINT_FLOAT32, 3, vector},
                                       {OXRT_PRINT_BOOL, 1, &yes},
                                       {OXRT_PRINT_FLOAT64, 1, &big}};
        thread->launch->services->print(thread, items, 5, " ", "\n");
    });
}

// Reports the rounding state and the record that the launch was given.
void runState(OxrtThread* thread, const OxrtTile* tile)
{
    forTile(thread, tile, [&](std::uint32_t index) {
        TinyHit& hit = paramsOf(thread).hits[index];
        hit.t = reinterpret_cast<const TinyRecord*>(thread->launch->raygenRecord + OXRT_SBT_RECORD_HEADER_SIZE)->value;
        hit.geometry = _mm_getcsr() & 0x8040; // FTZ and DAZ
        const auto slot = static_cast<std::uint32_t>(paramsOf(thread).texture);
        hit.primitive = slot < thread->launch->textureCount ? thread->launch->textures[slot].view->width : 0;
    });
}

const OxrtProgram programs[] = {
    {"__raygen__trace", OXRT_KIND_RAYGEN, 0, runTrace},
    {"__raygen__graph", OXRT_KIND_RAYGEN, 0, runGraph},
    {"__raygen__count", OXRT_KIND_RAYGEN, 0, runCount},
    {"__raygen__empty", OXRT_KIND_RAYGEN, 0, runEmpty},
    {"__raygen__endless", OXRT_KIND_RAYGEN, 0, runEndless},
    {"__raygen__gate", OXRT_KIND_RAYGEN, 0, runGate},
    {"__raygen__fault", OXRT_KIND_RAYGEN, 0, runFault},
    {"__raygen__print", OXRT_KIND_RAYGEN, 0, runPrint},
    {"__raygen__state", OXRT_KIND_RAYGEN, sizeof(TinyRecord), runState},
    {"__miss__sky", OXRT_KIND_MISS, 0, nullptr},
    {"__closesthit__matte", OXRT_KIND_CLOSESTHIT, sizeof(TinyRecord), nullptr},
    {"__anyhit__leaf", OXRT_KIND_ANYHIT, 0, nullptr},
    {"__exception__report", OXRT_KIND_EXCEPTION, 0, nullptr},
    {"__direct_callable__f", OXRT_KIND_DIRECT_CALLABLE, 0, nullptr},
};

const OxrtPipelineVariant variants[] = {
    {OXRT_ISA_ANY, 1, programs, sizeof programs / sizeof programs[0]},
#ifdef TINY_FUTURE_ISA
    {1000, 16, nullptr, 99},
#endif
};

} // namespace

#ifndef TINY_ABI
#define TINY_ABI OXRT_PIPELINE_ABI
#endif

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1;
extern "C" const OxrtPipelineBinary oxrt_pipeline_v1 = {TINY_ABI, sizeof variants / sizeof variants[0], variants, sizeof(TinyParams), 2,
                                                        "tiny"};
