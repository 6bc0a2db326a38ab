"""Cooperative vectors: functions of each element, elements, value semantics, control flow, callables, accumulators, sizes."""

import optixc as ox
from optixc import CoopVecElemType, CoopVecMatrixLayout

N = 24
Halves = ox.CoopVec[ox.float16, N]
Floats = ox.CoopVec[ox.float32, N]
Bytes = ox.CoopVec[ox.int8, N]
Naturals = ox.CoopVec[ox.uint8, N]
Integers = ox.CoopVec[ox.int32, N]


@ox.struct
class Params:
    a: ox.Array2[ox.float32]
    b: ox.Array2[ox.float32]
    c: ox.Array2[ox.float32]
    out: ox.Array3[ox.float64]
    memory: ox.Array[ox.uint8]
    halves: ox.Array[ox.float16]
    floats: ox.Array[ox.float32]
    offset: ox.uint32


params = ox.launch_params(Params)


@ox.device
def write(row: ox.uint32, line, v):
    for j in range(len(v)):
        params.out[line, row, j] = ox.float64(v[j])


@ox.device
def functions(row: ox.uint32, line, a, b, c, number):
    write(row, line, ox.coop_vec_min(a, b))
    write(row, line + 1, ox.coop_vec_max(a, b))
    write(row, line + 2, ox.coop_vec_mul(a, b))
    write(row, line + 3, ox.coop_vec_add(a, b))
    write(row, line + 4, ox.coop_vec_sub(a, b))
    write(row, line + 5, ox.coop_vec_step(a, b))
    write(row, line + 6, ox.coop_vec_ffma(a, b, c))
    write(row, line + 7, ox.coop_vec_min(a, number))
    write(row, line + 8, ox.coop_vec_max(a, number))


@ox.program
def __raygen__elements():
    row = ox.get_launch_index().x
    a, b, c = Floats(), Floats(), Floats()
    ha, hb, hc = Halves(), Halves(), Halves()
    ia, ib, ic = Bytes(), Bytes(), Bytes()
    na, nb, nc = Naturals(), Naturals(), Naturals()
    za, zb, zc = Integers(), Integers(), Integers()
    for j in range(N):
        x, y, z = params.a[row, j], params.b[row, j], params.c[row, j]
        a[j], b[j], c[j] = x, y, z
        ha[j], hb[j], hc[j] = x, y, z
        ia[j], ib[j], ic[j] = int(x * 40.0), int(y * 40.0), int(z * 40.0)
        na[j], nb[j], nc[j] = ox.uint32(abs(x) * 40.0), ox.uint32(abs(y) * 40.0), ox.uint32(abs(z) * 40.0)
        za[j], zb[j], zc[j] = int(x * 1e9), int(y * 1e9), int(z * 1e9)
    functions(row, 0, a, b, c, 0.1)
    functions(row, 9, ha, hb, hc, 0.1)
    functions(row, 18, ia, ib, ic, 7)
    functions(row, 27, na, nb, nc, ox.uint32(7))
    functions(row, 36, za, zb, zc, 7)
    write(row, 45, ox.coop_vec_exp2(a))
    write(row, 46, ox.coop_vec_log2(a))
    write(row, 47, ox.coop_vec_tanh(a))
    write(row, 48, ox.coop_vec_exp2(ha))
    write(row, 49, ox.coop_vec_log2(ha))
    write(row, 50, ox.coop_vec_tanh(ha))
    write(row, 51, ox.coop_vec_cvt(Halves, ia))
    write(row, 52, ox.coop_vec_cvt(Floats, na))
    write(row, 53, ox.coop_vec_cvt(Halves, za))
    write(row, 54, ox.coop_vec_cvt(Halves, a))
    write(row, 55, ox.coop_vec_cvt(Floats, ha))


@ox.device
def doubled(v: ox.CoopVec[ox.float32, 24]) -> ox.CoopVec[ox.float32, 24]:
    v[0] = 100.0
    return ox.coop_vec_add(v, v)


@ox.program
def __direct_callable__weighted(v: ox.CoopVec[ox.float32, 24], weight: float) -> ox.CoopVec[ox.float32, 24]:
    return ox.coop_vec_mul(v, Floats(weight))


@ox.program
def __raygen__values():
    row = ox.get_launch_index().x
    v = Floats()
    for j in range(N):
        v[j] = params.a[row, j]
    w = v
    w[int(row) % N] = 7.0
    write(row, 0, v)
    write(row, 1, w)
    write(row, 2, doubled(v))
    write(row, 3, v if row % 2 == 0 else w)
    u = Floats(1.0)
    if row % 3 == 0:
        u = ox.coop_vec_load(Floats, params.floats, row * 16)
    elif row % 3 == 1:
        for k in range(int(row)):
            u = ox.coop_vec_add(u, v)
            u[k % N] += 1.0
    write(row, 4, u)
    write(row, 5, ox.direct_call(0, v, float(row), result=Floats))
    pair = (v, 2.0)
    write(row, 6, ox.coop_vec_mul(pair[0], Floats(pair[1])))
    write(row, 7, ox.coop_vec_load(Floats, params.floats, params.offset))
    sizes = ox.CoopVec[ox.uint32, 4](
        ox.coop_vec_get_matrix_size(16, 16, CoopVecElemType.FLOAT16, CoopVecMatrixLayout.ROW_MAJOR),
        ox.coop_vec_get_matrix_size(3, 5, CoopVecElemType.FLOAT32, CoopVecMatrixLayout.ROW_MAJOR),
        ox.coop_vec_get_matrix_size(17, 5, CoopVecElemType.FLOAT16),
        ox.coop_vec_get_matrix_size(17, 5, CoopVecElemType.INT8, CoopVecMatrixLayout.COLUMN_MAJOR, 32),
    )
    write(row, 8, sizes)


@ox.struct
class Layer:
    matrix: ox.Array[ox.float32]
    bias: ox.Array[ox.float32]
    sums: ox.Array[ox.uint8]


@ox.program
def __direct_callable__layer(v: ox.CoopVec[ox.float32, 24], layer: Layer) -> ox.CoopVec[ox.float32, 5]:
    out = ox.coop_vec_mat_mul(ox.CoopVec[ox.float32, 5], v, layer.matrix, bias=layer.bias)
    ox.coop_vec_outer_product_accumulate(ox.coop_vec_load(ox.CoopVec[ox.float32, 5], layer.bias), v, layer.sums)
    return out


@ox.program
def __raygen__layers():
    row = ox.get_launch_index().x
    v = ox.coop_vec_load(Floats, params.floats, row * 16)
    out = ox.direct_call(row % 3, v, result=ox.CoopVec[ox.float32, 5])
    write(row, 0, out)


@ox.program
def __raygen__accumulates():
    i = ox.get_launch_index()
    row = i.x + ox.get_launch_dimensions().x * i.y
    if row % 5 != 4:
        a, b = Halves(1.0), ox.CoopVec[ox.float16, 10](1.0)
        a[int(row % N)] = 2.0
        b[int(row % 10)] = 3.0
        ox.coop_vec_outer_product_accumulate(a, b, params.memory, params.offset)
        ox.coop_vec_reduce_sum_accumulate(a, params.halves, (row % 2) * 48)
        ox.coop_vec_reduce_sum_accumulate(ox.coop_vec_cvt(Floats, a), params.floats)


@ox.program
def __raygen__past_the_end():
    v = Halves(1.0)
    r = ox.coop_vec_mat_mul(ox.CoopVec[ox.float16, 4], v, params.memory, params.offset)  # past the end
    params.out[0, 0, 0] = ox.float64(r[0])


@ox.program
def __raygen__bias_past_the_end():
    v = Halves(1.0)
    row = ox.get_launch_index().x
    r = ox.coop_vec_mat_mul(ox.CoopVec[ox.float16, 4], v, params.memory, 0, params.halves, row * 16)  # bias
    params.out[0, row, 0] = ox.float64(r[0])


@ox.program
def __raygen__load_past_the_end():
    v = ox.coop_vec_load(Halves, params.halves, ox.get_launch_index().x * params.offset)  # load
    params.out[0, 0, 0] = ox.float64(v[0])


@ox.program
def __raygen__sum_past_the_end():
    ox.coop_vec_reduce_sum_accumulate(Halves(1.0), params.halves, params.offset)  # sum


@ox.program
def __raygen__product_past_the_end():
    ox.coop_vec_outer_product_accumulate(Halves(1.0), Halves(1.0), params.memory, params.offset)  # product


@ox.program
def __raygen__element_past_the_end():
    v = Halves(1.0)
    params.out[0, 0, 0] = ox.float64(v[int(params.offset) + int(ox.get_launch_index().x)])  # element


@ox.program
def __raygen__shared_element_past_the_end():
    v = Halves(1.0)
    v[int(params.offset)] = 2.0  # shared element
    params.out[0, 0, 0] = ox.float64(v[0])


@ox.program
def __raygen__gradients():
    """One step of training of two layers: 24 inputs, 18 hidden values, 5 outputs; gradients stand behind the matrices."""
    row = ox.get_launch_index().x
    v, wanted = Floats(), ox.CoopVec[ox.float32, 5]()
    for j in range(N):
        v[j] = params.a[row, j]
    for j in range(5):
        wanted[j] = params.b[row, j]
    first = ox.coop_vec_mat_mul(ox.CoopVec[ox.float32, 18], v, params.memory, 0, matrix_layout=CoopVecMatrixLayout.TRAINING_OPTIMAL)
    hidden = ox.coop_vec_max(first, 0.0)
    out = ox.coop_vec_mat_mul(
        ox.CoopVec[ox.float32, 5], hidden, params.memory, 3072, matrix_layout=CoopVecMatrixLayout.TRAINING_OPTIMAL
    )
    delta = ox.coop_vec_sub(out, wanted)
    ox.coop_vec_outer_product_accumulate(delta, hidden, params.memory, 7296)
    back = ox.coop_vec_mat_mul(
        ox.CoopVec[ox.float32, 18], delta, params.memory, 3072, matrix_layout=CoopVecMatrixLayout.TRAINING_OPTIMAL, transpose=True
    )
    back = ox.coop_vec_mul(back, ox.coop_vec_step(ox.CoopVec[ox.float32, 18](0.5), hidden))
    ox.coop_vec_outer_product_accumulate(back, v, params.memory, 4224)
