/* What a program may ask without a ray: launch index, parameters, SBT records, faults, exceptions, prints, cancellation. */
#ifndef OXRT_DEVICE_THREAD_H
#define OXRT_DEVICE_THREAD_H

#include <oxrt/device_types.h>
#include <oxrt/pipeline.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* ---- launch -------------------------------------------------------------------------------------------------------------------- */

/* The numbers were just stored one by one. Older clang loads two in one piece, which waits for the stores: a fifth of a short program. */
OXRT_INLINE uint3 getLaunchIndex(const OxrtThread& thread) {
    uint3 index = {thread.index[0], thread.index[1], thread.index[2]};
#if defined(__clang__)
    __asm__("" : "+r"(index.x), "+r"(index.y), "+r"(index.z));
#endif
    return index;
}
OXRT_INLINE uint3 getLaunchDimensions(const OxrtThread& thread) {
    return {thread.launch->width, thread.launch->height, thread.launch->depth};
}
OXRT_INLINE constexpr uint undefinedValue() { return 0; }

template <class Params> OXRT_INLINE const Params& launchParams(const OxrtThread& thread) {
    return *static_cast<const Params*>(thread.params);
}

/* Whether the launch is to stop: polled by loops that may never end. */
OXRT_INLINE bool isCancelled(const OxrtThread& thread) { return __atomic_load_n(thread.launch->cancel, __ATOMIC_RELAXED) != 0; }

/* ---- faults, prints ------------------------------------------------------------------------------------------------------------- */

__attribute__((noinline, cold, unused)) static void fault(OxrtThread& thread, int32_t code, const char* message, Place place) {
    thread.launch->services->fault(&thread, code, place.file, place.line, message, nullptr, 0);
}

template <class... T>
__attribute__((noinline, cold)) void faultWithValues(OxrtThread& thread, int32_t code, const char* message, Place place, T... values) {
    const double numbers[] = {double(values)...};
    thread.launch->services->fault(&thread, code, place.file, place.line, message, numbers, sizeof...(T));
}

/* The condition of an assert; false is a fault. */
OXRT_INLINE void assertTrue(OxrtThread& thread, bool condition, const char* message, Place place = Place::current()) {
    if (__builtin_expect(!condition, 0))
        fault(thread, OXRT_FAULT_ASSERT, message, place);
}
template <class... T> OXRT_INLINE void assertTrue(OxrtThread& thread, Place place, bool condition, const char* message, T... values) {
    if (__builtin_expect(!condition, 0))
        faultWithValues(thread, OXRT_FAULT_ASSERT, message, place, values...);
}

/* Widened copies of what a print shows. */
struct PrintValues {
    union {
        int64_t integers[4];
        uint64_t naturals[4];
        float floats[4];
        double doubles[4];
        uint8_t bools[4];
        const char* text;
    };
    uint32_t type;
    uint32_t count;

    OXRT_INLINE OxrtPrintItem item() const {
        return {type, count, type == OXRT_PRINT_STRING ? static_cast<const void*>(text) : static_cast<const void*>(integers)};
    }
};

OXRT_INLINE PrintValues printable(const char* text) {
    PrintValues result;
    result.text = text;
    result.type = OXRT_PRINT_STRING;
    result.count = 1;
    return result;
}
template <Scalar T> OXRT_INLINE void setPrintable(PrintValues& values, int i, T value) {
    if constexpr (isSame<T, bool>) {
        values.bools[i] = value;
        values.type = OXRT_PRINT_BOOL;
    } else if constexpr (isSame<T, float> || isSame<T, half>) {
        values.floats[i] = float(value);
        values.type = OXRT_PRINT_FLOAT32;
    } else if constexpr (isSame<T, double>) {
        values.doubles[i] = value;
        values.type = OXRT_PRINT_FLOAT64;
    } else if constexpr (isSigned<T>) {
        values.integers[i] = value;
        values.type = OXRT_PRINT_INT;
    } else {
        values.naturals[i] = value;
        values.type = OXRT_PRINT_UINT;
    }
}
template <Scalar T> OXRT_INLINE PrintValues printable(T value) {
    PrintValues result;
    result.count = 1;
    setPrintable(result, 0, value);
    return result;
}
template <class T, int N> OXRT_INLINE PrintValues printable(const Vector<T, N>& value) {
    PrintValues result;
    result.count = N;
    for (int i = 0; i < N; ++i)
        setPrintable(result, i, value[i]);
    return result;
}

template <class... T> __attribute__((noinline)) void print(OxrtThread& thread, const char* separator, const char* end, const T&... values) {
    const PrintValues held[sizeof...(T) + 1] = {printable(values)..., printable("")};
    OxrtPrintItem items[sizeof...(T) + 1];
    for (uint32_t i = 0; i < sizeof...(T); ++i)
        items[i] = held[i].item();
    thread.launch->services->print(&thread, items, sizeof...(T), separator, end);
}

/* ---- checked access ------------------------------------------------------------------------------------------------------------- */

/* Names the indices and the shape of the array that they miss. */
template <class T, class... I>
__attribute__((noinline, cold)) void faultOfIndex(OxrtThread& thread, Place place, const Array<T, 1>& array, I... indices) {
    faultWithValues(thread, OXRT_FAULT_BOUNDS, "index out of range (\1), the shape is (\1)", place, indices..., array.shape[0]);
}
template <class T, class... I>
__attribute__((noinline, cold)) void faultOfIndex(OxrtThread& thread, Place place, const Array<T, 2>& array, I... indices) {
    faultWithValues(thread, OXRT_FAULT_BOUNDS, "index out of range (\1, \1), the shape is (\1, \1)", place, indices..., array.shape[0],
                    array.shape[1]);
}
template <class T, class... I>
__attribute__((noinline, cold)) void faultOfIndex(OxrtThread& thread, Place place, const Array<T, 3>& array, I... indices) {
    faultWithValues(thread, OXRT_FAULT_BOUNDS, "index out of range (\1, \1, \1), the shape is (\1, \1, \1)", place, indices..., array.shape[0],
                    array.shape[1], array.shape[2]);
}

template <class T, int SIZE> OXRT_INLINE constexpr int itemsOf(const FixedArray<T, SIZE>&) { return SIZE; }
template <class T, int N> OXRT_INLINE constexpr int itemsOf(const Vector<T, N>&) { return N; }
template <class T, int R, int C> OXRT_INLINE constexpr int itemsOf(const Matrix<T, R, C>&) { return R; }
template <class T, int N, class X> OXRT_INLINE constexpr int itemsOf(const CoopVec<T, N, X>&) { return N; }
template <class I> void faultOfItem(OxrtThread& thread, Place place, I index, int count) {
    faultWithValues(thread, OXRT_FAULT_BOUNDS, "index out of range (\1), there are \1 items", place, index, count);
}

/* Access with a check: an index out of range reads zero, or has `contains` say no, and is a fault. Items are those of fixed arrays,
   vectors of both kinds and matrices; where there is none, `itemPlace` is a place that nobody looks at. `Thread` gives the thread that
   a fault is told of. */
template <class Thread> struct Checked {
    Thread thread;
    Place place;

    template <class B, class I> OXRT_INLINE bool containsItem(const B& base, I index) const {
        if (__builtin_expect(uint64_t(int64_t(index)) < uint64_t(itemsOf(base)), 1))
            return true;
        faultOfItem(thread(), place, index, itemsOf(base));
        return false;
    }
    template <class B, class I> OXRT_INLINE auto item(const B& base, I index) const {
        auto result = base[0];
        result = containsItem(base, index) ? base[index] : decltype(result){};
        return result;
    }
    template <class T, int SIZE, class I> OXRT_INLINE T& itemPlace(FixedArray<T, SIZE>& base, I index) const {
        static thread_local T nothing;
        if (containsItem(base, index))
            return base[index];
        nothing = T{};
        return nothing;
    }

    template <class T, int RANK, class... I> OXRT_INLINE bool contains(const Array<T, RANK>& array, I... indices) const {
        if (__builtin_expect(array.contains(indices...), 1))
            return true;
        faultOfIndex(thread(), place, array, indices...);
        return false;
    }
    template <class T, int RANK, class... I> OXRT_INLINE T load(const Array<T, RANK>& array, I... indices) const {
        return contains(array, indices...) ? array.at(indices...) : T{};
    }
};
struct SameThread {
    OxrtThread& thread;
    OXRT_INLINE OxrtThread& operator()() const { return thread; }
};
OXRT_INLINE Checked<SameThread> checked(OxrtThread& thread, Place place = Place::current()) { return {{thread}, place}; }

/* ---- SBT records ---------------------------------------------------------------------------------------------------------------- */

template <class Record> OXRT_INLINE const Record& recordData(const OxrtRecordHeader& header) {
    return *reinterpret_cast<const Record*>(&header + 1);
}

/* Record `index` of a section if it is there and was packed for this pipeline, else null. */
OXRT_INLINE const OxrtRecordHeader* findRecord(const OxrtLaunch& launch, const uint8_t* section, uint32_t stride, uint32_t count,
                                               uint32_t index) {
    if (__builtin_expect(index >= count, 0))
        return nullptr;
    const auto* header = reinterpret_cast<const OxrtRecordHeader*>(section + uint64_t(stride) * index);
    return __builtin_expect(header->pipelineUid == launch.pipelineUid, 1) ? header : nullptr;
}

/* The data of a record that the SBT gives by address. */
template <class Record> OXRT_INLINE const Record& recordAt(const uint8_t* header) {
    return *reinterpret_cast<const Record*>(header + OXRT_SBT_RECORD_HEADER_SIZE);
}

/* Callables record `index` if it holds a program in `slot`; else a fault, if the launch is validated, and null. */
OXRT_INLINE const OxrtRecordHeader* findCallable(OxrtThread& thread, uint32_t index, int slot, Place place = Place::current()) {
    const OxrtLaunch& launch = *thread.launch;
    const OxrtRecordHeader* record = findRecord(launch, launch.callableRecords, launch.callableStride, launch.callableCount, index);
    if (__builtin_expect(record && record->programs[slot] != OXRT_NO_PROGRAM, 1))
        return record;
    if (launch.validation)
        fault(thread, index >= launch.callableCount ? OXRT_FAULT_CALLABLE_SBT : slot == 0 ? OXRT_FAULT_NO_DIRECT : OXRT_FAULT_NO_CONTINUATION,
              "the callables record does not hold the callable that is called", place);
    return nullptr;
}

__attribute__((noinline, cold, unused)) static void callableMismatch(OxrtThread& thread, Place place) {
    fault(thread, OXRT_FAULT_CALLABLE_ARGUMENTS, "the callable takes other arguments or gives another result than the call", place);
}

/* Where the trace stands that this thread is at, for faults of what runs below it; kept in validation only. */
inline Place& placeOfTrace() {
    static thread_local Place place = {nullptr, 0};
    return place;
}

__attribute__((noinline, cold, unused)) static void payloadMismatch(OxrtThread& thread) {
    fault(thread, OXRT_FAULT_PAYLOAD_MISMATCH, "the record's program takes another payload than the trace carries", placeOfTrace());
}

/* ---- launch indices ------------------------------------------------------------------------------------------------------------- */

/* Runs f for every index of a tile, the thread's index set to it. */
template <class F> OXRT_INLINE void forEachIndex(OxrtThread& thread, const OxrtTile& tile, F f) {
    for (uint32_t z = tile.begin[2]; z < tile.end[2]; ++z)
        for (uint32_t y = tile.begin[1]; y < tile.end[1]; ++y)
            for (uint32_t x = tile.begin[0]; x < tile.end[0]; ++x) {
                thread.index[0] = x;
                thread.index[1] = y;
                thread.index[2] = z;
                f();
            }
}

/* ---- exceptions ----------------------------------------------------------------------------------------------------------------- */

/* Whether the thread's stack has no room for another nested trace or callable. */
OXRT_INLINE bool isStackFull(const OxrtThread& thread) { return __builtin_frame_address(0) < thread.stackLimit; }

/* Ends the launch index: the caller returns, and so do all above it. */
template <class... Detail>
OXRT_INLINE void throwException(OxrtThread& thread, const char* line, int32_t code, Detail... details) {
    const uint32_t values[sizeof...(Detail) + 1] = {uint32_t(details)..., 0};
    for (uint32_t i = 0; i < sizeof...(Detail); ++i)
        thread.exceptionDetails[i] = values[i];
    thread.exceptionCode = code;
    thread.exceptionLine = line;
    thread.exceptionPending = 1;
}
OXRT_INLINE int32_t getExceptionCode(const OxrtThread& thread) { return thread.exceptionCode; }
OXRT_INLINE uint32_t getExceptionDetail_0(const OxrtThread& thread) { return thread.exceptionDetails[0]; }
OXRT_INLINE uint32_t getExceptionDetail_1(const OxrtThread& thread) { return thread.exceptionDetails[1]; }
OXRT_INLINE uint32_t getExceptionDetail_2(const OxrtThread& thread) { return thread.exceptionDetails[2]; }
OXRT_INLINE uint32_t getExceptionDetail_3(const OxrtThread& thread) { return thread.exceptionDetails[3]; }
OXRT_INLINE uint32_t getExceptionDetail_4(const OxrtThread& thread) { return thread.exceptionDetails[4]; }
OXRT_INLINE uint32_t getExceptionDetail_5(const OxrtThread& thread) { return thread.exceptionDetails[5]; }
OXRT_INLINE uint32_t getExceptionDetail_6(const OxrtThread& thread) { return thread.exceptionDetails[6]; }
OXRT_INLINE uint32_t getExceptionDetail_7(const OxrtThread& thread) { return thread.exceptionDetails[7]; }

/* A stack that is used up is an exception where the pipeline asks for it, else a fault. */
template <bool THROWS> __attribute__((noinline, cold)) void overflowStack(OxrtThread& thread, Place place) {
    if constexpr (THROWS)
        throwException(thread, nullptr, OXRT_FAULT_STACK_OVERFLOW);
    else
        fault(thread, OXRT_FAULT_STACK_OVERFLOW, "the stack is used up by nested traces and callables", place);
}

/* Guards a callable that callables call: false, with the overflow told, where the stack is full. */
template <bool THROWS> OXRT_INLINE bool enterCallable(OxrtThread& thread, Place place = Place::current()) {
    if (__builtin_expect(!isStackFull(thread), 1))
        return true;
    overflowStack<THROWS>(thread, place);
    return false;
}

/* What happens without an exception program: the first five exceptions of a launch are printed. */
__attribute__((noinline, cold, unused)) static void tellException(OxrtThread& thread) {
    if (__atomic_fetch_add(thread.launch->exceptionsTold, 1u, __ATOMIC_RELAXED) >= 5)
        return;
    print(thread, " ", "\n", "exception", thread.exceptionCode, "at launch index", thread.index[0], thread.index[1], thread.index[2],
          thread.exceptionLine ? thread.exceptionLine : "");
}

/* The number of the exception program to run for the pending exception; it is not pending any more. */
OXRT_INLINE int32_t takeException(OxrtThread& thread) {
    thread.exceptionPending = 0;
    thread.traceDepth = 0;
    const auto* header = reinterpret_cast<const OxrtRecordHeader*>(thread.launch->exceptionRecord);
    if (!header)
        tellException(thread);
    return header && header->pipelineUid == thread.launch->pipelineUid ? header->programs[0] : OXRT_NO_PROGRAM;
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
