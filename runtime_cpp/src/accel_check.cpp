// See accel_check.h.
#include "accel_check.h"

#include "error.h"
#include "geometry.h"
#include "motion.h"
#include "oxrt/embree.h"

#include <algorithm>
#include <cstdint>

namespace oxrt {

namespace {

constexpr std::uint32_t knownBuildFlags = OXRT_BUILD_FLAG_ALLOW_UPDATE | OXRT_BUILD_FLAG_ALLOW_COMPACTION |
                                          OXRT_BUILD_FLAG_PREFER_FAST_TRACE | OXRT_BUILD_FLAG_PREFER_FAST_BUILD |
                                          OXRT_BUILD_FLAG_ALLOW_RANDOM_VERTEX_ACCESS | OXRT_BUILD_FLAG_ALLOW_RANDOM_INSTANCE_ACCESS |
                                          OXRT_BUILD_FLAG_ALLOW_OPACITY_MICROMAP_UPDATE |
                                          OXRT_BUILD_FLAG_ALLOW_DISABLE_OPACITY_MICROMAPS | OXRT_BUILD_FLAG_NOT_ROBUST;
constexpr std::uint64_t maxPrimitivesPerGas = std::uint64_t(1) << 29;
constexpr std::uint64_t maxRecordsPerGas = std::uint64_t(1) << 24;

} // namespace

void checkBuildOptions(const OxrtAccelBuildOptions& options)
{
    if (options.buildFlags & ~knownBuildFlags)
        fail(OXRT_ERROR_INVALID_VALUE, "buildFlags 0x%x has unknown bits 0x%x; combine BuildFlags", options.buildFlags,
             options.buildFlags & ~knownBuildFlags);
    constexpr std::uint32_t both = OXRT_BUILD_FLAG_PREFER_FAST_TRACE | OXRT_BUILD_FLAG_PREFER_FAST_BUILD;
    if ((options.buildFlags & both) == both)
        fail(OXRT_ERROR_INVALID_VALUE, "buildFlags holds PREFER_FAST_TRACE and PREFER_FAST_BUILD; choose one");
    checkMotion(options.motion);
}

namespace {

// Motion holds for all inputs of a GAS, so each of them gives every key. First of all, since the number of keys says how much is read.
void checkKeys(const OxrtBuildInput& input, unsigned number, const OxrtMotionOptions& motion)
{
    const unsigned keys = std::max(1u, input.numKeys);
    if (keys != motion.numKeys)
        fail(OXRT_ERROR_INVALID_VALUE, "input %u has %u motion keys but the motion options say %u; give one array for each key", number, keys,
             motion.numKeys);
    if (keys > RTC_MAX_TIME_STEP_COUNT)
        fail(OXRT_ERROR_NOT_SUPPORTED, "input %u has %u motion keys; Embree takes at most %d for geometry, move it by a transform instead",
             number, keys, RTC_MAX_TIME_STEP_COUNT);
}

} // namespace

void checkBuildInputs(const Context& context, std::span<const OxrtBuildInput> inputs, const OxrtMotionOptions& motion)
{
    if (inputs.empty()) fail(OXRT_ERROR_INVALID_VALUE, "the list of build inputs is empty; give at least one");
    if (!inputs.data()) fail(OXRT_ERROR_INVALID_VALUE, "the build inputs are NULL but there are %zu", inputs.size());
    std::uint64_t primitives = 0;
    std::uint64_t records = 0;
    for (unsigned i = 0; i < inputs.size(); ++i) {
        if (inputs[i].type != inputs[0].type)
            fail(OXRT_ERROR_INVALID_VALUE, "input %u is of type 0x%x but input 0 of type 0x%x; make one accel per type and instance them",
                 i, inputs[i].type, inputs[0].type);
        if (inputs[i].type == OXRT_BUILD_INPUT_INSTANCES) continue;
        if (inputs[i].type == OXRT_BUILD_INPUT_CURVES && inputs[i].curveType != inputs[0].curveType)
            fail(OXRT_ERROR_INVALID_VALUE, "input %u has curve type 0x%x but input 0 has 0x%x; make one accel per type and instance them", i,
                 inputs[i].curveType, inputs[0].curveType);
        checkKeys(inputs[i], i, motion);
        Geometry::check(context, inputs[i], i);
        primitives += inputs[i].numPrimitives;
        records += inputs[i].numSbtRecords;
    }
    if (primitives > maxPrimitivesPerGas)
        fail(OXRT_ERROR_INVALID_VALUE, "the inputs hold %llu primitives; a GAS holds at most 2^29",
             static_cast<unsigned long long>(primitives));
    if (records > maxRecordsPerGas)
        fail(OXRT_ERROR_INVALID_VALUE, "the inputs need %llu SBT records; a GAS has at most 2^24",
             static_cast<unsigned long long>(records));
    if (inputs[0].type == OXRT_BUILD_INPUT_INSTANCES && inputs.size() != 1)
        fail(OXRT_ERROR_INVALID_VALUE, "%zu inputs of instances; an IAS has exactly one, put all instances into it", inputs.size());
}

} // namespace oxrt
