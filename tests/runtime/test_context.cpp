// Finding Embree, contexts, the log. The first tests need a process that has not loaded Embree yet.
#include "fixture.h"

#include <cstdlib>

namespace {

std::string realEmbree;

struct Log {
    std::vector<std::string> lines;
    static void append(unsigned level, const char* tag, const char* message, void* data)
    {
        static_cast<Log*>(data)->lines.push_back(std::to_string(level) + tag + message);
    }
    bool holds(const char* fragment) const
    {
        for (const std::string& line : lines)
            if (line.find(fragment) != std::string::npos) return true;
        return false;
    }
};

} // namespace

TEST(aMissingEmbreeHasARemedy)
{
    OxrtContext context = nullptr;
    setenv("OXRT_EMBREE", "/nowhere/libembree4.so.4", 1);
    CHECK_FAILS(oxrtContextCreate(nullptr, &context), OXRT_ERROR_LIBRARY_NOT_FOUND, "/nowhere/libembree4.so.4");
    CHECK_FAILS(oxrtContextCreate(nullptr, &context), OXRT_ERROR_LIBRARY_NOT_FOUND, "pip install embreex");
    setenv("OXRT_EMBREE", "libm.so.6", 1);
    CHECK_FAILS(oxrtContextCreate(nullptr, &context), OXRT_ERROR_LIBRARY_NOT_FOUND, "not an Embree 4 library");
    setenv("OXRT_EMBREE", OLD_EMBREE, 1);
    CHECK_FAILS(oxrtContextCreate(nullptr, &context), OXRT_ERROR_LIBRARY_NOT_FOUND, "is Embree 3.13, but version 4 is needed");
    unsetenv("OXRT_EMBREE");
    CHECK(context == nullptr);
}

TEST(thePathOfTheOptionsIsUsed)
{
    OxrtContextOptions options = {};
    options.embreePath = realEmbree.c_str();
    options.threads = 3;
    OxrtContext context = nullptr;
    CHECK_SUCCESS(oxrtContextCreate(&options, &context));
    OxrtContextInfo info = {};
    CHECK_SUCCESS(oxrtContextGetInfo(context, &info));
    CHECK_EQUAL(info.threads, 3u);
    CHECK(info.embreeVersion >= 40000);
    CHECK_EQUAL(info.embreeMaxInstanceLevels, 1u);
    CHECK(std::strstr(info.embreePath, "libembree4"));
    CHECK_SUCCESS(oxrtContextDestroy(context));
    CHECK_FAILS(oxrtContextDestroy(context), OXRT_ERROR_INVALID_DEVICE_CONTEXT, "does not exist");
    CHECK_FAILS(oxrtContextGetInfo(context, &info), OXRT_ERROR_INVALID_DEVICE_CONTEXT, "does not exist");
}

TEST(aLoadedEmbreeWins)
{
    OxrtContextOptions options = {};
    options.embreePath = "/another/libembree4.so.4";
    OxrtContext context = nullptr;
    CHECK_SUCCESS(oxrtContextCreate(&options, &context));
    CHECK_SUCCESS(oxrtContextDestroy(context));
}

TEST(optionsAreChecked)
{
    OxrtContext context = nullptr;
    OxrtContextOptions options = {};
    CHECK_FAILS(oxrtContextCreate(&options, nullptr), OXRT_ERROR_INVALID_VALUE, "NULL");
    options.threads = 100000;
    CHECK_FAILS(oxrtContextCreate(&options, &context), OXRT_ERROR_INVALID_VALUE, "threads is 100000");
    options.threads = 0;
    options.validation = 2;
    CHECK_FAILS(oxrtContextCreate(&options, &context), OXRT_ERROR_INVALID_VALUE, "validation is 2");
    options.validation = 0;
    options.logCallbackLevel = 5;
    CHECK_FAILS(oxrtContextCreate(&options, &context), OXRT_ERROR_INVALID_VALUE, "log level is 5");
}

TEST(theLogTellsFailuresUpToItsLevel)
{
    Log log;
    OxrtContextOptions options = {};
    options.logCallback = Log::append;
    options.logCallbackData = &log;
    options.logCallbackLevel = 4;
    OxrtContext context = nullptr;
    CHECK_SUCCESS(oxrtContextCreate(&options, &context));
    CHECK(log.holds("4CONTEXTEmbree 4."));
    OxrtPipeline pipeline = nullptr;
    CHECK_EQUAL(oxrtPipelineLoad(context, "/nowhere", &pipeline), OXRT_ERROR_FILE_IO_ERROR);
    CHECK(log.holds("2PIPELINEcannot read"));
    log.lines.clear();
    CHECK_SUCCESS(oxrtContextSetLogCallback(context, Log::append, &log, 1));
    CHECK_EQUAL(oxrtPipelineLoad(context, "/nowhere", &pipeline), OXRT_ERROR_FILE_IO_ERROR);
    CHECK_EQUAL(log.lines.size(), 0u);
    CHECK_SUCCESS(oxrtContextSetLogCallback(context, nullptr, nullptr, 4));
    CHECK_EQUAL(oxrtPipelineLoad(context, "/nowhere", &pipeline), OXRT_ERROR_FILE_IO_ERROR);
    CHECK_SUCCESS(oxrtContextDestroy(context));
}

TEST(resultsHaveNames)
{
    CHECK_EQUAL(std::string(oxrtGetErrorName(OXRT_SUCCESS)), "OXRT_SUCCESS");
    CHECK_EQUAL(std::string(oxrtGetErrorName(OXRT_ERROR_VALIDATION_FAILURE)), "OXRT_ERROR_VALIDATION_FAILURE");
    CHECK_EQUAL(std::string(oxrtGetErrorString(OXRT_ERROR_INVALID_VALUE)), "Invalid value");
    CHECK_EQUAL(std::string(oxrtGetErrorName(static_cast<OxrtResult>(5))), "Unrecognized OxrtResult code");
    CHECK(oxrtGetVersion()[0] != '\0');
}

TEST(destroyingAContextDestroysItsObjects)
{
    OxrtAccel accel = nullptr;
    OxrtPipeline pipeline = nullptr;
    {
        Fixture fixture;
        Triangles mesh = square(1);
        accel = fixture.build(mesh.input());
        fixture.build(instanceInput({instanceOf(fixture.handleOf(accel))}));
        pipeline = fixture.pipeline;
    }
    OxrtAccelInfo info;
    CHECK_FAILS(oxrtAccelGetInfo(accel, &info), OXRT_ERROR_INVALID_VALUE, "does not exist");
    CHECK_FAILS(oxrtPipelineDestroy(pipeline), OXRT_ERROR_INVALID_VALUE, "does not exist");
}

int main(int argc, char** argv)
{
    const char* path = std::getenv("OXRT_EMBREE");
    realEmbree = path ? path : "libembree4.so.4";
    return check::runAll(argc, argv);
}
