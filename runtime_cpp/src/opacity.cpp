// See opacity.h.
#include "opacity.h"

#include "context.h"
#include "error.h"
#include "objects.h"

#include <cstdint>
#include <cstring>
#include <map>

namespace oxrt {

namespace {

constexpr std::uint32_t knownArrayFlags = 3;
constexpr std::int32_t lastPredefined = -4;

// Levels and formats with how many there are of each.
using Histogram = std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint64_t>;

std::size_t bytesOf(std::uint32_t level, std::uint32_t format)
{
    const std::size_t bits = (std::size_t(1) << (2 * level)) * format;
    return bits < 8 ? 1 : bits / 8;
}

Histogram histogramOf(const OxrtOpacityMicromapCount* counts, std::uint32_t size)
{
    Histogram histogram;
    for (std::uint32_t i = 0; i < size; ++i)
        if (counts[i].count != 0) histogram[{counts[i].subdivisionLevel, counts[i].format}] += counts[i].count;
    return histogram;
}

void checkEqual(const Histogram& given, const Histogram& found, const char* what)
{
    Histogram all = found;
    all.insert(given.begin(), given.end());
    for (const auto& [key, any] : all) {
        const auto inGiven = given.find(key);
        const auto inFound = found.find(key);
        const std::uint64_t told = inGiven == given.end() ? 0 : inGiven->second;
        const std::uint64_t there = inFound == found.end() ? 0 : inFound->second;
        if (told != there)
            fail(OXRT_ERROR_INVALID_VALUE, "%s: %llu micromaps of level %u and format %u are told, but there are %llu", what,
                 static_cast<unsigned long long>(told), key.first, key.second, static_cast<unsigned long long>(there));
    }
}

void checkDesc(const OxrtOpacityMicromapDesc& desc, std::uint32_t number, std::size_t dataSize)
{
    if (desc.subdivisionLevel > OXRT_OPACITY_MICROMAP_MAX_LEVEL)
        fail(OXRT_ERROR_INVALID_VALUE, "micromap %u: subdivision level %u; give 0 to 12", number, desc.subdivisionLevel);
    if (desc.format != OXRT_OPACITY_MICROMAP_FORMAT_2_STATE && desc.format != OXRT_OPACITY_MICROMAP_FORMAT_4_STATE)
        fail(OXRT_ERROR_INVALID_VALUE, "micromap %u: format %u; give OpacityMicromapFormat.FORMAT_2_STATE or FORMAT_4_STATE", number,
             desc.format);
    const std::size_t bytes = bytesOf(desc.subdivisionLevel, desc.format);
    if (desc.byteOffset > dataSize || dataSize - desc.byteOffset < bytes)
        fail(OXRT_ERROR_INVALID_VALUE, "micromap %u: its %zu bytes from offset %u on do not fit into the %zu bytes of data", number, bytes,
             desc.byteOffset, dataSize);
}

OxrtMicromapView wholeTriangle(std::int32_t index)
{
    OxrtMicromapView view = {};
    view.state = static_cast<std::uint8_t>(-1 - index);
    return view;
}

// The micromap of triangle `i`; `maps` may be null where the index is predefined.
OxrtMicromapView micromapOf(const OxrtOpacityMicromapInput& input, const MicromapArray* array, std::uint64_t i)
{
    const bool isIndexed = input.indexingMode == OXRT_OPACITY_MICROMAP_INDEXING_INDEXED;
    if (isIndexed && input.indices[i] < 0) return wholeTriangle(input.indices[i]);
    const std::uint64_t index = isIndexed ? static_cast<std::uint64_t>(input.indices[i]) : i;
    return array->maps()[index + input.indexOffset];
}

bool equal(const OxrtMicromapView& a, const OxrtMicromapView& b)
{
    return a.states == b.states && a.level == b.level && a.isFourState == b.isFourState && a.state == b.state;
}

void checkUsage(const OxrtOpacityMicromapInput& input, const MicromapArray* array, std::uint64_t triangles, unsigned number)
{
    Histogram found;
    for (std::uint64_t i = 0; i < triangles; ++i) {
        const OxrtMicromapView view = micromapOf(input, array, i);
        if (view.states) ++found[{view.level, view.isFourState ? OXRT_OPACITY_MICROMAP_FORMAT_4_STATE : OXRT_OPACITY_MICROMAP_FORMAT_2_STATE}];
    }
    checkEqual(histogramOf(input.usageCounts, input.numUsageCounts), found, formatText("input %u: usage counts", number).c_str());
}

} // namespace

MicromapArray::MicromapArray(std::shared_ptr<Context> owner, const OxrtOpacityMicromapArrayOptions& options)
    : context(std::move(owner)), states(options.data, options.dataSize)
{
    if (options.flags & ~knownArrayFlags || options.flags == knownArrayFlags)
        fail(OXRT_ERROR_INVALID_VALUE, "opacity micromap array: flags 0x%x; give one of OpacityMicromapFlags", options.flags);
    Histogram found;
    for (std::uint32_t i = 0; i < options.numDescs; ++i) {
        const OxrtOpacityMicromapDesc& desc = options.descs[i];
        checkDesc(desc, i, options.dataSize);
        ++found[{desc.subdivisionLevel, desc.format}];
        OxrtMicromapView view = {};
        view.states = states.data() + desc.byteOffset;
        view.level = static_cast<std::uint8_t>(desc.subdivisionLevel);
        view.isFourState = desc.format == OXRT_OPACITY_MICROMAP_FORMAT_4_STATE;
        views.push_back(view);
    }
    checkEqual(histogramOf(options.histogram, options.numHistogramEntries), found, "opacity micromap array: histogram");
}

void checkMicromaps(const OxrtOpacityMicromapInput& input, std::uint64_t triangles, unsigned number)
{
    const bool isIndexed = input.indexingMode == OXRT_OPACITY_MICROMAP_INDEXING_INDEXED;
    if (!isIndexed && input.indexingMode != OXRT_OPACITY_MICROMAP_INDEXING_LINEAR)
        fail(OXRT_ERROR_INVALID_VALUE, "input %u: micromap indexing mode %u; give LINEAR or INDEXED", number, input.indexingMode);
    if (isIndexed != (input.indices != nullptr) && triangles != 0)
        fail(OXRT_ERROR_INVALID_VALUE, "input %u: micromap indices are %s", number,
             isIndexed ? "NULL; INDEXED needs one per triangle" : "given, but the mode is LINEAR");
    std::shared_ptr<MicromapArray> array;
    if (input.array) array = find(input.array);
    const std::uint64_t available = array ? array->maps().size() : 0;
    for (std::uint64_t i = 0; i < triangles; ++i) {
        if (isIndexed && input.indices[i] < 0) {
            if (input.indices[i] < lastPredefined)
                fail(OXRT_ERROR_INVALID_VALUE, "input %u: micromap index %d of triangle %llu; predefined ones are -1 to -4", number,
                     input.indices[i], static_cast<unsigned long long>(i));
            continue;
        }
        const std::uint64_t index = (isIndexed ? static_cast<std::uint64_t>(input.indices[i]) : i) + input.indexOffset;
        if (index >= available)
            fail(OXRT_ERROR_INVALID_VALUE, "input %u: triangle %llu has micromap %llu, but the array holds %llu", number,
                 static_cast<unsigned long long>(i), static_cast<unsigned long long>(index), static_cast<unsigned long long>(available));
    }
    if (input.usageCounts) checkUsage(input, array.get(), triangles, number);
}

void Micromaps::copy(const OxrtBuildInput& input)
{
    const OxrtOpacityMicromapInput* given = input.opacityMicromap;
    if (!given) {
        views = {};
        array = nullptr;
        return;
    }
    array = given->array ? find(given->array) : nullptr;
    if (views.size() != input.numPrimitives) views = Array<OxrtMicromapView>(input.numPrimitives);
    for (std::uint64_t i = 0; i < input.numPrimitives; ++i) views[i] = micromapOf(*given, array.get(), i);
}

bool Micromaps::isSame(const OxrtBuildInput& input) const
{
    const OxrtOpacityMicromapInput* given = input.opacityMicromap;
    if (!given || views.size() == 0) return !given && views.size() == 0;
    const std::shared_ptr<MicromapArray> other = given->array ? find(given->array) : nullptr;
    for (std::size_t i = 0; i < views.size(); ++i)
        if (!equal(views[i], micromapOf(*given, other.get(), i))) return false;
    return true;
}

} // namespace oxrt

using namespace oxrt;

OxrtResult oxrtOpacityMicromapArrayBuild(OxrtContext context, const OxrtOpacityMicromapArrayOptions* options,
                                         OxrtOpacityMicromapArray* array)
{
    return guard([&] {
        const auto owner = find(context);
        owner->attempt("MICROMAP", [&] {
            if (!options || !array) fail(OXRT_ERROR_INVALID_VALUE, "the %s is NULL", options ? "result pointer `array`" : "options");
            *array = nullptr;
            if ((!options->descs && options->numDescs != 0) || (!options->histogram && options->numHistogramEntries != 0) ||
                (!options->data && options->dataSize != 0))
                fail(OXRT_ERROR_INVALID_VALUE, "opacity micromap array: data, descs or histogram is NULL though its size is not 0");
            *array = publish(std::make_shared<MicromapArray>(owner, *options));
        });
    });
}

OxrtResult oxrtOpacityMicromapArrayDestroy(OxrtOpacityMicromapArray array)
{
    return guard([&] { withdraw(array); });
}
