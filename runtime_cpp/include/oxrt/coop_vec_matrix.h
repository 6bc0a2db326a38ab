/* Products of a matrix in memory with cooperative vectors.
 *
 * Every result starts as its bias and takes its products one after the other, columns upwards: in binary32 with one rounding for each
 * (fused), or in 32-bit integers that wrap; then it is rounded to the type of the result. So all widths, layouts and compilers agree.
 * Results are computed 16 at a time, each in a register (of lanes), because that many additions must be under way at once.
 */
#ifndef OXRT_COOP_VEC_MATRIX_H
#define OXRT_COOP_VEC_MATRIX_H

#include <oxrt/coop_vec.h>

namespace oxrt {
inline namespace OXRT_ISA {

/* OptiX's numbers. */
enum class MatrixElement : uint32_t {
    FLOAT16 = 0x2A01,
    FLOAT32 = 0x2A03,
    UINT8 = 0x2A04,
    INT8 = 0x2A05,
    FLOAT8_E4M3 = 0x2A0A,
    FLOAT8_E5M2 = 0x2A0B
};
enum class MatrixLayout : uint32_t { ROW_MAJOR = 0x2A40, COLUMN_MAJOR = 0x2A41, INFERENCING_OPTIMAL = 0x2A42, TRAINING_OPTIMAL = 0x2A43 };

constexpr bool isOptimal(MatrixLayout layout) {
    return layout == MatrixLayout::INFERENCING_OPTIMAL || layout == MatrixLayout::TRAINING_OPTIMAL;
}
constexpr bool isByte(MatrixElement element) { return element == MatrixElement::UINT8 || element == MatrixElement::INT8; }

/* Rows of a tile of the optimal layouts, and columns that other layouts are rearranged by. */
enum : int { TILE_ROWS = 16, PART_COLUMNS = 16 };

/* Rows without and with gaps: what a matrix of ROWS x COLUMNS elements takes in memory, from its first byte to its last. */
template <MatrixElement E> using MemoryElement =
    typename ChooseType<E == MatrixElement::FLOAT16, half,
                        typename ChooseType<E == MatrixElement::UINT8, uint8_t,
                                            typename ChooseType<E == MatrixElement::INT8, int8_t, float>::Type>::Type>::Type;

template <MatrixElement E, MatrixLayout L> constexpr uint32_t lineStride(int rows, int columns, uint32_t stride) {
    return stride != 0 ? stride : uint32_t(L == MatrixLayout::ROW_MAJOR ? columns : rows) * uint32_t(sizeof(MemoryElement<E>));
}
template <MatrixElement E, MatrixLayout L> constexpr uint64_t matrixBytes(int rows, int columns, uint32_t stride) {
    if (isOptimal(L)) {
        const uint64_t tiles = uint64_t(rows + TILE_ROWS - 1) / TILE_ROWS;
        return tiles * TILE_ROWS * 4 * uint64_t(isByte(E) ? (columns + 1) / 2 : columns);
    }
    const int lines = L == MatrixLayout::ROW_MAJOR ? rows : columns;
    const int length = L == MatrixLayout::ROW_MAJOR ? columns : rows;
    return uint64_t(lines - 1) * lineStride<E, L>(rows, columns, stride) + uint64_t(length) * sizeof(MemoryElement<E>);
}

/* ---- input --------------------------------------------------------------------------------------------------------------------- */

/* The nearest number of 8 bits, ties to even, beyond the largest that one. MANTISSA bits follow the leading one. */
template <int MANTISSA, int LOWEST_EXPONENT, class C> OXRT_INLINE C roundToFloat8(C x, float largest) {
    constexpr uint32_t dropped = 23 - MANTISSA;
    constexpr float lowest = 1.0f / float(1 << -LOWEST_EXPONENT);
    constexpr float shift = 1.5f * float(1 << (23 + LOWEST_EXPONENT - MANTISSA));
    const C magnitude = abs(x);
    const Rebind<C, uint32_t> bits = floatAsUint(magnitude);
    const Rebind<C, uint32_t> up = bits + ((1u << (dropped - 1)) - 1u) + ((bits >> dropped) & 1u);
    const C normal = uintAsFloat(up & ~((1u << dropped) - 1u));
    const C small = (magnitude + shift) - shift;
    const C near = select(magnitude < lowest, small, normal);
    const C limited = select(near > largest, C(largest), near);
    return select(x == x, copysign(limited, x), x);
}

/* A whole number that int32 holds: the plain conversion, which compilers make of many numbers at once. */
template <Scalar C> OXRT_INLINE int32_t smallInteger(C x) { return int32_t(x); }
template <Number C> requires(!Scalar<C>) OXRT_INLINE auto smallInteger(C x) { return convert<int32_t>(x); }

/* The item as the matrix takes it. Integers are limited to the range; a fraction goes to the nearest, ties to even, NaN to 0. */
template <MatrixElement INNER, class C> OXRT_INLINE auto interpreted(C x) {
    if constexpr (INNER == MatrixElement::FLOAT8_E4M3)
        return roundToFloat8<3, -6>(x, 448.0f);
    else if constexpr (INNER == MatrixElement::FLOAT8_E5M2)
        return roundToFloat8<2, -14>(x, 57344.0f);
    else if constexpr (isByte(INNER)) {
        constexpr int lowest = INNER == MatrixElement::INT8 ? -128 : 0, highest = INNER == MatrixElement::INT8 ? 127 : 255;
        using E = ElementOf<C>;
        if constexpr (isFloating<E>)
            return smallInteger(C(select(x == x, C(max(E(lowest), C(min(C(round(x)), E(highest))))), C(E(0)))));
        else if constexpr (isSigned<E>)
            return C(max(E(lowest), C(min(x, E(highest)))));
        else
            return convert<int32_t>(C(min(x, E(highest))));
    } else
        return x;
}

/* The items as factors: numbers, or for integers pairs of neighbours in one word. Beyond the last stands zero. */
template <MatrixElement INNER, class T, int K, class X, class S, int COLUMNS>
OXRT_INLINE void readFactors(S (&factors)[COLUMNS], const CoopVec<T, K, X>& vector) {
    if constexpr (isByte(INNER)) {
        S whole[2 * COLUMNS];
        for (int k = 0; k < K; ++k)
            whole[k] = S(interpreted<INNER>(computed<T>(vector, k)));
        if constexpr (K % 2 != 0)
            whole[K] = S(0);
        for (int j = 0; j < COLUMNS; ++j)
            factors[j] = (whole[2 * j] & 0xffff) | (whole[2 * j + 1] << 16);
    } else
        for (int k = 0; k < COLUMNS; ++k)
            factors[k] = S(interpreted<INNER>(computed<T>(vector, k)));
}

/* ---- parts of matrices that are rearranged ------------------------------------------------------------------------------------- */

OXRT_INLINE void widenSpan(float* to, const char* from, int count, float) { __builtin_memcpy(to, from, 4 * size_t(count)); }
OXRT_INLINE void widenSpan(float* to, const char* from, int count, half) {
    int i = 0;
#ifdef __F16C__
    typedef short Halves __attribute__((vector_size(16)));
    typedef float Floats __attribute__((vector_size(32)));
    for (; i + 8 <= count; i += 8) {
        Halves halves;
        __builtin_memcpy(&halves, from + 2 * i, 16);
        const Floats floats = __builtin_ia32_vcvtph2ps256(halves);
        __builtin_memcpy(to + i, &floats, 32);
    }
#endif
    for (; i < count; ++i) {
        half one;
        __builtin_memcpy(&one, from + 2 * i, 2);
        to[i] = float(one);
    }
}

/* Two integers as one word, the first in the low half. */
template <class B> OXRT_INLINE int32_t pairOf(const char* first, const char* second) {
    const int32_t high = second == nullptr ? 0 : int32_t(B(*second));
    return int32_t((uint32_t(int32_t(B(*first))) & 0xffffu) | uint32_t(high) << 16);
}

/* `count` columns from `column` on, of ROWS rows: row r, column k at part[16 * r + k] of row-major, at part[16 * k + r] of column-major
   matrices. Columns of integers are pairs. */
template <int ROWS, int K, MatrixElement E, MatrixLayout L>
OXRT_INLINE void readPart(float* part, const char* matrix, uint32_t stride, int row, int column, int count) {
    using M = MemoryElement<E>;
    if constexpr (L == MatrixLayout::ROW_MAJOR)
        for (int r = 0; r < ROWS; ++r)
            widenSpan(part + PART_COLUMNS * r, matrix + uint64_t(row + r) * stride + sizeof(M) * size_t(column), count, M());
    else
        for (int k = 0; k < count; ++k)
            widenSpan(part + TILE_ROWS * k, matrix + uint64_t(column + k) * stride + sizeof(M) * size_t(row), ROWS, M());
}
template <int ROWS, int K, MatrixElement E, MatrixLayout L>
OXRT_INLINE void readPart(int32_t* part, const char* matrix, uint32_t stride, int row, int column, int count) {
    using B = MemoryElement<E>;
    constexpr bool isByRows = L == MatrixLayout::ROW_MAJOR;
    const uint64_t next = isByRows ? 1 : stride;
    for (int r = 0; r < ROWS; ++r)
        for (int k = 0; k < count; ++k) {
            const int first = 2 * (column + k);
            const char* place = isByRows ? matrix + uint64_t(row + r) * stride + first : matrix + uint64_t(first) * stride + row + r;
            part[isByRows ? PART_COLUMNS * r + k : TILE_ROWS * k + r] = pairOf<B>(place, first + 1 < K ? place + next : nullptr);
        }
}

/* ---- products ------------------------------------------------------------------------------------------------------------------ */

OXRT_INLINE float addProduct(float sum, float weight, float factor) { return __builtin_fmaf(weight, factor, sum); }
/* The products of both halves. */
OXRT_INLINE int32_t addProduct(int32_t sum, int32_t weight, int32_t factor) {
    return sum + (weight << 16 >> 16) * (factor << 16 >> 16) + (weight >> 16) * (factor >> 16);
}

/* How many results of this number are computed at once; registers hold them and what they are multiplied with. */
template <class S> inline constexpr int ROWS_AT_ONCE = TILE_ROWS;

/* sums[r] += weight (r, k) * factors[k], k upwards, where weight (r, k) stands at weights[ROW_STEP * r + COLUMN_STEP * k]. */
template <int ROW_STEP, int COLUMN_STEP, int ROWS, class S, class M>
OXRT_INLINE void addProducts(S (&sums)[ROWS], const M* weights, const S* factors, int columns) {
    for (int k = 0; k < columns; ++k) {
        const S factor = factors[k];
#pragma GCC unroll 16
        for (int r = 0; r < ROWS; ++r)
            sums[r] = addProduct(sums[r], weights[ROW_STEP * r + COLUMN_STEP * k], factor);
    }
}

/* Pairs of integers in scalar code: 16 rows are one value, which compilers left to themselves do not see. */
template <int ROW_STEP, int COLUMN_STEP> requires(ROW_STEP == 1)
OXRT_INLINE void addProducts(int32_t (&sums)[TILE_ROWS], const int32_t* weights, const int32_t* factors, int columns) {
    typedef int32_t Column __attribute__((vector_size(4 * TILE_ROWS)));
    Column total;
    __builtin_memcpy(&total, sums, sizeof(total));
    for (int k = 0; k < columns; ++k) {
        Column column;
        __builtin_memcpy(&column, weights + COLUMN_STEP * k, sizeof(column));
        total += (column << 16 >> 16) * (factors[k] << 16 >> 16) + (column >> 16) * (factors[k] >> 16);
    }
    __builtin_memcpy(sums, &total, sizeof(total));
}

/* ROWS results from `row` on. */
template <int ROWS, int N, int K, MatrixElement E, MatrixLayout L, bool TRANSPOSE, class S>
OXRT_INLINE void multiplyRows(S* results, const char* matrix, uint32_t stride, int row, const S* factors) {
    using M = ElementOf<S>;
    constexpr int columns = isByte(E) ? (K + 1) / 2 : K;
    S sums[ROWS];
    for (int r = 0; r < ROWS; ++r)
        sums[r] = results[r];
    const M* words = reinterpret_cast<const M*>(matrix);
    if constexpr (isOptimal(L) && !TRANSPOSE)
        addProducts<1, TILE_ROWS>(sums, words + int64_t(row / TILE_ROWS) * TILE_ROWS * columns + row % TILE_ROWS, factors, columns);
    else if constexpr (isOptimal(L)) {
        /* The tiles run along our columns. */
        for (int k = 0; k < columns; k += TILE_ROWS)
            addProducts<TILE_ROWS, 1>(sums, words + int64_t(k) * N + TILE_ROWS * row, factors + k,
                                      columns - k < TILE_ROWS ? columns - k : int(TILE_ROWS));
    } else
        for (int k = 0; k < columns; k += PART_COLUMNS) {
            M part[TILE_ROWS * PART_COLUMNS];
            const int count = columns - k < PART_COLUMNS ? columns - k : int(PART_COLUMNS);
            readPart<ROWS, K, E, L>(part, matrix, stride, row, k, count);
            constexpr bool isByRows = L == MatrixLayout::ROW_MAJOR;
            addProducts<isByRows ? int(PART_COLUMNS) : 1, isByRows ? 1 : int(TILE_ROWS)>(sums, part, factors + k, count);
        }
    for (int r = 0; r < ROWS; ++r)
        results[r] = sums[r];
}

/* results[n] += row n of the matrix * factors. */
template <int N, int K, MatrixElement E, MatrixLayout L, bool TRANSPOSE, class S>
OXRT_INLINE void multiplyMatrix(S (&results)[N], const char* matrix, uint32_t stride, const S* factors) {
    constexpr int most = ROWS_AT_ONCE<S>, rest = N % most;
    for (int row = 0; row + most <= N; row += most)
        multiplyRows<most, N, K, E, L, TRANSPOSE>(results + row, matrix, stride, row, factors);
    if constexpr (rest != 0)
        multiplyRows<rest, N, K, E, L, TRANSPOSE>(results + (N - rest), matrix, stride, N - rest, factors);
}

template <class V> struct CoopVecResult;
template <class T, int SIZE> struct CoopVecResult<CoopVec<T, SIZE>> {
    using Element = T;
    static constexpr int size = SIZE;
};

/* The biases, or zero: what the sums start from. */
template <class T, class S, int N> OXRT_INLINE void readBias(S (&results)[N], const char* bias) {
    if (bias == nullptr) {
        for (int n = 0; n < N; ++n)
            results[n] = S(ElementOf<S>(0));
        return;
    }
    ElementOf<S> numbers[N];
    if constexpr (isSame<T, half>)
        widenSpan(numbers, bias, N, half());
    else
        __builtin_memcpy(numbers, bias, sizeof(numbers));
    for (int n = 0; n < N; ++n)
        results[n] = S(numbers[n]);
}

/* matrix * vector + bias with all memory known to be there; `bias` may be null. */
template <class Result, MatrixElement INNER, MatrixElement E, MatrixLayout L, bool TRANSPOSE, class T, int K, class X>
auto multiplyVector(const CoopVec<T, K, X>& vector, const char* matrix, uint32_t stride, const char* bias) {
    using R = typename CoopVecResult<Result>::Element;
    constexpr int N = CoopVecResult<Result>::size;
    using S = Rebind<X, typename ChooseType<isByte(E), int32_t, float>::Type>;
    S results[N];
    readBias<R>(results, bias);
    if constexpr (isSame<X, S> && INNER == E && !isByte(E) && E != MatrixElement::FLOAT8_E4M3 && E != MatrixElement::FLOAT8_E5M2)
        multiplyMatrix<N, K, E, L, TRANSPOSE>(results, matrix, stride, vector.items);
    else {
        S factors[isByte(E) ? (K + 1) / 2 : K];
        readFactors<INNER>(factors, vector);
        multiplyMatrix<N, K, E, L, TRANSPOSE>(results, matrix, stride, factors);
    }
    CoopVec<R, N, HeldItem<R, Rebind<S, Widened<R>>>> result;
    for (int n = 0; n < N; ++n)
        result.items[n] = convert<R>(results[n]);
    return result;
}

/* The stride of rows or columns in bytes, 0 for no gaps. */
template <class Result, MatrixElement INNER, MatrixElement E, MatrixLayout L, bool TRANSPOSE, PlainSpans Spans, class T, int K, class X, class M,
          int RANK>
OXRT_INLINE auto coopVecMatMul(Spans spans, const CoopVec<T, K, X>& vector, const Array<M, RANK>& matrix, uint32_t offset, uint32_t stride) {
    constexpr int N = CoopVecResult<Result>::size;
    using V = decltype(multiplyVector<Result, INNER, E, L, TRANSPOSE>(vector, nullptr, stride, nullptr));
    const uint64_t bytes = TRANSPOSE ? matrixBytes<E, L>(K, N, stride) : matrixBytes<E, L>(N, K, stride);
    if (!spans.contains(matrix, offset, bytes, MATRIX_ALIGNMENT))
        return coopVecOf<V>();
    const char* first = reinterpret_cast<const char*>(matrix.data) + offset;
    return multiplyVector<Result, INNER, E, L, TRANSPOSE>(vector, first, lineStride<E, L>(N, K, stride), nullptr);
}
template <class Result, MatrixElement INNER, MatrixElement E, MatrixLayout L, bool TRANSPOSE, PlainSpans Spans, class T, int K, class X, class M,
          int RANK, class B, int BIAS_RANK>
OXRT_INLINE auto coopVecMatMul(Spans spans, const CoopVec<T, K, X>& vector, const Array<M, RANK>& matrix, uint32_t offset, uint32_t stride,
                               const Array<B, BIAS_RANK>& bias, uint32_t biasOffset) {
    constexpr int N = CoopVecResult<Result>::size;
    using V = decltype(multiplyVector<Result, INNER, E, L, TRANSPOSE>(vector, nullptr, stride, nullptr));
    const uint64_t bytes = TRANSPOSE ? matrixBytes<E, L>(K, N, stride) : matrixBytes<E, L>(N, K, stride);
    if (!spans.contains(matrix, offset, bytes, MATRIX_ALIGNMENT) || !spans.contains(bias, biasOffset, sizeof(Result), VECTOR_ALIGNMENT))
        return coopVecOf<V>();
    const char* first = reinterpret_cast<const char*>(matrix.data) + offset;
    return multiplyVector<Result, INNER, E, L, TRANSPOSE>(vector, first, lineStride<E, L>(N, K, stride),
                                                          reinterpret_cast<const char*>(bias.data) + biasOffset);
}

}  // namespace OXRT_ISA
}  // namespace oxrt

#endif
