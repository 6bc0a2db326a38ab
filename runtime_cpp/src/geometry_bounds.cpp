// Boxes around the primitives of a geometry at one motion key.
#include "geometry.h"
#include "matrix.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace oxrt {

namespace {

// Empty for a triangle that is never hit: with a corner that is no number, or two in one place.
RTCBounds boundsOfTriangle(const float* vertices, const std::uint32_t* corners)
{
    RTCBounds bounds = emptyBounds();
    for (int corner = 0; corner < 3; ++corner) {
        const float* p = vertices + 3 * std::size_t(corners[corner]);
        const float* next = vertices + 3 * std::size_t(corners[(corner + 1) % 3]);
        if (std::equal(p, p + 3, next)) return bounds;
    }
    for (int corner = 0; corner < 3; ++corner) {
        const float* p = vertices + 3 * std::size_t(corners[corner]);
        if (!std::isfinite(p[0] + p[1] + p[2])) return emptyBounds();
        extend(bounds, {p[0], p[1], p[2], 0, p[0], p[1], p[2], 0});
    }
    return bounds;
}

} // namespace

RTCBounds boundsOfBox(const float* box)
{
    const bool ordered = box[0] <= box[3] && box[1] <= box[4] && box[2] <= box[5];
    const bool extended = box[0] < box[3] || box[1] < box[4] || box[2] < box[5];
    if (!ordered || !extended) return emptyBounds();
    const auto limit = [](float value) { return std::clamp(value, static_cast<float>(-farthest), static_cast<float>(farthest)); };
    return {limit(box[0]), limit(box[1]), limit(box[2]), 0, limit(box[3]), limit(box[4]), limit(box[5]), 0};
}

RTCBounds Geometry::boundsAt(std::uint32_t key) const
{
    RTCBounds bounds = emptyBounds();
    for (std::uint32_t primitive = 0; primitive < view.primitiveCount; ++primitive) {
        RTCBounds own;
        if (shape)
            own = shape->boundsAt(view, primitive, key);
        else if (inputType == OXRT_BUILD_INPUT_TRIANGLES)
            own = boundsOfTriangle(view.vertices + 3 * view.vertexCount * key, view.indices + 3 * std::size_t(primitive));
        else
            own = boundsOfBox(view.vertices + 6 * (view.vertexCount * key + primitive));
        if (!isEmpty(own)) extend(bounds, own);
    }
    return bounds;
}

} // namespace oxrt
