// Pipelines, SBTs and launches: every index once, every misuse named, cancel, faults, threads, fork.
#include "fixture.h"

#include <chrono>
#include <sys/wait.h>
#include <cstdint>
#include <thread>
#include <unistd.h>
#include <xmmintrin.h>

namespace {

using namespace std::chrono_literals;

// What the body writes to standard output.
template <class Body>
std::string captured(Body&& body)
{
    std::fflush(stdout);
    std::FILE* file = std::tmpfile();
    const int saved = dup(1);
    dup2(fileno(file), 1);
    body();
    std::fflush(stdout);
    dup2(saved, 1);
    close(saved);
    std::string text(static_cast<std::size_t>(std::ftell(file) < 0 ? 0 : lseek(fileno(file), 0, SEEK_END)), '\0');
    lseek(fileno(file), 0, SEEK_SET);
    CHECK_EQUAL(read(fileno(file), text.data(), text.size()), static_cast<ssize_t>(text.size()));
    std::fclose(file);
    return text;
}

} // namespace

TEST(everyIndexRunsOnce)
{
    const std::uint32_t sizes[][3] = {{1, 1, 1},   {7, 1, 1},    {100000, 1, 1}, {64, 64, 1},   {33, 65, 1}, {1, 5000, 1},
                                      {3, 3, 500}, {1, 1, 4097}, {2, 2000, 3},   {1000, 17, 5}, {5, 1, 2000}};
    for (const unsigned threads : {1u, 2u, 5u}) {
        Fixture fixture(threads);
        for (const auto& [width, height, depth] : sizes) {
            std::vector<std::uint32_t> visits(std::size_t(width) * height * depth);
            TinyParams params = {};
            params.visits = visits.data();
            CHECK_SUCCESS(fixture.launch("__raygen__count", params, width, height, depth));
            std::size_t wrong = 0;
            for (const std::uint32_t count : visits) wrong += count != 1;
            CHECK_EQUAL(wrong, 0u);
            std::uint64_t done = 0;
            std::uint64_t total = 0;
            CHECK_SUCCESS(oxrtLaunchGetProgress(fixture.pipeline, &done, &total));
            CHECK_EQUAL(done, visits.size());
            CHECK_EQUAL(total, visits.size());
        }
    }
}

TEST(steppedLaunchesRunToo)
{
    for (const unsigned threads : {1u, 3u}) {
        Fixture fixture(threads);
        for (int round = 0; round < 50; ++round) {
            std::vector<std::uint32_t> visits(64 * 64);
            TinyParams params = {};
            params.visits = visits.data();
            const OxrtShaderBindingTable sbt = fixture.table("__raygen__count");
            CHECK_SUCCESS(oxrtLaunchBegin(fixture.pipeline, &params, sizeof params, &sbt, 64, 64, 1));
            int done = 0;
            while (!done) CHECK_SUCCESS(oxrtLaunchWait(fixture.pipeline, 50, &done));
            for (const std::uint32_t count : visits)
                if (count != 1) CHECK_EQUAL(count, 1u);
        }
        int done = 0;
        CHECK_FAILS(oxrtLaunchWait(fixture.pipeline, 1, &done), OXRT_ERROR_INVALID_OPERATION, "oxrtLaunchBegin");
    }
}

TEST(anEndlessProgramCanBeCancelled)
{
    for (const unsigned threads : {1u, 2u}) {
        Fixture fixture(threads);
        std::atomic<std::uint32_t> started{0};
        TinyParams params = {};
        params.started = &started;
        const OxrtShaderBindingTable sbt = fixture.table("__raygen__endless");
        CHECK_SUCCESS(oxrtLaunchBegin(fixture.pipeline, &params, sizeof params, &sbt, 1, 1, 1));
        int done = 1;
        const auto begin = std::chrono::steady_clock::now();
        CHECK_SUCCESS(oxrtLaunchWait(fixture.pipeline, 50, &done));
        CHECK_EQUAL(done, 0);
        CHECK(std::chrono::steady_clock::now() - begin < 5s);
        CHECK_SUCCESS(oxrtLaunchCancel(fixture.pipeline));
        CHECK_FAILS(oxrtLaunchWait(fixture.pipeline, 60000, &done), OXRT_ERROR_LAUNCH_CANCELLED, "cancelled");
        CHECK_EQUAL(done, 1);
        // The next launch is whole again.
        CHECK_SUCCESS(fixture.launch("__raygen__empty", params, 64, 64));
        CHECK_SUCCESS(oxrtLaunchCancel(fixture.pipeline));
        CHECK_SUCCESS(fixture.launch("__raygen__empty", params, 64, 64));
    }
}

TEST(theFirstFaultIsKept)
{
    for (const unsigned validation : {0u, 1u}) {
        Fixture fixture(2, validation);
        TinyParams params = {};
        params.faultIndex = 70;
        CHECK_FAILS(fixture.launch("__raygen__fault", params, 64, 2),
                    validation ? OXRT_ERROR_VALIDATION_FAILURE : OXRT_ERROR_LAUNCH_FAILURE,
                    "shader.py:12: launch index (6, 1, 0): assertion failed (1.5, -2)");
        OxrtLaunchReport report = {};
        CHECK_SUCCESS(oxrtPipelineGetLaunchReport(fixture.pipeline, &report));
        CHECK_EQUAL(report.faultCode, static_cast<int>(OXRT_FAULT_ASSERT));
        CHECK_EQUAL(report.index[0], 6u);
        CHECK_EQUAL(std::string(report.path), "shader.py");
        CHECK_EQUAL(report.line, 12u);
        params.faultIndex = ~0u;
        CHECK_SUCCESS(fixture.launch("__raygen__fault", params, 64, 2));
    }
}

TEST(printsAreWholeLinesInPythonsForm)
{
    Fixture fixture(2);
    const std::string text = captured([&] { CHECK_SUCCESS(fixture.launch("__raygen__print", {}, 2000)); });
    std::size_t lines = 0;
    for (std::size_t begin = 0; begin < text.size(); ++lines) {
        const std::size_t end = text.find('\n', begin);
        const std::string line = text.substr(begin, end - begin);
        const std::string tail = " (1.0, 0.1, 1e-07) True 1e+16";
        const bool whole = line.starts_with("i ") && line.ends_with(tail) && line.size() <= 2 + 4 + tail.size();
        if (!whole) CHECK_EQUAL(line, tail);
        begin = end + 1;
    }
    CHECK_EQUAL(lines, 2000u);
}

TEST(kernelsSeeIeeeDenormalsRecordsAndTextures)
{
    Fixture fixture(1);
    const float texels[6] = {};
    OxrtTextureOptions texture = {};
    texture.texels = texels;
    texture.width = 3;
    texture.height = 2;
    texture.channels = 1;
    std::uint64_t handle = 0;
    CHECK_SUCCESS(oxrtTextureCreate(fixture.context, &texture, &handle));
    TinyHit hit = {};
    TinyParams params = {};
    params.hits = &hit;
    params.texture = handle;
    const OxrtShaderBindingTable sbt = fixture.table("__raygen__state");
    reinterpret_cast<TinyRecord*>(fixture.record.bytes + OXRT_SBT_RECORD_HEADER_SIZE)->value = 42;
    const unsigned state = _mm_getcsr();
    _mm_setcsr(state | 0x8040);
    CHECK_SUCCESS(oxrtLaunch(fixture.pipeline, &params, sizeof params, &sbt, 1, 1, 1));
    CHECK_EQUAL(_mm_getcsr() & 0x8040, 0x8040u);
    _mm_setcsr(state);
    CHECK_EQUAL(hit.t, 42.0f);
    CHECK_EQUAL(hit.geometry, 0u);
    CHECK_EQUAL(hit.primitive, 3u);
    CHECK_SUCCESS(oxrtTextureDestroy(fixture.context, handle));
    CHECK_FAILS(oxrtTextureDestroy(fixture.context, handle), OXRT_ERROR_INVALID_VALUE, "not alive");
    CHECK_SUCCESS(oxrtTextureCreate(nullptr, &texture, &handle)); // of no context, seen by all
    params.texture = handle;
    CHECK_SUCCESS(oxrtLaunch(fixture.pipeline, &params, sizeof params, &sbt, 1, 1, 1));
    CHECK_EQUAL(hit.primitive, 3u);
    CHECK_FAILS(oxrtTextureDestroy(fixture.context, handle), OXRT_ERROR_INVALID_VALUE, "not alive in this context");
    CHECK_SUCCESS(oxrtTextureDestroy(nullptr, handle));
    CHECK_FAILS(oxrtTextureDestroy(nullptr, handle), OXRT_ERROR_INVALID_VALUE, "not alive");
    texture.channels = 5;
    CHECK_FAILS(oxrtTextureCreate(fixture.context, &texture, &handle), OXRT_ERROR_INVALID_VALUE, "5 channels");
}

TEST(misuseOfLaunchesIsNamed)
{
    Fixture fixture;
    const TinyParams params = {};
    const OxrtShaderBindingTable good = fixture.table("__raygen__empty");
    OxrtShaderBindingTable sbt = good;
    const auto launch = [&](std::uint32_t width = 4, std::uint32_t height = 4, std::uint32_t depth = 1) {
        return oxrtLaunch(fixture.pipeline, &params, sizeof params, &sbt, width, height, depth);
    };
    CHECK_FAILS(oxrtLaunch(nullptr, &params, sizeof params, &sbt, 1, 1, 1), OXRT_ERROR_INVALID_VALUE, "pipeline is NULL");
    CHECK_FAILS(oxrtLaunch(fixture.pipeline, nullptr, sizeof params, &sbt, 1, 1, 1), OXRT_ERROR_INVALID_VALUE, "params is NULL");
    CHECK_FAILS(oxrtLaunch(fixture.pipeline, &params, 4, &sbt, 1, 1, 1), OXRT_ERROR_INVALID_VALUE, "paramsSize is 4");
    CHECK_FAILS(oxrtLaunch(fixture.pipeline, &params, sizeof params, nullptr, 1, 1, 1), OXRT_ERROR_INVALID_VALUE, "sbt is NULL");
    CHECK_FAILS(launch(0), OXRT_ERROR_INVALID_VALUE, "has a zero");
    CHECK_FAILS(launch(1, 1, 0), OXRT_ERROR_INVALID_VALUE, "has a zero");
    CHECK_FAILS(launch(1u << 20, (1u << 10) + 1, 1), OXRT_ERROR_LAUNCH_FAILURE, "2^30");
    CHECK_FAILS(launch(~0u, ~0u, ~0u), OXRT_ERROR_LAUNCH_FAILURE, "2^30");

    sbt.raygenRecord = nullptr;
    CHECK_FAILS(launch(), OXRT_ERROR_INVALID_VALUE, "raygenRecord is NULL");
    sbt.raygenRecord = fixture.record.bytes + 8;
    CHECK_FAILS(launch(), OXRT_ERROR_INVALID_VALUE, "not aligned");
    RecordBytes empty;
    sbt.raygenRecord = empty.bytes;
    CHECK_FAILS(launch(), OXRT_ERROR_INVALID_VALUE, "is empty");
    sbt = good;
    sbt.missCount = 2;
    sbt.missStride = 32;
    CHECK_FAILS(launch(), OXRT_ERROR_INVALID_VALUE, "miss records but their pointer is NULL");
    sbt.missRecords = empty.bytes + 8;
    CHECK_FAILS(launch(), OXRT_ERROR_INVALID_VALUE, "miss records are not aligned");
    sbt.missRecords = empty.bytes;
    sbt.missStride = 24;
    CHECK_FAILS(launch(), OXRT_ERROR_INVALID_VALUE, "stride is 24");
    sbt.missStride = 16;
    CHECK_FAILS(launch(), OXRT_ERROR_INVALID_VALUE, "stride is 16");
    sbt = good;
    sbt.exceptionRecord = good.raygenRecord;
    CHECK_FAILS(launch(), OXRT_ERROR_INVALID_VALUE, "exceptionRecord holds a program group of another kind");
    CHECK_SUCCESS((sbt = good, launch()));
}

TEST(recordsOfAnotherPipelineAreNamed)
{
    Fixture fixture(2, 1);
    OxrtPipeline second = nullptr;
    CHECK_SUCCESS(oxrtPipelineLoad(fixture.context, TINY_PIPELINE, &second));
    const TinyParams params = {};
    OxrtShaderBindingTable sbt = fixture.table("__raygen__empty");
    CHECK_FAILS(oxrtLaunch(second, &params, sizeof params, &sbt, 1, 1, 1), OXRT_ERROR_INVALID_VALUE, "another pipeline");

    // Validation looks at every header.
    RecordBytes misses[3];
    OxrtProgramGroupDesc group = {};
    group.kind = OXRT_PROGRAM_GROUP_KIND_MISS;
    group.miss = "__miss__sky";
    CHECK_SUCCESS(oxrtSbtRecordPackHeader(fixture.pipeline, &group, 32, misses[0].bytes));
    CHECK_SUCCESS(oxrtSbtRecordPackHeader(second, &group, 32, misses[1].bytes));
    sbt.missRecords = misses;
    sbt.missStride = sizeof misses[0];
    sbt.missCount = 3;
    CHECK_FAILS(oxrtLaunch(fixture.pipeline, &params, sizeof params, &sbt, 1, 1, 1), OXRT_ERROR_VALIDATION_FAILURE, "miss record 1");
    misses[1] = misses[0];
    CHECK_FAILS(oxrtLaunch(fixture.pipeline, &params, sizeof params, &sbt, 1, 1, 1), OXRT_ERROR_VALIDATION_FAILURE,
                "miss record 2 is empty");
    misses[2] = misses[0];
    CHECK_SUCCESS(oxrtLaunch(fixture.pipeline, &params, sizeof params, &sbt, 1, 1, 1));
}

TEST(programGroupsAreChecked)
{
    Fixture fixture;
    RecordBytes record;
    OxrtProgramGroupDesc group = {};
    const auto pack = [&](std::uint32_t dataSize = 0) { return oxrtSbtRecordPackHeader(fixture.pipeline, &group, dataSize, record.bytes); };
    group.kind = OXRT_PROGRAM_GROUP_KIND_HITGROUP;
    CHECK_SUCCESS(pack());
    group.closesthit = "__closesthit__matte";
    CHECK_FAILS(pack(), OXRT_ERROR_INVALID_VALUE, "reads 4 bytes of record data, but the record has 0");
    group.anyhit = "__anyhit__leaf";
    CHECK_SUCCESS(pack(4));
    const auto* header = reinterpret_cast<const OxrtRecordHeader*>(record.bytes);
    CHECK_EQUAL(header->programs[0], 10);
    CHECK_EQUAL(header->programs[1], 11);
    CHECK_EQUAL(header->programs[2], -1);
    group.intersection = "__miss__sky";
    CHECK_FAILS(pack(4), OXRT_ERROR_INVALID_VALUE, "intersection names `__miss__sky`, which is a miss program");
    group.intersection = "__intersection__none";
    CHECK_FAILS(pack(4), OXRT_ERROR_INVALID_VALUE, "not in this pipeline");
    group = {};
    group.kind = OXRT_PROGRAM_GROUP_KIND_RAYGEN;
    CHECK_FAILS(pack(), OXRT_ERROR_INVALID_VALUE, "needs `raygen`");
    group.kind = OXRT_PROGRAM_GROUP_KIND_CALLABLES;
    CHECK_FAILS(pack(), OXRT_ERROR_INVALID_VALUE, "directCallable");
    group.kind = static_cast<OxrtProgramGroupKind>(3);
    CHECK_FAILS(pack(), OXRT_ERROR_INVALID_VALUE, "kind 0x3");
    CHECK_FAILS(oxrtSbtRecordPackHeader(fixture.pipeline, nullptr, 0, record.bytes), OXRT_ERROR_INVALID_VALUE, "NULL");
    CHECK_FAILS(oxrtSbtRecordPackHeader(fixture.pipeline, &group, 0, nullptr), OXRT_ERROR_INVALID_VALUE, "NULL");
}

TEST(badPipelineFilesAreNamed)
{
    Fixture fixture;
    OxrtPipeline pipeline = nullptr;
    CHECK_FAILS(oxrtPipelineLoad(fixture.context, nullptr, &pipeline), OXRT_ERROR_INVALID_VALUE, "NULL");
    CHECK_FAILS(oxrtPipelineLoad(fixture.context, "/nowhere/x.so", &pipeline), OXRT_ERROR_FILE_IO_ERROR, "/nowhere/x.so");
    CHECK_FAILS(oxrtPipelineLoad(fixture.context, __FILE__, &pipeline), OXRT_ERROR_INVALID_FILE_FORMAT, "cannot load");
    CHECK_FAILS(oxrtPipelineLoad(fixture.context, NO_PIPELINE, &pipeline), OXRT_ERROR_ENTRY_SYMBOL_NOT_FOUND, "oxrt_pipeline_v1");
    CHECK_FAILS(oxrtPipelineLoad(fixture.context, OLD_PIPELINE, &pipeline), OXRT_ERROR_UNSUPPORTED_ABI_VERSION, "compile it again");
    CHECK(pipeline == nullptr);
    OxrtPipelineInfo info = {};
    CHECK_SUCCESS(oxrtPipelineGetInfo(fixture.pipeline, &info));
    CHECK_EQUAL(info.lanes, 1u); // not the variant for a machine to come
    CHECK_EQUAL(info.paramsSize, sizeof(TinyParams));
    std::int32_t program = 0;
    CHECK_SUCCESS(oxrtPipelineFindProgram(fixture.pipeline, "__miss__sky", &program));
    CHECK_EQUAL(program, 9);
    CHECK_SUCCESS(oxrtPipelineFindProgram(fixture.pipeline, "__miss__nope", &program));
    CHECK_EQUAL(program, -1);
}

TEST(launchesFromSeveralThreads)
{
    Fixture fixture(3);
    OxrtPipeline second = nullptr;
    CHECK_SUCCESS(oxrtPipelineLoad(fixture.context, TINY_PIPELINE, &second));
    std::atomic<unsigned> wrong{0};
    const auto work = [&](OxrtPipeline pipeline, bool stepped) {
        RecordBytes record;
        OxrtProgramGroupDesc group = {};
        group.kind = OXRT_PROGRAM_GROUP_KIND_RAYGEN;
        group.raygen = "__raygen__count";
        wrong += oxrtSbtRecordPackHeader(pipeline, &group, 0, record.bytes) != OXRT_SUCCESS;
        OxrtShaderBindingTable sbt = {};
        sbt.raygenRecord = record.bytes;
        for (int round = 0; round < 100; ++round) {
            std::vector<std::uint32_t> visits(50 * 50);
            TinyParams params = {};
            params.visits = visits.data();
            if (stepped) {
                wrong += oxrtLaunchBegin(pipeline, &params, sizeof params, &sbt, 50, 50, 1) != OXRT_SUCCESS;
                int done = 0;
                while (!done) wrong += oxrtLaunchWait(pipeline, 50, &done) != OXRT_SUCCESS;
            } else {
                wrong += oxrtLaunch(pipeline, &params, sizeof params, &sbt, 50, 50, 1) != OXRT_SUCCESS;
            }
            for (const std::uint32_t count : visits) wrong += count != 1;
        }
    };
    std::vector<std::thread> threads;
    threads.emplace_back(work, fixture.pipeline, false);
    threads.emplace_back(work, fixture.pipeline, true);
    threads.emplace_back(work, second, false);
    threads.emplace_back(work, second, true);
    for (std::thread& thread : threads) thread.join();
    CHECK_EQUAL(wrong.load(), 0u);
}

TEST(aLaunchKeepsWhatItMayRead)
{
    Fixture fixture(2);
    Triangles mesh = square(2);
    OxrtAccel accel = fixture.build(mesh.input(), OXRT_BUILD_FLAG_ALLOW_UPDATE);
    const OxrtTraversableHandle handle = fixture.handleOf(accel);
    std::vector<TinyHit> hits(64);
    std::atomic<std::uint32_t> started{0};
    std::uint32_t gate = 0;
    TinyParams params = {};
    params.hits = hits.data();
    params.visits = &gate;
    params.started = &started;
    params.scene = handle;
    params.rayMask = 255;
    params.cellSize = 1;
    const OxrtShaderBindingTable sbt = fixture.table("__raygen__gate");
    CHECK_SUCCESS(oxrtLaunchBegin(fixture.pipeline, &params, sizeof params, &sbt, 8, 8, 1));
    int done = 0;
    while (started == 0) CHECK_SUCCESS(oxrtLaunchWait(fixture.pipeline, 1, &done));

    const OxrtBuildInput input = mesh.input();
    CHECK_FAILS(oxrtAccelUpdate(accel, &input, 1), OXRT_ERROR_INVALID_OPERATION, "while a launch");
    CHECK_SUCCESS(oxrtAccelDestroy(accel));
    __atomic_store_n(&gate, 1u, __ATOMIC_RELEASE);
    while (!done) CHECK_SUCCESS(oxrtLaunchWait(fixture.pipeline, 50, &done));

    // The handle went stale, so rays miss; a new accel in its slot does not bring it back.
    for (int i = 0; i < 3; ++i) fixture.build(mesh.input());
    for (const TinyHit& hit : fixture.trace(handle)) CHECK_EQUAL(hit.geometry, ~0u);
}

TEST(destroyingWhileALaunchWaits)
{
    Fixture fixture(1);
    TinyParams params = {};
    const OxrtShaderBindingTable sbt = fixture.table("__raygen__empty");
    CHECK_SUCCESS(oxrtLaunchBegin(fixture.pipeline, &params, sizeof params, &sbt, 64, 64, 1));
    CHECK_SUCCESS(oxrtPipelineDestroy(fixture.pipeline));
    CHECK_FAILS(oxrtPipelineDestroy(fixture.pipeline), OXRT_ERROR_INVALID_VALUE, "does not exist");
    CHECK_SUCCESS(oxrtPipelineLoad(fixture.context, TINY_PIPELINE, &fixture.pipeline));
    const OxrtShaderBindingTable again = fixture.table("__raygen__empty");
    CHECK_SUCCESS(oxrtLaunchBegin(fixture.pipeline, &params, sizeof params, &again, 64, 64, 1));
}

TEST(destroyingAContextWaitsForOtherThreads)
{
    OxrtContextOptions options = {};
    options.threads = 2;
    OxrtContext context = nullptr;
    OxrtPipeline pipeline = nullptr;
    CHECK_SUCCESS(oxrtContextCreate(&options, &context));
    CHECK_SUCCESS(oxrtPipelineLoad(context, TINY_PIPELINE, &pipeline));
    RecordBytes record;
    OxrtProgramGroupDesc group = {};
    group.kind = OXRT_PROGRAM_GROUP_KIND_RAYGEN;
    group.raygen = "__raygen__gate";
    CHECK_SUCCESS(oxrtSbtRecordPackHeader(pipeline, &group, 0, record.bytes));
    std::vector<TinyHit> hits(64);
    std::atomic<std::uint32_t> started{0};
    std::uint32_t gate = 0;
    TinyParams params = {};
    params.hits = hits.data();
    params.visits = &gate;
    params.started = &started;
    OxrtResult result = OXRT_ERROR_INTERNAL_ERROR;
    std::thread launcher([&] {
        OxrtShaderBindingTable sbt = {};
        sbt.raygenRecord = record.bytes;
        result = oxrtLaunch(pipeline, &params, sizeof params, &sbt, 8, 8, 1);
    });
    while (started == 0) std::this_thread::yield();
    std::atomic<bool> destroyed{false};
    std::thread destroyer([&] {
        CHECK_SUCCESS(oxrtContextDestroy(context));
        destroyed = true;
    });
    std::this_thread::sleep_for(20ms);
    CHECK(!destroyed);
    __atomic_store_n(&gate, 1u, __ATOMIC_RELEASE);
    launcher.join();
    destroyer.join();
    CHECK_EQUAL(result, OXRT_SUCCESS);
}

TEST(aContextDoesNotSurviveFork)
{
    Fixture fixture(2);
    CHECK_SUCCESS(fixture.launch("__raygen__empty", {}, 64, 64));
    const pid_t child = fork();
    if (child == 0) {
        const TinyParams params = {};
        OxrtShaderBindingTable sbt = {};
        sbt.raygenRecord = fixture.record.bytes;
        const bool refused = oxrtLaunch(fixture.pipeline, &params, sizeof params, &sbt, 1, 1, 1) == OXRT_ERROR_INVALID_OPERATION &&
                             std::strstr(oxrtGetLastErrorMessage(), "fork") &&
                             oxrtContextDestroy(fixture.context) == OXRT_ERROR_INVALID_OPERATION;
        _exit(refused ? 0 : 1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    CHECK_EQUAL(status, 0);
    CHECK_SUCCESS(fixture.launch("__raygen__empty", {}, 64, 64));
}

int main(int argc, char** argv)
{
    return check::runAll(argc, argv);
}
