"""A ray generation program that does nothing: what remains is the cost of a launch."""

import optixc as ox


@ox.struct
class Params:
    unused: int


params = ox.launch_params(Params)


@ox.program
def __raygen__empty():
    pass
