/* Loads and stores whose address is another one in every lane.
 *
 * Lanes that the mask leaves out touch no memory and read zero. Words of 4 and 8 bytes are gathered; smaller numbers are read lane by
 * lane.
 */
#ifndef OXRT_LANES_MEMORY_H
#define OXRT_LANES_MEMORY_H

#include <oxrt/lanes_quads.h>
#include <oxrt/lanes_types.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* ---- places: an address per lane ---------------------------------------------------------------------------------------------- */

/* base + 4 * index bytes: for memory of less than 8 GiB from one base. */
template <int W> struct WordPlaces {
    const char* base;
    Lanes<int32_t, W> index;
    OXRT_INLINE const char* address(int lane) const { return base + 4 * int64_t(index[lane]); }
};

/* Any addresses. */
template <int W> struct AddressPlaces {
    Lanes<uint64_t, W> addresses;
    OXRT_INLINE const char* address(int lane) const { return reinterpret_cast<const char*>(addresses[lane]); }
};

/* T at `offset` bytes behind every place, lane by lane. */
template <class T, int W, class Places>
OXRT_INLINE Wide<T, W> gatherSlowly(const Places& places, int64_t offset, Lanes<bool, W> mask) {
    using E = ElementOf<Wide<T, W>>;
    if constexpr (isSame<E, bool>) {
        uint32_t bits = 0;
        eachLane(mask, [&](int lane) { bits |= uint32_t(places.address(lane)[offset] != 0) << lane; });
        return Lanes<bool, W>::ofBits(bits);
    } else {
        E values[W] = {};
        eachLane(mask, [&](int lane) {
            T value;
            __builtin_memcpy(&value, places.address(lane) + offset, sizeof(T));
            values[lane] = E(value);
        });
        return loadLanes<E, W>(values);
    }
}

template <class T> using Word32Of = typename ChooseType<isFloating<T>, float, int32_t>::Type;

template <class T, int W> OXRT_INLINE Lanes<T, W> gatherNumber(const WordPlaces<W>& places, int64_t offset, Lanes<bool, W> mask) {
    using G = Word32Of<T>;
    return bitCast<T>(Lanes<G, W>(gatherNative<4>(reinterpret_cast<const G*>(places.base + offset), places.index.v, mask.m)));
}
#ifdef OXRT_LANES_AVX512_H
template <class T, int W> requires(W == 16)
OXRT_INLINE Lanes<T, W> gatherNumber(const AddressPlaces<W>& places, int64_t offset, Lanes<bool, W> mask) {
    const Lanes<uint64_t, W> at = places.addresses + uint64_t(offset);
    const uint8_t low = lowMask(mask.m);
    const uint8_t high = highMask(mask.m);
    if constexpr (sizeof(T) == 4) {
        using G = Word32Of<T>;
        const G* kind = nullptr;
        return bitCast<T>(Lanes<G, W>(join(gatherAddressNative(kind, at.v, low), gatherAddressNative(kind, at.w, high))));
    } else {
        using G = typename ChooseType<isFloating<T>, double, int64_t>::Type;
        const G* kind = nullptr;
        return bitCast<T>(Lanes<G, W>(gatherAddressNative(kind, at.v, low), gatherAddressNative(kind, at.w, high)));
    }
}
#endif

/* A number T, as its wide form, from every place. */
template <class T, int W, class Places> OXRT_INLINE Wide<T, W> gather(const Places& places, int64_t offset, Lanes<bool, W> mask) {
    if constexpr (isSame<T, typename WidenedNumber<T>::Type> && sizeof(T) >= 4 && requires { gatherNumber<T, W>(places, offset, mask); } &&
                  !(isSame<Places, WordPlaces<W>> && sizeof(T) == 8))
        return gatherNumber<T, W>(places, offset, mask);
    else
        return gatherSlowly<T, W>(places, offset, mask);
}

/* Four bytes in one word. */
template <class T, int W, class Places>
OXRT_INLINE Vector<Wide<T, W>, 4> gatherFourBytes(const Places& places, int64_t offset, Lanes<bool, W> mask) {
    const Lanes<uint32_t, W> word = gather<uint32_t, W>(places, offset, mask);
    Vector<Wide<T, W>, 4> result;
    for (int i = 0; i < 4; ++i) {
        const Lanes<uint32_t, W> top = word << uint32_t(24 - 8 * i);
        if constexpr (isSigned<T>)
            result[i] = bitCast<int32_t>(top) >> 24;
        else
            result[i] = top >> 24u;
    }
    return result;
}

template <class T, class U, int W, class Places>
OXRT_INLINE void loadPart(Lanes<U, W>& to, const Places& places, int64_t offset, Lanes<bool, W> mask) {
    to = gather<T, W>(places, offset, mask);
}
template <class A, int W, class Places>
OXRT_INLINE void loadPart(VaryingArray<A, W>& to, const Places& places, int64_t offset, Lanes<bool, W> mask) {
    to.data = gather<uint64_t, W>(places, offset, mask);
    for (int axis = 0; axis < int(sizeof(to.shape) / sizeof(to.shape[0])); ++axis)
        to.shape[axis] = gather<uint64_t, W>(places, offset + 8 * (axis + 1), mask);
    to.shared = {};
    to.isShared = false;
}

/* The whole of a T from every place. `T` is the type in memory; each part of it is gathered from its own offset. */
template <class T, int W, class Places> OXRT_INLINE Wide<T, W> loadFrom(const Places& places, Lanes<bool, W> mask) {
    if constexpr (isSame<T, uchar4> || isSame<T, char4>)
        return gatherFourBytes<decltype(T::x), W>(places, 0, mask);
    else {
        Wide<T, W> result;
        T pattern; /* only the addresses of its parts are used */
        eachPart([&](auto& to, auto& part) {
            const int64_t offset = reinterpret_cast<const char*>(&part) - reinterpret_cast<const char*>(&pattern);
            loadPart<PlainType<decltype(part)>>(to, places, offset, mask);
        }, result, pattern);
        return result;
    }
}

/* ---- array elements ----------------------------------------------------------------------------------------------------------- */

template <class I> OXRT_INLINE auto wordIndex(I index) { return convert<int32_t>(index); }
template <class I> OXRT_INLINE auto longIndex(I index) {
    if constexpr (isSigned<ElementOf<I>>)
        return convert<uint64_t>(convert<int64_t>(index));
    else
        return convert<uint64_t>(index);
}

/* Row-major number of the element, in wrapping 64-bit arithmetic. */
template <int W, class Shape, class... I> OXRT_INLINE Lanes<uint64_t, W> longOffset(const Shape& shape, I... indices) {
    Lanes<uint64_t, W> result = uint64_t(0);
    int axis = 0;
    ((result = axis == 0 ? Lanes<uint64_t, W>(longIndex(indices)) : result * Lanes<uint64_t, W>(shape[axis]) + longIndex(indices),
      ++axis), ...);
    return result;
}

/* The lanes whose index is below the size; negative ones are not. Indices of a word are compared as words. */
template <int W, class I> OXRT_INLINE Lanes<bool, W> isBelow(I index, uint64_t size) {
    if constexpr (sizeof(ElementOf<I>) <= 4) {
        constexpr uint64_t end = uint64_t(1) << (isSigned<ElementOf<I>> ? 31 : 32);
        if (!isSigned<ElementOf<I>> && __builtin_expect(size >= end, 0))
            return true;
        return Lanes<uint32_t, W>(convert<uint32_t>(wordIndex(index))) < Lanes<uint32_t, W>(uint32_t(size < end ? size : end));
    }
    else
        return Lanes<uint64_t, W>(longIndex(index)) < Lanes<uint64_t, W>(size);
}

/* The lanes whose indices are inside of the array. */
template <int W, class T, int RANK, class... I> OXRT_INLINE Lanes<bool, W> inside(const Array<T, RANK>& array, I... indices) {
    Lanes<bool, W> result = true;
    int axis = 0;
    ((result = result & isBelow<W>(indices, array.shape[axis]), ++axis), ...);
    return result;
}
template <int W, class A, class... I> OXRT_INLINE Lanes<bool, W> inside(const VaryingArray<A, W>& array, I... indices) {
    if (array.isShared)
        return inside<W>(array.shared, indices...);
    Lanes<bool, W> result = true;
    int axis = 0;
    ((result = result & (Lanes<uint64_t, W>(longIndex(indices)) < array.shape[axis]), ++axis), ...);
    return result;
}

/* Calls f with the places of the elements. */
template <int W, class F, class T, int RANK, class... I> OXRT_INLINE auto withPlaces(F f, const Array<T, RANK>& array, I... indices) {
    if constexpr (sizeof(T) % 4 == 0) {
        uint64_t words = sizeof(T) / 4;
        for (int axis = 0; axis < RANK; ++axis)
            words *= array.shape[axis];
        if (__builtin_expect(words < uint64_t(1) << 31, 1)) {
            Lanes<int32_t, W> index = 0;
            int axis = 0;
            ((index = axis == 0 ? Lanes<int32_t, W>(wordIndex(indices)) : index * int32_t(array.shape[axis]) + wordIndex(indices),
              ++axis), ...);
            return f(WordPlaces<W>{reinterpret_cast<const char*>(array.data), index * int32_t(sizeof(T) / 4)});
        }
    }
    const Lanes<uint64_t, W> base = reinterpret_cast<uint64_t>(array.data);
    return f(AddressPlaces<W>{base + longOffset<W>(array.shape, indices...) * uint64_t(sizeof(T))});
}
template <int W, class F, class T, int RANK, class... I>
OXRT_INLINE auto withPlaces(F f, const VaryingArray<Array<T, RANK>, W>& array, I... indices) {
    if (array.isShared)
        return withPlaces<W>(f, array.shared, indices...);
    return f(AddressPlaces<W>{array.data + longOffset<W>(array.shape, indices...) * uint64_t(sizeof(T))});
}

template <class A> struct ArrayElement;
template <class T, int RANK> struct ArrayElement<Array<T, RANK>> { using Type = T; };
template <class A, int W> struct ArrayElement<VaryingArray<A, W>> : ArrayElement<A> {};

/* array[indices] in the lanes of the mask, zero elsewhere. */
template <int W, class A, class... I> OXRT_INLINE auto load(Lanes<bool, W> mask, const A& array, I... indices) {
    using T = typename ArrayElement<A>::Type;
    return withPlaces<W>([mask](auto places) { return loadFrom<T, W>(places, mask); }, array, indices...);
}

/* Four floats to every place, as one store each; rows of four neighbours in one. */
template <int W> OXRT_INLINE void storeFloat4(const WordPlaces<W>& places, Lanes<bool, W> mask, const Vector<Lanes<float, W>, 4>& value) {
    const QuadRows<W> rows(value);
    char* base = const_cast<char*>(places.base);
    if (all(mask) && all(places.index == firstOfFour(places.index) + loadQuadSteps<W>())) {
        for (int row = 0; row < W / 4; ++row)
            rows.storeRow(base + 4 * int64_t(places.index[4 * row]), row);
        return;
    }
    float quads[W][4];
    rows.storeAll(&quads[0][0]);
    eachLane(mask, [&](int lane) { __builtin_memcpy(base + 4 * int64_t(places.index[lane]), quads[lane], 16); });
}

/* The whole of a T to every place, lowest lane first. */
template <class T, int W, class Places> OXRT_INLINE void storeTo(const Places& places, Lanes<bool, W> mask, const Wide<T, W>& value) {
    eachLane(mask, [&](int lane) { extractLane(*reinterpret_cast<T*>(const_cast<char*>(places.address(lane))), value, lane); });
}

/* array[indices] = value in the lanes of the mask, lowest lane first. */
template <int W, class A, class V, class... I> OXRT_INLINE void store(Lanes<bool, W> mask, const V& value, const A& array, I... indices) {
    using T = typename ArrayElement<A>::Type;
    const Wide<T, W> wide(value);
    withPlaces<W>([&](auto places) {
        if constexpr (isSame<T, float4> && isSame<decltype(places), WordPlaces<W>>)
            storeFloat4(places, mask, wide);
        else
            storeTo<T>(places, mask, wide);
    }, array, indices...);
}

/* f(element, lane) for the elements of the active lanes, lowest lane first: atomic operations and stores to parts of elements. */
template <int W, class F, class A, class... I> OXRT_INLINE void eachElement(Lanes<bool, W> mask, F f, const A& array, I... indices) {
    using T = typename ArrayElement<A>::Type;
    withPlaces<W>([&](auto places) {
        eachLane(mask, [&](int lane) { f(*reinterpret_cast<T*>(const_cast<char*>(places.address(lane))), lane); });
    }, array, indices...);
}

/* A uniform element in a part of an expression that no lane may want. */
template <int W, class T, int RANK, class... I> OXRT_INLINE T loadShared(Lanes<bool, W> mask, const Array<T, RANK>& array, I... indices) {
    return any(mask) ? array.at(indices...) : T{};
}

/* ---- items of fixed arrays, vectors and matrices, by an index that may vary --------------------------------------------------- */

template <class T, int SIZE> OXRT_INLINE T& itemOf(FixedArray<T, SIZE>& array, int i) { return array.items[i]; }
template <class T, int N> OXRT_INLINE T& itemOf(Vector<T, N>& vector, int i) { return vector[i]; }
template <class T, int R, int C> OXRT_INLINE Vector<T, C>& itemOf(Matrix<T, R, C>& matrix, int i) { return matrix[i]; }
template <class T, int N, class X> OXRT_INLINE X& itemOf(CoopVec<T, N, X>& vector, int i) { return vector.items[i]; }
template <class T> inline constexpr int itemCount = vectorSize<T> + fixedArraySize<T> + coopVecSize<T>;
template <class T, int R, int C> inline constexpr int itemCount<Matrix<T, R, C>> = R;

/* Few items are compared one by one and may stay in registers. Of more, only those are looked at that lanes name. */
template <class B, int W> inline constexpr bool hasFewItems = itemCount<B> <= 2 * W;

/* f(i, lanes of the mask whose index is i) for each different index that names one of `count` items. */
template <int W, class I, class F> OXRT_INLINE void eachIndex(Lanes<bool, W> mask, I index, int count, F f) {
    if constexpr (Scalar<I>) {
        if (uint64_t(index) < uint64_t(count))
            f(int(index), mask);
    } else {
        Lanes<bool, W> left = mask & (index >= ElementOf<I>(0)) & (index < ElementOf<I>(count));
        while (any(left)) {
            const auto i = index[firstLane(left)];
            const Lanes<bool, W> own = left & (index == i);
            f(int(i), own);
            left = without(left, own);
        }
    }
}

/* Item `index`, zero where there is none. */
template <int W, class B, class I> requires (!hasFewItems<B, W>) OXRT_INLINE auto loadItem(const B& base, I index) {
    B& items = const_cast<B&>(base); /* read only, itemOf() is for both */
    using Item = PlainType<decltype(itemOf(items, 0))>;
    if constexpr (Scalar<I>)
        return uint64_t(index) < uint64_t(itemCount<B>) ? itemOf(items, int(index)) : Item{};
    else {
        auto result = asWide<W>(Item{});
        eachIndex<W>(Lanes<bool, W>(true), index, itemCount<B>, [&](int i, Lanes<bool, W> own) { assign(own, result, asWide<W>(itemOf(items, i))); });
        return result;
    }
}
template <int W, class B, class I> OXRT_INLINE auto loadItem(const B& base, I index) {
    B copy = base;
    using Item = PlainType<decltype(itemOf(copy, 0))>;
    if constexpr (Scalar<I>) {
        Item result{};
        for (int i = 0; i < itemCount<B>; ++i)
            if (index == I(i))
                result = itemOf(copy, i);
        return result;
    } else {
        auto result = asWide<W>(Item{});
        for (int i = 0; i < itemCount<B>; ++i)
            assign(index == ElementOf<I>(i), result, asWide<W>(itemOf(copy, i)));
        return result;
    }
}

/* f(item, lanes of the mask that name it) for every item. */
template <int W, class B, class I, class F> OXRT_INLINE void eachItem(Lanes<bool, W> mask, B& base, I index, F f) {
    if constexpr (!hasFewItems<B, W>)
        return eachIndex<W>(mask, index, itemCount<B>, [&](int i, Lanes<bool, W> own) { f(itemOf(base, i), own); });
    for (int i = 0; i < itemCount<B>; ++i)
        f(itemOf(base, i), mask & (index == ElementOf<I>(i)));
}

/* ---- lane by lane ------------------------------------------------------------------------------------------------------------- */

/* The value of one lane: of lanes, and of uniform values. */
template <class T> OXRT_INLINE const T& inLane(const T& value, int) { return value; }
template <class T, int W> OXRT_INLINE T inLane(const Lanes<T, W>& value, int lane) { return value[lane]; }
template <class T, int W, int N> OXRT_INLINE Vector<T, N> inLane(const Vector<Lanes<T, W>, N>& value, int lane) {
    return mapComponents<N>([lane](const Lanes<T, W>& x) { return x[lane]; }, value);
}
template <class T, int W, int R, int C> OXRT_INLINE Matrix<T, R, C> inLane(const Matrix<Lanes<T, W>, R, C>& value, int lane) {
    Matrix<T, R, C> result;
    for (int i = 0; i < R; ++i)
        result[i] = inLane(value[i], lane);
    return result;
}
template <class T, int W, int SIZE> OXRT_INLINE FixedArray<T, SIZE> inLane(const FixedArray<Lanes<T, W>, SIZE>& value, int lane) {
    FixedArray<T, SIZE> result;
    for (int i = 0; i < SIZE; ++i)
        result.items[i] = inLane(value.items[i], lane);
    return result;
}
template <class T, int N, int W> OXRT_INLINE CoopVec<T, N> inLane(const CoopVec<T, N, Lanes<typename WidenedNumber<T>::Type, W>>& value, int lane) {
    CoopVec<T, N> result;
    for (int i = 0; i < N; ++i)
        result.items[i] = T(value.items[i][lane]);
    return result;
}
template <class T, int RANK, int W> OXRT_INLINE Array<T, RANK> inLane(const VaryingArray<Array<T, RANK>, W>& value, int lane) {
    Array<T, RANK> result;
    result.data = reinterpret_cast<T*>(value.data[lane]);
    for (int axis = 0; axis < RANK; ++axis)
        result.shape[axis] = value.shape[axis][lane];
    return result;
}

/* f(lane) in every lane of the mask, lowest first; the results as lanes, zero elsewhere. */
template <int W, class F> OXRT_INLINE auto mapActive(Lanes<bool, W> mask, F f) {
    using R = decltype(f(0));
    Wide<PlainType<R>, W> result = spread<W>(PlainType<R>{});
    eachLane(mask, [&](int lane) { insertLane(result, f(lane), lane); });
    return result;
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
