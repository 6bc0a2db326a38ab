// Sleeping on a word of memory, and the polite way to spin on it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <linux/futex.h>
#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace oxrt {

inline void pauseSpin()
{
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
}

// Spins until `changed()` or until the time is over; returns the last `changed()`.
template <class Changed>
bool spinUntil(const Changed& changed, std::chrono::nanoseconds duration)
{
    if (changed()) return true;
    if (duration.count() <= 0) return false;
    const auto deadline = std::chrono::steady_clock::now() + duration;
    do {
        for (int i = 0; i < 16; ++i) {
            if (changed()) return true;
            pauseSpin();
        }
        sched_yield(); // on a busy machine the thread that is waited for may be queued on this very core
    } while (std::chrono::steady_clock::now() < deadline);
    return changed();
}

// Returns when woken, when the word is not `expected`, when the time is over, or for no reason. Negative: no limit.
inline void futexWait(std::atomic<std::uint32_t>& word, std::uint32_t expected, std::chrono::nanoseconds timeout)
{
    timespec limit = {};
    if (timeout.count() >= 0) {
        limit.tv_sec = static_cast<std::time_t>(timeout.count() / 1'000'000'000);
        limit.tv_nsec = static_cast<long>(timeout.count() % 1'000'000'000);
    }
    syscall(SYS_futex, reinterpret_cast<std::uint32_t*>(&word), FUTEX_WAIT_PRIVATE, expected, timeout.count() >= 0 ? &limit : nullptr,
            nullptr, 0);
}

inline void futexWake(std::atomic<std::uint32_t>& word, int count)
{
    syscall(SYS_futex, reinterpret_cast<std::uint32_t*>(&word), FUTEX_WAKE_PRIVATE, count, nullptr, nullptr, 0);
}

} // namespace oxrt
