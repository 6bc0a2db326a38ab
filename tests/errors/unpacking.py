import optixc as ox
from optixc import float3


@ox.program
def __raygen__a():
    a, b = 1, 2, 3  # E[OX302]: 2 names for 3 values
    c, *d = 1, 2, 3  # E[OX404]: unpacking with `*`
    e, f = 1  # E[OX302]: cannot be taken apart
    g, h, i = float3(1.0)
    (j, k), l = (1, 2), 3
    m, n = float3(1.0)  # E[OX302]: 2 names for 3 values
