/* Made by optixc. Compiled features:
   loops that poll for cancellation: shader.py:43
   array bounds checks: shader.py:77
*/
#include <oxrt/device.h>

#include <oxrt/lanes_trace.h>

namespace {

enum { LANES = 16 };
template <class T> using Wide = oxrt::Wide<T, LANES>;
using Mask = oxrt::Lanes<bool, LANES>;
using Lanes = oxrt::LanesThread<LANES>;
using Rays = oxrt::RayLanes<LANES>;

struct Params {
    oxrt::Array<int32_t, 1> numbers;
    int32_t count;
    int32_t step;
};

struct ParamsWide;
}  // namespace
template <> struct oxrt::WideType<Params, 16> { using Type = ParamsWide; };
namespace {

struct ParamsWide {
    using IsWideStruct = void;
    Wide<oxrt::Array<int32_t, 1>> numbers;
    Wide<int32_t> count;
    Wide<int32_t> step;
    template <class F, class... S> static OXRT_INLINE void each(const F& f, S&... s) { f(s.numbers...); f(s.count...); f(s.step...); }
};

/* Program numbers, as SBT records hold them. */
namespace number {
enum : int32_t { raygen_main };
}

Wide<int32_t> factorial_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, int32_t n);
Wide<int32_t> collatz_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, Wide<int32_t> n);
Wide<oxrt::Tuple<int32_t, int32_t>> divide_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, Wide<int32_t> a, int32_t b);

#line 33 "shader.py"
Wide<int32_t> factorial_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, int32_t n) {
    if (n <= 1) {
        return Wide<int32_t>(1);
    }
#line 36 "shader.py"
    Wide<int32_t> result_ = factorial_lanes(thread, mask, n - 1);
#line 36 "shader.py"
    return n * result_;
}

#line 57 "pipeline.cpp"
// Turns until 1; the loop has no provable bound.
#line 18 "shader.py"
Wide<int32_t> collatz_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, Wide<int32_t> n) {
#line 20 "shader.py"
    Wide<int32_t> turns = Wide<int32_t>(0);
    Mask looping = mask;
#line 21 "shader.py"
    while (oxrt::any(looping)) {
#line 21 "shader.py"
        if (oxrt::isCancelled(thread))
            break;
#line 21 "shader.py"
        Mask mask_ = looping;
#line 21 "shader.py"
        mask_ = looping = looping & (n != 1);
        if (oxrt::none(mask_)) {
            break;
        }
#line 22 "shader.py"
        oxrt::assign(mask_, n, oxrt::select(oxrt::modulo(n, 2) == 0, oxrt::floorDivide(n, 2), 3 * n + 1));
        oxrt::assign(mask_, turns, turns + 1);
    }
#line 24 "shader.py"
    return turns;
}

#line 28 "shader.py"
Wide<oxrt::Tuple<int32_t, int32_t>> divide_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask, Wide<int32_t> a, int32_t b) {
    return oxrt::makeTuple(oxrt::floorDivide(a, b), oxrt::modulo(a, b));
}

#line 40 "shader.py"
void raygen_main_lanes([[maybe_unused]] Lanes& thread, [[maybe_unused]] Mask mask) {
    const Params& params = oxrt::launchParams<Params>(thread);
    int32_t k{};
    Wide<int32_t> kept{};
#line 41 "shader.py"
    Wide<uint32_t> i = oxrt::getLaunchIndex(thread).x;
    Wide<int32_t> total = Wide<int32_t>(0);
    oxrt::Range<int32_t> range(0, params.count, 1);
#line 43 "shader.py"
    while (range.next(k)) {
#line 43 "shader.py"
        if (oxrt::isCancelled(thread))
            break;
#line 44 "shader.py"
        if (k == 3) {
            continue;
        }
        else {
#line 46 "shader.py"
            if (k > 10) {
                break;
            }
            else {
#line 49 "shader.py"
                total = total + k;
            }
        }
    }
#line 50 "shader.py"
    oxrt::Range<int32_t> range_(10, 0, params.step);
#line 50 "shader.py"
    while (range_.next(k)) {
#line 50 "shader.py"
        if (oxrt::isCancelled(thread))
            break;
#line 51 "shader.py"
        total = total - k;
    }
#line 52 "shader.py"
    oxrt::Range<int32_t> range_2(0, 4, 1);
#line 52 "shader.py"
    while (range_2.next(k)) {
        Wide<int32_t> last = k * total;
        total = total + last;
    }
#line 55 "shader.py"
    Wide<int32_t> found = Wide<int32_t>(-1);
    Mask looping = mask;
#line 56 "shader.py"
    while (oxrt::any(looping)) {
#line 56 "shader.py"
        if (oxrt::isCancelled(thread))
            break;
#line 56 "shader.py"
        Mask mask_ = looping;
#line 56 "shader.py"
        mask_ = looping = looping & (found < 0);
        if (oxrt::none(mask_)) {
            break;
        }
#line 57 "shader.py"
        oxrt::assign(mask_, found, collatz_lanes(thread, mask_, total));
        const Mask test = found == 7;
#line 58 "shader.py"
        Mask mask_2 = mask_ & test;
#line 58 "shader.py"
        if (oxrt::any(mask_2)) {
            looping = oxrt::without(looping, mask_2);
            mask_2 = false;
        }
        mask_ = mask_2 | oxrt::without(mask_, test);
    }
    if (oxrt::any(mask)) {
#line 60 "shader.py"
        Mask looping_ = mask;
#line 60 "shader.py"
        while (oxrt::any(looping_)) {
#line 60 "shader.py"
            Mask mask_3 = looping_;
#line 60 "shader.py"
            mask_3 = looping_ = looping_ & (found < 10);
            if (oxrt::none(mask_3)) {
                break;
            }
#line 61 "shader.py"
            oxrt::assign(mask_3, found, found + 1);
        }
#line 62 "shader.py"
        Wide<oxrt::Tuple<int32_t, int32_t>> items = divide_lanes(thread, mask, total, 7);
#line 62 "shader.py"
        Wide<int32_t> quotient = oxrt::get<0>(items);
#line 62 "shader.py"
        Wide<int32_t> rest = oxrt::get<1>(items);
        Wide<int32_t> value = quotient;
#line 63 "shader.py"
        quotient = rest;
#line 63 "shader.py"
        rest = value;
        const Mask test_ = total > 5;
#line 64 "shader.py"
        Mask mask_4 = mask & test_;
#line 64 "shader.py"
        if (oxrt::any(mask_4)) {
            oxrt::assign(mask_4, kept, quotient);
        }
        Mask mask_5 = oxrt::without(mask, test_);
        if (oxrt::any(mask_5)) {
#line 67 "shader.py"
            oxrt::assign(mask_5, kept, rest);
        }
#line 68 "shader.py"
        Wide<oxrt::float2> pair = Wide<oxrt::float2>(oxrt::float2(1.0f, 2.0f));
        pair.x = oxrt::convert<float>(kept);
        const Mask test_2 = (kept == 0) | (kept == 1);
        Mask mask_6 = mask & test_2;
#line 71 "shader.py"
        if (oxrt::any(mask_6)) {
            oxrt::assign(mask_6, total, factorial_lanes(thread, mask_6, 5));
        }
        Mask mask_7 = oxrt::without(mask, test_2);
        if (oxrt::any(mask_7)) {
            const Mask test_3 = kept == 2;
#line 73 "shader.py"
            Mask mask_8 = mask_7 & test_3;
#line 73 "shader.py"
            if (oxrt::any(mask_8)) {
                oxrt::assign(mask_8, total, Wide<int32_t>(2));
            }
            Mask mask_9 = oxrt::without(mask_7, test_3);
            if (oxrt::any(mask_9)) {
#line 76 "shader.py"
                oxrt::assign(mask_9, total, total + oxrt::convert<int32_t>(pair.x));
            }
        }
#line 77 "shader.py"
        oxrt::checked(thread, mask).store(total, params.numbers, i);
    }
}

#line 229 "pipeline.cpp"
void run_raygen_main(OxrtThread* thread, const OxrtTile* tile) {
    oxrt::runBlocks<LANES>(*thread, *tile, [](Lanes& lanes, Mask mask) {
        raygen_main_lanes(lanes, mask);
    });
}

const OxrtProgram programs[] = {
    {"__raygen__main", OXRT_KIND_RAYGEN, 0, run_raygen_main},
};
const OxrtPipelineVariant variants[] = {{oxrt::BUILT_ISA, 16, programs, 1}};
static_assert(sizeof(Params) == 24);

}  // namespace

extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {
    OXRT_PIPELINE_ABI, 1, variants, 24, 1, "0.1.0"};
