/* What lanes.h needs of AVX-512 (F, DQ, BW, VL): sixteen 32-bit lanes in one register, 64-bit lanes in two, masks in mask registers.
 *
 * Compiler builtins instead of <immintrin.h>, which takes a third of a second to compile. Where g++ and clang name or shape a builtin
 * differently, both stand here.
 */
#ifndef OXRT_LANES_AVX512_H
#define OXRT_LANES_AVX512_H

#include <oxrt/lanes_native.h>

namespace oxrt {
inline namespace OXRT_ISA {

typedef float NativeFloat16 __attribute__((vector_size(64)));
typedef int32_t NativeInt16 __attribute__((vector_size(64)));
typedef uint32_t NativeUint16 __attribute__((vector_size(64)));
typedef double NativeDouble8 __attribute__((vector_size(64)));
typedef int64_t NativeLong8 __attribute__((vector_size(64)));
typedef uint64_t NativeUlong8 __attribute__((vector_size(64)));
typedef long long NativeLongLong8 __attribute__((vector_size(64))); /* the 64-bit integer of the builtins */

template <> struct NativeVector<float, 16> { using Type = NativeFloat16; };
template <> struct NativeVector<int32_t, 16> { using Type = NativeInt16; };
template <> struct NativeVector<uint32_t, 16> { using Type = NativeUint16; };
template <> struct NativeVector<double, 16> { using Type = NativeDouble8; };
template <> struct NativeVector<int64_t, 16> { using Type = NativeLong8; };
template <> struct NativeVector<uint64_t, 16> { using Type = NativeUlong8; };

/* ---- comparisons: a mask bit per lane ----------------------------------------------------------------------------------------- */

/* Variables, because g++ without optimisation takes no call of a function as an immediate. */
template <Compare C>
constexpr int FLOAT_PREDICATE = C == Compare::EQUAL ? 0 : C == Compare::NOT_EQUAL ? 4 : C == Compare::LESS ? 17
    : C == Compare::LESS_EQUAL ? 18 : C == Compare::GREATER ? 30 : 29;
template <Compare C>
constexpr int INTEGER_PREDICATE = C == Compare::EQUAL ? 0 : C == Compare::NOT_EQUAL ? 4 : C == Compare::LESS ? 1
    : C == Compare::LESS_EQUAL ? 2 : C == Compare::GREATER ? 6 : 5;
enum { CURRENT_ROUNDING = 4 };

template <Compare C> OXRT_INLINE uint16_t compareNative(NativeFloat16 a, NativeFloat16 b) {
    return uint16_t(__builtin_ia32_cmpps512_mask(a, b, FLOAT_PREDICATE<C>, uint16_t(0xffff), CURRENT_ROUNDING));
}
template <Compare C> OXRT_INLINE uint16_t compareNative(NativeInt16 a, NativeInt16 b) {
    return uint16_t(__builtin_ia32_cmpd512_mask(a, b, INTEGER_PREDICATE<C>, uint16_t(0xffff)));
}
template <Compare C> OXRT_INLINE uint16_t compareNative(NativeUint16 a, NativeUint16 b) {
    return uint16_t(__builtin_ia32_ucmpd512_mask(NativeInt16(a), NativeInt16(b), INTEGER_PREDICATE<C>, uint16_t(0xffff)));
}
template <Compare C> OXRT_INLINE uint8_t compareNative(NativeDouble8 a, NativeDouble8 b) {
    return uint8_t(__builtin_ia32_cmppd512_mask(a, b, FLOAT_PREDICATE<C>, uint8_t(0xff), CURRENT_ROUNDING));
}
template <Compare C> OXRT_INLINE uint8_t compareNative(NativeLong8 a, NativeLong8 b) {
    return uint8_t(__builtin_ia32_cmpq512_mask(NativeLongLong8(a), NativeLongLong8(b), INTEGER_PREDICATE<C>, uint8_t(0xff)));
}
template <Compare C> OXRT_INLINE uint8_t compareNative(NativeUlong8 a, NativeUlong8 b) {
    return uint8_t(__builtin_ia32_ucmpq512_mask(NativeLongLong8(a), NativeLongLong8(b), INTEGER_PREDICATE<C>, uint8_t(0xff)));
}

/* The masks of the two registers that hold 64-bit lanes, and back. */
OXRT_INLINE uint8_t lowMask(uint16_t m) { return uint8_t(m); }
OXRT_INLINE uint8_t highMask(uint16_t m) { return uint8_t(m >> 8); }
OXRT_INLINE uint16_t joinMasks(uint8_t low, uint8_t high) { return uint16_t(low | high << 8); }

/* ---- choice ------------------------------------------------------------------------------------------------------------------- */

#ifdef __clang__
OXRT_INLINE NativeFloat16 selectNative(uint16_t m, NativeFloat16 a, NativeFloat16 b) { return __builtin_ia32_selectps_512(m, a, b); }
OXRT_INLINE NativeInt16 selectNative(uint16_t m, NativeInt16 a, NativeInt16 b) { return __builtin_ia32_selectd_512(m, a, b); }
OXRT_INLINE NativeDouble8 selectNative(uint8_t m, NativeDouble8 a, NativeDouble8 b) { return __builtin_ia32_selectpd_512(m, a, b); }
OXRT_INLINE NativeLong8 selectNative(uint8_t m, NativeLong8 a, NativeLong8 b) {
    return NativeLong8(__builtin_ia32_selectq_512(m, NativeLongLong8(a), NativeLongLong8(b)));
}
#else
OXRT_INLINE NativeFloat16 selectNative(uint16_t m, NativeFloat16 a, NativeFloat16 b) { return __builtin_ia32_blendmps_512_mask(b, a, m); }
OXRT_INLINE NativeInt16 selectNative(uint16_t m, NativeInt16 a, NativeInt16 b) { return __builtin_ia32_blendmd_512_mask(b, a, m); }
OXRT_INLINE NativeDouble8 selectNative(uint8_t m, NativeDouble8 a, NativeDouble8 b) { return __builtin_ia32_blendmpd_512_mask(b, a, m); }
OXRT_INLINE NativeLong8 selectNative(uint8_t m, NativeLong8 a, NativeLong8 b) {
    return NativeLong8(__builtin_ia32_blendmq_512_mask(NativeLongLong8(b), NativeLongLong8(a), m));
}
#endif
OXRT_INLINE NativeUint16 selectNative(uint16_t m, NativeUint16 a, NativeUint16 b) {
    return NativeUint16(selectNative(m, NativeInt16(a), NativeInt16(b)));
}
OXRT_INLINE NativeUlong8 selectNative(uint8_t m, NativeUlong8 a, NativeUlong8 b) {
    return NativeUlong8(selectNative(m, NativeLong8(a), NativeLong8(b)));
}

/* ---- floating point ----------------------------------------------------------------------------------------------------------- */

template <int MODE> OXRT_INLINE NativeFloat16 roundNative(NativeFloat16 a) {
    return __builtin_ia32_rndscaleps_mask(a, MODE, a, uint16_t(0xffff), CURRENT_ROUNDING);
}
template <int MODE> OXRT_INLINE NativeDouble8 roundNative(NativeDouble8 a) {
    return __builtin_ia32_rndscalepd_mask(a, MODE, a, uint8_t(0xff), CURRENT_ROUNDING);
}
OXRT_INLINE NativeFloat16 fmaNative(NativeFloat16 a, NativeFloat16 b, NativeFloat16 c) {
    return __builtin_ia32_vfmaddps512_mask(a, b, c, uint16_t(0xffff), CURRENT_ROUNDING);
}
OXRT_INLINE NativeDouble8 fmaNative(NativeDouble8 a, NativeDouble8 b, NativeDouble8 c) {
    return __builtin_ia32_vfmaddpd512_mask(a, b, c, uint8_t(0xff), CURRENT_ROUNDING);
}
#ifdef __clang__
OXRT_INLINE NativeFloat16 sqrtNative(NativeFloat16 a) { return __builtin_ia32_sqrtps512(a, CURRENT_ROUNDING); }
OXRT_INLINE NativeDouble8 sqrtNative(NativeDouble8 a) { return __builtin_ia32_sqrtpd512(a, CURRENT_ROUNDING); }
OXRT_INLINE NativeFloat16 minNative(NativeFloat16 a, NativeFloat16 b) { return __builtin_ia32_minps512(a, b, CURRENT_ROUNDING); }
OXRT_INLINE NativeFloat16 maxNative(NativeFloat16 a, NativeFloat16 b) { return __builtin_ia32_maxps512(a, b, CURRENT_ROUNDING); }
OXRT_INLINE NativeDouble8 minNative(NativeDouble8 a, NativeDouble8 b) { return __builtin_ia32_minpd512(a, b, CURRENT_ROUNDING); }
OXRT_INLINE NativeDouble8 maxNative(NativeDouble8 a, NativeDouble8 b) { return __builtin_ia32_maxpd512(a, b, CURRENT_ROUNDING); }
#else
OXRT_INLINE NativeFloat16 sqrtNative(NativeFloat16 a) { return __builtin_ia32_sqrtps512_mask(a, a, uint16_t(0xffff), CURRENT_ROUNDING); }
OXRT_INLINE NativeDouble8 sqrtNative(NativeDouble8 a) { return __builtin_ia32_sqrtpd512_mask(a, a, uint8_t(0xff), CURRENT_ROUNDING); }
OXRT_INLINE NativeFloat16 minNative(NativeFloat16 a, NativeFloat16 b) {
    return __builtin_ia32_minps512_mask(a, b, a, uint16_t(0xffff), CURRENT_ROUNDING);
}
OXRT_INLINE NativeFloat16 maxNative(NativeFloat16 a, NativeFloat16 b) {
    return __builtin_ia32_maxps512_mask(a, b, a, uint16_t(0xffff), CURRENT_ROUNDING);
}
OXRT_INLINE NativeDouble8 minNative(NativeDouble8 a, NativeDouble8 b) {
    return __builtin_ia32_minpd512_mask(a, b, a, uint8_t(0xff), CURRENT_ROUNDING);
}
OXRT_INLINE NativeDouble8 maxNative(NativeDouble8 a, NativeDouble8 b) {
    return __builtin_ia32_maxpd512_mask(a, b, a, uint8_t(0xff), CURRENT_ROUNDING);
}
#endif

/* Lane i is a[lanes[i]]. */
#ifdef __clang__
OXRT_INLINE NativeFloat16 permuteNative(NativeFloat16 a, NativeInt16 lanes) { return __builtin_ia32_permvarsf512(a, lanes); }
#else
OXRT_INLINE NativeFloat16 permuteNative(NativeFloat16 a, NativeInt16 lanes) {
    return __builtin_ia32_permvarsf512_mask(a, lanes, a, uint16_t(0xffff));
}
#endif

/* Truncation; what does not fit gives the lowest int, or all bits for uint. */
OXRT_INLINE NativeInt16 truncateNative(NativeFloat16 a) {
    return __builtin_ia32_cvttps2dq512_mask(a, NativeInt16{}, uint16_t(0xffff), CURRENT_ROUNDING);
}
OXRT_INLINE NativeUint16 truncateToUnsignedNative(NativeFloat16 a) {
    return NativeUint16(__builtin_ia32_cvttps2udq512_mask(a, NativeInt16{}, uint16_t(0xffff), CURRENT_ROUNDING));
}

/* ---- gathers: element at base + index * SCALE bytes, 0 where the mask is off -------------------------------------------------- */

template <int SCALE> OXRT_INLINE NativeFloat16 gatherNative(const float* base, NativeInt16 index, uint16_t m) {
    return __builtin_ia32_gathersiv16sf(NativeFloat16{}, base, index, m, SCALE);
}
template <int SCALE> OXRT_INLINE NativeInt16 gatherNative(const int32_t* base, NativeInt16 index, uint16_t m) {
    return __builtin_ia32_gathersiv16si(NativeInt16{}, base, index, m, SCALE);
}

/* The same from whole addresses, eight at a time. */
OXRT_INLINE NativeFloat8 gatherAddressNative(const float*, NativeUlong8 address, uint8_t m) {
    return __builtin_ia32_gatherdiv16sf(NativeFloat8{}, static_cast<const float*>(nullptr), NativeLongLong8(address), m, 1);
}
OXRT_INLINE NativeInt8 gatherAddressNative(const int32_t*, NativeUlong8 address, uint8_t m) {
    return __builtin_ia32_gatherdiv16si(NativeInt8{}, static_cast<const int32_t*>(nullptr), NativeLongLong8(address), m, 1);
}
OXRT_INLINE NativeDouble8 gatherAddressNative(const double*, NativeUlong8 address, uint8_t m) {
    return __builtin_ia32_gatherdiv8df(NativeDouble8{}, static_cast<const double*>(nullptr), NativeLongLong8(address), m, 1);
}
OXRT_INLINE NativeLong8 gatherAddressNative(const int64_t*, NativeUlong8 address, uint8_t m) {
    return NativeLong8(__builtin_ia32_gatherdiv8di(NativeLongLong8{}, static_cast<const long long*>(nullptr), NativeLongLong8(address),
                                                   m, 1));
}

/* What binary16 keeps of each number. */
OXRT_INLINE NativeFloat16 roundToHalfNative(NativeFloat16 a) {
    const NativeHalf16 rounded = __builtin_ia32_vcvtps2ph512_mask(a, 0, NativeHalf16{}, 0xffff);
    return __builtin_ia32_vcvtph2ps512_mask(rounded, NativeFloat16{}, 0xffff, CURRENT_ROUNDING);
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
