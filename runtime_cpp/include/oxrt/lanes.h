/* W numbers at once: the values of SPMD kernels, one lane per launch index.
 *
 * `Lanes<T, W>` has the operators of T, lane by lane; comparisons give masks, `Lanes<bool, W>`, which have & | ^ ! and no conversion to
 * bool (any, all, none ask). A scalar turns into lanes where it meets them. W is 16 with AVX-512, 8 with AVX2: the 32-bit lanes fill one
 * register, 64-bit lanes two.
 */
#ifndef OXRT_LANES_H
#define OXRT_LANES_H

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512BW__) && defined(__AVX512VL__)
#include <oxrt/lanes_avx512.h>
#endif
#if defined(__AVX2__) && defined(__FMA__)
#include <oxrt/lanes_avx2.h>
#endif

namespace oxrt {
inline namespace OXRT_ISA {

template <class T, int W> struct Lanes;

template <class T, int W> struct NumberTraits<Lanes<T, W>> {
    static constexpr bool isNumber = true;
    static constexpr int lanes = W;
    using Element = T;
    template <class U> using Rebind = Lanes<U, W>;
};
template <class T, int W> struct CommonNumber<Lanes<T, W>, Lanes<T, W>> {
    using Type = Lanes<T, W>;
};
template <class T, int W> struct CommonNumber<Lanes<T, W>, T> {
    using Type = Lanes<T, W>;
};
template <class T, int W> struct CommonNumber<T, Lanes<T, W>> {
    using Type = Lanes<T, W>;
};

template <class T, int W> using Native = typename NativeVector<T, W>::Type;

/* ---- masks -------------------------------------------------------------------------------------------------------------------- */

#ifdef OXRT_LANES_AVX512_H
template <> struct Lanes<bool, 16> {
    uint16_t m;
    Lanes() = default;
    OXRT_INLINE constexpr Lanes(bool all) : m(uint16_t(all ? 0xffff : 0)) {}
    static OXRT_INLINE constexpr Lanes ofNative(uint16_t m) {
        Lanes result(false);
        result.m = m;
        return result;
    }
    /* Bit i is lane i. */
    static OXRT_INLINE constexpr Lanes ofBits(uint32_t bits) { return ofNative(uint16_t(bits)); }
    OXRT_INLINE constexpr uint32_t bits() const { return m; }
    OXRT_INLINE constexpr bool operator[](int lane) const { return m >> lane & 1; }
    OXRT_INLINE constexpr void set(int lane, bool value) { m = uint16_t((m & ~(1u << lane)) | uint32_t(value) << lane); }
    friend OXRT_INLINE Lanes operator&(Lanes a, Lanes b) { return ofNative(uint16_t(a.m & b.m)); }
    friend OXRT_INLINE Lanes operator|(Lanes a, Lanes b) { return ofNative(uint16_t(a.m | b.m)); }
    friend OXRT_INLINE Lanes operator^(Lanes a, Lanes b) { return ofNative(uint16_t(a.m ^ b.m)); }
    /* The mask instruction by name: on ~ and ^ of the integer, clang 19 loops for ever in some kernels. */
    friend OXRT_INLINE Lanes operator!(Lanes a) { return ofNative(uint16_t(__builtin_ia32_knothi(a.m))); }
};
#endif
#ifdef OXRT_LANES_AVX2_H
template <> struct Lanes<bool, 8> {
    NativeInt8 m;
    Lanes() = default;
    OXRT_INLINE Lanes(bool all) : m(NativeInt8{} - int32_t(all)) {}
    static OXRT_INLINE Lanes ofNative(NativeInt8 m) {
        Lanes result;
        result.m = m;
        return result;
    }
    static OXRT_INLINE Lanes ofBits(uint32_t bits) {
        const NativeInt8 bit = {1, 2, 4, 8, 16, 32, 64, 128};
        return ofNative(((NativeInt8{} + int32_t(bits)) & bit) == bit);
    }
    OXRT_INLINE uint32_t bits() const { return uint32_t(__builtin_ia32_movmskps256(NativeFloat8(m))); }
    OXRT_INLINE bool operator[](int lane) const { return m[lane] != 0; }
    OXRT_INLINE void set(int lane, bool value) { m[lane] = -int32_t(value); }
    friend OXRT_INLINE Lanes operator&(Lanes a, Lanes b) { return ofNative(a.m & b.m); }
    friend OXRT_INLINE Lanes operator|(Lanes a, Lanes b) { return ofNative(a.m | b.m); }
    friend OXRT_INLINE Lanes operator^(Lanes a, Lanes b) { return ofNative(a.m ^ b.m); }
    friend OXRT_INLINE Lanes operator!(Lanes a) { return ofNative(~a.m); }
};
#endif

template <int W> OXRT_INLINE Lanes<bool, W> operator==(Lanes<bool, W> a, Lanes<bool, W> b) { return !(a ^ b); }
template <int W> OXRT_INLINE Lanes<bool, W> operator!=(Lanes<bool, W> a, Lanes<bool, W> b) { return a ^ b; }
template <int W> OXRT_INLINE Lanes<bool, W>& operator&=(Lanes<bool, W>& a, Lanes<bool, W> b) { return a = a & b; }
template <int W> OXRT_INLINE Lanes<bool, W>& operator|=(Lanes<bool, W>& a, Lanes<bool, W> b) { return a = a | b; }

template <int W> OXRT_INLINE bool any(Lanes<bool, W> mask) { return mask.bits() != 0; }
template <int W> OXRT_INLINE bool none(Lanes<bool, W> mask) { return mask.bits() == 0; }
template <int W> OXRT_INLINE bool all(Lanes<bool, W> mask) { return mask.bits() == (1u << W) - 1; }
/* The lanes of a that b lacks. */
template <int W> OXRT_INLINE Lanes<bool, W> without(Lanes<bool, W> a, Lanes<bool, W> b) { return a & !b; }
/* The lowest active lane of a mask that is not empty. */
template <int W> OXRT_INLINE int firstLane(Lanes<bool, W> mask) { return __builtin_ctz(mask.bits()); }

/* ---- numbers of 32 and 64 bits ------------------------------------------------------------------------------------------------ */

/* One register per 32-bit lanes. */
template <class T, int W> requires(sizeof(T) == 4) struct Lanes<T, W> {
    static constexpr int registers = 1;
    Native<T, W> v;
    Lanes() = default;
    OXRT_INLINE Lanes(T all) : v(all - Native<T, W>{}) {}
    OXRT_INLINE Lanes(Native<T, W> native) : v(native) {}
    OXRT_INLINE T operator[](int lane) const { return v[lane]; }
    OXRT_INLINE void set(int lane, T value) { v[lane] = value; }
};

/* Two registers: lanes 0 to W/2 - 1, and the rest. */
template <class T, int W> requires(sizeof(T) == 8) struct Lanes<T, W> {
    static constexpr int registers = 2;
    Native<T, W> v, w;
    Lanes() = default;
    OXRT_INLINE Lanes(T all) : v(all - Native<T, W>{}), w(all - Native<T, W>{}) {}
    OXRT_INLINE Lanes(Native<T, W> low, Native<T, W> high) : v(low), w(high) {}
    OXRT_INLINE T operator[](int lane) const { return lane < W / 2 ? v[lane] : w[lane - W / 2]; }
    OXRT_INLINE void set(int lane, T value) {
        if (lane < W / 2)
            v[lane] = value;
        else
            w[lane - W / 2] = value;
    }
};

/* f applied to each register of the operands. */
template <class F, class T, int W> OXRT_INLINE Lanes<T, W> mapRegisters(F f, Lanes<T, W> a) {
    if constexpr (Lanes<T, W>::registers == 1)
        return Lanes<T, W>(f(a.v));
    else
        return Lanes<T, W>(f(a.v), f(a.w));
}
template <class F, class T, int W> OXRT_INLINE Lanes<T, W> mapRegisters(F f, Lanes<T, W> a, Lanes<T, W> b) {
    if constexpr (Lanes<T, W>::registers == 1)
        return Lanes<T, W>(f(a.v, b.v));
    else
        return Lanes<T, W>(f(a.v, b.v), f(a.w, b.w));
}

#define OXRT_LANES_OPERATOR(op)                                                                                        \
    template <class T, int W> OXRT_INLINE Lanes<T, W> operator op(Lanes<T, W> a, Lanes<T, W> b) {                      \
        return mapRegisters([](auto x, auto y) { return x op y; }, a, b);                                              \
    }                                                                                                                  \
    template <class T, int W> OXRT_INLINE Lanes<T, W> operator op(Lanes<T, W> a, typename NumberTraits<Lanes<T, W>>::Element b) { \
        return a op Lanes<T, W>(b);                                                                                    \
    }                                                                                                                  \
    template <class T, int W> OXRT_INLINE Lanes<T, W> operator op(typename NumberTraits<Lanes<T, W>>::Element a, Lanes<T, W> b) { \
        return Lanes<T, W>(a) op b;                                                                                    \
    }
OXRT_LANES_OPERATOR(+)
OXRT_LANES_OPERATOR(-)
OXRT_LANES_OPERATOR(*)
OXRT_LANES_OPERATOR(/)
OXRT_LANES_OPERATOR(%)
OXRT_LANES_OPERATOR(&)
OXRT_LANES_OPERATOR(|)
OXRT_LANES_OPERATOR(^)
OXRT_LANES_OPERATOR(<<)
OXRT_LANES_OPERATOR(>>)
#undef OXRT_LANES_OPERATOR

template <class T, int W> OXRT_INLINE Lanes<T, W> operator-(Lanes<T, W> a) {
    return mapRegisters([](auto x) { return -x; }, a);
}
template <class T, int W> OXRT_INLINE Lanes<T, W> operator~(Lanes<T, W> a) {
    return mapRegisters([](auto x) { return ~x; }, a);
}

template <Compare C, class T, int W> OXRT_INLINE Lanes<bool, W> compare(Lanes<T, W> a, Lanes<T, W> b) {
    if constexpr (Lanes<T, W>::registers == 1)
        return Lanes<bool, W>::ofNative(compareNative<C>(a.v, b.v));
    else
        return Lanes<bool, W>::ofNative(joinMasks(compareNative<C>(a.v, b.v), compareNative<C>(a.w, b.w)));
}
#define OXRT_LANES_COMPARISON(op, name)                                                                                \
    template <class T, int W> requires(!isSame<T, bool>) OXRT_INLINE Lanes<bool, W> operator op(Lanes<T, W> a, Lanes<T, W> b) { \
        return compare<Compare::name>(a, b);                                                                           \
    }                                                                                                                  \
    template <class T, int W> OXRT_INLINE Lanes<bool, W> operator op(Lanes<T, W> a, typename NumberTraits<Lanes<T, W>>::Element b) { \
        return a op Lanes<T, W>(b);                                                                                    \
    }                                                                                                                  \
    template <class T, int W> OXRT_INLINE Lanes<bool, W> operator op(typename NumberTraits<Lanes<T, W>>::Element a, Lanes<T, W> b) { \
        return Lanes<T, W>(a) op b;                                                                                    \
    }
OXRT_LANES_COMPARISON(==, EQUAL)
OXRT_LANES_COMPARISON(!=, NOT_EQUAL)
OXRT_LANES_COMPARISON(<, LESS)
OXRT_LANES_COMPARISON(<=, LESS_EQUAL)
OXRT_LANES_COMPARISON(>, GREATER)
OXRT_LANES_COMPARISON(>=, GREATER_EQUAL)
#undef OXRT_LANES_COMPARISON

/* ---- choice ------------------------------------------------------------------------------------------------------------------- */

template <class T, int W> OXRT_INLINE Lanes<T, W> selectLanes(Lanes<bool, W> mask, Lanes<T, W> a, Lanes<T, W> b) {
    if constexpr (isSame<T, bool>)
        return (mask & a) | without(b, mask);
    else if constexpr (Lanes<T, W>::registers == 1)
        return Lanes<T, W>(selectNative(mask.m, a.v, b.v));
    else
        return Lanes<T, W>(selectNative(lowMask(mask.m), a.v, b.v), selectNative(highMask(mask.m), a.w, b.w));
}
/* a where the mask is on, b elsewhere; scalars are spread. */
template <int W, Number A, Number B> OXRT_INLINE Lanes<ElementOf<A>, W> select(Lanes<bool, W> mask, A a, B b) {
    using R = Lanes<ElementOf<A>, W>;
    return selectLanes(mask, R(a), R(b));
}
/* With a condition that all lanes share. */
template <class T, int W> OXRT_INLINE Lanes<T, W> select(bool condition, Lanes<T, W> a, Lanes<T, W> b) { return condition ? a : b; }

}  // namespace OXRT_ISA
}  // namespace oxrt

#include <oxrt/lanes_convert.h>
#include <oxrt/lanes_math.h>

#endif
