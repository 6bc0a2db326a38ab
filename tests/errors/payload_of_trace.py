import optixc as ox
from optixc import float3


@ox.struct
class Params:
    scene: ox.Traversable


@ox.struct
class Plain:
    x: float


@ox.payload
class Ray:
    x: float


params = ox.launch_params(Params)


@ox.program
def __raygen__a():
    o = float3(0.0)
    d = float3(0.0, 0.0, 1.0)
    plain = Plain(1.0)
    ox.trace(params.scene, o, d, payload=plain)  # E[OX318]: a payload cannot be Plain
    ox.trace(params.scene, o, d, payload=Ray(1.0))  # E[OX318]: needs a name
    a = ox.trace(params.scene, o, d, payload=(1, o))  # E[OX318]: a payload tuple holds numbers of 32 bits
    b = ox.trace(params.scene, o, d, payload=(True, 1))  # E[OX318]: a payload tuple holds numbers of 32 bits
    c = ox.trace(params.scene, o, d, payload=(-1, 1))  # E[OX313]: does not hold a negative literal
    ray = Ray(1.0)
    e = ox.trace(params.scene, o, d, payload=ray)  # E[OX321]: this call gives no value
    ox.trace(params.scene, o, payload=ray)  # E[OX305]: misses `direction`
    ox.trace(params.scene, o, d, flags=1, payload=ray)  # E[OX305]: no parameter `flags`
    ox.trace(params.scene, o, 1.0, payload=ray)  # E[OX302]: argument `direction` must be float3
    ox.trace(params.scene, o, d, ray_flags=-1, payload=ray)  # E[OX313]: argument `ray_flags` is uint32
