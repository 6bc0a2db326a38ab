/* Scenes that kernels walk through themselves: several levels of instances, transforms, motion. Embree is asked about one structure at a
 * time, with the ray in the space of that structure and at its own time.
 *
 * An IAS without Embree's own instances is one user geometry with a primitive for each instance; its callback goes down into the child
 * with a query of its own. Distances along the ray are the same in all spaces, since directions are not normalised.
 */
#ifndef OXRT_DEVICE_GRAPH_H
#define OXRT_DEVICE_GRAPH_H

#include <oxrt/device_query.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* The state of one walk. Embree hands the address of the ray's context to the callbacks, which is that of the walk. */
struct GraphWalk {
    Ray ray;
    GraphPath path;
    GraphPath* committed; /* the way to the closest hit */
    RTCIntersectArguments intersectInstances, intersectPrimitives;
    RTCOccludedArguments occludeInstances, occludePrimitives;
};

/* A query on the way down: the same type for both kinds, so that one code serves both. */
template <bool ANY> struct GraphQuery;
template <> struct GraphQuery<false> {
    RTCRayHit rayhit;
    OXRT_INLINE RTCRay& ray() { return rayhit.ray; }
};
template <> struct GraphQuery<true> {
    RTCRay only;
    OXRT_INLINE RTCRay& ray() { return only; }
};

/* Asks Embree about the structure; `outer` is shortened to what was found. */
template <bool ANY, class Outer> OXRT_INLINE void askStructure(GraphWalk& walk, const OxrtTraversableView& view, GraphQuery<ANY>& query, Outer& outer) {
    const bool isInner = view.type == OXRT_TRAVERSABLE_IAS && !view.hasNativeInstances;
    const OxrtServices& services = *walk.ray.thread->launch->services;
    RTCRay& ray = query.ray();
    walk.path.structure = &view;
    walk.path.native = nullptr;
    walk.path.direction = {ray.dir_x, ray.dir_y, ray.dir_z};
    if constexpr (ANY) {
        services.occluded1(view.scene, &ray, isInner ? &walk.occludeInstances : &walk.occludePrimitives);
        outer.tfar = ray.tfar;
    } else {
        RTCHit& hit = query.rayhit.hit;
        hit.geomID = RTC_INVALID_GEOMETRY_ID;
        hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        services.intersect1(view.scene, &query.rayhit, isInner ? &walk.intersectInstances : &walk.intersectPrimitives);
        outer.ray.tfar = ray.tfar;
        if (hit.geomID == RTC_INVALID_GEOMETRY_ID)
            return;
        outer.hit = hit;
        if (!isInner)
            copyPath(*walk.committed, walk.path);
    }
}

/* Goes through transforms to the next structure and asks it. The ray is given in the space of `view`'s parent. */
template <class Programs, bool ANY, class Outer>
OXRT_INLINE void descend(GraphWalk& walk, const OxrtTraversableView* view, Quad origin, Quad direction, const RTCRay& parent, Outer& outer) {
    const float time = walk.ray.time;
    for (; view->child; view = view->child) {
        if (view->type != OXRT_TRAVERSABLE_STATIC && (!Programs::usesTime || hasVanished(*view, time)))
            return; /* without motion in the pipeline, motion transforms are not there */
        Columns inverse;
        if constexpr (!Programs::usesTime)
            inverse = columnsOf(view->transformKeys + 12);
        else if (!inverseAt(*view, time, inverse))
            return;
        origin = inverse.point(origin);
        direction = inverse.vector(direction);
        walk.path.nodes[walk.path.size++] = view;
    }
    if (!view->scene)
        return;
    const bool moves = view->keyCount > 1;
    if (moves && hasVanished(*view, time))
        return;
    GraphQuery<ANY> query;
    RTCRay& ray = query.ray();
    EmbreeRow* rows = reinterpret_cast<EmbreeRow*>(&ray);
    rows[0] = EmbreeRow{origin[0], origin[1], origin[2], parent.tnear};
    rows[1] = EmbreeRow{direction[0], direction[1], direction[2], moves ? relativeTime(*view, time) : 0.0f};
    ray.tfar = parent.tfar;
    ray.mask = parent.mask;
    ray.id = 0;
    ray.flags = 0;
    askStructure<ANY>(walk, *view, query, outer);
}

/* One instance of the IAS that Embree is asked about: down into its child, and back. */
template <class Programs, bool ANY, class Outer>
OXRT_INLINE void enterInstance(GraphWalk& walk, uint32_t index, const RTCRay& parent, Outer& outer) {
    const OxrtTraversableView& structure = *walk.path.structure;
    const OxrtInstanceView& instance = structure.instances[index];
    if (structure.instanceBoxes && !meetsBox(quadAt(&parent.org_x), quadAt(&parent.dir_x), structure.instanceBoxes + 6 * uint64_t(index),
                                             parent.tnear, parent.tfar))
        return;
    if (!(instance.visibilityMask & walk.ray.mask) || !instance.child || !instance.child->scene || walk.ray.isTerminated)
        return;
    const Columns inverse = columnsOf(instance.worldToObject);
    const Quad direction = inverse.vector(quadAt(&parent.dir_x));
    if (direction[0] == 0.0f && direction[1] == 0.0f && direction[2] == 0.0f)
        return; /* of a singular instance the inverse is zero */
    GraphPath& path = walk.path;
    const OxrtInstanceView* outerInstance = path.instance;
    const uint32_t outerIndex = path.instanceIndex;
    const uint32_t outerSize = path.size;
    path.nodes[path.size++] = structure.instanceTraversables + index;
    path.instance = &instance;
    path.instanceIndex = index;
    path.sbtOffset += instance.sbtOffset;
    descend<Programs, ANY>(walk, instance.child, inverse.point(quadAt(&parent.org_x)), direction, parent, outer);
    path.structure = &structure;
    path.instance = outerInstance;
    path.instanceIndex = outerIndex;
    path.size = outerSize;
    path.sbtOffset -= instance.sbtOffset;
}
template <class Programs> void intersectInstance(const RTCIntersectFunctionNArguments* arguments) {
    if (arguments->valid[0] != -1)
        return;
    auto& rayhit = *static_cast<RTCRayHit*>(arguments->rayhit);
    enterInstance<Programs, false>(*reinterpret_cast<GraphWalk*>(arguments->context), arguments->primID, rayhit.ray, rayhit);
}
template <class Programs> void occludeInstance(const RTCOccludedFunctionNArguments* arguments) {
    if (arguments->valid[0] != -1)
        return;
    auto& ray = *static_cast<RTCRay*>(arguments->ray);
    enterInstance<Programs, true>(*reinterpret_cast<GraphWalk*>(arguments->context), arguments->primID, ray, ray);
}

/* What a trace says, in a ray of its own: the caller's stays in registers. */
OXRT_INLINE void copyArguments(Ray& to, const Ray& from) {
    to.thread = from.thread;
    to.payload = from.payload;
    to.root = from.root;
    to.origin = from.origin;
    to.direction = from.direction;
    to.tmin = from.tmin;
    to.tmax = from.tmax;
    to.time = from.time;
    to.mask = from.mask;
    to.flags = from.flags;
    to.sbtOffset = from.sbtOffset;
    to.sbtStride = from.sbtStride;
    to.missIndex = from.missIndex;
}

OXRT_INLINE void beginWalk(GraphWalk& walk, GraphPath& committed) {
    walk.ray.path = &walk.path;
    walk.committed = &committed;
    walk.path.native = nullptr;
    walk.path.instance = nullptr;
    walk.path.instanceIndex = 0;
    walk.path.sbtOffset = 0;
    walk.path.size = 0;
}

/* The walk of one ray; true if something was hit. The hit stays in the walk's ray, the way to it in `committed`. */
template <class Programs, class Flags> __attribute__((noinline)) bool walkClosest(GraphWalk& walk, GraphPath& committed) {
    Ray& ray = walk.ray;
    beginWalk(walk, committed);
    setCallbacks<Programs, Flags>(walk.intersectPrimitives, ray);
    walk.intersectInstances = walk.intersectPrimitives;
    walk.intersectInstances.filter = nullptr;
    walk.intersectInstances.intersect = intersectInstance<Programs>;
    walk.intersectPrimitives.intersect = intersectCallback<Programs>(ray);
    RTCRayHit found;
    setEmbreeRay(found.ray, ray);
    ray.closestInEmbree = found.ray.tfar;
    ray.committedKind = NO_REPORT;
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    const RTCRay world = found.ray;
    descend<Programs, false>(walk, ray.root, quadAt(&world.org_x), quadAt(&world.dir_x), world, found);
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return false;
    ray.path = &committed;
    const bool isOwn = ray.isTerminated || (ray.committedKind != NO_REPORT && found.ray.tfar == ray.closestInEmbree);
    enterHit(ray, found.hit, isOwn ? ray.closest : found.ray.tfar);
    return true;
}
template <class Programs, class Flags> __attribute__((noinline)) bool walkAny(GraphWalk& walk, GraphPath& committed) {
    Ray& ray = walk.ray;
    beginWalk(walk, committed);
    setCallbacks<Programs, Flags>(walk.occludePrimitives, ray);
    walk.occludeInstances = walk.occludePrimitives;
    walk.occludeInstances.filter = nullptr;
    walk.occludeInstances.occluded = occludeInstance<Programs>;
    walk.occludePrimitives.occluded = occludeCallback<Programs>(ray);
    RTCRay found;
    setEmbreeRay(found, ray);
    ray.closestInEmbree = found.tfar;
    const RTCRay world = found;
    descend<Programs, true>(walk, ray.root, quadAt(&world.org_x), quadAt(&world.dir_x), world, found);
    return ray.isTerminated || found.tfar < 0.0f;
}

/* As traverseClosest and traverseAny; the way to the hit is entered into `path`, which the ray refers to afterwards. */
template <class Programs, class Flags> OXRT_INLINE bool traverseGraphClosest(Ray& ray, GraphPath& path) {
    GraphWalk walk;
    copyArguments(walk.ray, ray);
    if (!walkClosest<Programs, Flags>(walk, path))
        return false;
    const Ray& found = walk.ray;
    ray.path = &path;
    ray.t = found.t;
    ray.u = found.u;
    ray.v = found.v;
    ray.normal = found.normal;
    ray.primitive = found.primitive;
    ray.instance = found.instance;
    ray.geometry = found.geometry;
    if constexpr (Programs::hasIntersection) {
        ray.kind = found.committedKind;
        __builtin_memcpy(ray.committedAttributes, found.committedAttributes, sizeof(ray.committedAttributes));
        ray.attributes = ray.committedAttributes;
    }
    return true;
}
template <class Programs, class Flags> OXRT_INLINE bool traverseGraphAny(Ray& ray, GraphPath& path) {
    GraphWalk walk;
    copyArguments(walk.ray, ray);
    return walkAny<Programs, Flags>(walk, path);
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
