import optixc as ox


@ox.struct
class S:
    x: float


@ox.program
def __raygen__a():
    a = b = S(1.0)  # E[OX308]: both targets would be names of one S
    c = d = 1.0
    e = 0xFFFFFFFF  # E[OX313]: write uint32(4294967295)
