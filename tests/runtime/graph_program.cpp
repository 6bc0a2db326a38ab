// A ray generation program of the hand-written pipeline that traces by the device library, through graphs and motion.
#include "oxrt/device.h"
#include "tiny_params.h"

#include <cstdint>

namespace {

struct GraphPrograms : oxrt::NoPrograms {
    struct Payload {
        TinyHit hit;
    };
    static constexpr bool hasClosestHit = true;
    static constexpr bool hasMiss = true;
    static constexpr bool usesTime = true;
    static constexpr bool usesMicromaps = true;

    // Records hold nothing here: what a hit is, is read from the ray.
    static void closestHit(oxrt::Ray&, Payload&, const OxrtRecordHeader&) {}
    static void miss(oxrt::Ray&, Payload&, const OxrtRecordHeader&) {}
};

TinyHit traceOne(OxrtThread& thread, const TinyParams& params)
{
    TinyHit result = {-1, 0, ~0u, ~0u, ~0u, ~0u};
    GraphPrograms::Payload payload = {};
    oxrt::Ray ray;
    oxrt::GraphPath path;
    const oxrt::float3 origin((static_cast<float>(thread.index[0]) + 0.5f) * params.cellSize,
                              (static_cast<float>(thread.index[1]) + 0.5f) * params.cellSize, -1);
    oxrt::setRay<GraphPrograms>(ray, thread, params.scene, origin, oxrt::float3(0, 0, 1), 0, 1e6f, params.time, params.rayMask, 0, 0, 1, 0,
                                payload, oxrt::Place::current());
    if (!oxrt::canHit(ray) || !oxrt::findClosest<GraphPrograms, uint32_t>(ray, path)) return result;
    result.t = ray.t;
    result.primitive = oxrt::getPrimitiveIndex(ray);
    result.geometry = oxrt::getTransformListSize(ray);
    result.instance = oxrt::getInstanceId(ray);
    result.record = oxrt::instanceSbtOffset(ray) + oxrt::getSbtGASIndex(ray);
    return result;
}

} // namespace

void runGraph(OxrtThread* thread, const OxrtTile* tile)
{
    const TinyParams& params = *static_cast<const TinyParams*>(thread->params);
    for (std::uint32_t y = tile->begin[1]; y < tile->end[1]; ++y)
        for (std::uint32_t x = tile->begin[0]; x < tile->end[0]; ++x) {
            thread->index[0] = x;
            thread->index[1] = y;
            params.hits[y * thread->launch->width + x] = traceOne(*thread, params);
        }
}
