/* Matrices of traversables at a time: OptiX guide, "Motion transforms"; keys are spread evenly over the range and clamp outside of it. */
#ifndef OXRT_DEVICE_MOTION_H
#define OXRT_DEVICE_MOTION_H

#include <oxrt/device_box.h>
#include <oxrt/device_thread.h>

namespace oxrt {
inline namespace OXRT_ISA {

enum MotionFlag : uint32_t { MOTION_START_VANISH = 1, MOTION_END_VANISH = 2 };

/* ---- 3x4 row-major matrices ------------------------------------------------------------------------------------------------------- */

OXRT_INLINE float3 transformPoint(const float* m, const float3& p) {
    return {m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
            m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]};
}
OXRT_INLINE float3 transformVector(const float* m, const float3& v) {
    return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[4] * v.x + m[5] * v.y + m[6] * v.z, m[8] * v.x + m[9] * v.y + m[10] * v.z};
}
/* `inverse` is the matrix of the opposite direction. */
OXRT_INLINE float3 transformNormal(const float* inverse, const float3& n) {
    const float* m = inverse;
    return {m[0] * n.x + m[4] * n.y + m[8] * n.z, m[1] * n.x + m[5] * n.y + m[9] * n.z, m[2] * n.x + m[6] * n.y + m[10] * n.z};
}

OXRT_INLINE float3x4 matrixFrom(const float* m) {
    return {{{m[0], m[1], m[2], m[3]}, {m[4], m[5], m[6], m[7]}, {m[8], m[9], m[10], m[11]}}};
}
OXRT_INLINE float3x4 identityTransform() { return {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}; }

struct Affine {
    float m[12];
};

/* The matrix that applies `inner` first. */
OXRT_INLINE Affine composed(const Affine& outer, const Affine& inner) {
    Affine result;
    for (int row = 0; row < 3; ++row) {
        const float* o = outer.m + 4 * row;
        for (int column = 0; column < 4; ++column)
            result.m[4 * row + column] = o[0] * inner.m[column] + o[1] * inner.m[4 + column] + o[2] * inner.m[8 + column];
        result.m[4 * row + 3] += o[3];
    }
    return result;
}

template <int LANE> OXRT_INLINE Quad spread(Quad quad) { return __builtin_shufflevector(quad, quad, LANE, LANE, LANE, LANE); }
OXRT_INLINE Quad crossed(Quad a, Quad b) {
    return __builtin_shufflevector(a, a, 1, 2, 0, 3) * __builtin_shufflevector(b, b, 2, 0, 1, 3) -
           __builtin_shufflevector(a, a, 2, 0, 1, 3) * __builtin_shufflevector(b, b, 1, 2, 0, 3);
}

/* A 3x4 matrix by columns. Points and vectors go through it as transformPoint and transformVector have them, step by step. */
struct Columns {
    Quad x, y, z, origin;

    OXRT_INLINE Quad vector(Quad v) const { return x * spread<0>(v) + y * spread<1>(v) + z * spread<2>(v); }
    OXRT_INLINE Quad point(Quad p) const { return vector(p) + origin; }
};
OXRT_INLINE Columns columnsOf(const float* m) {
    const Quad a = quadAt(m), b = quadAt(m + 4), c = quadAt(m + 8);
    const Quad low = __builtin_shufflevector(a, b, 0, 4, 1, 5), high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
    return {__builtin_shufflevector(low, c, 0, 1, 4, 4), __builtin_shufflevector(low, c, 2, 3, 5, 5),
            __builtin_shufflevector(high, c, 0, 1, 6, 6), __builtin_shufflevector(high, c, 2, 3, 7, 7)};
}

/* The inverse of the matrix with these rows; false where it is not finite. */
OXRT_INLINE bool inverted(Quad a, Quad b, Quad c, Columns& inverse) {
    const Quad minors = crossed(b, c);
    const Quad parts = a * minors;
    const float scale = 1.0f / (parts[0] + parts[1] + parts[2]);
    if (!(__builtin_fabsf(scale) < __builtin_inff()))
        return false;
    inverse.x = minors * scale;
    inverse.y = crossed(c, a) * scale;
    inverse.z = crossed(a, b) * scale;
    inverse.origin = -(inverse.x * spread<3>(a) + inverse.y * spread<3>(b) + inverse.z * spread<3>(c));
    return true;
}
OXRT_INLINE bool inverted(const Affine& matrix, Affine& inverse) {
    Columns columns;
    if (!inverted(quadAt(matrix.m), quadAt(matrix.m + 4), quadAt(matrix.m + 8), columns))
        return false;
    for (int row = 0; row < 3; ++row) {
        inverse.m[4 * row] = columns.x[row];
        inverse.m[4 * row + 1] = columns.y[row];
        inverse.m[4 * row + 2] = columns.z[row];
        inverse.m[4 * row + 3] = columns.origin[row];
    }
    return true;
}

/* ---- time ------------------------------------------------------------------------------------------------------------------------- */

/* Whether something with these motion options is not there at a time. */
OXRT_INLINE bool hasVanished(const OxrtTraversableView& view, float time) {
    return ((view.motionFlags & MOTION_START_VANISH) && time < view.timeBegin) || ((view.motionFlags & MOTION_END_VANISH) && time > view.timeEnd);
}

/* The time between the first key and the last as 0 to 1, clamped; NaN is 0. */
OXRT_INLINE float relativeTime(const OxrtTraversableView& view, float time) {
    const float relative = (time - view.timeBegin) / (view.timeEnd - view.timeBegin);
    return !(relative > 0.0f) ? 0.0f : relative < 1.0f ? relative : 1.0f;
}

/* The key before a time and the fraction to the next. */
struct KeyPlace {
    uint32_t key;
    float fraction;
};
OXRT_INLINE KeyPlace keyPlace(const OxrtTraversableView& view, float time) {
    const uint32_t intervals = view.keyCount - 1;
    const float last = float(intervals);
    const float raw = last * (time - view.timeBegin) / (view.timeEnd - view.timeBegin);
    const float position = !(raw > 0.0f) ? 0.0f : raw < last ? raw : last;
    if (intervals == 1)
        return {0, position};
    const uint32_t key = uint32_t(position);
    const uint32_t first = key < intervals ? key : intervals - 1;
    return {first, position - float(first)};
}

OXRT_INLINE float blended(float a, float b, float fraction) { return fraction == 0.0f ? a : (1.0f - fraction) * a + fraction * b; }

/* The key of SIZE floats at a time. */
template <int SIZE> OXRT_INLINE void blendKeys(const OxrtTraversableView& view, float time, float* result) {
    const KeyPlace place = keyPlace(view, time);
    const float* a = view.transformKeys + uint64_t(place.key) * SIZE;
    if (place.fraction == 0.0f) {
        __builtin_memcpy(result, a, SIZE * sizeof(float));
        return;
    }
    const float rest = 1.0f - place.fraction;
    for (int i = 0; i < SIZE; ++i)
        result[i] = rest * a[i] + place.fraction * a[SIZE + i];
}

/* Translation times rotation times scale and shear, from sx a b pvx sy c pvy sz pvz qx qy qz qw tx ty tz. */
OXRT_INLINE Affine matrixOfSrt(const float* s) {
    const float x = s[9], y = s[10], z = s[11], w = s[12];
    const float perNorm = 1.0f / (x * x + y * y + z * z + w * w);
    const float nx = x * perNorm, ny = y * perNorm, nz = z * perNorm, nw = w * perNorm;
    const float xx = x * nx, yy = y * ny, zz = z * nz, ww = w * nw;
    const float xy = x * ny, zw = z * nw, xz = x * nz, yw = y * nw, yz = y * nz, xw = x * nw;
    const float r[9] = {xx - yy - zz + ww, 2.0f * (xy - zw), 2.0f * (xz + yw), 2.0f * (xy + zw), yy - xx - zz + ww,
                        2.0f * (yz - xw),  2.0f * (xz - yw), 2.0f * (yz + xw), zz - xx - yy + ww};
    Affine matrix;
    for (int row = 0; row < 3; ++row) {
        const float* q = r + 3 * row;
        matrix.m[4 * row] = q[0] * s[0];
        matrix.m[4 * row + 1] = q[0] * s[1] + q[1] * s[4];
        matrix.m[4 * row + 2] = q[0] * s[2] + q[1] * s[5] + q[2] * s[7];
        matrix.m[4 * row + 3] = q[0] * s[3] + q[1] * s[6] + q[2] * s[8] + s[13 + row];
    }
    return matrix;
}

/* The child-to-parent matrix of an instance or transform. */
inline __attribute__((noinline)) Affine matrixAt(const OxrtTraversableView& node, float time) {
    Affine matrix;
    if (node.type == OXRT_TRAVERSABLE_INSTANCE) {
        __builtin_memcpy(matrix.m, node.instances->objectToWorld, sizeof(matrix.m));
        return matrix;
    }
    if (node.type == OXRT_TRAVERSABLE_STATIC) {
        __builtin_memcpy(matrix.m, node.transformKeys, sizeof(matrix.m));
        return matrix;
    }
    if (node.type == OXRT_TRAVERSABLE_SRT_MOTION) {
        float key[16];
        blendKeys<16>(node, time, key);
        return matrixOfSrt(key);
    }
    blendKeys<12>(node, time, matrix.m);
    return matrix;
}

/* The parent-to-child matrix; false where there is none. */
OXRT_INLINE bool inverseAt(const OxrtTraversableView& node, float time, Affine& inverse) {
    if (node.type == OXRT_TRAVERSABLE_INSTANCE)
        __builtin_memcpy(inverse.m, node.instances->worldToObject, sizeof(inverse.m));
    else if (node.type == OXRT_TRAVERSABLE_STATIC)
        __builtin_memcpy(inverse.m, node.transformKeys + 12, sizeof(inverse.m));
    else
        return inverted(matrixAt(node, time), inverse);
    return true;
}

/* The same of a transform for one ray, by columns. */
OXRT_INLINE bool inverseAt(const OxrtTraversableView& transform, float time, Columns& inverse) {
    if (transform.type == OXRT_TRAVERSABLE_STATIC) {
        inverse = columnsOf(transform.transformKeys + 12);
        return true;
    }
    if (transform.type == OXRT_TRAVERSABLE_SRT_MOTION) {
        const Affine matrix = matrixAt(transform, time);
        return inverted(quadAt(matrix.m), quadAt(matrix.m + 4), quadAt(matrix.m + 8), inverse);
    }
    const KeyPlace place = keyPlace(transform, time);
    const float* first = transform.transformKeys + uint64_t(place.key) * 12;
    const float rest = 1.0f - place.fraction;
    const auto row = [&](int number) {
        const Quad before = quadAt(first + 4 * number);
        return place.fraction == 0.0f ? before : rest * before + place.fraction * quadAt(first + 12 + 4 * number);
    };
    return inverted(row(0), row(1), row(2), inverse);
}

/* ---- the way from the root of a trace to a primitive ------------------------------------------------------------------------------- */

enum { MAX_PATH_NODES = 31 };

/* Scenes of one level need none. */
struct GraphPath {
    const OxrtTraversableView* structure; /* what Embree was asked about: a GAS, or an IAS with Embree's own instances */
    const OxrtInstanceView* native;       /* the last instance where `structure` is an IAS */
    const OxrtInstanceView* instance;     /* the innermost one above `structure`, null without */
    uint32_t instanceIndex;
    uint32_t sbtOffset; /* summed over the instances above `structure` */
    float3 direction;   /* the ray's, in the space of `structure` */
    uint32_t size;      /* of nodes */
    const OxrtTraversableView* nodes[MAX_PATH_NODES]; /* instances and transforms above `structure`, outermost first */
};

OXRT_INLINE void copyPath(GraphPath& to, const GraphPath& from) {
    __builtin_memcpy(&to, &from, __builtin_offsetof(GraphPath, nodes) + from.size * sizeof(from.nodes[0]));
}

OXRT_INLINE const OxrtTraversableView& structureOf(const GraphPath& path) { return path.native ? *path.native->child : *path.structure; }
OXRT_INLINE uint32_t pathLength(const GraphPath& path) { return path.size + (path.native ? 1 : 0); }
OXRT_INLINE uint64_t pathHandle(const GraphPath& path, uint32_t index) {
    if (index < path.size)
        return path.nodes[index]->handle;
    return index == path.size && path.native ? path.native->handle : 0;
}

inline __attribute__((noinline)) Affine objectToWorldAlong(const GraphPath& path, float time) {
    Affine matrix = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
    for (uint32_t i = 0; i < path.size; ++i)
        matrix = i == 0 ? matrixAt(*path.nodes[0], time) : composed(matrix, matrixAt(*path.nodes[i], time));
    if (!path.native)
        return matrix;
    Affine last;
    __builtin_memcpy(last.m, path.native->objectToWorld, sizeof(last.m));
    return path.size == 0 ? last : composed(matrix, last);
}
inline __attribute__((noinline)) Affine worldToObjectAlong(const GraphPath& path, float time) {
    Affine matrix = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
    for (uint32_t i = 0; i < path.size; ++i) {
        Affine inverse = matrix;
        inverseAt(*path.nodes[i], time, inverse);
        matrix = i == 0 ? inverse : composed(inverse, matrix);
    }
    if (!path.native)
        return matrix;
    Affine last;
    __builtin_memcpy(last.m, path.native->worldToObject, sizeof(last.m));
    return path.size == 0 ? last : composed(last, matrix);
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
