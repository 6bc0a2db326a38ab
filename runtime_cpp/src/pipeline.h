// A loaded pipeline: the programs of the best variant for this machine, SBT headers for them, and the one launch that may be under way.
#pragma once

#include "context.h"
#include "launch.h"
#include "oxrt/oxrt.h"
#include "oxrt/pipeline.h"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

namespace oxrt {

struct LaunchSize {
    std::uint32_t width, height, depth;
};

class Pipeline {
public:
    Pipeline(std::shared_ptr<Context> owner, const char* path);
    ~Pipeline();
    Pipeline(const Pipeline&) = delete;
    Pipeline& operator=(const Pipeline&) = delete;

    OxrtPipelineInfo info() const;
    // OXRT_NO_PROGRAM if there is none of this name.
    std::int32_t findProgram(const char* name) const;
    void packHeader(const OxrtProgramGroupDesc& group, std::uint32_t dataSize, void* record) const;

    // Waits for an earlier launch of this pipeline to be waited for.
    void beginLaunch(const void* params, std::size_t paramsSize, const OxrtShaderBindingTable* sbt, LaunchSize size);
    // The calling thread takes part until the launch ended.
    void runLaunch(const void* params, std::size_t paramsSize, const OxrtShaderBindingTable* sbt, LaunchSize size);
    // True when the launch ended; throws what it ended with.
    bool waitLaunch(std::chrono::nanoseconds timeout);
    // Waits until no launch runs; the result of one that nobody waits for is dropped.
    void finishLaunch() noexcept;
    void cancelLaunch();

    // A launch that nobody runs: what an interpreter's programs see of it.
    std::unique_ptr<Launch> makeLaunch(const void* params, std::size_t paramsSize, const OxrtShaderBindingTable* sbt, LaunchSize size) const;

    OxrtLaunchReport lastReport() const;
    void setFrames(std::size_t bytes);
    void setStackDepths(std::uint32_t traces, std::uint32_t graph);
    void progress(std::uint64_t& done, std::uint64_t& total) const;

    const std::shared_ptr<Context> context;

private:
    struct Ending {
        OxrtLaunchReport report = {};
        bool cancelled = false;
    };
    struct CloseLibrary {
        void operator()(void* library) const;
    };

    void chooseVariant(const OxrtPipelineBinary& candidate);
    std::int32_t groupProgram(const char* name, std::uint32_t kind, const char* member, std::uint32_t dataSize) const;
    const OxrtProgram& raygenOf(const OxrtShaderBindingTable& sbt) const;
    OxrtLaunch describeLaunch(const OxrtShaderBindingTable& sbt, LaunchSize size) const;
    const OxrtProgram& checkLaunch(const void* params, std::size_t paramsSize, const OxrtShaderBindingTable* sbt, LaunchSize size) const;
    std::uint64_t prepareLaunch(const void* params, std::size_t paramsSize, const OxrtShaderBindingTable* sbt, LaunchSize size);
    Ending endLaunch(std::uint64_t ended) noexcept;
    void throwResult(const Ending& ending) const;

    const std::string path;
    std::unique_ptr<void, CloseLibrary> library;
    const OxrtPipelineBinary* binary = nullptr;
    const OxrtPipelineVariant* variant = nullptr;
    std::uint32_t uid = 0;

    std::unique_ptr<Launch> launch;
    mutable std::mutex mutex;
    std::condition_variable idle;
    std::uint64_t ticket = 0; // of the launch between its begin and the wait that saw its end, else 0
    bool begun = false;       // it waits for oxrtLaunchWait
    OxrtLaunchReport failedReport = {};
    std::size_t frameBytes = 0; // of all functions together
    std::uint32_t stackTraceDepth = UINT32_MAX; // traces that may nest on the configured stack
    std::uint32_t stackGraphDepth = UINT32_MAX; // traversables that may lie one below the other
};

// Checks bases, strides and counts, and in validation mode every header. Throws Failure naming the record.
void checkShaderBindingTable(const OxrtShaderBindingTable& sbt, std::uint32_t pipelineUid, bool everyHeader);

const char* programKindName(std::uint32_t kind);

} // namespace oxrt
