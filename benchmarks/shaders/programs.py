"""Programs that differ in one thing at a time: callables against helpers, payload words, exceptions, a shadow ray, recursion."""

import optixc as ox
from optixc import Array2, Traversable, float3, uint32

CALLS = 64
DEPTH = 31


@ox.struct
class Params:
    image: Array2[float3]
    scene: Traversable
    eye: float3
    shadows: bool


@ox.struct
class Factor:
    """Data of a callable, and what the helper takes in its place."""

    scale: float
    shift: float


@ox.payload
class Color:
    color: float3


@ox.payload
class Wide:
    """32 words, of which nobody uses more than three."""

    color: float3
    rest0: ox.uint4
    rest1: ox.uint4
    rest2: ox.uint4
    rest3: ox.uint4
    rest4: ox.uint4
    rest5: ox.uint4
    rest6: ox.uint4
    rest7: uint32


@ox.payload
class Shadow:
    light: float


@ox.payload
class Tree:
    color: float3
    depth: int


@ox.payload
class Step:
    """What a mirror tells the loop: its own light, the share of the next one's, and where that comes from."""

    color: float3
    share: float
    origin: float3
    direction: float3


params = ox.launch_params(Params)


@ox.device
def view_direction() -> float3:
    i, size = ox.get_launch_index(), ox.get_launch_dimensions()
    x = 2.0 * (float(i.x) + 0.5) / float(size.x) - 1.0
    y = 1.0 - 2.0 * (float(i.y) + 0.5) / float(size.y)
    return ox.normalize(float3(x, y, -2.0))


@ox.device
def write(color: float3):
    i = ox.get_launch_index()
    params.image[i.y, i.x] = color


@ox.device
def normal_here() -> float3:
    p0, p1, p2 = ox.get_triangle_vertex_data()
    n = ox.normalize(ox.cross(p1 - p0, p2 - p0))
    return -n if ox.dot(n, ox.get_world_ray_direction()) > 0.0 else n


@ox.device
def point_here() -> float3:
    return ox.get_world_ray_origin() + ox.get_ray_tmax() * ox.get_world_ray_direction()


# Callables against the same arithmetic in place


@ox.device
def step_value(x: float, scale: float, shift: float) -> float:
    return ox.fract(x * scale + shift) + 0.25


@ox.program
def __direct_callable__step(x: float, factor: Factor) -> float:
    return step_value(x, factor.scale, factor.shift)


@ox.program
def __direct_callable__other_step(x: float, factor: Factor) -> float:
    return ox.fract(x * factor.scale + factor.shift) + 0.25


@ox.program
def __raygen__called():
    i = ox.get_launch_index()
    x = float(i.x) * 0.001
    for k in range(CALLS):
        x = ox.direct_call(uint32((k + int(i.y)) & 3), x, result=float)
    write(float3(x))


@ox.program
def __raygen__in_place():
    i = ox.get_launch_index()
    x = float(i.x) * 0.001
    for k in range(CALLS):
        which = float((k + int(i.y)) & 3)
        x = step_value(x, 3.0 + which, 0.1 * which)
    write(float3(x))


# Payload of 3 and of 32 words


@ox.program
def __raygen__narrow():
    ray = Color(float3(0.0))
    ox.trace(params.scene, params.eye, view_direction(), payload=ray)
    write(ray.color)


@ox.program
def __raygen__wide():
    nothing = ox.uint4(uint32(0))
    ray = Wide(float3(0.0), nothing, nothing, nothing, nothing, nothing, nothing, nothing, uint32(0))
    ox.trace(params.scene, params.eye, view_direction(), payload=ray)
    write(ray.color)


@ox.program
def __closesthit__narrow(ray: Color):
    ray.color = abs(normal_here())


@ox.program
def __closesthit__wide(ray: Wide):
    ray.color = abs(normal_here())


@ox.program
def __closesthit__throwing(ray: Color):
    """The same, which throws where there is no light; nothing here is that dark."""
    ray.color = abs(normal_here())
    if ray.color.x + ray.color.y + ray.color.z < 0.1:
        ox.throw_exception(1)


# A shadow ray that a bound value removes, and the program that never had it


@ox.device
def lit(n: float3) -> float3:
    light = ox.normalize(float3(0.4, 1.0, 0.3))
    return float3(ox.max(ox.dot(n, light), 0.0) + 0.1)


@ox.program
def __closesthit__bound(ray: Color):
    n = normal_here()
    ray.color = lit(n)
    if params.shadows:
        shadow = Shadow(0.0)
        flags = uint32(ox.RayFlags.TERMINATE_ON_FIRST_HIT | ox.RayFlags.DISABLE_CLOSESTHIT)
        ox.trace(params.scene, point_here(), float3(0.4, 1.0, 0.3), tmin=1e-3, ray_flags=flags, miss_sbt_index=1, payload=shadow)
        ray.color *= shadow.light


@ox.program
def __closesthit__without(ray: Color):
    ray.color = lit(normal_here())


@ox.program
def __miss__light(shadow: Shadow):
    shadow.light = 1.0


# Mirrors by recursion and by a loop


@ox.device
def own_color(n: float3) -> float3:
    return 0.05 * (float3(1.0) + n)


@ox.program
def __raygen__tree():
    ray = Tree(float3(0.0), 1)
    ox.trace(params.scene, params.eye, view_direction(), payload=ray)
    write(ray.color)


@ox.program
def __closesthit__tree(ray: Tree):
    n = normal_here()
    color = own_color(n)
    if ray.depth < DEPTH:
        reflected = Tree(float3(0.0), ray.depth + 1)
        ox.trace(params.scene, point_here(), ox.reflect(ox.get_world_ray_direction(), n), tmin=1e-3, payload=reflected)
        color += 0.9 * reflected.color
    ray.color = color


@ox.program
def __miss__tree(ray: Tree):
    ray.color = float3(0.5, 0.7, 1.0)


@ox.program
def __raygen__loop():
    origin, direction = params.eye, view_direction()
    color = float3(0.0)
    weight = 1.0
    for _ in range(DEPTH):
        step = Step(float3(0.0), 0.0, origin, direction)
        ox.trace(params.scene, origin, direction, tmin=1e-3, payload=step)
        color += weight * step.color
        weight *= step.share
        if weight <= 0.0:
            break
        origin, direction = step.origin, step.direction
    write(color)


@ox.program
def __closesthit__loop(step: Step):
    n = normal_here()
    step.color = own_color(n)
    step.share = 0.9
    step.origin = point_here()
    step.direction = ox.reflect(ox.get_world_ray_direction(), n)


@ox.program
def __miss__loop(step: Step):
    step.color = float3(0.5, 0.7, 1.0)
