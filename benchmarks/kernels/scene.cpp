// Builds the Embree scenes of the hand-written kernels: one device, triangle meshes, and the spheres and floor of Whitted's picture.
#include <oxrt/embree.h>
#include <string.h>

namespace {

void attach(RTCScene scene, RTCGeometry geometry) {
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_MEDIUM);
    rtcSetGeometryMask(geometry, 0xFFFFFFFFu);
    rtcSetGeometryEnableFilterFunctionFromArguments(geometry, true);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
}


void boxBounds(const RTCBoundsFunctionArguments* arguments) {
    const float* box = static_cast<const float*>(arguments->geometryUserPtr) + 6 * size_t(arguments->primID);
    RTCBounds* bounds = arguments->bounds_o;
    bounds->lower_x = box[0];
    bounds->lower_y = box[1];
    bounds->lower_z = box[2];
    bounds->upper_x = box[3];
    bounds->upper_y = box[4];
    bounds->upper_z = box[5];
}

}  // namespace

#pragma GCC visibility push(default)
extern "C" {

void* bench_device_create(const char* configuration) { return rtcNewDevice(configuration); }
void bench_device_release(void* device) { rtcReleaseDevice(static_cast<RTCDevice>(device)); }

void* bench_scene_create(void* device) {
    RTCScene scene = rtcNewScene(static_cast<RTCDevice>(device));
    rtcSetSceneFlags(scene, RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS));
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    return scene;
}

// Vertices are copied, since Embree reads 4 bytes past the last one.
void bench_scene_add_triangles(void* device, void* scene, const float* vertices, size_t vertexCount, const unsigned* indices,
                               size_t triangleCount) {
    RTCGeometry geometry = rtcNewGeometry(static_cast<RTCDevice>(device), RTC_GEOMETRY_TYPE_TRIANGLE);
    memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, vertexCount), vertices, vertexCount * 12);
    memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, triangleCount), indices, triangleCount * 12);
    attach(static_cast<RTCScene>(scene), geometry);
}

// Round linear curves (`firsts`: the first point of each segment), or spheres where there are none. Points are x, y, z, radius.
void bench_scene_add_shapes(void* device, void* scene, const float* points, size_t pointCount, const unsigned* firsts, size_t count) {
    const RTCGeometryType type = firsts ? RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE : RTC_GEOMETRY_TYPE_SPHERE_POINT;
    RTCGeometry geometry = rtcNewGeometry(static_cast<RTCDevice>(device), type);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, points, 0, 16, pointCount);
    if (firsts) {
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, firsts, 0, 4, count);
        unsigned char* flags = static_cast<unsigned char*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_FLAGS, 0, RTC_FORMAT_UCHAR, 1, count));
        for (size_t i = 0; i < count; ++i) {
            const bool left = i > 0 && firsts[i - 1] + 1 == firsts[i], right = i + 1 < count && firsts[i] + 1 == firsts[i + 1];
            flags[i] = (left ? RTC_CURVE_FLAG_NEIGHBOR_LEFT : 0) | (right ? RTC_CURVE_FLAG_NEIGHBOR_RIGHT : 0);
        }
    }
    attach(static_cast<RTCScene>(scene), geometry);
}

void bench_scene_add_custom(void* device, void* scene, const float* boxes, unsigned count) {
    RTCGeometry geometry = rtcNewGeometry(static_cast<RTCDevice>(device), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, count);
    rtcSetGeometryUserData(geometry, const_cast<float*>(boxes));
    rtcSetGeometryBoundsFunction(geometry, boxBounds, nullptr);
    attach(static_cast<RTCScene>(scene), geometry);
}

// A device of one thread joins its builds: otherwise, with a second device in the process, TBB leaves a worker that spins for ever.
void bench_scene_commit(void* scene, int join) {
    if (join)
        rtcJoinCommitScene(static_cast<RTCScene>(scene));
    else
        rtcCommitScene(static_cast<RTCScene>(scene));
}
void bench_scene_release(void* scene) { rtcReleaseScene(static_cast<RTCScene>(scene)); }

}
#pragma GCC visibility pop
