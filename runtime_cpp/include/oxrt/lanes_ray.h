/* The launch indices and the trace in flight of W lanes, and the device functions that read them: device_thread.h and device_ray.h for
 * lanes. Names and meanings are theirs.
 */
#ifndef OXRT_LANES_RAY_H
#define OXRT_LANES_RAY_H

#include <oxrt/device_trace.h>
#include <oxrt/lanes_memory.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* ---- the launch --------------------------------------------------------------------------------------------------------------- */

/* What the lanes of one block of launch indices share, and where each of them is. */
template <int W> struct LanesThread {
    OxrtThread* thread;
    Lanes<uint32_t, W> index[3];
    Lanes<bool, W> thrown; /* lanes that threw an exception and run no further */
    Lanes<int32_t, W> exceptionCode;
    Lanes<uint32_t, W> exceptionDetails[8];
    const char* exceptionLine;

    /* Makes the scalar thread stand for one lane: before faults and scalar programs. */
    OXRT_INLINE OxrtThread& atLane(int lane) const {
        for (int axis = 0; axis < 3; ++axis)
            thread->index[axis] = index[axis][lane];
        return *thread;
    }
};

template <int W> OXRT_INLINE Wide<uint3, W> getLaunchIndex(const LanesThread<W>& thread) {
    return {thread.index[0], thread.index[1], thread.index[2]};
}
template <int W> OXRT_INLINE uint3 getLaunchDimensions(const LanesThread<W>& thread) { return getLaunchDimensions(*thread.thread); }
template <class Params, int W> OXRT_INLINE const Params& launchParams(const LanesThread<W>& thread) {
    return launchParams<Params>(*thread.thread);
}
template <int W> OXRT_INLINE bool isCancelled(const LanesThread<W>& thread) { return isCancelled(*thread.thread); }

/* ---- the trace in flight ------------------------------------------------------------------------------------------------------ */

template <int W> struct Packet;
template <> struct Packet<8> {
    using RayHit = RTCRayHit8;
    static OXRT_INLINE void intersect(const OxrtServices& s, const int* valid, void* scene, RayHit& packet,
                                      RTCIntersectArguments* arguments) {
        s.intersect8(valid, scene, &packet, arguments);
    }
    static OXRT_INLINE void occluded(const OxrtServices& s, const int* valid, void* scene, RayHit& packet,
                                     RTCOccludedArguments* arguments) {
        s.occluded8(valid, scene, &packet.ray, arguments);
    }
};
template <> struct Packet<16> {
    using RayHit = RTCRayHit16;
    static OXRT_INLINE void intersect(const OxrtServices& s, const int* valid, void* scene, RayHit& packet,
                                      RTCIntersectArguments* arguments) {
        s.intersect16(valid, scene, &packet, arguments);
    }
    static OXRT_INLINE void occluded(const OxrtServices& s, const int* valid, void* scene, RayHit& packet,
                                     RTCOccludedArguments* arguments) {
        s.occluded16(valid, scene, &packet.ray, arguments);
    }
};

/* Embree's packet: the rays and the hits, which need not lie together while callbacks run. */
template <int W> struct PacketParts {
    using Whole = typename Packet<W>::RayHit;
    decltype(Whole::ray)& ray;
    decltype(Whole::hit)& hit;

    OXRT_INLINE PacketParts(Whole& whole) : ray(whole.ray), hit(whole.hit) {}
    OXRT_INLINE PacketParts(decltype(Whole::ray)& rays, decltype(Whole::hit)& hits) : ray(rays), hit(hits) {}
    /* Of a packet made in one piece. */
    OXRT_INLINE Whole& whole() const { return reinterpret_cast<Whole&>(ray); }
};

/* Where the SBT record of each lane is. */
template <int W> struct RecordLanes {
    const OxrtRecordHeader* common; /* the one of all lanes, null if they differ */
    WordPlaces<W> places;           /* else each lane's */
};

/* One trace of all lanes, or the candidates that a callback judges. Rays and hits stay in Embree's packet; what is derived from them is
   computed where it is read. */
template <int W> struct RayLanes {
    PacketParts<W> packet; /* not its memory: Embree sees that, and nothing else of the ray */
    LanesThread<W>* thread;
    void* payload;
    const OxrtTraversableView* root;
    GraphPath* paths = nullptr; /* each lane's way to its hit in scenes that kernels walk through themselves, else null */
    Lanes<float, W> tmin, tmax;
    Lanes<float, W> t; /* what getRayTmax gives */
    Lanes<uint32_t, W> sbtOffset, sbtStride, missIndex;
    uint32_t flags;
    Lanes<bool, W> active; /* the lanes that hit something, or missed */
    const OxrtInstanceView* commonInstance; /* if all active lanes hit one geometry: its instance or null */
    const OxrtGeometry* commonGeometry;     /* ... and itself, else null */
    RecordLanes<W> records;
    Lanes<uint32_t, W> kind; /* of custom primitives */
    Lanes<uint32_t, W> attributes[8];
    /* payload registers by number, where programs use them */
    Lanes<uint32_t, W> (*readWord)(const void* payload, int index) = nullptr;
    void (*writeWord)(void* payload, int index, Lanes<bool, W> mask, Lanes<uint32_t, W> words) = nullptr;

    OXRT_INLINE explicit RayLanes(PacketParts<W> rays) : packet(rays) {}
};

template <int W> OXRT_INLINE Lanes<float, W> packetLanes(const float (&values)[W]) { return loadLanes<float, W>(values); }
template <int W> OXRT_INLINE Lanes<uint32_t, W> packetLanes(const unsigned (&values)[W]) { return loadLanes<uint32_t, W>(values); }
template <class T, int W> OXRT_INLINE void setPacket(T (&values)[W], Lanes<T, W> lanes) { storeLanes<T, W>(values, lanes); }
template <int W>
OXRT_INLINE void setPacket(unsigned (&values)[W], uint32_t value) { storeLanes<uint32_t, W>(values, Lanes<uint32_t, W>(value)); }

template <int W> OXRT_INLINE Wide<float3, W> getWorldRayOrigin(const RayLanes<W>& ray) {
    const auto& r = ray.packet.ray;
    return {packetLanes<W>(r.org_x), packetLanes<W>(r.org_y), packetLanes<W>(r.org_z)};
}
template <int W> OXRT_INLINE Wide<float3, W> getWorldRayDirection(const RayLanes<W>& ray) {
    const auto& r = ray.packet.ray;
    return {packetLanes<W>(r.dir_x), packetLanes<W>(r.dir_y), packetLanes<W>(r.dir_z)};
}
template <int W> OXRT_INLINE Lanes<uint32_t, W> payloadWord(const RayLanes<W>& ray, int index) { return ray.readWord(ray.payload, index); }
template <int W> OXRT_INLINE void setPayloadWord(RayLanes<W>& ray, Lanes<bool, W> mask, int index, Wide<uint32_t, W> words) {
    ray.writeWord(ray.payload, index, mask, words);
}
template <int W> OXRT_INLINE Lanes<float, W> getRayTmin(const RayLanes<W>& ray) { return ray.tmin; }
template <int W> OXRT_INLINE Lanes<float, W> getRayTmax(const RayLanes<W>& ray) { return ray.t; }
template <int W> OXRT_INLINE Lanes<float, W> getRayTime(const RayLanes<W>& ray) { return packetLanes<W>(ray.packet.ray.time); }
template <int W> OXRT_INLINE Lanes<uint32_t, W> getRayFlags(const RayLanes<W>& ray) { return ray.flags; }
template <int W> OXRT_INLINE Lanes<uint32_t, W> getRayVisibilityMask(const RayLanes<W>& ray) {
    return packetLanes<W>(ray.packet.ray.mask);
}

/* ---- neighbours of floats: see nextUp of scalars ---------------------------------------------------------------------------- */

template <int W> OXRT_INLINE Lanes<float, W> nextUp(Lanes<float, W> x) {
    const Lanes<uint32_t, W> bits = floatAsUint(x);
    const Lanes<float, W> away = uintAsFloat(select(x > 0.0f, bits + 1u, bits - 1u));
    const Lanes<float, W> next = select(abs(x) < NEXT_TO_ZERO, NEXT_TO_ZERO, away);
    return select(x < __builtin_inff(), next, x);
}
template <int W> OXRT_INLINE Lanes<float, W> nextDown(Lanes<float, W> x) { return -nextUp(-x); }

/* ---- where the hits are ------------------------------------------------------------------------------------------------------- */

/* Byte places of structs in an array: `index` of each lane, the array's base shared. */
template <class T, int W> OXRT_INLINE WordPlaces<W> placesIn(const T* array, Lanes<uint32_t, W> index) {
    static_assert(sizeof(T) % 4 == 0);
    return {reinterpret_cast<const char*>(array), bitCast<int32_t>(index * uint32_t(sizeof(T) / 4))};
}

#define OXRT_FIELD_OFFSET(type, field) int64_t(__builtin_offsetof(type, field))

/* The innermost instance on the way to the hit, null without. */
OXRT_INLINE const OxrtInstanceView* innermostInstance(const GraphPath& path) { return path.native ? path.native : path.instance; }

/* f(path, lane) in every active lane of a scene with paths; zero elsewhere. */
template <class T, class F, int W> __attribute__((noinline)) Lanes<T, W> mapPaths(RayLanes<W> ray, T otherwise, F f) {
    Lanes<T, W> result = otherwise;
    eachLane(ray.active, [&](int lane) { result.set(lane, f(ray.paths[lane], lane)); });
    return result;
}

/* The lanes that hit something inside of an instance. */
template <int W> OXRT_INLINE Lanes<bool, W> inInstance(const RayLanes<W>& ray) {
    if (ray.paths)
        return mapPaths(ray, 0u, [](const GraphPath& path, int) { return innermostInstance(path) ? 1u : 0u; }) != 0u;
    if (!ray.root->instances)
        return false;
    return ray.active & (packetLanes<W>(ray.packet.hit.instID[0]) != RTC_INVALID_GEOMETRY_ID);
}
template <int W> OXRT_INLINE WordPlaces<W> instancePlaces(const RayLanes<W>& ray) {
    return placesIn<OxrtInstanceView, W>(ray.root->instances, packetLanes<W>(ray.packet.hit.instID[0]));
}
/* A 4-byte field of each lane's instance, `otherwise` without one. */
template <class T, int W> OXRT_INLINE Lanes<T, W> instanceField(const RayLanes<W>& ray, int64_t offset, T otherwise) {
    if (ray.paths)
        return mapPaths(ray, otherwise, [=](const GraphPath& path, int) {
            T value = otherwise;
            if (const OxrtInstanceView* instance = innermostInstance(path))
                __builtin_memcpy(&value, reinterpret_cast<const char*>(instance) + offset, sizeof(T));
            return value;
        });
    if (ray.commonGeometry) {
        T value = otherwise;
        if (ray.commonInstance)
            __builtin_memcpy(&value, reinterpret_cast<const char*>(ray.commonInstance) + offset, sizeof(T));
        return value;
    }
    const Lanes<bool, W> mask = inInstance(ray);
    return select(mask, gather<T, W>(instancePlaces(ray), offset, mask), otherwise);
}

/* Addresses of the geometries that were hit. */
template <int W> OXRT_INLINE AddressPlaces<W> geometryPlaces(const RayLanes<W>& ray) {
    if (ray.paths)
        return {mapPaths(ray, uint64_t(0), [&packet = ray.packet](const GraphPath& path, int lane) {
            return reinterpret_cast<uint64_t>(structureOf(path).geometries + packet.hit.geomID[lane]);
        })};
    const Lanes<uint64_t, W> id = convert<uint64_t>(packetLanes<W>(ray.packet.hit.geomID));
    Lanes<uint64_t, W> geometries = reinterpret_cast<uint64_t>(ray.root->geometries);
    const Lanes<bool, W> mask = inInstance(ray);
    if (any(mask)) {
        const AddressPlaces<W> child{gather<uint64_t, W>(instancePlaces(ray), OXRT_FIELD_OFFSET(OxrtInstanceView, child), mask)};
        geometries = select(mask, gather<uint64_t, W>(child, OXRT_FIELD_OFFSET(OxrtTraversableView, geometries), mask), geometries);
    }
    return {geometries + id * uint64_t(sizeof(OxrtGeometry))};
}
template <class T, int W> OXRT_INLINE Lanes<T, W> geometryField(const RayLanes<W>& ray, int64_t offset) {
    if (ray.commonGeometry) {
        T value;
        __builtin_memcpy(&value, reinterpret_cast<const char*>(ray.commonGeometry) + offset, sizeof(T));
        return value;
    }
    return gather<T, W>(geometryPlaces(ray), offset, ray.active);
}
#define OXRT_GEOMETRY_FIELD(type, ray, field) geometryField<type>(ray, OXRT_FIELD_OFFSET(OxrtGeometry, field))

template <int W> OXRT_INLINE Lanes<uint32_t, W> localPrimitive(const RayLanes<W>& ray) { return packetLanes<W>(ray.packet.hit.primID); }
template <int W> OXRT_INLINE Lanes<uint32_t, W> getPrimitiveIndex(const RayLanes<W>& ray) {
    return localPrimitive(ray) + OXRT_GEOMETRY_FIELD(uint32_t, ray, primitiveIndexOffset);
}
template <int W> OXRT_INLINE Lanes<uint32_t, W> localRecord(const RayLanes<W>& ray) {
    const Lanes<uint32_t, W> primitive = localPrimitive(ray);
    if (ray.commonGeometry) {
        const uint32_t* offsets = ray.commonGeometry->recordOffsets;
        return offsets ? gather<uint32_t, W>(placesIn<uint32_t, W>(offsets, primitive), 0, ray.active) : Lanes<uint32_t, W>(0u);
    }
    const Lanes<uint64_t, W> offsets = OXRT_GEOMETRY_FIELD(uint64_t, ray, recordOffsets);
    const Lanes<bool, W> mask = ray.active & (offsets != uint64_t(0));
    return gather<uint32_t, W>(AddressPlaces<W>{offsets + convert<uint64_t>(primitive) * uint64_t(4)}, 0, mask);
}
template <int W> OXRT_INLINE Lanes<uint32_t, W> getSbtGASIndex(const RayLanes<W>& ray) {
    return OXRT_GEOMETRY_FIELD(uint32_t, ray, recordBase) + localRecord(ray);
}
template <int W> OXRT_INLINE Lanes<uint32_t, W> getInstanceId(const RayLanes<W>& ray) {
    return instanceField<uint32_t>(ray, OXRT_FIELD_OFFSET(OxrtInstanceView, instanceId), ~0u);
}
template <int W> OXRT_INLINE Lanes<uint32_t, W> getInstanceIndex(const RayLanes<W>& ray) {
    if (ray.paths)
        return mapPaths(ray, 0u, [&packet = ray.packet](const GraphPath& path, int lane) {
            return path.native ? packet.hit.instID[0][lane] : path.instanceIndex;
        });
    return select(inInstance(ray), packetLanes<W>(ray.packet.hit.instID[0]), 0u);
}
/* Of all instances above the primitive. */
template <int W> OXRT_INLINE Lanes<uint32_t, W> instanceSbtOffset(const RayLanes<W>& ray) {
    if (ray.paths)
        return mapPaths(ray, 0u, [](const GraphPath& path, int) { return path.sbtOffset + (path.native ? path.native->sbtOffset : 0); });
    return instanceField<uint32_t>(ray, OXRT_FIELD_OFFSET(OxrtInstanceView, sbtOffset), 0u);
}
template <int W> OXRT_INLINE Lanes<uint32_t, W> getClusterId(const RayLanes<W>&) { return ~0u; }
template <int W> OXRT_INLINE Lanes<uint32_t, W> geometryType(const RayLanes<W>& ray) {
    return OXRT_GEOMETRY_FIELD(uint32_t, ray, primitiveType);
}

/* The scalar ray of one lane, with what the getters of a hit read: for device functions that few programs use. */
template <int W> OXRT_INLINE void scalarHit(Ray& one, const RayLanes<W>& ray, int lane) {
    const auto& packet = ray.packet;
    one.thread = ray.thread->thread;
    one.root = ray.root;
    one.path = ray.paths ? ray.paths + lane : nullptr;
    one.origin = {packet.ray.org_x[lane], packet.ray.org_y[lane], packet.ray.org_z[lane]};
    one.direction = {packet.ray.dir_x[lane], packet.ray.dir_y[lane], packet.ray.dir_z[lane]};
    one.tmin = ray.tmin[lane];
    one.time = packet.ray.time[lane];
    one.flags = ray.flags;
    const RTCHit hit = {packet.hit.Ng_x[lane], packet.hit.Ng_y[lane], packet.hit.Ng_z[lane], packet.hit.u[lane], packet.hit.v[lane],
                        packet.hit.primID[lane], packet.hit.geomID[lane], {packet.hit.instID[0][lane]}, {0}};
    enterHit(one, hit, ray.t[lane]);
    one.kind = ray.kind[lane];
}

/* f(scalar ray, lane) in every active lane; the results as lanes, zero elsewhere. By value, so that the caller's ray stays in registers. */
template <class F, int W> __attribute__((noinline)) auto mapHits(RayLanes<W> ray, F f) {
    Ray one;
    using R = decltype(f(static_cast<const Ray&>(one), 0));
    Wide<R, W> result = spread<W>(R{});
    eachLane(ray.active, [&](int lane) {
        scalarHit(one, ray, lane);
        insertLane(result, f(static_cast<const Ray&>(one), lane), lane);
    });
    return result;
}

#define OXRT_MAPPED_GETTER(name) \
    template <int W> auto name(const RayLanes<W>& ray) { return mapHits(ray, [](const Ray& one, int) { return name(one); }); }
OXRT_MAPPED_GETTER(getGASTraversableHandle)
OXRT_MAPPED_GETTER(getPrimitiveType)
OXRT_MAPPED_GETTER(getTransformListSize)
OXRT_MAPPED_GETTER(getObjectToWorldTransformMatrix)
OXRT_MAPPED_GETTER(getWorldToObjectTransformMatrix)
#undef OXRT_MAPPED_GETTER
template <class I, int W> auto getTransformListHandle(const RayLanes<W>& ray, I index) {
    const Lanes<uint32_t, W> wide = convert<uint32_t>(index);
    return mapHits(ray, [&](const Ray& one, int lane) { return getTransformListHandle(one, wide[lane]); });
}

/* ---- transforms --------------------------------------------------------------------------------------------------------------- */

/* The 12 numbers of each lane's matrix at `offset` of its instance. */
template <int W> struct MatrixLanes {
    Lanes<float, W> m[12];
};
template <int W> OXRT_INLINE MatrixLanes<W> instanceMatrix(const RayLanes<W>& ray, int64_t offset) {
    MatrixLanes<W> result;
    for (int i = 0; i < 12; ++i)
        result.m[i] = instanceField<float>(ray, offset + 4 * i, i % 5 == 0 ? 1.0f : 0.0f);
    return result;
}
/* In instances the transformed value, elsewhere the value itself, bit for bit. */
template <class F, int W>
OXRT_INLINE Wide<float3, W> throughInstance(const RayLanes<W>& ray, int64_t offset, const Wide<float3, W>& value, F f) {
    const Lanes<bool, W> mask = inInstance(ray);
    if (none(mask))
        return value;
    const MatrixLanes<W> matrix = instanceMatrix(ray, offset);
    return select(mask, f(matrix.m, value), value);
}
template <class M, class V> OXRT_INLINE V pointThrough(const M& m, const V& p) {
    return {m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
            m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]};
}
template <class M, class V> OXRT_INLINE V vectorThrough(const M& m, const V& v) {
    return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[4] * v.x + m[5] * v.y + m[6] * v.z, m[8] * v.x + m[9] * v.y + m[10] * v.z};
}
template <class M, class V> OXRT_INLINE V normalThrough(const M& m, const V& n) {
    return {m[0] * n.x + m[4] * n.y + m[8] * n.z, m[1] * n.x + m[5] * n.y + m[9] * n.z, m[2] * n.x + m[6] * n.y + m[10] * n.z};
}
template <int W, class F> OXRT_INLINE Wide<float3, W> throughPaths(const RayLanes<W>& ray, const Wide<float3, W>& value, F transform) {
    return mapHits(ray, [&](const Ray& one, int lane) {
        float3 own;
        extractLane(own, value, lane);
        return transform(one, own);
    });
}
#define OXRT_LANES_TRANSFORM(name, through, matrix)                                                                    \
    template <int W, class V> OXRT_INLINE Wide<float3, W> name(const RayLanes<W>& ray, const V& value) {               \
        if (ray.paths)                                                                                                 \
            return throughPaths<W>(ray, Wide<float3, W>(value), [](const Ray& one, const float3& x) { return name(one, x); }); \
        return throughInstance(ray, OXRT_FIELD_OFFSET(OxrtInstanceView, matrix), Wide<float3, W>(value),               \
                               [](const auto& m, const auto& x) { return through(m, x); });                            \
    }
OXRT_LANES_TRANSFORM(transformPointFromObjectToWorldSpace, pointThrough, objectToWorld)
OXRT_LANES_TRANSFORM(transformPointFromWorldToObjectSpace, pointThrough, worldToObject)
OXRT_LANES_TRANSFORM(transformVectorFromObjectToWorldSpace, vectorThrough, objectToWorld)
OXRT_LANES_TRANSFORM(transformVectorFromWorldToObjectSpace, vectorThrough, worldToObject)
OXRT_LANES_TRANSFORM(transformNormalFromObjectToWorldSpace, normalThrough, worldToObject)
OXRT_LANES_TRANSFORM(transformNormalFromWorldToObjectSpace, normalThrough, objectToWorld)
#undef OXRT_LANES_TRANSFORM

/* ---- the hits ----------------------------------------------------------------------------------------------------------------- */

template <int W> OXRT_INLINE Wide<float2, W> getTriangleBarycentrics(const RayLanes<W>& ray) {
    return {packetLanes<W>(ray.packet.hit.u), packetLanes<W>(ray.packet.hit.v)};
}
template <int W> OXRT_INLINE Lanes<float, W> getCurveParameter(const RayLanes<W>& ray) { return packetLanes<W>(ray.packet.hit.u); }

template <int W> OXRT_INLINE Wide<float3, W> getGeometricNormal(const RayLanes<W>& ray) {
    const auto& hit = ray.packet.hit;
    const Wide<float3, W> normal = {packetLanes<W>(hit.Ng_x), packetLanes<W>(hit.Ng_y), packetLanes<W>(hit.Ng_z)};
    if (!(ray.root->needs & OXRT_SCENE_HAS_CUSTOM))
        return normal;
    return select(geometryType(ray) == uint32_t(OXRT_PRIMITIVE_CUSTOM), Wide<float3, W>(float3(0.0f)), normal);
}

template <int W, class Places> OXRT_INLINE Wide<float3, W> vertexAt(const Places& places, Lanes<bool, W> mask) {
    return {gather<float, W>(places, 0, mask), gather<float, W>(places, 4, mask), gather<float, W>(places, 8, mask)};
}
/* Zero in lanes that hit no triangle: their arrays are laid out otherwise. */
template <int W> OXRT_INLINE Wide<TriangleVertices, W> getTriangleVertexData(const RayLanes<W>& ray) {
    if (ray.root->needs & OXRT_SCENE_HAS_MOTION)
        return mapHits(ray, [](const Ray& one, int) { return getTriangleVertexData(one); });
    const Lanes<uint32_t, W> primitive = localPrimitive(ray);
    constexpr uint32_t others = OXRT_SCENE_HAS_CUSTOM | OXRT_SCENE_HAS_CURVES | OXRT_SCENE_HAS_SPHERES;
    Lanes<bool, W> mask = ray.active;
    if (ray.root->needs & others)
        mask &= geometryType(ray) == uint32_t(OXRT_PRIMITIVE_TRIANGLE);
    Wide<float3, W> corners[3];
    if (ray.commonGeometry) {
        const WordPlaces<W> indices = placesIn<uint3, W>(reinterpret_cast<const uint3*>(ray.commonGeometry->indices), primitive);
        for (int i = 0; i < 3; ++i) {
            const Lanes<uint32_t, W> vertex = gather<uint32_t, W>(indices, 4 * i, mask);
            corners[i] = vertexAt<W>(placesIn<float3, W>(reinterpret_cast<const float3*>(ray.commonGeometry->vertices), vertex), mask);
        }
    } else {
        const AddressPlaces<W> geometries = geometryPlaces(ray);
        const Lanes<uint64_t, W> vertices = gather<uint64_t, W>(geometries, OXRT_FIELD_OFFSET(OxrtGeometry, vertices), mask);
        const Lanes<uint64_t, W> indices = gather<uint64_t, W>(geometries, OXRT_FIELD_OFFSET(OxrtGeometry, indices), mask);
        const AddressPlaces<W> triangle{indices + convert<uint64_t>(primitive) * uint64_t(12)};
        for (int i = 0; i < 3; ++i) {
            const Lanes<uint64_t, W> vertex = convert<uint64_t>(gather<uint32_t, W>(triangle, 4 * i, mask));
            corners[i] = vertexAt<W>(AddressPlaces<W>{vertices + vertex * uint64_t(12)}, mask);
        }
    }
    return makeTuple(corners[0], corners[1], corners[2]);
}

/* Attribute words: the reported ones of a custom primitive, the barycentrics of a built-in one. */
template <int W> OXRT_INLINE Lanes<uint32_t, W> attributeWord(const RayLanes<W>& ray, int index) {
    Lanes<uint32_t, W> builtin = 0u;
    if (index == 0)
        builtin = floatAsUint(packetLanes<W>(ray.packet.hit.u));
    else if (index == 1)
        builtin = floatAsUint(packetLanes<W>(ray.packet.hit.v));
    return select(geometryType(ray) == uint32_t(OXRT_PRIMITIVE_CUSTOM), ray.attributes[index], builtin);
}
#define OXRT_LANES_ATTRIBUTE(index) \
    template <int W> OXRT_INLINE Lanes<uint32_t, W> getAttribute_##index(const RayLanes<W>& ray) { return attributeWord(ray, index); }
OXRT_LANES_ATTRIBUTE(0)
OXRT_LANES_ATTRIBUTE(1)
OXRT_LANES_ATTRIBUTE(2)
OXRT_LANES_ATTRIBUTE(3)
OXRT_LANES_ATTRIBUTE(4)
OXRT_LANES_ATTRIBUTE(5)
OXRT_LANES_ATTRIBUTE(6)
OXRT_LANES_ATTRIBUTE(7)
#undef OXRT_LANES_ATTRIBUTE

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
