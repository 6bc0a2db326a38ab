// The C functions of acceleration structures. See accel.h.
#include "accel.h"
#include "error.h"
#include "objects.h"

#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

namespace oxrt {

namespace {

void checkSize(std::size_t given, std::size_t needed, const char* property)
{
    if (given != needed) fail(OXRT_ERROR_INVALID_VALUE, "resultSize is %zu; %s takes %zu bytes", given, property, needed);
}

void emitCompactedSize(const Accel& accel, void* result, std::size_t resultSize)
{
    const std::uint64_t size = accel.info().memoryUsage; // structures are compact as they are built
    checkSize(resultSize, sizeof size, "COMPACTED_SIZE");
    if (!accel.mayCompact())
        fail(OXRT_ERROR_INVALID_VALUE, "the accel was built without ALLOW_COMPACTION; build it with that flag to ask for its compacted size");
    std::memcpy(result, &size, sizeof size);
}

void emitBoxes(const Accel& accel, void* result, std::size_t resultSize)
{
    constexpr float infinity = std::numeric_limits<float>::infinity();
    std::vector<float> boxes;
    for (std::uint32_t key = 0; key < accel.keyCount(); ++key) {
        const RTCBounds bounds = accel.boundsAt(key);
        const bool isNothing = !(bounds.lower_x <= bounds.upper_x);
        const float box[6] = {bounds.lower_x, bounds.lower_y, bounds.lower_z, bounds.upper_x, bounds.upper_y, bounds.upper_z};
        for (int i = 0; i < 6; ++i) boxes.push_back(isNothing ? (i < 3 ? infinity : -infinity) : box[i]);
    }
    checkSize(resultSize, boxes.size() * sizeof(float), "AABBS");
    std::memcpy(result, boxes.data(), resultSize);
}

} // namespace

} // namespace oxrt

using namespace oxrt;

OxrtResult oxrtAccelBuild(OxrtContext context, const OxrtAccelBuildOptions* options, const OxrtBuildInput* inputs, unsigned numInputs,
                          OxrtAccel* accel)
{
    return guard([&] {
        const auto owner = find(context);
        owner->attempt("ACCEL", [&] {
            if (!accel) fail(OXRT_ERROR_INVALID_VALUE, "the result pointer `accel` is NULL");
            *accel = nullptr;
            *accel = publish(Accel::make(owner, options ? *options : OxrtAccelBuildOptions{}, {inputs, numInputs}));
        });
    });
}

OxrtResult oxrtAccelUpdate(OxrtAccel accel, const OxrtBuildInput* inputs, unsigned numInputs)
{
    return guard([&] {
        const auto self = find(accel);
        self->context->attempt("ACCEL", [&] { self->update({inputs, numInputs}); });
    });
}

OxrtResult oxrtAccelGetInfo(OxrtAccel accel, OxrtAccelInfo* info)
{
    return guard([&] {
        const auto self = find(accel);
        if (!info) fail(OXRT_ERROR_INVALID_VALUE, "the result pointer `info` is NULL");
        *info = self->info();
    });
}

OxrtResult oxrtAccelCompact(OxrtAccel accel, OxrtAccel* compacted)
{
    return guard([&] {
        const auto self = find(accel);
        self->context->attempt("ACCEL", [&] {
            if (!compacted) fail(OXRT_ERROR_INVALID_VALUE, "the result pointer `compacted` is NULL");
            *compacted = nullptr;
            if (!self->mayCompact())
                fail(OXRT_ERROR_INVALID_VALUE, "the accel was built without ALLOW_COMPACTION; build it with that flag to compact it");
            *compacted = publish(self->copy({}));
        });
    });
}

OxrtResult oxrtAccelRelocate(OxrtAccel accel, const OxrtTraversableHandle* children, uint64_t numChildren, OxrtAccel* relocated)
{
    return guard([&] {
        const auto self = find(accel);
        self->context->attempt("ACCEL", [&] {
            if (!relocated) fail(OXRT_ERROR_INVALID_VALUE, "the result pointer `relocated` is NULL");
            *relocated = nullptr;
            if (!children && numChildren != 0) fail(OXRT_ERROR_INVALID_VALUE, "children is NULL but numChildren is not 0");
            *relocated = publish(self->copy({children, numChildren}));
        });
    });
}

OxrtResult oxrtAccelEmitProperty(OxrtAccel accel, uint32_t type, void* result, size_t resultSize)
{
    return guard([&] {
        const auto self = find(accel);
        self->context->attempt("ACCEL", [&] {
            if (!result) fail(OXRT_ERROR_INVALID_VALUE, "the result pointer `result` is NULL");
            switch (type) {
            case OXRT_PROPERTY_TYPE_COMPACTED_SIZE: emitCompactedSize(*self, result, resultSize); break;
            case OXRT_PROPERTY_TYPE_AABBS: emitBoxes(*self, result, resultSize); break;
            default:
                fail(OXRT_ERROR_INVALID_VALUE, "property type 0x%x; give OXRT_PROPERTY_TYPE_COMPACTED_SIZE or OXRT_PROPERTY_TYPE_AABBS", type);
            }
        });
    });
}

OxrtResult oxrtAccelDestroy(OxrtAccel accel)
{
    return guard([&] {
        std::shared_ptr<Accel> self = withdraw(accel);
        self->invalidate();
        const std::shared_ptr<Context> context = self->context;
        context->retire(std::move(self));
    });
}
