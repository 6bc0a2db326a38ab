// Motion: checked options, and boxes around what moves. Kernels evaluate the same motion in oxrt/device_motion.h.
#pragma once

#include "oxrt/embree.h"
#include "oxrt/oxrt.h"

namespace oxrt {

// Of a structure: up to one key is static. Throws Failure for flags, times or an order that mean nothing.
void checkMotion(const OxrtMotionOptions& motion);
// Of a motion transform: at least two keys, begin before end.
void checkTransformMotion(const OxrtMotionOptions& motion);

// Where times lie between the keys 0 to numKeys - 1, clamped.
double keyPosition(const OxrtMotionOptions& motion, float time);

// A box around everything that `bounds` passes between two key positions. `keys`: 12 floats each, 16 in the SRT form.
RTCBounds sweptByMatrices(const float* keys, double begin, double end, const RTCBounds& bounds);
RTCBounds sweptBySrt(const float* keys, double begin, double end, const RTCBounds& bounds);

} // namespace oxrt
