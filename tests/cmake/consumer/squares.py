"""Writes a function of the launch index; the function is another file's."""

from power import power

import optixc as ox


@ox.struct
class Params:
    values: ox.Array[ox.int32]


params = ox.launch_params(Params)


@ox.program
def __raygen__squares():
    i = ox.get_launch_index().x
    params.values[i] = power(int(i))
