/* float32 functions for `math fast`: at most 4 ulp, no special cases beyond those stated; the rest is precise. */
#ifndef OXRT_MATH_FAST_H
#define OXRT_MATH_FAST_H

#include <oxrt/math_precise.h>

namespace oxrt {
inline namespace OXRT_ISA {
namespace fast {

using namespace precise;

}  // namespace fast
}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
