// See pipeline.h.
#include "pipeline.h"

#include "cpu.h"
#include "error.h"
#include "objects.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <dlfcn.h>
#include <unistd.h>

namespace oxrt {

namespace {

constexpr std::uint64_t maxLaunchIndices = std::uint64_t(1) << 30;
constexpr std::uint64_t maxFrames = std::uint64_t(1) << 40;

// 0 marks an empty record.
std::uint32_t nextUid()
{
    static std::atomic<std::uint32_t> counter{0};
    return ++counter;
}

} // namespace

void Pipeline::CloseLibrary::operator()(void* handle) const
{
    dlclose(handle);
}

Pipeline::Pipeline(std::shared_ptr<Context> owner, const char* file) : context(std::move(owner)), path(file), uid(nextUid())
{
    // A name without a slash would make the loader search its own folders.
    const std::string name = path.find('/') == std::string::npos ? "./" + path : path;
    if (access(name.c_str(), R_OK) != 0)
        fail(OXRT_ERROR_FILE_IO_ERROR, "cannot read the pipeline %s (%s); compile it first", file, std::strerror(errno));
    library.reset(dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL));
    if (!library) {
        const char* reason = dlerror();
        fail(OXRT_ERROR_INVALID_FILE_FORMAT, "cannot load the pipeline %s: %s", file, reason ? reason : "unknown reason");
    }
    binary = static_cast<const OxrtPipelineBinary*>(dlsym(library.get(), "oxrt_pipeline_v1"));
    if (!binary) fail(OXRT_ERROR_ENTRY_SYMBOL_NOT_FOUND, "%s is not a compiled pipeline: it does not export oxrt_pipeline_v1", file);
    chooseVariant(*binary);
    launch = std::make_unique<Launch>(binary->paramsSize);
}

Pipeline::~Pipeline()
{
    finishLaunch();
}

void Pipeline::chooseVariant(const OxrtPipelineBinary& candidate)
{
    if (candidate.abi != OXRT_PIPELINE_ABI)
        fail(OXRT_ERROR_UNSUPPORTED_ABI_VERSION, "the pipeline %s has interface version %u, this runtime has %u; compile it again",
             path.c_str(), candidate.abi, static_cast<unsigned>(OXRT_PIPELINE_ABI));
    const std::uint32_t isa = detectIsa();
    for (std::uint32_t i = 0; candidate.variants && i < candidate.variantCount; ++i)
        if ((candidate.variants[i].isa & ~isa) == 0) variant = &candidate.variants[i];
    if (!variant)
        fail(OXRT_ERROR_NOT_SUPPORTED,
             "the pipeline %s was compiled for %s, which this processor does not run (it has %s); compile it on this machine, or with "
             "--target x86-64 for kernels that run on any",
             path.c_str(), candidate.variantCount ? isaName(candidate.variants[0].isa) : "no processor", isaName(isa));

    for (std::uint32_t i = 0; i < variant->programCount; ++i) {
        const OxrtProgram& program = variant->programs[i];
        if (!program.name || (program.kind == OXRT_KIND_RAYGEN && !program.run))
            fail(OXRT_ERROR_INVALID_FILE_FORMAT, "program %u of the pipeline %s is incomplete; compile it again", i, path.c_str());
    }
}

OxrtPipelineInfo Pipeline::info() const
{
    return {variant->lanes, variant->isa, variant->programCount, binary->paramsSize, binary->maxTraceDepth, uid, static_cast<std::uint32_t>(workerStackSize)};
}

std::int32_t Pipeline::findProgram(const char* name) const
{
    for (std::uint32_t i = 0; i < variant->programCount; ++i)
        if (std::strcmp(variant->programs[i].name, name) == 0) return static_cast<std::int32_t>(i);
    return OXRT_NO_PROGRAM;
}

const OxrtProgram& Pipeline::checkLaunch(const void* params, std::size_t paramsSize, const OxrtShaderBindingTable* sbt,
                                         LaunchSize size) const
{
    // An absent variable ignores what is passed, as in OptiX.
    if (binary->paramsSize != 0 && !params) fail(OXRT_ERROR_INVALID_VALUE, "params is NULL, but the pipeline has launch parameters");
    if (binary->paramsSize != 0 && paramsSize != binary->paramsSize)
        fail(OXRT_ERROR_INVALID_VALUE, "paramsSize is %zu, but the pipeline's launch parameters have %u bytes; pass the same struct",
             paramsSize, binary->paramsSize);
    if (!sbt) fail(OXRT_ERROR_INVALID_VALUE, "sbt is NULL");
    if (size.width == 0 || size.height == 0 || size.depth == 0)
        fail(OXRT_ERROR_INVALID_VALUE, "the launch size %u x %u x %u has a zero; use 1 for unused dimensions", size.width, size.height,
             size.depth);
    const std::uint64_t area = std::uint64_t(size.width) * size.height;
    if (area > maxLaunchIndices || area * size.depth > maxLaunchIndices)
        fail(OXRT_ERROR_LAUNCH_FAILURE, "the launch size %u x %u x %u exceeds 2^30 indices; launch in parts", size.width, size.height,
             size.depth);
    checkShaderBindingTable(*sbt, uid, context->validation);
    return raygenOf(*sbt);
}

OxrtLaunch Pipeline::describeLaunch(const OxrtShaderBindingTable& sbt, LaunchSize size) const
{
    OxrtLaunch description = {};
    description.width = size.width;
    description.height = size.height;
    description.depth = size.depth;
    description.pipelineUid = uid;
    description.raygenRecord = static_cast<const std::uint8_t*>(sbt.raygenRecord);
    description.exceptionRecord = static_cast<const std::uint8_t*>(sbt.exceptionRecord);
    description.missRecords = static_cast<const std::uint8_t*>(sbt.missRecords);
    description.missStride = sbt.missStride;
    description.missCount = sbt.missCount;
    description.hitgroupRecords = static_cast<const std::uint8_t*>(sbt.hitgroupRecords);
    description.hitgroupStride = sbt.hitgroupStride;
    description.hitgroupCount = sbt.hitgroupCount;
    description.callableRecords = static_cast<const std::uint8_t*>(sbt.callableRecords);
    description.callableStride = sbt.callableStride;
    description.callableCount = sbt.callableCount;
    description.maxTraceDepth = stackTraceDepth;
    description.maxGraphDepth = stackGraphDepth;
    return description;
}

std::unique_ptr<Launch> Pipeline::makeLaunch(const void* params, std::size_t paramsSize, const OxrtShaderBindingTable* sbt,
                                             LaunchSize size) const
{
    const OxrtProgram& raygen = checkLaunch(params, paramsSize, sbt, size);
    auto made = std::make_unique<Launch>(binary->paramsSize);
    made->prepare(*context, describeLaunch(*sbt, size), raygen, params, frameBytes);
    return made;
}

std::uint64_t Pipeline::prepareLaunch(const void* params, std::size_t paramsSize, const OxrtShaderBindingTable* sbt, LaunchSize size)
{
    const OxrtProgram& raygen = checkLaunch(params, paramsSize, sbt, size);
    std::unique_lock lock(mutex);
    idle.wait(lock, [this] { return ticket == 0; });
    const std::uint64_t begunTicket = context->beginLaunch();
    launch->prepare(*context, describeLaunch(*sbt, size), raygen, params, frameBytes);
    ticket = begunTicket;
    begun = false;
    return begunTicket;
}

void Pipeline::beginLaunch(const void* params, std::size_t paramsSize, const OxrtShaderBindingTable* sbt, LaunchSize size)
{
    const std::uint64_t mine = prepareLaunch(params, paramsSize, sbt, size);
    try {
        context->pool.begin(*launch);
    } catch (...) {
        endLaunch(mine);
        throw;
    }
    {
        const std::lock_guard lock(mutex);
        begun = ticket == mine;
    }
    idle.notify_all(); // finishLaunch() may wait to take it over
}

void Pipeline::runLaunch(const void* params, std::size_t paramsSize, const OxrtShaderBindingTable* sbt, LaunchSize size)
{
    const std::uint64_t mine = prepareLaunch(params, paramsSize, sbt, size);
    try {
        if (launch->partCount() == 1 || context->threads == 1) {
            launch->run();
        } else {
            context->pool.begin(*launch);
            context->pool.help(*launch);
            context->pool.wait(*launch, std::chrono::nanoseconds(-1), false);
        }
    } catch (...) {
        endLaunch(mine);
        throw;
    }
    throwResult(endLaunch(mine));
}

bool Pipeline::waitLaunch(std::chrono::nanoseconds timeout)
{
    std::uint64_t waited;
    {
        const std::lock_guard lock(mutex);
        if (!begun) fail(OXRT_ERROR_INVALID_OPERATION, "no launch of this pipeline was begun; call oxrtLaunchBegin first");
        waited = ticket;
    }
    if (!context->pool.wait(*launch, timeout, true)) return false;
    throwResult(endLaunch(waited));
    return true;
}

void Pipeline::finishLaunch() noexcept
{
    std::unique_lock lock(mutex);
    while (ticket != 0) {
        if (!begun) { // another thread runs it
            idle.wait(lock);
            continue;
        }
        const std::uint64_t waited = ticket;
        lock.unlock();
        context->pool.wait(*launch, std::chrono::nanoseconds(-1), true);
        endLaunch(waited);
        lock.lock();
    }
}

Pipeline::Ending Pipeline::endLaunch(std::uint64_t ended) noexcept
{
    Ending ending;
    {
        const std::lock_guard lock(mutex);
        if (ticket != ended) return ending; // another thread waited as well and was first
        ending.report = launch->report();
        ending.cancelled = launch->cancelled();
        if (ending.report.faultCode != OXRT_FAULT_NONE) failedReport = ending.report;
        ticket = 0;
        begun = false;
    }
    idle.notify_all();
    context->endLaunch(ended);
    return ending;
}

void Pipeline::throwResult(const Ending& ending) const
{
    const OxrtLaunchReport& report = ending.report;
    if (report.faultCode != OXRT_FAULT_NONE) {
        const std::string place = report.path[0] ? formatText("%s:%u: ", report.path, report.line) : std::string();
        fail(context->validation ? OXRT_ERROR_VALIDATION_FAILURE : OXRT_ERROR_LAUNCH_FAILURE, "%slaunch index (%u, %u, %u): %s (code %d)",
             place.c_str(), report.index[0], report.index[1], report.index[2], report.message, report.faultCode);
    }
    if (ending.cancelled) fail(OXRT_ERROR_LAUNCH_CANCELLED, "the launch was cancelled");
}

void Pipeline::cancelLaunch()
{
    const std::lock_guard lock(mutex);
    if (ticket != 0) launch->cancel();
}

OxrtLaunchReport Pipeline::lastReport() const
{
    const std::lock_guard lock(mutex);
    return failedReport;
}

void Pipeline::setFrames(std::size_t bytes)
{
    const std::lock_guard lock(mutex);
    frameBytes = bytes;
}

void Pipeline::setStackDepths(std::uint32_t traces, std::uint32_t graph)
{
    const std::lock_guard lock(mutex);
    stackTraceDepth = traces;
    stackGraphDepth = graph;
}

void Pipeline::progress(std::uint64_t& done, std::uint64_t& total) const
{
    done = launch->indicesDone();
    total = launch->indexCount();
}

} // namespace oxrt

using namespace oxrt;

OxrtResult oxrtPipelineLoad(OxrtContext context, const char* path, OxrtPipeline* pipeline)
{
    return guard([&] {
        const auto owner = find(context);
        owner->attempt("PIPELINE", [&] {
            if (!pipeline) fail(OXRT_ERROR_INVALID_VALUE, "the result pointer `pipeline` is NULL");
            *pipeline = nullptr;
            if (!path) fail(OXRT_ERROR_INVALID_VALUE, "the path is NULL");
            *pipeline = publish(std::make_shared<Pipeline>(owner, path));
        });
    });
}

OxrtResult oxrtPipelineDestroy(OxrtPipeline pipeline)
{
    return guard([&] { withdraw(pipeline)->finishLaunch(); });
}

OxrtResult oxrtPipelineGetInfo(OxrtPipeline pipeline, OxrtPipelineInfo* info)
{
    return guard([&] {
        const auto self = find(pipeline);
        if (!info) fail(OXRT_ERROR_INVALID_VALUE, "the result pointer `info` is NULL");
        *info = self->info();
    });
}

OxrtResult oxrtPipelineSetFrames(OxrtPipeline pipeline, uint64_t bytes)
{
    return guard([&] {
        const auto self = find(pipeline);
        if (bytes > maxFrames)
            fail(OXRT_ERROR_INVALID_VALUE, "the frames of a pipeline take %llu bytes; no stack is larger than 2^40",
                 static_cast<unsigned long long>(bytes));
        self->setFrames(bytes);
    });
}

OxrtResult oxrtPipelineSetStackDepths(OxrtPipeline pipeline, uint32_t traceDepth, uint32_t graphDepth)
{
    return guard([&] { find(pipeline)->setStackDepths(traceDepth, graphDepth); });
}

OxrtResult oxrtPipelineFindProgram(OxrtPipeline pipeline, const char* name, int32_t* program)
{
    return guard([&] {
        const auto self = find(pipeline);
        if (!name || !program) fail(OXRT_ERROR_INVALID_VALUE, "the %s is NULL", name ? "result pointer `program`" : "name");
        *program = self->findProgram(name);
    });
}

OxrtResult oxrtLaunch(OxrtPipeline pipeline, const void* params, size_t paramsSize, const OxrtShaderBindingTable* sbt, uint32_t width,
                      uint32_t height, uint32_t depth)
{
    return guard([&] {
        const auto self = find(pipeline);
        self->context->attempt("LAUNCH", [&] { self->runLaunch(params, paramsSize, sbt, {width, height, depth}); });
    });
}

OxrtResult oxrtLaunchBegin(OxrtPipeline pipeline, const void* params, size_t paramsSize, const OxrtShaderBindingTable* sbt, uint32_t width,
                           uint32_t height, uint32_t depth)
{
    return guard([&] {
        const auto self = find(pipeline);
        self->context->attempt("LAUNCH", [&] { self->beginLaunch(params, paramsSize, sbt, {width, height, depth}); });
    });
}

OxrtResult oxrtLaunchWait(OxrtPipeline pipeline, unsigned timeoutMs, int* done)
{
    return guard([&] {
        const auto self = find(pipeline);
        self->context->attempt("LAUNCH", [&] {
            if (!done) fail(OXRT_ERROR_INVALID_VALUE, "the result pointer `done` is NULL");
            *done = 1; // also where the launch ended in a failure
            *done = self->waitLaunch(std::chrono::milliseconds(timeoutMs));
        });
    });
}

OxrtResult oxrtLaunchCancel(OxrtPipeline pipeline)
{
    return guard([&] { find(pipeline)->cancelLaunch(); });
}

OxrtResult oxrtPipelineGetLaunchReport(OxrtPipeline pipeline, OxrtLaunchReport* report)
{
    return guard([&] {
        const auto self = find(pipeline);
        if (!report) fail(OXRT_ERROR_INVALID_VALUE, "the result pointer `report` is NULL");
        *report = self->lastReport();
    });
}

OxrtResult oxrtLaunchGetProgress(OxrtPipeline pipeline, uint64_t* done, uint64_t* total)
{
    return guard([&] {
        const auto self = find(pipeline);
        if (!done || !total) fail(OXRT_ERROR_INVALID_VALUE, "the result pointer `%s` is NULL", done ? "total" : "done");
        self->progress(*done, *total);
    });
}
