/* Numbers, vectors and matrices of device code.
 *
 * A number is a C++ scalar (one launch index) or a `Lanes<T, W>` of lanes.h (W of them); vectors and matrices are templates over the
 * number, so that scalar and SPMD kernels share one definition of everything. No C++ standard header is included: each would cost more
 * than compiling a kernel.
 */
#ifndef OXRT_VECTORS_H
#define OXRT_VECTORS_H

#include <stdint.h>

/* Without optimisation calls stay calls: inlined everywhere, packets take six times as long to compile and gdb steps into every operator. */
#ifdef __OPTIMIZE__
#define OXRT_INLINE inline __attribute__((always_inline))
#else
#define OXRT_INLINE inline
#endif

/* Objects compiled for different instruction sets are linked into one library: each has its own namespace, lest their inline functions
   be merged. The names stay `oxrt::...`. */
#ifndef OXRT_ISA
#define OXRT_ISA isa_default
#endif

namespace oxrt {
inline namespace OXRT_ISA {

/* ---- numbers ------------------------------------------------------------------------------------------------------------------ */

#if defined(__aarch64__) && !defined(__clang__) && __GNUC__ < 13
using half = __fp16; /* _Float16 came to this g++ later */
#else
using half = _Float16;
#endif

/* What a number is made of. `Rebind<U>` is a number of as many lanes with elements U. Specialised for Lanes in lanes.h. */
template <class N> struct NumberTraits {
    static constexpr bool isNumber = false;
};

template <class T> struct ScalarTraits {
    static constexpr bool isNumber = true;
    static constexpr int lanes = 1;
    using Element = T;
    template <class U> using Rebind = U;
};

template <> struct NumberTraits<bool> : ScalarTraits<bool> {};
template <> struct NumberTraits<int8_t> : ScalarTraits<int8_t> {};
template <> struct NumberTraits<uint8_t> : ScalarTraits<uint8_t> {};
template <> struct NumberTraits<int16_t> : ScalarTraits<int16_t> {};
template <> struct NumberTraits<uint16_t> : ScalarTraits<uint16_t> {};
template <> struct NumberTraits<int32_t> : ScalarTraits<int32_t> {};
template <> struct NumberTraits<uint32_t> : ScalarTraits<uint32_t> {};
template <> struct NumberTraits<int64_t> : ScalarTraits<int64_t> {};
template <> struct NumberTraits<uint64_t> : ScalarTraits<uint64_t> {};
template <> struct NumberTraits<half> : ScalarTraits<half> {};
template <> struct NumberTraits<float> : ScalarTraits<float> {};
template <> struct NumberTraits<double> : ScalarTraits<double> {};

template <class N> concept Number = NumberTraits<N>::isNumber;
template <class N> using ElementOf = typename NumberTraits<N>::Element;
template <class N, class U> using Rebind = typename NumberTraits<N>::template Rebind<U>;
template <class N> using MaskOf = Rebind<N, bool>;

template <class A, class B> inline constexpr bool isSame = false;
template <class A> inline constexpr bool isSame<A, A> = true;
template <class T> inline constexpr bool isFloating = isSame<T, float> || isSame<T, double> || isSame<T, half>;
template <class T> inline constexpr bool isSigned = T(-1) < T(0);

/* The number that holds both: of equal elements, the one with lanes. Mixed elements are an error of the caller. */
template <class A, class B> struct CommonNumber {};
template <class A> struct CommonNumber<A, A> {
    using Type = A;
};
template <class A, class B> using Common = typename CommonNumber<A, B>::Type;

template <bool condition, class A, class B> struct ChooseType {
    using Type = A;
};
template <class A, class B> struct ChooseType<false, A, B> {
    using Type = B;
};

/* ---- vectors ------------------------------------------------------------------------------------------------------------------ */

/* N numbers named x y z w; aligned as one of them. */
template <class T, int N> struct Vector;

template <class T> struct Vector<T, 2> {
    T x, y;
    Vector() = default;
    OXRT_INLINE constexpr explicit Vector(T all) : x(all), y(all) {}
    OXRT_INLINE constexpr Vector(T x_, T y_) : x(x_), y(y_) {}
    template <class U> requires(!isSame<T, U>&& isSame<T, Common<T, U>>)
    OXRT_INLINE constexpr Vector(const Vector<U, 2>& v) : x(v.x), y(v.y) {}
    OXRT_INLINE constexpr T& operator[](int i) { return i == 0 ? x : y; }
    OXRT_INLINE constexpr const T& operator[](int i) const { return i == 0 ? x : y; }
};

template <class T> struct Vector<T, 3> {
    T x, y, z;
    Vector() = default;
    OXRT_INLINE constexpr explicit Vector(T all) : x(all), y(all), z(all) {}
    OXRT_INLINE constexpr Vector(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
    OXRT_INLINE constexpr Vector(Vector<T, 2> v, T z_) : x(v.x), y(v.y), z(z_) {}
    OXRT_INLINE constexpr Vector(T x_, Vector<T, 2> v) : x(x_), y(v.x), z(v.y) {}
    template <class U> requires(!isSame<T, U>&& isSame<T, Common<T, U>>)
    OXRT_INLINE constexpr Vector(const Vector<U, 3>& v) : x(v.x), y(v.y), z(v.z) {}
    OXRT_INLINE constexpr T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
    OXRT_INLINE constexpr const T& operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
};

template <class T> struct Vector<T, 4> {
    T x, y, z, w;
    Vector() = default;
    OXRT_INLINE constexpr explicit Vector(T all) : x(all), y(all), z(all), w(all) {}
    OXRT_INLINE constexpr Vector(T x_, T y_, T z_, T w_) : x(x_), y(y_), z(z_), w(w_) {}
    OXRT_INLINE constexpr Vector(Vector<T, 3> v, T w_) : x(v.x), y(v.y), z(v.z), w(w_) {}
    OXRT_INLINE constexpr Vector(T x_, Vector<T, 3> v) : x(x_), y(v.x), z(v.y), w(v.z) {}
    OXRT_INLINE constexpr Vector(Vector<T, 2> a, Vector<T, 2> b) : x(a.x), y(a.y), z(b.x), w(b.y) {}
    OXRT_INLINE constexpr Vector(Vector<T, 2> v, T z_, T w_) : x(v.x), y(v.y), z(z_), w(w_) {}
    OXRT_INLINE constexpr Vector(T x_, Vector<T, 2> v, T w_) : x(x_), y(v.x), z(v.y), w(w_) {}
    OXRT_INLINE constexpr Vector(T x_, T y_, Vector<T, 2> v) : x(x_), y(y_), z(v.x), w(v.y) {}
    template <class U> requires(!isSame<T, U>&& isSame<T, Common<T, U>>)
    OXRT_INLINE constexpr Vector(const Vector<U, 4>& v) : x(v.x), y(v.y), z(v.z), w(v.w) {}
    OXRT_INLINE constexpr T& operator[](int i) { return i == 0 ? x : i == 1 ? y : i == 2 ? z : w; }
    OXRT_INLINE constexpr const T& operator[](int i) const { return i == 0 ? x : i == 1 ? y : i == 2 ? z : w; }
};

/* rows x columns numbers, row by row; m[i] is row i. */
template <class T, int ROWS, int COLUMNS> struct Matrix {
    Vector<T, COLUMNS> rows[ROWS];
    OXRT_INLINE constexpr Vector<T, COLUMNS>& operator[](int i) { return rows[i]; }
    OXRT_INLINE constexpr const Vector<T, COLUMNS>& operator[](int i) const { return rows[i]; }
};

#define OXRT_VECTOR_NAMES(name, type) \
    using name##2 = Vector<type, 2>;  \
    using name##3 = Vector<type, 3>;  \
    using name##4 = Vector<type, 4>;
OXRT_VECTOR_NAMES(bool, bool)
OXRT_VECTOR_NAMES(char, int8_t)
OXRT_VECTOR_NAMES(uchar, uint8_t)
OXRT_VECTOR_NAMES(short, int16_t)
OXRT_VECTOR_NAMES(ushort, uint16_t)
OXRT_VECTOR_NAMES(int, int32_t)
OXRT_VECTOR_NAMES(uint, uint32_t)
OXRT_VECTOR_NAMES(longlong, int64_t)
OXRT_VECTOR_NAMES(ulonglong, uint64_t)
OXRT_VECTOR_NAMES(half, half)
OXRT_VECTOR_NAMES(float, float)
OXRT_VECTOR_NAMES(double, double)
#undef OXRT_VECTOR_NAMES

using float3x3 = Matrix<float, 3, 3>;
using float3x4 = Matrix<float, 3, 4>;
using float4x4 = Matrix<float, 4, 4>;

template <class V> inline constexpr int vectorSize = 0;
template <class T, int N> inline constexpr int vectorSize<Vector<T, N>> = N;
template <class V> concept IsVector = vectorSize<V> > 0;

/* ---- element-wise ------------------------------------------------------------------------------------------------------------- */

/* Component i of a vector; a number stands for all of its components. */
template <Number T> OXRT_INLINE constexpr T component(const T& value, int) { return value; }
template <class T, int N> OXRT_INLINE constexpr T component(const Vector<T, N>& value, int i) { return value[i]; }

/* f applied to the components of vectors of one size, in which numbers are spread. */
template <int N, class F, class... A> OXRT_INLINE constexpr auto mapComponents(F f, const A&... a) {
    using R = decltype(f(component(a, 0)...));
    if constexpr (N == 2)
        return Vector<R, 2>(f(component(a, 0)...), f(component(a, 1)...));
    else if constexpr (N == 3)
        return Vector<R, 3>(f(component(a, 0)...), f(component(a, 1)...), f(component(a, 2)...));
    else
        return Vector<R, 4>(f(component(a, 0)...), f(component(a, 1)...), f(component(a, 2)...), f(component(a, 3)...));
}

#define OXRT_VECTOR_OPERATOR(op)                                                                                        \
    template <class A, class B, int N>                                                                                  \
    OXRT_INLINE constexpr Vector<Common<A, B>, N> operator op(const Vector<A, N>& a, const Vector<B, N>& b) {           \
        return mapComponents<N>([](Common<A, B> x, Common<A, B> y) { return Common<A, B>(x op y); }, a, b);             \
    }                                                                                                                   \
    template <class A, Number B, int N>                                                                                 \
    OXRT_INLINE constexpr Vector<Common<A, B>, N> operator op(const Vector<A, N>& a, const B& b) {                      \
        return mapComponents<N>([](Common<A, B> x, Common<A, B> y) { return Common<A, B>(x op y); }, a, b);             \
    }                                                                                                                   \
    template <Number A, class B, int N>                                                                                 \
    OXRT_INLINE constexpr Vector<Common<A, B>, N> operator op(const A& a, const Vector<B, N>& b) {                      \
        return mapComponents<N>([](Common<A, B> x, Common<A, B> y) { return Common<A, B>(x op y); }, a, b);             \
    }
OXRT_VECTOR_OPERATOR(+)
OXRT_VECTOR_OPERATOR(-)
OXRT_VECTOR_OPERATOR(*)
OXRT_VECTOR_OPERATOR(/)
OXRT_VECTOR_OPERATOR(&)
OXRT_VECTOR_OPERATOR(|)
OXRT_VECTOR_OPERATOR(^)
#undef OXRT_VECTOR_OPERATOR

template <class T, int N> OXRT_INLINE constexpr Vector<T, N> operator-(const Vector<T, N>& v) {
    return mapComponents<N>([](T x) { return T(-x); }, v);
}
template <class T, int N> OXRT_INLINE constexpr Vector<T, N> operator~(const Vector<T, N>& v) {
    return mapComponents<N>([](T x) { return T(~x); }, v);
}

/* True where all components are equal. */
template <class A, class B, int N> OXRT_INLINE constexpr MaskOf<Common<A, B>> operator==(const Vector<A, N>& a, const Vector<B, N>& b) {
    MaskOf<Common<A, B>> equal = Common<A, B>(a.x) == Common<A, B>(b.x);
    for (int i = 1; i < N; ++i)
        equal = equal & (Common<A, B>(a[i]) == Common<A, B>(b[i]));
    return equal;
}
template <class A, class B, int N> OXRT_INLINE constexpr MaskOf<Common<A, B>> operator!=(const Vector<A, N>& a, const Vector<B, N>& b) {
    return !(a == b);
}

/* v.zx is swizzle<2, 0>(v). */
template <int... I, class T, int N> OXRT_INLINE constexpr Vector<T, sizeof...(I)> swizzle(const Vector<T, N>& v) {
    return Vector<T, sizeof...(I)>(v[I]...);
}

/* ---- matrices ----------------------------------------------------------------------------------------------------------------- */

template <class A, class B, int R, int C>
OXRT_INLINE constexpr Vector<Common<A, B>, R> multiply(const Matrix<A, R, C>& m, const Vector<B, C>& v) {
    Vector<Common<A, B>, R> result;
    for (int i = 0; i < R; ++i) {
        Common<A, B> sum = Common<A, B>(m[i][0]) * v[0];
        for (int k = 1; k < C; ++k)
            sum = sum + Common<A, B>(m[i][k]) * v[k];
        result[i] = sum;
    }
    return result;
}

template <class A, class B, int R, int K, int C>
OXRT_INLINE constexpr Matrix<Common<A, B>, R, C> multiply(const Matrix<A, R, K>& a, const Matrix<B, K, C>& b) {
    Matrix<Common<A, B>, R, C> result;
    for (int i = 0; i < R; ++i)
        for (int j = 0; j < C; ++j) {
            Common<A, B> sum = Common<A, B>(a[i][0]) * b[0][j];
            for (int k = 1; k < K; ++k)
                sum = sum + Common<A, B>(a[i][k]) * b[k][j];
            result[i][j] = sum;
        }
    return result;
}

#define OXRT_MATRIX_OPERATOR(op)                                                                                        \
    template <class A, class B, int R, int C>                                                                           \
    OXRT_INLINE constexpr Matrix<Common<A, B>, R, C> operator op(const Matrix<A, R, C>& a, const Matrix<B, R, C>& b) {  \
        Matrix<Common<A, B>, R, C> result;                                                                              \
        for (int i = 0; i < R; ++i)                                                                                     \
            result[i] = a[i] op b[i];                                                                                   \
        return result;                                                                                                  \
    }
OXRT_MATRIX_OPERATOR(+)
OXRT_MATRIX_OPERATOR(-)
#undef OXRT_MATRIX_OPERATOR

template <class A, Number B, int R, int C>
OXRT_INLINE constexpr Matrix<Common<A, B>, R, C> operator*(const Matrix<A, R, C>& m, const B& x) {
    Matrix<Common<A, B>, R, C> result;
    for (int i = 0; i < R; ++i)
        result[i] = m[i] * x;
    return result;
}
template <Number A, class B, int R, int C>
OXRT_INLINE constexpr Matrix<Common<A, B>, R, C> operator*(const A& x, const Matrix<B, R, C>& m) {
    return m * x;
}
template <class T, int R, int C> OXRT_INLINE constexpr Matrix<T, R, C> operator-(const Matrix<T, R, C>& m) {
    Matrix<T, R, C> result;
    for (int i = 0; i < R; ++i)
        result[i] = -m[i];
    return result;
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
