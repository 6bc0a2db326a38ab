import optixc as ox
from optixc import float3


def twice(x):
    return x << 1  # E[OX303]: `<<` does not take float32


def outer(y):
    return twice(y) + 1


@ox.program
def __raygen__a():
    a = outer(3)
    b = outer(2.5)
