// Search order: loaded already, the caller's path, OXRT_EMBREE, the system's names. Then version, functions, properties and the layout of
// hits are checked, because a wrong guess about any of them would corrupt memory later.
#include "embree_library.h"

#include "error.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <link.h>
#include <memory>
#include <mutex>
#include <sys/stat.h>
#include <vector>

namespace oxrt {

namespace {

constexpr const char* remedy = "install it with `pip install embreex` or set OXRT_EMBREE to the path of a libembree4.so.4";

int rememberEmbreePath(dl_phdr_info* info, std::size_t, void* data)
{
    const char* slash = std::strrchr(info->dlpi_name, '/');
    const char* file = slash ? slash + 1 : info->dlpi_name;
    if (std::strncmp(file, "libembree4", 10) != 0) return 0;
    *static_cast<std::string*>(data) = info->dlpi_name;
    return 1;
}

std::string findLoadedEmbree()
{
    std::string path;
    dl_iterate_phdr(rememberEmbreePath, &path);
    return path;
}

bool isSameFile(const char* first, const char* second)
{
    struct stat a, b;
    return stat(first, &a) == 0 && stat(second, &b) == 0 && a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

void* openLibrary(const char* embreePath, EmbreeLibrary& library)
{
    const std::string loaded = findLoadedEmbree();
    if (!loaded.empty()) {
        if (void* handle = dlopen(loaded.c_str(), RTLD_NOW | RTLD_NOLOAD)) {
            library.path = loaded;
            if (embreePath && !isSameFile(loaded.c_str(), embreePath)) library.ignoredPath = embreePath;
            return handle;
        }
    }

    std::vector<const char*> candidates;
    const char* environment = std::getenv("OXRT_EMBREE");
    if (embreePath && *embreePath)
        candidates = {embreePath};
    else if (environment && *environment)
        candidates = {environment};
    else
        candidates = {"libembree4.so.4", "libembree4.so"};

    std::string reasons;
    for (const char* candidate : candidates) {
        if (void* handle = dlopen(candidate, RTLD_NOW | RTLD_LOCAL)) return handle;
        const char* reason = dlerror();
        reasons += reasons.empty() ? "" : "; ";
        reasons += reason ? reason : candidate;
    }
    fail(OXRT_ERROR_LIBRARY_NOT_FOUND, "Embree 4 was not found (%s); %s", reasons.c_str(), remedy);
}

unsigned readVersion(void* handle, const char* name)
{
    const auto newDevice = reinterpret_cast<decltype(&::rtcNewDevice)>(dlsym(handle, "rtcNewDevice"));
    const auto releaseDevice = reinterpret_cast<decltype(&::rtcReleaseDevice)>(dlsym(handle, "rtcReleaseDevice"));
    const auto getProperty = reinterpret_cast<decltype(&::rtcGetDeviceProperty)>(dlsym(handle, "rtcGetDeviceProperty"));
    if (!newDevice || !releaseDevice || !getProperty) fail(OXRT_ERROR_LIBRARY_NOT_FOUND, "%s is not an Embree 4 library; %s", name, remedy);

    const RTCDevice device = newDevice(nullptr);
    if (!device) fail(OXRT_ERROR_LIBRARY_NOT_FOUND, "Embree in %s cannot make a device on this machine; %s", name, remedy);
    const auto version = static_cast<unsigned>(getProperty(device, RTC_DEVICE_PROPERTY_VERSION));
    releaseDevice(device);
    return version;
}

void resolveFunctions(void* handle, EmbreeLibrary& library)
{
#define OXRT_EMBREE_RESOLVE(name)                                                                                                          \
    library.name = reinterpret_cast<decltype(&::name)>(dlsym(handle, #name));                                                              \
    if (!library.name) fail(OXRT_ERROR_LIBRARY_NOT_FOUND, "Embree in %s lacks %s; %s", library.path.c_str(), #name, remedy);
    OXRT_EMBREE_FUNCTIONS(OXRT_EMBREE_RESOLVE)
#undef OXRT_EMBREE_RESOLVE
}

void checkProperties(const EmbreeLibrary& library, RTCDevice device)
{
    static constexpr struct {
        RTCDeviceProperty property;
        const char* option;
    } needed[] = {
        {RTC_DEVICE_PROPERTY_RAY_MASK_SUPPORTED, "EMBREE_RAY_MASK"},
        {RTC_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED, "EMBREE_FILTER_FUNCTION"},
        {RTC_DEVICE_PROPERTY_TRIANGLE_GEOMETRY_SUPPORTED, "EMBREE_GEOMETRY_TRIANGLE"},
        {RTC_DEVICE_PROPERTY_USER_GEOMETRY_SUPPORTED, "EMBREE_GEOMETRY_USER"},
    };
    for (const auto& [property, option] : needed)
        if (!library.rtcGetDeviceProperty(device, property))
            fail(OXRT_ERROR_LIBRARY_NOT_FOUND, "Embree in %s was built without %s, which is needed; %s", library.path.c_str(), option,
                 remedy);
}

// One instanced triangle, hit once: with other instance levels or without instance arrays the ids land elsewhere.
void checkHitLayout(const EmbreeLibrary& library, RTCDevice device)
{
    alignas(16) static constexpr float vertices[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static constexpr unsigned indices[3] = {0, 1, 2};
    static constexpr float identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

    const RTCScene inner = library.rtcNewScene(device);
    const RTCGeometry triangle = library.rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    library.rtcSetSharedGeometryBuffer(triangle, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices, 0, 12, 3);
    library.rtcSetSharedGeometryBuffer(triangle, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, indices, 0, 12, 1);
    library.rtcCommitGeometry(triangle);
    library.rtcAttachGeometryByID(inner, triangle, 5);
    library.rtcReleaseGeometry(triangle);
    library.rtcJoinCommitScene(inner);

    const RTCScene outer = library.rtcNewScene(device);
    const RTCGeometry instance = library.rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    library.rtcSetGeometryInstancedScene(instance, inner);
    library.rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, identity);
    library.rtcCommitGeometry(instance);
    library.rtcAttachGeometryByID(outer, instance, 7);
    library.rtcReleaseGeometry(instance);
    library.rtcReleaseScene(inner);
    library.rtcJoinCommitScene(outer);

    // Room behind the hit: a build with more levels writes there.
    struct {
        RTCRayHit rayhit;
        unsigned guard[64];
    } probe = {};
    RTCRay& ray = probe.rayhit.ray;
    ray.org_x = ray.org_y = 0.25f;
    ray.org_z = -1;
    ray.dir_z = 1;
    ray.tfar = 10;
    ray.mask = 1;
    probe.rayhit.hit.geomID = probe.rayhit.hit.primID = RTC_INVALID_GEOMETRY_ID;
    library.rtcIntersect1(outer, &probe.rayhit, nullptr);
    library.rtcReleaseScene(outer);

    // Embree divides by an approximate reciprocal, which differs from processor to processor.
    const RTCHit& hit = probe.rayhit.hit;
    const bool isAtTriangle = std::abs(ray.tfar - 1) < 1e-3f;
    bool clean = hit.geomID == 5 && hit.primID == 0 && hit.instID[0] == 7 && hit.instPrimID[0] == 0 && isAtTriangle;
    for (unsigned word : probe.guard) clean = clean && word == 0;
    if (!clean)
        fail(OXRT_ERROR_LIBRARY_NOT_FOUND,
             "Embree in %s lays out hits differently: it needs EMBREE_MAX_INSTANCE_LEVEL_COUNT=1 and EMBREE_GEOMETRY_INSTANCE_ARRAY=ON; %s",
             library.path.c_str(), remedy);
}

EmbreeLibrary load(const char* embreePath)
{
    EmbreeLibrary library;
    void* handle = openLibrary(embreePath, library);
    if (library.path.empty()) library.path = findLoadedEmbree();
    if (library.path.empty()) library.path = embreePath ? embreePath : "the library given by OXRT_EMBREE";

    library.version = readVersion(handle, library.path.c_str());
    if (library.version < 40000)
        fail(OXRT_ERROR_LIBRARY_NOT_FOUND, "%s is Embree %u.%u, but version 4 is needed; %s", library.path.c_str(), library.version / 10000,
             library.version / 100 % 100, remedy);
    resolveFunctions(handle, library);

    const std::unique_ptr<RTCDeviceTy, decltype(library.rtcReleaseDevice)> device(library.rtcNewDevice("threads=1"),
                                                                                  library.rtcReleaseDevice);
    checkProperties(library, device.get());
    checkHitLayout(library, device.get());
    library.backfaceCulling = library.rtcGetDeviceProperty(device.get(), RTC_DEVICE_PROPERTY_BACKFACE_CULLING_ENABLED) != 0;
    return library;
}

} // namespace

const EmbreeLibrary& loadEmbree(const char* embreePath)
{
    static std::mutex mutex;
    static const EmbreeLibrary* loaded = nullptr; // never unloaded: other users of the process may hold it as well
    const std::lock_guard lock(mutex);
    if (!loaded) loaded = new EmbreeLibrary(load(embreePath));
    return *loaded;
}

} // namespace oxrt
