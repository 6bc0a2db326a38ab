"""Rays with any SBT arguments that write down which record they reached."""

import optixc as ox
from optixc import FixedArray, float3, uint32

NOTHING = 0
MISS = 1000000
TALL = 2000000


@ox.struct
class Ray:
    origin: float3
    sbt_offset: uint32
    sbt_stride: uint32
    miss_index: uint32


@ox.struct
class Params:
    scene: ox.Traversable
    rays: ox.Array[Ray]
    reached: ox.Array[uint32]


@ox.struct
class Short:
    number: uint32


@ox.struct
class Tall:
    room: FixedArray[uint32, 9]
    number: uint32


@ox.payload
class Reached:
    number: uint32


params = ox.launch_params(Params)


@ox.program
def __raygen__rays():
    i = ox.get_launch_index().x
    ray = params.rays[i]
    reached = Reached(NOTHING)
    ox.trace(params.scene, ray.origin, float3(0.0, 0.0, -1.0), sbt_offset=ray.sbt_offset, sbt_stride=ray.sbt_stride,
             miss_sbt_index=ray.miss_index, payload=reached)
    params.reached[i] = reached.number


@ox.program
def __closesthit__short(reached: Reached, record: Short):
    reached.number = record.number


@ox.program
def __closesthit__tall(reached: Reached, record: Tall):
    reached.number = TALL + record.number


@ox.program
def __intersection__box():
    ox.report_intersection(1.0, 0)


@ox.program
def __miss__short(reached: Reached, record: Short):
    reached.number = MISS + record.number
