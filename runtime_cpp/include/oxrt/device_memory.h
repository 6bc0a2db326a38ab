/* Memory that several threads write: atomics on array elements. All are relaxed and give the old value. */
#ifndef OXRT_DEVICE_MEMORY_H
#define OXRT_DEVICE_MEMORY_H

#include <oxrt/device_thread.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* Replaces the value at `place` by change(old) in one step. */
template <class T, class F> OXRT_INLINE T atomicUpdate(T* place, F change) {
    T old;
    __atomic_load(place, &old, __ATOMIC_RELAXED);
    for (;;) {
        T wanted = change(old);
        if (__atomic_compare_exchange(place, &old, &wanted, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED))
            return old;
    }
}

/* Adds, for floats by trying again until nobody came between. */
template <class T> OXRT_INLINE T fetchAdd(T* place, T value) {
    if constexpr (isFloating<T>)
        return atomicUpdate(place, [value](T old) { return T(old + value); });
    else
        return __atomic_fetch_add(place, value, __ATOMIC_RELAXED);
}

/* The functions of shaders: on element `index`; outside of the array they do nothing and give zero. */
#define OXRT_ATOMIC(NAME, ...)                                                                                        \
    template <class T, int RANK> OXRT_INLINE T NAME(const Array<T, RANK>& array, uint32_t index, T value) {            \
        T* place = elementOf(array, index);                                                                            \
        return place ? __VA_ARGS__ : T(0);                                                                             \
    }
template <class T, int RANK> OXRT_INLINE T* elementOf(const Array<T, RANK>& array, uint32_t index) {
    uint64_t count = 1;
    for (int axis = 0; axis < RANK; ++axis)
        count *= array.shape[axis];
    return index < count ? array.data + index : nullptr;
}
OXRT_ATOMIC(atomicAdd, fetchAdd(place, value))
OXRT_ATOMIC(atomicSub, fetchAdd(place, T(-value)))
OXRT_ATOMIC(atomicExch, atomicUpdate(place, [value](T) { return value; }))
OXRT_ATOMIC(atomicMin, atomicUpdate(place, [value](T old) { return value < old ? value : old; }))
OXRT_ATOMIC(atomicMax, atomicUpdate(place, [value](T old) { return old < value ? value : old; }))
OXRT_ATOMIC(atomicAnd, __atomic_fetch_and(place, value, __ATOMIC_RELAXED))
OXRT_ATOMIC(atomicOr, __atomic_fetch_or(place, value, __ATOMIC_RELAXED))
OXRT_ATOMIC(atomicXor, __atomic_fetch_xor(place, value, __ATOMIC_RELAXED))
OXRT_ATOMIC(atomicInc, atomicUpdate(place, [value](T old) { return old >= value ? T(0) : T(old + 1); }))
OXRT_ATOMIC(atomicDec, atomicUpdate(place, [value](T old) { return old == T(0) || old > value ? value : T(old - 1); }))
#undef OXRT_ATOMIC
template <class T, int RANK> OXRT_INLINE T atomicCas(const Array<T, RANK>& array, uint32_t index, T expected, T value) {
    T* place = elementOf(array, index);
    return place ? atomicUpdate(place, [expected, value](T old) { return old == expected ? value : old; }) : T(0);
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
