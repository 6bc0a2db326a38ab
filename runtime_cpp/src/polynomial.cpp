// See polynomial.h.
#include "polynomial.h"

namespace oxrt {

namespace {

constexpr int rootSteps = 60;
constexpr double smallest = 1e-14; // intervals that are as good as a point

// The root between two places where `f` has different signs: Newton's steps, halving where they leave the interval or are too slow.
double rootBetween(const Polynomial& f, const Polynomial& slope, double low, double high)
{
    const bool rises = f.at(low) < 0;
    double u = 0.5 * (low + high);
    double width = high - low;
    for (int step = 0; step < rootSteps && high - low > smallest; ++step) {
        const double value = f.at(u);
        if (value == 0) return u;
        ((value < 0) == rises ? low : high) = u;
        const double incline = slope.at(u);
        const double next = incline != 0 ? u - value / incline : low;
        const double move = next > u ? next - u : u - next;
        if (!(next > low && next < high) || move > 0.5 * width) {
            width = 0.5 * (high - low);
            u = low + width;
        } else {
            if (move < smallest) return next;
            width = move;
            u = next;
        }
    }
    return u;
}

} // namespace

int Polynomial::degree() const
{
    int highest = mostRoots;
    while (highest > 0 && terms[highest] == 0) --highest;
    return highest;
}

Polynomial Polynomial::derivative() const
{
    Polynomial result;
    for (int i = 1; i <= mostRoots; ++i) result.terms[i - 1] = i * terms[i];
    return result;
}

// It is monotone between the roots of its derivative.
int rootsIn01(const Polynomial& f, double (&roots)[Polynomial::mostRoots])
{
    const int degree = f.degree();
    if (degree == 0) return 0;
    const Polynomial slope = f.derivative();
    double extremes[Polynomial::mostRoots];
    const int extremeCount = degree > 1 ? rootsIn01(slope, extremes) : 0;
    int found = 0;
    double low = 0;
    double atLow = f.at(0);
    if (atLow == 0) roots[found++] = 0;
    for (int i = 0; i <= extremeCount && found < Polynomial::mostRoots; ++i) {
        const double high = i < extremeCount ? extremes[i] : 1;
        if (high <= low) continue;
        const double atHigh = f.at(high);
        if (atHigh == 0)
            roots[found++] = high;
        else if ((atLow < 0 && atHigh > 0) || (atLow > 0 && atHigh < 0))
            roots[found++] = rootBetween(f, slope, low, high);
        low = high;
        atLow = atHigh;
    }
    return found;
}

} // namespace oxrt
