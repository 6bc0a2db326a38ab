// Matrices of cooperative vectors in memory: their sizes, and conversion between layouts and element types. Kernels read the same places
// (oxrt/coop_vec_matrix.h): optimal layouts hold tiles of 16 rows, column after column, floating-point numbers of all sizes as float32 and
// 8-bit integers as int16, two columns side by side.
#include "context.h"
#include "error.h"
#include "objects.h"
#include "oxrt/coop_vec.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

namespace oxrt {

namespace {

constexpr std::uint32_t sizeMultiple = 64;
constexpr std::uint32_t strideMultiple = 16;
constexpr std::uint64_t maxElements = std::uint64_t(1) << 40;

struct ElementType {
    std::uint32_t number;
    const char* name;
    std::uint32_t size;
    bool isFloat;
};

constexpr ElementType elementTypes[] = {
    {OXRT_COOP_VEC_ELEM_TYPE_FLOAT16, "FLOAT16", 2, true},          {OXRT_COOP_VEC_ELEM_TYPE_FLOAT32, "FLOAT32", 4, true},
    {OXRT_COOP_VEC_ELEM_TYPE_UINT8, "UINT8", 1, false},             {OXRT_COOP_VEC_ELEM_TYPE_INT8, "INT8", 1, false},
    {OXRT_COOP_VEC_ELEM_TYPE_UINT32, "UINT32", 4, false},           {OXRT_COOP_VEC_ELEM_TYPE_INT32, "INT32", 4, false},
    {OXRT_COOP_VEC_ELEM_TYPE_FLOAT8_E4M3, "FLOAT8_E4M3", 1, true},  {OXRT_COOP_VEC_ELEM_TYPE_FLOAT8_E5M2, "FLOAT8_E5M2", 1, true},
};

const ElementType& elementOf(std::uint32_t number)
{
    for (const ElementType& type : elementTypes)
        if (type.number == number) return type;
    fail(OXRT_ERROR_INVALID_VALUE, "element type 0x%x is unknown; give one of OXRT_COOP_VEC_ELEM_TYPE_...", number);
}

// One matrix whose description was found right.
class MatrixInMemory {
public:
    MatrixInMemory(std::uint32_t rowCount, std::uint32_t columnCount, std::uint32_t type, std::uint32_t arrangement, std::uint32_t stride)
        : element(elementOf(type)), rows(rowCount), columns(columnCount), layout(arrangement), lineStride(stride)
    {
        if (layout < OXRT_COOP_VEC_MATRIX_LAYOUT_ROW_MAJOR || layout > OXRT_COOP_VEC_MATRIX_LAYOUT_TRAINING_OPTIMAL)
            fail(OXRT_ERROR_INVALID_VALUE, "matrix layout 0x%x is unknown; give one of OXRT_COOP_VEC_MATRIX_LAYOUT_...", layout);
        if (rows == 0 || columns == 0)
            fail(OXRT_ERROR_INVALID_VALUE, "a matrix has at least one row and one column, this is %u x %u", rows, columns);
        if (std::uint64_t(rows) * columns > maxElements)
            fail(OXRT_ERROR_INVALID_VALUE, "a matrix of %u x %u elements; one has at most 2^40", rows, columns);
        if (isFloat8() && !isOptimal()) fail(OXRT_ERROR_INVALID_VALUE, "a matrix of %s has an optimal layout", element.name);
        if (isOptimal()) return;
        const std::uint64_t line = std::uint64_t(lineLength()) * element.size;
        if (lineStride != 0 && lineStride < line)
            fail(OXRT_ERROR_INVALID_VALUE, "a stride of %u bytes is less than the %llu bytes of one %s; 0 stands for no gaps", lineStride,
                 static_cast<unsigned long long>(line), isRowMajor() ? "row" : "column");
        if (lineStride % strideMultiple != 0)
            fail(OXRT_ERROR_INVALID_VALUE, "a stride of %u bytes is no multiple of %u; 0 stands for no gaps", lineStride, strideMultiple);
    }

    bool isOptimal() const { return layout >= OXRT_COOP_VEC_MATRIX_LAYOUT_INFERENCING_OPTIMAL; }
    bool isFloat8() const { return element.isFloat && element.size == 1; }
    bool isByte() const { return !element.isFloat && element.size == 1; }

    // Bytes up to the end of the last element; tiles are whole.
    std::uint64_t extent() const
    {
        if (!isOptimal()) return (lineCount() - 1) * stride() + std::uint64_t(lineLength()) * element.size;
        const std::uint64_t tiles = (std::uint64_t(rows) + TILE_ROWS - 1) / TILE_ROWS;
        return tiles * TILE_ROWS * (isByte() ? columns + columns % 2 : columns) * storedSize();
    }
    // With the gaps behind all lines, a multiple of 64.
    std::uint64_t size() const
    {
        const std::uint64_t bytes = isOptimal() ? extent() : lineCount() * stride();
        return (bytes + sizeMultiple - 1) / sizeMultiple * sizeMultiple;
    }

    // Numbers of any floating-point type; integers as 32 bits.
    template <class Number>
    Number read(const std::uint8_t* memory, std::uint32_t row, std::uint32_t column) const
    {
        const std::uint8_t* place = memory + offset(row, column);
        if constexpr (std::is_same_v<Number, float>) {
            if (isOptimal() || element.size == 4) return load<float>(place);
            return float(load<half>(place));
        } else {
            if (element.size == 4) return load<std::int32_t>(place);
            if (isOptimal()) return load<std::int16_t>(place);
            return element.number == OXRT_COOP_VEC_ELEM_TYPE_INT8 ? load<std::int8_t>(place) : load<std::uint8_t>(place);
        }
    }
    template <class Number>
    void write(std::uint8_t* memory, std::uint32_t row, std::uint32_t column, Number number) const
    {
        std::uint8_t* place = memory + offset(row, column);
        if constexpr (std::is_same_v<Number, float>) {
            const float kept = rounded(number);
            if (isOptimal() || element.size == 4)
                store(place, kept);
            else
                store(place, half(kept));
        } else if (element.size == 4)
            store(place, number);
        else if (isOptimal())
            store(place, static_cast<std::int16_t>(number));
        else
            store(place, static_cast<std::uint8_t>(number));
    }

    const ElementType& element;
    const std::uint32_t rows, columns;

private:
    bool isRowMajor() const { return layout == OXRT_COOP_VEC_MATRIX_LAYOUT_ROW_MAJOR; }
    std::uint64_t lineCount() const { return isRowMajor() ? rows : columns; }
    std::uint32_t lineLength() const { return isRowMajor() ? columns : rows; }
    std::uint64_t stride() const { return lineStride != 0 ? lineStride : std::uint64_t(lineLength()) * element.size; }
    std::uint32_t storedSize() const { return !isOptimal() ? element.size : isByte() ? 2 : 4; }

    std::uint64_t offset(std::uint64_t row, std::uint64_t column) const
    {
        if (!isOptimal()) return (isRowMajor() ? row : column) * stride() + (isRowMajor() ? column : row) * element.size;
        const std::uint64_t tile = row / TILE_ROWS;
        const std::uint64_t inTile = row % TILE_ROWS;
        if (!isByte()) return ((tile * columns + column) * TILE_ROWS + inTile) * 4;
        const std::uint64_t pairs = (std::uint64_t(columns) + 1) / 2;
        return (((tile * pairs + column / 2) * TILE_ROWS + inTile) * 2 + column % 2) * 2;
    }
    float rounded(float number) const
    {
        switch (element.number) {
        case OXRT_COOP_VEC_ELEM_TYPE_FLOAT16: return float(half(number));
        case OXRT_COOP_VEC_ELEM_TYPE_FLOAT8_E4M3: return interpreted<MatrixElement::FLOAT8_E4M3>(number);
        case OXRT_COOP_VEC_ELEM_TYPE_FLOAT8_E5M2: return interpreted<MatrixElement::FLOAT8_E5M2>(number);
        default: return number;
        }
    }

    template <class T>
    static T load(const std::uint8_t* place)
    {
        T value;
        std::memcpy(&value, place, sizeof value);
        return value;
    }
    template <class T>
    static void store(std::uint8_t* place, const T& value)
    {
        std::memcpy(place, &value, sizeof value);
    }

    const std::uint32_t layout, lineStride;
};

MatrixInMemory matrixOf(const OxrtCoopVecMatrixDescription& told)
{
    return MatrixInMemory(told.n, told.k, told.elementType, told.layout, told.rowColumnStrideInBytes);
}

void checkNetwork(const OxrtNetworkDescription* network, const void* memory, const char* what)
{
    if (!network) fail(OXRT_ERROR_INVALID_VALUE, "the description of the %s network is NULL", what);
    if (network->numLayers == 0) fail(OXRT_ERROR_INVALID_VALUE, "the %s network has no matrix", what);
    if (!network->layers) fail(OXRT_ERROR_INVALID_VALUE, "the %s network has %u matrices but `layers` is NULL", what, network->numLayers);
    if (!memory) fail(OXRT_ERROR_INVALID_VALUE, "the memory of the %s networks is NULL", what);
    for (std::uint32_t i = 0; i < network->numLayers; ++i) {
        const OxrtCoopVecMatrixDescription& told = network->layers[i];
        const std::uint64_t size = matrixOf(told).size();
        if (told.offsetInBytes % sizeMultiple != 0)
            fail(OXRT_ERROR_INVALID_VALUE, "matrix %u of the %s network is at offset %u, which is no multiple of %u", i, what,
                 told.offsetInBytes, sizeMultiple);
        if (told.sizeInBytes != 0 && told.sizeInBytes < size)
            fail(OXRT_ERROR_INVALID_VALUE, "matrix %u of the %s network says %u bytes, it takes %llu; write 0 or that", i, what,
                 told.sizeInBytes, static_cast<unsigned long long>(size));
    }
}

void checkStride(const OxrtNetworkDescription& network, std::size_t stride, const char* what)
{
    std::uint64_t end = 0;
    for (std::uint32_t i = 0; i < network.numLayers; ++i)
        end = std::max(end, network.layers[i].offsetInBytes + matrixOf(network.layers[i]).extent());
    if (stride < end || stride % sizeMultiple != 0)
        fail(OXRT_ERROR_INVALID_VALUE,
             "the stride of the %s networks is %zu; networks of %llu bytes need a multiple of %u that is not below it",
             what, stride, static_cast<unsigned long long>(end), sizeMultiple);
}

void checkPair(const MatrixInMemory& from, const MatrixInMemory& to, std::uint32_t number)
{
    if (from.rows != to.rows || from.columns != to.columns)
        fail(OXRT_ERROR_INVALID_VALUE, "matrix %u is %u x %u in the input network and %u x %u in the output network; give one shape", number,
             from.rows, from.columns, to.rows, to.columns);
    if (from.element.number == to.element.number) return;
    const bool bothSmall = from.isFloat8() && to.isFloat8();
    if (!from.element.isFloat || !to.element.isFloat || bothSmall)
        fail(OXRT_ERROR_INVALID_VALUE,
             "%s is not converted to %s: only FLOAT32 and FLOAT16 and numbers of fewer bits are converted to each other", from.element.name,
             to.element.name);
}

// Through a copy, because input and output may be the same memory.
template <class Number>
void convertMatrix(const MatrixInMemory& from, const std::uint8_t* source, const MatrixInMemory& to, std::uint8_t* target)
{
    std::vector<Number> elements;
    elements.reserve(std::size_t(from.rows) * from.columns);
    for (std::uint32_t row = 0; row < from.rows; ++row)
        for (std::uint32_t column = 0; column < from.columns; ++column) elements.push_back(from.read<Number>(source, row, column));
    if (to.isOptimal()) std::memset(target, 0, to.extent()); // rows that fill a tile are multiplied too
    const Number* next = elements.data();
    for (std::uint32_t row = 0; row < to.rows; ++row)
        for (std::uint32_t column = 0; column < to.columns; ++column) to.write(target, row, column, *next++);
}

} // namespace

} // namespace oxrt

using namespace oxrt;

OxrtResult oxrtCoopVecMatrixComputeSize(OxrtContext context, uint32_t n, uint32_t k, uint32_t elementType, uint32_t layout,
                                        uint32_t rowColumnStrideInBytes, size_t* sizeInBytes)
{
    return guard([&] {
        find(context)->attempt("COOP_VEC", [&] {
            if (!sizeInBytes) fail(OXRT_ERROR_INVALID_VALUE, "the result pointer `sizeInBytes` is NULL");
            *sizeInBytes = MatrixInMemory(n, k, elementType, layout, rowColumnStrideInBytes).size();
        });
    });
}

OxrtResult oxrtCoopVecMatrixConvert(OxrtContext context, uint32_t numNetworks, const OxrtNetworkDescription* inputNetwork, const void* input,
                                    size_t inputStrideInBytes, const OxrtNetworkDescription* outputNetwork, void* output,
                                    size_t outputStrideInBytes)
{
    return guard([&] {
        find(context)->attempt("COOP_VEC", [&] {
            if (numNetworks == 0) fail(OXRT_ERROR_INVALID_VALUE, "the number of networks must be 1 or more, not 0");
            checkNetwork(inputNetwork, input, "input");
            checkNetwork(outputNetwork, output, "output");
            if (inputNetwork->numLayers != outputNetwork->numLayers)
                fail(OXRT_ERROR_INVALID_VALUE, "the input network has %u matrices and the output network %u; give the same ones",
                     inputNetwork->numLayers, outputNetwork->numLayers);
            for (std::uint32_t i = 0; i < inputNetwork->numLayers; ++i)
                checkPair(matrixOf(inputNetwork->layers[i]), matrixOf(outputNetwork->layers[i]), i);
            if (numNetworks > 1) {
                checkStride(*inputNetwork, inputStrideInBytes, "input");
                checkStride(*outputNetwork, outputStrideInBytes, "output");
            }
            for (std::uint32_t network = 0; network < numNetworks; ++network)
                for (std::uint32_t i = 0; i < inputNetwork->numLayers; ++i) {
                    const OxrtCoopVecMatrixDescription& old = inputNetwork->layers[i];
                    const OxrtCoopVecMatrixDescription& made = outputNetwork->layers[i];
                    const MatrixInMemory from = matrixOf(old);
                    const MatrixInMemory to = matrixOf(made);
                    const auto* source = static_cast<const std::uint8_t*>(input) + network * inputStrideInBytes + old.offsetInBytes;
                    auto* target = static_cast<std::uint8_t*>(output) + network * outputStrideInBytes + made.offsetInBytes;
                    if (from.element.isFloat)
                        convertMatrix<float>(from, source, to, target);
                    else
                        convertMatrix<std::int32_t>(from, source, to, target);
                }
        });
    });
}
