// See context.h.
#include "context.h"

#include "accel.h"
#include "cpu.h"
#include "objects.h"
#include "pipeline.h"
#include "texture.h"
#include "trace_services.h"
#include "transform.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sched.h>
#include <unistd.h>

namespace oxrt {

namespace {

constexpr unsigned maxThreads = 1024;
constexpr std::uint32_t maxTraversables = 1u << 24;

unsigned chooseThreads(unsigned wanted)
{
    if (wanted > maxThreads)
        fail(OXRT_ERROR_INVALID_VALUE, "threads is %u; give 0 (all that the process may use) to %u", wanted, maxThreads);
    return wanted != 0 ? wanted : usableThreads();
}

bool checkValidation(unsigned validation)
{
    if (validation > 1) fail(OXRT_ERROR_INVALID_VALUE, "validation is %u; give 0 or 1", validation);
    return validation == 1;
}

} // namespace

unsigned usableThreads()
{
    unsigned count = 1;
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) == 0)
        count = static_cast<unsigned>(CPU_COUNT(&set));
    else if (const long online = sysconf(_SC_NPROCESSORS_ONLN); online > 0)
        count = static_cast<unsigned>(online);

    std::ifstream quotaFile("/sys/fs/cgroup/cpu.max");
    double quota = 0;
    double period = 0;
    if (quotaFile >> quota >> period && quota > 0 && period > 0) count = std::min(count, static_cast<unsigned>(std::ceil(quota / period)));
    return std::clamp(count, 1u, maxThreads);
}

Context::Context(const OxrtContextOptions& options)
    : embree(loadEmbree(options.embreePath)), validation(checkValidation(options.validation)), threads(chooseThreads(options.threads)),
      traversables(maxTraversables), pool(threads), process(forkCount())
{
    setLog(options.logCallback, options.logCallbackData, options.logCallbackLevel);
    device = embree.rtcNewDevice(formatText("threads=%u", threads).c_str());
    if (!device)
        fail(OXRT_ERROR_INTERNAL_ERROR, "Embree in %s made no device (error %d); try a smaller `threads`", embree.path.c_str(),
             static_cast<int>(embree.rtcGetDeviceError(nullptr)));
    embree.rtcSetDeviceErrorFunction(device, onEmbreeError, this);
    embree.rtcSetDeviceMemoryMonitorFunction(device, onEmbreeMemory, this);
    services = traceServices(embree);

    if (!embree.ignoredPath.empty())
        log(3, "EMBREE", formatText("%s is not used: this process has loaded %s already", embree.ignoredPath.c_str(), embree.path.c_str()));
    log(4, "CONTEXT",
        formatText("Embree %u.%u.%u from %s, %u threads", embree.version / 10000, embree.version / 100 % 100, embree.version % 100,
                   embree.path.c_str(), threads));
}

Context::~Context()
{
    retired.clear();
    if (device) embree.rtcReleaseDevice(device);
}

void Context::checkProcess() const
{
    if (process != forkCount())
        fail(OXRT_ERROR_INVALID_OPERATION,
             "this context was made before fork() and cannot be used in the child process; make a new context there, "
             "or start processes with `spawn`");
}

void Context::log(unsigned level, const char* tag, const std::string& message) const
{
    OxrtLogCallback callback;
    void* data;
    {
        const std::lock_guard lock(logMutex);
        if (!logCallback || level > logLevel) return;
        callback = logCallback;
        data = logData;
    }
    callback(level, tag, message.c_str(), data);
}

void Context::setLog(OxrtLogCallback callback, void* data, unsigned level)
{
    if (level > 4) fail(OXRT_ERROR_INVALID_VALUE, "log level is %u; give 0 (off) to 4 (everything)", level);
    const std::lock_guard lock(logMutex);
    logCallback = callback;
    logData = data;
    logLevel = level;
}

void Context::onEmbreeError(void* context, RTCError code, const char* text)
{
    auto& self = *static_cast<Context*>(context);
    const std::lock_guard lock(self.embreeErrorMutex);
    if (self.embreeError != RTC_ERROR_NONE) return;
    self.embreeError = code;
    self.embreeErrorText = text ? text : "";
}

bool Context::onEmbreeMemory(void* context, std::ptrdiff_t bytes, bool)
{
    static_cast<Context*>(context)->embreeBytes.fetch_add(bytes, std::memory_order_relaxed);
    return true;
}

void Context::checkEmbree(const char* action)
{
    RTCError code;
    std::string text;
    {
        const std::lock_guard lock(embreeErrorMutex);
        code = std::exchange(embreeError, RTC_ERROR_NONE);
        text = std::exchange(embreeErrorText, {});
    }
    if (code == RTC_ERROR_NONE) return;
    if (code == RTC_ERROR_OUT_OF_MEMORY)
        fail(OXRT_ERROR_HOST_OUT_OF_MEMORY, "%s: Embree ran out of memory; free accels or build a smaller scene", action);
    fail(OXRT_ERROR_INTERNAL_ERROR, "%s: Embree reported error %d: %s", action, static_cast<int>(code), text.c_str());
}

std::uint64_t Context::beginLaunch()
{
    std::unique_lock lock(launchMutex);
    changesDone.wait(lock, [this] { return changes == 0; });
    activeTickets.insert(++lastTicket);
    return lastTicket;
}

void Context::endLaunch(std::uint64_t ticket)
{
    std::vector<Retired> free; // destroyed after the lock is given back
    const std::lock_guard lock(launchMutex);
    activeTickets.erase(ticket);
    const std::uint64_t oldest = activeTickets.empty() ? lastTicket + 1 : *activeTickets.begin();
    const auto firstFree =
        std::partition(retired.begin(), retired.end(), [oldest](const Retired& entry) { return entry.ticket >= oldest; });
    std::move(firstFree, retired.end(), std::back_inserter(free));
    retired.erase(firstFree, retired.end());
}

void Context::retire(std::shared_ptr<const void> object)
{
    const std::lock_guard lock(launchMutex);
    if (!activeTickets.empty()) retired.push_back({lastTicket, std::move(object)});
}

void Context::beginChange(const char* action)
{
    const std::lock_guard lock(launchMutex);
    if (!activeTickets.empty())
        fail(OXRT_ERROR_INVALID_OPERATION, "%s while a launch of this context runs; wait for the launch first", action);
    ++changes;
}

void Context::endChange()
{
    {
        const std::lock_guard lock(launchMutex);
        --changes;
    }
    changesDone.notify_all();
}

void Context::addTraversable(std::uint64_t handle, std::weak_ptr<const Traversable> traversable)
{
    const std::lock_guard lock(traversableMutex);
    traversableOwners[handle] = std::move(traversable);
}

void Context::removeTraversable(std::uint64_t handle)
{
    const std::lock_guard lock(traversableMutex);
    traversableOwners.erase(handle);
}

std::shared_ptr<const Traversable> Context::findTraversable(std::uint64_t handle) const
{
    const std::lock_guard lock(traversableMutex);
    const auto entry = traversableOwners.find(handle);
    return entry == traversableOwners.end() ? nullptr : entry->second.lock();
}

} // namespace oxrt

using namespace oxrt;

OxrtResult oxrtContextCreate(const OxrtContextOptions* options, OxrtContext* context)
{
    return guard([&] {
        if (!context) fail(OXRT_ERROR_INVALID_VALUE, "the result pointer `context` is NULL");
        *context = nullptr;
        *context = publish(std::make_shared<Context>(options ? *options : OxrtContextOptions{}));
    });
}

OxrtResult oxrtContextDestroy(OxrtContext context)
{
    return guard([&] {
        const ContextObjects withdrawn = withdraw(context);
        for (const auto& pipeline : withdrawn.pipelines) pipeline->finishLaunch();
        removeTextures(withdrawn.context.get());
        for (const auto& accel : withdrawn.accels) accel->invalidate();
        for (const auto& transform : withdrawn.transforms) transform->invalidate();
    });
}

OxrtResult oxrtContextSetLogCallback(OxrtContext context, OxrtLogCallback callback, void* data, unsigned level)
{
    return guard([&] { find(context)->setLog(callback, data, level); });
}

OxrtResult oxrtContextGetInfo(OxrtContext context, OxrtContextInfo* info)
{
    return guard([&] {
        const auto self = find(context);
        if (!info) fail(OXRT_ERROR_INVALID_VALUE, "the result pointer `info` is NULL");
        *info = {};
        info->threads = self->threads;
        info->embreeVersion = self->embree.version;
        info->embreeMaxInstanceLevels = RTC_MAX_INSTANCE_LEVEL_COUNT;
        info->embreeBackfaceCulling = self->embree.backfaceCulling;
        info->isa = detectIsa();
        std::snprintf(info->embreePath, sizeof info->embreePath, "%s", self->embree.path.c_str());
    });
}
