// One launch of a pipeline: a grid of tiles that threads grab in chunks, and the record of the first fault.
#pragma once

#include "array.h"
#include "oxrt/oxrt.h"
#include "oxrt/pipeline.h"
#include "pool.h"

#include <atomic>
#include <cstdint>
#include <mutex>

namespace oxrt {

class Context;

class Launch final : public SharedWork {
public:
    explicit Launch(std::uint32_t paramsSize);

    // For the next launch; `launch` comes without params, cancel word and tables.
    // `frames`: bytes of stack that all functions of the pipeline take together, 0 if nobody knows.
    void prepare(const Context& context, const OxrtLaunch& launch, const OxrtProgram& raygen, const void* params, std::size_t frames);

    void run() override;
    bool exhausted() const override { return nextTile.load(std::memory_order_relaxed) >= tileCount; }
    std::uint64_t partCount() const override { return tileCount; }

    void cancel();
    void recordFault(const OxrtThread& thread, std::int32_t code, const char* path, std::uint32_t line, const char* message,
                     const double* values, std::uint32_t valueCount);

    const OxrtLaunch& description() const { return view; }
    std::uint64_t indicesDone() const { return done.load(std::memory_order_relaxed); }
    std::uint64_t indexCount() const { return total.load(std::memory_order_relaxed); }
    bool cancelled() const { return wasCancelled.load(std::memory_order_relaxed); }
    // faultCode 0 if there was none. Only when no thread runs.
    const OxrtLaunchReport& report() const { return faultReport; }

private:
    // False, with the fault told, if this thread's stack is too small for the programs.
    bool findStack(OxrtThread& thread);
    void chooseTiles(unsigned threads);
    std::uint64_t grab(std::uint64_t& end);
    OxrtTile tileAt(std::uint64_t number) const;

    Array<std::uint8_t> paramsCopy;
    OxrtLaunch view = {};
    const OxrtProgram* program = nullptr;
    unsigned threadCount = 1;
    std::size_t frameBytes = 0;

    std::uint32_t tileSize[3] = {};
    std::uint32_t tilesAcross[3] = {};
    std::uint64_t tileCount = 0;

    // Written by all threads; away from what they only read.
    alignas(64) std::atomic<std::uint64_t> nextTile{0};
    std::atomic<std::uint64_t> done{0};
    std::atomic<std::uint64_t> total{0};
    alignas(64) std::uint32_t cancelWord = 0; // kernels read it without <atomic>
    std::uint32_t exceptionsTold = 0;         // kernels count it without <atomic>
    std::atomic<bool> wasCancelled{false};
    std::mutex faultMutex;
    OxrtLaunchReport faultReport = {};
};

} // namespace oxrt
