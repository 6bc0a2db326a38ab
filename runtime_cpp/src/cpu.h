// What the machine can run, and the floating-point state that kernels expect.
#pragma once

#include "oxrt/pipeline.h"

#include <cstdint>
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace oxrt {

// The bits OXRT_ISA_... of what this machine and operating system run; the variable OXRT_MAX_ISA leaves less.
std::uint32_t detectIsa();

// What --target calls the level of these bits.
const char* isaName(std::uint32_t isa);

// Round to nearest, denormals as IEEE has them, exceptions masked; whatever the caller's thread had comes back at the end. The open
// intervals of built-in primitives need denormals (nextafter(0)).
class KernelFloatState {
public:
#if defined(__x86_64__)
    KernelFloatState() : saved(_mm_getcsr()) { _mm_setcsr(0x1F80); }
    ~KernelFloatState() { _mm_setcsr(saved); }

private:
    const unsigned saved;

public:
#else
    KernelFloatState() = default;
#endif
    KernelFloatState(const KernelFloatState&) = delete;
    KernelFloatState& operator=(const KernelFloatState&) = delete;
};

} // namespace oxrt
