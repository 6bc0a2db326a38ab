/* Maths that is rarer than math.h's: bits, lengths, and 3x3 matrices. Written once for scalars and lanes. */
#ifndef OXRT_MATH_GEOMETRY_H
#define OXRT_MATH_GEOMETRY_H

#include <oxrt/math.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* ---- bits ---------------------------------------------------------------------------------------------------------------------- */

/* Bit 0 becomes bit 31. */
template <Number U> requires isSame<ElementOf<U>, uint32_t> OXRT_INLINE U reverseBits(U x) {
    const auto swapped = [](U value, uint32_t mask, uint32_t distance) {
        return ((value >> U(distance)) & U(mask)) | ((value & U(mask)) << U(distance));
    };
    x = swapped(x, 0x55555555u, 1u);
    x = swapped(x, 0x33333333u, 2u);
    x = swapped(x, 0x0F0F0F0Fu, 4u);
    x = swapped(x, 0x00FF00FFu, 8u);
    return (x >> U(16u)) | (x << U(16u));
}

/* The upper word of the 64-bit product. */
template <Number A, Number B> OXRT_INLINE Common<A, B> mulHi(A a, B b) {
    using R = Common<A, B>;
    return mapLanes([](uint32_t x, uint32_t y) { return uint32_t((uint64_t(x) * y) >> 32); }, R(a), R(b));
}

/* ---- numbers and vectors -------------------------------------------------------------------------------------------------------- */

/* a * b + c, rounded once. */
template <Number A, Number B, Number C> OXRT_INLINE auto fma(A a, B b, C c) {
    using R = Common<Common<A, B>, C>;
    if constexpr (isSame<ElementOf<R>, float>)
        return mapLanes([](float x, float y, float z) { return __builtin_fmaf(x, y, z); }, R(a), R(b), R(c));
    else
        return mapLanes([](double x, double y, double z) { return __builtin_fma(x, y, z); }, R(a), R(b), R(c));
}
template <class A, class B, class C> requires(IsVector<A> || IsVector<B> || IsVector<C>)
OXRT_INLINE auto fma(const A& a, const B& b, const C& c) {
    constexpr int size = commonSize<A, B> > vectorSize<C> ? commonSize<A, B> : vectorSize<C>;
    return mapComponents<size>([](auto x, auto y, auto z) { return fma(x, y, z); }, a, b, c);
}

template <class T, int N> OXRT_INLINE T lengthSquared(const Vector<T, N>& v) { return dot(v, v); }

/* n where it points against i as `reference` does, else -n. */
template <class A, class B, class C, int N>
OXRT_INLINE Vector<Common<Common<A, B>, C>, N> faceforward(const Vector<A, N>& n, const Vector<B, N>& i, const Vector<C, N>& reference) {
    using R = Common<Common<A, B>, C>;
    const Vector<R, N> normal(n);
    return select(R(dot(reference, i)) < R(ElementOf<R>(0)), normal, -normal);
}

/* ---- matrices -------------------------------------------------------------------------------------------------------------------- */

template <class T> OXRT_INLINE Matrix<T, 3, 3> transpose(const Matrix<T, 3, 3>& m) {
    return {{{m[0].x, m[1].x, m[2].x}, {m[0].y, m[1].y, m[2].y}, {m[0].z, m[1].z, m[2].z}}};
}
template <class T> OXRT_INLINE T determinant(const Matrix<T, 3, 3>& m) { return dot(m[0], cross(m[1], m[2])); }
/* By cofactors; infinite or NaN where there is no inverse. */
template <class T> OXRT_INLINE Matrix<T, 3, 3> inverse(const Matrix<T, 3, 3>& m) {
    const Matrix<T, 3, 3> cofactors = {{cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])}};
    const T scale = T(ElementOf<T>(1)) / dot(m[0], cofactors[0]);
    const Matrix<T, 3, 3> adjugate = transpose(cofactors);
    return {{adjugate[0] * scale, adjugate[1] * scale, adjugate[2] * scale}};
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
