// See opacity.h.
#include "opacity.h"

#include "context.h"
#include "error.h"
#include "objects.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <map>
#include <unordered_map>

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

// Micromaps of level 0 for the predefined indices -1 to -4.
constexpr std::uint32_t wholeStates[] = {OXRT_OPACITY_TRANSPARENT, OXRT_OPACITY_OPAQUE, OXRT_OPACITY_UNKNOWN_TRANSPARENT,
                                         OXRT_OPACITY_UNKNOWN_OPAQUE};
constexpr std::uint32_t wholeCount = std::size(wholeStates);

std::uint32_t shapeOf(std::uint32_t level, std::uint32_t format)
{
    return std::bit_cast<std::uint32_t>(static_cast<float>(1u << level)) | (format == OXRT_OPACITY_MICROMAP_FORMAT_4_STATE);
}
std::uint32_t levelOf(std::uint32_t shape)
{
    return static_cast<std::uint32_t>(std::countr_zero(static_cast<std::uint32_t>(std::bit_cast<float>(shape & ~1u))));
}
std::uint32_t formatOf(std::uint32_t shape)
{
    return shape & 1 ? OXRT_OPACITY_MICROMAP_FORMAT_4_STATE : OXRT_OPACITY_MICROMAP_FORMAT_2_STATE;
}

bool isPredefined(const OxrtOpacityMicromapInput& input, std::uint64_t i)
{
    return input.indexingMode == OXRT_OPACITY_MICROMAP_INDEXING_INDEXED && input.indices[i] < 0;
}

// The micromap of triangle `i`; `array` may be null where the index is predefined.
OxrtMicromapView micromapOf(const OxrtOpacityMicromapInput& input, const MicromapArray* array, std::uint64_t i)
{
    if (isPredefined(input, i))
        return {static_cast<std::uint32_t>(-1 - input.indices[i]), shapeOf(0, OXRT_OPACITY_MICROMAP_FORMAT_4_STATE)};
    const bool isIndexed = input.indexingMode == OXRT_OPACITY_MICROMAP_INDEXING_INDEXED;
    const std::uint64_t index = isIndexed ? static_cast<std::uint64_t>(input.indices[i]) : i;
    return array->maps()[index + input.indexOffset];
}

void checkUsage(const OxrtOpacityMicromapInput& input, const MicromapArray* array, std::uint64_t triangles, unsigned number)
{
    Histogram found;
    for (std::uint64_t i = 0; i < triangles; ++i) {
        if (isPredefined(input, i)) continue;
        const std::uint32_t shape = micromapOf(input, array, i).shape;
        ++found[{levelOf(shape), formatOf(shape)}];
    }
    checkEqual(histogramOf(input.usageCounts, input.numUsageCounts), found, formatText("input %u: usage counts", number).c_str());
}

// Bit i of the result: the parity of the bits i and above.
std::uint32_t parityAbove(std::uint32_t x)
{
    x ^= x >> 1;
    x ^= x >> 2;
    x ^= x >> 4;
    return x ^ x >> 8;
}

// The low 12 bits, each followed by a zero.
std::uint32_t spreadBits(std::uint32_t x)
{
    x = (x | x << 8) & 0x00FF00FF;
    x = (x | x << 4) & 0x0F0F0F0F;
    x = (x | x << 2) & 0x33333333;
    return (x | x << 1) & 0x55555555;
}

// The place on the micromap curve of a micro-triangle in square (u, v): the inverse of what the OptiX header micromap/optix_micromap_impl.h
// does from index to corners.
std::uint32_t curveIndex(std::uint32_t u, std::uint32_t v, bool isUpper, std::uint32_t level)
{
    const std::uint32_t last = (1u << level) - 1;
    const std::uint32_t w = (~(u + v) - isUpper) & last;
    const std::uint32_t b0 = ~(u ^ w) & last;
    const std::uint32_t t = (u ^ v) & b0;
    const std::uint32_t b1 = (((parityAbove(t) ^ u) & ~b0) | t) & last;
    return spreadBits(b0) | spreadBits(b1) << 1;
}

// The places on the curve of all micro-triangles, row after row.
std::vector<std::uint32_t> curveOf(std::uint32_t level)
{
    const std::uint32_t side = 1u << level;
    std::vector<std::uint32_t> curve;
    curve.reserve(std::size_t(side) * side);
    for (std::uint32_t v = 0; v < side; ++v)
        for (std::uint32_t u = 0; u + v < side; ++u) {
            curve.push_back(curveIndex(u, v, false, level));
            if (u + v + 1 < side) curve.push_back(curveIndex(u, v, true, level));
        }
    return curve;
}

// From the order of the curve to rows; BITS for each state.
template <unsigned BITS>
void copyStates(const std::vector<std::uint32_t>& curve, const std::uint8_t* from, std::uint32_t* to)
{
    constexpr std::size_t inWord = 32 / BITS;
    constexpr std::uint32_t mask = (1u << BITS) - 1;
    for (std::size_t begin = 0; begin < curve.size(); begin += inWord) {
        const std::size_t count = std::min(inWord, curve.size() - begin);
        std::uint32_t word = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t bit = curve[begin + i] * BITS;
            word |= (static_cast<std::uint32_t>(from[bit / 8]) >> bit % 8 & mask) << i * BITS;
        }
        *to++ = word;
    }
}

std::size_t wordsOf(std::uint32_t level, std::uint32_t format)
{
    return (bytesOf(level, format) + 3) / 4;
}

// Where each micromap goes. Several may be the same bytes.
std::size_t placeMaps(const OxrtOpacityMicromapArrayOptions& options, std::vector<OxrtMicromapView>& views)
{
    std::size_t end = wholeCount;
    std::unordered_map<std::size_t, std::vector<OxrtMicromapView>> known; // by the place of the bytes
    for (std::uint32_t i = 0; i < options.numDescs; ++i) {
        const OxrtOpacityMicromapDesc& desc = options.descs[i];
        const std::uint32_t shape = shapeOf(desc.subdivisionLevel, desc.format);
        std::vector<OxrtMicromapView>& there = known[desc.byteOffset];
        auto same = std::find_if(there.begin(), there.end(), [&](const OxrtMicromapView& view) { return view.shape == shape; });
        if (same == there.end()) {
            same = there.insert(there.end(), {static_cast<std::uint32_t>(end), shape});
            end += wordsOf(desc.subdivisionLevel, desc.format);
        }
        views.push_back(*same);
    }
    constexpr std::size_t limit = std::size_t(1) << 31; // kernels address words by signed numbers
    if (end > limit)
        fail(OXRT_ERROR_INVALID_VALUE, "opacity micromap array: its states take %zu bytes; one array holds less than 8 GiB", 4 * end);
    return end;
}

} // namespace

MicromapArray::MicromapArray(std::shared_ptr<Context> owner, const OxrtOpacityMicromapArrayOptions& options) : context(std::move(owner))
{
    if (options.flags & ~knownArrayFlags || options.flags == knownArrayFlags)
        fail(OXRT_ERROR_INVALID_VALUE, "opacity micromap array: flags 0x%x; give one of OpacityMicromapFlags", options.flags);
    checkAligned(options.descs, alignof(OxrtOpacityMicromapDesc), "opacity micromap array: descs");
    checkAligned(options.histogram, alignof(OxrtOpacityMicromapCount), "opacity micromap array: histogram");
    Histogram found;
    for (std::uint32_t i = 0; i < options.numDescs; ++i) {
        checkDesc(options.descs[i], i, options.dataSize);
        ++found[{options.descs[i].subdivisionLevel, options.descs[i].format}];
    }
    checkEqual(histogramOf(options.histogram, options.numHistogramEntries), found, "opacity micromap array: histogram");

    words = Array<std::uint32_t>(placeMaps(options, views));
    std::copy_n(wholeStates, wholeCount, words.data());
    std::map<std::uint32_t, std::vector<std::uint32_t>> curves; // by level
    std::uint32_t end = wholeCount;
    for (std::uint32_t i = 0; i < options.numDescs; ++i) {
        if (views[i].firstWord < end) continue; // copied before
        const OxrtOpacityMicromapDesc& desc = options.descs[i];
        std::vector<std::uint32_t>& curve = curves[desc.subdivisionLevel];
        if (curve.empty()) curve = curveOf(desc.subdivisionLevel);
        const auto copy = desc.format == OXRT_OPACITY_MICROMAP_FORMAT_4_STATE ? copyStates<2> : copyStates<1>;
        copy(curve, options.data + desc.byteOffset, words.data() + end);
        end += static_cast<std::uint32_t>(wordsOf(desc.subdivisionLevel, desc.format));
    }
}

void checkMicromaps(const OxrtOpacityMicromapInput& input, const Context& context, std::uint64_t triangles, unsigned number)
{
    checkAligned(input.indices, alignof(std::int32_t), formatText("input %u: micromap indices", number).c_str());
    checkAligned(input.usageCounts, alignof(OxrtOpacityMicromapCount), formatText("input %u: micromap usageCounts", number).c_str());
    const bool isIndexed = input.indexingMode == OXRT_OPACITY_MICROMAP_INDEXING_INDEXED;
    if (!isIndexed && input.indexingMode != OXRT_OPACITY_MICROMAP_INDEXING_LINEAR)
        fail(OXRT_ERROR_INVALID_VALUE, "input %u: micromap indexing mode %u; give LINEAR or INDEXED", number, input.indexingMode);
    if (isIndexed != (input.indices != nullptr) && triangles != 0)
        fail(OXRT_ERROR_INVALID_VALUE, "input %u: micromap indices are %s", number,
             isIndexed ? "NULL; INDEXED needs one per triangle" : "given, but the mode is LINEAR");
    std::shared_ptr<MicromapArray> array;
    if (input.array) array = find(input.array);
    if (array && array->context.get() != &context)
        fail(OXRT_ERROR_INVALID_VALUE, "input %u: the opacity micromap array is of another context; build one in this context", number);
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
    for (std::size_t i = 0; i < views.size(); ++i) {
        const OxrtMicromapView map = micromapOf(*given, other.get(), i);
        const bool isOfArray = map.firstWord >= wholeCount;
        if (map.firstWord != views[i].firstWord || map.shape != views[i].shape || (isOfArray && other != array)) return false;
    }
    return true;
}

void Micromaps::describe(OxrtGeometry& view) const
{
    view.opacityMicromaps = views.size() == 0 ? nullptr : views.data();
    view.micromapStates = array ? array->states() : wholeStates;
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
