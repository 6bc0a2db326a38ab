"""Ambient occlusion: 16 cosine-distributed rays, one in each of 4 x 4 strata, from every visible point."""

from camera import Camera, camera_direction, pixel_of
from sampling import Random, cosine_hemisphere, facing, pcg_hash, random_float2, tangents

import optixc as ox
from optixc import float2, float3, float4

SAMPLES = 16


@ox.struct
class Params:
    image: ox.Array2[float4]
    scene: ox.Traversable
    camera: Camera
    width: ox.uint32
    radius: float
    offset: float


@ox.payload
class Surface:
    """`t` is negative where nothing was hit; `n` is the unit normal of the triangle."""

    n: float3
    t: float


@ox.payload
class Visibility:
    value: float


params = ox.launch_params(Params)


@ox.program
def __raygen__ambient_occlusion():
    index = ox.get_launch_index()
    pixel = pixel_of(params.camera, index)
    direction = camera_direction(params.camera, pixel)
    surface = Surface(float3(0.0), -1.0)
    ox.trace(params.scene, params.camera.eye, direction, tmin=0.0, tmax=1e16, ray_flags=ox.RayFlags.DISABLE_ANYHIT, payload=surface)
    open_rays = 0.0
    if surface.t >= 0.0:
        n = facing(surface.n, direction)
        origin = params.camera.eye + surface.t * direction + params.offset * n
        s, t = tangents(n)
        random = Random(pcg_hash(pixel.y * params.width + pixel.x))
        for i in range(SAMPLES):
            jitter = random_float2(random)
            local = cosine_hemisphere(float2((float(i & 3) + jitter.x) * 0.25, (float(i >> 2) + jitter.y) * 0.25))
            visibility = Visibility(0.0)
            ox.trace(
                params.scene,
                origin,
                local.x * s + local.y * t + local.z * n,
                tmin=0.0,
                tmax=params.radius,
                ray_flags=ox.RayFlags.TERMINATE_ON_FIRST_HIT | ox.RayFlags.DISABLE_CLOSESTHIT | ox.RayFlags.DISABLE_ANYHIT,
                miss_sbt_index=1,
                payload=visibility,
            )
            open_rays += visibility.value
    params.image[index.y, index.x] = float4(float3(open_rays * (1.0 / SAMPLES)), 1.0)


@ox.program
def __closesthit__surface(surface: Surface):
    surface.n = ox.normalize(ox.get_geometric_normal())
    surface.t = ox.get_ray_tmax()


@ox.program
def __miss__nothing(surface: Surface):
    surface.t = -1.0


@ox.program
def __miss__visible(visibility: Visibility):
    visibility.value = 1.0
