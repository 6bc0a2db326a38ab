// How a ribbon without normals is turned about its axis, strand by strand.
#pragma once

#include "curve_basis.h"

#include <cstddef>
#include <vector>

namespace oxrt {

// A direction across `tangent` where nothing else says one.
Point4 anyAcross(const Point4& tangent);

// The unit vectors across at the borders of a strand's segments, one more than these; `points` has two control points more than segments.
std::vector<Point4> acrossStrand(const Point4* points, std::size_t segments);

} // namespace oxrt
