/* What a program may ask without a ray: launch index, parameters, SBT records, faults, exceptions, prints, cancellation. */
#ifndef OXRT_DEVICE_THREAD_H
#define OXRT_DEVICE_THREAD_H

#include <oxrt/device_types.h>
#include <oxrt/pipeline.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* ---- launch -------------------------------------------------------------------------------------------------------------------- */

OXRT_INLINE uint3 getLaunchIndex(const OxrtThread& thread) { return {thread.index[0], thread.index[1], thread.index[2]}; }
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

template <class T, int RANK, class... I>
OXRT_INLINE bool inBounds(OxrtThread& thread, const Array<T, RANK>& array, Place place, I... indices) {
    if (__builtin_expect(array.contains(indices...), 1))
        return true;
    faultWithValues(thread, OXRT_FAULT_BOUNDS, "index out of range", place, indices...);
    return false;
}

/* The element, or zero and a fault where an index is out of range. */
template <class T, int RANK, class... I>
OXRT_INLINE T loadChecked(OxrtThread& thread, const Array<T, RANK>& array, Place place, I... indices) {
    return inBounds(thread, array, place, indices...) ? array.at(indices...) : T{};
}

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

/* ---- exceptions ----------------------------------------------------------------------------------------------------------------- */

/* Ends the launch index: the caller returns, and so do all above it. */
template <class... Detail>
OXRT_INLINE void throwException(OxrtThread& thread, const char* file, int32_t code, Detail... details) {
    const uint32_t values[sizeof...(Detail) + 1] = {uint32_t(details)..., 0};
    for (uint32_t i = 0; i < sizeof...(Detail); ++i)
        thread.exceptionDetails[i] = values[i];
    thread.exceptionCode = code;
    thread.exceptionLine = file;
    thread.exceptionPending = 1;
}
OXRT_INLINE int32_t getExceptionCode(const OxrtThread& thread) { return thread.exceptionCode; }
template <int INDEX> OXRT_INLINE uint32_t getExceptionDetail(const OxrtThread& thread) { return thread.exceptionDetails[INDEX]; }

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
