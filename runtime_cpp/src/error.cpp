// Result names and the thread's last sentence.
#include "error.h"

#include <algorithm>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstring>

#ifndef OXRT_VERSION
#error "OXRT_VERSION comes from the build system"
#endif

namespace oxrt {

namespace {

// A fixed buffer: keeping the message must not itself run out of memory.
thread_local char lastMessage[2048] = "";

std::string formatList(const char* format, va_list arguments)
{
    char text[2048];
    std::vsnprintf(text, sizeof text, format, arguments);
    return text;
}

struct ResultName {
    OxrtResult result;
    const char* name;
    const char* text;
};

constexpr ResultName resultNames[] = {
    {OXRT_SUCCESS, "OXRT_SUCCESS", "Success"},
    {OXRT_ERROR_INVALID_VALUE, "OXRT_ERROR_INVALID_VALUE", "Invalid value"},
    {OXRT_ERROR_HOST_OUT_OF_MEMORY, "OXRT_ERROR_HOST_OUT_OF_MEMORY", "Host is out of memory"},
    {OXRT_ERROR_INVALID_OPERATION, "OXRT_ERROR_INVALID_OPERATION", "Invalid operation"},
    {OXRT_ERROR_FILE_IO_ERROR, "OXRT_ERROR_FILE_IO_ERROR", "File I/O error"},
    {OXRT_ERROR_INVALID_FILE_FORMAT, "OXRT_ERROR_INVALID_FILE_FORMAT", "Invalid file format"},
    {OXRT_ERROR_INVALID_DEVICE_CONTEXT, "OXRT_ERROR_INVALID_DEVICE_CONTEXT", "Invalid device context"},
    {OXRT_ERROR_VALIDATION_FAILURE, "OXRT_ERROR_VALIDATION_FAILURE", "Validation failure"},
    {OXRT_ERROR_LAUNCH_FAILURE, "OXRT_ERROR_LAUNCH_FAILURE", "Launch failure"},
    {OXRT_ERROR_PIPELINE_LINK_ERROR, "OXRT_ERROR_PIPELINE_LINK_ERROR", "Pipeline link error"},
    {OXRT_ERROR_NOT_SUPPORTED, "OXRT_ERROR_NOT_SUPPORTED", "Feature is not supported"},
    {OXRT_ERROR_UNSUPPORTED_ABI_VERSION, "OXRT_ERROR_UNSUPPORTED_ABI_VERSION", "Unsupported ABI version"},
    {OXRT_ERROR_LIBRARY_NOT_FOUND, "OXRT_ERROR_LIBRARY_NOT_FOUND", "Library not found"},
    {OXRT_ERROR_ENTRY_SYMBOL_NOT_FOUND, "OXRT_ERROR_ENTRY_SYMBOL_NOT_FOUND", "Entry symbol not found"},
    {OXRT_ERROR_LAUNCH_CANCELLED, "OXRT_ERROR_LAUNCH_CANCELLED", "Launch was cancelled"},
    {OXRT_ERROR_INTERNAL_ERROR, "OXRT_ERROR_INTERNAL_ERROR", "Internal error"},
};

const ResultName* findName(OxrtResult result)
{
    for (const ResultName& entry : resultNames)
        if (entry.result == result) return &entry;
    return nullptr;
}

} // namespace

void fail(OxrtResult result, const char* format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    std::string text = formatList(format, arguments);
    va_end(arguments);
    throw Failure(result, std::move(text));
}

std::string formatText(const char* format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    std::string text = formatList(format, arguments);
    va_end(arguments);
    return text;
}

void checkAligned(const void* pointer, std::size_t alignment, const char* name)
{
    if (reinterpret_cast<std::uintptr_t>(pointer) % alignment != 0)
        fail(OXRT_ERROR_INVALID_VALUE, "%s is not aligned to %zu bytes", name, alignment);
}

void setLastErrorMessage(const char* text) noexcept
{
    const std::size_t length = std::min(std::strlen(text), sizeof lastMessage - 1);
    std::memcpy(lastMessage, text, length);
    lastMessage[length] = '\0';
}

} // namespace oxrt

const char* oxrtGetErrorName(OxrtResult result)
{
    const oxrt::ResultName* entry = oxrt::findName(result);
    return entry ? entry->name : "Unrecognized OxrtResult code";
}

const char* oxrtGetErrorString(OxrtResult result)
{
    const oxrt::ResultName* entry = oxrt::findName(result);
    return entry ? entry->text : "Unrecognized OxrtResult code";
}

const char* oxrtGetLastErrorMessage(void)
{
    return oxrt::lastMessage;
}

const char* oxrtGetVersion(void)
{
    return OXRT_VERSION;
}
