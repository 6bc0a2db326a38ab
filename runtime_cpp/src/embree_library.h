// Finds Embree at run time. The process shall hold one Embree only, so a copy that is already loaded (the embreex wheel's, say) wins.
#pragma once

#include "oxrt/embree.h"

#include <string>

namespace oxrt {

#define OXRT_EMBREE_FUNCTIONS(USE)                                                                                                         \
    USE(rtcNewDevice)                                                                                                                      \
    USE(rtcReleaseDevice)                                                                                                                  \
    USE(rtcGetDeviceProperty)                                                                                                              \
    USE(rtcGetDeviceError)                                                                                                                 \
    USE(rtcSetDeviceErrorFunction)                                                                                                         \
    USE(rtcSetDeviceMemoryMonitorFunction)                                                                                                 \
    USE(rtcNewScene)                                                                                                                       \
    USE(rtcReleaseScene)                                                                                                                   \
    USE(rtcSetSceneFlags)                                                                                                                  \
    USE(rtcSetSceneBuildQuality)                                                                                                           \
    USE(rtcCommitScene)                                                                                                                    \
    USE(rtcJoinCommitScene)                                                                                                                \
    USE(rtcGetSceneBounds)                                                                                                                 \
    USE(rtcAttachGeometryByID)                                                                                                             \
    USE(rtcGetGeometry)                                                                                                                    \
    USE(rtcNewGeometry)                                                                                                                    \
    USE(rtcReleaseGeometry)                                                                                                                \
    USE(rtcCommitGeometry)                                                                                                                 \
    USE(rtcEnableGeometry)                                                                                                                 \
    USE(rtcDisableGeometry)                                                                                                                \
    USE(rtcSetGeometryBuildQuality)                                                                                                        \
    USE(rtcSetGeometryTimeStepCount)                                                                                                       \
    USE(rtcSetGeometryMask)                                                                                                                \
    USE(rtcSetGeometryUserData)                                                                                                            \
    USE(rtcSetSharedGeometryBuffer)                                                                                                        \
    USE(rtcUpdateGeometryBuffer)                                                                                                           \
    USE(rtcSetGeometryEnableFilterFunctionFromArguments)                                                                                   \
    USE(rtcSetGeometryIntersectFilterFunction)                                                                                             \
    USE(rtcSetGeometryOccludedFilterFunction)                                                                                              \
    USE(rtcSetGeometryUserPrimitiveCount)                                                                                                  \
    USE(rtcSetGeometryBoundsFunction)                                                                                                      \
    USE(rtcSetGeometryIntersectFunction)                                                                                                   \
    USE(rtcSetGeometryOccludedFunction)                                                                                                    \
    USE(rtcSetGeometryInstancedScene)                                                                                                      \
    USE(rtcSetGeometryTransform)                                                                                                           \
    USE(rtcIntersect1)                                                                                                                     \
    USE(rtcIntersect8)                                                                                                                     \
    USE(rtcIntersect16)                                                                                                                    \
    USE(rtcOccluded1)                                                                                                                      \
    USE(rtcOccluded8)                                                                                                                      \
    USE(rtcOccluded16)

struct EmbreeLibrary {
#define OXRT_EMBREE_MEMBER(name) decltype(&::name) name = nullptr;
    OXRT_EMBREE_FUNCTIONS(OXRT_EMBREE_MEMBER)
#undef OXRT_EMBREE_MEMBER

    std::string path;
    // Set when the caller named another file than the one that was loaded already.
    std::string ignoredPath;
    unsigned version = 0; // 40400 for 4.4.0
    bool backfaceCulling = false;
};

// Loads the library once per process; later calls get the same one. Throws Failure with the remedy. `embreePath` may be null.
const EmbreeLibrary& loadEmbree(const char* embreePath);

} // namespace oxrt
