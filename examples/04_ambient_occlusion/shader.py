"""Ambient occlusion: how much of the hemisphere above a point is open within a radius.

A primary ray brings back the point and its normal; the ray generation program then sends the occlusion rays, so nothing recurses.
"""

import optixc as ox
from optixc import float2, float3, float4, uint32
from optixc.stdlib.camera import Pinhole, pinhole_direction
from optixc.stdlib.frame import frame_from_normal, to_world
from optixc.stdlib.random import sobol_owen_2d
from optixc.stdlib.sampling import cosine_hemisphere
from optixc.stdlib.self_intersection import offset_ray_origin

SURFACE_MISS = 0
OPEN_MISS = 1


@ox.struct
class Params:
    """A launch adds number `sample` of `samples` primary rays per pixel, followed by `occlusion_rays` of length `radius`.

    `ray_counts` tells how many rays each pixel has taken so far.
    """

    image: ox.Array2[float4]
    ray_counts: ox.Array2[uint32]
    scene: ox.Traversable
    camera: Pinhole
    sample: int
    samples: int
    occlusion_rays: int
    radius: float


@ox.payload
class Surface:
    """The first surface along a primary ray; `hit` is 0 where there is none. The normal points towards the viewer."""

    point: float3
    normal: float3
    hit: int


@ox.payload
class Opening:
    """1 where an occlusion ray got through."""

    open: float


params = ox.launch_params(Params)


@ox.device
def openness(surface: Surface, first: uint32, seed: uint32) -> float:
    """The cosine-weighted share of open directions; 1 on an unoccluded plane. Sample numbers start at `first`."""
    frame = frame_from_normal(surface.normal)
    origin = offset_ray_origin(surface.point, surface.normal)
    total = 0.0
    for k in range(params.occlusion_rays):
        direction = to_world(frame, cosine_hemisphere(sobol_owen_2d(first + uint32(k), seed)))
        opening = Opening(0.0)
        ox.trace(
            params.scene,
            origin,
            direction,
            tmax=params.radius,
            ray_flags=ox.RayFlags.TERMINATE_ON_FIRST_HIT | ox.RayFlags.DISABLE_CLOSESTHIT,
            miss_sbt_index=OPEN_MISS,
            payload=opening,
        )
        total += opening.open
    return total / float(params.occlusion_rays)


@ox.program
def __raygen__ambient_occlusion():
    i, size = ox.get_launch_index(), ox.get_launch_dimensions()
    pixel = i.y * size.x + i.x
    jitter = sobol_owen_2d(uint32(params.sample), pixel)
    screen = float2((float(i.x) + jitter.x) / float(size.x), (float(i.y) + jitter.y) / float(size.y))
    surface = Surface(float3(0.0), float3(0.0), 0)
    ox.trace(params.scene, params.camera.eye, pinhole_direction(params.camera, screen), payload=surface)
    value = 1.0
    rays = 1
    if surface.hit != 0:
        value = openness(surface, uint32(params.sample * params.occlusion_rays), pixel ^ 0x9E3779B9)
        rays += params.occlusion_rays
    params.image[i.y, i.x] += float4(float3(value), 1.0) / float(params.samples)
    params.ray_counts[i.y, i.x] += uint32(rays)


@ox.program
def __closesthit__surface(surface: Surface):
    p0, p1, p2 = ox.get_triangle_vertex_data()
    uv = ox.get_triangle_barycentrics()
    n = ox.normalize(ox.cross(p1 - p0, p2 - p0))
    surface.normal = -n if ox.dot(n, ox.get_world_ray_direction()) > 0.0 else n
    surface.point = (1.0 - uv.x - uv.y) * p0 + uv.x * p1 + uv.y * p2
    surface.hit = 1


@ox.program
def __miss__open(opening: Opening):
    opening.open = 1.0
