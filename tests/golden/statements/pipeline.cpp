/* Made by optixc. Compiled features:
   loops that poll for cancellation: shader.py:43
   array bounds checks: shader.py:77
*/
#include <oxrt/device.h>

namespace {

struct Params {
    oxrt::Array<int32_t, 1> numbers;
    int32_t count;
    int32_t step;
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_main };
}

int32_t factorial(int32_t n);

// Turns until 1; the loop has no provable bound.
#line 18 "shader.py"
int32_t collatz(OxrtThread& thread, int32_t n) {
#line 20 "shader.py"
    int32_t turns = 0;
    while (n != 1 && !oxrt::isCancelled(thread)) {
        n = oxrt::modulo(n, 2) == 0 ? oxrt::floorDivide(n, 2) : 3 * n + 1;
        turns = turns + 1;
    }
#line 24 "shader.py"
    return turns;
}

#line 28 "shader.py"
oxrt::Tuple<int32_t, int32_t> divide(int32_t a, int32_t b) {
    return oxrt::makeTuple(oxrt::floorDivide(a, b), oxrt::modulo(a, b));
}

#line 33 "shader.py"
int32_t factorial(int32_t n) {
    if (n <= 1) {
        return 1;
    }
#line 36 "shader.py"
    int32_t result = factorial(n - 1);
#line 36 "shader.py"
    return n * result;
}

#line 40 "shader.py"
void raygen_main(OxrtThread& thread) {
    const Params& params = oxrt::launchParams<Params>(thread);
    int32_t kept{};
#line 41 "shader.py"
    uint32_t i = oxrt::getLaunchIndex(thread).x;
    int32_t total = 0;
    for (int32_t k : oxrt::Range<int32_t>(0, params.count, 1)) {
#line 43 "shader.py"
        if (oxrt::isCancelled(thread))
            break;
#line 44 "shader.py"
        if (k == 3) {
            continue;
        } else if (k > 10) {
            break;
        } else {
            total = total + k;
        }
    }
#line 50 "shader.py"
    for (int32_t k : oxrt::Range<int32_t>(10, 0, params.step)) {
#line 50 "shader.py"
        if (oxrt::isCancelled(thread))
            break;
#line 51 "shader.py"
        total = total - k;
    }
#line 52 "shader.py"
    for (int32_t k = 0; k < 4; ++k) {
        int32_t last = k * total;
        total = total + last;
    }
#line 55 "shader.py"
    int32_t found = -1;
    while (found < 0 && !oxrt::isCancelled(thread)) {
        found = collatz(thread, total);
        if (found == 7) {
            break;
        }
    }
#line 60 "shader.py"
    while (found < 10) {
        found = found + 1;
    }
#line 62 "shader.py"
    oxrt::Tuple<int32_t, int32_t> items = divide(total, 7);
#line 62 "shader.py"
    int32_t quotient = oxrt::get<0>(items);
#line 62 "shader.py"
    int32_t rest = oxrt::get<1>(items);
    int32_t value = quotient;
#line 63 "shader.py"
    quotient = rest;
#line 63 "shader.py"
    rest = value;
    if (total > 5) {
        kept = quotient;
    } else {
        kept = rest;
    }
#line 68 "shader.py"
    oxrt::float2 pair = oxrt::float2(1.0f, 2.0f);
    pair.x = float(kept);
#line 71 "shader.py"
    if (kept == 0 || kept == 1) {
        total = factorial(5);
    } else if (kept == 2) {
        total = 2;
    } else {
        total = total + oxrt::convert<int32_t>(pair.x);
    }
#line 77 "shader.py"
    if (oxrt::checked(thread).contains(params.numbers, i))
#line 77 "shader.py"
        params.numbers.at(i) = total;
}

#line 130 "pipeline.cpp"
void run_raygen_main(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::forEachIndex(*thread, *tile, [thread] {
        raygen_main(*thread);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__main", OXRT_KIND_RAYGEN, 0, run_raygen_main},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 1, programs, 1}};
static_assert(sizeof(Params) == 24);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 24, 1, "0.1.0"};
