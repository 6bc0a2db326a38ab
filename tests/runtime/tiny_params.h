// What the tests and the hand-written pipeline share.
#pragma once

#include "oxrt/pipeline.h"

#include <atomic>
#include <cstdint>

struct TinyHit {
    float t;
    float tmaxSeenByMiss;
    std::uint32_t geometry, primitive, instance, record;
};

struct TinyParams {
    TinyHit* hits;         // one per launch index
    std::uint32_t* visits; // one per launch index
    std::atomic<std::uint32_t>* started;
    const float* directions; // 3 per index or null: +z
    std::uint64_t scene;
    std::uint64_t texture;
    std::uint32_t rayMask;
    float cellSize;                // rays start at ((x + 1/2) cellSize, (y + 1/2) cellSize, -1)
    std::uint32_t useIntersection; // 1: custom primitives are hit at the entry of their box
    std::uint32_t faultIndex;
    float time;
};

struct TinyRecord {
    float value;
};
