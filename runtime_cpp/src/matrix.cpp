// See matrix.h.
#include "matrix.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace oxrt {

namespace {

// Kernels move rays in binary32: a few units in the last place of the largest coordinate.
constexpr double rounding = 1e-6;

Interval product(const Interval& a, const Interval& b)
{
    const double corners[4] = {a.lower * b.lower, a.lower * b.upper, a.upper * b.lower, a.upper * b.upper};
    return {*std::min_element(corners, corners + 4), *std::max_element(corners, corners + 4)};
}

} // namespace

bool invert(const float (&matrix)[12], float (&inverse)[12])
{
    const auto m = [&matrix](int row, int column) { return static_cast<double>(matrix[4 * row + column]); };
    double cofactors[9];
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) {
            const int r0 = (row + 1) % 3;
            const int r1 = (row + 2) % 3;
            const int c0 = (column + 1) % 3;
            const int c1 = (column + 2) % 3;
            cofactors[3 * row + column] = m(r0, c0) * m(r1, c1) - m(r0, c1) * m(r1, c0);
        }
    const double determinant = m(0, 0) * cofactors[0] + m(0, 1) * cofactors[1] + m(0, 2) * cofactors[2];
    bool finite = determinant != 0;
    for (int row = 0; row < 3; ++row) {
        double translation = 0;
        for (int column = 0; column < 3; ++column) {
            const double element = cofactors[3 * column + row] / determinant;
            inverse[4 * row + column] = static_cast<float>(element);
            translation -= element * m(column, 3);
        }
        inverse[4 * row + 3] = static_cast<float>(translation);
        for (int column = 0; column < 4; ++column) finite = finite && std::isfinite(inverse[4 * row + column]);
    }
    if (!finite) std::fill(std::begin(inverse), std::end(inverse), 0.0f);
    return finite;
}

RTCBounds emptyBounds()
{
    constexpr float infinity = std::numeric_limits<float>::infinity();
    return {infinity, infinity, infinity, 0, -infinity, -infinity, -infinity, 0};
}

bool isEmpty(const RTCBounds& bounds)
{
    return !(bounds.lower_x <= bounds.upper_x && bounds.lower_y <= bounds.upper_y && bounds.lower_z <= bounds.upper_z);
}

void extend(RTCBounds& bounds, const RTCBounds& other)
{
    bounds = {std::min(bounds.lower_x, other.lower_x), std::min(bounds.lower_y, other.lower_y), std::min(bounds.lower_z, other.lower_z), 0,
              std::max(bounds.upper_x, other.upper_x), std::max(bounds.upper_y, other.upper_y), std::max(bounds.upper_z, other.upper_z), 0};
}

RTCBounds imageOf(const Interval (&matrix)[12], const RTCBounds& bounds)
{
    if (isEmpty(bounds)) return emptyBounds();
    const Interval box[3] = {{bounds.lower_x, bounds.upper_x}, {bounds.lower_y, bounds.upper_y}, {bounds.lower_z, bounds.upper_z}};
    double lower[3];
    double upper[3];
    for (int row = 0; row < 3; ++row) {
        lower[row] = matrix[4 * row + 3].lower;
        upper[row] = matrix[4 * row + 3].upper;
        double largest = std::max(std::fabs(lower[row]), std::fabs(upper[row]));
        for (int column = 0; column < 3; ++column) {
            const Interval term = product(matrix[4 * row + column], box[column]);
            lower[row] += term.lower;
            upper[row] += term.upper;
            largest = std::max({largest, std::fabs(term.lower), std::fabs(term.upper)});
        }
        lower[row] = std::max(lower[row] - rounding * largest, -farthest);
        upper[row] = std::min(upper[row] + rounding * largest, farthest);
    }
    const auto asFloat = [](double value) { return static_cast<float>(value); };
    return {asFloat(lower[0]), asFloat(lower[1]), asFloat(lower[2]), 0, asFloat(upper[0]), asFloat(upper[1]), asFloat(upper[2]), 0};
}

RTCBounds imageOf(const float* matrix, const RTCBounds& bounds)
{
    Interval exact[12];
    for (int i = 0; i < 12; ++i) exact[i] = {matrix[i], matrix[i]};
    return imageOf(exact, bounds);
}

} // namespace oxrt
