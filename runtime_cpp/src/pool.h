// The threads that run launches. `threads` kernels run at once: threads - 1 workers, which spin for a moment after their last work so that
// launches in quick succession cost no system call, and either the calling thread or, where that one must stay responsive, a spare worker
// that takes its place while it sleeps.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <pthread.h>
#include <vector>

namespace oxrt {

// Address space; only what is used becomes memory. Nested traces each hold a traversal stack and the locals of 16 lanes.
constexpr std::size_t workerStackSize = std::size_t(64) << 20;

// Work that several threads do together.
class SharedWork {
public:
    // Returns when there is nothing left to grab; parts that other threads grabbed may still be under way.
    virtual void run() = 0;
    // Never becomes false again.
    virtual bool exhausted() const = 0;
    // Parts that can still be grabbed, to wake no more workers than can be used.
    virtual std::uint64_t partCount() const = 0;

protected:
    ~SharedWork() = default;

private:
    friend class Pool;
    unsigned running = 0;
    std::atomic<std::uint32_t> finished{0};
};

class Pool {
public:
    explicit Pool(unsigned threads);
    ~Pool();
    Pool(const Pool&) = delete;
    Pool& operator=(const Pool&) = delete;

    // Offers the work to the workers. It must stay alive until wait() returned true.
    void begin(SharedWork& work);
    // The calling thread takes part.
    void help(SharedWork& work);
    // True when all of the work is done. Negative: no limit. With `useSpare` a spare worker runs while the caller sleeps.
    bool wait(SharedWork& work, std::chrono::nanoseconds timeout, bool useSpare);

    unsigned threads() const { return threadCount; }

private:
    static void* workerEntry(void* pool);
    static void* spareEntry(void* pool);
    void startWorkers();
    bool start(void* (*entry)(void*));
    void workerLoop();
    void spareLoop();
    bool runOne();
    SharedWork* take();
    void leave(SharedWork& work);
    bool wakeSpare();

    const unsigned threadCount;
    std::mutex mutex;
    std::vector<SharedWork*> works; // guarded by mutex, like `running` of each
    std::vector<pthread_t> started;
    bool workersStarted = false;
    bool spareStarted = false;
    std::atomic<bool> stopping{false};
    std::atomic<std::uint32_t> epoch{0};
    std::atomic<std::uint32_t> spareEpoch{0};
    std::atomic<unsigned> sleepers{0};
};

} // namespace oxrt
