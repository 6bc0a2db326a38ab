/* Lanes of x y z w as the four numbers of each lane side by side: the way from registers to images. */
#ifndef OXRT_LANES_QUADS_H
#define OXRT_LANES_QUADS_H

#include <oxrt/lanes.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* The value of the first lane of each four. */
template <int W> OXRT_INLINE Lanes<int32_t, W> firstOfFour(Lanes<int32_t, W> a) {
    if constexpr (W == 16)
        return Lanes<int32_t, W>(__builtin_shufflevector(a.v, a.v, 0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12));
    else
        return Lanes<int32_t, W>(__builtin_shufflevector(a.v, a.v, 0, 0, 0, 0, 4, 4, 4, 4));
}
/* Words from the first of four neighbours to each of them. */
template <int W> OXRT_INLINE Lanes<int32_t, W> loadQuadSteps() { return bitCast<int32_t>((laneIndex<W>() & 3u) << 2u); }

template <int W> struct QuadRows;

#ifdef OXRT_LANES_AVX512_H
/* Register r holds lanes 4 r to 4 r + 3. */
template <> struct QuadRows<16> {
    NativeFloat16 rows[4];

    OXRT_INLINE explicit QuadRows(const Vector<Lanes<float, 16>, 4>& q) {
        // 4x4 transposes inside of each 128 bits, then of the 128-bit pieces
        const auto xy0 = __builtin_shufflevector(q.x.v, q.y.v, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
        const auto xy1 = __builtin_shufflevector(q.x.v, q.y.v, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31);
        const auto zw0 = __builtin_shufflevector(q.z.v, q.w.v, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
        const auto zw1 = __builtin_shufflevector(q.z.v, q.w.v, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31);
        const auto p0 = __builtin_shufflevector(xy0, zw0, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29);
        const auto p1 = __builtin_shufflevector(xy0, zw0, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31);
        const auto p2 = __builtin_shufflevector(xy1, zw1, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29);
        const auto p3 = __builtin_shufflevector(xy1, zw1, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31);
        const auto a01 = __builtin_shufflevector(p0, p1, 0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23);
        const auto a23 = __builtin_shufflevector(p2, p3, 0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23);
        const auto b01 = __builtin_shufflevector(p0, p1, 8, 9, 10, 11, 12, 13, 14, 15, 24, 25, 26, 27, 28, 29, 30, 31);
        const auto b23 = __builtin_shufflevector(p2, p3, 8, 9, 10, 11, 12, 13, 14, 15, 24, 25, 26, 27, 28, 29, 30, 31);
        rows[0] = __builtin_shufflevector(a01, a23, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27);
        rows[1] = __builtin_shufflevector(a01, a23, 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31);
        rows[2] = __builtin_shufflevector(b01, b23, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27);
        rows[3] = __builtin_shufflevector(b01, b23, 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31);
    }
    OXRT_INLINE void storeRow(char* target, int row) const { __builtin_memcpy(target, &rows[row], 64); }
    OXRT_INLINE void storeAll(float* target) const { __builtin_memcpy(target, rows, sizeof(rows)); }
};
#endif

#ifdef OXRT_LANES_AVX2_H
/* Registers 2 r and 2 r + 1 hold lanes 4 r to 4 r + 3. */
template <> struct QuadRows<8> {
    NativeFloat8 rows[4];

    OXRT_INLINE explicit QuadRows(const Vector<Lanes<float, 8>, 4>& q) {
        const auto xy0 = __builtin_shufflevector(q.x.v, q.y.v, 0, 8, 1, 9, 4, 12, 5, 13);
        const auto xy1 = __builtin_shufflevector(q.x.v, q.y.v, 2, 10, 3, 11, 6, 14, 7, 15);
        const auto zw0 = __builtin_shufflevector(q.z.v, q.w.v, 0, 8, 1, 9, 4, 12, 5, 13);
        const auto zw1 = __builtin_shufflevector(q.z.v, q.w.v, 2, 10, 3, 11, 6, 14, 7, 15);
        const auto p0 = __builtin_shufflevector(xy0, zw0, 0, 1, 8, 9, 4, 5, 12, 13);
        const auto p1 = __builtin_shufflevector(xy0, zw0, 2, 3, 10, 11, 6, 7, 14, 15);
        const auto p2 = __builtin_shufflevector(xy1, zw1, 0, 1, 8, 9, 4, 5, 12, 13);
        const auto p3 = __builtin_shufflevector(xy1, zw1, 2, 3, 10, 11, 6, 7, 14, 15);
        rows[0] = __builtin_shufflevector(p0, p1, 0, 1, 2, 3, 8, 9, 10, 11);
        rows[1] = __builtin_shufflevector(p2, p3, 0, 1, 2, 3, 8, 9, 10, 11);
        rows[2] = __builtin_shufflevector(p0, p1, 4, 5, 6, 7, 12, 13, 14, 15);
        rows[3] = __builtin_shufflevector(p2, p3, 4, 5, 6, 7, 12, 13, 14, 15);
    }
    OXRT_INLINE void storeRow(char* target, int row) const { __builtin_memcpy(target, &rows[2 * row], 64); }
    OXRT_INLINE void storeAll(float* target) const { __builtin_memcpy(target, rows, sizeof(rows)); }
};
#endif

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
