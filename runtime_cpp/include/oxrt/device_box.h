/* Four floats at once, and whether a ray meets a box: where Embree offers primitives of user geometry without looking at their boxes. */
#ifndef OXRT_DEVICE_BOX_H
#define OXRT_DEVICE_BOX_H

#include <oxrt/vectors.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* Four numbers in a register: of points and vectors the fourth says nothing. */
using Quad = float __attribute__((vector_size(16), may_alias, aligned(4)));

OXRT_INLINE Quad quadAt(const float* numbers) {
    Quad quad;
    __builtin_memcpy(&quad, numbers, sizeof(quad));
    return quad;
}

/* Inside of the interval, faces included; in doubt it does. The box is its lower corner and its upper one, and empty where they are the
   other way round. Of the ray's fourth numbers nothing counts. */
OXRT_INLINE bool meetsBox(Quad origin, Quad direction, const float* box, float tmin, float tmax) {
    const Quad last = quadAt(box + 2);
    const Quad positive = direction + 0.0f; /* no negative zero */
    const Quad lower = (quadAt(box) - origin) / positive;
    const Quad upper = (__builtin_shufflevector(last, last, 1, 2, 3, 3) - origin) / positive;
    const auto isRising = positive >= 0.0f;
    const Quad near = isRising ? lower : upper;
    const Quad far = isRising ? upper : lower;
    float enter = tmin;
    float leave = tmax;
    for (int axis = 0; axis < 3; ++axis) {
        /* 0 / 0, where the ray runs along a face, changes nothing */
        enter = near[axis] > enter ? near[axis] : enter;
        leave = far[axis] < leave ? far[axis] : leave;
    }
    constexpr float rounding = 1e-6f;
    return !(enter > leave * (leave < 0.0f ? 1.0f - rounding : 1.0f + rounding)); /* no sum, since it may be infinite */
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
