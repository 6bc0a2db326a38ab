/* SBT records of lanes: where they are, which program each names, their data. */
#ifndef OXRT_LANES_RECORDS_H
#define OXRT_LANES_RECORDS_H

#include <oxrt/lanes_hit_kind.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* What the emitted programs over lanes of a payload class override. */
struct NoLanePrograms {
    using Scalar = NoPrograms;
    using Payload = NoPayload;
    static constexpr bool usesPayloadWords = false;
    static constexpr bool callbacksUsePayload = false; /* any-hit and intersection programs do */
    static constexpr bool callbacksReadHit = false;    /* ... in each lane: more than the ray and what an intersection's lanes share */
    static constexpr int attributeWords = 0;           /* the most that an intersection program reports and somebody reads */
};

/* A fault of the lowest lane of the mask, if there is one. */
template <int W>
__attribute__((noinline, cold)) void fault(LanesThread<W>& thread, Lanes<bool, W> mask, int32_t code, const char* message, Place place) {
    if (any(mask))
        fault(thread.atLane(firstLane(mask)), code, message, place);
}

/* Finds the records with these indices, and gives the lanes that have one which this pipeline may run. */
template <int W>
OXRT_INLINE Lanes<bool, W> findRecords(RecordLanes<W>& records, const OxrtLaunch& launch, Lanes<bool, W> mask, const uint8_t* section,
                                       uint32_t stride, uint32_t count, Lanes<uint32_t, W> index) {
    const uint32_t first = index[firstLane(mask)];
    records.places = {reinterpret_cast<const char*>(section), bitCast<int32_t>(index * (stride / 4))};
    if (none(mask & (index != first))) {
        records.common = findRecord(launch, section, stride, count, first);
        return records.common ? mask : Lanes<bool, W>(false);
    }
    records.common = nullptr;
    const Lanes<bool, W> present = mask & (index < count);
    return present & (gather<uint32_t, W>(records.places, OXRT_FIELD_OFFSET(OxrtRecordHeader, pipelineUid), present) == launch.pipelineUid);
}

/* The number of the program in `slot` of each lane's record. */
template <int W> OXRT_INLINE Lanes<int32_t, W> recordPrograms(const RecordLanes<W>& records, Lanes<bool, W> mask, int slot) {
    if (records.common)
        return records.common->programs[slot];
    return gather<int32_t, W>(records.places, OXRT_FIELD_OFFSET(OxrtRecordHeader, programs) + 4 * slot, mask);
}

/* The data of each lane's record. */
template <class Record, int W> OXRT_INLINE Wide<Record, W> loadRecord(const RecordLanes<W>& records, Lanes<bool, W> mask) {
    if (records.common)
        return spread<W>(recordData<Record>(*records.common));
    return loadFrom<Record, W>(WordPlaces<W>{records.places.base + sizeof(OxrtRecordHeader), records.places.index}, mask);
}

/* Makes the lanes of `hit` the active ones; notes whether they hit one geometry. */
template <int W> OXRT_INLINE void enterHits(RayLanes<W>& ray, Lanes<bool, W> hit) {
    ray.active = hit;
    const int lane = firstLane(hit);
    const auto& packet = ray.packet.hit;
    ray.commonInstance = nullptr;
    ray.commonGeometry = nullptr;
    const uint32_t geometry = packet.geomID[lane];
    if (ray.paths)
        return; /* what lanes share is not looked for */
    const bool hasInstances = ray.root->instances;
    if (!hasInstances && ray.root->geometryCount == 1)
        ray.commonGeometry = ray.root->geometries;
    else if (none(hit & (packetLanes<W>(packet.geomID) != geometry))) {
        const uint32_t instance = hasInstances ? packet.instID[0][lane] : RTC_INVALID_GEOMETRY_ID;
        if (!hasInstances)
            ray.commonGeometry = ray.root->geometries + geometry;
        else if (instance != RTC_INVALID_GEOMETRY_ID && none(hit & (packetLanes<W>(packet.instID[0]) != instance))) {
            ray.commonInstance = ray.root->instances + instance;
            ray.commonGeometry = ray.commonInstance->child->geometries + geometry;
        }
    }
}

/* The active lanes whose hit has a record. */
template <int W> OXRT_INLINE Lanes<bool, W> findHitRecords(RayLanes<W>& ray) {
    const OxrtLaunch& launch = *ray.thread->thread->launch;
    const Lanes<uint32_t, W> index = instanceSbtOffset(ray) + getSbtGASIndex(ray) * ray.sbtStride + ray.sbtOffset;
    return findRecords(ray.records, launch, ray.active, launch.hitgroupRecords, launch.hitgroupStride, launch.hitgroupCount, index);
}

/* The callables records with these indices that hold a program in `slot`. */
template <int W>
OXRT_INLINE Lanes<bool, W> findCallables(LanesThread<W>& thread, RecordLanes<W>& records, Lanes<bool, W> mask, Lanes<uint32_t, W> index,
                                         int slot, Place place = Place::current()) {
    const OxrtLaunch& launch = *thread.thread->launch;
    Lanes<bool, W> found = findRecords(records, launch, mask, launch.callableRecords, launch.callableStride, launch.callableCount, index);
    if (any(found))
        found = found & (recordPrograms(records, found, slot) != int32_t(OXRT_NO_PROGRAM));
    if (launch.validation)
        eachLane(without(mask, found), [&](int lane) { findCallable(thread.atLane(lane), index[lane], slot, place); });
    return found;
}

/* ---- payload registers by number ---------------------------------------------------------------------------------------------- */

/* Word `index` of a payload of any class. */
template <class Payload, int W> Lanes<uint32_t, W> readPayloadWord(const void* payload, int index) {
    Lanes<uint32_t, W> words = 0u;
    for (int lane = 0; lane < W; ++lane) {
        Payload own;
        extractLane(own, *static_cast<const Wide<Payload, W>*>(payload), lane);
        uint32_t word;
        __builtin_memcpy(&word, reinterpret_cast<const char*>(&own) + 4 * index, 4);
        words.set(lane, word);
    }
    return words;
}
template <class Payload, int W> void writePayloadWord(void* payload, int index, Lanes<bool, W> mask, Lanes<uint32_t, W> words) {
    eachLane(mask, [&](int lane) {
        Payload own;
        extractLane(own, *static_cast<const Wide<Payload, W>*>(payload), lane);
        const uint32_t word = words[lane];
        __builtin_memcpy(reinterpret_cast<char*>(&own) + 4 * index, &word, 4);
        insertLane(*static_cast<Wide<Payload, W>*>(payload), own, lane);
    });
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
