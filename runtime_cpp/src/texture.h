// Textures: texels copied once, seen by the programs of every context through one slot table of the process.
#pragma once

#include "oxrt/pipeline.h"

#include <cstdint>

namespace oxrt {

class Context;

struct TextureSlots {
    const OxrtTextureSlot* slots;
    std::uint32_t count;
};

// What a launch that begins now can see.
TextureSlots textureSlots();

// Destroys the textures that were made for a context; launches that run keep theirs.
void removeTextures(const Context* context);

} // namespace oxrt
