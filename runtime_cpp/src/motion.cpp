// See motion.h.
#include "motion.h"

#include "error.h"
#include "matrix.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>

namespace oxrt {

namespace {

constexpr std::uint32_t knownMotionFlags = 3;
// A turn between two keys is bounded in this many pieces, each by interval arithmetic: boxes grow by a few per cent.
constexpr int piecesPerInterval = 32;

void checkTimes(const OxrtMotionOptions& motion)
{
    if (motion.flags & ~knownMotionFlags)
        fail(OXRT_ERROR_INVALID_VALUE, "motion.flags is 0x%x, which has unknown bits; combine MotionFlags", motion.flags);
    if (!std::isfinite(motion.timeBegin) || !std::isfinite(motion.timeEnd))
        fail(OXRT_ERROR_INVALID_VALUE, "motion.timeBegin %g and motion.timeEnd %g must be finite", static_cast<double>(motion.timeBegin),
             static_cast<double>(motion.timeEnd));
}

// f(position) at both ends and at every key between them, in order, in pairs of neighbours.
template <class F>
void eachPiece(double begin, double end, double step, F f)
{
    double at = begin;
    do {
        const double next = std::min(end, (std::floor(at / step) + 1) * step);
        f(at, next);
        at = next;
    } while (at < end);
}

// The key before a position and the fraction to the next; at a last key the one before it.
struct Place {
    std::size_t key;
    double fraction;
};

Place placeOf(double position, double pieceBegin)
{
    const double key = std::floor(pieceBegin);
    return {static_cast<std::size_t>(key), position - key};
}

// Element i between two keys of `stride` floats; the position of a piece's end belongs to the interval in which the piece begins.
double elementAt(const float* keys, std::size_t stride, std::size_t i, const Place& place)
{
    const double a = keys[place.key * stride + i];
    return place.fraction == 0 ? a : (1 - place.fraction) * a + place.fraction * static_cast<double>(keys[(place.key + 1) * stride + i]);
}

Interval operator+(const Interval& a, const Interval& b)
{
    return {a.lower + b.lower, a.upper + b.upper};
}

Interval operator-(const Interval& a, const Interval& b)
{
    return {a.lower - b.upper, a.upper - b.lower};
}

Interval operator*(const Interval& a, const Interval& b)
{
    const auto [least, most] = std::minmax({a.lower * b.lower, a.lower * b.upper, a.upper * b.lower, a.upper * b.upper});
    return {least, most};
}

Interval square(const Interval& a)
{
    const double l = a.lower * a.lower;
    const double u = a.upper * a.upper;
    return {a.lower <= 0 && a.upper >= 0 ? 0 : std::min(l, u), std::max(l, u)};
}

// Elements of a rotation, whatever the quaternion's length does on the way.
Interval perNorm(const Interval& element, const Interval& norm)
{
    if (norm.lower <= 0) return {-1, 1};
    const Interval inverse = {1 / norm.upper, 1 / norm.lower};
    const Interval quotient = element * inverse;
    return {std::max(quotient.lower, -1.0), std::min(quotient.upper, 1.0)};
}

// Translation times rotation times scale and shear, as the OptiX guide writes it ("Motion transforms").
void srtMatrix(const Interval (&s)[16], Interval (&matrix)[12])
{
    const Interval &x = s[9], &y = s[10], &z = s[11], &w = s[12];
    const Interval xx = square(x), yy = square(y), zz = square(z), ww = square(w);
    const Interval norm = xx + yy + zz + ww;
    const Interval two = {2, 2};
    const Interval rotation[9] = {
        perNorm(xx - yy - zz + ww, norm), perNorm(two * (x * y - z * w), norm), perNorm(two * (x * z + y * w), norm),
        perNorm(two * (x * y + z * w), norm), perNorm(yy - xx - zz + ww, norm), perNorm(two * (y * z - x * w), norm),
        perNorm(two * (x * z - y * w), norm), perNorm(two * (y * z + x * w), norm), perNorm(zz - xx - yy + ww, norm)};
    for (int row = 0; row < 3; ++row) {
        const Interval* r = rotation + 3 * row;
        matrix[4 * row] = r[0] * s[0];
        matrix[4 * row + 1] = r[0] * s[1] + r[1] * s[4];
        matrix[4 * row + 2] = r[0] * s[2] + r[1] * s[5] + r[2] * s[7];
        matrix[4 * row + 3] = r[0] * s[3] + r[1] * s[6] + r[2] * s[8] + s[13 + row];
    }
}

} // namespace

void checkMotion(const OxrtMotionOptions& motion)
{
    if (motion.numKeys <= 1) return; // static: times and flags do not count
    checkTimes(motion);
    if (motion.timeBegin > motion.timeEnd)
        fail(OXRT_ERROR_INVALID_VALUE, "motion.timeBegin %g is after motion.timeEnd %g", static_cast<double>(motion.timeBegin),
             static_cast<double>(motion.timeEnd));
}

void checkTransformMotion(const OxrtMotionOptions& motion)
{
    if (motion.numKeys < 2) fail(OXRT_ERROR_INVALID_VALUE, "motion.numKeys is %u; a motion transform needs at least 2", motion.numKeys);
    checkTimes(motion);
    if (!(motion.timeBegin < motion.timeEnd))
        fail(OXRT_ERROR_INVALID_VALUE, "motion.timeBegin %g must be before motion.timeEnd %g", static_cast<double>(motion.timeBegin),
             static_cast<double>(motion.timeEnd));
}

double keyPosition(const OxrtMotionOptions& motion, float time)
{
    const double last = motion.numKeys - 1.0;
    const double begin = motion.timeBegin;
    const double position = last * (static_cast<double>(time) - begin) / (static_cast<double>(motion.timeEnd) - begin);
    return position > 0 ? std::min(position, last) : 0;
}

RTCBounds sweptByMatrices(const float* keys, double begin, double end, const RTCBounds& bounds)
{
    RTCBounds swept = emptyBounds();
    eachPiece(begin, end, 1, [&](double from, double to) {
        for (const double position : {from, to}) { // every point moves along a line between them
            Interval matrix[12];
            for (std::size_t i = 0; i < 12; ++i) matrix[i].lower = matrix[i].upper = elementAt(keys, 12, i, placeOf(position, from));
            extend(swept, imageOf(matrix, bounds));
        }
    });
    return swept;
}

RTCBounds sweptBySrt(const float* keys, double begin, double end, const RTCBounds& bounds)
{
    RTCBounds swept = emptyBounds();
    eachPiece(begin, end, 1.0 / piecesPerInterval, [&](double from, double to) {
        Interval elements[16];
        for (std::size_t i = 0; i < 16; ++i) {
            const auto [least, most] = std::minmax({elementAt(keys, 16, i, placeOf(from, from)), elementAt(keys, 16, i, placeOf(to, from))});
            elements[i] = {least, most};
        }
        Interval matrix[12];
        srtMatrix(elements, matrix);
        extend(swept, imageOf(matrix, bounds));
    });
    return swept;
}

} // namespace oxrt
