// See cpu.h.
#include "cpu.h"

namespace oxrt {

std::uint32_t detectIsa()
{
#if defined(__x86_64__)
    __builtin_cpu_init();
    const bool v3 =
        __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
    const bool v4 = v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd") &&
                    __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
    return v4 ? OXRT_ISA_X86_64_V4 : v3 ? OXRT_ISA_X86_64_V3 : OXRT_ISA_ANY;
#else
    return OXRT_ISA_ANY;
#endif
}

} // namespace oxrt
