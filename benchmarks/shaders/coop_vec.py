"""A network of two hidden layers for each launch index: by cooperative vectors of three types, and by plain loops."""

import optixc as ox
from optixc import CoopVecElemType, CoopVecMatrixLayout, uint3

INPUTS = 32
WIDTH = 64
OUTPUTS = 3
OPTIMAL = CoopVecMatrixLayout.INFERENCING_OPTIMAL
Features = ox.CoopVec[ox.float32, INPUTS]
Floats = ox.CoopVec[ox.float32, WIDTH]
Halves = ox.CoopVec[ox.float16, WIDTH]
Integers = ox.CoopVec[ox.int32, WIDTH]


@ox.struct
class Params:
    """`memory` holds matrices and biases at these offsets, for the program that runs; `weights` all of them as float32, in order."""

    features: ox.Array[ox.float32]
    memory: ox.Array[ox.uint8]
    matrices: uint3
    biases: uint3
    weights: ox.Array[ox.float32]
    out: ox.Array2[ox.float32]
    scale: float


params = ox.launch_params(Params)


@ox.device
def features():
    return ox.coop_vec_load(Features, params.features, ox.get_launch_index().x * (4 * INPUTS))


@ox.device
def write(v):
    i = ox.get_launch_index().x
    for j in range(OUTPUTS):
        params.out[i, j] = v[j]


@ox.program
def __raygen__float16():
    v = ox.coop_vec_cvt(ox.CoopVec[ox.float16, INPUTS], features())
    m, b = params.matrices, params.biases
    h = ox.coop_vec_max(ox.coop_vec_mat_mul(Halves, v, params.memory, m.x, params.memory, b.x, matrix_layout=OPTIMAL), 0.0)
    h = ox.coop_vec_max(ox.coop_vec_mat_mul(Halves, h, params.memory, m.y, params.memory, b.y, matrix_layout=OPTIMAL), 0.0)
    write(ox.coop_vec_mat_mul(ox.CoopVec[ox.float16, OUTPUTS], h, params.memory, m.z, params.memory, b.z, matrix_layout=OPTIMAL))


@ox.program
def __raygen__float32():
    m, b = params.matrices, params.biases
    h = ox.coop_vec_max(ox.coop_vec_mat_mul(Floats, features(), params.memory, m.x, params.memory, b.x, matrix_layout=OPTIMAL), 0.0)
    h = ox.coop_vec_max(ox.coop_vec_mat_mul(Floats, h, params.memory, m.y, params.memory, b.y, matrix_layout=OPTIMAL), 0.0)
    write(ox.coop_vec_mat_mul(ox.CoopVec[ox.float32, OUTPUTS], h, params.memory, m.z, params.memory, b.z, matrix_layout=OPTIMAL))


@ox.program
def __raygen__float16_rows():
    v = ox.coop_vec_cvt(ox.CoopVec[ox.float16, INPUTS], features())
    m, b = params.matrices, params.biases
    h = ox.coop_vec_max(ox.coop_vec_mat_mul(Halves, v, params.memory, m.x, params.memory, b.x), 0.0)
    h = ox.coop_vec_max(ox.coop_vec_mat_mul(Halves, h, params.memory, m.y, params.memory, b.y), 0.0)
    write(ox.coop_vec_mat_mul(ox.CoopVec[ox.float16, OUTPUTS], h, params.memory, m.z, params.memory, b.z))


@ox.device
def dequantised(v):
    """Sums of 8-bit products as float32 again, cut off at zero."""
    return ox.coop_vec_max(ox.coop_vec_mul(ox.coop_vec_cvt(Floats, v), Floats(params.scale)), 0.0)


@ox.program
def __raygen__int8():
    m, b = params.matrices, params.biases
    v = ox.coop_vec_mul(features(), Features(1.0 / params.scale))
    h = dequantised(ox.coop_vec_mat_mul(Integers, v, params.memory, m.x, params.memory, b.x, matrix_layout=OPTIMAL,
                                        matrix_element_type=CoopVecElemType.INT8))
    h = dequantised(ox.coop_vec_mat_mul(Integers, h, params.memory, m.y, params.memory, b.y, matrix_layout=OPTIMAL,
                                        matrix_element_type=CoopVecElemType.INT8))
    out = ox.coop_vec_mat_mul(ox.CoopVec[ox.int32, OUTPUTS], h, params.memory, m.z, params.memory, b.z, matrix_layout=OPTIMAL,
                              matrix_element_type=CoopVecElemType.INT8)
    values = ox.coop_vec_cvt(ox.CoopVec[ox.float32, OUTPUTS], out)
    write(ox.coop_vec_mul(values, ox.CoopVec[ox.float32, OUTPUTS](params.scale * params.scale)))


@ox.program
def __raygen__loops():
    i = ox.get_launch_index().x
    first, second = ox.FixedArray[float, 64](), ox.FixedArray[float, 64]()
    for n in range(WIDTH):
        total = params.weights[WIDTH * INPUTS + n]
        for k in range(INPUTS):
            total += params.weights[n * INPUTS + k] * params.features[int(i) * INPUTS + k]
        first[n] = max(total, 0.0)
    start = WIDTH * (INPUTS + 1)
    for n in range(WIDTH):
        total = params.weights[start + WIDTH * WIDTH + n]
        for k in range(WIDTH):
            total += params.weights[start + n * WIDTH + k] * first[k]
        second[n] = max(total, 0.0)
    start = WIDTH * (INPUTS + 1) + WIDTH * (WIDTH + 1)
    for n in range(OUTPUTS):
        total = params.weights[start + OUTPUTS * WIDTH + n]
        for k in range(WIDTH):
            total += params.weights[start + n * WIDTH + k] * second[k]
        params.out[i, n] = total
