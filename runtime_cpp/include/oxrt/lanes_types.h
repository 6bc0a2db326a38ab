/* Values of any device type, one per lane: which type holds them, assignment under a mask, single lanes in and out.
 *
 * `Wide<T, W>` is the type of W values of T: lanes of numbers (storage numbers widened to 32 bits), vectors, matrices, tuples and fixed
 * arrays of wide values. Generated code specialises WideType for its structs, whose wide form has a static `each(f, structs...)` that
 * calls f with the fields of all given structs side by side.
 */
#ifndef OXRT_LANES_TYPES_H
#define OXRT_LANES_TYPES_H

#include <oxrt/device_types.h>
#include <oxrt/lanes.h>

namespace oxrt {
inline namespace OXRT_ISA {

template <class T, int W> struct VaryingArray;

template <class T, int W> struct WideType;
template <class T, int W> using Wide = typename WideType<T, W>::Type;

template <Scalar T, int W> struct WideType<T, W> { using Type = Lanes<typename WidenedNumber<T>::Type, W>; };
template <Scalar T, int N, int W> struct WideType<Vector<T, N>, W> { using Type = Vector<Wide<T, W>, N>; };
template <Scalar T, int R, int C, int W> struct WideType<Matrix<T, R, C>, W> { using Type = Matrix<Wide<T, W>, R, C>; };
template <class T, int W> concept HasWide = requires { typename WideType<T, W>::Type; };
template <class T, int SIZE, int W> requires HasWide<T, W> struct WideType<FixedArray<T, SIZE>, W> { using Type = FixedArray<Wide<T, W>, SIZE>; };
template <class T, int N, int W> struct WideType<CoopVec<T, N>, W> { using Type = CoopVec<T, N, Lanes<typename WidenedNumber<T>::Type, W>>; };
template <class T, int RANK, int W> struct WideType<Array<T, RANK>, W> { using Type = VaryingArray<Array<T, RANK>, W>; };
template <class... T, int W> struct WideType<Tuple<T...>, W> { using Type = Tuple<Wide<T, W>...>; };
template <class T, int W> struct WideType<Word<T>, W> { using Type = Wide<T, W>; };

/* Arrays that may be another one in every lane. Where all lanes got theirs from one place, `shared` is it and `isShared` is set. */
template <class T, int RANK, int W> struct VaryingArray<Array<T, RANK>, W> {
    Lanes<uint64_t, W> data;
    Lanes<uint64_t, W> shape[RANK];
    Array<T, RANK> shared;
    bool isShared;
};
template <class T> inline constexpr bool isVaryingArray = false;
template <class A, int W> inline constexpr bool isVaryingArray<VaryingArray<A, W>> = true;

template <class T> struct PlainTypeOf { using Type = T; };
template <class T> struct PlainTypeOf<T&> { using Type = T; };
template <class T> struct PlainTypeOf<const T&> { using Type = T; };
template <class T> using PlainType = typename PlainTypeOf<T>::Type;

/* A struct that generated code made wide. */
template <class T> concept WideStruct = requires { typename T::IsWideStruct; };
template <class T> inline constexpr bool isTuple = false;
template <class... T> inline constexpr bool isTuple<Tuple<T...>> = true;
template <class T> inline constexpr bool isMatrix = false;
template <class T, int R, int C> inline constexpr bool isMatrix<Matrix<T, R, C>> = true;
template <class T> inline constexpr int fixedArraySize = 0;
template <class T, int SIZE> inline constexpr int fixedArraySize<FixedArray<T, SIZE>> = SIZE;
template <class T> inline constexpr bool isWord = false;
template <class T> inline constexpr bool isWord<Word<T>> = true;
template <class T> struct WordContent;
template <class T> struct WordContent<Word<T>> { using Type = T; };

/* f(parts...) for the numbers that wide values are made of, in order; the further arguments have the same shape, wide or not. */
template <class F, class First, class... Rest> OXRT_INLINE void eachPart(const F& f, First& first, Rest&... rest);

/* The second argument is words of a payload: its content takes part, and is put back. */
template <class F, class First, class T> OXRT_INLINE void eachPartOfWord(const F& f, First& first, Word<T>& word) {
    T content = word;
    eachPart(f, first, content);
    word = Word<T>(content);
}

template <class F, class First, class... Rest> OXRT_INLINE void eachPart(const F& f, First& first, Rest&... rest) {
    if constexpr ((isWord<Rest> || ...))
        eachPartOfWord(f, first, rest...);
    else if constexpr (IsVector<First>) {
        for (int i = 0; i < vectorSize<First>; ++i)
            eachPart(f, first[i], rest[i]...);
    } else if constexpr (isMatrix<First>) {
        for (int i = 0; i < int(sizeof(first.rows) / sizeof(first.rows[0])); ++i)
            eachPart(f, first.rows[i], rest.rows[i]...);
    } else if constexpr (fixedArraySize<First> > 0) {
        for (int i = 0; i < fixedArraySize<First>; ++i)
            eachPart(f, first.items[i], rest.items[i]...);
    } else if constexpr (coopVecSize<First> > 0) {
        for (int i = 0; i < coopVecSize<First>; ++i)
            eachPart(f, first.items[i], rest.items[i]...);
    } else if constexpr (isSame<First, Tuple<>>) {
    } else if constexpr (isTuple<First>) {
        eachPart(f, first.first, rest.first...);
        eachPart(f, first.rest, rest.rest...);
    } else if constexpr (WideStruct<First>)
        First::each([&f](auto&... fields) __attribute__((always_inline)) { eachPart(f, fields...); }, first, rest...);
    else
        f(first, rest...);
}

/* ---- assignment and choice under a mask --------------------------------------------------------------------------------------- */

template <int W, class T> OXRT_INLINE void assignPart(Lanes<bool, W> mask, Lanes<T, W>& to, const Lanes<T, W>& from) {
    to = select(mask, from, to);
}
template <int W, class T, int RANK>
OXRT_INLINE void assignPart(Lanes<bool, W> mask, VaryingArray<Array<T, RANK>, W>& to, const VaryingArray<Array<T, RANK>, W>& from) {
    to.data = select(mask, from.data, to.data);
    for (int axis = 0; axis < RANK; ++axis)
        to.shape[axis] = select(mask, from.shape[axis], to.shape[axis]);
    to.isShared = false;
}

/* target = value in the lanes of the mask; a value that all lanes share is spread. */
template <int W, class T> OXRT_INLINE void assign(Lanes<bool, W> mask, T& target, const T& value) {
    T copy = value;
    eachPart([mask](auto& to, auto& from) { assignPart(mask, to, from); }, target, copy);
}
template <int W, class T, class U> requires(!isSame<T, U>) OXRT_INLINE void assign(Lanes<bool, W> mask, T& target, const U& value) {
    assign(mask, target, T(value));
}

template <int W, class T> requires(!Number<T> && vectorSize<T> == 0) OXRT_INLINE T select(Lanes<bool, W> mask, T ifTrue, T ifFalse) {
    assign(mask, ifFalse, ifTrue);
    return ifFalse;
}

/* ---- single lanes ------------------------------------------------------------------------------------------------------------- */

template <class T, class U, int W> OXRT_INLINE void extractPart(T& to, const Lanes<U, W>& from, int lane) { to = T(from[lane]); }
template <class T, int RANK, int W>
OXRT_INLINE void extractPart(Array<T, RANK>& to, const VaryingArray<Array<T, RANK>, W>& from, int lane) {
    to.data = reinterpret_cast<T*>(from.data[lane]);
    for (int axis = 0; axis < RANK; ++axis)
        to.shape[axis] = from.shape[axis][lane];
}
template <class T, class U, int W> OXRT_INLINE void insertPart(Lanes<U, W>& to, const T& from, int lane) { to.set(lane, U(from)); }
template <class T, int RANK, int W> OXRT_INLINE void insertPart(VaryingArray<Array<T, RANK>, W>& to, const Array<T, RANK>& from, int lane) {
    to.data.set(lane, reinterpret_cast<uint64_t>(from.data));
    for (int axis = 0; axis < RANK; ++axis)
        to.shape[axis].set(lane, from.shape[axis]);
    to.isShared = false;
}
template <class T, class U, int W> OXRT_INLINE void spreadPart(Lanes<U, W>& to, const T& from) { to = U(from); }
template <class T, int RANK, int W> OXRT_INLINE void spreadPart(VaryingArray<Array<T, RANK>, W>& to, const Array<T, RANK>& from) {
    to.data = reinterpret_cast<uint64_t>(from.data);
    for (int axis = 0; axis < RANK; ++axis)
        to.shape[axis] = from.shape[axis];
    to.shared = from;
    to.isShared = true;
}

/* `target`, of the type that V is the wide form of, becomes the value in one lane; storage numbers are narrowed. */
template <class T, class V> OXRT_INLINE void extractLane(T& target, const V& value, int lane) {
    V copy = value;
    eachPart([lane](auto& from, auto& to) { extractPart(to, from, lane); }, copy, target);
}
template <class T, class V> OXRT_INLINE void insertLane(V& target, const T& value, int lane) {
    T copy = value;
    eachPart([lane](auto& to, auto& from) { insertPart(to, from, lane); }, target, copy);
}

/* The value in all lanes. */
template <int W, class T> OXRT_INLINE Wide<T, W> spread(const T& value) {
    Wide<T, W> result;
    T copy = value;
    eachPart([](auto& to, auto& from) { spreadPart(to, from); }, result, copy);
    return result;
}

/* The value as its wide form, if it is not wide already. */
template <int W, class T> OXRT_INLINE auto asWide(const T& value) {
    if constexpr (HasWide<T, W>)
        return spread<W>(value);
    else
        return value;
}

/* f(lane) for every lane of the mask, lowest first. */
template <int W, class F> OXRT_INLINE void eachLane(Lanes<bool, W> mask, F f) {
    for (uint32_t bits = mask.bits(); bits != 0; bits &= bits - 1)
        f(__builtin_ctz(bits));
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
