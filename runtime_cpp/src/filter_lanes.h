// The lanes of a packet in a geometry filter. Embree offers spheres and curves to one lane of a packet at a time, so the lanes that count
// are found first, and everything else is done for them alone.
#pragma once

#include "oxrt/embree.h"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace oxrt {

enum RayField { ORIGIN = 0, TNEAR = 3, DIRECTION = 4, TIME = 7, TFAR = 8 };
enum HitField { NORMAL = 0, PRIMITIVE = 5 };

// Where field `field` of lane `lane` stands in a packet of `width`; the fields follow each other as in RTCRay and RTCHit.
inline float& fieldOf(void* packet, unsigned field, unsigned width, unsigned lane)
{
    return static_cast<float*>(packet)[field * width + lane];
}

// One bit for each lane that is valid.
inline unsigned validLanes(const RTCFilterFunctionNArguments& arguments)
{
    const int* const valid = arguments.valid;
    if (arguments.N == 1) return valid[0] == -1;
    unsigned lanes = 0;
#if defined(__SSE2__)
    for (unsigned lane = 0; lane < arguments.N; lane += 4) {
        const __m128i four = _mm_loadu_si128(reinterpret_cast<const __m128i*>(valid + lane));
        lanes |= static_cast<unsigned>(_mm_movemask_ps(_mm_castsi128_ps(four))) << lane;
    }
#else
    for (unsigned lane = 0; lane < arguments.N; ++lane) lanes |= static_cast<unsigned>(valid[lane] == -1) << lane;
#endif
    return lanes;
}

template <class F> void eachValidLane(const RTCFilterFunctionNArguments& arguments, F&& f)
{
    for (unsigned lanes = validLanes(arguments); lanes != 0; lanes &= lanes - 1) f(static_cast<unsigned>(__builtin_ctz(lanes)));
}

// Whether the ray enters the surface in this lane; else it leaves it.
inline bool isEntered(const RTCFilterFunctionNArguments& arguments, unsigned lane)
{
    const unsigned width = arguments.N;
    const float* const direction = &fieldOf(arguments.ray, DIRECTION, width, lane);
    const float* const normal = &fieldOf(arguments.hit, NORMAL, width, lane);
    return direction[0] * normal[0] + direction[width] * normal[width] + direction[2 * width] * normal[2 * width] < 0;
}

} // namespace oxrt
