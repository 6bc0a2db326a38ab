"""A debug build: array bounds, assertions, prints, locals that nobody reads; and validation of rays and records."""

import optixc as ox
from optixc import float3

OPTIONS = {"debug": True, "trap_nan": True, "validation": True}


@ox.struct
class Params:
    values: ox.Array2[float3]
    scene: ox.Traversable


@ox.struct
class State:
    weights: ox.FixedArray[ox.float32, 4]


@ox.payload
class Radiance:
    color: float3


params = ox.launch_params(Params)


@ox.device
def total(state: State, count: ox.int32) -> float:
    result = 0.0
    for k in range(count):
        result += state.weights[k]
        state.weights[k] = 0.0
    return result


@ox.program
def __raygen__checked():
    i = ox.get_launch_index()
    unread = i.x + 1  # noqa: F841
    state = State(ox.FixedArray[ox.float32, 4]())
    state.weights[i.x % 4] = 1.0
    ray = Radiance(params.values[i.y, i.x])
    ox.trace(params.scene, ray.color, float3(0.0, 0.0, 1.0), payload=ray)
    assert ray.color.x >= 0.0, "radiance is not negative"
    print("pixel", i.x, i.y, ray.color, sep=", ")
    params.values[i.y, i.x] = ray.color * total(state, 3)
    params.values[0, 0].x = 1.0


@ox.program
def __closesthit__white(ray: Radiance):
    ray.color = float3(1.0)
