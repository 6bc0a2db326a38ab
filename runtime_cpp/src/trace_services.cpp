// See trace_services.h. Prints follow Python: what print() writes in the interpreter appears here in the same form.
#include "trace_services.h"

#include "launch.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <mutex>
#include <string>
#include <string_view>

namespace oxrt {

namespace {

// Python's repr: the fewest digits that give the same value, positional for exponents from -4 to 15.
template <class Float>
void appendFloat(std::string& line, Float value)
{
    if (!std::isfinite(value)) {
        line += std::isnan(value) ? "nan" : value < 0 ? "-inf" : "inf";
        return;
    }
    const Float magnitude = std::fabs(value);
    const bool positional = magnitude == 0 || (magnitude >= Float(1e-4) && magnitude < Float(1e16));
    char text[64];
    const auto format = positional ? std::chars_format::fixed : std::chars_format::scientific;
    const char* end = std::to_chars(text, text + sizeof text, value, format).ptr;
    const std::string_view digits(text, static_cast<std::size_t>(end - text));
    line += digits;
    if (positional && digits.find('.') == digits.npos) line += ".0";
}

void appendValue(std::string& line, const OxrtPrintItem& item, std::uint32_t i)
{
    switch (item.type) {
    case OXRT_PRINT_BOOL: line += static_cast<const std::uint8_t*>(item.values)[i] ? "True" : "False"; break;
    case OXRT_PRINT_INT: line += std::to_string(static_cast<const std::int64_t*>(item.values)[i]); break;
    case OXRT_PRINT_UINT: line += std::to_string(static_cast<const std::uint64_t*>(item.values)[i]); break;
    case OXRT_PRINT_FLOAT32: appendFloat(line, static_cast<const float*>(item.values)[i]); break;
    case OXRT_PRINT_FLOAT64: appendFloat(line, static_cast<const double*>(item.values)[i]); break;
    default: line += '?'; break;
    }
}

void appendItem(std::string& line, const OxrtPrintItem& item)
{
    if (item.type == OXRT_PRINT_STRING) {
        line += static_cast<const char*>(item.values);
        return;
    }
    if (item.count != 1) line += '(';
    for (std::uint32_t i = 0; i < item.count; ++i) {
        if (i != 0) line += ", ";
        appendValue(line, item, i);
    }
    if (item.count != 1) line += ')';
}

void print(OxrtThread*, const OxrtPrintItem* items, std::uint32_t count, const char* separator, const char* end)
{
    static std::mutex mutex;
    try {
        std::string line;
        for (std::uint32_t i = 0; i < count; ++i) {
            if (i != 0) line += separator ? separator : " ";
            appendItem(line, items[i]);
        }
        line += end ? end : "\n";
        const std::lock_guard lock(mutex);
        std::fwrite(line.data(), 1, line.size(), stdout);
        std::fflush(stdout);
    } catch (const std::exception&) {
        // A line that memory cannot hold is dropped: kernels know no exceptions.
    }
}

void fault(OxrtThread* thread, std::int32_t code, const char* path, std::uint32_t line, const char* message, const double* values,
           std::uint32_t valueCount)
{
    static_cast<Launch*>(thread->runtime)->recordFault(*thread, code, path, line, message, values, valueCount);
}

} // namespace

OxrtServices traceServices(const EmbreeLibrary& embree)
{
    OxrtServices services = {};
    services.intersect1 = reinterpret_cast<decltype(services.intersect1)>(embree.rtcIntersect1);
    services.occluded1 = reinterpret_cast<decltype(services.occluded1)>(embree.rtcOccluded1);
    services.intersect8 = reinterpret_cast<decltype(services.intersect8)>(embree.rtcIntersect8);
    services.occluded8 = reinterpret_cast<decltype(services.occluded8)>(embree.rtcOccluded8);
    services.intersect16 = reinterpret_cast<decltype(services.intersect16)>(embree.rtcIntersect16);
    services.occluded16 = reinterpret_cast<decltype(services.occluded16)>(embree.rtcOccluded16);
    services.fault = fault;
    services.print = print;
    return services;
}

} // namespace oxrt
