import optixc as ox
from optixc import float3


@ox.struct
class Params:
    counts: ox.Array2[ox.uint32]
    sums: ox.Array[float]
    points: ox.Array[float3]


params = ox.launch_params(Params)


@ox.program
def __raygen__a():
    a = ox.atomic_add(params.counts, (1, 2), 1)
    b = ox.atomic_add(params.counts, 1, 1)  # E[OX312]: takes 2 indices, here are 1
    c = ox.atomic_and(params.sums, 1, 1)  # E[OX302]: does not work on
    d = ox.atomic_add(params.points, 1, float3(1.0))  # E[OX302]: does not work on
    e = ox.atomic_add(params.sums, 1.5, 1.0)  # E[OX312]: an index must be an integer
    f = ox.atomic_add(params.sums, 1)  # E[OX305]: misses `value`
    g = ox.atomic_add(params.counts, (1, 2), 1.5)  # E[OX302]: the value must be uint32
    h = ox.atomic_inc(params.sums, 1, 1.0)  # E[OX302]: an array of uint32
    i = ox.atomic_cas(params.counts, (0, 0), 1, 2)
