/* What lanes.h needs of AVX2 and FMA: eight 32-bit lanes in one register, 64-bit lanes in two, masks as registers of 0 and -1.
 *
 * Compiler builtins instead of <immintrin.h>, which takes a third of a second to compile.
 */
#ifndef OXRT_LANES_AVX2_H
#define OXRT_LANES_AVX2_H

#include <oxrt/lanes_native.h>

namespace oxrt {
inline namespace OXRT_ISA {

template <> struct NativeVector<float, 8> { using Type = NativeFloat8; };
template <> struct NativeVector<int32_t, 8> { using Type = NativeInt8; };
template <> struct NativeVector<uint32_t, 8> { using Type = NativeUint8; };
template <> struct NativeVector<double, 8> { using Type = NativeDouble4; };
template <> struct NativeVector<int64_t, 8> { using Type = NativeLong4; };
template <> struct NativeVector<uint64_t, 8> { using Type = NativeUlong4; };

/* ---- comparisons: lanes of 0 and -1 ------------------------------------------------------------------------------------------- */

template <Compare C, class V> OXRT_INLINE auto compareVectors(V a, V b) {
    if constexpr (C == Compare::EQUAL)
        return a == b;
    else if constexpr (C == Compare::NOT_EQUAL)
        return a != b;
    else if constexpr (C == Compare::LESS)
        return a < b;
    else if constexpr (C == Compare::LESS_EQUAL)
        return a <= b;
    else if constexpr (C == Compare::GREATER)
        return a > b;
    else
        return a >= b;
}
template <Compare C> OXRT_INLINE NativeInt8 compareNative(NativeFloat8 a, NativeFloat8 b) { return NativeInt8(compareVectors<C>(a, b)); }
template <Compare C> OXRT_INLINE NativeInt8 compareNative(NativeInt8 a, NativeInt8 b) { return NativeInt8(compareVectors<C>(a, b)); }
template <Compare C> OXRT_INLINE NativeInt8 compareNative(NativeUint8 a, NativeUint8 b) { return NativeInt8(compareVectors<C>(a, b)); }
template <Compare C>
OXRT_INLINE NativeLong4 compareNative(NativeDouble4 a, NativeDouble4 b) { return NativeLong4(compareVectors<C>(a, b)); }
template <Compare C> OXRT_INLINE NativeLong4 compareNative(NativeLong4 a, NativeLong4 b) { return NativeLong4(compareVectors<C>(a, b)); }
template <Compare C> OXRT_INLINE NativeLong4 compareNative(NativeUlong4 a, NativeUlong4 b) { return NativeLong4(compareVectors<C>(a, b)); }

/* The masks of the two registers that hold 64-bit lanes, and back. */
OXRT_INLINE NativeLong4 lowMask(NativeInt8 m) {
    return __builtin_convertvector(NativeInt4(__builtin_shufflevector(m, m, 0, 1, 2, 3)), NativeLong4);
}
OXRT_INLINE NativeLong4 highMask(NativeInt8 m) {
    return __builtin_convertvector(NativeInt4(__builtin_shufflevector(m, m, 4, 5, 6, 7)), NativeLong4);
}
OXRT_INLINE NativeInt8 joinMasks(NativeLong4 low, NativeLong4 high) {
    const NativeInt8 a = NativeInt8(low);
    const NativeInt8 b = NativeInt8(high);
    return __builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14);
}

/* ---- choice ------------------------------------------------------------------------------------------------------------------- */

OXRT_INLINE NativeFloat8 selectNative(NativeInt8 m, NativeFloat8 a, NativeFloat8 b) {
    return __builtin_ia32_blendvps256(b, a, NativeFloat8(m));
}
OXRT_INLINE NativeInt8 selectNative(NativeInt8 m, NativeInt8 a, NativeInt8 b) {
    return NativeInt8(selectNative(m, NativeFloat8(a), NativeFloat8(b)));
}
OXRT_INLINE NativeUint8 selectNative(NativeInt8 m, NativeUint8 a, NativeUint8 b) {
    return NativeUint8(selectNative(m, NativeFloat8(a), NativeFloat8(b)));
}
OXRT_INLINE NativeDouble4 selectNative(NativeLong4 m, NativeDouble4 a, NativeDouble4 b) {
    return __builtin_ia32_blendvpd256(b, a, NativeDouble4(m));
}
OXRT_INLINE NativeLong4 selectNative(NativeLong4 m, NativeLong4 a, NativeLong4 b) {
    return NativeLong4(selectNative(m, NativeDouble4(a), NativeDouble4(b)));
}
OXRT_INLINE NativeUlong4 selectNative(NativeLong4 m, NativeUlong4 a, NativeUlong4 b) {
    return NativeUlong4(selectNative(m, NativeDouble4(a), NativeDouble4(b)));
}

/* ---- floating point ----------------------------------------------------------------------------------------------------------- */

template <int MODE> OXRT_INLINE NativeFloat8 roundNative(NativeFloat8 a) { return __builtin_ia32_roundps256(a, MODE); }
template <int MODE> OXRT_INLINE NativeDouble4 roundNative(NativeDouble4 a) { return __builtin_ia32_roundpd256(a, MODE); }
OXRT_INLINE NativeFloat8 fmaNative(NativeFloat8 a, NativeFloat8 b, NativeFloat8 c) { return __builtin_ia32_vfmaddps256(a, b, c); }
OXRT_INLINE NativeDouble4 fmaNative(NativeDouble4 a, NativeDouble4 b, NativeDouble4 c) { return __builtin_ia32_vfmaddpd256(a, b, c); }
OXRT_INLINE NativeFloat8 sqrtNative(NativeFloat8 a) { return __builtin_ia32_sqrtps256(a); }
OXRT_INLINE NativeDouble4 sqrtNative(NativeDouble4 a) { return __builtin_ia32_sqrtpd256(a); }
OXRT_INLINE NativeFloat8 minNative(NativeFloat8 a, NativeFloat8 b) { return __builtin_ia32_minps256(a, b); }
OXRT_INLINE NativeFloat8 maxNative(NativeFloat8 a, NativeFloat8 b) { return __builtin_ia32_maxps256(a, b); }
OXRT_INLINE NativeDouble4 minNative(NativeDouble4 a, NativeDouble4 b) { return __builtin_ia32_minpd256(a, b); }
OXRT_INLINE NativeDouble4 maxNative(NativeDouble4 a, NativeDouble4 b) { return __builtin_ia32_maxpd256(a, b); }

/* Lane i is a[lanes[i]]. */
OXRT_INLINE NativeFloat8 permuteNative(NativeFloat8 a, NativeInt8 lanes) { return __builtin_ia32_permvarsf256(a, lanes); }

/* Truncation; what does not fit gives the lowest int. */
OXRT_INLINE NativeInt8 truncateNative(NativeFloat8 a) { return __builtin_ia32_cvttps2dq256(a); }

/* ---- gathers: element at base + index * SCALE bytes, 0 where the mask is off -------------------------------------------------- */

#ifdef __clang__
template <int SCALE> OXRT_INLINE NativeFloat8 gatherNative(const float* base, NativeInt8 index, NativeInt8 m) {
    return __builtin_ia32_gatherd_ps256(NativeFloat8{}, base, index, NativeFloat8(m), SCALE);
}
template <int SCALE> OXRT_INLINE NativeInt8 gatherNative(const int32_t* base, NativeInt8 index, NativeInt8 m) {
    return __builtin_ia32_gatherd_d256(NativeInt8{}, base, index, m, SCALE);
}
#else
template <int SCALE> OXRT_INLINE NativeFloat8 gatherNative(const float* base, NativeInt8 index, NativeInt8 m) {
    return __builtin_ia32_gathersiv8sf(NativeFloat8{}, base, index, NativeFloat8(m), SCALE);
}
template <int SCALE> OXRT_INLINE NativeInt8 gatherNative(const int32_t* base, NativeInt8 index, NativeInt8 m) {
    return __builtin_ia32_gathersiv8si(NativeInt8{}, base, index, m, SCALE);
}
#endif

#ifdef __F16C__
/* What binary16 keeps of each number. */
OXRT_INLINE NativeFloat8 roundToHalfNative(NativeFloat8 a) { return __builtin_ia32_vcvtph2ps256(__builtin_ia32_vcvtps2ph256(a, 0)); }
#endif

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
