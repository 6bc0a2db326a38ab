// See texture.h.
#include "texture.h"

#include "array.h"
#include "context.h"
#include "error.h"
#include "objects.h"

#include <cstdint>
#include <memory>
#include <mutex>
#include <pthread.h>
#include <unordered_map>
#include <vector>

namespace oxrt {

namespace {

constexpr std::uint32_t maxSide = 1u << 16;
constexpr std::uint32_t maxTextures = 1u << 20;

using View = std::shared_ptr<const OxrtTextureView>;

struct Owned {
    const Context* context; // null: nobody destroys it but its maker
    View view;
};

struct Textures {
    std::mutex mutex;
    SlotTable<OxrtTextureSlot> slots{maxTextures};
    std::unordered_map<std::uint64_t, Owned> owners;
};

Textures& textures();

// The lock is held across fork(), so that the child finds it free and the table whole.
void lockBeforeFork()
{
    textures().mutex.lock();
}

void unlockAfterFork()
{
    textures().mutex.unlock();
}

Textures& textures()
{
    // Never destroyed: threads may still run while the process exits.
    static Textures* const instance = [] {
        auto* made = new Textures;
        pthread_atfork(lockBeforeFork, unlockAfterFork, unlockAfterFork);
        return made;
    }();
    return *instance;
}

struct Texture {
    Array<std::uint8_t> texels;
    OxrtTextureView view = {};
};

void checkTexture(const OxrtTextureOptions& options)
{
    if (!options.texels) fail(OXRT_ERROR_INVALID_VALUE, "texture: texels is NULL");
    if (options.width == 0 || options.height == 0 || options.width > maxSide || options.height > maxSide)
        fail(OXRT_ERROR_INVALID_VALUE, "texture: the size is %u x %u; give 1 to %u on each side", options.width, options.height, maxSide);
    if (options.channels == 0 || options.channels > 4)
        fail(OXRT_ERROR_INVALID_VALUE, "texture: %u channels; give 1 to 4", options.channels);
    if (options.format > OXRT_TEXTURE_UINT8) fail(OXRT_ERROR_INVALID_VALUE, "texture: format %u is unknown", options.format);
    if (options.filter > OXRT_FILTER_LINEAR) fail(OXRT_ERROR_INVALID_VALUE, "texture: filter %u is unknown", options.filter);
    if (options.wrapU > OXRT_WRAP_BORDER || options.wrapV > OXRT_WRAP_BORDER)
        fail(OXRT_ERROR_INVALID_VALUE, "texture: wrap (%u, %u) is unknown", options.wrapU, options.wrapV);
    if (options.srgb > 1) fail(OXRT_ERROR_INVALID_VALUE, "texture: srgb is %u; give 0 or 1", options.srgb);
    if (options.srgb == 1 && options.format != OXRT_TEXTURE_UINT8)
        fail(OXRT_ERROR_INVALID_VALUE, "texture: srgb decoding needs uint8 texels; convert float texels beforehand");
}

View makeTexture(const OxrtTextureOptions& options)
{
    checkTexture(options);
    const std::size_t texelSize = options.channels * (options.format == OXRT_TEXTURE_FLOAT32 ? sizeof(float) : 1);
    auto texture = std::make_shared<Texture>();
    texture->texels =
        Array<std::uint8_t>(static_cast<const std::uint8_t*>(options.texels), std::size_t(options.width) * options.height * texelSize);
    texture->view = {texture->texels.data(), options.width, options.height, options.channels, options.format,
                     options.filter,         options.wrapU, options.wrapV,  options.srgb};
    return {texture, &texture->view};
}

std::uint64_t add(const Context* context, View view)
{
    Textures& all = textures();
    const std::lock_guard lock(all.mutex);
    const std::uint64_t handle = all.slots.add(view.get());
    all.owners[handle] = {context, std::move(view)};
    return handle;
}

void remove(const Context* context, std::uint64_t handle)
{
    View view;
    {
        Textures& all = textures();
        const std::lock_guard lock(all.mutex);
        const auto entry = all.owners.find(handle);
        if (entry == all.owners.end() || entry->second.context != context)
            fail(OXRT_ERROR_INVALID_VALUE, "texture handle 0x%llx is not alive%s", static_cast<unsigned long long>(handle),
                 context ? " in this context" : "");
        view = std::move(entry->second.view);
        all.owners.erase(entry);
        all.slots.remove(handle);
    }
    for (const auto& reader : liveContexts()) reader->retire(view);
}

// Runs the body for a context, or for none.
template <class Body>
void attemptFor(OxrtContext context, Body&& body)
{
    if (!context) return body(nullptr);
    const auto owner = find(context);
    owner->attempt("TEXTURE", [&] { body(owner.get()); });
}

} // namespace

TextureSlots textureSlots()
{
    Textures& all = textures();
    const std::lock_guard lock(all.mutex);
    return {all.slots.data(), all.slots.size()};
}

void removeTextures(const Context* context)
{
    std::vector<std::uint64_t> handles;
    {
        Textures& all = textures();
        const std::lock_guard lock(all.mutex);
        for (const auto& [handle, owned] : all.owners)
            if (owned.context == context) handles.push_back(handle);
    }
    for (const std::uint64_t handle : handles) remove(context, handle);
}

} // namespace oxrt

using namespace oxrt;

OxrtResult oxrtTextureCreate(OxrtContext context, const OxrtTextureOptions* options, uint64_t* handle)
{
    return guard([&] {
        attemptFor(context, [&](const Context* owner) {
            if (!options || !handle) fail(OXRT_ERROR_INVALID_VALUE, "the %s is NULL", options ? "result pointer `handle`" : "options");
            *handle = add(owner, makeTexture(*options));
        });
    });
}

OxrtResult oxrtTextureDestroy(OxrtContext context, uint64_t handle)
{
    return guard([&] { attemptFor(context, [&](const Context* owner) { remove(owner, handle); }); });
}
