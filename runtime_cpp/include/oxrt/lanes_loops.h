/* Counting loops whose number of turns differs between lanes, and checks of values in debug and validation builds. */
#ifndef OXRT_LANES_LOOPS_H
#define OXRT_LANES_LOOPS_H

#include <oxrt/lanes_records.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* Python's range(start, stop, step) with bounds of each lane's own: see Range. Steps of 0 give no turns. */
template <class T, int W> struct RangeLanes {
    Lanes<uint32_t, W> turns;
    Lanes<T, W> value;
    Lanes<T, W> step;

    OXRT_INLINE RangeLanes(Lanes<T, W> start, Lanes<T, W> stop, Lanes<T, W> step_) : value(start), step(step_) {
        const Lanes<T, W> zero = T(0);
        const Lanes<uint32_t, W> up = convert<uint32_t>(stop) - convert<uint32_t>(start);
        Lanes<uint32_t, W> distance = up;
        Lanes<uint32_t, W> stride = convert<uint32_t>(step);
        Lanes<bool, W> runs = (step > zero) & (start < stop);
        if constexpr (isSigned<T>) {
            const Lanes<bool, W> isDown = step < zero;
            distance = select(isDown, 0u - up, up);
            stride = select(isDown, 0u - stride, stride);
            runs = runs | (isDown & (start > stop));
        }
        if (none(runs & (stride != 1u)))
            turns = select(runs, distance, 0u);
        else
            turns = select(runs, floorDivide(distance - 1u, select(runs, stride, 1u)) + 1u, 0u);
    }

    /* Gives those lanes of the mask that have a turn left their next value; they are the result. */
    OXRT_INLINE Lanes<bool, W> next(Lanes<bool, W> mask, Lanes<T, W>& target) {
        const Lanes<bool, W> runs = mask & (turns != 0u);
        turns = turns - 1u;
        target = select(runs, value, target);
        value = value + step;
        return runs;
    }
};

/* The next turn of a range that all lanes share, for a variable that other lanes keep. */
template <class T, int W> OXRT_INLINE bool nextTurn(Range<T>& range, Lanes<bool, W> mask, Lanes<T, W>& target) {
    T value;
    if (!range.next(value))
        return false;
    target = select(mask, value, target);
    return true;
}

/* ---- groups of equal lanes ---------------------------------------------------------------------------------------------------- */

/* f(value, lanes that have it) for each distinct value among the lanes of the mask. */
template <class T, int W, class F> OXRT_INLINE void eachValue(Lanes<bool, W> mask, Lanes<T, W> values, F f) {
    while (any(mask)) {
        const T value = values[firstLane(mask)];
        const Lanes<bool, W> equal = mask & (values == value);
        f(value, equal);
        mask = without(mask, equal);
    }
}
template <class T, int W, class F> requires Scalar<T> OXRT_INLINE void eachValue(Lanes<bool, W> mask, T value, F f) { f(value, mask); }

/* ---- checks ------------------------------------------------------------------------------------------------------------------- */

/* An active lane, 0 if there is none. */
template <int W> OXRT_INLINE int anyLane(Lanes<bool, W> mask) { return any(mask) ? firstLane(mask) : 0; }

template <int W>
OXRT_INLINE void assertTrue(LanesThread<W>& thread, Lanes<bool, W> mask, Lanes<bool, W> condition, const char* message,
                            Place place = Place::current()) {
    const Lanes<bool, W> failed = without(mask, condition);
    if (__builtin_expect(any(failed), 0))
        fault(thread.atLane(firstLane(failed)), OXRT_FAULT_ASSERT, message, place);
}
template <int W, class... T>
OXRT_INLINE void assertTrue(LanesThread<W>& thread, Place place, Lanes<bool, W> mask, Lanes<bool, W> condition, const char* message,
                            T... values) {
    const Lanes<bool, W> failed = without(mask, condition);
    if (__builtin_expect(any(failed), 0)) {
        const int lane = firstLane(failed);
        faultWithValues(thread.atLane(lane), OXRT_FAULT_ASSERT, message, place, inLane(values, lane)...);
    }
}

/* A fault for the first of the lanes whose indices are outside of the array. */
template <int W, class A, class... I>
__attribute__((noinline, cold)) void faultOfLanes(LanesThread<W>& thread, Lanes<bool, W> outside, Place place, const A& array, I... indices) {
    const int lane = firstLane(outside);
    faultOfIndex(thread.atLane(lane), place, inLane(array, lane), inLane(indices, lane)...);
}

/* The lanes of the mask whose indices are inside of the array; a fault for the first that is not. */
template <int W, class A, class... I>
OXRT_INLINE Lanes<bool, W> insideAt(LanesThread<W>& thread, Lanes<bool, W> mask, Place place, const A& array, I... indices) {
    const Lanes<bool, W> found = mask & inside<W>(array, indices...);
    if (const Lanes<bool, W> outside = without(mask, found); __builtin_expect(any(outside), 0)) {
        faultOfLanes<W>(thread, outside, place, array, indices...);
        return found;
    }
    return mask; /* not `found`: loads need not wait for the comparison */
}

/* The lanes of the mask whose index names an item; a fault for the first whose does not. */
template <int W, class B, class I> OXRT_INLINE Lanes<bool, W> insideItemsAt(LanesThread<W>& thread, Lanes<bool, W> mask, Place place, const B&, I index) {
    auto wide = asWide<W>(index);
    using Wide = decltype(wide);
    const Lanes<bool, W> found = mask & (wide >= Wide(ElementOf<Wide>(0))) & (wide < Wide(ElementOf<Wide>(itemCount<B>)));
    if (const Lanes<bool, W> outside = without(mask, found); __builtin_expect(any(outside), 0)) {
        const int lane = firstLane(outside);
        faultOfItem(thread.atLane(lane), place, inLane(wide, lane), itemCount<B>);
    }
    return found;
}

/* A call of the lanes of a mask on elements that may not exist. The place of the call is that of the author's line. */
template <int W> struct CheckedLanes {
    LanesThread<W>& thread;
    Lanes<bool, W> mask;
    Place place;

    template <class A, class... I> OXRT_INLINE Lanes<bool, W> inside(const A& array, I... indices) const {
        return insideAt(thread, mask, place, array, indices...);
    }
    template <class A, class... I> OXRT_INLINE auto load(const A& array, I... indices) const {
        return oxrt::load<W>(inside(array, indices...), array, indices...);
    }
    template <class V, class A, class... I> OXRT_INLINE void store(const V& value, const A& array, I... indices) const {
        oxrt::store<W>(inside(array, indices...), value, array, indices...);
    }
    template <class B, class I> OXRT_INLINE Lanes<bool, W> insideItems(const B& base, I index) const {
        return insideItemsAt(thread, mask, place, base, index);
    }
    template <class B, class I> OXRT_INLINE auto item(const B& base, I index) const {
        insideItems(base, index);
        return loadItem<W>(base, index);
    }
    template <class T, int SIZE, Scalar I> OXRT_INLINE T& itemPlace(FixedArray<T, SIZE>& base, I index) const {
        static thread_local T nothing;
        if (any(insideItems(base, index)))
            return base[index];
        nothing = T{};
        return nothing;
    }
};
template <int W> OXRT_INLINE CheckedLanes<W> checked(LanesThread<W>& thread, Lanes<bool, W> mask, Place place = Place::current()) {
    return {thread, mask, place};
}

/* The same for an element that all lanes of the mask share: who is told of a fault is found out when there is one. */
template <int W> __attribute__((noinline, cold)) OxrtThread& threadOfAnyLane(LanesThread<W>& thread, Lanes<bool, W> mask) {
    return thread.atLane(anyLane(mask));
}
template <int W> struct ThreadOfAnyLane {
    LanesThread<W>& thread;
    Lanes<bool, W> mask;
    OXRT_INLINE OxrtThread& operator()() const { return threadOfAnyLane(thread, mask); }
};
template <int W>
OXRT_INLINE Checked<ThreadOfAnyLane<W>> checkedCommon(LanesThread<W>& thread, Lanes<bool, W> mask, Place place = Place::current()) {
    return {{thread, mask}, place};
}

/* Lanes whose record's program takes another payload than the trace carries. */
template <int W> OXRT_INLINE void payloadMismatch(RayLanes<W>& ray, Lanes<bool, W> mask) {
    if (__builtin_expect(any(mask), 0))
        payloadMismatch(ray.thread->atLane(firstLane(mask)));
}

/* ---- exceptions --------------------------------------------------------------------------------------------------------------- */

/* Ends the launch indices of the mask; these lanes return, and so do all callers in them. */
template <int W, class... Detail>
OXRT_INLINE void throwException(LanesThread<W>& thread, Lanes<bool, W> mask, const char* line, Wide<int32_t, W> code, Detail... details) {
    thread.thrown |= mask;
    thread.exceptionCode = select(mask, code, thread.exceptionCode);
    thread.exceptionLine = line;
    int next = 0;
    ((thread.exceptionDetails[next] = select(mask, Lanes<uint32_t, W>(details), thread.exceptionDetails[next]), ++next), ...);
}

/* Moves the exception that a scalar program threw to its lanes. */
template <int W> void takeExceptions(LanesThread<W>& thread, Lanes<bool, W> mask) {
    OxrtThread& scalar = *thread.thread;
    thread.thrown |= mask;
    thread.exceptionCode = select(mask, scalar.exceptionCode, thread.exceptionCode);
    for (int i = 0; i < 8; ++i)
        thread.exceptionDetails[i] = select(mask, scalar.exceptionDetails[i], thread.exceptionDetails[i]);
    thread.exceptionLine = scalar.exceptionLine;
    scalar.exceptionPending = 0;
}

/* Makes the exception of one lane that of the scalar thread. */
template <int W> OXRT_INLINE OxrtThread& throwingLane(const LanesThread<W>& thread, int lane) {
    OxrtThread& scalar = thread.atLane(lane);
    scalar.exceptionCode = thread.exceptionCode[lane];
    for (int i = 0; i < 8; ++i)
        scalar.exceptionDetails[i] = thread.exceptionDetails[i][lane];
    scalar.exceptionLine = thread.exceptionLine;
    return scalar;
}

/* ---- payloads and attributes -------------------------------------------------------------------------------------------------- */

/* A wide payload seen as another class with the same words, for the duration of a call. */
template <class To, class From, int W> struct WidePayloadAs {
    Wide<From, W>& original;
    Wide<To, W> copy;

    explicit WidePayloadAs(Wide<From, W>& payload) : original(payload), copy(spread<W>(To{})) { move<From, To>(original, copy); }
    ~WidePayloadAs() { move<To, From>(copy, original); }
    WidePayloadAs(const WidePayloadAs&) = delete;
    WidePayloadAs& operator=(const WidePayloadAs&) = delete;
    OXRT_INLINE operator Wide<To, W>&() { return copy; }

private:
    template <class A, class B> static void move(const Wide<A, W>& from, Wide<B, W>& to) {
        static_assert(sizeof(A) == sizeof(B));
        for (int lane = 0; lane < W; ++lane) {
            A words;
            extractLane(words, from, lane);
            B same;
            __builtin_memcpy(&same, &words, sizeof(same));
            insertLane(to, same, lane);
        }
    }
};

/* The attributes of the hits as the author's struct, whose words all have 32 bits or are wrapped. */
template <class Attributes, int W> OXRT_INLINE Wide<Attributes, W> getAttributes(const RayLanes<W>& ray) {
    Lanes<uint32_t, W> words[8];
    for (int i = 0; i < int(sizeof(Attributes) / 4); ++i)
        words[i] = attributeWord(ray, i);
    Wide<Attributes, W> result;
    if constexpr (Wide<Attributes, W>::hasWrappedFields)
        for (int lane = 0; lane < W; ++lane) {
            uint32_t own[8];
            for (int i = 0; i < int(sizeof(Attributes) / 4); ++i)
                own[i] = words[i][lane];
            Attributes value;
            __builtin_memcpy(&value, own, sizeof(value));
            insertLane(result, value, lane);
        }
    else {
        int next = 0;
        eachPart([&](auto& part) { part = bitCast<ElementOf<PlainType<decltype(part)>>>(words[next++]); }, result);
    }
    return result;
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
