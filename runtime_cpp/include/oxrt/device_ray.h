/* The trace in flight, and the device functions that read it. */
#ifndef OXRT_DEVICE_RAY_H
#define OXRT_DEVICE_RAY_H

#include <oxrt/device_motion.h>
#include <oxrt/embree.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* OptiX's flag words. */
enum RayFlag : uint32_t {
    RAY_DISABLE_ANYHIT = 1,
    RAY_ENFORCE_ANYHIT = 2,
    RAY_TERMINATE_ON_FIRST_HIT = 4,
    RAY_DISABLE_CLOSESTHIT = 8,
    RAY_CULL_BACK_FACING = 16,
    RAY_CULL_FRONT_FACING = 32,
    RAY_CULL_DISABLED_ANYHIT = 64,
    RAY_CULL_ENFORCED_ANYHIT = 128,
    RAY_FORCE_MICROMAP_2_STATE = 1024,
    RAY_CULL_ANY = RAY_CULL_BACK_FACING | RAY_CULL_FRONT_FACING | RAY_CULL_DISABLED_ANYHIT | RAY_CULL_ENFORCED_ANYHIT
};
enum GeometryFlag : uint32_t { GEOMETRY_DISABLE_ANYHIT = 1, GEOMETRY_DISABLE_FACE_CULLING = 4 };
enum InstanceFlag : uint32_t { INSTANCE_DISABLE_FACE_CULLING = 1, INSTANCE_FLIP_FACING = 2, INSTANCE_DISABLE_ANYHIT = 4,
                               INSTANCE_ENFORCE_ANYHIT = 8, INSTANCE_FORCE_MICROMAP_2_STATE = 16,
                               INSTANCE_DISABLE_MICROMAPS = 32 };
enum HitKind : uint32_t { HIT_KIND_TRIANGLE_FRONT_FACE = 0xFE, HIT_KIND_TRIANGLE_BACK_FACE = 0xFF };
enum RecordSlot { SLOT_CLOSESTHIT = 0, SLOT_ANYHIT = 1, SLOT_INTERSECTION = 2 };

/* Stands for the kind of a reported hit while there is none: kinds have 8 bits. */
inline constexpr uint32_t NO_REPORT = ~0u;

/* What became of a candidate. */
enum class Verdict : uint32_t { Accept, Ignore, Terminate };

/* Where the ray has met the curve segment that was offered last: Embree may offer one crossing again and again. */
struct CurveRoots {
    const OxrtGeometry* geometry;
    const OxrtInstanceView* instance;
    uint32_t primitive;
    uint32_t count;
    float t[4];
    float closest; /* the nearest accepted hit of the whole query */
};

/* One trace: the ray as the caller gave it, and the hit that the running program is about (the candidate in any-hit programs, the
   closest accepted one in closest-hit programs). Traces without callbacks never give its address away, so that it stays in registers. */
struct Ray {
    RTCRayQueryContext context; /* first: Embree hands its address to the callbacks */
    OxrtThread* thread;
    void* payload;
    const OxrtTraversableView* root;
    GraphPath* path; /* the way to the hit in scenes that kernels walk through themselves (device_graph.h), else null */
    float3 origin, direction;
    float tmin, tmax, time;
    uint32_t mask, flags, sbtOffset, sbtStride, missIndex;

    /* the hit */
    float t; /* what getRayTmax gives: see the kinds of programs there */
    float u, v;
    float3 normal; /* of a triangle: object space, not normalised */
    uint32_t primitive; /* within its geometry */
    const OxrtInstanceView* instance; /* the innermost; null for a GAS that hangs in none */
    const OxrtGeometry* geometry;
    const OxrtRecordHeader* record;
    uint32_t recordIndex;
    uint32_t kind; /* of custom primitives, as reported */
    const uint32_t* attributes; /* of custom primitives, as reported */

    /* while callbacks run */
    Verdict verdict;
    const OxrtRecordHeader* soleRecord; /* of all candidates, or null */
    CurveRoots curveRoots;
    RTCFilterFunctionN filter; /* of the query, or null */
    bool isTerminated;
    float closest; /* t of the closest accepted hit, or the caller's tmax */
    float closestInEmbree; /* what stands for `closest` in Embree's ray */
    const RTCRay* objectRay;
    RTCHit* embreeHit; /* null in occlusion queries */
    RTCRay* embreeRay;
    uint32_t embreeGeometry;
    bool runsAnyHit;
    uint32_t committedKind;
    uint32_t committedAttributes[8];
    uint32_t candidateAttributes[8];
};

/* What stands next to zero: Embree multiplies both ends of the interval with factors below one (rounding, determinants), and a denormal
   product costs more than the rest of a short traversal: 2^-126 itself made primary packets a third slower. */
constexpr float NEXT_TO_ZERO = 0x1p-64f;

/* The neighbours of a float. Embree's intervals are closed, OptiX's open for built-in primitives. */
OXRT_INLINE constexpr float nextUp(float x) {
    if (!(x < __builtin_inff()))
        return x;
    if (__builtin_fabsf(x) < NEXT_TO_ZERO)
        return NEXT_TO_ZERO;
    const uint32_t bits = __builtin_bit_cast(uint32_t, x);
    return __builtin_bit_cast(float, x > 0.0f ? bits + 1 : bits - 1);
}
OXRT_INLINE constexpr float nextDown(float x) { return -nextUp(-x); }

/* ---- payload -------------------------------------------------------------------------------------------------------------------- */

OXRT_INLINE uint32_t payloadWord(const Ray& ray, int index) {
    uint32_t word;
    __builtin_memcpy(&word, static_cast<const char*>(ray.payload) + 4 * index, 4);
    return word;
}
OXRT_INLINE void setPayloadWord(Ray& ray, int index, uint32_t word) {
    __builtin_memcpy(static_cast<char*>(ray.payload) + 4 * index, &word, 4);
}
#define OXRT_PAYLOAD(i)                                                                        \
    OXRT_INLINE uint32_t getPayload_##i(const Ray& ray) { return payloadWord(ray, i); }         \
    OXRT_INLINE void setPayload_##i(Ray& ray, uint32_t word) { setPayloadWord(ray, i, word); }
OXRT_PAYLOAD(0) OXRT_PAYLOAD(1) OXRT_PAYLOAD(2) OXRT_PAYLOAD(3) OXRT_PAYLOAD(4) OXRT_PAYLOAD(5) OXRT_PAYLOAD(6) OXRT_PAYLOAD(7)
OXRT_PAYLOAD(8) OXRT_PAYLOAD(9) OXRT_PAYLOAD(10) OXRT_PAYLOAD(11) OXRT_PAYLOAD(12) OXRT_PAYLOAD(13) OXRT_PAYLOAD(14) OXRT_PAYLOAD(15)
OXRT_PAYLOAD(16) OXRT_PAYLOAD(17) OXRT_PAYLOAD(18) OXRT_PAYLOAD(19) OXRT_PAYLOAD(20) OXRT_PAYLOAD(21) OXRT_PAYLOAD(22) OXRT_PAYLOAD(23)
OXRT_PAYLOAD(24) OXRT_PAYLOAD(25) OXRT_PAYLOAD(26) OXRT_PAYLOAD(27) OXRT_PAYLOAD(28) OXRT_PAYLOAD(29) OXRT_PAYLOAD(30) OXRT_PAYLOAD(31)
#undef OXRT_PAYLOAD
/* Which payload types a program takes is settled when the pipeline is compiled. */
OXRT_INLINE void setPayloadTypes(Ray&, uint32_t) {}

/* ---- the ray -------------------------------------------------------------------------------------------------------------------- */

OXRT_INLINE float3 getWorldRayOrigin(const Ray& ray) { return ray.origin; }
OXRT_INLINE float3 getWorldRayDirection(const Ray& ray) { return ray.direction; }
/* Intersection and any-hit programs only. */
OXRT_INLINE float3 getObjectRayOrigin(const Ray& ray) { return {ray.objectRay->org_x, ray.objectRay->org_y, ray.objectRay->org_z}; }
OXRT_INLINE float3 getObjectRayDirection(const Ray& ray) { return {ray.objectRay->dir_x, ray.objectRay->dir_y, ray.objectRay->dir_z}; }
OXRT_INLINE float getRayTmin(const Ray& ray) { return ray.tmin; }
/* Any-hit: the candidate's t. Closest-hit: the hit's. Intersection: the closest accepted so far. Miss: the caller's tmax. */
OXRT_INLINE float getRayTmax(const Ray& ray) { return ray.t; }
OXRT_INLINE float getRayTime(const Ray& ray) { return ray.time; }
OXRT_INLINE uint32_t getRayFlags(const Ray& ray) { return ray.flags; }
OXRT_INLINE uint32_t getRayVisibilityMask(const Ray& ray) { return ray.mask; }

/* ---- where the hit is --------------------------------------------------------------------------------------------------------------- */

OXRT_INLINE uint32_t getPrimitiveIndex(const Ray& ray) { return ray.primitive + ray.geometry->primitiveIndexOffset; }
OXRT_INLINE uint32_t localRecord(const Ray& ray) { return ray.geometry->recordOffsets ? ray.geometry->recordOffsets[ray.primitive] : 0; }
OXRT_INLINE uint32_t getSbtGASIndex(const Ray& ray) { return ray.geometry->recordBase + localRecord(ray); }
OXRT_INLINE uint32_t getInstanceId(const Ray& ray) { return ray.instance ? ray.instance->instanceId : ~0u; }
OXRT_INLINE uint32_t getInstanceIndex(const Ray& ray) {
    if (__builtin_expect(ray.path != nullptr, 0))
        return ray.path->native ? uint32_t(ray.instance - ray.path->structure->instances) : ray.path->instanceIndex;
    return ray.instance ? uint32_t(ray.instance - ray.root->instances) : 0;
}
/* The GAS that holds the primitive. */
OXRT_INLINE const OxrtTraversableView& holderOf(const Ray& ray) {
    if (__builtin_expect(ray.path != nullptr, 0))
        return structureOf(*ray.path);
    return ray.instance ? *ray.instance->child : *ray.root;
}
OXRT_INLINE uint64_t getGASTraversableHandle(const Ray& ray) { return holderOf(ray).handle; }
/* Of all instances above the primitive. */
OXRT_INLINE uint32_t instanceSbtOffset(const Ray& ray) {
    if (__builtin_expect(ray.path != nullptr, 0))
        return ray.path->sbtOffset + (ray.path->native ? ray.path->native->sbtOffset : 0);
    return ray.instance ? ray.instance->sbtOffset : 0;
}
OXRT_INLINE constexpr uint32_t getClusterId(const Ray&) { return ~0u; }

/* ---- transforms ----------------------------------------------------------------------------------------------------------------- */

OXRT_INLINE uint32_t getTransformListSize(const Ray& ray) {
    if (__builtin_expect(ray.path != nullptr, 0))
        return pathLength(*ray.path);
    return ray.instance ? 1 : 0;
}
OXRT_INLINE uint64_t getTransformListHandle(const Ray& ray, uint32_t index) {
    if (__builtin_expect(ray.path != nullptr, 0))
        return pathHandle(*ray.path, index);
    return ray.instance && index == 0 ? ray.instance->handle : 0;
}

#define OXRT_TRANSFORM(NAME, TRANSFORM, MATRIX, ALONG)                                  \
    OXRT_INLINE float3 transform##NAME(const Ray& ray, const float3& value) {            \
        if (__builtin_expect(ray.path != nullptr, 0))                                    \
            return throughPath(ray, value, ALONG, TRANSFORM);                            \
        return ray.instance ? TRANSFORM(ray.instance->MATRIX, value) : value;            \
    }
template <class Along, class Transform> OXRT_INLINE float3 throughPath(const Ray& ray, const float3& value, Along along, Transform transform) {
    return pathLength(*ray.path) == 0 ? value : transform(along(*ray.path, ray.time).m, value);
}
OXRT_TRANSFORM(PointFromObjectToWorldSpace, transformPoint, objectToWorld, objectToWorldAlong)
OXRT_TRANSFORM(PointFromWorldToObjectSpace, transformPoint, worldToObject, worldToObjectAlong)
OXRT_TRANSFORM(VectorFromObjectToWorldSpace, transformVector, objectToWorld, objectToWorldAlong)
OXRT_TRANSFORM(VectorFromWorldToObjectSpace, transformVector, worldToObject, worldToObjectAlong)
OXRT_TRANSFORM(NormalFromObjectToWorldSpace, transformNormal, worldToObject, worldToObjectAlong)
OXRT_TRANSFORM(NormalFromWorldToObjectSpace, transformNormal, objectToWorld, objectToWorldAlong)
#undef OXRT_TRANSFORM

OXRT_INLINE float3x4 getObjectToWorldTransformMatrix(const Ray& ray) {
    if (__builtin_expect(ray.path != nullptr, 0))
        return matrixFrom(objectToWorldAlong(*ray.path, ray.time).m);
    return ray.instance ? matrixFrom(ray.instance->objectToWorld) : identityTransform();
}
OXRT_INLINE float3x4 getWorldToObjectTransformMatrix(const Ray& ray) {
    if (__builtin_expect(ray.path != nullptr, 0))
        return matrixFrom(worldToObjectAlong(*ray.path, ray.time).m);
    return ray.instance ? matrixFrom(ray.instance->worldToObject) : identityTransform();
}

/* ---- the hit ---------------------------------------------------------------------------------------------------------------------- */

/* The ray's direction in object space. */
OXRT_INLINE float3 objectDirection(const Ray& ray) {
    if (__builtin_expect(ray.path != nullptr, 0))
        return ray.path->native ? transformVector(ray.path->native->worldToObject, ray.path->direction) : ray.path->direction;
    return transformVectorFromWorldToObjectSpace(ray, ray.direction);
}

/* Which side of a triangle the ray meets: counter-clockwise in object space is the front, unless the instance flips it. */
OXRT_INLINE bool isFrontFacing(const Ray& ray) {
    const float3 direction = objectDirection(ray);
    const float cosine = ray.normal.x * direction.x + ray.normal.y * direction.y + ray.normal.z * direction.z;
    const bool isFlipped = ray.instance && (ray.instance->flags & INSTANCE_FLIP_FACING);
    return (cosine < 0.0f) != isFlipped;
}

OXRT_INLINE bool isTriangleGeometry(const Ray& ray) { return ray.geometry->primitiveType == OXRT_PRIMITIVE_TRIANGLE; }
OXRT_INLINE bool isCustomGeometry(const Ray& ray) { return ray.geometry->primitiveType == OXRT_PRIMITIVE_CUSTOM; }

/* Kinds of the built-in primitives other than triangles; they are hit from the front only. */
OXRT_INLINE constexpr uint32_t builtinHitKind(uint32_t primitiveType) {
    switch (primitiveType) {
    case OXRT_PRIMITIVE_QUADRATIC_BSPLINE: return 128;
    case OXRT_PRIMITIVE_CUBIC_BSPLINE: return 130;
    case OXRT_PRIMITIVE_LINEAR: return 132;
    case OXRT_PRIMITIVE_CATMULL_ROM: return 134;
    case OXRT_PRIMITIVE_FLAT_QUADRATIC_BSPLINE: return 136;
    case OXRT_PRIMITIVE_SPHERE: return 138;
    case OXRT_PRIMITIVE_CUBIC_BEZIER: return 140;
    case OXRT_PRIMITIVE_QUADRATIC_BSPLINE_ROCAPS: return 142;
    case OXRT_PRIMITIVE_CUBIC_BSPLINE_ROCAPS: return 144;
    case OXRT_PRIMITIVE_CATMULL_ROM_ROCAPS: return 146;
    case OXRT_PRIMITIVE_CUBIC_BEZIER_ROCAPS: return 148;
    default: return 0;
    }
}
OXRT_INLINE uint32_t getHitKind(const Ray& ray) {
    if (isTriangleGeometry(ray))
        return isFrontFacing(ray) ? HIT_KIND_TRIANGLE_FRONT_FACE : HIT_KIND_TRIANGLE_BACK_FACE;
    return isCustomGeometry(ray) ? ray.kind : builtinHitKind(ray.geometry->primitiveType);
}
OXRT_INLINE bool isTriangleHit(const Ray& ray) { return getHitKind(ray) >= HIT_KIND_TRIANGLE_FRONT_FACE; }
OXRT_INLINE bool isTriangleFrontFaceHit(const Ray& ray) { return getHitKind(ray) == HIT_KIND_TRIANGLE_FRONT_FACE; }
OXRT_INLINE bool isTriangleBackFaceHit(const Ray& ray) { return getHitKind(ray) == HIT_KIND_TRIANGLE_BACK_FACE; }
OXRT_INLINE constexpr bool isBackFaceHit(uint32_t kind) { return (kind & 1) != 0; } /* of custom kinds too, as recorded */
OXRT_INLINE constexpr bool isFrontFaceHit(uint32_t kind) { return !isBackFaceHit(kind); }
OXRT_INLINE bool isBackFaceHit(const Ray& ray) { return isBackFaceHit(getHitKind(ray)); }
OXRT_INLINE bool isFrontFaceHit(const Ray& ray) { return isFrontFaceHit(getHitKind(ray)); }
OXRT_INLINE constexpr uint32_t getPrimitiveType(uint32_t kind) {
    if (kind < 128)
        return OXRT_PRIMITIVE_CUSTOM;
    if (kind >= HIT_KIND_TRIANGLE_FRONT_FACE)
        return OXRT_PRIMITIVE_TRIANGLE;
    for (uint32_t type = OXRT_PRIMITIVE_QUADRATIC_BSPLINE; type <= OXRT_PRIMITIVE_CUBIC_BEZIER_ROCAPS; ++type)
        if (builtinHitKind(type) == (kind & ~1u))
            return type;
    return OXRT_PRIMITIVE_CUSTOM;
}
/* Custom primitives may report the kinds of built-in ones and then look like them, but never like triangles. */
OXRT_INLINE uint32_t getPrimitiveType(const Ray& ray) {
    return isCustomGeometry(ray) && ray.kind < HIT_KIND_TRIANGLE_FRONT_FACE ? getPrimitiveType(ray.kind) : ray.geometry->primitiveType;
}

OXRT_INLINE float2 getTriangleBarycentrics(const Ray& ray) { return {ray.u, ray.v}; }
OXRT_INLINE float getCurveParameter(const Ray& ray) { return ray.u; }
OXRT_INLINE float2 getRibbonParameters(const Ray& ray) { return {ray.u, ray.v}; }

/* Object space; rounding apart (p1 - p0) x (p2 - p0) of triangles. */
OXRT_INLINE float3 getGeometricNormal(const Ray& ray) { return isCustomGeometry(ray) ? float3(0.0f) : ray.normal; }

OXRT_INLINE float3 vertexOf(const OxrtGeometry& geometry, uint32_t index) {
    const float* v = geometry.vertices + 3 * uint64_t(index);
    return {v[0], v[1], v[2]};
}
using TriangleVertices = Tuple<float3, float3, float3>;
OXRT_INLINE TriangleVertices triangleVertices(const OxrtGeometry& geometry, uint32_t primitive) {
    const uint32_t* i = geometry.indices + 3 * uint64_t(primitive);
    return makeTuple(vertexOf(geometry, i[0]), vertexOf(geometry, i[1]), vertexOf(geometry, i[2]));
}
/* The floats of a vertex at a time: `width` numbers for each vertex, those of a key after those of the one before. */
OXRT_INLINE void vertexAt(const OxrtTraversableView& gas, const OxrtGeometry& geometry, uint32_t index, uint32_t width, float time, float* values) {
    const KeyPlace place = keyPlace(gas, time);
    const float* a = geometry.vertices + width * (geometry.vertexCount * place.key + index);
    const float* b = a + width * geometry.vertexCount;
    for (uint32_t i = 0; i < width; ++i)
        values[i] = blended(a[i], b[i], place.fraction);
}
inline __attribute__((noinline)) TriangleVertices movingTriangle(const OxrtTraversableView& gas, const OxrtGeometry& geometry, uint32_t primitive,
                                                                 float time) {
    const uint32_t* i = geometry.indices + 3 * uint64_t(primitive);
    float v[3][3];
    for (int corner = 0; corner < 3; ++corner)
        vertexAt(gas, geometry, i[corner], 3, time, v[corner]);
    return makeTuple(float3(v[0][0], v[0][1], v[0][2]), float3(v[1][0], v[1][1], v[1][2]), float3(v[2][0], v[2][1], v[2][2]));
}
OXRT_INLINE TriangleVertices triangleVerticesAt(const OxrtTraversableView& gas, const OxrtGeometry& geometry, uint32_t primitive, float time) {
    return __builtin_expect(geometry.keyCount > 1, 0) ? movingTriangle(gas, geometry, primitive, time) : triangleVertices(geometry, primitive);
}
/* Corners in object space at the ray's time, the pre-transform applied. */
/* Zero where the hit is no triangle: its arrays are laid out otherwise. */
OXRT_INLINE TriangleVertices getTriangleVertexData(const Ray& ray) {
    if (!isTriangleGeometry(ray))
        return {};
    return triangleVerticesAt(holderOf(ray), *ray.geometry, ray.primitive, ray.time);
}

/* Attribute words: the reported ones of a custom primitive, the barycentrics of a built-in one. */
OXRT_INLINE uint32_t attributeWord(const Ray& ray, int index) {
    if (isCustomGeometry(ray))
        return ray.attributes[index];
    return index == 0 ? floatAsUint(ray.u) : index == 1 ? floatAsUint(ray.v) : 0;
}
OXRT_INLINE uint32_t getAttribute_0(const Ray& ray) { return attributeWord(ray, 0); }
OXRT_INLINE uint32_t getAttribute_1(const Ray& ray) { return attributeWord(ray, 1); }
OXRT_INLINE uint32_t getAttribute_2(const Ray& ray) { return attributeWord(ray, 2); }
OXRT_INLINE uint32_t getAttribute_3(const Ray& ray) { return attributeWord(ray, 3); }
OXRT_INLINE uint32_t getAttribute_4(const Ray& ray) { return attributeWord(ray, 4); }
OXRT_INLINE uint32_t getAttribute_5(const Ray& ray) { return attributeWord(ray, 5); }
OXRT_INLINE uint32_t getAttribute_6(const Ray& ray) { return attributeWord(ray, 6); }
OXRT_INLINE uint32_t getAttribute_7(const Ray& ray) { return attributeWord(ray, 7); }
template <class Attributes> OXRT_INLINE Attributes getAttributes(const Ray& ray) {
    static_assert(sizeof(Attributes) <= sizeof(ray.committedAttributes));
    const uint32_t builtin[8] = {floatAsUint(ray.u), floatAsUint(ray.v)};
    Attributes result;
    __builtin_memcpy(&result, isCustomGeometry(ray) ? ray.attributes : builtin, sizeof(Attributes));
    return result;
}

/* ---- ends of any-hit programs: the program returns right after ------------------------------------------------------------------- */

OXRT_INLINE void ignoreIntersection(Ray& ray) { ray.verdict = Verdict::Ignore; }
OXRT_INLINE void terminateRay(Ray& ray) { ray.verdict = Verdict::Terminate; }

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
