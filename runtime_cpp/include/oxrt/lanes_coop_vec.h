/* Cooperative vectors over lanes: each lane has its own, a matrix is shared by all that name the same place.
 *
 * A product takes one weight for all lanes at a time: it is one multiplication and addition of a register.
 */
#ifndef OXRT_LANES_COOP_VEC_H
#define OXRT_LANES_COOP_VEC_H

#include <oxrt/coop_vec.h>
#include <oxrt/lanes_loops.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* ---- memory -------------------------------------------------------------------------------------------------------------------- */

template <int W> struct SpansOfLanes {
    Lanes<bool, W> mask;
    OXRT_INLINE AnySpan at(int) const { return anySpan; }
};
template <int W> OXRT_INLINE SpansOfLanes<W> spansOf(Lanes<bool, W> mask) { return {mask}; }

template <int W> struct CheckedSpansOfLanes {
    LanesThread<W>& thread;
    Lanes<bool, W> mask;
    Place place;
    OXRT_INLINE CheckedSpans at(int lane) const { return {thread.atLane(lane), place}; }
};
template <int W>
OXRT_INLINE CheckedSpansOfLanes<W> checkedSpans(LanesThread<W>& thread, Lanes<bool, W> mask, Place place) {
    return {thread, mask, place};
}

template <class S> inline constexpr int lanesOfSpans = 0;
template <int W> inline constexpr int lanesOfSpans<SpansOfLanes<W>> = W;
template <int W> inline constexpr int lanesOfSpans<CheckedSpansOfLanes<W>> = W;

/* An array or offset that all lanes share. */
template <class A> inline constexpr bool isShared = true;
template <class T, int W> inline constexpr bool isShared<Lanes<T, W>> = false;
template <class A, int W> inline constexpr bool isShared<VaryingArray<A, W>> = false;

/* The lanes that have the same array or offset as `lane`. */
template <int W, class A> OXRT_INLINE Lanes<bool, W> sameAs(const A&, int) { return true; }
template <int W, class T> OXRT_INLINE Lanes<bool, W> sameAs(const Lanes<T, W>& value, int lane) { return value == value[lane]; }
template <int W, class T, int RANK> OXRT_INLINE Lanes<bool, W> sameAs(const VaryingArray<Array<T, RANK>, W>& array, int lane) {
    Lanes<bool, W> same = array.data == array.data[lane];
    for (int axis = 0; axis < RANK; ++axis)
        same = same & (array.shape[axis] == array.shape[axis][lane]);
    return same;
}

/* f(lanes, lane) for the lanes of each distinct choice of arrays and offsets, and one of them. */
template <int W, class F, class... A> OXRT_INLINE void eachPlace(Lanes<bool, W> mask, F f, const A&... places) {
    if constexpr ((isShared<A> && ...)) {
        if (any(mask))
            f(mask, firstLane(mask));
    } else
        while (any(mask)) {
            const int lane = firstLane(mask);
            const Lanes<bool, W> same = (mask & ... & sameAs<W>(places, lane));
            f(same, lane);
            mask = without(mask, same);
        }
}

template <class T, int N, int W> OXRT_INLINE const CoopVec<T, N, Lanes<Widened<T>, W>>& wideVector(const CoopVec<T, N, Lanes<Widened<T>, W>>& v) {
    return v;
}
template <class T, int N, int W> OXRT_INLINE CoopVec<T, N, Lanes<Widened<T>, W>> wideVector(const CoopVec<T, N>& v) { return spread<W>(v); }

/* ---- loads and products -------------------------------------------------------------------------------------------------------- */

template <class V, LaneSpans Spans, class A, class O> OXRT_INLINE auto coopVecLoad(Spans spans, const A& array, O offset) {
    constexpr int W = lanesOfSpans<Spans>;
    Wide<V, W> result = spread<W>(V{});
    eachPlace<W>(spans.mask, [&](Lanes<bool, W> lanes, int lane) {
        assign(lanes, result, spread<W>(coopVecLoad<V>(spans.at(lane), inLane(array, lane), inLane(offset, lane))));
    }, array, offset);
    return result;
}

template <class Result, MatrixElement INNER, MatrixElement E, MatrixLayout L, bool TRANSPOSE, LaneSpans Spans, class T, int K, class X,
          class A, class O, class S, class... B>
auto coopVecMatMul(Spans spans, const CoopVec<T, K, X>& vector, const A& matrix, O offset, S stride, const B&... bias) {
    constexpr int W = lanesOfSpans<Spans>;
    const auto& wide = wideVector<T, K, W>(vector);
    if constexpr (isShared<A> && isShared<O> && isShared<S> && (isShared<B> && ...))
        return coopVecMatMul<Result, INNER, E, L, TRANSPOSE>(spans.at(any(spans.mask) ? firstLane(spans.mask) : 0), wide, matrix, offset, stride,
                                                             bias...);
    else {
        Wide<Result, W> result = spread<W>(Result{});
        eachPlace<W>(spans.mask, [&](Lanes<bool, W> lanes, int lane) {
            const Wide<Result, W> found = coopVecMatMul<Result, INNER, E, L, TRANSPOSE>(
                spans.at(lane), wide, inLane(matrix, lane), inLane(offset, lane), inLane(stride, lane), inLane(bias, lane)...);
            assign(lanes, result, found);
        }, matrix, offset, stride, bias...);
        return result;
    }
}

/* ---- accumulators -------------------------------------------------------------------------------------------------------------- */

/* The sum over the lanes of a mask, neighbours first. */
template <int W> OXRT_INLINE float sumOfLanes(Lanes<bool, W> mask, Lanes<float, W> values) {
    float sums[W];
    storeLanes(sums, select(mask, values, 0.0f));
    for (int step = 1; step < W; step *= 2)
        for (int i = 0; i < W; i += 2 * step)
            sums[i] += sums[i + step];
    return sums[0];
}

template <LaneSpans Spans, class T, int N, class X, class A, class O>
OXRT_INLINE void coopVecReduceSumAccumulate(Spans spans, const CoopVec<T, N, X>& vector, const A& array, O offset) {
    constexpr int W = lanesOfSpans<Spans>;
    const auto& wide = wideVector<T, N, W>(vector);
    eachPlace<W>(spans.mask, [&](Lanes<bool, W> lanes, int lane) {
        const auto one = inLane(array, lane);
        const uint32_t start = inLane(offset, lane);
        if (!spans.at(lane).contains(one, start, sizeof(T) * N, ACCUMULATOR_ALIGNMENT))
            return;
        char* first = reinterpret_cast<char*>(one.data) + start;
        for (int i = 0; i < N; ++i)
            addTo<T>(first + sizeof(T) * size_t(i), sumOfLanes(lanes, wide.items[i]));
    }, array, offset);
}

/* The products of all lanes are summed before memory is touched: 16 rows in a register, a column of one lane at a time. */
template <LaneSpans Spans, class T, int N, class X, int K, class Y, class A, class O>
void coopVecOuterProductAccumulate(Spans spans, const CoopVec<T, N, X>& a, const CoopVec<T, K, Y>& b, const A& matrix, O offset) {
    constexpr int W = lanesOfSpans<Spans>, rows = (N + TILE_ROWS - 1) / TILE_ROWS * TILE_ROWS;
    constexpr uint64_t bytes = matrixBytes<MatrixElement::FLOAT32, MatrixLayout::TRAINING_OPTIMAL>(N, K, 0);
    const auto& wideA = wideVector<T, N, W>(a);
    const auto& wideB = wideVector<T, K, W>(b);
    eachPlace<W>(spans.mask, [&](Lanes<bool, W> lanes, int lane) {
        const auto one = inLane(matrix, lane);
        const uint32_t start = inLane(offset, lane);
        if (!spans.at(lane).contains(one, start, bytes, ACCUMULATOR_ALIGNMENT))
            return;
        float turned[W][rows] = {};
        for (int n = 0; n < N; ++n) {
            float column[W];
            storeLanes(column, select(lanes, wideA.items[n], 0.0f));
            for (int i = 0; i < W; ++i)
                turned[i][n] = column[i];
        }
        addToTiles<N, K>(reinterpret_cast<char*>(one.data) + start, [&](int row, int k, TileColumn& sums) __attribute__((always_inline)) {
            float factors[W];
            storeLanes(factors, select(lanes, wideB.items[k], 0.0f));
            for (int i = 0; i < W; ++i) {
                TileColumn column;
                __builtin_memcpy(&column, &turned[i][row], sizeof(column));
                sums += column * factors[i];
            }
        });
    }, matrix, offset);
}

/* ---- products of registers ----------------------------------------------------------------------------------------------------- */

template <int W> OXRT_INLINE Lanes<float, W> addProduct(Lanes<float, W> sum, float weight, Lanes<float, W> factor) {
    return multiplyAdd(Lanes<float, W>(weight), factor, sum);
}
template <int W> OXRT_INLINE Lanes<int32_t, W> addProduct(Lanes<int32_t, W> sum, int32_t weight, Lanes<int32_t, W> factor) {
    const Lanes<int32_t, W> weights = weight;
#ifdef __AVX512VNNI__
    if constexpr (W == 16) {
#ifdef __clang__
        return Lanes<int32_t, W>(__builtin_ia32_vpdpwssd512(sum.v, weights.v, factor.v));
#else
        return Lanes<int32_t, W>(__builtin_ia32_vpdpwssd_v16si(sum.v, weights.v, factor.v));
#endif
    } else
#endif
    if constexpr (W == 8) {
        typedef short Shorts __attribute__((vector_size(32)));
        return sum + Lanes<int32_t, W>(NativeInt8(__builtin_ia32_pmaddwd256(Shorts(weights.v), Shorts(factor.v))));
    } else
        return sum + (weights << 16 >> 16) * (factor << 16 >> 16) + (weights >> 16) * (factor >> 16);
}

#ifndef __AVX512VL__
/* Half of 16 registers hold sums, the others weights and factors. */
template <class T> inline constexpr int ROWS_AT_ONCE<Lanes<T, 8>> = 8;
#endif

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
