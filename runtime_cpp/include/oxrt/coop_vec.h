/* Cooperative vectors: fixed numbers of values that one launch index holds, and what is done with them element by element.
 *
 * `CoopVec<T, N, X>` holds N numbers of type T; X is T itself, or lanes of what T widens to. Arithmetic is that of the widened type, rounded
 * or wrapped to T after each operation: float16 is computed in binary32.
 */
#ifndef OXRT_COOP_VEC_H
#define OXRT_COOP_VEC_H

#include <oxrt/device_memory.h>
#include <oxrt/math_geometry.h>

namespace oxrt {
inline namespace OXRT_ISA {

template <class T> using Widened = typename WidenedNumber<T>::Type;
/* What the items of CoopVec<T, N, X> are computed in, and what items of T are held as that are computed as C. */
template <class T, class X> using ComputedItem = typename ChooseType<isSame<T, X>, Widened<T>, X>::Type;
template <class T, class C> using HeldItem = typename ChooseType<NumberTraits<C>::lanes == 1, T, C>::Type;

/* ---- making -------------------------------------------------------------------------------------------------------------------- */

template <class V> struct CoopVecMaker;
template <class T, int N, class X> struct CoopVecMaker<CoopVec<T, N, X>> {
    /* Zero, one number for all items, or one for each. */
    template <class... A> static OXRT_INLINE CoopVec<T, N, X> make(A... values) {
        CoopVec<T, N, X> result;
        if constexpr (sizeof...(A) <= 1)
            for (int i = 0; i < N; ++i)
                result.items[i] = X((T(0) + ... + convert<T>(values)));
        else {
            int i = 0;
            ((result.items[i++] = X(convert<T>(values))), ...);
        }
        return result;
    }
};
template <class V, class... A> OXRT_INLINE V coopVecOf(A... values) { return CoopVecMaker<V>::make(values...); }

/* ---- element by element -------------------------------------------------------------------------------------------------------- */

/* Item i in the type of arithmetic; a number stands for all items, rounded to what T holds. */
template <class T, int N, class X> OXRT_INLINE ComputedItem<T, X> computed(const CoopVec<T, N, X>& vector, int i) {
    return ComputedItem<T, X>(vector.items[i]);
}
template <class T, Number A> OXRT_INLINE Rebind<A, Widened<T>> computed(const A& number, int) { return convert<Widened<T>>(convert<T>(number)); }

/* f applied to the items of vectors of one type. */
template <class T, int N, class F, class... V> OXRT_INLINE auto mapItems(F f, const V&... vectors) {
    using C = decltype(f(computed<T>(vectors, 0)...));
    CoopVec<T, N, HeldItem<T, C>> result;
    for (int i = 0; i < N; ++i)
        result.items[i] = convert<T>(f(computed<T>(vectors, i)...));
    return result;
}

#define OXRT_COOP_VEC_1(name, function)                                                                                \
    template <class T, int N, class X> OXRT_INLINE auto name(const CoopVec<T, N, X>& a) {                              \
        return mapItems<T, N>([](auto x) { return function(x); }, a);                                                  \
    }
OXRT_COOP_VEC_1(coopVecExp2, oxrt::exp2)
OXRT_COOP_VEC_1(coopVecLog2, oxrt::log2)
OXRT_COOP_VEC_1(coopVecTanh, oxrt::tanh)
#undef OXRT_COOP_VEC_1

#define OXRT_COOP_VEC_2(name, expression)                                                                              \
    template <class T, int N, class X, class B> OXRT_INLINE auto name(const CoopVec<T, N, X>& a, const B& b) {         \
        return mapItems<T, N>([](auto p, auto q) {                                                                     \
            using C = Common<decltype(p), decltype(q)>;                                                                \
            const C x = p, y = q;                                                                                      \
            return C(expression);                                                                                      \
        }, a, b);                                                                                                      \
    }
OXRT_COOP_VEC_2(coopVecMin, oxrt::min(x, y))
OXRT_COOP_VEC_2(coopVecMax, oxrt::max(x, y))
OXRT_COOP_VEC_2(coopVecMul, x* y)
OXRT_COOP_VEC_2(coopVecAdd, x + y)
OXRT_COOP_VEC_2(coopVecSub, x - y)
OXRT_COOP_VEC_2(coopVecStep, select(y < x, C(ElementOf<C>(0)), C(ElementOf<C>(1))))
#undef OXRT_COOP_VEC_2

/* a * b + c, rounded once in the type of arithmetic, and then to T. */
template <class T, int N, class A, class B, class C>
OXRT_INLINE auto coopVecFFMA(const CoopVec<T, N, A>& a, const CoopVec<T, N, B>& b, const CoopVec<T, N, C>& c) {
    return mapItems<T, N>([](auto p, auto q, auto r) {
        using R = Common<Common<decltype(p), decltype(q)>, decltype(r)>;
        if constexpr (isFloating<ElementOf<R>>)
            return R(fma(R(p), R(q), R(r)));
        else
            return R(R(p) * R(q) + R(r));
    }, a, b, c);
}

/* The items as To, which is float or half. */
template <class To, class T, int N, class X> OXRT_INLINE auto coopVecCvt(const CoopVec<T, N, X>& vector) {
    using C = Rebind<ComputedItem<T, X>, float>;
    CoopVec<To, N, HeldItem<To, C>> result;
    for (int i = 0; i < N; ++i)
        result.items[i] = convert<To>(C(convert<float>(computed<T>(vector, i))));
    return result;
}

/* ---- memory -------------------------------------------------------------------------------------------------------------------- */

/* Of offsets, in bytes. */
enum : uint32_t { MATRIX_ALIGNMENT = 64, VECTOR_ALIGNMENT = 16, ACCUMULATOR_ALIGNMENT = 4 };

/* What says which memory a call may touch, for one launch index; over lanes it has a mask. */
template <class S> concept PlainSpans = !requires(S spans) { spans.mask; };
template <class S> concept LaneSpans = !PlainSpans<S>;

/* Any, for builds without checks. */
struct AnySpan {
    template <class A> OXRT_INLINE bool contains(const A&, uint32_t, uint64_t, uint32_t) const { return true; }
};
inline constexpr AnySpan anySpan;

/* Only what lies inside of the array, at an aligned offset; everything else is a fault. */
struct CheckedSpans {
    OxrtThread& thread;
    Place place;

    template <class T, int RANK>
    OXRT_INLINE bool contains(const Array<T, RANK>& array, uint32_t offset, uint64_t bytes, uint32_t alignment) const {
        uint64_t size = sizeof(T);
        for (int axis = 0; axis < RANK; ++axis)
            size *= array.shape[axis];
        if (__builtin_expect(offset % alignment != 0, 0))
            faultWithValues(thread, OXRT_FAULT_BOUNDS, "offset \1 is no multiple of \1", place, offset, alignment);
        else if (__builtin_expect(offset + bytes > size, 0))
            faultWithValues(thread, OXRT_FAULT_BOUNDS, "\1 bytes from offset \1 end behind the array, which has \1 bytes", place, bytes, offset,
                            size);
        else if (__builtin_expect(alignment == ACCUMULATOR_ALIGNMENT && reinterpret_cast<uint64_t>(array.data) % 4 != 0, 0))
            fault(thread, OXRT_FAULT_BOUNDS, "the array begins at an address that is no multiple of 4", place);
        else
            return true;
        return false;
    }
};
OXRT_INLINE CheckedSpans checkedSpans(OxrtThread& thread, Place place) { return {thread, place}; }

/* V, which is held as in memory, from an offset in bytes. */
template <class V, PlainSpans Spans, class T, int RANK> OXRT_INLINE V coopVecLoad(Spans spans, const Array<T, RANK>& array, uint32_t offset) {
    V result{};
    if (spans.contains(array, offset, sizeof(V), VECTOR_ALIGNMENT))
        __builtin_memcpy(&result, reinterpret_cast<const char*>(array.data) + offset, sizeof(V));
    return result;
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#include <oxrt/coop_vec_accumulate.h>
#include <oxrt/coop_vec_matrix.h>

#endif
