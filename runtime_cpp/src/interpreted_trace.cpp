// See interpreted_trace.h. Compiled with the floating-point flags of kernels, so that both give the same bits.
#include "interpreted_trace.h"

#include "oxrt/device.h"
#include "oxrt/device_hit_object.h"

namespace oxrt {

namespace {

template <bool USES_TIME, bool USES_MICROMAPS>
struct Interpreted : NoPrograms {
    struct Payload {
        uint32_t words[OXRT_PAYLOAD_WORDS];
    };
    static constexpr bool hasClosestHit = true;
    static constexpr bool hasAnyHit = true;
    static constexpr bool hasIntersection = true;
    static constexpr bool hasMiss = true;
    static constexpr bool mayThrow = true;
    static constexpr bool usesTime = USES_TIME;
    static constexpr bool usesMicromaps = USES_MICROMAPS;

    static void closestHit(Ray& ray, Payload&, const OxrtRecordHeader& record)
    {
        run(ray, OXRT_KIND_CLOSESTHIT, SLOT_CLOSESTHIT, record);
    }
    static void anyHit(Ray& ray, Payload&, const OxrtRecordHeader& record) { run(ray, OXRT_KIND_ANYHIT, SLOT_ANYHIT, record); }
    static void intersection(Ray& ray, Payload&, const OxrtRecordHeader& record)
    {
        run(ray, OXRT_KIND_INTERSECTION, SLOT_INTERSECTION, record);
    }
    static void miss(Ray& ray, Payload&, const OxrtRecordHeader& record) { run(ray, OXRT_KIND_MISS, 0, record); }

private:
    static void run(Ray& ray, uint32_t kind, int slot, const OxrtRecordHeader& record)
    {
        const auto& owner = *reinterpret_cast<const InterpretedThread*>(ray.thread);
        if (record.programs[slot] != OXRT_NO_PROGRAM) owner.callback(owner.data, &ray, kind, record.programs[slot], &record);
    }
};

float3 vectorOf(const float (&numbers)[3])
{
    return {numbers[0], numbers[1], numbers[2]};
}

using Static = Interpreted<false, false>;
using Moving = Interpreted<true, false>;
using StaticWithMicromaps = Interpreted<false, true>;
using MovingWithMicromaps = Interpreted<true, true>;

template <class Programs>
typename Programs::Payload& payloadOf(uint32_t* words)
{
    return *reinterpret_cast<typename Programs::Payload*>(words);
}

template <class Programs>
void traceAs(InterpretedThread& owner, const OxrtRayArguments& a, uint32_t* payload)
{
    trace<Programs, uint32_t>(owner.thread, a.handle, vectorOf(a.origin), vectorOf(a.direction), a.tmin, a.tmax, a.time, a.visibilityMask,
                              a.rayFlags, a.sbtOffset, a.sbtStride, a.missIndex, payloadOf<Programs>(payload));
}

template <class Programs>
void traverseAs(InterpretedThread& owner, HitObject& object, const OxrtRayArguments& a, uint32_t* payload)
{
    traverse<Programs, uint32_t>(owner.thread, object, a.handle, vectorOf(a.origin), vectorOf(a.direction), a.tmin, a.tmax, a.time,
                                 a.visibilityMask, a.rayFlags, a.sbtOffset, a.sbtStride, a.missIndex, payloadOf<Programs>(payload));
}

} // namespace

void traceInterpreted(InterpretedThread& owner, const OxrtRayArguments& arguments, uint32_t* payload)
{
    if (owner.usesMicromaps)
        owner.usesTime ? traceAs<MovingWithMicromaps>(owner, arguments, payload) : traceAs<StaticWithMicromaps>(owner, arguments, payload);
    else
        owner.usesTime ? traceAs<Moving>(owner, arguments, payload) : traceAs<Static>(owner, arguments, payload);
}

bool isTooDeepInterpreted(const InterpretedThread& owner, uint64_t handle)
{
    return isTooDeep(owner.thread, findTraversable(*owner.thread.launch, handle));
}

uint32_t graphDepthInterpreted(const InterpretedThread& owner, uint64_t handle)
{
    const OxrtTraversableView* root = findTraversable(*owner.thread.launch, handle);
    return root ? root->graphDepth : 0;
}

void* newHitObject(InterpretedThread& owner)
{
    return new HitObject(owner.thread);
}

void freeHitObject(void* object)
{
    delete static_cast<HitObject*>(object);
}

void traverseInterpreted(InterpretedThread& owner, void* object, const OxrtRayArguments& arguments, uint32_t* payload)
{
    auto& outgoing = *static_cast<HitObject*>(object);
    if (owner.usesMicromaps)
        owner.usesTime ? traverseAs<MovingWithMicromaps>(owner, outgoing, arguments, payload)
                       : traverseAs<StaticWithMicromaps>(owner, outgoing, arguments, payload);
    else
        owner.usesTime ? traverseAs<Moving>(owner, outgoing, arguments, payload) : traverseAs<Static>(owner, outgoing, arguments, payload);
}

void invokeInterpreted(InterpretedThread& owner, void* object, uint32_t* payload)
{
    invoke<Moving>(owner.thread, *static_cast<HitObject*>(object), payloadOf<Moving>(payload));
}

} // namespace oxrt

extern "C" {

int oxrtInterpreterReport(void* ray, float t, uint32_t kind, const uint32_t* attributes, unsigned count)
{
    oxrt::Ray& found = *static_cast<oxrt::Ray*>(ray);
    struct {
        uint32_t words[8];
    } held = {};
    for (unsigned i = 0; i < count && i < 8; ++i) held.words[i] = attributes[i];
    const bool accepted = oxrt::reportIntersection<oxrt::Moving>(found, t, kind, held);
    return oxrt::hasEnded(found) ? 2 : accepted;
}

void oxrtInterpreterIgnore(void* ray)
{
    static_cast<oxrt::Ray*>(ray)->verdict = oxrt::Verdict::Ignore;
}

void oxrtInterpreterTerminate(void* ray)
{
    static_cast<oxrt::Ray*>(ray)->verdict = oxrt::Verdict::Terminate;
}
}
