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

template <class T> OXRT_INLINE T atomicAdd(T& place, T value) { return fetchAdd(&place, value); }
template <class T> OXRT_INLINE T atomicSub(T& place, T value) { return fetchAdd(&place, T(-value)); }
template <class T> OXRT_INLINE T atomicExch(T& place, T value) {
    return atomicUpdate(&place, [value](T) { return value; });
}
template <class T> OXRT_INLINE T atomicMin(T& place, T value) {
    return atomicUpdate(&place, [value](T old) { return value < old ? value : old; });
}
template <class T> OXRT_INLINE T atomicMax(T& place, T value) {
    return atomicUpdate(&place, [value](T old) { return old < value ? value : old; });
}
template <class T> OXRT_INLINE T atomicAnd(T& place, T value) { return __atomic_fetch_and(&place, value, __ATOMIC_RELAXED); }
template <class T> OXRT_INLINE T atomicOr(T& place, T value) { return __atomic_fetch_or(&place, value, __ATOMIC_RELAXED); }
template <class T> OXRT_INLINE T atomicXor(T& place, T value) { return __atomic_fetch_xor(&place, value, __ATOMIC_RELAXED); }
template <class T> OXRT_INLINE T atomicInc(T& place, T value) {
    return atomicUpdate(&place, [value](T old) { return old >= value ? T(0) : T(old + 1); });
}
template <class T> OXRT_INLINE T atomicDec(T& place, T value) {
    return atomicUpdate(&place, [value](T old) { return old == T(0) || old > value ? value : T(old - 1); });
}
template <class T> OXRT_INLINE T atomicCas(T& place, T expected, T value) {
    return atomicUpdate(&place, [expected, value](T old) { return old == expected ? value : old; });
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
