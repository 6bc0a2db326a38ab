"""Paths through hair: curves that scatter light by a model of fibres, in front of a wall, under two rectangular lights.

Closest-hit programs bring back where the path is and what it met; the ray generation program shades and goes on, so nothing recurses.
"""

import optixc as ox
from optixc import float2, float3, float4, uint32
from optixc.stdlib.camera import Pinhole, pinhole_direction
from optixc.stdlib.curves import cubic_bspline_point, cubic_bspline_tangent, normal_across
from optixc.stdlib.frame import Frame, frame_from_normal, to_local, to_world
from optixc.stdlib.hair import Hair, fibre_offset, hair_modes, hair_sample_modes, hair_value
from optixc.stdlib.light import LightSample, RectangleLight, rectangle_light
from optixc.stdlib.math import INV_PI, max_component
from optixc.stdlib.random import pixel_sample_2d
from optixc.stdlib.sampling import cosine_hemisphere
from optixc.stdlib.self_intersection import offset_ray_origin

NOTHING = 0
HAIR = 1
SURFACE = 2
LIGHTS = 2
OPEN_MISS = 1
LIMIT = 3.0


@ox.struct
class Params:
    """A launch adds path number `sample` of `samples` to each pixel; `ray_counts` tells how many rays each pixel has taken so far."""

    image: ox.Array2[float4]
    ray_counts: ox.Array2[uint32]
    scene: ox.Traversable
    camera: Pinhole
    sample: int
    samples: int
    max_depth: int
    hairs: ox.Array[Hair]
    lights: ox.FixedArray[RectangleLight, 2]
    ambient: float3


@ox.struct
class Tress:
    """Record data: which of `Params.hairs` these curves are."""

    hair: int


@ox.struct
class Surface:
    """Record data of triangles: diffuse reflectance."""

    albedo: float3


@ox.payload
class Vertex:
    """What a ray met. Hair: a point of the axis, the unit tangent, the radius; surfaces: the point and the albedo in `tangent`."""

    point: float3
    normal: float3
    tangent: float3
    radius: float
    kind: int
    hair: int


@ox.payload
class Opening:
    """1 where a shadow ray got through."""

    open: float


params = ox.launch_params(Params)


@ox.device
def numbers(pixel: uint32, dimension: uint32) -> float2:
    """Two numbers of this sample for one purpose."""
    return pixel_sample_2d(uint32(params.sample), pixel, dimension)


@ox.device
def is_open(origin: float3, to_light: float3, distance: float) -> float:
    """1 or 0: whether light comes through."""
    opening = Opening(0.0)
    ox.trace(
        params.scene,
        origin,
        to_light,
        tmax=0.999 * distance,
        ray_flags=ox.RayFlags.TERMINATE_ON_FIRST_HIT | ox.RayFlags.DISABLE_CLOSESTHIT,
        miss_sbt_index=OPEN_MISS,
        payload=opening,
    )
    return opening.open


@ox.device
def draw_light(point: float3, u: float2) -> LightSample:
    """A point of one of the lights, each as likely as the other; the radiance is made up for that."""
    chosen = 1 if u.x >= 0.5 else 0
    v = float2(2.0 * u.x - float(chosen), u.y)
    sample = rectangle_light(params.lights[chosen], point, v)
    sample.radiance *= float(LIGHTS)
    return sample


@ox.device
def limited(light: float3, depth: int) -> float3:
    """Seldom a path meets a narrow peak of a fibre after many others: that would be a bright dot, so indirect light has an upper limit."""
    peak = max_component(light)
    return light * (LIMIT / peak) if depth > 0 and peak > LIMIT else light


@ox.device
def beside(vertex: Vertex, direction: float3) -> float3:
    """Where a ray leaves a hair: just outside of it, on the side that it goes to."""
    across = direction - ox.dot(direction, vertex.tangent) * vertex.tangent
    return vertex.point + (1.05 * vertex.radius / ox.max(ox.length(across), 1e-3)) * across


@ox.program
def __raygen__paths():
    i, size = ox.get_launch_index(), ox.get_launch_dimensions()
    pixel = i.y * size.x + i.x
    jitter = numbers(pixel, uint32(0))
    screen = float2((float(i.x) + jitter.x) / float(size.x), (float(i.y) + jitter.y) / float(size.y))
    origin = params.camera.eye
    direction = pinhole_direction(params.camera, screen)
    throughput = float3(1.0)
    color = float3(0.0)
    rays = 0
    for depth in range(params.max_depth):
        vertex = Vertex(float3(0.0), float3(0.0), float3(0.0), 0.0, NOTHING, 0)
        rays += 1
        ox.trace(params.scene, origin, direction, payload=vertex)
        if vertex.kind == NOTHING:
            color += throughput * params.ambient
            break
        dimension = uint32(4 * depth + 1)
        wo = -direction
        light = draw_light(vertex.point, numbers(pixel, dimension))
        scattered = numbers(pixel, dimension + uint32(1))
        if vertex.kind == HAIR:
            # Local coordinates with x along the fibre, as the hair model wants them
            frame = Frame(vertex.tangent, vertex.normal, ox.cross(vertex.tangent, vertex.normal))
            local = to_local(frame, wo)
            modes = hair_modes(params.hairs[vertex.hair], fibre_offset(vertex.tangent, vertex.normal, wo), local)
            if light.pdf > 0.0:
                rays += 1
                value = hair_value(modes, local, to_local(frame, light.to_light)).xyz
                clear = is_open(beside(vertex, light.to_light), light.to_light, light.distance)
                color += limited((clear / light.pdf) * throughput * value * light.radiance, depth)
            sample = hair_sample_modes(modes, local, scattered, numbers(pixel, dimension + uint32(2)))
            direction = to_world(frame, sample.wi)
            throughput *= sample.weight
            origin = beside(vertex, direction)
        else:
            origin = offset_ray_origin(vertex.point, vertex.normal)
            cosine = ox.dot(light.to_light, vertex.normal)
            if light.pdf > 0.0 and cosine > 0.0:
                rays += 1
                clear = is_open(origin, light.to_light, light.distance)
                color += (INV_PI * cosine * clear / light.pdf) * throughput * vertex.tangent * light.radiance
            direction = to_world(frame_from_normal(vertex.normal), cosine_hemisphere(scattered))
            throughput *= vertex.tangent

        # Russian roulette, once a path carries little
        if depth >= 3:
            survival = ox.min(max_component(throughput), 0.95)
            if numbers(pixel, dimension + uint32(3)).x >= survival:
                break
            throughput /= survival
    params.image[i.y, i.x] += float4(color, 1.0) / float(params.samples)
    params.ray_counts[i.y, i.x] += uint32(rays)


@ox.program
def __closesthit__hair(vertex: Vertex, tress: Tress):
    points = ox.get_cubic_bspline_vertex_data()
    u = ox.get_curve_parameter()
    axis = cubic_bspline_point(points, u)
    tangent = ox.normalize(cubic_bspline_tangent(points, u))
    hit = ox.get_world_ray_origin() + ox.get_ray_tmax() * ox.get_world_ray_direction()
    vertex.kind = HAIR
    vertex.hair = tress.hair
    vertex.point = axis.xyz
    vertex.radius = axis.w
    vertex.tangent = tangent
    vertex.normal = normal_across(hit, axis.xyz, tangent)


@ox.program
def __closesthit__surface(vertex: Vertex, surface: Surface):
    p0, p1, p2 = ox.get_triangle_vertex_data()
    uv = ox.get_triangle_barycentrics()
    n = ox.normalize(ox.cross(p1 - p0, p2 - p0))
    vertex.kind = SURFACE
    vertex.normal = -n if ox.dot(n, ox.get_world_ray_direction()) > 0.0 else n
    vertex.point = (1.0 - uv.x - uv.y) * p0 + uv.x * p1 + uv.y * p2
    vertex.tangent = surface.albedo


@ox.program
def __miss__open(opening: Opening):
    opening.open = 1.0
