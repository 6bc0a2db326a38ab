/* Texture look-up at level 0. Coordinates 0 to 1 span the image; texel centres lie at (i + 0.5) / size. */
#ifndef OXRT_DEVICE_TEXTURE_H
#define OXRT_DEVICE_TEXTURE_H

#include <oxrt/device_thread.h>
#include <oxrt/math.h>

namespace oxrt {
inline namespace OXRT_ISA {

OXRT_INLINE const OxrtTextureView* findTexture(const OxrtLaunch& launch, uint64_t handle) {
    const uint32_t slot = uint32_t(handle);
    if (slot >= launch.textureCount)
        return nullptr;
    const OxrtTextureSlot& found = launch.textures[slot];
    return found.generation == uint32_t(handle >> 32) ? found.view : nullptr;
}

/* The texel index for a wrapped coordinate, -1 for the border. */
OXRT_INLINE int32_t wrapTexel(int32_t i, int32_t size, uint32_t mode) {
    if (i >= 0 && i < size)
        return i;
    switch (mode) {
    case OXRT_WRAP_REPEAT: return modulo(i, size);
    case OXRT_WRAP_MIRROR: {
        const int32_t twice = modulo(i, 2 * size);
        return twice < size ? twice : 2 * size - 1 - twice;
    }
    case OXRT_WRAP_BORDER: return -1;
    default: return i < 0 ? 0 : size - 1;
    }
}

OXRT_INLINE float linearFromSrgb(float c) { return c <= 0.04045f ? c / 12.92f : pow((c + 0.055f) / 1.055f, 2.4f); }

/* One texel as four channels; missing colours are 0, a missing alpha 1. */
static inline float4 readTexel(const OxrtTextureView& texture, int32_t x, int32_t y) {
    const int32_t column = wrapTexel(x, int32_t(texture.width), texture.wrapU);
    const int32_t row = wrapTexel(y, int32_t(texture.height), texture.wrapV);
    if (column < 0 || row < 0)
        return {0.0f, 0.0f, 0.0f, 0.0f};
    const uint64_t first = (uint64_t(row) * texture.width + uint64_t(column)) * texture.channels;
    float4 texel = {0.0f, 0.0f, 0.0f, 1.0f};
    for (uint32_t c = 0; c < texture.channels; ++c) {
        float value;
        if (texture.format == OXRT_TEXTURE_UINT8) {
            value = float(static_cast<const uint8_t*>(texture.texels)[first + c]) * (1.0f / 255.0f);
            if (texture.srgb && c < 3)
                value = linearFromSrgb(value);
        } else
            value = static_cast<const float*>(texture.texels)[first + c];
        texel[int(c)] = value;
    }
    return texel;
}

/* The filtered colour at (u, v); zero for a handle that names no texture. */
static inline float4 tex2d(const OxrtThread& thread, uint64_t handle, float u, float v) {
    const OxrtTextureView* texture = findTexture(*thread.launch, handle);
    if (!texture)
        return {0.0f, 0.0f, 0.0f, 0.0f};
    const float x = u * float(texture->width);
    const float y = v * float(texture->height);
    if (texture->filter == OXRT_FILTER_NEAREST)
        return readTexel(*texture, convert<int32_t>(floor(x)), convert<int32_t>(floor(y)));
    const float left = floor(x - 0.5f);
    const float top = floor(y - 0.5f);
    const int32_t column = convert<int32_t>(left);
    const int32_t row = convert<int32_t>(top);
    const float s = x - 0.5f - left;
    const float t = y - 0.5f - top;
    const float4 upper = (1.0f - s) * readTexel(*texture, column, row) + s * readTexel(*texture, column + 1, row);
    const float4 lower = (1.0f - s) * readTexel(*texture, column, row + 1) + s * readTexel(*texture, column + 1, row + 1);
    return (1.0f - t) * upper + t * lower;
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
