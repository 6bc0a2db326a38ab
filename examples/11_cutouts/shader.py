"""Leaves cut out of rectangles by a texture: an any-hit program lets rays through where the texture is transparent.

The program asks the texture at every hit on a rectangle. Opacity micromaps say beforehand for most of a rectangle's area that it is opaque
or transparent; then the program runs only along the leaf's outline. Payloads count its runs.
"""

import optixc as ox
from optixc import float2, float3, float4, uint32
from optixc.stdlib.camera import Pinhole, pinhole_direction
from optixc.stdlib.frame import frame_from_normal, to_world
from optixc.stdlib.random import hash_uint, pixel_sample_2d, unit_float
from optixc.stdlib.sampling import cosine_hemisphere, uniform_cone
from optixc.stdlib.self_intersection import offset_ray_origin

RADIANCE = 0
SHADOW = 1
RAY_TYPES = 2
BOUNCES = 4


@ox.struct
class Params:
    """A launch adds path number `sample` of `samples` to each pixel; `counts` has rays and runs of the any-hit program by pixel."""

    image: ox.Array2[float4]
    counts: ox.Array3[uint32]
    scene: ox.Traversable
    camera: Pinhole
    sample: int
    samples: int
    sun_direction: float3
    sun_color: float3


@ox.struct
class Leaves:
    """Record data: texture coordinates of the rectangles' corners in the order of the triangles, and the leaf's picture."""

    uvs: ox.Array2[float2]
    picture: ox.Texture
    color: float3
    other: float3
    through: float


@ox.struct
class Solid:
    """Record data of bark and lawn: a colour, and one that it is mixed with by a pattern."""

    color: float3
    other: float3
    is_lawn: int


@ox.payload
class Surface:
    """The first surface along a ray: `through` is the share of light that comes out on its other side; `runs` counts any-hit programs."""

    point: float3
    normal: float3
    albedo: float3
    through: float
    hit: int
    runs: int


@ox.payload
class Opening:
    """1 where a ray to the sun got through; `runs` counts any-hit programs."""

    open: float
    runs: int


params = ox.launch_params(Params)


@ox.device
def numbers(pixel: uint32, dimension: uint32) -> float2:
    """Two numbers of this sample for one purpose."""
    return pixel_sample_2d(uint32(params.sample), pixel, dimension)


@ox.device
def sky(direction: float3) -> float3:
    """A glow around the sun, white at the horizon, blue above."""
    up = ox.max(direction.y, 0.0)
    glow = ox.pow(ox.max(ox.dot(direction, params.sun_direction), 0.0), 12.0)
    return ox.lerp(float3(0.90, 0.94, 0.98), float3(0.24, 0.47, 0.88), ox.pow(up, 0.6)) + 0.8 * glow * float3(1.0, 0.85, 0.6)


@ox.device
def picture_at(leaves: Leaves, uv: float2) -> float4:
    """Colour and alpha of the picture, filtered, where the current triangle was hit."""
    triangle = ox.get_primitive_index() % 2
    place = (1.0 - uv.x - uv.y) * leaves.uvs[triangle, 0] + uv.x * leaves.uvs[triangle, 1] + uv.y * leaves.uvs[triangle, 2]
    return ox.tex2d(leaves.picture, place.x, place.y)


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
    rays, runs = 0, 0
    for bounce in range(BOUNCES):
        surface = Surface(float3(0.0), float3(0.0), float3(0.0), 0.0, 0, 0)
        rays += 1
        ox.trace(params.scene, origin, direction, sbt_offset=RADIANCE, sbt_stride=RAY_TYPES, payload=surface)
        runs += surface.runs
        if surface.hit == 0:
            color += throughput * sky(direction)
            break
        throughput *= surface.albedo

        # The sun, from the near side or through the leaf from the far one
        to_sun = to_world(frame_from_normal(params.sun_direction), uniform_cone(numbers(pixel, uint32(3 * bounce + 1)), 0.9999))
        cosine = ox.dot(surface.normal, to_sun)
        share = 1.0 - surface.through if cosine > 0.0 else surface.through
        if share > 0.0:
            opening = Opening(0.0, 0)
            rays += 1
            ox.trace(
                params.scene,
                offset_ray_origin(surface.point, surface.normal if cosine > 0.0 else -surface.normal),
                to_sun,
                ray_flags=ox.RayFlags.TERMINATE_ON_FIRST_HIT | ox.RayFlags.DISABLE_CLOSESTHIT,
                sbt_offset=SHADOW,
                sbt_stride=RAY_TYPES,
                miss_sbt_index=SHADOW,
                payload=opening,
            )
            runs += opening.runs
            color += (share * abs(cosine) * opening.open) * throughput * params.sun_color

        # On, to one side or the other
        side = surface.normal
        if numbers(pixel, uint32(3 * bounce + 2)).x < surface.through:
            side = -surface.normal
        direction = to_world(frame_from_normal(side), cosine_hemisphere(numbers(pixel, uint32(3 * bounce + 3))))
        origin = offset_ray_origin(surface.point, side)
    params.image[i.y, i.x] += float4(color, 1.0) / float(params.samples)
    params.counts[i.y, i.x, 0] += uint32(rays)
    params.counts[i.y, i.x, 1] += uint32(runs)


@ox.device
def place(surface: Surface):
    """The point and the normal of a triangle, towards the ray's origin."""
    p0, p1, p2 = ox.get_triangle_vertex_data()
    uv = ox.get_triangle_barycentrics()
    n = ox.normalize(ox.cross(p1 - p0, p2 - p0))
    surface.normal = -n if ox.dot(n, ox.get_world_ray_direction()) > 0.0 else n
    surface.point = (1.0 - uv.x - uv.y) * p0 + uv.x * p1 + uv.y * p2
    surface.hit = 1


@ox.program
def __closesthit__leaf(surface: Surface, leaves: Leaves):
    place(surface)
    veins = picture_at(leaves, ox.get_triangle_barycentrics())
    tint = unit_float(hash_uint(ox.get_primitive_index() // 2))
    surface.albedo = ox.lerp(leaves.color, leaves.other, tint * tint) * veins.xyz
    surface.through = leaves.through


@ox.program
def __closesthit__solid(surface: Surface, solid: Solid):
    place(surface)
    p = surface.point
    pattern = 0.5 + 0.5 * ox.sin(9.0 * p.y + 3.0 * ox.sin(7.0 * p.x) + 3.0 * ox.sin(8.0 * p.z))
    if solid.is_lawn != 0:
        cell = hash_uint(uint32(int(ox.floor(90.0 * p.x)) * 8191 + int(ox.floor(90.0 * p.z)) + 0x5BD1E995))
        broad = 0.5 + 0.5 * ox.sin(1.3 * p.x + ox.sin(0.9 * p.z)) * ox.sin(1.1 * p.z + 0.7)
        pattern = 0.5 * unit_float(cell) + 0.5 * broad
    surface.albedo = ox.lerp(solid.color, solid.other, pattern)


@ox.program
def __anyhit__leaf(surface: Surface, leaves: Leaves):
    surface.runs += 1
    if picture_at(leaves, ox.get_triangle_barycentrics()).w < 0.5:
        ox.ignore_intersection()


@ox.program
def __anyhit__leaf_shadow(opening: Opening, leaves: Leaves):
    opening.runs += 1
    if picture_at(leaves, ox.get_triangle_barycentrics()).w < 0.5:
        ox.ignore_intersection()


@ox.program
def __miss__open(opening: Opening):
    opening.open = 1.0
