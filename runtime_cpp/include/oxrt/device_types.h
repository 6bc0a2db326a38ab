/* Types of device code beside numbers and vectors: arrays in host memory, fixed arrays, tuples, words of payload registers. */
#ifndef OXRT_DEVICE_TYPES_H
#define OXRT_DEVICE_TYPES_H

#include <oxrt/number.h>

namespace oxrt {
inline namespace OXRT_ISA {

using uint = uint32_t;

/* A file and line of the shader; as a default argument it names the caller's, which #line maps to the author's file. */
struct Place {
    const char* file;
    uint32_t line;
    static constexpr Place current(const char* file = __builtin_FILE(), uint32_t line = __builtin_LINE()) { return {file, line}; }
};

/* ---- memory -------------------------------------------------------------------------------------------------------------------- */

/* A view of host memory, C-contiguous. Negative indices do not wrap: they become very large. */
template <class T, int RANK> struct Array {
    T* data;
    uint64_t shape[RANK];

    template <class... I> OXRT_INLINE T& at(I... indices) const {
        static_assert(sizeof...(I) == RANK);
        return data[offset(indices...)];
    }

    template <class... I> OXRT_INLINE bool contains(I... indices) const {
        int axis = 0;
        return ((uint64_t(int64_t(indices)) < shape[axis++]) && ...);
    }

    template <class... I> OXRT_INLINE uint64_t offset(I... indices) const {
        uint64_t result = 0;
        int axis = 0;
        ((result = axis == 0 ? position(indices) : result * shape[axis] + position(indices), ++axis), ...);
        return result;
    }

private:
    static OXRT_INLINE constexpr uint64_t position(int32_t i) { return uint64_t(int64_t(i)); }
    static OXRT_INLINE constexpr uint64_t position(uint32_t i) { return i; }
    static OXRT_INLINE constexpr uint64_t position(int64_t i) { return uint64_t(i); }
    static OXRT_INLINE constexpr uint64_t position(uint64_t i) { return i; }
};

/* SIZE values of T, held by value; indices out of range read T{} and drop writes. */
template <class T, int SIZE> struct FixedArray {
    T items[SIZE];

    OXRT_INLINE bool contains(int64_t i) const { return uint64_t(i) < uint64_t(SIZE); }
    OXRT_INLINE T& operator[](int64_t i) { return items[i]; }
    OXRT_INLINE const T& operator[](int64_t i) const { return items[i]; }
    OXRT_INLINE T load(int64_t i) const { return contains(i) ? items[i] : T{}; }
};

/* ---- cooperative vectors ------------------------------------------------------------------------------------------------------- */

/* N numbers that T holds; X is T itself, or lanes of what T widens to. See coop_vec.h. */
template <class T, int N, class X = T> struct CoopVec {
    X items[N];

    OXRT_INLINE X& operator[](int64_t i) { return items[i]; }
    OXRT_INLINE const X& operator[](int64_t i) const { return items[i]; }
};

template <class V> inline constexpr int coopVecSize = 0;
template <class T, int N, class X> inline constexpr int coopVecSize<CoopVec<T, N, X>> = N;

/* ---- tuples -------------------------------------------------------------------------------------------------------------------- */

template <class... T> struct Tuple;
template <> struct Tuple<> {};
template <class First, class... Rest> struct Tuple<First, Rest...> {
    First first;
    [[no_unique_address]] Tuple<Rest...> rest;
};

OXRT_INLINE constexpr Tuple<> makeTuple() { return {}; }
template <class First, class... Rest> OXRT_INLINE constexpr Tuple<First, Rest...> makeTuple(First first, Rest... rest) {
    return {first, makeTuple(rest...)};
}

template <int INDEX, class First, class... Rest> OXRT_INLINE constexpr auto& get(Tuple<First, Rest...>& tuple) {
    if constexpr (INDEX == 0)
        return tuple.first;
    else
        return get<INDEX - 1>(tuple.rest);
}
template <int INDEX, class First, class... Rest> OXRT_INLINE constexpr const auto& get(const Tuple<First, Rest...>& tuple) {
    if constexpr (INDEX == 0)
        return tuple.first;
    else
        return get<INDEX - 1>(tuple.rest);
}

/* ---- payload and attribute words ------------------------------------------------------------------------------------------------ */

/* A value of another size than 4 bytes as whole 32-bit words, so that a struct of such fields is an array of words. */
template <class T> struct Word {
    uint32_t words[(sizeof(T) + 3) / 4];

    Word() = default;
    OXRT_INLINE Word(const T& value) {
        words[0] = 0;
        __builtin_memcpy(words, &value, sizeof(T));
    }
    OXRT_INLINE operator T() const {
        T value;
        __builtin_memcpy(&value, words, sizeof(T));
        return value;
    }
};

/* The payload of a trace without one. */
struct NoPayload {};
inline NoPayload noPayload;

/* A payload seen as another class with the same words, for the duration of a call. */
template <class To, class From> struct PayloadAs {
    From& original;
    To copy;

    OXRT_INLINE explicit PayloadAs(From& payload) : original(payload) {
        static_assert(sizeof(To) == sizeof(From));
        __builtin_memcpy(&copy, &payload, sizeof(To));
    }
    OXRT_INLINE ~PayloadAs() { __builtin_memcpy(&original, &copy, sizeof(To)); }
    PayloadAs(const PayloadAs&) = delete;
    PayloadAs& operator=(const PayloadAs&) = delete;
    OXRT_INLINE operator To&() { return copy; }
};

/* ---- loops --------------------------------------------------------------------------------------------------------------------- */

/* Python's range(start, stop, step): the number of turns is fixed before the first one, so that nothing overflows. */
template <class T> struct Range {
    uint64_t turns;
    T value;
    T step;

    OXRT_INLINE constexpr Range(T start, T stop, T step_) : turns(0), value(start), step(step_) {
        const int64_t distance = int64_t(stop) - int64_t(start);
        const int64_t stride = int64_t(step_);
        if (stride > 0 && distance > 0)
            turns = (uint64_t(distance) + uint64_t(stride) - 1) / uint64_t(stride);
        else if (stride < 0 && distance < 0)
            turns = (uint64_t(-distance) + uint64_t(-stride) - 1) / uint64_t(-stride);
    }

    /* Gives the next value to `target`; false after the last one. */
    OXRT_INLINE constexpr bool next(T& target) {
        if (turns == 0)
            return false;
        target = value;
        ++*this;
        return true;
    }

    /* For loops over the range itself: it is its own iterator, at its end when no turns are left. */
    struct End {};
    OXRT_INLINE constexpr Range begin() const { return *this; }
    OXRT_INLINE constexpr End end() const { return {}; }
    OXRT_INLINE constexpr T operator*() const { return value; }
    OXRT_INLINE constexpr Range& operator++() {
        --turns;
        value = T(value + step);
        return *this;
    }
    OXRT_INLINE constexpr bool operator!=(End) const { return turns != 0; }
};

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
