// The stack of the thread that runs.
#pragma once

#include <cstddef>

namespace oxrt {

// The lowest address of this thread's stack that is not left to Embree's traversals (OXRT_STACK_RESERVE, less on small stacks); the first
// call of a thread asks the system. NULL if that does not know.
const char* findStackLimit();

// Bytes between here and the lowest address of the stack, all of them if the system does not know.
std::size_t stackLeft();

} // namespace oxrt
