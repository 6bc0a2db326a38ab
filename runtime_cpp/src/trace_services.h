// The functions that kernels call back: Embree's queries, faults, prints.
#pragma once

#include "embree_library.h"
#include "oxrt/pipeline.h"

namespace oxrt {

OxrtServices traceServices(const EmbreeLibrary& embree);

} // namespace oxrt
