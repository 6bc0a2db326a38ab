// Vectors, random numbers, sampling: the arithmetic that all kernels share, for one number or many.
#ifndef BENCH_ALGEBRA_H
#define BENCH_ALGEBRA_H

#include "job.h"
#include "wide.h"

namespace bench {

template <class F> struct Vec {
    F x, y, z;
    Vec() = default;
    BENCH_INLINE Vec(F x_, F y_, F z_) : x(x_), y(y_), z(z_) {}
    BENCH_INLINE explicit Vec(const float* p) : x(p[0]), y(p[1]), z(p[2]) {}
};
using Float3 = Vec<float>;
using Wide3 = Vec<Wide>;

template <class F> BENCH_INLINE Vec<F> operator+(Vec<F> a, Vec<F> b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
template <class F> BENCH_INLINE Vec<F> operator-(Vec<F> a, Vec<F> b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
template <class F> BENCH_INLINE Vec<F> operator*(Vec<F> a, Vec<F> b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
template <class F> BENCH_INLINE Vec<F> operator*(F s, Vec<F> a) { return {s * a.x, s * a.y, s * a.z}; }
template <class F> BENCH_INLINE Vec<F> operator-(Vec<F> a) { return {-a.x, -a.y, -a.z}; }
template <class F> BENCH_INLINE F dot(Vec<F> a, Vec<F> b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class F> BENCH_INLINE Vec<F> cross(Vec<F> a, Vec<F> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class F> BENCH_INLINE F length(Vec<F> a) { return squareRoot(dot(a, a)); }
template <class F> BENCH_INLINE Vec<F> normalize(Vec<F> a) { return (F(1.0f) / length(a)) * a; }
template <class F> BENCH_INLINE Vec<F> select(BoolOf<F> m, Vec<F> a, Vec<F> b) {
    return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}
template <class F> BENCH_INLINE Vec<F> facing(Vec<F> n, Vec<F> direction) { return select(dot(n, direction) > F(0.0f), -n, n); }

template <class F> BENCH_INLINE Vec<F> gather3(const float* base, UintOf<F> index, BoolOf<F> mask) {
    const UintOf<F> at = index * UintOf<F>(3u);
    return {gather(base, at, mask), gather(base + 1, at, mask), gather(base + 2, at, mask)};
}

// ---- random numbers: O'Neill's PCG RXS-M-XS

template <class U> BENCH_INLINE U pcgStep(U state) { return state * U(747796405u) + U(2891336453u); }
template <class U> BENCH_INLINE U pcgHash(U value) {
    const U state = pcgStep(value);
    const U word = ((state >> ((state >> 28u) + U(4u))) ^ state) * U(277803737u);
    return (word >> 22u) ^ word;
}
template <class F> struct Random {
    UintOf<F> state;
    BENCH_INLINE F next() {
        const UintOf<F> word = pcgHash(state);
        state = pcgStep(state);
        return toFloat(word >> 8u) * F(5.9604644775390625e-08f);
    }
};

// ---- directions

// Sine and cosine for |x| below some thousands: Cephes' polynomials after a reduction by pi/2.
template <class F> BENCH_INLINE void sineCosine(F x, F& sine, F& cosine) {
    const F quadrant = roundDown(x * F(0.636619772f) + F(0.5f));
    const F r = ((x - quadrant * F(1.5703125f)) - quadrant * F(4.837512969970703e-4f)) - quadrant * F(7.549789948768648e-8f);
    const F r2 = r * r;
    const F s = ((F(-1.9515295891e-4f) * r2 + F(8.3321608736e-3f)) * r2 - F(1.6666654611e-1f)) * r2 * r + r;
    const F c = ((F(2.443315711809948e-5f) * r2 - F(1.388731625493765e-3f)) * r2 + F(4.166664568298827e-2f)) * (r2 * r2) -
                F(0.5f) * r2 + F(1.0f);
    const UintOf<F> q = toInteger(quadrant);
    const BoolOf<F> even = (q & UintOf<F>(1u)) == UintOf<F>(0u);
    const F sineOf = select(even, s, c), cosineOf = select(even, c, s);
    sine = select((q & UintOf<F>(2u)) == UintOf<F>(0u), sineOf, -sineOf);
    cosine = select(((q + UintOf<F>(1u)) & UintOf<F>(2u)) == UintOf<F>(0u), cosineOf, -cosineOf);
}

// Duff et al. 2017.
template <class F> BENCH_INLINE void tangents(Vec<F> n, Vec<F>& s, Vec<F>& t) {
    const F sign = select(n.z >= F(0.0f), F(1.0f), F(-1.0f));
    const F a = F(-1.0f) / (sign + n.z);
    const F b = n.x * n.y * a;
    s = {F(1.0f) + sign * n.x * n.x * a, sign * b, -sign * n.x};
    t = {b, sign + n.y * n.y * a, -n.y};
}

template <class F> BENCH_INLINE Vec<F> cosineHemisphere(F u1, F u2) {
    const F radius = squareRoot(u1);
    F sine, cosine;
    sineCosine(F(6.283185307f) * u2, sine, cosine);
    return {radius * cosine, radius * sine, squareRoot(F(1.0f) - u1)};
}

template <class F> BENCH_INLINE Vec<F> cosineAbout(Vec<F> n, F u1, F u2) {
    Vec<F> s, t;
    tangents(n, s, t);
    const Vec<F> local = cosineHemisphere(u1, u2);
    return local.x * s + local.y * t + local.z * n;
}

// ---- camera

template <class F> BENCH_INLINE Vec<F> cameraDirection(const BenchJob& job, UintOf<F> x, UintOf<F> y) {
    const F px = F(job.pixel[0]) * (toFloat(x) + F(0.5f)) - F(1.0f);
    const F py = F(1.0f) - F(job.pixel[1]) * (toFloat(y) + F(0.5f));
    return normalize(px * Vec<F>(job.u) + py * Vec<F>(job.v) + Vec<F>(job.w));
}

}  // namespace bench
#endif
