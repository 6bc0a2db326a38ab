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

struct TwoFloats {
    float first, second;
};

/* Adds to as many floats as Bits holds in one exchange, if they are aligned; whether it did. Halves of 16 bytes that do not belong
   together let the exchange fail, as any change in between does. */
template <class Bits> OXRT_INLINE bool addToGroup(float* place, const float* values) {
    constexpr int words = int(sizeof(Bits) / sizeof(uint64_t));
    if (reinterpret_cast<uint64_t>(place) % sizeof(Bits) != 0)
        return false;
    bool isZero = true;
    for (int i = 0; i < 2 * words; ++i)
        isZero = isZero & (values[i] == 0.0f);
    for (bool isDone = isZero; !isDone;) {
        Bits old = 0, wanted = 0;
        for (int i = words - 1; i >= 0; --i) {
            const uint64_t word = __atomic_load_n(reinterpret_cast<uint64_t*>(place) + i, __ATOMIC_RELAXED);
            const TwoFloats two = __builtin_bit_cast(TwoFloats, word);
            const TwoFloats sums = {two.first + values[2 * i], two.second + values[2 * i + 1]};
            old = words == 1 ? Bits(word) : (old << 32 << 32) | word;
            wanted = words == 1 ? Bits(__builtin_bit_cast(uint64_t, sums)) : (wanted << 32 << 32) | __builtin_bit_cast(uint64_t, sums);
        }
        isDone = __sync_bool_compare_and_swap(reinterpret_cast<Bits*>(place), old, wanted);
    }
    return true;
}

/* Adds to neighbours in memory, several at a time where they are aligned: an exchange costs as much for four as for one. */
OXRT_INLINE void addToNeighbours(float* place, const float* values, int count) {
    int i = 0;
    while (i < count) {
#ifdef __GCC_HAVE_SYNC_COMPARE_AND_SWAP_16
        if (count - i >= 4 && addToGroup<unsigned __int128>(place + i, values + i)) {
            i += 4;
            continue;
        }
#endif
        if (count - i >= 2 && addToGroup<uint64_t>(place + i, values + i)) {
            i += 2;
            continue;
        }
        addTo<float>(reinterpret_cast<char*>(place + i), values[i]);
        ++i;
    }
}

template <PlainSpans Spans, class T, int N, class M, int RANK>
OXRT_INLINE void coopVecReduceSumAccumulate(Spans spans, const CoopVec<T, N>& vector, const Array<M, RANK>& array, uint32_t offset) {
    if (!spans.contains(array, offset, sizeof(vector), ACCUMULATOR_ALIGNMENT))
        return;
    char* first = reinterpret_cast<char*>(array.data) + offset;
    for (int i = 0; i < N; ++i)
        addTo<T>(first + sizeof(T) * size_t(i), float(vector.items[i]));
}

/* One column of a tile. */
typedef float TileColumn __attribute__((vector_size(4 * TILE_ROWS)));

/* The numbers of an optimal layout, tile by tile: product(row, k, column) adds up to 16 sums of column k from `row` on. Several columns are
   computed before the first exchange, which waits for everything before it. */
template <int N, int K, class F> OXRT_INLINE void addToTiles(char* matrix, F product) {
    constexpr int most = 16;
    for (int row = 0; row < N; row += TILE_ROWS)
        for (int first = 0; first < K; first += most) {
            const int count = K - first < most ? K - first : most;
            float sums[most][TILE_ROWS];
            for (int k = 0; k < count; ++k) {
                TileColumn column = {};
                product(row, first + k, column);
                __builtin_memcpy(sums[k], &column, sizeof(column));
            }
            float* tile = reinterpret_cast<float*>(matrix) + (int64_t(row) * K + TILE_ROWS * first);
            for (int k = 0; k < count; ++k)
                addToNeighbours(tile + TILE_ROWS * k, sums[k], N - row < TILE_ROWS ? N - row : int(TILE_ROWS));
        }
}

template <PlainSpans Spans, class T, int N, int K, class M, int RANK>
void coopVecOuterProductAccumulate(Spans spans, const CoopVec<T, N>& a, const CoopVec<T, K>& b, const Array<M, RANK>& matrix,
                                   uint32_t offset) {
    constexpr uint64_t bytes = matrixBytes<MatrixElement::FLOAT32, MatrixLayout::TRAINING_OPTIMAL>(N, K, 0);
    if (!spans.contains(matrix, offset, bytes, ACCUMULATOR_ALIGNMENT))
        return;
    addToTiles<N, K>(reinterpret_cast<char*>(matrix.data) + offset, [&](int row, int k, TileColumn& sums) __attribute__((always_inline)) {
        for (int r = 0; r < TILE_ROWS && row + r < N; ++r)
            sums[r] = float(a.items[row + r]) * float(b.items[k]);
    });
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
