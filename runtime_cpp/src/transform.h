// A transform as a traversable of its own: static, or moving by matrix or SRT keys.
#pragma once

#include "array.h"
#include "oxrt/oxrt.h"
#include "traversable.h"

#include <memory>

namespace oxrt {

class Context;

class Transform final : public Traversable {
public:
    // Throws Failure and leaves nothing behind. Keeps the child alive.
    static std::shared_ptr<Transform> make(std::shared_ptr<Context> context, const OxrtTransformOptions& options);
    // Use make(): this only prepares.
    Transform(std::shared_ptr<Context> owner, const OxrtTransformOptions& options, std::shared_ptr<const Traversable> below);
    ~Transform() override;

    // Makes the handle stale; may be called again.
    void invalidate();

    RTCBounds boundsDuring(float begin, float end) const override;

    const std::shared_ptr<Context> context;

private:
    const OxrtMotionOptions motion;
    const std::shared_ptr<const Traversable> child;
    Array<float> keys;
};

} // namespace oxrt
