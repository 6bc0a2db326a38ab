// Launches of a pipeline that does nothing, timed without Python in between.
#include <oxrt/oxrt.h>

#include <algorithm>
#include <chrono>
#include <vector>

using LaunchFunction = OxrtResult (*)(OxrtPipeline, const void*, size_t, const OxrtShaderBindingTable*, uint32_t, uint32_t, uint32_t);

// Median microseconds of `count` launches, -1 if one fails.
extern "C" __attribute__((visibility("default"))) double bench_launch_overhead(void* launch, void* pipeline, const void* params, size_t size,
                                                                                const void* table, uint32_t width, uint32_t height,
                                                                                uint32_t count) {
    const LaunchFunction function = reinterpret_cast<LaunchFunction>(launch);
    std::vector<double> microseconds;
    for (uint32_t i = 0; i < count; i++) {
        const auto start = std::chrono::steady_clock::now();
        if (function(static_cast<OxrtPipeline>(pipeline), params, size, static_cast<const OxrtShaderBindingTable*>(table), width, height, 1))
            return -1.0;
        microseconds.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count());
    }
    std::nth_element(microseconds.begin(), microseconds.begin() + count / 2, microseconds.end());
    return microseconds[count / 2];
}
