// The limit: how long pure traversal of a workload's own rays takes, in each form. Only in builds with BENCH_RECORD, where the scalar
// kernel notes its rays, pixel by pixel in the order in which packets hold them.
#ifndef BENCH_LIMIT_H
#define BENCH_LIMIT_H

#include <time.h>
#include <vector>

#include "algebra.h"

namespace bench {

struct RecordedRay {
    Float3 origin, direction;
    float tfar;
};

// Classes of rays: those that seek a hit and shadow rays, each by how many rays of the pixel had sought a hit before.
class Recorder {
public:
    void beginPixel() { sought = 0; }
    void seek(RecordedRay ray) {
        at(hits, sought).push_back(ray);
        sought++;
    }
    void shadow(RecordedRay ray) { at(shadows, sought - 1).push_back(ray); }
    std::vector<std::vector<RecordedRay>> hits, shadows;

private:
    static constexpr unsigned LAST = 8;
    unsigned sought = 0;
    static std::vector<RecordedRay>& at(std::vector<std::vector<RecordedRay>>& classes, unsigned number) {
        if (number > LAST) number = LAST;
        if (classes.size() <= number) classes.resize(number + 1);
        return classes[number];
    }
};

inline Recorder& recorder() {
    static Recorder one;
    return one;
}

// Ray i of a list in another order: within 256 rays, 16 by 16 transposed. All 16 rays of a point come one after the other in ambient
// occlusion; so a packet holds one of each of 16 points.
inline size_t transposed(size_t i, size_t count) {
    const size_t chunk = i & ~size_t(255);
    return chunk + 256 > count ? i : chunk + ((i & 15) << 4) + ((i & 255) >> 4);
}

// Processor time of this thread, which traces alone.
inline double processorSeconds() {
    timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}
template <class Body> double secondsOf(Body body) {
    const double start = processorSeconds();
    body();
    return processorSeconds() - start;
}

}  // namespace bench
#endif
