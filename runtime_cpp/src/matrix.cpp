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
Interval product(double a, const Interval& b)
{
    return {std::min(a * b.lower, a * b.upper), std::max(a * b.lower, a * b.upper)};
}

Interval intervalOf(const Interval& a)
{
    return a;
}
Interval intervalOf(double a)
{
    return {a, a};
}

// Of a matrix of intervals or of numbers.
template <class Element>
RTCBounds image(const Element* matrix, const RTCBounds& bounds)
{
    if (isEmpty(bounds)) return emptyBounds();
    const Interval box[3] = {{bounds.lower_x, bounds.upper_x}, {bounds.lower_y, bounds.upper_y}, {bounds.lower_z, bounds.upper_z}};
    Interval rows[3];
    for (int row = 0; row < 3; ++row) {
        Interval sum = intervalOf(matrix[4 * row + 3]);
        double largest = std::max(std::fabs(sum.lower), std::fabs(sum.upper));
        for (int column = 0; column < 3; ++column) {
            const Interval term = product(matrix[4 * row + column], box[column]);
            sum = {sum.lower + term.lower, sum.upper + term.upper};
            largest = std::max(largest, std::max(std::fabs(term.lower), std::fabs(term.upper)));
        }
        rows[row] = {std::max(sum.lower - rounding * largest, -farthest), std::min(sum.upper + rounding * largest, farthest)};
    }
    const auto asFloat = [](double value) { return static_cast<float>(value); };
    return {asFloat(rows[0].lower), asFloat(rows[1].lower), asFloat(rows[2].lower), 0,
            asFloat(rows[0].upper), asFloat(rows[1].upper), asFloat(rows[2].upper), 0};
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
    return image(matrix, bounds);
}

RTCBounds imageOf(const float* matrix, const RTCBounds& bounds)
{
    return image(matrix, bounds);
}

} // namespace oxrt
