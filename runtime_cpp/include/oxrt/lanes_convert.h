/* Conversions between lanes of different elements, the same bits as another element, and functions applied lane by lane. */
#ifndef OXRT_LANES_CONVERT_H
#define OXRT_LANES_CONVERT_H

#include <oxrt/lanes.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* ---- lane by lane ------------------------------------------------------------------------------------------------------------- */

template <class T, int W> OXRT_INLINE Lanes<T, W> loadLanes(const T (&values)[W]) {
    Lanes<T, W> result;
    __builtin_memcpy(&result, values, sizeof(values));
    return result;
}
template <class T, int W>
OXRT_INLINE void storeLanes(T (&values)[W], Lanes<T, W> lanes) { __builtin_memcpy(values, &lanes, sizeof(values)); }

/* 0, 1, 2 ... */
template <int W> OXRT_INLINE Lanes<uint32_t, W> laneIndex() {
    uint32_t values[W];
    for (int i = 0; i < W; ++i)
        values[i] = uint32_t(i);
    return loadLanes<uint32_t, W>(values);
}

/* f(lane of each value) for every lane, active or not. */
template <class F, class T, int W, class... Rest> auto mapLanes(F f, Lanes<T, W> first, Rest... rest) {
    using R = decltype(f(first[0], rest[0]...));
    if constexpr (isSame<R, bool>) {
        uint32_t bits = 0;
        for (int i = 0; i < W; ++i)
            bits |= uint32_t(f(first[i], rest[i]...)) << i;
        return Lanes<bool, W>::ofBits(bits);
    } else {
        R values[W];
        for (int i = 0; i < W; ++i)
            values[i] = f(first[i], rest[i]...);
        return loadLanes<R, W>(values);
    }
}

/* ---- bits --------------------------------------------------------------------------------------------------------------------- */

template <class To, class From, int W> OXRT_INLINE Lanes<To, W> bitCast(Lanes<From, W> a) {
    static_assert(sizeof(To) == sizeof(From));
    if constexpr (Lanes<From, W>::registers == 1)
        return Lanes<To, W>(Native<To, W>(a.v));
    else
        return Lanes<To, W>(Native<To, W>(a.v), Native<To, W>(a.w));
}
template <int PLACES, int W> OXRT_INLINE Lanes<int64_t, W> shiftRightLogical(Lanes<int64_t, W> a) {
    return bitCast<int64_t>(bitCast<uint64_t>(a) >> uint64_t(PLACES));
}

/* ---- halves of a register of 32-bit lanes, and back --------------------------------------------------------------------------- */

OXRT_INLINE NativeFloat4 lowHalf(NativeFloat8 v) { return __builtin_shufflevector(v, v, 0, 1, 2, 3); }
OXRT_INLINE NativeFloat4 highHalf(NativeFloat8 v) { return __builtin_shufflevector(v, v, 4, 5, 6, 7); }
OXRT_INLINE NativeInt4 lowHalf(NativeInt8 v) { return __builtin_shufflevector(v, v, 0, 1, 2, 3); }
OXRT_INLINE NativeInt4 highHalf(NativeInt8 v) { return __builtin_shufflevector(v, v, 4, 5, 6, 7); }
OXRT_INLINE NativeUint4 lowHalf(NativeUint8 v) { return __builtin_shufflevector(v, v, 0, 1, 2, 3); }
OXRT_INLINE NativeUint4 highHalf(NativeUint8 v) { return __builtin_shufflevector(v, v, 4, 5, 6, 7); }
template <class V> OXRT_INLINE auto joinQuarters(V low, V high) { return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7); }
OXRT_INLINE NativeFloat8 join(NativeFloat4 low, NativeFloat4 high) { return joinQuarters(low, high); }
OXRT_INLINE NativeInt8 join(NativeInt4 low, NativeInt4 high) { return joinQuarters(low, high); }
OXRT_INLINE NativeUint8 join(NativeUint4 low, NativeUint4 high) { return joinQuarters(low, high); }
#ifdef OXRT_LANES_AVX512_H
template <class V> OXRT_INLINE auto lowEight(V v) { return __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7); }
template <class V> OXRT_INLINE auto highEight(V v) { return __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15); }
template <class V> OXRT_INLINE auto joinEights(V low, V high) {
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}
OXRT_INLINE NativeFloat8 lowHalf(NativeFloat16 v) { return lowEight(v); }
OXRT_INLINE NativeFloat8 highHalf(NativeFloat16 v) { return highEight(v); }
OXRT_INLINE NativeInt8 lowHalf(NativeInt16 v) { return lowEight(v); }
OXRT_INLINE NativeInt8 highHalf(NativeInt16 v) { return highEight(v); }
OXRT_INLINE NativeUint8 lowHalf(NativeUint16 v) { return lowEight(v); }
OXRT_INLINE NativeUint8 highHalf(NativeUint16 v) { return highEight(v); }
OXRT_INLINE NativeFloat16 join(NativeFloat8 low, NativeFloat8 high) { return joinEights(low, high); }
OXRT_INLINE NativeInt16 join(NativeInt8 low, NativeInt8 high) { return joinEights(low, high); }
OXRT_INLINE NativeUint16 join(NativeUint8 low, NativeUint8 high) { return joinEights(low, high); }
#endif

/* ---- numbers ------------------------------------------------------------------------------------------------------------------ */

template <class T, int W> using HalfRegister = decltype(lowHalf(Native<T, W>{}));

/* Truncates, saturates, NaN to 0: as the scalar conversion does. */
template <int W> OXRT_INLINE Lanes<int32_t, W> saturate(Lanes<float, W> a, int32_t) {
    Lanes<int32_t, W> result = truncateNative(a.v);
    result = select(a >= 2147483648.0f, 2147483647, result);
    return select(a == a, result, 0);
}
template <int W> OXRT_INLINE Lanes<uint32_t, W> saturate(Lanes<float, W> a, uint32_t) {
    const Lanes<float, W> positive = maxNative(a.v, Native<float, W>{});
#ifdef OXRT_LANES_AVX512_H
    if constexpr (W == 16)
        return truncateToUnsignedNative(positive.v);
#endif
    const Lanes<bool, W> isLarge = positive >= 2147483648.0f;
    const Lanes<float, W> low = select(isLarge, positive - 2147483648.0f, positive);
    const Lanes<uint32_t, W> whole = Native<uint32_t, W>(truncateNative(low.v));
    return select(positive >= 4294967296.0f, 0xffffffffu, select(isLarge, whole + 0x80000000u, whole));
}

/* The numbers that the storage type To holds, in lanes of its widened type. */
template <class To, class From, int W> requires isStorage<To>
OXRT_INLINE Lanes<typename WidenedNumber<To>::Type, W> convert(Lanes<From, W> a) {
    using Widened = typename WidenedNumber<To>::Type;
#ifdef __F16C__
    if constexpr (isSame<To, half> && isSame<From, float>)
        return Lanes<float, W>(roundToHalfNative(a.v));
    else
#endif
    if constexpr (!isFloating<To> && !isFloating<From> && !isSame<From, bool> && sizeof(From) == 4) {
        constexpr Widened places = Widened(32 - 8 * sizeof(To));
        return bitCast<Widened>(a) << places >> places;
    } else
        return mapLanes([](From x) { return Widened(convert<To>(x)); }, a);
}

template <class To, class From, int W> requires(!isStorage<To>) OXRT_INLINE Lanes<To, W> convert(Lanes<From, W> a) {
    if constexpr (isSame<To, From>)
        return a;
    else if constexpr (isSame<From, bool>)
        return select(a, To(1), To(0));
    else if constexpr (isSame<To, bool>)
        return a != Lanes<From, W>(From(0));
    else if constexpr (isFloating<From> && !isFloating<To>) {
        if constexpr (sizeof(From) == 4 && sizeof(To) == 4)
            return saturate(a, To(0));
        else
            return mapLanes([](From x) { return convert<To>(x); }, a);
    } else if constexpr (sizeof(From) == 4 && sizeof(To) == 4)
        return Lanes<To, W>(__builtin_convertvector(a.v, Native<To, W>));
    else if constexpr (sizeof(From) == 4)
        return Lanes<To, W>(__builtin_convertvector(lowHalf(a.v), Native<To, W>), __builtin_convertvector(highHalf(a.v), Native<To, W>));
    else if constexpr (sizeof(To) == 4)
        return Lanes<To, W>(join(__builtin_convertvector(a.v, HalfRegister<To, W>), __builtin_convertvector(a.w, HalfRegister<To, W>)));
    else
        return Lanes<To, W>(__builtin_convertvector(a.v, Native<To, W>), __builtin_convertvector(a.w, Native<To, W>));
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
