// Whether an acceleration structure can be built from what a caller gave.
#pragma once

#include "oxrt/oxrt.h"

#include <span>

namespace oxrt {

class Context;

// Both throw Failure. `motion` is what holds for all inputs: one key if static.
void checkBuildOptions(const OxrtAccelBuildOptions& options);
void checkBuildInputs(const Context& context, std::span<const OxrtBuildInput> inputs, const OxrtMotionOptions& motion);

} // namespace oxrt
