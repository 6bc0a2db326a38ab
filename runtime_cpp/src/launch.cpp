// See launch.h.
#include "launch.h"

#include "context.h"
#include "cpu.h"
#include "stack.h"
#include "texture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <string_view>

namespace oxrt {

namespace {

// Big enough that grabbing is free, small enough that the last tiles end together; lanes are blocks of at most 4x4 or 16x1 indices.
constexpr std::uint32_t largestTile = 1024;
constexpr std::uint32_t smallestTile = 256;
constexpr std::uint64_t wantedTilesPerThread = 8;
constexpr std::uint64_t largestChunk = 16;

std::uint32_t divideUp(std::uint32_t value, std::uint32_t divisor)
{
    return (value + divisor - 1) / divisor;
}

std::uint32_t powerOfTwoUpTo(std::uint32_t value, std::uint32_t limit)
{
    std::uint32_t power = 1;
    while (power < value && power < limit) power *= 2;
    return power;
}

} // namespace

Launch::Launch(std::uint32_t paramsSize) : paramsCopy(paramsSize)
{}

void Launch::prepare(const Context& context, const OxrtLaunch& launch, const OxrtProgram& raygen, const void* params, std::size_t frames)
{
    frameBytes = frames;
    if (paramsCopy.size() != 0) std::memcpy(paramsCopy.data(), params, paramsCopy.size());
    view = launch;
    view.params = paramsCopy.data();
    view.traversables = context.traversables.data();
    view.traversableCount = context.traversables.size();
    const TextureSlots textures = textureSlots();
    view.textures = textures.slots;
    view.textureCount = textures.count;
    view.services = &context.services;
    view.cancel = &cancelWord;
    exceptionsTold = 0;
    view.exceptionsTold = &exceptionsTold;
    view.validation = context.validation;
    program = &raygen;
    threadCount = context.threads;

    std::atomic_ref(cancelWord).store(0);
    wasCancelled = false;
    faultReport = {};
    done = 0;
    total = std::uint64_t(view.width) * view.height * view.depth;
    chooseTiles(threadCount);
    nextTile = 0;
}

void Launch::chooseTiles(unsigned threads)
{
    const std::uint32_t size[3] = {view.width, view.height, view.depth};
    for (std::uint32_t area = largestTile; area >= smallestTile; area /= 4) {
        // Square where the launch is, else as long as it takes.
        const std::uint32_t side = area == largestTile ? 32 : 16;
        tileSize[0] = powerOfTwoUpTo(size[0], size[1] == 1 ? area : side);
        tileSize[1] = powerOfTwoUpTo(size[1], area / tileSize[0]);
        if (tileSize[0] * tileSize[1] < area) tileSize[0] = powerOfTwoUpTo(size[0], area / tileSize[1]);
        tileSize[2] = powerOfTwoUpTo(size[2], area / (tileSize[0] * tileSize[1]));
        tileCount = 1;
        for (int axis = 0; axis < 3; ++axis) {
            tilesAcross[axis] = divideUp(size[axis], tileSize[axis]);
            tileCount *= tilesAcross[axis];
        }
        if (tileCount >= wantedTilesPerThread * threads) return;
    }
}

std::uint64_t Launch::grab(std::uint64_t& end)
{
    std::uint64_t begin = nextTile.load(std::memory_order_relaxed);
    std::uint64_t chunk;
    do {
        if (begin >= tileCount) return end = tileCount;
        chunk = std::clamp<std::uint64_t>((tileCount - begin) / (4 * std::uint64_t(threadCount)), 1, largestChunk);
    } while (!nextTile.compare_exchange_weak(begin, begin + chunk, std::memory_order_relaxed));
    end = begin + chunk;
    return begin;
}

OxrtTile Launch::tileAt(std::uint64_t number) const
{
    const std::uint32_t size[3] = {view.width, view.height, view.depth};
    OxrtTile tile;
    for (int axis = 0; axis < 3; ++axis) {
        const auto place = static_cast<std::uint32_t>(number % tilesAcross[axis]);
        number /= tilesAcross[axis];
        tile.begin[axis] = place * tileSize[axis];
        tile.end[axis] = std::min(size[axis], tile.begin[axis] + tileSize[axis]);
    }
    return tile;
}

bool Launch::findStack(OxrtThread& thread)
{
    const char* limit = findStackLimit();
    if (!limit) return true;
    // A check in a program sees where its frame begins; the frame itself and those of what it calls lie below.
    thread.stackLimit = limit + 2 * frameBytes;
    if (static_cast<const char*>(__builtin_frame_address(0)) >= thread.stackLimit) return true;
    recordFault(thread, OXRT_FAULT_STACK_OVERFLOW, nullptr, 0, "the programs need more stack than this thread has", nullptr, 0);
    nextTile.store(tileCount, std::memory_order_relaxed);
    return false;
}

void Launch::run()
{
    const KernelFloatState floatState;
    OxrtThread thread = {};
    thread.launch = &view;
    thread.params = view.params;
    thread.runtime = this;
    if (!findStack(thread)) return;

    const auto cancelState = std::atomic_ref(cancelWord);
    std::uint64_t end;
    for (std::uint64_t tileNumber = grab(end); tileNumber < tileCount; tileNumber = grab(end)) {
        std::uint64_t indices = 0;
        for (; tileNumber < end; ++tileNumber) {
            if (cancelState.load(std::memory_order_relaxed) != 0) {
                nextTile.store(tileCount, std::memory_order_relaxed);
                return;
            }
            const OxrtTile tile = tileAt(tileNumber);
            program->run(&thread, &tile);
            indices += std::uint64_t(tile.end[0] - tile.begin[0]) * (tile.end[1] - tile.begin[1]) * (tile.end[2] - tile.begin[2]);
        }
        done.fetch_add(indices, std::memory_order_relaxed);
    }
}

void Launch::cancel()
{
    wasCancelled = true;
    std::atomic_ref(cancelWord).store(1);
}

namespace {

// Where a message has a place for a value; values without one follow the message.
constexpr char valuePlace = '\1';

// Indices with all their digits, other numbers as float32 needs them.
std::string numberText(double value)
{
    const bool isIndex = std::abs(value) < 0x1p53 && value == std::trunc(value);
    char text[32];
    std::snprintf(text, sizeof text, "%.*g", isIndex ? 16 : 9, value);
    return text;
}

void writeMessage(char* target, std::size_t size, std::string_view message, const double* values, std::uint32_t valueCount)
{
    std::string text;
    std::uint32_t used = 0;
    for (const char c : message) {
        if (c == valuePlace && used < valueCount)
            text += numberText(values[used++]);
        else
            text += c;
    }
    for (std::uint32_t i = used; i < valueCount; ++i)
        text += (i == used ? " (" : ", ") + numberText(values[i]) + (i + 1 == valueCount ? ")" : "");
    std::snprintf(target, size, "%s", text.c_str());
}

} // namespace

void Launch::recordFault(const OxrtThread& thread, std::int32_t code, const char* path, std::uint32_t line, const char* message,
                         const double* values, std::uint32_t valueCount)
{
    const std::lock_guard lock(faultMutex);
    if (faultReport.faultCode != OXRT_FAULT_NONE || code == OXRT_FAULT_NONE) return;
    faultReport.faultCode = code;
    std::copy_n(thread.index, 3, faultReport.index);
    faultReport.line = line;
    std::snprintf(faultReport.path, sizeof faultReport.path, "%s", path ? path : "");
    writeMessage(faultReport.message, sizeof faultReport.message, message ? message : "", values, valueCount);
    std::atomic_ref(cancelWord).store(1);
}

} // namespace oxrt
