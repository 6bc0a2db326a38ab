// Shader binding tables: writing record headers and judging tables before a launch. Kernels check what they read as well; here a bad table
// gets a sentence.
#include "pipeline.h"

#include "error.h"
#include "objects.h"

#include <cstdint>
#include <cstring>

namespace oxrt {

namespace {

constexpr std::uint32_t maxRecordData = 1u << 30;

struct Section {
    const char* name;
    const void* base;
    std::uint32_t stride;
    std::uint32_t count;
    std::uint32_t kind;
};

bool aligned(const void* pointer)
{
    return reinterpret_cast<std::uintptr_t>(pointer) % OXRT_SBT_RECORD_ALIGNMENT == 0;
}

OxrtRecordHeader readHeader(const void* record)
{
    OxrtRecordHeader header;
    std::memcpy(&header, record, sizeof header);
    return header;
}

void checkSection(const Section& section)
{
    if (section.count == 0) return;
    if (!section.base) fail(OXRT_ERROR_INVALID_VALUE, "the SBT has %u %s records but their pointer is NULL", section.count, section.name);
    if (!aligned(section.base)) fail(OXRT_ERROR_INVALID_VALUE, "the SBT's %s records are not aligned to 16 bytes", section.name);
    if (section.stride % OXRT_SBT_RECORD_ALIGNMENT != 0 || section.stride < OXRT_SBT_RECORD_HEADER_SIZE)
        fail(OXRT_ERROR_INVALID_VALUE, "the SBT's %s stride is %u; give a multiple of 16 of at least 32 bytes", section.name,
             section.stride);
}

// Throws `result` for a header that no program group of this pipeline wrote.
void checkHeader(const void* record, std::uint32_t kind, std::uint32_t pipelineUid, const std::string& name, OxrtResult result)
{
    const OxrtRecordHeader header = readHeader(record);
    if (header.pipelineUid == 0) fail(result, "the SBT's %s is empty; give it the header of a group (oxrtSbtRecordPackHeader), of an empty one if nothing is to run", name.c_str());
    if (header.pipelineUid != pipelineUid)
        fail(result, "the SBT's %s was written for another pipeline (%u, this is %u); write its header for this one", name.c_str(),
             header.pipelineUid, pipelineUid);
    if (header.kind != kind)
        fail(result, "the SBT's %s holds a program group of another kind (0x%x instead of 0x%x)", name.c_str(), header.kind, kind);
}

void checkSingle(const void* record, const char* name)
{
    if (!aligned(record)) fail(OXRT_ERROR_INVALID_VALUE, "the SBT's %s is not aligned to 16 bytes", name);
}

} // namespace

const char* programKindName(std::uint32_t kind)
{
    static constexpr const char* names[] = {"raygen",       "miss",      "closesthit",      "anyhit",
                                            "intersection", "exception", "direct_callable", "continuation_callable"};
    return kind < std::size(names) ? names[kind] : "unknown";
}

void checkShaderBindingTable(const OxrtShaderBindingTable& sbt, std::uint32_t pipelineUid, bool everyHeader)
{
    if (!sbt.raygenRecord) fail(OXRT_ERROR_INVALID_VALUE, "the SBT's raygenRecord is NULL; give the record of a ray generation program");
    checkSingle(sbt.raygenRecord, "raygenRecord");
    checkHeader(sbt.raygenRecord, OXRT_PROGRAM_GROUP_KIND_RAYGEN, pipelineUid, "raygenRecord", OXRT_ERROR_INVALID_VALUE);
    if (sbt.exceptionRecord) {
        checkSingle(sbt.exceptionRecord, "exceptionRecord");
        checkHeader(sbt.exceptionRecord, OXRT_PROGRAM_GROUP_KIND_EXCEPTION, pipelineUid, "exceptionRecord", OXRT_ERROR_INVALID_VALUE);
    }

    const Section sections[] = {
        {"miss", sbt.missRecords, sbt.missStride, sbt.missCount, OXRT_PROGRAM_GROUP_KIND_MISS},
        {"hitgroup", sbt.hitgroupRecords, sbt.hitgroupStride, sbt.hitgroupCount, OXRT_PROGRAM_GROUP_KIND_HITGROUP},
        {"callable", sbt.callableRecords, sbt.callableStride, sbt.callableCount, OXRT_PROGRAM_GROUP_KIND_CALLABLES},
    };
    for (const Section& section : sections) {
        checkSection(section);
        for (std::uint32_t i = 0; everyHeader && i < section.count; ++i)
            checkHeader(static_cast<const std::uint8_t*>(section.base) + std::size_t(section.stride) * i, section.kind, pipelineUid,
                        formatText("%s record %u", section.name, i), OXRT_ERROR_VALIDATION_FAILURE);
    }
}

std::int32_t Pipeline::groupProgram(const char* name, std::uint32_t kind, const char* member, std::uint32_t dataSize) const
{
    if (!name) return OXRT_NO_PROGRAM;
    const std::int32_t number = findProgram(name);
    if (number == OXRT_NO_PROGRAM)
        fail(OXRT_ERROR_INVALID_VALUE, "program group: %s names `%s`, which is not in this pipeline; add it when the pipeline is made",
             member, name);
    const OxrtProgram& program = variant->programs[number];
    if (program.kind != kind)
        fail(OXRT_ERROR_INVALID_VALUE, "program group: %s names `%s`, which is a %s program", member, name, programKindName(program.kind));
    if (dataSize < program.recordSize)
        fail(OXRT_ERROR_INVALID_VALUE, "program group: `%s` reads %u bytes of record data, but the record has %u", name, program.recordSize,
             dataSize);
    return number;
}

void Pipeline::packHeader(const OxrtProgramGroupDesc& group, std::uint32_t dataSize, void* record) const
{
    if (!record) fail(OXRT_ERROR_INVALID_VALUE, "the record is NULL");
    if (dataSize > maxRecordData) fail(OXRT_ERROR_INVALID_VALUE, "dataSize is %u; a record holds at most 2^30 bytes of data", dataSize);
    OxrtRecordHeader header = {};
    header.programs[0] = header.programs[1] = header.programs[2] = OXRT_NO_PROGRAM;
    header.pipelineUid = uid;
    header.kind = group.kind;
    header.dataSize = dataSize;
    switch (group.kind) {
    case OXRT_PROGRAM_GROUP_KIND_RAYGEN:
        if (!group.raygen) fail(OXRT_ERROR_INVALID_VALUE, "program group: a raygen group needs `raygen`");
        header.programs[0] = groupProgram(group.raygen, OXRT_KIND_RAYGEN, "raygen", dataSize);
        break;
    case OXRT_PROGRAM_GROUP_KIND_MISS: header.programs[0] = groupProgram(group.miss, OXRT_KIND_MISS, "miss", dataSize); break;
    case OXRT_PROGRAM_GROUP_KIND_EXCEPTION:
        if (!group.exception) fail(OXRT_ERROR_INVALID_VALUE, "program group: an exception group needs `exception`");
        header.programs[0] = groupProgram(group.exception, OXRT_KIND_EXCEPTION, "exception", dataSize);
        break;
    case OXRT_PROGRAM_GROUP_KIND_HITGROUP:
        header.programs[0] = groupProgram(group.closesthit, OXRT_KIND_CLOSESTHIT, "closesthit", dataSize);
        header.programs[1] = groupProgram(group.anyhit, OXRT_KIND_ANYHIT, "anyhit", dataSize);
        header.programs[2] = groupProgram(group.intersection, OXRT_KIND_INTERSECTION, "intersection", dataSize);
        break;
    case OXRT_PROGRAM_GROUP_KIND_CALLABLES:
        if (!group.directCallable && !group.continuationCallable)
            fail(OXRT_ERROR_INVALID_VALUE, "program group: a callables group needs `directCallable` or `continuationCallable`");
        header.programs[0] = groupProgram(group.directCallable, OXRT_KIND_DIRECT_CALLABLE, "directCallable", dataSize);
        header.programs[1] = groupProgram(group.continuationCallable, OXRT_KIND_CONTINUATION_CALLABLE, "continuationCallable", dataSize);
        break;
    default: fail(OXRT_ERROR_INVALID_VALUE, "program group: kind 0x%x is unknown", static_cast<unsigned>(group.kind));
    }
    std::memcpy(record, &header, sizeof header);
}

const OxrtProgram& Pipeline::raygenOf(const OxrtShaderBindingTable& sbt) const
{
    const OxrtRecordHeader header = readHeader(sbt.raygenRecord);
    const std::int32_t number = header.programs[0];
    if (number < 0 || static_cast<std::uint32_t>(number) >= variant->programCount || variant->programs[number].kind != OXRT_KIND_RAYGEN)
        fail(OXRT_ERROR_INVALID_VALUE, "the SBT's raygenRecord names no ray generation program; its header was overwritten");
    return variant->programs[number];
}

} // namespace oxrt

using namespace oxrt;

OxrtResult oxrtSbtRecordPackHeader(OxrtPipeline pipeline, const OxrtProgramGroupDesc* group, uint32_t dataSize, void* record)
{
    return guard([&] {
        const auto self = find(pipeline);
        self->context->attempt("SBT", [&] {
            if (!group) fail(OXRT_ERROR_INVALID_VALUE, "the program group is NULL");
            self->packHeader(*group, dataSize, record);
        });
    });
}
