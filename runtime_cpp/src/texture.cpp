// Textures: texels copied once, seen by kernels through the context's slot table.
#include "array.h"
#include "context.h"
#include "error.h"
#include "objects.h"

#include <limits>

namespace oxrt {

namespace {

constexpr std::uint32_t maxSide = 1u << 16;

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

std::shared_ptr<const OxrtTextureView> makeTexture(const OxrtTextureOptions& options)
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

} // namespace

} // namespace oxrt

using namespace oxrt;

OxrtResult oxrtTextureCreate(OxrtContext context, const OxrtTextureOptions* options, uint64_t* handle)
{
    return guard([&] {
        const auto owner = find(context);
        owner->attempt("TEXTURE", [&] {
            if (!options || !handle) fail(OXRT_ERROR_INVALID_VALUE, "the %s is NULL", options ? "result pointer `handle`" : "options");
            *handle = owner->addTexture(makeTexture(*options));
        });
    });
}

OxrtResult oxrtTextureDestroy(OxrtContext context, uint64_t handle)
{
    return guard([&] {
        const auto owner = find(context);
        owner->attempt("TEXTURE", [&] { owner->removeTexture(handle); });
    });
}
