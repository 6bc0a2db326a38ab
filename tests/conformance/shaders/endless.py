"""Programs that never end, each at a place and in the lanes that the parameters name; and rays that are no numbers in some lanes."""

import math

import optixc as ox
from optixc import float3

ODD, NESTED, TRACES, CLOSEST_HIT, ANY_HIT, ANY_HIT_RANGE, MISS, INTERSECTION, CONTINUES = range(1, 10)


@ox.struct
class Params:
    out: ox.Array[ox.float32]
    scene: ox.Traversable
    place: int


@ox.payload
class Carried:
    value: float


params = ox.launch_params(Params)


@ox.device
def spin(start: float) -> float:
    x = start
    while x > 0.0:
        x = x + 1.0
        if x > 100.0:
            x = 1.0
    return x


@ox.device
def count(i: int):
    for k in range(2000000000):
        for j in range(2000000000):
            params.out[i] = params.out[i] * 1.0001 + float(j + k)


@ox.device
def trace_for_ever() -> float:
    x = 0.0
    while True:
        ray = Carried(1.0)
        ox.trace(params.scene, float3(0.2, 0.2, 1.0), float3(0.0, 0.0, -1.0), payload=ray)
        x += ray.value


@ox.program
def __raygen__main():
    i = int(ox.get_launch_index().x)
    if params.place == 1 and i % 3 == 1:
        params.out[i] = spin(float(i))
    if params.place == 2 and i % 3 == 1:
        count(i)
    if params.place == 3 and i == 2:
        params.out[i] = trace_for_ever()
    if params.place == 9:
        k = 0
        while k != -1:
            k = i
            if i % 5 == 2:
                continue
            k = -1
    ray = Carried(float(i))
    ox.trace(params.scene, float3(0.2 if i < 30 else 3.0, 0.2, 1.0), float3(0.0, 0.0, -1.0), payload=ray)
    params.out[i] = ray.value


@ox.program
def __raygen__no_numbers():
    i = int(ox.get_launch_index().x)
    wrong = math.nan if i % 3 == 0 else math.inf
    x = wrong if i % 2 == 0 else 0.2
    down = wrong if i % 5 == 4 else -1.0
    tmin = wrong if i % 11 == 7 else 0.0
    ray = Carried(float(i))
    ox.trace(params.scene, float3(x, 0.2, 1.0), float3(0.0, 0.0, down), tmin=tmin, payload=ray)
    params.out[i] = ray.value


@ox.program
def __raygen__one_lane():
    i = int(ox.get_launch_index().x)
    if i == params.place - 100:
        ray = Carried(float(i))
        ox.trace(params.scene, float3(0.2, 0.2, 1.0), float3(0.0, 0.0, -1.0), payload=ray)
        params.out[i] = ray.value


@ox.program
def __closesthit__main(ray: Carried):
    if params.place == 4 and ray.value > 3.0:
        ray.value = spin(1.0)
        return  # a value that nobody reads would not be computed
    ray.value = 5.0


@ox.program
def __anyhit__main(ray: Carried):
    if params.place == 5 and ray.value > 3.0:
        ray.value = spin(1.0)
    if params.place == 6 and ray.value > 3.0:
        count(1)


@ox.program
def __miss__main(ray: Carried):
    if params.place == 7 and ray.value == 33.0:
        ray.value = spin(1.0)
        return
    ray.value = 6.0


@ox.program
def __intersection__main():
    if params.place == 8:
        count(1)
    ox.report_intersection(0.5, 0)
