// See pool.h.
#include "pool.h"

#include "futex.h"

#include <algorithm>
#include <climits>
#include <csignal>
#include <cstdint>

namespace oxrt {

namespace {

using namespace std::chrono_literals;

// Measured on two cores: shorter spins make launches 300 us apart pay a wake-up, longer ones only burn the core.
constexpr std::chrono::nanoseconds workerSpin = 300us;
constexpr std::chrono::nanoseconds callerSpin = 20us;

} // namespace

Pool::Pool(unsigned threads) : threadCount(threads)
{}

Pool::~Pool()
{
    {
        const std::lock_guard lock(mutex);
        stopping = true;
    }
    ++epoch;
    ++spareEpoch;
    futexWake(epoch, INT_MAX);
    futexWake(spareEpoch, INT_MAX);
    for (pthread_t thread : started) pthread_join(thread, nullptr);
}

void Pool::begin(SharedWork& work)
{
    {
        const std::lock_guard lock(mutex);
        startWorkers();
        work.running = 0;
        work.finished = 0;
        works.push_back(&work);
    }
    ++epoch;
    const unsigned asleep = sleepers;
    if (asleep != 0) futexWake(epoch, static_cast<int>(std::min<std::uint64_t>(asleep, work.partCount())));
}

void Pool::help(SharedWork& work)
{
    {
        const std::lock_guard lock(mutex);
        if (work.finished) return;
        ++work.running;
    }
    work.run();
    leave(work);
}

bool Pool::wait(SharedWork& work, std::chrono::nanoseconds timeout, bool useSpare)
{
    const auto begin = std::chrono::steady_clock::now();
    const auto finished = [&work] { return work.finished.load(std::memory_order_acquire) != 0; };

    // A short launch ends within the spin. After it the caller's core is free for the spare.
    const bool workersRun = threadCount > 1;
    std::chrono::nanoseconds spin = workersRun || !useSpare ? callerSpin : 0ns;
    if (timeout >= 0ns) spin = std::min(spin, timeout);
    if (spinUntil(finished, spin)) return true;
    if (useSpare) {
        if (!wakeSpare()) help(work);
        // Alone the spare does all the work, which may be as short as what workers do within the spin above.
        else if (!workersRun && spinUntil(finished, timeout >= 0ns ? std::min(callerSpin, timeout) : callerSpin)) return true;
    }

    while (!finished()) {
        std::chrono::nanoseconds left = -1ns;
        if (timeout >= 0ns) {
            left = timeout - (std::chrono::steady_clock::now() - begin);
            if (left <= 0ns) return false;
        }
        futexWait(work.finished, 0, left);
    }
    return true;
}

void Pool::startWorkers()
{
    if (workersStarted) return;
    workersStarted = true;
    started.reserve(threadCount);
    for (unsigned i = 1; i < threadCount; ++i)
        if (!start(workerEntry)) break; // the others and the caller do the work
}

bool Pool::start(void* (*entry)(void*))
{
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, workerStackSize);

    // Signals belong to the threads of the program, so that Ctrl-C reaches the one that waits for it.
    sigset_t all;
    sigset_t old;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &old);
    pthread_t thread;
    const bool created = pthread_create(&thread, &attributes, entry, this) == 0;
    pthread_sigmask(SIG_SETMASK, &old, nullptr);
    pthread_attr_destroy(&attributes);
    if (created) started.push_back(thread);
    return created;
}

void* Pool::workerEntry(void* pool)
{
    static_cast<Pool*>(pool)->workerLoop();
    return nullptr;
}

void* Pool::spareEntry(void* pool)
{
    static_cast<Pool*>(pool)->spareLoop();
    return nullptr;
}

void Pool::workerLoop()
{
    for (;;) {
        const std::uint32_t seen = epoch;
        if (stopping) return;
        if (runOne()) continue;
        if (spinUntil([&] { return epoch.load(std::memory_order_acquire) != seen; }, workerSpin)) continue;
        ++sleepers;
        futexWait(epoch, seen, -1ns);
        --sleepers;
    }
}

void Pool::spareLoop()
{
    for (;;) {
        const std::uint32_t seen = spareEpoch;
        if (stopping) return;
        if (runOne()) continue;
        // Without workers every launch comes here: the next one need not wake it.
        if (threadCount == 1 && spinUntil([&] { return spareEpoch.load(std::memory_order_acquire) != seen; }, workerSpin)) continue;
        futexWait(spareEpoch, seen, -1ns);
    }
}

bool Pool::runOne()
{
    SharedWork* work = take();
    if (!work) return false;
    work->run();
    leave(*work);
    return true;
}

SharedWork* Pool::take()
{
    const std::lock_guard lock(mutex);
    for (SharedWork* work : works)
        if (!work->exhausted()) {
            ++work->running;
            return work;
        }
    return nullptr;
}

void Pool::leave(SharedWork& work)
{
    {
        const std::lock_guard lock(mutex);
        if (--work.running != 0 || !work.exhausted()) return;
        std::erase(works, &work);
        work.finished.store(1, std::memory_order_release);
    }
    // The owner may have left already; waking a stale address wakes nobody or somebody who looks again.
    futexWake(work.finished, INT_MAX);
}

bool Pool::wakeSpare()
{
    {
        const std::lock_guard lock(mutex);
        if (!spareStarted) spareStarted = start(spareEntry);
        if (!spareStarted) return false;
    }
    ++spareEpoch;
    futexWake(spareEpoch, 1);
    return true;
}

} // namespace oxrt
