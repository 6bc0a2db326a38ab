// See objects.h.
#include "objects.h"

#include "accel.h"
#include "context.h"
#include "opacity.h"
#include "pipeline.h"
#include "transform.h"

#include <atomic>
#include <mutex>
#include <pthread.h>
#include <unordered_map>

namespace oxrt {

namespace {

template <class Object>
using Table = std::unordered_map<const void*, std::shared_ptr<Object>>;

struct Objects {
    std::mutex mutex;
    Table<Context> contexts;
    Table<Accel> accels;
    Table<Transform> transforms;
    Table<MicromapArray> micromapArrays;
    Table<Pipeline> pipelines;
    std::atomic<unsigned> forks{0};
};

Objects& objects();

// The lock is held across fork(), so that the child finds it free and the tables whole.
void lockBeforeFork()
{
    objects().mutex.lock();
}

void unlockInParent()
{
    objects().mutex.unlock();
}

void unlockInChild()
{
    ++objects().forks;
    objects().mutex.unlock();
}

Objects& objects()
{
    // Never destroyed: threads may still run while the process exits.
    static Objects* const instance = [] {
        auto* made = new Objects;
        pthread_atfork(lockBeforeFork, unlockInParent, unlockInChild);
        return made;
    }();
    return *instance;
}

template <class Object>
const void* insert(Table<Object> Objects::* table, std::shared_ptr<Object> object)
{
    const std::lock_guard lock(objects().mutex);
    const void* key = object.get();
    (objects().*table)[key] = std::move(object);
    return key;
}

template <class Object>
std::shared_ptr<Object> lookUp(Table<Object> Objects::* table, const void* key, OxrtResult result, const char* name)
{
    if (!key) fail(result, "the %s is NULL", name);
    const std::lock_guard lock(objects().mutex);
    const auto entry = (objects().*table).find(key);
    if (entry == (objects().*table).end()) fail(result, "the %s does not exist (it was destroyed, or the pointer is of something else)", name);
    return entry->second;
}

template <class Object>
std::shared_ptr<Object> erase(Table<Object> Objects::* table, const void* key, OxrtResult result, const char* name)
{
    std::shared_ptr<Object> object = lookUp(table, key, result, name);
    const std::lock_guard lock(objects().mutex);
    if ((objects().*table).erase(key) == 0) fail(result, "the %s was destroyed by another thread meanwhile", name);
    return object;
}

template <class Object>
std::vector<std::shared_ptr<Object>> eraseOf(Table<Object>& table, const Context* context)
{
    std::vector<std::shared_ptr<Object>> erased;
    for (auto entry = table.begin(); entry != table.end();) {
        if (entry->second->context.get() == context) {
            erased.push_back(std::move(entry->second));
            entry = table.erase(entry);
        } else {
            ++entry;
        }
    }
    return erased;
}

template <class Handle>
Handle asHandle(const void* key)
{
    return reinterpret_cast<Handle>(const_cast<void*>(key));
}

} // namespace

OxrtContext publish(std::shared_ptr<Context> context)
{
    return asHandle<OxrtContext>(insert(&Objects::contexts, std::move(context)));
}

OxrtAccel publish(std::shared_ptr<Accel> accel)
{
    return asHandle<OxrtAccel>(insert(&Objects::accels, std::move(accel)));
}

OxrtTransform publish(std::shared_ptr<Transform> transform)
{
    return asHandle<OxrtTransform>(insert(&Objects::transforms, std::move(transform)));
}

OxrtOpacityMicromapArray publish(std::shared_ptr<MicromapArray> array)
{
    return asHandle<OxrtOpacityMicromapArray>(insert(&Objects::micromapArrays, std::move(array)));
}

OxrtPipeline publish(std::shared_ptr<Pipeline> pipeline)
{
    return asHandle<OxrtPipeline>(insert(&Objects::pipelines, std::move(pipeline)));
}

std::shared_ptr<Context> find(OxrtContext handle)
{
    auto context = lookUp(&Objects::contexts, handle, OXRT_ERROR_INVALID_DEVICE_CONTEXT, "context");
    context->checkProcess();
    return context;
}

std::shared_ptr<Accel> find(OxrtAccel handle)
{
    auto accel = lookUp(&Objects::accels, handle, OXRT_ERROR_INVALID_VALUE, "accel");
    accel->context->checkProcess();
    return accel;
}

std::shared_ptr<Transform> find(OxrtTransform handle)
{
    auto transform = lookUp(&Objects::transforms, handle, OXRT_ERROR_INVALID_VALUE, "transform");
    transform->context->checkProcess();
    return transform;
}

std::shared_ptr<MicromapArray> find(OxrtOpacityMicromapArray handle)
{
    auto array = lookUp(&Objects::micromapArrays, handle, OXRT_ERROR_INVALID_VALUE, "opacity micromap array");
    array->context->checkProcess();
    return array;
}

std::shared_ptr<Pipeline> find(OxrtPipeline handle)
{
    auto pipeline = lookUp(&Objects::pipelines, handle, OXRT_ERROR_INVALID_VALUE, "pipeline");
    pipeline->context->checkProcess();
    return pipeline;
}

std::shared_ptr<Accel> withdraw(OxrtAccel handle)
{
    find(handle);
    return erase(&Objects::accels, handle, OXRT_ERROR_INVALID_VALUE, "accel");
}

std::shared_ptr<Transform> withdraw(OxrtTransform handle)
{
    find(handle);
    return erase(&Objects::transforms, handle, OXRT_ERROR_INVALID_VALUE, "transform");
}

std::shared_ptr<MicromapArray> withdraw(OxrtOpacityMicromapArray handle)
{
    find(handle);
    return erase(&Objects::micromapArrays, handle, OXRT_ERROR_INVALID_VALUE, "opacity micromap array");
}

std::shared_ptr<Pipeline> withdraw(OxrtPipeline handle)
{
    find(handle);
    return erase(&Objects::pipelines, handle, OXRT_ERROR_INVALID_VALUE, "pipeline");
}

ContextObjects withdraw(OxrtContext handle)
{
    find(handle);
    ContextObjects withdrawn;
    withdrawn.context = erase(&Objects::contexts, handle, OXRT_ERROR_INVALID_DEVICE_CONTEXT, "context");
    const std::lock_guard lock(objects().mutex);
    withdrawn.accels = eraseOf(objects().accels, withdrawn.context.get());
    withdrawn.transforms = eraseOf(objects().transforms, withdrawn.context.get());
    withdrawn.micromapArrays = eraseOf(objects().micromapArrays, withdrawn.context.get());
    withdrawn.pipelines = eraseOf(objects().pipelines, withdrawn.context.get());
    return withdrawn;
}

std::vector<std::shared_ptr<Context>> liveContexts()
{
    std::vector<std::shared_ptr<Context>> live;
    const std::lock_guard lock(objects().mutex);
    for (const auto& entry : objects().contexts) live.push_back(entry.second);
    return live;
}

unsigned forkCount()
{
    return objects().forks;
}

} // namespace oxrt
