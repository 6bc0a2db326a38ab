// What a handle can lead to on the host side: an acceleration structure or a transform above one.
#pragma once

#include "oxrt/embree.h"
#include "oxrt/pipeline.h"

#include <cstdint>

namespace oxrt {

class Traversable {
public:
    virtual ~Traversable() = default;
    Traversable(const Traversable&) = delete;
    Traversable& operator=(const Traversable&) = delete;

    // What kernels see; it stays at its address.
    const OxrtTraversableView& traversable() const { return view; }
    std::uint64_t handle() const { return view.handle; }
    // How many traversables the longest way down holds, this one included.
    unsigned graphDepth() const { return view.graphDepth; }
    // A box around everything below at all times from `begin` to `end`, which may be infinite. Vanishing is not looked at.
    virtual RTCBounds boundsDuring(float begin, float end) const = 0;

protected:
    Traversable() = default;

    OxrtTraversableView view = {};
};

constexpr unsigned maxGraphDepth = 31;

} // namespace oxrt
