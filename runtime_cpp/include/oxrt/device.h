/* All that the C++ of a compiled pipeline includes (and lanes.h for packets). No C++ standard header: see vectors.h. */
#ifndef OXRT_DEVICE_H
#define OXRT_DEVICE_H

#include <oxrt/device_isa.h>
#include <oxrt/math_geometry.h>
#include <oxrt/device_memory.h>
#include <oxrt/device_trace.h>
#include <oxrt/device_handles.h>
#include <oxrt/device_curves.h>

#endif
