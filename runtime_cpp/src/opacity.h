// Opacity micromaps: arrays of them, and which one each triangle of a build input has.
#pragma once

#include "array.h"
#include "oxrt/oxrt.h"
#include "oxrt/pipeline.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace oxrt {

class Context;

// Never changes once it is made; accels share it.
class MicromapArray {
public:
    // Throws Failure for data, descriptors or histograms that do not fit each other.
    MicromapArray(std::shared_ptr<Context> owner, const OxrtOpacityMicromapArrayOptions& options);

    const std::shared_ptr<Context> context;
    const std::vector<OxrtMicromapView>& maps() const { return views; }
    // The first words are the states of triangles with predefined indices.
    const std::uint32_t* states() const { return words.data(); }

private:
    Array<std::uint32_t> words;
    std::vector<OxrtMicromapView> views;
};

// Throws Failure.
void checkMicromaps(const OxrtOpacityMicromapInput& input, const Context& context, std::uint64_t triangles, unsigned number);

// The micromaps of one build input's triangles.
class Micromaps {
public:
    void copy(const OxrtBuildInput& input);
    // Whether a build input has the micromaps that were copied.
    bool isSame(const OxrtBuildInput& input) const;
    // What kernels read; null without micromaps.
    void describe(OxrtGeometry& view) const;
    std::size_t bytes() const { return views.bytes(); }

private:
    Array<OxrtMicromapView> views;
    std::shared_ptr<const MicromapArray> array;
};

} // namespace oxrt
