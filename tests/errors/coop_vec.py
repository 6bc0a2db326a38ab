import optixc as ox
from optixc import CoopVecElemType, CoopVecMatrixLayout, float3

H4 = ox.CoopVec[ox.float16, 4]
H8 = ox.CoopVec[ox.float16, 8]
F4 = ox.CoopVec[ox.float32, 4]
I4 = ox.CoopVec[ox.int32, 4]
B4 = ox.CoopVec[ox.int8, 4]
OPTIMAL = CoopVecMatrixLayout.INFERENCING_OPTIMAL
Wide = ox.CoopVec[ox.float64, 4]  # E[OX201]: a CoopVec cannot hold float64


@ox.struct
class Params:
    bytes: ox.Array[ox.uint8]
    halves: ox.Array[ox.float16]
    floats: ox.Array[ox.float32]
    points: ox.Array[float3]
    n: ox.uint32
    i: int


@ox.struct
class Holds:
    v: ox.CoopVec[ox.float16, 4]  # E[OX202]: a field cannot be of type CoopVec[float16, 4]


params = ox.launch_params(Params)


@ox.program
def __raygen__types():
    a = ox.CoopVec[ox.float16]()  # E[OX201]: CoopVec needs an element type and a size
    b = Wide()
    c = ox.CoopVec[ox.float16, 0]()  # E[OX201]: the size of a CoopVec is an integer constant from 1 to 1024
    d = ox.CoopVec[ox.float16, params.n]()  # E[OX201]: the size of a CoopVec is an integer constant
    e = H4(1.0, 2.0)  # E[OX305]: takes 4 elements, one for all, or none (all zero), here are 2
    f = H4(float3(1.0))  # E[OX302]: an element must be float16
    g = ox.FixedArray[H4, 2]()  # E[OX201]: a FixedArray cannot hold CoopVec[float16, 4]
    h = B4(300)  # E[OX313]: does not hold 300


@ox.program
def __raygen__elements():
    h, i, b = H4(), I4(), B4()
    a = h + h  # E[OX303]: write ox.coop_vec_add(a, b)
    c = ox.coop_vec_add(h, F4())  # E[OX302]: argument `b` must be CoopVec[float16, 4], this is CoopVec[float32, 4]
    d = ox.coop_vec_tanh(i)  # E[OX322]: takes float16 and float32, this is CoopVec[int32, 4]
    e = ox.coop_vec_max(3.0, h)  # E[OX302]: argument `a` must be a cooperative vector, this is a float literal
    f = ox.coop_vec_max(h, float3(1.0))  # E[OX302]: argument `b` must be CoopVec[float16, 4], this is float3
    g = ox.coop_vec_cvt(I4, h)  # E[OX322]: converts to float16 and float32, not to int32
    j = ox.coop_vec_cvt(H8, i)  # E[OX322]: has 4 elements, CoopVec[float16, 8] has 8
    k = ox.coop_vec_cvt(float3, i)  # E[OX302]: must be a type of cooperative vectors, this is float3
    m = h[4]  # E[OX312]: has no index 4
    n = h == h  # E[OX303]: `==`
    print(h)  # E[OX302]: print() takes numbers, vectors and text


@ox.program
def __raygen__memory():
    a = ox.coop_vec_load(H4, params.floats)  # E[OX302]: must be ox.Array[ox.float16] or ox.Array[ox.uint8], this is Array[float32]
    b = ox.coop_vec_load(H4, params.bytes, 24)  # E[OX322]: `offset_in_bytes` is 24, which is no multiple of 16
    c = ox.coop_vec_load(H4, params.bytes, params.i)  # E[OX302]: must be uint32
    ox.coop_vec_reduce_sum_accumulate(I4(), params.bytes)  # E[OX322]: adds float16 and float32
    ox.coop_vec_outer_product_accumulate(H4(), F4(), params.bytes)  # E[OX322]: both float16 or both float32
    ox.coop_vec_outer_product_accumulate(H4(), H8(), params.halves)  # E[OX302]: must be ox.Array[ox.uint8], this is Array[float16]
    ox.coop_vec_outer_product_accumulate(H4(), H8(), params.bytes, matrix_layout=OPTIMAL)  # E[OX322]: layout TRAINING_OPTIMAL
    d = ox.coop_vec_get_matrix_size(params.n, 4, CoopVecElemType.FLOAT16)  # E[OX322]: `n` must be a constant
    e = ox.coop_vec_get_matrix_size(4, 4, CoopVecElemType.FLOAT16, CoopVecMatrixLayout.ROW_MAJOR, 4)  # E[OX322]: less than the 8 bytes
    h = ox.coop_vec_get_matrix_size(100000, 100000, CoopVecElemType.FLOAT32)  # E[OX322]: more than 32 bits count
    f = ox.coop_vec_get_matrix_size(4, 4, 77)  # E[OX322]: 77 is no element type
    g = ox.coop_vec_reduce_sum_accumulate(H4(), params.bytes)  # E[OX321]: gives no value


@ox.program
def __raygen__products():
    h, f, b = H4(), F4(), B4()
    a = ox.coop_vec_mat_mul(H8, h, params.points)  # E[OX302]: argument `matrix` must be ox.Array[ox.float16]
    c = ox.coop_vec_mat_mul(H8, h, params.halves, matrix_layout=OPTIMAL)  # E[OX302]: argument `matrix` must be ox.Array[ox.uint8]
    d = ox.coop_vec_mat_mul(F4, h, params.halves)  # E[OX322]: this product is FLOAT16, bias and result are FLOAT32
    e = ox.coop_vec_mat_mul(H4, h, params.halves, 32)  # E[OX322]: which is no multiple of 64
    g = ox.coop_vec_mat_mul(H4, h, params.halves, bias=params.floats)  # E[OX302]: argument `bias` must be ox.Array[ox.float16]
    i = ox.coop_vec_mat_mul(H4, h, params.halves, transpose=True)  # E[OX322]: a transposed matrix has an optimal layout, not ROW_MAJOR
    j = ox.coop_vec_mat_mul(H4, h, params.bytes, matrix_element_type=CoopVecElemType.FLOAT8_E4M3)  # E[OX322]: has an optimal layout
    k = ox.coop_vec_mat_mul(H4, f, params.halves, matrix_element_type=CoopVecElemType.FLOAT16)  # E[OX322]: multiplies vectors of float16
    m = ox.coop_vec_mat_mul(H4, b, params.bytes)  # E[OX322]: this product is INT32, bias and result are FLOAT16
    n = ox.coop_vec_mat_mul(I4, h, params.bytes, matrix_element_type=CoopVecElemType.INT32)  # E[OX322]: a matrix cannot hold INT32
    o = ox.coop_vec_mat_mul(H4, h, params.halves, row_column_stride_in_bytes=20)  # E[OX322]: is no multiple of 16
    p = ox.coop_vec_mat_mul(H4, h, params.halves, matrix_layout=params.i)  # E[OX322]: `matrix_layout` must be a constant
    q = ox.coop_vec_mat_mul(H4, h, params.halves, input_interpretation=CoopVecElemType.INT8)  # E[OX322]: takes its input as FLOAT16
    r = ox.coop_vec_mat_mul(H4, h, params.halves, bias=None, bias_element_type=CoopVecElemType.FLOAT32)  # E[OX322]: the bias is FLOAT32
    s = ox.coop_vec_mat_mul(H4, h)  # E[OX305]: misses `matrix`
    t = ox.coop_vec_mat_mul(  # E[OX322]: cannot be transposed
        I4, b, params.bytes, matrix_layout=CoopVecMatrixLayout.INFERENCING_OPTIMAL, transpose=True
    )
