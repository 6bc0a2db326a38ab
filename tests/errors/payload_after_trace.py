import optixc as ox
from optixc import float3, uint32


@ox.struct
class Params:
    out: ox.Array[float3]
    scene: ox.Traversable


@ox.payload
class Ray:
    color: float3 = ox.payload_word(caller="r", ch="w", ms="w")
    depth: int = ox.payload_word(caller="w", ch="r")
    seed: uint32 = ox.payload_word(caller="rw", ch="rw")
    hits: int = ox.payload_word(ch="w", ms="r")


params = ox.launch_params(Params)
UP = float3(0.0, 0.0, 1.0)


@ox.device
def peek(ray: Ray) -> int:
    return ray.depth


@ox.device
def reset(ray: Ray):
    ray.depth = 3


@ox.program
def __raygen__reads():
    ray = Ray(float3(0.0), 1, 2, 0)
    d = ray.depth + peek(ray)
    ox.trace(params.scene, UP, UP, payload=ray)
    d += ray.depth  # E[OX317]: `Ray.depth` is read after a trace that does not bring it back
    d += peek(ray)  # E[OX317]: `Ray.depth` is read by `peek` after a trace
    ray.depth += 1  # E[OX317]: `Ray.depth` is read after a trace
    ray.color.x = 1.0
    d += int(ray.seed)
    reset(ray)
    d += ray.depth
    ox.trace(params.scene, UP, UP, payload=ray)
    other = ox.copy(ray)  # E[OX317]: `Ray.depth` is read after a trace
    params.out[0] = ray.color * float(d)


@ox.program
def __raygen__loops():
    ray = Ray(float3(0.0), 1, 2, 0)
    d = 0
    for k in range(3):
        d += ray.hits  # E[OX317]: `Ray.hits` is read after a trace
        ox.trace(params.scene, UP, UP, payload=ray)  # E[OX317]: `Ray.depth` is passed to another trace
        if k == 1:
            continue
        ray.depth = k
    while d > 0:
        ray.depth = d
        ray.hits = 0
        ox.traverse(params.scene, UP, UP, payload=ray)
        d -= ray.hits + ray.depth
        ox.invoke(payload=ray)
    params.out[0] = ray.color


@ox.program
def __raygen__branches():
    ray = Ray(float3(0.0), 1, 2, 0)
    d = int(params.out[0].x)
    ox.trace(params.scene, UP, UP, payload=ray)
    if d > 3:
        ray = Ray(float3(0.0), 1, 2, 0)
        d = ray.depth
    else:
        ray.depth = 1
    d += ray.depth
    d += ray.hits  # E[OX317]: `Ray.hits` is read after a trace
    params.out[0] = ray.color * float(d)


@ox.program
def __closesthit__nested(ray: Ray):
    ray.color.x = 1.0
    ray.color[1] = 2.0
    ox.trace(params.scene, UP, UP, payload=ray)


@ox.program
def __miss__nested(ray: Ray):
    ox.trace(params.scene, UP, UP, payload=ray)  # E[OX317]: read `Ray.depth` # E[OX317]: read `Ray.seed` # E[OX317]: write `Ray.seed`


@ox.program
def __anyhit__copies(ray: Ray):
    other = ox.copy(ray)  # E[OX317]: read `Ray.color` # E[OX317]: read `Ray.depth` # E[OX317]: read `Ray.seed` # E[OX317]: read `Ray.hits`
