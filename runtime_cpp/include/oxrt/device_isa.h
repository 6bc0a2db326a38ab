/* Which instruction sets the compiler was allowed to use for this file. */
#ifndef OXRT_DEVICE_ISA_H
#define OXRT_DEVICE_ISA_H

#include <oxrt/pipeline.h>
#include <oxrt/vectors.h>

namespace oxrt {
inline namespace OXRT_ISA {

enum : uint32_t {
    BUILT_ISA = OXRT_ISA_ANY
#if defined(__AVX2__) && defined(__FMA__) && defined(__BMI2__)
        | OXRT_ISA_X86_64_V3
#endif
#if defined(__AVX512F__) && defined(__AVX512BW__) && defined(__AVX512CD__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
        | OXRT_ISA_X86_64_V4
#endif
#ifdef __AVX512VBMI__
        | OXRT_ISA_AVX512_VBMI
#endif
#ifdef __AVX512VBMI2__
        | OXRT_ISA_AVX512_VBMI2
#endif
#ifdef __AVX512VNNI__
        | OXRT_ISA_AVX512_VNNI
#endif
#ifdef __AVX512BITALG__
        | OXRT_ISA_AVX512_BITALG
#endif
#ifdef __AVX512VPOPCNTDQ__
        | OXRT_ISA_AVX512_VPOPCNTDQ
#endif
#ifdef __AVX512IFMA__
        | OXRT_ISA_AVX512_IFMA
#endif
#ifdef __GFNI__
        | OXRT_ISA_GFNI
#endif
};

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
