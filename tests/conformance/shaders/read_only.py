"""Reads some arrays and writes others: of parameters, of a struct inside, of a record."""

import optixc as ox
from optixc import Array, uint32


@ox.struct
class Tables:
    weights: Array[float]
    sums: Array[float]


@ox.struct
class Params:
    out: Array[float]
    source: Array[float]
    tables: Tables
    counts: Array[uint32]


@ox.struct
class Data:
    scale: Array[float]
    notes: Array[float]


params = ox.launch_params(Params)


@ox.program
def __raygen__write(data: Data):
    i = ox.get_launch_index().x
    params.out[i] = params.source[i] * params.tables.weights[0] * data.scale[0]
    params.tables.sums[i] = params.source[i]
    data.notes[i] = 1.0
    ox.atomic_add(params.counts, 0, uint32(1))


@ox.program
def __raygen__read(data: Data):
    i = ox.get_launch_index().x
    params.out[i] = params.source[i] + params.tables.sums[i] + float(params.counts[0]) + data.notes[0]
