/* The lanes forms of number.h, on which math.h builds the same functions as for scalars. */
#ifndef OXRT_LANES_MATH_H
#define OXRT_LANES_MATH_H

#include <oxrt/lanes_convert.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* ---- floating point ----------------------------------------------------------------------------------------------------------- */

template <class T, int W> requires isFloating<T> OXRT_INLINE Lanes<T, W> sqrt(Lanes<T, W> a) {
    return mapRegisters([](auto x) { return sqrtNative(x); }, a);
}
template <class T, int W> requires isFloating<T> OXRT_INLINE Lanes<T, W> floor(Lanes<T, W> a) {
    return mapRegisters([](auto x) { return roundNative<ROUND_DOWN>(x); }, a);
}
template <class T, int W> requires isFloating<T> OXRT_INLINE Lanes<T, W> ceil(Lanes<T, W> a) {
    return mapRegisters([](auto x) { return roundNative<ROUND_UP>(x); }, a);
}
template <class T, int W> requires isFloating<T> OXRT_INLINE Lanes<T, W> trunc(Lanes<T, W> a) {
    return mapRegisters([](auto x) { return roundNative<ROUND_TO_ZERO>(x); }, a);
}
template <class T, int W> requires isFloating<T> OXRT_INLINE Lanes<T, W> round(Lanes<T, W> a) {
    return mapRegisters([](auto x) { return roundNative<ROUND_NEAREST>(x); }, a);
}
template <class T, int W> requires isFloating<T> OXRT_INLINE Lanes<T, W> multiplyAdd(Lanes<T, W> a, Lanes<T, W> b, Lanes<T, W> c) {
    if constexpr (Lanes<T, W>::registers == 1)
        return Lanes<T, W>(fmaNative(a.v, b.v, c.v));
    else
        return Lanes<T, W>(fmaNative(a.v, b.v, c.v), fmaNative(a.w, b.w, c.w));
}

/* The value of one lane in all of them; quicker than to read it, which goes through memory. */
template <int W> OXRT_INLINE Lanes<float, W> spreadLane(Lanes<float, W> a, int lane) {
    return Lanes<float, W>(permuteNative(a.v, Lanes<int32_t, W>(lane).v));
}
template <int W> OXRT_INLINE Vector<Lanes<float, W>, 3> spreadLane(const Vector<Lanes<float, W>, 3>& v, int lane) {
    return {spreadLane(v.x, lane), spreadLane(v.y, lane), spreadLane(v.z, lane)};
}

template <class T> struct SignBits;
template <> struct SignBits<float> {
    using Type = uint32_t;
    static constexpr uint32_t sign = 0x80000000u;
};
template <> struct SignBits<double> {
    using Type = uint64_t;
    static constexpr uint64_t sign = 0x8000000000000000u;
};
template <class T, int W> requires isFloating<T> OXRT_INLINE Lanes<T, W> abs(Lanes<T, W> a) {
    using Bits = SignBits<T>;
    return bitCast<T>(bitCast<typename Bits::Type>(a) & typename Bits::Type(~Bits::sign));
}
template <class T, int W> requires isFloating<T> OXRT_INLINE Lanes<T, W> copysign(Lanes<T, W> magnitude, Lanes<T, W> sign) {
    using Bits = SignBits<T>;
    using B = typename Bits::Type;
    return bitCast<T>((bitCast<B>(magnitude) & B(~Bits::sign)) | (bitCast<B>(sign) & Bits::sign));
}

template <class T, int W> OXRT_INLINE Lanes<T, W> minimum(Lanes<T, W> a, Lanes<T, W> b) {
    if constexpr (isFloating<T>)
        return mapRegisters([](auto x, auto y) { return minNative(x, y); }, a, b);
    else
        return mapRegisters([](auto x, auto y) { return x < y ? x : y; }, a, b);
}
template <class T, int W> OXRT_INLINE Lanes<T, W> maximum(Lanes<T, W> a, Lanes<T, W> b) {
    if constexpr (isFloating<T>)
        return mapRegisters([](auto x, auto y) { return maxNative(x, y); }, a, b);
    else
        return mapRegisters([](auto x, auto y) { return x > y ? x : y; }, a, b);
}

/* ---- integers ----------------------------------------------------------------------------------------------------------------- */

/* Whole registers by one divisor that the compiler knows: it multiplies instead. */
template <class T, int W> OXRT_INLINE Lanes<T, W> quotientByConstant(Lanes<T, W> a, T b) {
    return mapRegisters([b](auto x) { return x / b; }, a);
}

template <class T, int W> requires(!isFloating<T>) OXRT_INLINE Lanes<T, W> quotient(Lanes<T, W> a, Lanes<T, W> b) {
    if constexpr (sizeof(T) == 8)
        return mapLanes([](T x, T y) { return quotient(x, y); }, a, b);
    else if constexpr (isSigned<T>) {
        // doubles hold the exact quotient's whole part; the one that does not fit an int is by -1
        const Lanes<bool, W> isNegation = b == T(-1);
        const Lanes<double, W> ratio = convert<double>(a) / convert<double>(select(isNegation, T(1), b));
        using Half = HalfRegister<T, W>;
        const Lanes<T, W> result = join(__builtin_convertvector(ratio.v, Half), __builtin_convertvector(ratio.w, Half));
        return select(isNegation, T(0) - a, result);
    } else {
        const Lanes<double, W> ratio = convert<double>(a) / convert<double>(b);
        using Half = HalfRegister<T, W>;
        return join(__builtin_convertvector(ratio.v, Half), __builtin_convertvector(ratio.w, Half));
    }
}

/* Python's // and % by a divisor that all lanes share. */
template <class T, int W> requires(!isFloating<T>) OXRT_INLINE Lanes<T, W> floorDivide(Lanes<T, W> a, T b) {
    if (b == 0)
        return T(0);
    if (__builtin_constant_p(b) && b > 0) {
        const Lanes<T, W> result = quotientByConstant(a, b);
        if constexpr (isSigned<T>)
            return select(a - result * b < T(0), result - T(1), result);
        else
            return result;
    }
    return floorDivide(a, Lanes<T, W>(b));
}
template <class T, int W> requires(!isFloating<T>) OXRT_INLINE Lanes<T, W> modulo(Lanes<T, W> a, T b) {
    if (b == 0)
        return T(0);
    if (__builtin_constant_p(b) && b > 0)
        return a - floorDivide(a, b) * b;
    return modulo(a, Lanes<T, W>(b));
}

/* A number that all lanes share beside one that they do not. */
template <Number A, Number B> requires(!isSame<A, B>) OXRT_INLINE Common<A, B> floorDivide(A a, B b) {
    return floorDivide(Common<A, B>(a), Common<A, B>(b));
}
template <Number A, Number B> requires(!isSame<A, B>) OXRT_INLINE Common<A, B> modulo(A a, B b) {
    return modulo(Common<A, B>(a), Common<A, B>(b));
}
template <Number A, Number B> requires(!isSame<A, B>) OXRT_INLINE Common<A, B> copysign(A magnitude, B sign) {
    return copysign(Common<A, B>(magnitude), Common<A, B>(sign));
}

template <class T, int W> requires(!isFloating<T> && isSigned<T>) OXRT_INLINE Lanes<T, W> abs(Lanes<T, W> a) { return maximum(a, -a); }
template <class T, int W> requires(!isFloating<T> && !isSigned<T>) OXRT_INLINE Lanes<T, W> abs(Lanes<T, W> a) { return a; }

template <class T, int W> requires(!isFloating<T>) OXRT_INLINE Lanes<T, W> popcount(Lanes<T, W> a) {
    return mapLanes([](T x) { return popcount(x); }, a);
}
template <class T, int W> requires(!isFloating<T>) OXRT_INLINE Lanes<T, W> clz(Lanes<T, W> a) {
    return mapLanes([](T x) { return clz(x); }, a);
}
template <class T, int W> requires(!isFloating<T>) OXRT_INLINE Lanes<T, W> ctz(Lanes<T, W> a) {
    return mapLanes([](T x) { return ctz(x); }, a);
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
