/* The mathematics of device code: every function of the manual's table, for scalars, lanes, and vectors of either.
 *
 * Precise mode (the default) is within 1 ulp for float32 and gives the same bits in scalar and SPMD kernels; with OXRT_FAST_MATH
 * defined, float32 functions are within 4 ulp. float64 functions are libm's. docs/math.md lists measured errors and times.
 */
#ifndef OXRT_MATH_H
#define OXRT_MATH_H

#include <oxrt/math_fast.h>
#include <oxrt/math_precise.h>

#ifdef __clang__
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wbitwise-instead-of-logical" /* & and | of masks: lanes have no && */
#endif

namespace oxrt {
inline namespace OXRT_ISA {

/* ---- one number --------------------------------------------------------------------------------------------------------------- */

#ifdef OXRT_FAST_MATH
namespace chosen = fast;
#else
namespace chosen = precise;
#endif

/* float32 from the chosen set, float64 from libm, lane by lane. */
#define OXRT_MATH_1(name)                                                                                              \
    template <Float32 F> OXRT_INLINE F name(F x) { return chosen::name(x); }                                           \
    template <Float64 F> OXRT_INLINE F name(F x) {                                                                     \
        return mapLanes([](double v) { return __builtin_##name(v); }, x);                                              \
    }
#define OXRT_MATH_2(name)                                                                                              \
    template <Float32 A, Float32 B> OXRT_INLINE Common<A, B> name(A x, B y) {                                          \
        return chosen::name(Common<A, B>(x), Common<A, B>(y));                                                         \
    }                                                                                                                  \
    template <Float64 A, Float64 B> OXRT_INLINE Common<A, B> name(A x, B y) {                                          \
        return mapLanes([](double v, double w) { return __builtin_##name(v, w); }, Common<A, B>(x), Common<A, B>(y));  \
    }
OXRT_MATH_1(sin)
OXRT_MATH_1(cos)
OXRT_MATH_1(tan)
OXRT_MATH_1(asin)
OXRT_MATH_1(acos)
OXRT_MATH_1(atan)
OXRT_MATH_1(sinh)
OXRT_MATH_1(cosh)
OXRT_MATH_1(tanh)
OXRT_MATH_1(exp)
OXRT_MATH_1(exp2)
OXRT_MATH_1(log)
OXRT_MATH_1(log2)
OXRT_MATH_1(log10)
OXRT_MATH_2(pow)
OXRT_MATH_2(atan2)
OXRT_MATH_2(hypot)
#undef OXRT_MATH_1
#undef OXRT_MATH_2

template <Float32 F> OXRT_INLINE F rsqrt(F x) { return chosen::rsqrt(x); }
template <Float64 F> OXRT_INLINE F rsqrt(F x) { return F(1.0) / sqrt(x); }

/* `a if a < b else b` and `a if a > b else b`: the second operand where either is NaN, and of two zeros. */
template <Number A, Number B> OXRT_INLINE Common<A, B> min(A a, B b) { return minimum(Common<A, B>(a), Common<A, B>(b)); }
template <Number A, Number B> OXRT_INLINE Common<A, B> max(A a, B b) { return maximum(Common<A, B>(a), Common<A, B>(b)); }

/* max(low, min(x, high)), so that NaN gives high. */
template <Number A, Number B, Number C> OXRT_INLINE auto clamp(A x, B low, C high) { return max(low, min(x, high)); }

/* x limited to [0, 1]; NaN gives 1, as clamp does. */
template <FloatNumber F> OXRT_INLINE F saturate(F x) { return clamp(x, F(ElementOf<F>(0)), F(ElementOf<F>(1))); }

/* a + t * (b - a). */
template <FloatNumber A, FloatNumber B, FloatNumber C> OXRT_INLINE Common<Common<A, B>, C> lerp(A a, B b, C t) {
    using R = Common<Common<A, B>, C>;
    return R(a) + R(t) * R(Common<A, B>(b) - Common<A, B>(a));
}
template <FloatNumber A, FloatNumber B, FloatNumber C> OXRT_INLINE auto mix(A a, B b, C t) { return lerp(a, b, t); }

/* 0 below the edge, 1 from it on. */
template <FloatNumber A, FloatNumber B> OXRT_INLINE Common<A, B> step(A edge, B x) {
    using R = Common<A, B>;
    return select(R(x) < R(edge), R(ElementOf<R>(0)), R(ElementOf<R>(1)));
}

/* 3 t^2 - 2 t^3 of t = clamp((x - low) / (high - low), 0, 1). */
template <FloatNumber A, FloatNumber B, FloatNumber C> OXRT_INLINE Common<Common<A, B>, C> smoothstep(A low, B high, C x) {
    using R = Common<Common<A, B>, C>;
    using E = ElementOf<R>;
    const R t = clamp((R(x) - R(low)) / R(Common<A, B>(high) - Common<A, B>(low)), R(E(0)), R(E(1)));
    return t * t * (R(E(3)) - R(E(2)) * t);
}

/* -1, 0 or 1; NaN gives 0. */
template <Number T> OXRT_INLINE T sign(T x) {
    using E = ElementOf<T>;
    const T positive = select(x > T(E(0)), T(E(1)), T(E(0)));
    if constexpr (isSigned<E>)
        return select(x < T(E(0)), T(E(-1)), positive);
    else
        return positive;
}

/* x - floor(x). */
template <FloatNumber F> OXRT_INLINE F fract(F x) { return x - floor(x); }
template <FloatNumber F> OXRT_INLINE F radians(F degrees) { return degrees * F(ElementOf<F>(0.017453292519943295)); }
template <FloatNumber F> OXRT_INLINE F degrees(F radians) { return radians * F(ElementOf<F>(57.29577951308232)); }

template <FloatNumber F> OXRT_INLINE MaskOf<F> isnan(F x) { return x != x; }
template <FloatNumber F> OXRT_INLINE MaskOf<F> isinf(F x) { return abs(x) == F(ElementOf<F>(__builtin_inf())); }
template <FloatNumber F> OXRT_INLINE MaskOf<F> isfinite(F x) { return abs(x) < F(ElementOf<F>(__builtin_inf())); }

/* The remainder of x / y towards zero, exact; NaN for y = 0. */
template <FloatNumber A, FloatNumber B> OXRT_INLINE Common<A, B> fmod(A x, B y) {
    using R = Common<A, B>;
    if constexpr (isSame<ElementOf<R>, float>)
        return mapLanes([](float v, float w) { return __builtin_fmodf(v, w); }, R(x), R(y));
    else
        return mapLanes([](double v, double w) { return __builtin_fmod(v, w); }, R(x), R(y));
}

/* Python's float % and //: the remainder has the sign of the divisor; division by zero gives NaN and a / 0. */
template <FloatNumber T> OXRT_INLINE T modulo(T a, T b) {
    const T zero = T(ElementOf<T>(0));
    const T rest = fmod(a, b);
    const MaskOf<T> differs = (rest != zero) & ((rest < zero) != (b < zero));
    return select(rest == zero, copysign(zero, b), select(differs, rest + b, rest));
}
template <FloatNumber T> OXRT_INLINE T floorDivide(T a, T b) {
    using E = ElementOf<T>;
    const T zero = T(E(0));
    const T rest = fmod(a, b);
    const MaskOf<T> differs = (rest != zero) & ((rest < zero) != (b < zero));
    const T exact = (a - rest) / b - select(differs, T(E(1)), zero);
    const T low = floor(exact);
    const T near = select(exact - low > T(E(0.5)), low + T(E(1)), low);
    return select(b == zero, a / b, select(exact == zero, copysign(zero, a / b), near));
}

/* ** of floats is pow; of integers repeated multiplication. */
template <FloatNumber A, FloatNumber B> OXRT_INLINE Common<A, B> power(A base, B exponent) { return pow(base, exponent); }
template <IntegerNumber A, IntegerNumber B> OXRT_INLINE Common<A, B> power(A base, B exponent) {
    return mapLanes([](ElementOf<A> b, ElementOf<A> e) { return integerPower(b, e); }, Common<A, B>(base), Common<A, B>(exponent));
}

/* ---- vectors, component by component ------------------------------------------------------------------------------------------ */

#define OXRT_ELEMENTWISE_1(name)                                                                                       \
    template <class T, int N> OXRT_INLINE auto name(const Vector<T, N>& v) {                                           \
        return mapComponents<N>([](T x) { return name(x); }, v);                                                       \
    }
OXRT_ELEMENTWISE_1(sqrt)
OXRT_ELEMENTWISE_1(rsqrt)
OXRT_ELEMENTWISE_1(sin)
OXRT_ELEMENTWISE_1(cos)
OXRT_ELEMENTWISE_1(tan)
OXRT_ELEMENTWISE_1(asin)
OXRT_ELEMENTWISE_1(acos)
OXRT_ELEMENTWISE_1(atan)
OXRT_ELEMENTWISE_1(sinh)
OXRT_ELEMENTWISE_1(cosh)
OXRT_ELEMENTWISE_1(tanh)
OXRT_ELEMENTWISE_1(exp)
OXRT_ELEMENTWISE_1(exp2)
OXRT_ELEMENTWISE_1(log)
OXRT_ELEMENTWISE_1(log2)
OXRT_ELEMENTWISE_1(log10)
OXRT_ELEMENTWISE_1(floor)
OXRT_ELEMENTWISE_1(ceil)
OXRT_ELEMENTWISE_1(round)
OXRT_ELEMENTWISE_1(trunc)
OXRT_ELEMENTWISE_1(fract)
OXRT_ELEMENTWISE_1(saturate)
OXRT_ELEMENTWISE_1(abs)
OXRT_ELEMENTWISE_1(sign)
OXRT_ELEMENTWISE_1(radians)
OXRT_ELEMENTWISE_1(degrees)
OXRT_ELEMENTWISE_1(isnan)
OXRT_ELEMENTWISE_1(isinf)
OXRT_ELEMENTWISE_1(isfinite)
OXRT_ELEMENTWISE_1(popcount)
OXRT_ELEMENTWISE_1(clz)
OXRT_ELEMENTWISE_1(ctz)
OXRT_ELEMENTWISE_1(floatAsUint)
OXRT_ELEMENTWISE_1(floatAsInt)
OXRT_ELEMENTWISE_1(uintAsFloat)
OXRT_ELEMENTWISE_1(intAsFloat)
#undef OXRT_ELEMENTWISE_1

/* Vectors of one size with each other, or with a number that stands for all components. */
template <class A, class B> inline constexpr int commonSize = vectorSize<A> > vectorSize<B> ? vectorSize<A> : vectorSize<B>;

#define OXRT_ELEMENTWISE_2(name)                                                                                       \
    template <class A, class B> requires(IsVector<A> || IsVector<B>) OXRT_INLINE auto name(const A& a, const B& b) {   \
        return mapComponents<commonSize<A, B>>([](auto x, auto y) { return name(x, y); }, a, b);                       \
    }
OXRT_ELEMENTWISE_2(pow)
OXRT_ELEMENTWISE_2(power)
OXRT_ELEMENTWISE_2(atan2)
OXRT_ELEMENTWISE_2(hypot)
OXRT_ELEMENTWISE_2(fmod)
OXRT_ELEMENTWISE_2(min)
OXRT_ELEMENTWISE_2(max)
OXRT_ELEMENTWISE_2(step)
OXRT_ELEMENTWISE_2(copysign)
OXRT_ELEMENTWISE_2(modulo)
OXRT_ELEMENTWISE_2(floorDivide)
OXRT_ELEMENTWISE_2(shiftLeft)
OXRT_ELEMENTWISE_2(shiftRight)
#undef OXRT_ELEMENTWISE_2

#define OXRT_ELEMENTWISE_3(name)                                                                                       \
    template <class A, class B, class C> requires(IsVector<A> || IsVector<B> || IsVector<C>)                           \
    OXRT_INLINE auto name(const A& a, const B& b, const C& c) {                                                        \
        return mapComponents<(commonSize<A, B> > vectorSize<C> ? commonSize<A, B> : vectorSize<C>)>(                   \
            [](auto x, auto y, auto z) { return name(x, y, z); }, a, b, c);                                            \
    }
OXRT_ELEMENTWISE_3(clamp)
OXRT_ELEMENTWISE_3(lerp)
OXRT_ELEMENTWISE_3(mix)
OXRT_ELEMENTWISE_3(smoothstep)
#undef OXRT_ELEMENTWISE_3

template <class M, class T, int N> OXRT_INLINE Vector<T, N> select(M mask, const Vector<T, N>& ifTrue, const Vector<T, N>& ifFalse) {
    return mapComponents<N>([mask](T x, T y) { return select(mask, x, y); }, ifTrue, ifFalse);
}

/* ---- geometry ----------------------------------------------------------------------------------------------------------------- */

template <class A, class B, int N> OXRT_INLINE Common<A, B> dot(const Vector<A, N>& a, const Vector<B, N>& b) {
    using R = Common<A, B>;
    R sum = R(a.x) * R(b.x);
    for (int i = 1; i < N; ++i)
        sum = sum + R(a[i]) * R(b[i]);
    return sum;
}

template <class A, class B> OXRT_INLINE Vector<Common<A, B>, 3> cross(const Vector<A, 3>& a, const Vector<B, 3>& b) {
    using R = Common<A, B>;
    return {R(a.y) * R(b.z) - R(a.z) * R(b.y), R(a.z) * R(b.x) - R(a.x) * R(b.z), R(a.x) * R(b.y) - R(a.y) * R(b.x)};
}

template <class T, int N> OXRT_INLINE T length(const Vector<T, N>& v) { return sqrt(dot(v, v)); }
template <class A, class B, int N> OXRT_INLINE Common<A, B> distance(const Vector<A, N>& a, const Vector<B, N>& b) { return length(a - b); }

/* v * (1 / length(v)); NaN for a zero vector. */
template <class T, int N> OXRT_INLINE Vector<T, N> normalize(const Vector<T, N>& v) { return v * (T(ElementOf<T>(1)) / length(v)); }

/* The mirror image of the incident direction i about the normal n: i - 2 dot(n, i) n. */
template <class A, class B, int N> OXRT_INLINE Vector<Common<A, B>, N> reflect(const Vector<A, N>& i, const Vector<B, N>& n) {
    using R = Common<A, B>;
    return i - n * (R(ElementOf<R>(2)) * dot(n, i));
}

/* The refracted direction of GLSL for unit i and n and eta = outside over inside; zero under total reflection. */
template <class A, class B, Number C, int N>
OXRT_INLINE Vector<Common<Common<A, B>, C>, N> refract(const Vector<A, N>& i, const Vector<B, N>& n, C eta) {
    using R = Common<Common<A, B>, C>;
    using E = ElementOf<R>;
    const R cosine = R(dot(n, i));
    const R k = R(E(1)) - R(eta) * R(eta) * (R(E(1)) - cosine * cosine);
    const Vector<R, N> bent = Vector<R, N>(i) * R(eta) - Vector<R, N>(n) * (R(eta) * cosine + sqrt(max(k, R(E(0)))));
    return select(k < R(E(0)), Vector<R, N>(R(E(0))), bent);
}

/* Of a vector of bools: whether one, or every component is true. */
template <class T, int N> OXRT_INLINE T any(const Vector<T, N>& v) {
    T result = v.x;
    for (int i = 1; i < N; ++i)
        result = result | v[i];
    return result;
}
template <class T, int N> OXRT_INLINE T all(const Vector<T, N>& v) {
    T result = v.x;
    for (int i = 1; i < N; ++i)
        result = result & v[i];
    return result;
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#ifdef __clang__
#pragma clang diagnostic pop
#endif

#endif
