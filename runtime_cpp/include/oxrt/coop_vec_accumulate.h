/* Sums of cooperative vectors, and of their outer products, in memory that all launch indices add to: the accumulators of training.
 *
 * Every addition is atomic. Their order is not fixed, so sums are equal up to rounding, and exact where all partial sums are.
 */
#ifndef OXRT_COOP_VEC_ACCUMULATE_H
#define OXRT_COOP_VEC_ACCUMULATE_H

#include <oxrt/coop_vec_matrix.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* Adds to a number in memory, rounding once. */
template <class T> OXRT_INLINE void addTo(char* place, float value) {
    if (value != 0.0f)
        atomicUpdate(reinterpret_cast<T*>(place), [value](T old) { return T(float(old) + value); });
}

/* Adds to neighbours in memory, two at a time where the first is aligned to both: one exchange costs as much for two. */
OXRT_INLINE void addToNeighbours(float* place, const float* values, int count) {
    struct Two {
        float numbers[2];
    };
    int i = 0;
    if (reinterpret_cast<uint64_t>(place) % 8 == 0)
        for (; i + 1 < count; i += 2) {
            const float first = values[i], second = values[i + 1];
            if (first == 0.0f && second == 0.0f)
                continue;
            atomicUpdate(reinterpret_cast<uint64_t*>(place + i), [first, second](uint64_t bits) {
                const Two old = __builtin_bit_cast(Two, bits);
                return __builtin_bit_cast(uint64_t, (Two{{old.numbers[0] + first, old.numbers[1] + second}}));
            });
        }
    for (; i < count; ++i)
        addTo<float>(reinterpret_cast<char*>(place + i), values[i]);
}

template <PlainSpans Spans, class T, int N, class M, int RANK>
OXRT_INLINE void coopVecReduceSumAccumulate(Spans spans, const CoopVec<T, N>& vector, const Array<M, RANK>& array, uint32_t offset) {
    if (!spans.contains(array, offset, sizeof(vector), ACCUMULATOR_ALIGNMENT))
        return;
    char* first = reinterpret_cast<char*>(array.data) + offset;
    for (int i = 0; i < N; ++i)
        addTo<T>(first + sizeof(T) * size_t(i), float(vector.items[i]));
}

/* The numbers of an optimal layout, tile by tile: product(row, column, sums) gives up to 16 sums of a column from `row` on. */
template <int N, int K, class F> OXRT_INLINE void addToTiles(char* matrix, F product) {
    for (int row = 0; row < N; row += TILE_ROWS)
        for (int k = 0; k < K; ++k) {
            float sums[TILE_ROWS];
            product(row, k, sums);
            addToNeighbours(reinterpret_cast<float*>(matrix) + (int64_t(row) * K + TILE_ROWS * k), sums,
                            N - row < TILE_ROWS ? N - row : int(TILE_ROWS));
        }
}

template <PlainSpans Spans, class T, int N, int K, class M, int RANK>
void coopVecOuterProductAccumulate(Spans spans, const CoopVec<T, N>& a, const CoopVec<T, K>& b, const Array<M, RANK>& matrix,
                                   uint32_t offset) {
    constexpr uint64_t bytes = matrixBytes<MatrixElement::FLOAT32, MatrixLayout::TRAINING_OPTIMAL>(N, K, 0);
    if (!spans.contains(matrix, offset, bytes, ACCUMULATOR_ALIGNMENT))
        return;
    addToTiles<N, K>(reinterpret_cast<char*>(matrix.data) + offset, [&](int row, int k, float (&sums)[TILE_ROWS]) {
        for (int r = 0; r < TILE_ROWS; ++r)
            sums[r] = row + r < N ? float(a.items[row + r]) * float(b.items[k]) : 0.0f;
    });
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
