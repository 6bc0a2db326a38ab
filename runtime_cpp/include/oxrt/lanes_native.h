/* Registers of eight 32-bit lanes, and the words that the instruction sets' files share. */
#ifndef OXRT_LANES_NATIVE_H
#define OXRT_LANES_NATIVE_H

#include <oxrt/number.h>

namespace oxrt {
inline namespace OXRT_ISA {

typedef float NativeFloat8 __attribute__((vector_size(32)));
typedef int32_t NativeInt8 __attribute__((vector_size(32)));
typedef uint32_t NativeUint8 __attribute__((vector_size(32)));
typedef double NativeDouble4 __attribute__((vector_size(32)));
typedef int64_t NativeLong4 __attribute__((vector_size(32)));
typedef uint64_t NativeUlong4 __attribute__((vector_size(32)));
typedef float NativeFloat4 __attribute__((vector_size(16)));
typedef int32_t NativeInt4 __attribute__((vector_size(16)));
typedef uint32_t NativeUint4 __attribute__((vector_size(16)));

typedef short NativeHalf8 __attribute__((vector_size(16)));
typedef short NativeHalf16 __attribute__((vector_size(32)));

/* The register that holds W lanes of 4 bytes, or half of W lanes of 8 bytes. */
template <class T, int W> struct NativeVector;

enum class Compare { EQUAL, NOT_EQUAL, LESS, LESS_EQUAL, GREATER, GREATER_EQUAL };

/* Immediate operand of x86's rounding instructions, without the inexact exception. */
enum { ROUND_NEAREST = 8, ROUND_DOWN = 9, ROUND_UP = 10, ROUND_TO_ZERO = 11 };

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
