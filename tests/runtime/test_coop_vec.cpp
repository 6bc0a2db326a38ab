// Matrices of cooperative vectors: layouts, element types, several networks, and what is refused.
#include "fixture.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace {

constexpr std::uint32_t half = OXRT_COOP_VEC_ELEM_TYPE_FLOAT16;
constexpr std::uint32_t single = OXRT_COOP_VEC_ELEM_TYPE_FLOAT32;
constexpr std::uint32_t rowMajor = OXRT_COOP_VEC_MATRIX_LAYOUT_ROW_MAJOR;
constexpr std::uint32_t columnMajor = OXRT_COOP_VEC_MATRIX_LAYOUT_COLUMN_MAJOR;
constexpr std::uint32_t inferencing = OXRT_COOP_VEC_MATRIX_LAYOUT_INFERENCING_OPTIMAL;

OxrtCoopVecMatrixDescription matrix(std::uint32_t n, std::uint32_t k, std::uint32_t element, std::uint32_t layout, std::uint32_t offset = 0,
                                    std::uint32_t stride = 0)
{
    return {n, k, offset, element, layout, stride, 0};
}

class Converter {
public:
    Converter() { CHECK_SUCCESS(oxrtContextCreate(nullptr, &context)); }
    ~Converter() { CHECK_SUCCESS(oxrtContextDestroy(context)); }
    Converter(const Converter&) = delete;
    Converter& operator=(const Converter&) = delete;

    OxrtResult convert(const OxrtCoopVecMatrixDescription& before, const void* input, const OxrtCoopVecMatrixDescription& after, void* output)
    {
        const OxrtNetworkDescription given = {&before, 1};
        const OxrtNetworkDescription made = {&after, 1};
        return oxrtCoopVecMatrixConvert(context, 1, &given, input, 0, &made, output, 0);
    }
    std::size_t size(std::uint32_t n, std::uint32_t k, std::uint32_t element, std::uint32_t layout, std::uint32_t stride = 0)
    {
        std::size_t bytes = 0;
        CHECK_SUCCESS(oxrtCoopVecMatrixComputeSize(context, n, k, element, layout, stride, &bytes));
        return bytes;
    }

    OxrtContext context = nullptr;
};

} // namespace

TEST(rowsBecomeColumns)
{
    Converter converter;
    const float given[15] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14};
    float made[16 + 5 * 4] = {};
    CHECK_SUCCESS(converter.convert(matrix(3, 5, single, rowMajor), given, matrix(3, 5, single, columnMajor, 64, 16), made));
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 5; ++column) CHECK_EQUAL(made[16 + 4 * column + row], given[5 * row + column]);
}

TEST(sizesAreMultiplesOf64)
{
    Converter converter;
    CHECK_EQUAL(converter.size(3, 5, single, rowMajor), 64u);
    CHECK_EQUAL(converter.size(3, 5, single, rowMajor, 32), 128u);
    CHECK_EQUAL(converter.size(17, 5, half, inferencing), 32u * 5 * 4);
    CHECK_EQUAL(converter.size(17, 5, OXRT_COOP_VEC_ELEM_TYPE_INT8, inferencing), 32u * 6 * 2);
}

TEST(everythingComesBack)
{
    Converter converter;
    for (const std::uint32_t n : {1u, 16u, 17u})
        for (const std::uint32_t k : {1u, 5u, 40u})
            for (const std::uint32_t element : {OXRT_COOP_VEC_ELEM_TYPE_INT8, OXRT_COOP_VEC_ELEM_TYPE_UINT8}) {
                std::vector<std::uint8_t> given(n * k);
                for (std::size_t i = 0; i < given.size(); ++i) given[i] = static_cast<std::uint8_t>(37 * i + 11);
                std::vector<std::uint8_t> kept(converter.size(n, k, element, inferencing));
                std::vector<std::uint8_t> back(converter.size(n, k, element, rowMajor));
                CHECK_SUCCESS(converter.convert(matrix(n, k, element, rowMajor), given.data(), matrix(n, k, element, inferencing), kept.data()));
                CHECK_SUCCESS(converter.convert(matrix(n, k, element, inferencing), kept.data(), matrix(n, k, element, rowMajor), back.data()));
                CHECK(std::memcmp(back.data(), given.data(), given.size()) == 0);
            }
}

TEST(numbersAreRoundedToTheirType)
{
    Converter converter;
    const float infinity = std::numeric_limits<float>::infinity();
    const float given[4] = {1.0f + 0x1p-11f, 70000.0f, -0.0664f, 500.0f};
    std::uint16_t halves[32] = {};
    CHECK_SUCCESS(converter.convert(matrix(1, 4, single, rowMajor), given, matrix(1, 4, half, rowMajor), halves));
    CHECK_EQUAL(halves[0], 0x3c00);
    CHECK_EQUAL(halves[1], 0x7c00);
    float made[64] = {};
    CHECK_SUCCESS(converter.convert(matrix(1, 4, single, rowMajor), given, matrix(1, 4, half, inferencing), made));
    CHECK_EQUAL(made[0], 1.0f);
    CHECK_EQUAL(made[16], infinity);
    CHECK_SUCCESS(converter.convert(matrix(1, 4, single, rowMajor), given, matrix(1, 4, OXRT_COOP_VEC_ELEM_TYPE_FLOAT8_E4M3, inferencing), made));
    CHECK_EQUAL(made[16], 448.0f);
    CHECK_EQUAL(made[32], -0.06640625f + 0.00390625f);
    CHECK_EQUAL(made[1], 0.0f); // rows that fill a tile
}

TEST(networksLieAStrideApartAndMayBeConvertedInPlace)
{
    Converter converter;
    std::vector<float> memory(3 * 16);
    for (std::size_t i = 0; i < memory.size(); ++i) memory[i] = float(i);
    const std::vector<float> given = memory;
    const auto before = matrix(2, 3, single, rowMajor);
    const auto after = matrix(2, 3, single, columnMajor);
    const OxrtNetworkDescription rows = {&before, 1};
    const OxrtNetworkDescription columns = {&after, 1};
    CHECK_SUCCESS(oxrtCoopVecMatrixConvert(converter.context, 3, &rows, memory.data(), 64, &columns, memory.data(), 64));
    for (int network = 0; network < 3; ++network)
        for (int row = 0; row < 2; ++row)
            for (int column = 0; column < 3; ++column)
                CHECK_EQUAL(memory[16 * network + 2 * column + row], given[16 * network + 3 * row + column]);
}

TEST(misuseOfMatricesIsNamed)
{
    Converter converter;
    const float given[64] = {};
    float made[64] = {};
    const auto good = matrix(2, 3, single, rowMajor);
    const auto fails = [&](const OxrtCoopVecMatrixDescription& before, const OxrtCoopVecMatrixDescription& after, const char* text) {
        CHECK_FAILS(converter.convert(before, given, after, made), OXRT_ERROR_INVALID_VALUE, text);
    };
    fails(matrix(0, 3, single, rowMajor), good, "at least one row and one column, this is 0 x 3");
    fails(matrix(2, 3, 7, rowMajor), good, "element type 0x7 is unknown");
    fails(matrix(2, 3, single, 7), good, "layout 0x7 is unknown");
    fails(matrix(1u << 31, 1u << 31, single, rowMajor), good, "at most 2^40");
    fails(matrix(2, 3, OXRT_COOP_VEC_ELEM_TYPE_FLOAT8_E5M2, rowMajor), good, "FLOAT8_E5M2 has an optimal layout");
    fails(matrix(2, 3, single, rowMajor, 0, 8), good, "less than the 12 bytes of one row");
    fails(matrix(2, 3, single, columnMajor, 0, 24), good, "no multiple of 16");
    fails(good, matrix(2, 3, single, rowMajor, 32), "matrix 0 of the output network is at offset 32");
    fails(good, matrix(3, 2, single, rowMajor), "2 x 3 in the input network and 3 x 2 in the output");
    fails(good, matrix(2, 3, OXRT_COOP_VEC_ELEM_TYPE_INT32, rowMajor), "FLOAT32 is not converted to INT32");
    auto small = good;
    small.sizeInBytes = 32;
    fails(small, good, "says 32 bytes, it takes 64");
    CHECK_FAILS(converter.convert(good, nullptr, good, made), OXRT_ERROR_INVALID_VALUE, "the memory of the input networks is NULL");
    CHECK_FAILS(converter.convert(good, given, good, nullptr), OXRT_ERROR_INVALID_VALUE, "the memory of the output networks is NULL");

    const OxrtNetworkDescription network = {&good, 1};
    const OxrtNetworkDescription empty = {nullptr, 0};
    const OxrtNetworkDescription nothing = {nullptr, 2};
    const OxrtCoopVecMatrixDescription both[] = {good, good};
    const OxrtNetworkDescription two = {both, 2};
    const auto several = [&](const OxrtNetworkDescription* input, const OxrtNetworkDescription* output, std::uint32_t count = 1,
                             std::size_t inputStride = 64, std::size_t outputStride = 64) {
        return oxrtCoopVecMatrixConvert(converter.context, count, input, given, inputStride, output, made, outputStride);
    };
    CHECK_FAILS(several(nullptr, &network), OXRT_ERROR_INVALID_VALUE, "description of the input network is NULL");
    CHECK_FAILS(several(&network, nullptr), OXRT_ERROR_INVALID_VALUE, "description of the output network is NULL");
    CHECK_FAILS(several(&empty, &network), OXRT_ERROR_INVALID_VALUE, "the input network has no matrix");
    CHECK_FAILS(several(&network, &nothing), OXRT_ERROR_INVALID_VALUE, "`layers` is NULL");
    CHECK_FAILS(several(&network, &two), OXRT_ERROR_INVALID_VALUE, "1 matrices and the output network 2");
    CHECK_FAILS(several(&network, &network, 0), OXRT_ERROR_INVALID_VALUE, "must be 1 or more");
    CHECK_FAILS(several(&network, &network, 2, 16), OXRT_ERROR_INVALID_VALUE, "the stride of the input networks is 16");
    CHECK_FAILS(several(&network, &network, 2, 64, 40), OXRT_ERROR_INVALID_VALUE, "the stride of the output networks is 40");
    CHECK_FAILS(oxrtCoopVecMatrixConvert(nullptr, 1, &network, given, 0, &network, made, 0), OXRT_ERROR_INVALID_DEVICE_CONTEXT, "NULL");
    CHECK_FAILS(oxrtCoopVecMatrixComputeSize(converter.context, 2, 3, single, rowMajor, 0, nullptr), OXRT_ERROR_INVALID_VALUE, "NULL");
}

int main(int argc, char** argv)
{
    return check::runAll(argc, argv);
}
