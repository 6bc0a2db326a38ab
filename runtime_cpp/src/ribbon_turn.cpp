// The rule was found by asking a real OptiX (9.0) for the normals of 700 strands, whose directions it gives to the last bits. A ribbon lies
// in the planes in which its axis bends. The plane of a segment whose neighbours go on in nearly its direction is that of a longer piece;
// at the borders of segments the planes' normals are averaged over neighbours, twice, so that the ribbon turns evenly.
#include "ribbon_turn.h"

#include <algorithm>
#include <cmath>

namespace oxrt {

namespace {

// Planes are differences of near points: in double precision they lose nothing of the control points.
struct Vector {
    double x = 0, y = 0, z = 0;
    Vector operator+(const Vector& b) const { return {x + b.x, y + b.y, z + b.z}; }
    Vector operator-(const Vector& b) const { return {x - b.x, y - b.y, z - b.z}; }
    Vector operator*(double s) const { return {x * s, y * s, z * s}; }
};

double dot(const Vector& a, const Vector& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

Vector cross(const Vector& a, const Vector& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Zero stays zero, which stands for no direction.
Vector unit(const Vector& a)
{
    const double length = std::sqrt(dot(a, a));
    return length > 0 ? a * (1 / length) : Vector{};
}

bool isDirection(const Vector& a)
{
    return dot(a, a) > 0;
}

Vector across(const Vector& a, const Vector& tangent)
{
    return a - tangent * dot(a, tangent);
}

// In binary32 with fused products: of planes at right angles, which are common in made-up strands, the rounding decides, as it does there.
bool isOpposite(const Vector& a, const Vector& b)
{
    return std::fma(float(a.x), float(b.x), std::fma(float(a.y), float(b.y), float(a.z) * float(b.z))) < 0;
}

Vector onSideOf(const Vector& a, const Vector& other)
{
    return isOpposite(a, other) ? a * -1 : a;
}

class Strand {
public:
    Strand(const Point4* points, std::size_t segments) : count(segments)
    {
        for (std::size_t i = 0; i < count + 2; ++i) controls.push_back({points[i].x, points[i].y, points[i].z});
        for (std::size_t k = 0; k <= count; ++k) {
            tangents.push_back(unit(controls[k + 1] - controls[k]));
            borders.push_back((controls[k] + controls[k + 1]) * 0.5);
        }
        for (std::size_t i = 0; i < count; ++i) {
            middles.push_back((controls[i] + controls[i + 2]) * 0.125 + controls[i + 1] * 0.75);
            chords.push_back(unit(borders[i + 1] - borders[i]));
        }
    }

    std::vector<Vector> widths() const
    {
        std::vector<Vector> planes = evenSides(longPlanes(filled(ownPlanes())));
        return turnedEvenly(averaged(planes));
    }

private:
    // The normal of the plane of a segment with `more` segments on both sides of it, zero for a straight line.
    Vector plane(std::size_t segment, std::size_t more) const
    {
        const Vector& from = borders[segment - std::min(segment, more)];
        const Vector way = borders[std::min(segment + 1 + more, count)] - from;
        const Vector aside = middles[segment] - from;
        const Vector normal = cross(way, aside);
        constexpr double straight = 1e-14;
        if (!(dot(normal, normal) > straight * dot(way, way) * dot(aside, aside))) return {};
        return unit(more > 0 ? across(normal, tangents[segment + 1]) : normal);
    }

    std::vector<Vector> ownPlanes() const
    {
        std::vector<Vector> planes;
        for (std::size_t i = 0; i < count; ++i) planes.push_back(plane(i, 0));
        return planes;
    }

    // Straight segments have no plane: they take those of the nearest bends, the mean of two that are as near.
    std::vector<Vector> filled(const std::vector<Vector>& planes) const
    {
        const std::size_t none = count;
        std::vector<std::size_t> before(count, none), behind(count, none);
        for (std::size_t i = 0; i < count; ++i) before[i] = isDirection(planes[i]) ? i : i > 0 ? before[i - 1] : none;
        for (std::size_t i = count; i-- > 0;) behind[i] = isDirection(planes[i]) ? i : i + 1 < count ? behind[i + 1] : none;
        std::vector<Vector> full = planes;
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t a = before[i], b = behind[i];
            if (a == none && b == none) {
                const Point4 free = anyAcross({float(tangents[i].x), float(tangents[i].y), float(tangents[i].z), 0});
                full[i] = {free.x, free.y, free.z};
            } else if (b == none || (a != none && i - a < b - i)) {
                full[i] = planes[a];
            } else if (a == none || b - i < i - a) {
                full[i] = planes[b];
            } else {
                const Vector mean = unit(planes[a] + planes[b]);
                full[i] = isDirection(mean) ? mean : planes[a];
            }
        }
        return full;
    }

    // A segment whose followers deviate little, all together by 30 degrees, takes the plane of a piece with as many segments on both sides.
    std::vector<Vector> longPlanes(std::vector<Vector> planes) const
    {
        constexpr std::size_t mostMore = 256; // a strand may be one long line
        const double limit = std::sqrt(0.75);
        for (std::size_t i = 0; i < count; ++i) {
            double together = 1;
            std::size_t more = 0;
            for (; more < mostMore && i + 1 + more < count; ++more)
                if (!((together *= std::fabs(dot(chords[i], chords[i + 1 + more]))) > limit)) break;
            const Vector piece = more > 0 ? plane(i, more) : Vector{};
            if (isDirection(piece)) planes[i] = piece;
        }
        return planes;
    }

    static std::vector<Vector> evenSides(std::vector<Vector> planes)
    {
        for (std::size_t i = 1; i < planes.size(); ++i) planes[i] = onSideOf(planes[i], planes[i - 1]);
        return planes;
    }

    // At every border, from the planes of the two segments that meet in it and in the borders beside it.
    std::vector<Vector> averaged(const std::vector<Vector>& planes) const
    {
        std::vector<Vector> sums = {planes.front()};
        for (std::size_t k = 1; k < count; ++k) sums.push_back(planes[k - 1] + planes[k]);
        sums.push_back(planes.back());
        std::vector<Vector> widths;
        for (std::size_t k = 0; k <= count; ++k) {
            const bool isEnd = k == 0 || k == count;
            const Vector sum = !isEnd ? sums[k - 1] + sums[k] + sums[k + 1] : count == 1 ? sums[k] : k == 0 ? sums[1] : sums[count - 1];
            widths.push_back(unit(across(sum, tangents[k])));
        }
        return widths;
    }

    // Every border but the ends turns towards its neighbours, of which the one before it has turned already.
    std::vector<Vector> turnedEvenly(std::vector<Vector> widths) const
    {
        constexpr double pull = 0.375;
        for (std::size_t k = 1; k < count; ++k) {
            const Vector own = widths[k];
            const Vector before = onSideOf(widths[k - 1], own);
            const Vector behind = onSideOf(widths[k + 1], own);
            const Vector turn = across(before, own) + across(behind, own);
            widths[k] = unit(across(own + turn * pull, tangents[k]));
        }
        return widths;
    }

    const std::size_t count;
    std::vector<Vector> controls, tangents, borders, middles, chords;
};

} // namespace

// One of two vectors that complete a direction to a frame without a branch but for the sign (Duff et al., JCGT 2017): OptiX turns straight
// ribbons so.
Point4 anyAcross(const Point4& tangent)
{
    const Point4 t = normalize3(tangent);
    const float sign = std::copysign(1.0f, t.z);
    const float a = -1 / (sign + t.z);
    return {-t.x * t.y * a, -sign - t.y * t.y * a, t.y, 0};
}

std::vector<Point4> acrossStrand(const Point4* points, std::size_t segments)
{
    std::vector<Point4> result;
    const std::vector<Vector> widths = Strand(points, segments).widths();
    for (std::size_t k = 0; k <= segments; ++k) {
        const Vector& w = widths[k];
        const bool isKnown = isDirection(w); // false where points coincide or are no numbers
        result.push_back(isKnown ? Point4{float(w.x), float(w.y), float(w.z), 0} : anyAcross(points[k + 1] - points[k]));
    }
    return result;
}

} // namespace oxrt
