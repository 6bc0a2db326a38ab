// How failures travel inside the runtime: a Failure is thrown where something is wrong and becomes a result code plus a thread-local
// sentence at the C interface. No exception crosses that interface.
#pragma once

#include "oxrt/oxrt.h"

#include <cstddef>
#include <exception>
#include <new>
#include <string>
#include <utility>

namespace oxrt {

class Failure : public std::exception {
public:
    Failure(OxrtResult code, std::string sentence) : result(code), text(std::move(sentence)) {}
    const char* what() const noexcept override { return text.c_str(); }

    const OxrtResult result;
    const std::string text;
};

// The text names the thing, the place in the caller's input and the remedy.
[[noreturn]] void fail(OxrtResult result, const char* format, ...) __attribute__((format(printf, 2, 3)));

std::string formatText(const char* format, ...) __attribute__((format(printf, 1, 2)));

// For memory that is read as it lies; NULL is somebody else's affair.
void checkAligned(const void* pointer, std::size_t alignment, const char* name);

void setLastErrorMessage(const char* text) noexcept;

// Runs the body of a C function.
template <class Body>
OxrtResult guard(Body&& body) noexcept
{
    setLastErrorMessage("");
    try {
        std::forward<Body>(body)();
        return OXRT_SUCCESS;
    } catch (const Failure& failure) {
        setLastErrorMessage(failure.what());
        return failure.result;
    } catch (const std::bad_alloc&) {
        setLastErrorMessage("out of memory: the system refused an allocation; free accels or use a smaller scene");
        return OXRT_ERROR_HOST_OUT_OF_MEMORY;
    } catch (const std::exception& exception) {
        setLastErrorMessage(exception.what());
        return OXRT_ERROR_INTERNAL_ERROR;
    }
}

} // namespace oxrt
