/* Operations on one number that C++ has no operator for, or whose operator means something else than Python's.
 *
 * The scalar forms stand here, those for lanes in lanes.h; everything built on them (math.h) is written once. A template that takes
 * `Number` works for both.
 */
#ifndef OXRT_NUMBER_H
#define OXRT_NUMBER_H

#include <oxrt/vectors.h>

#ifdef __clang__
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wbitwise-instead-of-logical" /* & and | of masks: lanes have no && */
#endif

namespace oxrt {
inline namespace OXRT_ISA {

/* A C++ scalar, as opposed to lanes of them. */
template <class T> concept Scalar = Number<T> && NumberTraits<T>::lanes == 1;
template <class T> concept FloatNumber = Number<T> && isFloating<ElementOf<T>>;
template <class T> concept Float32 = Number<T> && isSame<ElementOf<T>, float>;
template <class T> concept Float64 = Number<T> && isSame<ElementOf<T>, double>;
template <class T> concept IntegerNumber = Number<T> && !isFloating<ElementOf<T>> && !isSame<ElementOf<T>, bool>;
template <class T> concept SignedInteger = IntegerNumber<T> && isSigned<ElementOf<T>>;
template <class T> concept UnsignedInteger = IntegerNumber<T> && !isSigned<ElementOf<T>>;

/* ---- masks and choice --------------------------------------------------------------------------------------------------------- */

OXRT_INLINE constexpr bool any(bool mask) { return mask; }
OXRT_INLINE constexpr bool all(bool mask) { return mask; }
OXRT_INLINE constexpr bool none(bool mask) { return !mask; }

template <Scalar T> OXRT_INLINE constexpr T select(bool mask, T ifTrue, T ifFalse) { return mask ? ifTrue : ifFalse; }

/* f applied to every lane on its own: the way to reach code that exists for scalars only. */
template <class F, Scalar... T> OXRT_INLINE auto mapLanes(F f, T... values) { return f(values...); }

/* ---- storage numbers ---------------------------------------------------------------------------------------------------------- */

/* What arithmetic uses for a storage number. */
template <class T> struct WidenedNumber { using Type = T; };
template <> struct WidenedNumber<int8_t> { using Type = int32_t; };
template <> struct WidenedNumber<int16_t> { using Type = int32_t; };
template <> struct WidenedNumber<uint8_t> { using Type = uint32_t; };
template <> struct WidenedNumber<uint16_t> { using Type = uint32_t; };
template <> struct WidenedNumber<half> { using Type = float; };
template <class T> inline constexpr bool isStorage = !isSame<T, typename WidenedNumber<T>::Type>;

/* ---- conversions -------------------------------------------------------------------------------------------------------------- */

template <class To, class From> struct ScalarConverter {
    static OXRT_INLINE constexpr To convert(From value) { return To(value); }
};

#if defined(__x86_64__)
using MachineFloats = float __attribute__((vector_size(16)));
using MachineDoubles = double __attribute__((vector_size(16)));
/* Truncates; the lowest number for what does not fit and for NaN. */
OXRT_INLINE int64_t truncateInMachine(float value) { return __builtin_ia32_cvttss2si64(MachineFloats{value}); }
OXRT_INLINE int64_t truncateInMachine(double value) { return __builtin_ia32_cvttsd2si64(MachineDoubles{value}); }
#endif

/* Truncates, saturates, and gives 0 for NaN. */
template <class To, class From> requires(isFloating<From> && !isFloating<To> && !isSame<To, bool>) struct ScalarConverter<To, From> {
    static OXRT_INLINE constexpr To convert(From value) {
#if defined(__x86_64__)
        if constexpr (sizeof(To) < 8)
            if (!__builtin_is_constant_evaluated()) {
                const int64_t truncated = truncateInMachine(value);
                return __builtin_expect(truncated == int64_t(To(truncated)), 1) ? To(truncated) : saturate(value);
            }
#endif
        return saturate(value);
    }

private:
    static OXRT_INLINE constexpr To saturate(From value) {
        constexpr int valueBits = int(sizeof(To)) * 8 - (isSigned<To> ? 1 : 0);
        constexpr From limit = From(uint64_t(1) << (valueBits - 1)) * From(2);
        constexpr To highest = To((uint64_t(1) << (valueBits - 1)) - 1 + (uint64_t(1) << (valueBits - 1)));
        constexpr From lowest = isSigned<To> ? -limit : From(0);
        constexpr From below = limit - limit * (isSame<From, float> ? From(5.9604645e-8) : From(1.1102230246251565e-16));
        const From raised = value > lowest ? value : lowest;
        const To truncated = To(raised < limit ? raised : below);
        const To saturated = value >= limit ? highest : truncated;
        return value == value ? saturated : To(0);
    }
};
template <class From> struct ScalarConverter<bool, From> {
    static OXRT_INLINE constexpr bool convert(From value) { return value != From(0); }
};

/* The number with elements To; float to integer truncates, saturates and takes NaN to 0. */
template <class To, Scalar From> OXRT_INLINE constexpr To convert(From value) { return ScalarConverter<To, From>::convert(value); }
template <class To, class From, int N> OXRT_INLINE constexpr auto convert(const Vector<From, N>& v) {
    return mapComponents<N>([](From x) { return convert<To>(x); }, v);
}

/* The same bits as a number of another type of that size. */
template <class To, Scalar From> OXRT_INLINE constexpr To bitCast(From value) { return __builtin_bit_cast(To, value); }

template <Number F> OXRT_INLINE Rebind<F, uint32_t> floatAsUint(F x) { return bitCast<uint32_t>(x); }
template <Number F> OXRT_INLINE Rebind<F, int32_t> floatAsInt(F x) { return bitCast<int32_t>(x); }
template <Number I> OXRT_INLINE Rebind<I, float> uintAsFloat(I x) { return bitCast<float>(x); }
template <Number I> OXRT_INLINE Rebind<I, float> intAsFloat(I x) { return bitCast<float>(x); }

/* ---- floating point ----------------------------------------------------------------------------------------------------------- */

OXRT_INLINE float sqrt(float x) { return __builtin_sqrtf(x); }
OXRT_INLINE double sqrt(double x) { return __builtin_sqrt(x); }
OXRT_INLINE float floor(float x) { return __builtin_floorf(x); }
OXRT_INLINE double floor(double x) { return __builtin_floor(x); }
OXRT_INLINE float ceil(float x) { return __builtin_ceilf(x); }
OXRT_INLINE double ceil(double x) { return __builtin_ceil(x); }
OXRT_INLINE float trunc(float x) { return __builtin_truncf(x); }
OXRT_INLINE double trunc(double x) { return __builtin_trunc(x); }
/* To the nearest integer, ties to even: Python's round(). */
OXRT_INLINE float round(float x) { return __builtin_rintf(x); }
OXRT_INLINE double round(double x) { return __builtin_rint(x); }
OXRT_INLINE float abs(float x) { return __builtin_fabsf(x); }
OXRT_INLINE double abs(double x) { return __builtin_fabs(x); }
OXRT_INLINE float copysign(float magnitude, float sign) { return __builtin_copysignf(magnitude, sign); }
OXRT_INLINE double copysign(double magnitude, double sign) { return __builtin_copysign(magnitude, sign); }

/* a * b + c, rounded once where the machine has the instruction. Only for approximations: results may differ between machines. */
OXRT_INLINE float multiplyAdd(float a, float b, float c) {
#ifdef __FMA__
    return __builtin_fmaf(a, b, c);
#else
    return a * b + c;
#endif
}
OXRT_INLINE double multiplyAdd(double a, double b, double c) {
#ifdef __FMA__
    return __builtin_fma(a, b, c);
#else
    return a * b + c;
#endif
}

/* `a if a < b else b` and `a if a > b else b`: b where either is NaN, b of two zeros. x86's own minps and maxps. */
template <Scalar T> OXRT_INLINE constexpr T minimum(T a, T b) { return a < b ? a : b; }
template <Scalar T> OXRT_INLINE constexpr T maximum(T a, T b) { return a > b ? a : b; }

/* ---- integers ----------------------------------------------------------------------------------------------------------------- */

template <class T> struct UnsignedOf {
    using Type = typename ChooseType<sizeof(T) == 8, uint64_t, uint32_t>::Type;
};

/* a / b towards zero for b != 0; the lowest number by -1 wraps. */
template <Scalar T> OXRT_INLINE constexpr T quotient(T a, T b) {
    if constexpr (isSigned<T>) {
        using U = typename UnsignedOf<T>::Type;
        return b == T(-1) ? T(U(0) - U(a)) : T(a / b);
    } else
        return T(a / b);
}

/* Python's // and %: rounded down, the remainder has the divisor's sign; division by zero gives 0. */
template <IntegerNumber T> OXRT_INLINE constexpr T floorDivide(T a, T b) {
    const MaskOf<T> byZero = b == T(0);
    const T divisor = select(byZero, T(1), b);
    T result = quotient(a, divisor);
    if constexpr (isSigned<ElementOf<T>>) {
        const T rest = a - result * divisor;
        result = select((rest != T(0)) & ((rest ^ divisor) < T(0)), result - T(1), result);
    }
    return select(byZero, T(0), result);
}
template <IntegerNumber T> OXRT_INLINE constexpr T modulo(T a, T b) {
    const MaskOf<T> byZero = b == T(0);
    const T divisor = select(byZero, T(1), b);
    T rest = a - quotient(a, divisor) * divisor;
    if constexpr (isSigned<ElementOf<T>>)
        rest = select((rest != T(0)) & ((rest ^ divisor) < T(0)), rest + divisor, rest);
    return select(byZero, T(0), rest);
}

/* Counts of the width or more (negative ones too) shift everything out: 0, or the sign for >> of signed numbers. */
template <IntegerNumber T, IntegerNumber C> OXRT_INLINE constexpr auto shiftLeft(T value, C count) {
    using E = ElementOf<T>;
    using R = Common<T, Rebind<C, E>>;
    using U = typename UnsignedOf<E>::Type;
    constexpr U bits = U(sizeof(U) * 8);
    const Rebind<C, U> places = convert<U>(count);
    const Rebind<C, U> within = places & U(bits - 1);
    const Rebind<R, U> shifted = Rebind<R, U>(convert<U>(value)) << Rebind<R, U>(within);
    return select(places < bits, R(convert<E>(shifted)), R(E(0)));
}
template <IntegerNumber T, IntegerNumber C> OXRT_INLINE constexpr auto shiftRight(T value, C count) {
    using E = ElementOf<T>;
    using R = Common<T, Rebind<C, E>>;
    using U = typename UnsignedOf<E>::Type;
    constexpr U bits = U(sizeof(U) * 8);
    const Rebind<C, U> places = convert<U>(count);
    const Rebind<C, E> within = convert<E>(Rebind<C, U>(places & U(bits - 1)));
    R all = R(E(0));
    if constexpr (isSigned<E>)
        all = R(value) >> R(E(bits - 1));
    return select(places < bits, R(value) >> R(within), all);
}

template <int PLACES> OXRT_INLINE constexpr int64_t shiftRightLogical(int64_t value) { return int64_t(uint64_t(value) >> PLACES); }

/* base ** exponent by repeated multiplication, wrapping; a negative exponent gives what 1 // base ** -exponent gives. */
template <Scalar T> OXRT_INLINE constexpr T integerPower(T base, T exponent) {
    using U = typename UnsignedOf<T>::Type;
    if constexpr (isSigned<T>)
        if (exponent < T(0))
            return base == T(1) ? T(1) : base == T(-1) ? (exponent & T(1) ? T(-1) : T(1)) : T(0);
    U result = 1;
    U factor = U(base);
    for (U rest = U(exponent); rest != 0; rest >>= 1) {
        if (rest & 1)
            result *= factor;
        factor *= factor;
    }
    return T(result);
}

OXRT_INLINE uint32_t popcount(uint32_t x) { return uint32_t(__builtin_popcount(x)); }
OXRT_INLINE uint32_t clz(uint32_t x) { return x == 0 ? 32 : uint32_t(__builtin_clz(x)); }
OXRT_INLINE uint32_t ctz(uint32_t x) { return x == 0 ? 32 : uint32_t(__builtin_ctz(x)); }
OXRT_INLINE uint64_t popcount(uint64_t x) { return uint64_t(__builtin_popcountll(x)); }
OXRT_INLINE uint64_t clz(uint64_t x) { return x == 0 ? 64 : uint64_t(__builtin_clzll(x)); }
OXRT_INLINE uint64_t ctz(uint64_t x) { return x == 0 ? 64 : uint64_t(__builtin_ctzll(x)); }
OXRT_INLINE int32_t popcount(int32_t x) { return int32_t(popcount(uint32_t(x))); }
OXRT_INLINE int32_t clz(int32_t x) { return int32_t(clz(uint32_t(x))); }
OXRT_INLINE int32_t ctz(int32_t x) { return int32_t(ctz(uint32_t(x))); }
OXRT_INLINE int64_t popcount(int64_t x) { return int64_t(popcount(uint64_t(x))); }
OXRT_INLINE int64_t clz(int64_t x) { return int64_t(clz(uint64_t(x))); }
OXRT_INLINE int64_t ctz(int64_t x) { return int64_t(ctz(uint64_t(x))); }
/* The lowest number stays itself. */
OXRT_INLINE constexpr int32_t abs(int32_t x) { return x < 0 ? int32_t(0u - uint32_t(x)) : x; }
OXRT_INLINE constexpr int64_t abs(int64_t x) { return x < 0 ? int64_t(uint64_t(0) - uint64_t(x)) : x; }
OXRT_INLINE constexpr uint32_t abs(uint32_t x) { return x; }
OXRT_INLINE constexpr uint64_t abs(uint64_t x) { return x; }

}  // namespace OXRT_ISA
}  // namespace oxrt

#ifdef __clang__
#pragma clang diagnostic pop
#endif

#endif
