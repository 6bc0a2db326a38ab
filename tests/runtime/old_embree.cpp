// Answers like Embree 3.13, to see that it is refused.
#include "oxrt/embree.h"

#define EXPORT __attribute__((visibility("default")))

EXPORT RTCDevice rtcNewDevice(const char*)
{
    static int device;
    return reinterpret_cast<RTCDevice>(&device);
}

EXPORT void rtcReleaseDevice(RTCDevice)
{}

EXPORT ptrdiff_t rtcGetDeviceProperty(RTCDevice, RTCDeviceProperty)
{
    return 31305;
}
