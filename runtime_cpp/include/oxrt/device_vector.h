/* Vectors and matrices of shader programs: float3, uint2, float3x4 ...
 *
 * Templates on the component, so that one definition serves scalars and lanes: Vec3<float> is float3, Vec3<lanes of float> a packet of
 * them. Operators take mixed components (uniform with varying); the result has whatever component the scalar operator gives. All are
 * aggregates without padding, aligned as their component.
 */
#ifndef OXRT_DEVICE_VECTOR_H
#define OXRT_DEVICE_VECTOR_H

#include <stdint.h>

namespace oxrt {

using uint = uint32_t;

/* Whether T can be a component of a vector; lanes.h adds its own types. */
template <class T> inline constexpr bool isComponent = false;
template <> inline constexpr bool isComponent<bool> = true;
template <> inline constexpr bool isComponent<int32_t> = true;
template <> inline constexpr bool isComponent<uint32_t> = true;
template <> inline constexpr bool isComponent<int64_t> = true;
template <> inline constexpr bool isComponent<uint64_t> = true;
template <> inline constexpr bool isComponent<float> = true;
template <> inline constexpr bool isComponent<double> = true;

template <class T> struct Vec2 {
    using Component = T;
    static constexpr int size = 2;
    T x, y;
};

template <class T> struct Vec3 {
    using Component = T;
    static constexpr int size = 3;
    T x, y, z;
};

template <class T> struct Vec4 {
    using Component = T;
    static constexpr int size = 4;
    T x, y, z, w;
};

/* Element-wise results of a function of one or two components. */
template <class F, class A> constexpr auto map(Vec2<A> a, F f) { return Vec2<decltype(f(a.x))>{f(a.x), f(a.y)}; }
template <class F, class A> constexpr auto map(Vec3<A> a, F f) { return Vec3<decltype(f(a.x))>{f(a.x), f(a.y), f(a.z)}; }
template <class F, class A> constexpr auto map(Vec4<A> a, F f) { return Vec4<decltype(f(a.x))>{f(a.x), f(a.y), f(a.z), f(a.w)}; }

template <class F, class A, class B> constexpr auto map(Vec2<A> a, Vec2<B> b, F f) {
    return Vec2<decltype(f(a.x, b.x))>{f(a.x, b.x), f(a.y, b.y)};
}
template <class F, class A, class B> constexpr auto map(Vec3<A> a, Vec3<B> b, F f) {
    return Vec3<decltype(f(a.x, b.x))>{f(a.x, b.x), f(a.y, b.y), f(a.z, b.z)};
}
template <class F, class A, class B> constexpr auto map(Vec4<A> a, Vec4<B> b, F f) {
    return Vec4<decltype(f(a.x, b.x))>{f(a.x, b.x), f(a.y, b.y), f(a.z, b.z), f(a.w, b.w)};
}

/* vector op vector, vector op scalar, scalar op vector for all three sizes. */
#define OXRT_VECTOR_OPERATOR(OP)                                                                                               \
    template <class A, class B> constexpr auto operator OP(Vec2<A> a, Vec2<B> b) {                                              \
        return Vec2<decltype(a.x OP b.x)>{a.x OP b.x, a.y OP b.y};                                                              \
    }                                                                                                                           \
    template <class A, class B> constexpr auto operator OP(Vec3<A> a, Vec3<B> b) {                                              \
        return Vec3<decltype(a.x OP b.x)>{a.x OP b.x, a.y OP b.y, a.z OP b.z};                                                  \
    }                                                                                                                           \
    template <class A, class B> constexpr auto operator OP(Vec4<A> a, Vec4<B> b) {                                              \
        return Vec4<decltype(a.x OP b.x)>{a.x OP b.x, a.y OP b.y, a.z OP b.z, a.w OP b.w};                                      \
    }                                                                                                                           \
    template <class A, class B> requires isComponent<B> constexpr auto operator OP(Vec2<A> a, B b) {                            \
        return Vec2<decltype(a.x OP b)>{a.x OP b, a.y OP b};                                                                    \
    }                                                                                                                           \
    template <class A, class B> requires isComponent<B> constexpr auto operator OP(Vec3<A> a, B b) {                            \
        return Vec3<decltype(a.x OP b)>{a.x OP b, a.y OP b, a.z OP b};                                                          \
    }                                                                                                                           \
    template <class A, class B> requires isComponent<B> constexpr auto operator OP(Vec4<A> a, B b) {                            \
        return Vec4<decltype(a.x OP b)>{a.x OP b, a.y OP b, a.z OP b, a.w OP b};                                                \
    }                                                                                                                           \
    template <class A, class B> requires isComponent<A> constexpr auto operator OP(A a, Vec2<B> b) {                            \
        return Vec2<decltype(a OP b.x)>{a OP b.x, a OP b.y};                                                                    \
    }                                                                                                                           \
    template <class A, class B> requires isComponent<A> constexpr auto operator OP(A a, Vec3<B> b) {                            \
        return Vec3<decltype(a OP b.x)>{a OP b.x, a OP b.y, a OP b.z};                                                          \
    }                                                                                                                           \
    template <class A, class B> requires isComponent<A> constexpr auto operator OP(A a, Vec4<B> b) {                            \
        return Vec4<decltype(a OP b.x)>{a OP b.x, a OP b.y, a OP b.z, a OP b.w};                                                \
    }

OXRT_VECTOR_OPERATOR(+)
OXRT_VECTOR_OPERATOR(-)
OXRT_VECTOR_OPERATOR(*)
OXRT_VECTOR_OPERATOR(/)
OXRT_VECTOR_OPERATOR(&)
OXRT_VECTOR_OPERATOR(|)
OXRT_VECTOR_OPERATOR(^)
#undef OXRT_VECTOR_OPERATOR

template <class A> constexpr Vec2<A> operator-(Vec2<A> a) { return {-a.x, -a.y}; }
template <class A> constexpr Vec3<A> operator-(Vec3<A> a) { return {-a.x, -a.y, -a.z}; }
template <class A> constexpr Vec4<A> operator-(Vec4<A> a) { return {-a.x, -a.y, -a.z, -a.w}; }
template <class A> constexpr Vec2<A> operator~(Vec2<A> a) { return {~a.x, ~a.y}; }
template <class A> constexpr Vec3<A> operator~(Vec3<A> a) { return {~a.x, ~a.y, ~a.z}; }
template <class A> constexpr Vec4<A> operator~(Vec4<A> a) { return {~a.x, ~a.y, ~a.z, ~a.w}; }

/* True where all components are equal: one bool, or one mask of lanes. */
template <class A, class B> constexpr auto operator==(Vec2<A> a, Vec2<B> b) { return (a.x == b.x) & (a.y == b.y); }
template <class A, class B> constexpr auto operator==(Vec3<A> a, Vec3<B> b) { return (a.x == b.x) & (a.y == b.y) & (a.z == b.z); }
template <class A, class B> constexpr auto operator==(Vec4<A> a, Vec4<B> b) {
    return (a.x == b.x) & (a.y == b.y) & (a.z == b.z) & (a.w == b.w);
}
template <class A, class B> constexpr auto operator!=(Vec2<A> a, Vec2<B> b) { return (a.x != b.x) | (a.y != b.y); }
template <class A, class B> constexpr auto operator!=(Vec3<A> a, Vec3<B> b) { return (a.x != b.x) | (a.y != b.y) | (a.z != b.z); }
template <class A, class B> constexpr auto operator!=(Vec4<A> a, Vec4<B> b) {
    return (a.x != b.x) | (a.y != b.y) | (a.z != b.z) | (a.w != b.w);
}

/* ---- names ---------------------------------------------------------------------------------------------------------------------- */

/* A 16-bit float in memory; arithmetic happens after reading it as float. */
struct half {
    uint16_t bits;
    half() = default;
    half(float value) {
        _Float16 narrow = static_cast<_Float16>(value);
        __builtin_memcpy(&bits, &narrow, 2);
    }
    operator float() const {
        _Float16 narrow;
        __builtin_memcpy(&narrow, &bits, 2);
        return static_cast<float>(narrow);
    }
};

#define OXRT_VECTOR_NAMES(NAME, COMPONENT)                                                                                     \
    using NAME##2 = Vec2<COMPONENT>;                                                                                            \
    using NAME##3 = Vec3<COMPONENT>;                                                                                            \
    using NAME##4 = Vec4<COMPONENT>;

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

/* ---- matrices ------------------------------------------------------------------------------------------------------------------- */

/* Row by row in memory; rows[i] is row i. */
template <class T> struct Mat3x3 {
    Vec3<T> rows[3];
};
template <class T> struct Mat3x4 {
    Vec4<T> rows[3];
};
template <class T> struct Mat4x4 {
    Vec4<T> rows[4];
};

using float3x3 = Mat3x3<float>;
using float3x4 = Mat3x4<float>;
using float4x4 = Mat4x4<float>;

} // namespace oxrt
#endif
