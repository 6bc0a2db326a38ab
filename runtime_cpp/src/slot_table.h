// Handles: 32 bits of generation over 32 bits of slot. Kernels read the table while the host changes it, so it never moves: address space
// is reserved once and made usable as it fills. A generation is never handed out twice by this process (until 32 bits wrap), which makes a
// handle of a destroyed object, or of another context, stale instead of wrong.
#pragma once

#include "error.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <sys/mman.h>

namespace oxrt {

// Never 0, so that no handle is 0.
inline std::uint32_t nextGeneration()
{
    static std::atomic<std::uint32_t> counter{0};
    for (;;)
        if (const std::uint32_t generation = ++counter) return generation;
}

template <class Slot>
class SlotTable {
public:
    using View = decltype(Slot::view);

    explicit SlotTable(std::uint32_t maxSlots) : capacity(maxSlots)
    {
        void* memory = mmap(nullptr, bytes(capacity), PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
        if (memory == MAP_FAILED)
            fail(OXRT_ERROR_HOST_OUT_OF_MEMORY, "cannot reserve %zu bytes of address space for handles; raise the limit (ulimit -v)",
                 bytes(capacity));
        slots = static_cast<Slot*>(memory);
    }

    ~SlotTable() { munmap(slots, bytes(capacity)); }
    SlotTable(const SlotTable&) = delete;
    SlotTable& operator=(const SlotTable&) = delete;

    std::uint64_t add(View view)
    {
        const std::lock_guard lock(mutex);
        std::uint32_t index;
        if (used < committed || (freeSlots.empty() && grow())) {
            index = used++;
        } else {
            index = freeSlots.front(); // the oldest, so that a slot rests before it is used again
            freeSlots.pop_front();
        }
        Slot& slot = slots[index];
        std::atomic_ref(slot.view).store(view, std::memory_order_release);
        const std::uint32_t generation = nextGeneration();
        std::atomic_ref(slot.generation).store(generation, std::memory_order_release);
        return std::uint64_t(generation) << 32 | index;
    }

    void remove(std::uint64_t handle)
    {
        const std::lock_guard lock(mutex);
        const auto index = static_cast<std::uint32_t>(handle);
        if (!alive(handle)) return;
        std::atomic_ref(slots[index].generation).store(0, std::memory_order_release);
        std::atomic_ref(slots[index].view).store(View{}, std::memory_order_release);
        freeSlots.push_back(index);
    }

    // Null for a stale handle.
    View find(std::uint64_t handle) const
    {
        const std::lock_guard lock(mutex);
        return alive(handle) ? slots[static_cast<std::uint32_t>(handle)].view : View{};
    }

    const Slot* data() const { return slots; }

    std::uint32_t size() const
    {
        const std::lock_guard lock(mutex);
        return used;
    }

private:
    static constexpr std::uint32_t slotsPerStep = 1u << 16;

    static std::size_t bytes(std::uint32_t count) { return std::size_t(count) * sizeof(Slot); }

    bool alive(std::uint64_t handle) const
    {
        const auto index = static_cast<std::uint32_t>(handle);
        const auto generation = static_cast<std::uint32_t>(handle >> 32);
        return index < used && generation != 0 && slots[index].generation == generation;
    }

    bool grow()
    {
        if (committed == capacity)
            fail(OXRT_ERROR_INVALID_OPERATION, "all %u handles of this context are in use; destroy some objects", capacity);
        const std::uint32_t next = capacity - committed < slotsPerStep ? capacity : committed + slotsPerStep;
        if (mprotect(slots, bytes(next), PROT_READ | PROT_WRITE) != 0) throw std::bad_alloc();
        committed = next;
        return true;
    }

    const std::uint32_t capacity;
    mutable std::mutex mutex;
    Slot* slots = nullptr;
    std::uint32_t committed = 0;
    std::uint32_t used = 0;
    std::deque<std::uint32_t> freeSlots;
};

} // namespace oxrt
