// Splits an image over threads in tiles of 32x32 and times it.
#ifndef BENCH_LAUNCH_H
#define BENCH_LAUNCH_H

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "algebra.h"
#ifdef BENCH_RECORD
#include "limit.h"
#endif

namespace bench {

enum { TILE = 32 };

// One per thread and launch; a cache line of its own.
struct alignas(64) Worker {
    uint64_t rays = 0;
};

// Calls kernel(worker, x0, y0, x1, y1) for every tile.
template <class Kernel> void launch(BenchJob& job, Kernel kernel) {
    const auto start = std::chrono::steady_clock::now();
    const uint32_t columns = (job.width + TILE - 1) / TILE, rows = (job.height + TILE - 1) / TILE;
    std::atomic<uint32_t> next{0};
    std::vector<Worker> workers(job.threads);
    const auto work = [&](unsigned thread) {
        const unsigned before = _mm_getcsr();
        _mm_setcsr(before | 0x8040);  // flush denormals, as Embree's manual asks for
        Worker worker;
        for (uint32_t tile; (tile = next.fetch_add(1, std::memory_order_relaxed)) < columns * rows;) {
            const uint32_t x = tile % columns * TILE, y = tile / columns * TILE;
            kernel(worker, x, y, x + TILE < job.width ? x + TILE : job.width, y + TILE < job.height ? y + TILE : job.height);
        }
        workers[thread] = worker;
        _mm_setcsr(before);
    };
    std::vector<std::thread> threads;
    for (unsigned i = 1; i < job.threads; i++) threads.emplace_back(work, i);
    work(0);
    for (std::thread& thread : threads) thread.join();
    job.rays = 0;
    for (const Worker& worker : workers) job.rays += worker.rays;
    job.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

BENCH_INLINE uint32_t imageRow(const BenchJob& job, uint32_t y) { return y + y / 16 * job.skip; }

BENCH_INLINE void writePixel(const BenchJob& job, uint32_t x, uint32_t y, Float3 color) {
    float* pixel = job.image + (size_t(y) * job.width + x) * 4;
    _mm_storeu_ps(pixel, _mm_setr_ps(color.x, color.y, color.z, 1.0f));
}

// Calls kernel(worker, x, y) for every pixel.
template <class Kernel> void launchPixels(BenchJob& job, Kernel kernel) {
    launch(job, [&](Worker& worker, uint32_t x0, uint32_t y0, uint32_t x1, uint32_t y1) {
#ifdef BENCH_RECORD
        // in the order of packets
        for (uint32_t by = y0; by < y1; by += BLOCK_HEIGHT)
            for (uint32_t bx = x0; bx < x1; bx += 4)
                for (uint32_t i = 0; i < LANES; i++) {
                    const uint32_t x = bx + i % 4, y = by + i / 4;
                    recorder().beginPixel();
                    if (x < x1 && y < y1) kernel(worker, x, y);
                }
#else
        for (uint32_t y = y0; y < y1; y++)
            for (uint32_t x = x0; x < x1; x++) kernel(worker, x, y);
#endif
    });
}

// A packet's pixels: 4x4 or 4x2 of them from (x, y); `active` are those inside the image.
struct Block {
    uint32_t x, y;
    WideUint px, py;  // in the whole image
    Mask active;
};

template <class Kernel> void launchBlocks(BenchJob& job, Kernel kernel) {
    launch(job, [&](Worker& worker, uint32_t x0, uint32_t y0, uint32_t x1, uint32_t y1) {
        const WideUint lane = laneIndices(), dx = lane & WideUint(3u), dy = lane >> 2u;
        for (uint32_t y = y0; y < y1; y += BLOCK_HEIGHT)
            for (uint32_t x = x0; x < x1; x += 4) {
                const Mask active = (dx < WideUint(x1 - x)) & (dy < WideUint(y1 - y));
                kernel(worker, Block{x, y, WideUint(x) + dx, WideUint(imageRow(job, y)) + dy, active});
            }
    });
}

inline void writeBlock(const BenchJob& job, const Block& block, Wide3 color) {
#if defined(__AVX512F__)
    if (bitsOf(block.active) == 0xFFFF) {
        // four transposes of 4x4: lane i of 128 bits is image row i, then whole rows of four pixels are gathered
        const __m512 a = Wide(1.0f).v;
        const __m512 rg0 = _mm512_unpacklo_ps(color.x.v, color.y.v), rg1 = _mm512_unpackhi_ps(color.x.v, color.y.v);
        const __m512 ba0 = _mm512_unpacklo_ps(color.z.v, a), ba1 = _mm512_unpackhi_ps(color.z.v, a);
        const __m512 p0 = _mm512_shuffle_ps(rg0, ba0, 0x44), p1 = _mm512_shuffle_ps(rg0, ba0, 0xEE);
        const __m512 p2 = _mm512_shuffle_ps(rg1, ba1, 0x44), p3 = _mm512_shuffle_ps(rg1, ba1, 0xEE);
        const __m512 a01 = _mm512_shuffle_f32x4(p0, p1, 0x44), a23 = _mm512_shuffle_f32x4(p2, p3, 0x44);
        const __m512 b01 = _mm512_shuffle_f32x4(p0, p1, 0xEE), b23 = _mm512_shuffle_f32x4(p2, p3, 0xEE);
        float* row = job.image + (size_t(block.y) * job.width + block.x) * 4;
        const size_t pitch = size_t(job.width) * 4;
        _mm512_storeu_ps(row, _mm512_shuffle_f32x4(a01, a23, 0x88));
        _mm512_storeu_ps(row + pitch, _mm512_shuffle_f32x4(a01, a23, 0xDD));
        _mm512_storeu_ps(row + 2 * pitch, _mm512_shuffle_f32x4(b01, b23, 0x88));
        _mm512_storeu_ps(row + 3 * pitch, _mm512_shuffle_f32x4(b01, b23, 0xDD));
        return;
    }
#endif
    alignas(64) float r[LANES], g[LANES], b[LANES];
    store(r, color.x);
    store(g, color.y);
    store(b, color.z);
    for (unsigned lane = 0, bits = bitsOf(block.active); bits >> lane; lane++)
        if (bits >> lane & 1) writePixel(job, block.x + (lane & 3), block.y + (lane >> 2), {r[lane], g[lane], b[lane]});
}

}  // namespace bench
#endif
