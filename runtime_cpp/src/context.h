// A context: one Embree device, one pool of threads, the handle tables, and the order between launches and the memory that they read.
#pragma once

#include "embree_library.h"
#include "error.h"
#include "oxrt/oxrt.h"
#include "oxrt/pipeline.h"
#include "pool.h"
#include "slot_table.h"

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

namespace oxrt {

class Traversable;

class Context {
public:
    explicit Context(const OxrtContextOptions& options);
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    // Throws after fork(): the threads and locks of the parent do not exist here.
    void checkProcess() const;
    // Runs the body; a failure is also told to the log.
    template <class Body>
    void attempt(const char* tag, Body&& body);

    void log(unsigned level, const char* tag, const std::string& message) const;
    void setLog(OxrtLogCallback callback, void* data, unsigned level);

    // Throws the error that Embree reported since the last call, if any; `action` begins the sentence.
    void checkEmbree(const char* action);

    // A launch may read everything that lives when it begins, until it ends.
    std::uint64_t beginLaunch();
    void endLaunch(std::uint64_t ticket);
    // Keeps the object until no launch that runs now can reach it.
    void retire(std::shared_ptr<const void> object);
    // In-place changes exclude launches.
    void beginChange(const char* action);
    void endChange();

    void addTraversable(std::uint64_t handle, std::weak_ptr<const Traversable> traversable);
    void removeTraversable(std::uint64_t handle);
    // Null for a stale handle and for those of instances.
    std::shared_ptr<const Traversable> findTraversable(std::uint64_t handle) const;

    const EmbreeLibrary& embree;
    RTCDevice device = nullptr;
    const bool validation;
    const unsigned threads;
    SlotTable<OxrtTraversableSlot> traversables;
    Pool pool;
    OxrtServices services = {};
    std::mutex buildMutex; // one build at a time: each uses all threads, and its memory can be told apart
    std::atomic<std::int64_t> embreeBytes{0};

private:
    static void onEmbreeError(void* context, RTCError code, const char* text);
    static bool onEmbreeMemory(void* context, std::ptrdiff_t bytes, bool post);

    const unsigned process;

    mutable std::mutex logMutex;
    OxrtLogCallback logCallback = nullptr;
    void* logData = nullptr;
    unsigned logLevel = 0;

    std::mutex embreeErrorMutex;
    RTCError embreeError = RTC_ERROR_NONE;
    std::string embreeErrorText;

    struct Retired {
        std::uint64_t ticket;
        std::shared_ptr<const void> object;
    };
    std::mutex launchMutex;
    std::uint64_t lastTicket = 0;
    std::set<std::uint64_t> activeTickets;
    unsigned changes = 0;
    std::condition_variable changesDone;
    std::vector<Retired> retired;

    mutable std::mutex traversableMutex;
    std::unordered_map<std::uint64_t, std::weak_ptr<const Traversable>> traversableOwners;
};

// As many as the process may use: its CPU set and its cgroup's quota.
unsigned usableThreads();

template <class Body>
void Context::attempt(const char* tag, Body&& body)
{
    checkProcess();
    try {
        std::forward<Body>(body)();
    } catch (const Failure& failure) {
        log(2, tag, failure.text);
        throw;
    }
}

} // namespace oxrt
