// 3x4 row-major matrices and the boxes that they move.
#pragma once

#include "oxrt/embree.h"

namespace oxrt {

// In double precision; false, and zeros, where no finite inverse exists.
bool invert(const float (&matrix)[12], float (&inverse)[12]);

// A number that is only known to lie between two others.
struct Interval {
    double lower, upper;
};

// Embree drops primitives that reach further.
constexpr double farthest = 1.8e18;

RTCBounds emptyBounds();
bool isEmpty(const RTCBounds& bounds);
void extend(RTCBounds& bounds, const RTCBounds& other);
// As kernels read boxes.
inline void storeBox(const RTCBounds& bounds, float* box)
{
    const float numbers[6] = {bounds.lower_x, bounds.lower_y, bounds.lower_z, bounds.upper_x, bounds.upper_y, bounds.upper_z};
    for (int i = 0; i < 6; ++i) box[i] = numbers[i];
}

// A box around the images of `bounds` under every matrix whose elements lie in the intervals, with room for the rounding of kernels.
RTCBounds imageOf(const Interval (&matrix)[12], const RTCBounds& bounds);
RTCBounds imageOf(const float* matrix, const RTCBounds& bounds);

} // namespace oxrt
