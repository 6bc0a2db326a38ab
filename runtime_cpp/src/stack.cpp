// See stack.h.
#include "stack.h"

#include "oxrt/oxrt.h"

#include <algorithm>
#include <limits>
#include <pthread.h>

namespace oxrt {

namespace {

struct Stack {
    const char* lowest = nullptr;
    std::size_t size = 0;
};

const Stack& stackOfThread()
{
    thread_local const Stack stack = [] {
        pthread_attr_t attributes;
        if (pthread_getattr_np(pthread_self(), &attributes) != 0) return Stack{};
        void* lowest = nullptr;
        std::size_t size = 0;
        pthread_attr_getstack(&attributes, &lowest, &size);
        pthread_attr_destroy(&attributes);
        return Stack{static_cast<const char*>(lowest), size};
    }();
    return stack;
}

} // namespace

const char* findStackLimit()
{
    const Stack& stack = stackOfThread();
    return stack.lowest ? stack.lowest + std::min<std::size_t>(OXRT_STACK_RESERVE, stack.size / 4) : nullptr;
}

std::size_t stackLeft()
{
    const Stack& stack = stackOfThread();
    if (!stack.lowest) return std::numeric_limits<std::size_t>::max();
    return static_cast<std::size_t>(static_cast<const char*>(__builtin_frame_address(0)) - stack.lowest);
}

} // namespace oxrt
