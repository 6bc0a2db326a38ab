// Polynomials of degree 5 at most and their roots between 0 and 1.
#pragma once

#include <array>

namespace oxrt {

struct Polynomial {
    static constexpr int mostRoots = 5;

    std::array<double, mostRoots + 1> terms = {}; // of 1, u, u^2, ...

    double at(double u) const
    {
        double value = 0;
        for (int i = mostRoots; i >= 0; --i) value = value * u + terms[i];
        return value;
    }
    int degree() const;
    Polynomial derivative() const;
};

// Ascending; their number. A polynomial that is zero everywhere has none.
int rootsIn01(const Polynomial& f, double (&roots)[Polynomial::mostRoots]);

} // namespace oxrt
