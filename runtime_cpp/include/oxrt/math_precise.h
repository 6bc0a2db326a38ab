/* float32 functions to within one unit in the last place, for scalars and lanes alike.
 *
 * Each is evaluated in double precision by a polynomial whose relative error is below 2^-34, and rounded once, so that the result
 * is the nearest float32 but for about one argument in a thousand, where it is the other neighbour. Special values follow C's Annex F.
 * The polynomials are minimax fits (relative error; Lawson's weights) over the reduced range stated beside them.
 */
#ifndef OXRT_MATH_PRECISE_H
#define OXRT_MATH_PRECISE_H

#include <oxrt/number.h>

#ifdef __clang__
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wbitwise-instead-of-logical" /* & and | of masks: lanes have no && */
#endif

namespace oxrt {
inline namespace OXRT_ISA {
namespace precise {

template <class D> OXRT_INLINE D polynomial(D, double c) { return D(c); }
template <class D, class... C> OXRT_INLINE D polynomial(D x, double c, C... rest) { return multiplyAdd(polynomial(x, rest...), x, D(c)); }

template <class F> using DoubleOf = Rebind<F, double>;
template <class F> using LongOf = Rebind<F, int64_t>;

inline constexpr double infinity = __builtin_inf();
inline constexpr double pi = 0x1.921fb54442d18p+1;
/* Added to a number below 2^51, leaves the nearest integer in the low bits of the sum. */
inline constexpr double roundingMagic = 0x1.8p52;

/* ---- exponential and logarithm ------------------------------------------------------------------------------------------------ */

/* 2^n e^r where `sum` is n + roundingMagic, |n| < 1000, |r| <= ln(2)/2. */
template <class D> OXRT_INLINE D scaledExponential(D sum, D r) {
    const D p = polynomial(r, 0x1.ffffffffab7efp-1, 0x1.000000010c1a0p+0, 0x1.00000059fd78ep-1, 0x1.55555342c77bep-3, 0x1.55546819edb0fp-5,
                           0x1.1112faf68edfep-7, 0x1.6da4f64a44c04p-10, 0x1.9eb6ca4b4d27ap-13);
    const auto exponent = (bitCast<int64_t>(sum) << 52) + LongOf<D>(int64_t(1023) << 52);
    return p * bitCast<double>(exponent);
}

/* e^x for |x| <= 700. */
template <class D> OXRT_INLINE D exponential(D x) {
    const D sum = multiplyAdd(x, D(0x1.71547652b82fep+0), D(roundingMagic));
    return scaledExponential(sum, multiplyAdd(sum - D(roundingMagic), D(-0x1.62e42fefa39efp-1), x));
}

/* 2^x for |x| <= 1000. */
template <class D> OXRT_INLINE D exponential2(D x) {
    const D sum = x + D(roundingMagic);
    return scaledExponential(sum, (x - (sum - D(roundingMagic))) * D(0x1.62e42fefa39efp-1));
}

/* x = 2^exponent * m with m in [sqrt(1/2), sqrt(2)]; `log` is log(m) = 2 atanh((m - 1) / (m + 1)). x is positive and normal. */
template <class D> struct LogarithmParts {
    D exponent, log;
};
template <bool isLong, class D> OXRT_INLINE LogarithmParts<D> logarithmParts(D x) {
    const auto bits = bitCast<int64_t>(x);
    const auto biased = shiftRightLogical<52>(bits - LongOf<D>(0x3fe6a09e667f3bcd - (int64_t(1023) << 52)));
    const D exponent = bitCast<double>(biased | LongOf<D>(0x4330000000000000)) - D(0x1p52 + 1023);
    const D m = bitCast<double>(bits - ((biased - LongOf<D>(1023)) << 52));
    const D s = (m - D(1.0)) / (m + D(1.0));
    const D s2 = s * s;
    D p;
    if constexpr (isLong)
        p = polynomial(s2, 0x1.0000000000001p+0, 0x1.5555555552cfbp-2, 0x1.999999a4462f7p-3, 0x1.249240ae4dbd7p-3, 0x1.c722d256de86fp-4,
                       0x1.732276e14626ap-4, 0x1.58dda14696352p-4);
    else
        p = polynomial(s2, 0x1.0000000004a43p+0, 0x1.555554da9b8b0p-2, 0x1.999a9ce507d67p-3, 0x1.2432ab309b065p-3, 0x1.e3b2d4e0e5449p-4);
    return {exponent, (s + s) * p};
}

/* The logarithm of x to the base with log2(base) = 1 / perOctave, perNeper = 1 / ln(base). */
template <class F> OXRT_INLINE F logarithm(F x, double perOctave, double perNeper) {
    const auto parts = logarithmParts<false>(convert<double>(x));
    F result = convert<float>(multiplyAdd(parts.exponent, DoubleOf<F>(perOctave), parts.log * DoubleOf<F>(perNeper)));
    result = select(x == F(float(infinity)), x, result);
    result = select(x == F(0.0f), F(-float(infinity)), result);
    return select(x >= F(0.0f), result, F(__builtin_nanf("")));
}

template <class F> OXRT_INLINE F clampForExponential(F x, float low, float high) {
    const F below = select(x > F(high), F(high), x);
    return select(below < F(low), F(low), below);
}

template <Float32 F>
OXRT_INLINE F exp(F x) { return convert<float>(exponential(convert<double>(clampForExponential(x, -110.0f, 100.0f)))); }
template <Float32 F>
OXRT_INLINE F exp2(F x) { return convert<float>(exponential2(convert<double>(clampForExponential(x, -160.0f, 140.0f)))); }
template <Float32 F> OXRT_INLINE F log(F x) { return logarithm(x, 0x1.62e42fefa39efp-1, 1.0); }
template <Float32 F> OXRT_INLINE F log2(F x) { return logarithm(x, 1.0, 0x1.71547652b82fep+0); }
template <Float32 F> OXRT_INLINE F log10(F x) { return logarithm(x, 0x1.34413509f79ffp-2, 0x1.bcb7b1526e50ep-2); }

/* C's pow: 1 for y = 0 or x = 1, whatever the other; NaN for a finite x < 0 and a y that is no integer. */
template <Float32 F> OXRT_INLINE F pow(F x, F y) {
    using D = DoubleOf<F>;
    const F ax = abs(x);
    const F ay = abs(y);
    const F infinite = F(float(infinity));
    const MaskOf<F> isZero = ax == F(0.0f);
    const MaskOf<F> isInfinite = ax == infinite;
    // log2|x| times y, kept where the exponential stays finite
    const auto parts = logarithmParts<true>(convert<double>(ax));
    const D log2x = multiplyAdd(parts.log, D(0x1.71547652b82fep+0), parts.exponent);
    const D product = convert<double>(y) * log2x;
    const D power = minimum(maximum(product, D(-200.0)), D(200.0));
    F result = convert<float>(exponential2(power));
    result = select((isZero & (y < F(0.0f))) | (isInfinite & (y > F(0.0f))), infinite, result);
    result = select((isZero & (y > F(0.0f))) | (isInfinite & (y < F(0.0f))), F(0.0f), result);
    result = select((ax == F(1.0f)) & (ay == infinite), F(1.0f), result);
    // sign of a negative base
    const MaskOf<F> isInteger = trunc(y) == y;
    const F halfY = y * F(0.5f);
    const MaskOf<F> isOdd = isInteger & (trunc(halfY) != halfY);
    const MaskOf<F> isNegative = floatAsInt(x) < Rebind<F, int32_t>(0);
    result = select(isOdd & isNegative, -result, result);
    result = select((x < F(0.0f)) & !isInfinite & !isInteger, F(__builtin_nanf("")), result);
    result = select((x == x) & (y == y), result, x + y);
    return select((x == F(1.0f)) | (y == F(0.0f)), F(1.0f), result);
}

/* ---- trigonometry ------------------------------------------------------------------------------------------------------------- */

template <class D> OXRT_INLINE D sinePolynomial(D r, D r2) {
    return r * polynomial(r2, 0x1.fffffffff5fd8p-1, -0x1.55555548e20f3p-3, 0x1.11110717ae10ap-7, -0x1.a00ec68854268p-13,
                          0x1.6cb086ea8a42dp-19);
}
template <class D> OXRT_INLINE D cosinePolynomial(D r2) {
    return polynomial(r2, 0x1.ffffffffffdb0p-1, -0x1.ffffffffdfeedp-2, 0x1.555555430cc02p-5, -0x1.6c16b20899c00p-10, 0x1.a00e38f91c8d1p-16,
                      -0x1.23b6aa208b15cp-22);
}

/* Arguments beyond this take the bits of 2/pi; up to it a two-part pi/2 does (fdlibm's 33 + 53 bits; n stays below 2^20). */
inline constexpr float largeAngle = 1.0e6f;

/* x = quadrant * pi/2 + rest, |rest| <= pi/4; the quadrant counts modulo 4. */
struct ReducedAngle {
    double rest;
    int64_t quadrant;
};

/* The reduction for largeAngle <= |x| < infinity: 96 bits of 2/pi from the one worth 2, times the 24 bits of x (Payne and Hanek). */
inline ReducedAngle reduceLargeAngle(float x) {
    constexpr uint32_t twoOverPi[] = {0xa2f9836e, 0x4e441529, 0xfc2757d1, 0xf534ddc0, 0xdb629599, 0x3c439041, 0xfe5163ab, 0xdebbc561};
    const uint32_t bits = bitCast<uint32_t>(x);
    const int exponent = int(bits >> 23 & 0xff) - 150;
    const uint64_t mantissa = (bits & 0x7fffff) | 0x800000;
    // bits `first` to `first` + 95 after the binary point of 2/pi; those before it give multiples of 4
    const int first = exponent - 2;
    unsigned __int128 window = 0;
    for (int index = first; index < first + 96; index += 32) {
        const uint64_t pair = index < 0 ? uint64_t(twoOverPi[0]) << (32 + index)
                                        : (uint64_t(twoOverPi[index / 32]) << 32 | twoOverPi[index / 32 + 1]) << (index % 32);
        window = window << 32 | pair >> 32;
    }
    // 94 bits after the point
    unsigned __int128 product = window * mantissa & ((static_cast<unsigned __int128>(1) << 96) - 1);
    product += static_cast<unsigned __int128>(1) << 93;
    const int64_t quadrant = int64_t(product >> 94) & 3;
    const unsigned __int128 fraction = product & ((static_cast<unsigned __int128>(1) << 94) - 1);
    const int64_t centred = int64_t(fraction >> 31) - (int64_t(1) << 62);
    const double rest = double(centred) * 0x1p-63 * (pi / 2);
    return bits >> 31 ? ReducedAngle{-rest, -quadrant} : ReducedAngle{rest, quadrant};
}

template <class F> struct Angle {
    DoubleOf<F> rest;
    LongOf<F> quadrant;
};

template <class F> OXRT_INLINE Angle<F> reduceAngle(F x) {
    using D = DoubleOf<F>;
    const D wide = convert<double>(x);
    const D sum = multiplyAdd(wide, D(0x1.45f306dc9c883p-1), D(roundingMagic));
    const D n = sum - D(roundingMagic);
    Angle<F> angle{(wide - n * D(0x1.921fb54400000p+0)) - n * D(0x1.0b4611a626331p-34), bitCast<int64_t>(sum)};
    const MaskOf<F> isLarge = abs(x) > F(largeAngle);
    if (__builtin_expect(any(isLarge), 0)) {
        const MaskOf<F> isFinite = abs(x) < F(float(infinity));
        const F safe = select(isLarge & isFinite, x, F(largeAngle));
        const MaskOf<D> wideMask = isLarge;
        angle.rest = select(wideMask, mapLanes([](float v) { return reduceLargeAngle(v).rest; }, safe), angle.rest);
        angle.quadrant = select(wideMask, mapLanes([](float v) { return reduceLargeAngle(v).quadrant; }, safe), angle.quadrant);
        angle.rest = select(isFinite, angle.rest, D(__builtin_nan("")));
    }
    return angle;
}

/* if quadrant is odd `odd`, else `even`; negated if bit 1 of `quadrant + turn` is set. Bits, because wide masks are slow on AVX2. */
template <class D, class I> OXRT_INLINE D byQuadrant(I quadrant, int turn, D even, D odd) {
    const I isOdd = I(0) - (quadrant & I(1));
    const I chosen = (bitCast<int64_t>(even) & ~isOdd) | (bitCast<int64_t>(odd) & isOdd);
    return bitCast<double>(chosen ^ (((quadrant + I(turn)) & I(2)) << 62));
}

template <Float32 F> OXRT_INLINE F sin(F x) {
    const auto a = reduceAngle(x);
    const auto r2 = a.rest * a.rest;
    const F result = convert<float>(byQuadrant(a.quadrant, 0, sinePolynomial(a.rest, r2), cosinePolynomial(r2)));
    return select(x == F(0.0f), x, result);
}

template <Float32 F> OXRT_INLINE F cos(F x) {
    const auto a = reduceAngle(x);
    const auto r2 = a.rest * a.rest;
    return convert<float>(byQuadrant(a.quadrant, 1, cosinePolynomial(r2), sinePolynomial(a.rest, r2)));
}

template <Float32 F> OXRT_INLINE F tan(F x) {
    const auto a = reduceAngle(x);
    const auto r2 = a.rest * a.rest;
    const auto s = sinePolynomial(a.rest, r2);
    const auto c = cosinePolynomial(r2);
    const F result = convert<float>(byQuadrant(a.quadrant, 0, s, c) / byQuadrant(a.quadrant, 1, c, s));
    return select(x == F(0.0f), x, result);
}

/* atan(t) for 0 <= t <= 1. */
template <class D> OXRT_INLINE D arcTangent(D t) {
    return t * polynomial(t * t, 0x1.ffffffffff78dp-1, -0x1.555555536a120p-2, 0x1.9999987064c97p-3, -0x1.2492257d17801p-3,
                          0x1.c717ef608fb7dp-4,
                          -0x1.7430bb6c8d589p-4, 0x1.39f352fd19d39p-4, -0x1.0bf4cda38ae43p-4, 0x1.c04463c27fe7fp-5, -0x1.5ca775207070cp-5,
                          0x1.d61eb28107a51p-6, -0x1.facd0168cea8bp-7, 0x1.8d530d0383e62p-8, -0x1.8b03d906f76dcp-10, 0x1.7176169c99d16p-13);
}

/* The angle of the direction (x, y) for y >= 0, in [0, pi]; 0 for (0, 0). */
template <class D> OXRT_INLINE D halfPlaneAngle(D y, D x) {
    const D ax = abs(x);
    const D low = minimum(y, ax);
    const D high = maximum(y, ax);
    const D ratio = low / maximum(high, D(0x1p-1022));
    D angle = arcTangent(ratio);
    angle = select(y > ax, D(pi / 2) - angle, angle);
    return select(x < D(0.0), D(pi) - angle, angle);
}

template <Float32 F> OXRT_INLINE F atan(F x) {
    using D = DoubleOf<F>;
    const D ax = convert<double>(abs(x));
    const D t = minimum(ax, D(1.0)) / maximum(ax, D(1.0));
    const D angle = arcTangent(t);
    const F result = convert<float>(select(ax > D(1.0), D(pi / 2) - angle, angle));
    return select(x == x, copysign(result, x), x);
}

template <Float32 F> OXRT_INLINE F asin(F x) {
    using D = DoubleOf<F>;
    const D ax = convert<double>(abs(x));
    const D other = sqrt((D(1.0) - ax) * (D(1.0) + ax));
    const F result = copysign(convert<float>(halfPlaneAngle(ax, other)), x);
    return select(abs(x) <= F(1.0f), result, F(__builtin_nanf("")));
}

template <Float32 F> OXRT_INLINE F acos(F x) {
    using D = DoubleOf<F>;
    const D wide = convert<double>(x);
    const D other = sqrt((D(1.0) - wide) * (D(1.0) + wide));
    const F result = convert<float>(halfPlaneAngle(other, wide));
    return select(abs(x) <= F(1.0f), result, F(__builtin_nanf("")));
}

template <Float32 F> OXRT_INLINE F atan2(F y, F x) {
    using D = DoubleOf<F>;
    const F infinite = F(float(infinity));
    const MaskOf<F> bothInfinite = (abs(x) == infinite) & (abs(y) == infinite);
    const D wideX = convert<double>(select(bothInfinite, copysign(F(1.0f), x), x));
    const D wideY = convert<double>(select(bothInfinite, F(1.0f), abs(y)));
    F angle = convert<float>(halfPlaneAngle(wideY, wideX));
    angle = select((x == F(0.0f)) & (y == F(0.0f)) & (floatAsInt(x) < Rebind<F, int32_t>(0)), F(float(pi)), angle);
    return select((x == x) & (y == y), copysign(angle, y), x + y);
}

/* ---- hyperbolic functions and roots ------------------------------------------------------------------------------------------- */

/* sinh for |x| <= 1, where the difference of exponentials cancels. */
template <class D> OXRT_INLINE D smallHyperbolicSine(D x) {
    return x * polynomial(x * x, 0x1.00000000328d3p+0, 0x1.5555550419abdp-3, 0x1.11113a6d1d473p-7, 0x1.9ffcb50be6203p-13,
                          0x1.7a4bbe998b249p-19);
}

template <Float32 F> OXRT_INLINE F sinh(F x) {
    using D = DoubleOf<F>;
    const D wide = convert<double>(clampForExponential(x, -120.0f, 120.0f));
    const D e = exponential(wide);
    return convert<float>(select(abs(wide) < D(1.0), smallHyperbolicSine(wide), (e - D(1.0) / e) * D(0.5)));
}

template <Float32 F> OXRT_INLINE F cosh(F x) {
    using D = DoubleOf<F>;
    const D e = exponential(convert<double>(clampForExponential(x, -120.0f, 120.0f)));
    return convert<float>((e + D(1.0) / e) * D(0.5));
}

template <Float32 F> OXRT_INLINE F tanh(F x) {
    using D = DoubleOf<F>;
    const D wide = convert<double>(clampForExponential(x, -20.0f, 20.0f));
    const D e = exponential(wide);
    const D inverse = D(1.0) / e;
    const D s = select(abs(wide) < D(1.0), smallHyperbolicSine(wide), (e - inverse) * D(0.5));
    return convert<float>(s / ((e + inverse) * D(0.5)));
}

template <Float32 F> OXRT_INLINE F rsqrt(F x) { return convert<float>(DoubleOf<F>(1.0) / sqrt(convert<double>(x))); }

template <Float32 F> OXRT_INLINE F hypot(F x, F y) {
    const auto a = convert<double>(x);
    const auto b = convert<double>(y);
    const F infinite = F(float(infinity));
    return select((abs(x) == infinite) | (abs(y) == infinite), infinite, F(convert<float>(sqrt(a * a + b * b))));
}

}  // namespace precise
}  // namespace OXRT_ISA
}  // namespace oxrt

#ifdef __clang__
#pragma clang diagnostic pop
#endif

#endif
