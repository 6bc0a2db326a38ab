// See cpu.h.
#include "cpu.h"

#include "error.h"

#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace oxrt {

namespace {

std::uint32_t processorIsa()
{
    std::uint32_t found = OXRT_ISA_ANY;
#if defined(__x86_64__)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2"))
        found |= OXRT_ISA_X86_64_V3;
    if (found && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
        found |= OXRT_ISA_X86_64_V4;
    if (__builtin_cpu_supports("avx512vbmi")) found |= OXRT_ISA_AVX512_VBMI;
    if (__builtin_cpu_supports("avx512vbmi2")) found |= OXRT_ISA_AVX512_VBMI2;
    if (__builtin_cpu_supports("avx512vnni")) found |= OXRT_ISA_AVX512_VNNI;
    if (__builtin_cpu_supports("avx512bitalg")) found |= OXRT_ISA_AVX512_BITALG;
    if (__builtin_cpu_supports("avx512vpopcntdq")) found |= OXRT_ISA_AVX512_VPOPCNTDQ;
    if (__builtin_cpu_supports("avx512ifma")) found |= OXRT_ISA_AVX512_IFMA;
    if (__builtin_cpu_supports("gfni")) found |= OXRT_ISA_GFNI;
#endif
    return found;
}

} // namespace

std::uint32_t detectIsa()
{
    const char* most = std::getenv("OXRT_MAX_ISA");
    if (!most || !*most) return processorIsa();
    for (const std::uint32_t level : {OXRT_ISA_ANY, OXRT_ISA_X86_64_V3, OXRT_ISA_X86_64_V4})
        if (std::strcmp(most, isaName(level)) == 0) return processorIsa() & level;
    fail(OXRT_ERROR_INVALID_VALUE, "OXRT_MAX_ISA is \"%s\"; set it to x86-64, x86-64-v3 or x86-64-v4, or unset it", most);
}

const char* isaName(std::uint32_t isa)
{
    if (isa & ~std::uint32_t(OXRT_ISA_X86_64_V4)) return "more than x86-64-v4";
    return isa & ~std::uint32_t(OXRT_ISA_X86_64_V3) ? "x86-64-v4" : isa ? "x86-64-v3" : "x86-64";
}

} // namespace oxrt
