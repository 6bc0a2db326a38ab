// Sixteen (AVX-512) or eight (AVX2) numbers at once, and the same functions for one number, so that the arithmetic of a benchmark is
// written once. Control flow is not: scalar kernels branch, packet kernels mask.
#ifndef BENCH_WIDE_H
#define BENCH_WIDE_H

#include <immintrin.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#define BENCH_INLINE inline __attribute__((always_inline))

namespace bench {

// ---- one number

BENCH_INLINE float select(bool mask, float a, float b) { return mask ? a : b; }
BENCH_INLINE uint32_t select(bool mask, uint32_t a, uint32_t b) { return mask ? a : b; }
BENCH_INLINE float minimum(float a, float b) { return a < b ? a : b; }
BENCH_INLINE float maximum(float a, float b) { return a > b ? a : b; }
BENCH_INLINE float squareRoot(float a) { return __builtin_sqrtf(a); }
BENCH_INLINE float roundDown(float a) { return __builtin_floorf(a); }
BENCH_INLINE float absolute(float a) { return __builtin_fabsf(a); }
BENCH_INLINE float toFloat(uint32_t a) { return float(int32_t(a)); }
BENCH_INLINE uint32_t toInteger(float a) { return uint32_t(int32_t(a)); }
BENCH_INLINE bool any(bool mask) { return mask; }
BENCH_INLINE bool both(bool a, bool b) { return a && b; }
BENCH_INLINE float gather(const float* base, uint32_t index, bool) { return base[index]; }
BENCH_INLINE uint32_t gather(const uint32_t* base, uint32_t index, bool) { return base[index]; }

#if defined(__AVX512F__)

enum { LANES = 16, BLOCK_HEIGHT = 4 };

struct Mask {
    __mmask16 bits;
};
struct Wide {
    __m512 v;
    Wide() = default;
    BENCH_INLINE Wide(__m512 v_) : v(v_) {}
    BENCH_INLINE Wide(float a) : v(_mm512_set1_ps(a)) {}
};
struct WideUint {
    __m512i v;
    WideUint() = default;
    BENCH_INLINE WideUint(__m512i v_) : v(v_) {}
    BENCH_INLINE WideUint(uint32_t a) : v(_mm512_set1_epi32(int(a))) {}
};

BENCH_INLINE Mask operator&(Mask a, Mask b) { return {__mmask16(a.bits & b.bits)}; }
BENCH_INLINE Mask operator|(Mask a, Mask b) { return {__mmask16(a.bits | b.bits)}; }
BENCH_INLINE Mask operator!(Mask a) { return {_knot_mask16(a.bits)}; }  // with ~ clang 19 may never end
BENCH_INLINE unsigned bitsOf(Mask a) { return a.bits; }
BENCH_INLINE Mask maskOf(unsigned bits) { return {__mmask16(bits)}; }

BENCH_INLINE Wide operator+(Wide a, Wide b) { return _mm512_add_ps(a.v, b.v); }
BENCH_INLINE Wide operator-(Wide a, Wide b) { return _mm512_sub_ps(a.v, b.v); }
BENCH_INLINE Wide operator*(Wide a, Wide b) { return _mm512_mul_ps(a.v, b.v); }
BENCH_INLINE Wide operator/(Wide a, Wide b) { return _mm512_div_ps(a.v, b.v); }
BENCH_INLINE Wide operator-(Wide a) {
    return _mm512_castsi512_ps(_mm512_xor_si512(_mm512_castps_si512(a.v), _mm512_set1_epi32(int(0x80000000u))));
}
BENCH_INLINE Mask operator<(Wide a, Wide b) { return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_LT_OQ)}; }
BENCH_INLINE Mask operator<=(Wide a, Wide b) { return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_LE_OQ)}; }
BENCH_INLINE Mask operator>(Wide a, Wide b) { return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_GT_OQ)}; }
BENCH_INLINE Mask operator>=(Wide a, Wide b) { return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_GE_OQ)}; }
BENCH_INLINE Wide select(Mask m, Wide a, Wide b) { return _mm512_mask_blend_ps(m.bits, b.v, a.v); }
BENCH_INLINE Wide minimum(Wide a, Wide b) { return _mm512_min_ps(a.v, b.v); }
BENCH_INLINE Wide maximum(Wide a, Wide b) { return _mm512_max_ps(a.v, b.v); }
BENCH_INLINE Wide squareRoot(Wide a) { return _mm512_sqrt_ps(a.v); }
BENCH_INLINE Wide roundDown(Wide a) { return _mm512_roundscale_ps(a.v, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC); }
BENCH_INLINE Wide absolute(Wide a) { return _mm512_abs_ps(a.v); }

BENCH_INLINE WideUint operator+(WideUint a, WideUint b) { return _mm512_add_epi32(a.v, b.v); }
BENCH_INLINE WideUint operator-(WideUint a, WideUint b) { return _mm512_sub_epi32(a.v, b.v); }
BENCH_INLINE WideUint operator*(WideUint a, WideUint b) { return _mm512_mullo_epi32(a.v, b.v); }
BENCH_INLINE WideUint operator^(WideUint a, WideUint b) { return _mm512_xor_si512(a.v, b.v); }
BENCH_INLINE WideUint operator&(WideUint a, WideUint b) { return _mm512_and_si512(a.v, b.v); }
BENCH_INLINE WideUint operator>>(WideUint a, unsigned count) { return _mm512_srli_epi32(a.v, count); }
BENCH_INLINE WideUint operator>>(WideUint a, WideUint count) { return _mm512_srlv_epi32(a.v, count.v); }
BENCH_INLINE Mask operator==(WideUint a, WideUint b) { return {_mm512_cmpeq_epi32_mask(a.v, b.v)}; }
BENCH_INLINE Mask operator<(WideUint a, WideUint b) { return {_mm512_cmplt_epu32_mask(a.v, b.v)}; }
BENCH_INLINE WideUint select(Mask m, WideUint a, WideUint b) { return _mm512_mask_blend_epi32(m.bits, b.v, a.v); }
BENCH_INLINE Wide toFloat(WideUint a) { return _mm512_cvtepi32_ps(a.v); }
BENCH_INLINE WideUint toInteger(Wide a) { return _mm512_cvttps_epi32(a.v); }

BENCH_INLINE Wide load(const float* p) { return _mm512_load_ps(p); }
BENCH_INLINE WideUint load(const unsigned* p) { return _mm512_load_si512(p); }
BENCH_INLINE void store(float* p, Wide a) { _mm512_store_ps(p, a.v); }
BENCH_INLINE void store(unsigned* p, WideUint a) { _mm512_store_si512(p, a.v); }
BENCH_INLINE void storeMask(int* p, Mask m) { _mm512_store_si512(p, _mm512_movm_epi32(m.bits)); }
BENCH_INLINE Mask loadMask(const int* p) { return {_mm512_movepi32_mask(_mm512_loadu_si512(p))}; }
BENCH_INLINE void storeMasked(float* p, Mask m, Wide a) { _mm512_mask_storeu_ps(p, m.bits, a.v); }
BENCH_INLINE void storeMasked(int* p, Mask m, WideUint a) { _mm512_mask_storeu_epi32(p, m.bits, a.v); }
BENCH_INLINE Wide gather(const float* base, WideUint index, Mask m) {
    return _mm512_mask_i32gather_ps(_mm512_setzero_ps(), m.bits, index.v, base, 4);
}
BENCH_INLINE WideUint gather(const uint32_t* base, WideUint index, Mask m) {
    return _mm512_mask_i32gather_epi32(_mm512_setzero_si512(), m.bits, index.v, base, 4);
}
BENCH_INLINE WideUint laneIndices() { return _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15); }

#else

enum { LANES = 8, BLOCK_HEIGHT = 2 };

struct Mask {
    __m256 v;
};
struct Wide {
    __m256 v;
    Wide() = default;
    BENCH_INLINE Wide(__m256 v_) : v(v_) {}
    BENCH_INLINE Wide(float a) : v(_mm256_set1_ps(a)) {}
};
struct WideUint {
    __m256i v;
    WideUint() = default;
    BENCH_INLINE WideUint(__m256i v_) : v(v_) {}
    BENCH_INLINE WideUint(uint32_t a) : v(_mm256_set1_epi32(int(a))) {}
};

BENCH_INLINE Mask operator&(Mask a, Mask b) { return {_mm256_and_ps(a.v, b.v)}; }
BENCH_INLINE Mask operator|(Mask a, Mask b) { return {_mm256_or_ps(a.v, b.v)}; }
BENCH_INLINE Mask operator!(Mask a) { return {_mm256_xor_ps(a.v, _mm256_castsi256_ps(_mm256_set1_epi32(-1)))}; }
BENCH_INLINE unsigned bitsOf(Mask a) { return unsigned(_mm256_movemask_ps(a.v)); }
BENCH_INLINE Mask maskOf(unsigned bits) {
    const __m256i bit = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    return {_mm256_castsi256_ps(_mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(int(bits)), bit), bit))};
}

BENCH_INLINE Wide operator+(Wide a, Wide b) { return _mm256_add_ps(a.v, b.v); }
BENCH_INLINE Wide operator-(Wide a, Wide b) { return _mm256_sub_ps(a.v, b.v); }
BENCH_INLINE Wide operator*(Wide a, Wide b) { return _mm256_mul_ps(a.v, b.v); }
BENCH_INLINE Wide operator/(Wide a, Wide b) { return _mm256_div_ps(a.v, b.v); }
BENCH_INLINE Wide operator-(Wide a) { return _mm256_xor_ps(a.v, _mm256_set1_ps(-0.0f)); }
BENCH_INLINE Mask operator<(Wide a, Wide b) { return {_mm256_cmp_ps(a.v, b.v, _CMP_LT_OQ)}; }
BENCH_INLINE Mask operator<=(Wide a, Wide b) { return {_mm256_cmp_ps(a.v, b.v, _CMP_LE_OQ)}; }
BENCH_INLINE Mask operator>(Wide a, Wide b) { return {_mm256_cmp_ps(a.v, b.v, _CMP_GT_OQ)}; }
BENCH_INLINE Mask operator>=(Wide a, Wide b) { return {_mm256_cmp_ps(a.v, b.v, _CMP_GE_OQ)}; }
BENCH_INLINE Wide select(Mask m, Wide a, Wide b) { return _mm256_blendv_ps(b.v, a.v, m.v); }
BENCH_INLINE Wide minimum(Wide a, Wide b) { return _mm256_min_ps(a.v, b.v); }
BENCH_INLINE Wide maximum(Wide a, Wide b) { return _mm256_max_ps(a.v, b.v); }
BENCH_INLINE Wide squareRoot(Wide a) { return _mm256_sqrt_ps(a.v); }
BENCH_INLINE Wide roundDown(Wide a) { return _mm256_round_ps(a.v, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC); }
BENCH_INLINE Wide absolute(Wide a) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a.v); }

BENCH_INLINE WideUint operator+(WideUint a, WideUint b) { return _mm256_add_epi32(a.v, b.v); }
BENCH_INLINE WideUint operator-(WideUint a, WideUint b) { return _mm256_sub_epi32(a.v, b.v); }
BENCH_INLINE WideUint operator*(WideUint a, WideUint b) { return _mm256_mullo_epi32(a.v, b.v); }
BENCH_INLINE WideUint operator^(WideUint a, WideUint b) { return _mm256_xor_si256(a.v, b.v); }
BENCH_INLINE WideUint operator&(WideUint a, WideUint b) { return _mm256_and_si256(a.v, b.v); }
BENCH_INLINE WideUint operator>>(WideUint a, unsigned count) { return _mm256_srli_epi32(a.v, int(count)); }
BENCH_INLINE WideUint operator>>(WideUint a, WideUint count) { return _mm256_srlv_epi32(a.v, count.v); }
BENCH_INLINE Mask operator==(WideUint a, WideUint b) { return {_mm256_castsi256_ps(_mm256_cmpeq_epi32(a.v, b.v))}; }
BENCH_INLINE Mask operator<(WideUint a, WideUint b) {
    const __m256i flip = _mm256_set1_epi32(int(0x80000000u));
    return {_mm256_castsi256_ps(_mm256_cmpgt_epi32(_mm256_xor_si256(b.v, flip), _mm256_xor_si256(a.v, flip)))};
}
BENCH_INLINE WideUint select(Mask m, WideUint a, WideUint b) {
    return _mm256_blendv_epi8(b.v, a.v, _mm256_castps_si256(m.v));
}
BENCH_INLINE Wide toFloat(WideUint a) { return _mm256_cvtepi32_ps(a.v); }
BENCH_INLINE WideUint toInteger(Wide a) { return _mm256_cvttps_epi32(a.v); }

BENCH_INLINE Wide load(const float* p) { return _mm256_load_ps(p); }
BENCH_INLINE WideUint load(const unsigned* p) { return _mm256_load_si256(reinterpret_cast<const __m256i*>(p)); }
BENCH_INLINE void store(float* p, Wide a) { _mm256_store_ps(p, a.v); }
BENCH_INLINE void store(unsigned* p, WideUint a) { _mm256_store_si256(reinterpret_cast<__m256i*>(p), a.v); }
BENCH_INLINE void storeMask(int* p, Mask m) { _mm256_store_si256(reinterpret_cast<__m256i*>(p), _mm256_castps_si256(m.v)); }
BENCH_INLINE Mask loadMask(const int* p) { return {_mm256_castsi256_ps(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(p)))}; }
BENCH_INLINE void storeMasked(float* p, Mask m, Wide a) { _mm256_maskstore_ps(p, _mm256_castps_si256(m.v), a.v); }
BENCH_INLINE void storeMasked(int* p, Mask m, WideUint a) { _mm256_maskstore_epi32(p, _mm256_castps_si256(m.v), a.v); }
BENCH_INLINE Wide gather(const float* base, WideUint index, Mask m) {
    return _mm256_mask_i32gather_ps(_mm256_setzero_ps(), base, index.v, m.v, 4);
}
BENCH_INLINE WideUint gather(const uint32_t* base, WideUint index, Mask m) {
    return _mm256_mask_i32gather_epi32(_mm256_setzero_si256(), reinterpret_cast<const int*>(base), index.v, _mm256_castps_si256(m.v), 4);
}
BENCH_INLINE WideUint laneIndices() { return _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7); }

#endif

BENCH_INLINE Mask both(Mask a, Mask b) { return a & b; }
BENCH_INLINE bool any(Mask m) { return bitsOf(m) != 0; }
BENCH_INLINE unsigned countOf(Mask m) { return unsigned(__builtin_popcount(bitsOf(m))); }

// The unsigned integer and the mask that belong to a number.
template <class F> struct Kin;
template <> struct Kin<float> {
    using Uint = uint32_t;
    using Bool = bool;
};
template <> struct Kin<Wide> {
    using Uint = WideUint;
    using Bool = Mask;
};
template <class F> using UintOf = typename Kin<F>::Uint;
template <class F> using BoolOf = typename Kin<F>::Bool;

}  // namespace bench
#endif
