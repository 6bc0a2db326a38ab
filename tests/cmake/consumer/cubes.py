"""A second pipeline of the same program; its parameters have the name of the first one's and other fields."""

import optixc as ox


@ox.struct
class Params:
    scale: ox.float64
    values: ox.Array[float]


params = ox.launch_params(Params)


@ox.program
def __raygen__cubes():
    i = ox.get_launch_index().x
    params.values[i] = float(i) ** 3 * float(params.scale)
