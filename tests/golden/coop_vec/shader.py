"""Cooperative vectors: a network of two layers, and one step of its training."""

import optixc as ox
from optixc import CoopVecElemType, CoopVecMatrixLayout, float3

Hidden = ox.CoopVec[ox.float16, 32]
Output = ox.CoopVec[ox.float16, 3]


@ox.struct
class Params:
    image: ox.Array2[float3]
    network: ox.Array[ox.uint8]
    gradients: ox.Array[ox.uint8]
    sums: ox.Array[ox.float16]
    layer: ox.uint32


params = ox.launch_params(Params)


@ox.device
def relu(v: Hidden) -> Hidden:
    return ox.coop_vec_max(v, 0.0)


@ox.program
def __raygen__infers_and_learns():
    i = ox.get_launch_index()
    v = ox.CoopVec[ox.float16, 8](1.0)
    v[0] = float(i.x)
    first = ox.coop_vec_mat_mul(
        Hidden, v, params.network, 0, params.network, 1024, matrix_layout=CoopVecMatrixLayout.INFERENCING_OPTIMAL
    )
    hidden = relu(first)
    # Every launch index has a matrix of its own, so each is multiplied for the lanes that have it.
    size = ox.coop_vec_get_matrix_size(3, 32, CoopVecElemType.FLOAT16)
    out = ox.coop_vec_mat_mul(
        Output, hidden, params.network, 2048 + i.x * size, matrix_layout=CoopVecMatrixLayout.INFERENCING_OPTIMAL
    )
    # What all lanes read alike is read once.
    shared = ox.coop_vec_load(Output, params.network, params.layer)
    delta = ox.coop_vec_mul(ox.coop_vec_sub(out, shared), Output(0.5, 0.25, 1.0))
    ox.coop_vec_outer_product_accumulate(delta, hidden, params.gradients, params.layer)
    ox.coop_vec_reduce_sum_accumulate(delta, params.sums)
    whole = ox.coop_vec_cvt(ox.CoopVec[ox.float32, 3], out)
    params.image[i.y, i.x] = float3(whole[0], whole[1], whole[2])
