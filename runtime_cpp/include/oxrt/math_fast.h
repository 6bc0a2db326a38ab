/* float32 functions for `math="fast"`: at most 4 units in the last place, evaluated in single precision.
 *
 * What is not written here is that of precise mode (pow, hyperbolic functions, hypot: their errors would grow beyond 4 ulp). Special values
 * are as there. Polynomials: S. Moshier, Cephes, single precision. Angles beyond 1e5 are reduced precisely.
 */
#ifndef OXRT_MATH_FAST_H
#define OXRT_MATH_FAST_H

#include <oxrt/math_precise.h>

#ifdef __clang__
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wbitwise-instead-of-logical" /* & and | of masks: lanes have no && */
#endif

namespace oxrt {
inline namespace OXRT_ISA {
namespace fast {

using precise::cosh;
using precise::hypot;
using precise::infinity;
using precise::pow;
using precise::sinh;
using precise::tanh;

template <class F> using IntOf = Rebind<F, int32_t>;

template <class F> OXRT_INLINE F polynomial(F, float c) { return F(c); }
template <class F, class... C> OXRT_INLINE F polynomial(F x, float c, C... rest) { return multiplyAdd(polynomial(x, rest...), x, F(c)); }

/* Added to a number below 2^22, leaves the nearest integer in the low bits of the sum. */
inline constexpr float roundingMagic = 0x1.8p23f;

/* ---- exponential and logarithm ------------------------------------------------------------------------------------------------ */

/* x 2^n for |n| <= 252, in two steps so that results may be denormal. */
template <class F> OXRT_INLINE F scaled(F x, IntOf<F> n) {
    const IntOf<F> half = n >> IntOf<F>(1);
    const IntOf<F> rest = n - half;
    return x * intAsFloat((half + IntOf<F>(127)) << IntOf<F>(23)) * intAsFloat((rest + IntOf<F>(127)) << IntOf<F>(23));
}

/* 2^n e^r, |r| <= ln(2)/2, where `sum` is n + roundingMagic. */
template <class F> OXRT_INLINE F scaledExponential(F sum, F r) {
    const F p = polynomial(r, 5.0000001201e-1f, 1.6666665459e-1f, 4.1665795894e-2f, 8.3334519073e-3f, 1.3981999507e-3f, 1.9875691500e-4f);
    const F e = multiplyAdd(p, r * r, r) + F(1.0f);
    return scaled(e, floatAsInt(sum) - floatAsInt(F(roundingMagic)));
}

template <Float32 F> OXRT_INLINE F exp(F x) {
    const F inside = precise::clampForExponential(x, -104.0f, 89.0f);
    const F sum = multiplyAdd(inside, F(1.44269504f), F(roundingMagic));
    const F n = sum - F(roundingMagic);
    const F r = multiplyAdd(n, F(2.12194440e-4f), multiplyAdd(n, F(-0.693359375f), inside));
    return select(x == x, scaledExponential(sum, r), x);
}
template <Float32 F> OXRT_INLINE F exp2(F x) {
    const F inside = precise::clampForExponential(x, -151.0f, 129.0f);
    const F sum = inside + F(roundingMagic);
    return select(x == x, scaledExponential(sum, (inside - (sum - F(roundingMagic))) * F(0.693147181f)), x);
}

template <class F> struct LogarithmParts {
    F exponent, m;
};
/* x = 2^exponent (1 + m) with 1 + m in [sqrt(1/2), sqrt(2)], for positive x. */
template <class F> OXRT_INLINE LogarithmParts<F> logarithmParts(F x) {
    const MaskOf<F> isDenormal = x < F(__FLT_MIN__);
    const IntOf<F> bits = floatAsInt(select(isDenormal, x * F(0x1p23f), x));
    const IntOf<F> exponent = (bits - IntOf<F>(0x3f3504f3)) >> IntOf<F>(23);
    const F m = intAsFloat(bits - (exponent << IntOf<F>(23))) - F(1.0f);
    return {convert<float>(exponent) - select(isDenormal, F(23.0f), F(0.0f)), m};
}
/* log(1 + m) - m. */
template <class F> OXRT_INLINE F logarithmRest(F m) {
    const F z = m * m;
    const F p = polynomial(m, 3.3333331174e-1f, -2.4999993993e-1f, 2.0000714765e-1f, -1.6668057665e-1f, 1.4249322787e-1f, -1.2420140846e-1f,
                           1.1676998740e-1f, -1.1514610310e-1f, 7.0376836292e-2f);
    return multiplyAdd(p * m, z, F(-0.5f) * z);
}
template <class F> OXRT_INLINE F logarithmOf(F x, F result) {
    result = select(x == F(float(infinity)), x, result);
    result = select(x == F(0.0f), F(-float(infinity)), result);
    return select(x >= F(0.0f), result, F(__builtin_nanf("")));
}
template <Float32 F> OXRT_INLINE F log(F x) {
    const auto parts = logarithmParts(x);
    const F low = multiplyAdd(parts.exponent, F(-2.12194440e-4f), logarithmRest(parts.m));
    return logarithmOf(x, multiplyAdd(parts.exponent, F(0.693359375f), parts.m + low));
}
template <Float32 F> OXRT_INLINE F log2(F x) {
    const auto parts = logarithmParts(x);
    const F rest = logarithmRest(parts.m);
    // log2(e) = 1 + 0.4427
    const F low = multiplyAdd(parts.m, F(0.442695041f), rest * F(1.44269504f));
    return logarithmOf(x, parts.exponent + (parts.m + low));
}
template <Float32 F> OXRT_INLINE F log10(F x) {
    const auto parts = logarithmParts(x);
    const F rest = logarithmRest(parts.m);
    const F low = multiplyAdd(parts.m + rest, F(7.00731903e-4f), rest * F(0.43359375f));
    const F exponentLow = multiplyAdd(parts.exponent, F(2.48745663e-4f), low);
    return logarithmOf(x, multiplyAdd(parts.exponent, F(0.30078125f), multiplyAdd(parts.m, F(0.43359375f), exponentLow)));
}

/* ---- trigonometry ------------------------------------------------------------------------------------------------------------- */

template <class F> struct Angle {
    F rest;
    IntOf<F> quadrant;
};
/* pi/2 in three parts. */
template <class F> OXRT_INLINE Angle<F> reduceAngle(F x) {
    const F sum = multiplyAdd(x, F(0.636619772f), F(roundingMagic));
    const F n = sum - F(roundingMagic);
    Angle<F> angle{multiplyAdd(n, F(1.71512451e-15f), multiplyAdd(n, F(4.37113883e-8f), multiplyAdd(n, F(-1.57079637f), x))),
                   floatAsInt(sum)};
    const MaskOf<F> isLarge = !(abs(x) < F(1.0e5f));
    if (__builtin_expect(any(isLarge), 0)) {
        const auto precisely = precise::reduceAngle(x);
        angle.rest = select(isLarge, F(convert<float>(precisely.rest)), angle.rest);
        angle.quadrant = select(isLarge, IntOf<F>(convert<int32_t>(precisely.quadrant)), angle.quadrant);
    }
    return angle;
}
template <class F> OXRT_INLINE F sinePolynomial(F r, F z) {
    return multiplyAdd(polynomial(z, -1.6666654611e-1f, 8.3321608736e-3f, -1.9515295891e-4f) * z, r, r);
}
template <class F> OXRT_INLINE F cosinePolynomial(F z) {
    return multiplyAdd(polynomial(z, 4.166664568298827e-2f, -1.388731625493765e-3f, 2.443315711809948e-5f), z * z, multiplyAdd(z,
        F(-0.5f), F(1.0f)));
}
/* If `quadrant` is odd `odd`, else `even`; negated if bit 1 of quadrant + turn is set. */
template <class F> OXRT_INLINE F byQuadrant(IntOf<F> quadrant, int turn, F even, F odd) {
    const F chosen = select((quadrant & IntOf<F>(1)) != IntOf<F>(0), odd, even);
    return intAsFloat(floatAsInt(chosen) ^ (((quadrant + IntOf<F>(turn)) & IntOf<F>(2)) << IntOf<F>(30)));
}
template <Float32 F> OXRT_INLINE F sin(F x) {
    const auto a = reduceAngle(x);
    const F z = a.rest * a.rest;
    return select(x == F(0.0f), x, byQuadrant(a.quadrant, 0, sinePolynomial(a.rest, z), cosinePolynomial(z)));
}
template <Float32 F> OXRT_INLINE F cos(F x) {
    const auto a = reduceAngle(x);
    const F z = a.rest * a.rest;
    return byQuadrant(a.quadrant, 1, cosinePolynomial(z), sinePolynomial(a.rest, z));
}
template <Float32 F> OXRT_INLINE F tan(F x) {
    const auto a = reduceAngle(x);
    const F z = a.rest * a.rest;
    const F s = sinePolynomial(a.rest, z);
    const F c = cosinePolynomial(z);
    return select(x == F(0.0f), x, byQuadrant(a.quadrant, 0, s, c) / byQuadrant(a.quadrant, 1, c, s));
}

/* atan(a / b) for 0 <= a, 0 < b. */
template <class F> OXRT_INLINE F ratioAngle(F a, F b) {
    // to |t| <= tan(pi/8): a/b, (a - b)/(a + b) or -b/a
    const MaskOf<F> isSteep = a > F(2.414213562f) * b;
    const MaskOf<F> isMiddle = !isSteep & (a > F(0.414213562f) * b);
    const F top = select(isSteep, -b, select(isMiddle, a - b, a));
    const F bottom = select(isSteep, a, select(isMiddle, a + b, b));
    const F base = select(isSteep, F(1.57079637f), select(isMiddle, F(0.785398163f), F(0.0f)));
    const F t = top / bottom;
    const F z = t * t;
    const F p = polynomial(z, -3.33329491539e-1f, 1.99777106478e-1f, -1.38776856032e-1f, 8.05374449538e-2f);
    return base + multiplyAdd(p * z, t, t);
}
template <Float32 F> OXRT_INLINE F atan(F x) {
    const F ax = abs(x);
    const F result = select(ax == F(float(infinity)), F(1.57079637f), ratioAngle(ax, F(1.0f)));
    return select(x == x, copysign(result, x), x);
}
template <class F> OXRT_INLINE F smallArcSine(F x, F z) {
    const F p = polynomial(z, 1.6666752422e-1f, 7.4953002686e-2f, 4.5470025998e-2f, 2.4181311049e-2f, 4.2163199048e-2f);
    return multiplyAdd(p * z, x, x);
}
template <Float32 F> OXRT_INLINE F asin(F x) {
    const F ax = abs(x);
    const MaskOf<F> isFar = ax > F(0.5f);
    const F z = select(isFar, F(0.5f) * (F(1.0f) - ax), ax * ax);
    const F s = smallArcSine(select(isFar, sqrt(z), ax), z);
    const F result = copysign(select(isFar, F(1.57079637f) - (s + s), s), x);
    return select(ax <= F(1.0f), result, F(__builtin_nanf("")));
}
template <Float32 F> OXRT_INLINE F acos(F x) {
    const F ax = abs(x);
    const MaskOf<F> isFar = ax > F(0.5f);
    const F z = select(isFar, F(0.5f) * (F(1.0f) - ax), ax * ax);
    const F s = smallArcSine(select(isFar, sqrt(z), x), z);
    const F far = select(x < F(0.0f), F(3.14159274f) - (s + s), s + s);
    return select(ax <= F(1.0f), select(isFar, far, F(1.57079637f) - s), F(__builtin_nanf("")));
}

template <Float32 F> OXRT_INLINE F rsqrt(F x) { return F(1.0f) / sqrt(x); }
/* Quotients that leave the range of float32 would cost the bound. */
template <Float32 F> OXRT_INLINE F atan2(F y, F x) { return precise::atan2(y, x); }

}  // namespace fast
}  // namespace OXRT_ISA
}  // namespace oxrt

#ifdef __clang__
#pragma clang diagnostic pop
#endif

#endif
