"""Whitted's spheres: custom primitives, two types of rays, reflection and refraction by recursion.

After T. Whitted, "An Improved Illumination Model for Shaded Display", 1980. The hit group of a ray is its primitive's number times two,
plus its ray type: records alternate between radiance and shadow.
"""

import optixc as ox
from optixc import float2, float3, float4, uint32
from optixc.stdlib.camera import Pinhole, pinhole_direction
from optixc.stdlib.fresnel import fresnel_dielectric, fresnel_schlick
from optixc.stdlib.random import sobol_owen_2d

RADIANCE_RAY = 0
SHADOW_RAY = 1
RAY_TYPES = 2
MAX_DEPTH = 8
MIN_IMPORTANCE = 0.01
EPSILON = 1e-3


@ox.struct
class Params:
    """A launch adds number `sample` of `samples` per pixel; `ray_counts` tells how many rays it took so far, shadow rays included.

    The light is a point without fall-off.
    """

    image: ox.Array2[float4]
    ray_counts: ox.Array2[uint32]
    scene: ox.Traversable
    camera: Pinhole
    sample: int
    samples: int
    light_position: float3
    light_color: float3
    ambient_color: float3


@ox.struct
class Floor:
    """A parallelogram with `checks` x `checks` squares."""

    anchor: float3
    edge_u: float3
    edge_v: float3
    light_color: float3
    dark_color: float3
    checks: float


@ox.struct
class MetalBall:
    center: float3
    radius: float
    reflectance: float3


@ox.struct
class GlassShell:
    """A hollow ball: glass between two radii, air inside and outside. Light that passes one surface is multiplied by `tint`."""

    center: float3
    inner_radius: float
    outer_radius: float
    refractive_index: float
    tint: float3


@ox.struct
class PlasticBalls:
    """Many balls in one build input: centre and radius, and a colour, per primitive."""

    spheres: ox.Array[float4]
    colors: ox.Array[float3]


@ox.attributes
class SpherePoint:
    """The unit normal; it points into the air, also on the inner surface of a shell."""

    normal: float3


@ox.attributes
class FloorPoint:
    """Where on the parallelogram, 0 to 1 along each edge."""

    place: float2


@ox.payload
class Radiance:
    """`importance` is the share that this ray has in its pixel at most; `rays` counts it and all that it caused."""

    color: float3
    importance: float
    depth: int
    rays: int


@ox.payload
class Shadow:
    """The share of the light that comes through."""

    light: float3


params = ox.launch_params(Params)


@ox.program
def __raygen__pinhole():
    i, size = ox.get_launch_index(), ox.get_launch_dimensions()
    jitter = sobol_owen_2d(uint32(params.sample), i.y * size.x + i.x)
    screen = float2((float(i.x) + jitter.x) / float(size.x), (float(i.y) + jitter.y) / float(size.y))
    ray = Radiance(float3(0.0), 1.0, 0, 1)
    ox.trace(
        params.scene,
        params.camera.eye,
        pinhole_direction(params.camera, screen),
        sbt_offset=RADIANCE_RAY,
        sbt_stride=RAY_TYPES,
        miss_sbt_index=RADIANCE_RAY,
        payload=ray,
    )
    params.image[i.y, i.x] += float4(ray.color, 1.0) / float(params.samples)
    params.ray_counts[i.y, i.x] += uint32(ray.rays)


@ox.device
def bounce(ray: Radiance, point: float3, direction: float3, weight: float3) -> float3:
    """What comes from `direction`, times `weight`; nothing where that would hardly be seen."""
    importance = ray.importance * ox.max(weight.x, ox.max(weight.y, weight.z))
    if importance < MIN_IMPORTANCE or ray.depth >= MAX_DEPTH:
        return float3(0.0)
    next_ray = Radiance(float3(0.0), importance, ray.depth + 1, 1)
    ox.trace(
        params.scene,
        point,
        direction,
        tmin=EPSILON,
        sbt_offset=RADIANCE_RAY,
        sbt_stride=RAY_TYPES,
        miss_sbt_index=RADIANCE_RAY,
        payload=next_ray,
    )
    ray.rays += next_ray.rays
    return weight * next_ray.color


@ox.device
def light_through(ray: Radiance, point: float3) -> float3:
    """The share of the light that reaches a point, coloured by the glass on its way."""
    shadow = Shadow(float3(1.0))
    ox.trace(
        params.scene,
        point,
        params.light_position - point,
        tmin=EPSILON,
        tmax=1.0,
        ray_flags=ox.RayFlags.DISABLE_CLOSESTHIT,
        sbt_offset=SHADOW_RAY,
        sbt_stride=RAY_TYPES,
        miss_sbt_index=SHADOW_RAY,
        payload=shadow,
    )
    ray.rays += 1
    return shadow.light


@ox.device
def phong(ray: Radiance, point: float3, n: float3, color: float3, shine: float, exponent: float) -> float3:
    """Ambient, diffuse and highlight of the point light."""
    result = color * params.ambient_color
    to_light = ox.normalize(params.light_position - point)
    cosine = ox.dot(n, to_light)
    if cosine > 0.0:
        halfway = ox.normalize(to_light - ox.normalize(ox.get_world_ray_direction()))
        highlight = shine * ox.pow(ox.max(ox.dot(n, halfway), 0.0), exponent)
        result += light_through(ray, point) * params.light_color * (cosine * color + float3(highlight))
    return result


@ox.device
def hit_point() -> float3:
    return ox.get_world_ray_origin() + ox.get_ray_tmax() * ox.get_world_ray_direction()


@ox.device
def sphere_roots(center: float3, radius: float) -> float2:
    """Both distances to a sphere, nearer first; the first is above the second if the ray misses.

    Stable for far away and for large spheres: E. Haines and others, "Precision Improvements for Ray/Sphere Intersection",
    Ray Tracing Gems, 2019.
    """
    o = ox.get_object_ray_origin() - center
    d = ox.get_object_ray_direction()
    a = ox.dot(d, d)
    half_b = -ox.dot(o, d)
    nearest = o + (half_b / a) * d
    discriminant = radius * radius - ox.dot(nearest, nearest)
    if discriminant < 0.0:
        return float2(1.0, -1.0)
    root = ox.sqrt(a * discriminant)
    q = half_b + (root if half_b >= 0.0 else -root)
    t0 = (ox.dot(o, o) - radius * radius) / q
    t1 = q / a
    return float2(ox.min(t0, t1), ox.max(t0, t1))


@ox.device
def report_sphere(t: float, center: float3, side: float) -> bool:
    """Reports a point of a sphere; `side` is -1 where the air is inside."""
    point = ox.get_object_ray_origin() + t * ox.get_object_ray_direction()
    return ox.report_intersection(t, 0, SpherePoint(side * ox.normalize(point - center)))


@ox.device
def report_nearest(center: float3, radius: float):
    """The near point of a sphere, or the far one for a ray that starts inside."""
    roots = sphere_roots(center, radius)
    if roots.x <= roots.y and not report_sphere(roots.x, center, 1.0):
        report_sphere(roots.y, center, 1.0)


@ox.program
def __intersection__metal_ball(ball: MetalBall):
    report_nearest(ball.center, ball.radius)


@ox.program
def __intersection__plastic_balls(balls: PlasticBalls):
    sphere = balls.spheres[ox.get_primitive_index()]
    report_nearest(sphere.xyz, sphere.w)


@ox.program
def __intersection__glass_shell(shell: GlassShell):
    """Up to four points: a shadow ray is attenuated by each, any other ray stops at the first."""
    outer = sphere_roots(shell.center, shell.outer_radius)
    if outer.x > outer.y or report_sphere(outer.x, shell.center, 1.0):
        return
    inner = sphere_roots(shell.center, shell.inner_radius)
    if inner.x <= inner.y and (report_sphere(inner.x, shell.center, -1.0) or report_sphere(inner.y, shell.center, -1.0)):
        return
    report_sphere(outer.y, shell.center, 1.0)


@ox.program
def __intersection__floor(floor: Floor):
    n = ox.cross(floor.edge_u, floor.edge_v)
    o = floor.anchor - ox.get_object_ray_origin()
    d = ox.get_object_ray_direction()
    slope = ox.dot(d, n)
    if slope == 0.0:
        return
    t = ox.dot(o, n) / slope
    across = t * d - o
    scale = 1.0 / ox.dot(n, n)
    u = scale * ox.dot(ox.cross(across, floor.edge_v), n)
    v = scale * ox.dot(ox.cross(floor.edge_u, across), n)
    if 0.0 <= u <= 1.0 and 0.0 <= v <= 1.0:
        ox.report_intersection(t, 0, FloorPoint(float2(u, v)))


@ox.program
def __closesthit__checker(ray: Radiance, hit: FloorPoint, floor: Floor):
    cell = ox.floor(hit.place * floor.checks)
    even = (int(cell.x) + int(cell.y)) % 2 == 0
    n = ox.normalize(ox.cross(floor.edge_u, floor.edge_v))
    ray.color = phong(ray, hit_point(), n, floor.light_color if even else floor.dark_color, 0.0, 1.0)


@ox.program
def __closesthit__metal(ray: Radiance, hit: SpherePoint, ball: MetalBall):
    d = ox.normalize(ox.get_world_ray_direction())
    point = hit_point()
    weight = fresnel_schlick(ball.reflectance, -ox.dot(d, hit.normal))
    color = phong(ray, point, hit.normal, 0.1 * ball.reflectance, 0.9, 180.0)
    ray.color = color + bounce(ray, point, ox.reflect(d, hit.normal), weight)


@ox.program
def __closesthit__plastic(ray: Radiance, hit: SpherePoint, balls: PlasticBalls):
    d = ox.normalize(ox.get_world_ray_direction())
    point = hit_point()
    weight = fresnel_schlick(float3(0.04), -ox.dot(d, hit.normal))
    color = phong(ray, point, hit.normal, balls.colors[ox.get_primitive_index()], 0.35, 60.0)
    ray.color = color + bounce(ray, point, ox.reflect(d, hit.normal), weight)


@ox.program
def __closesthit__glass(ray: Radiance, hit: SpherePoint, shell: GlassShell):
    d = ox.normalize(ox.get_world_ray_direction())
    point = hit_point()

    # From air to glass or back: `eta` is the index on the far side over that on the near side
    cosine = -ox.dot(d, hit.normal)
    eta = shell.refractive_index if cosine > 0.0 else 1.0 / shell.refractive_index
    n = hit.normal if cosine > 0.0 else -hit.normal
    cosine = abs(cosine)

    # Both branches of the tree, each with its Fresnel weight
    reflected = fresnel_dielectric(cosine, eta)
    color = bounce(ray, point, d + 2.0 * cosine * n, float3(reflected))
    sine_squared = (1.0 - cosine * cosine) / (eta * eta)
    if sine_squared < 1.0:
        refraction = d / eta + (cosine / eta - ox.sqrt(1.0 - sine_squared)) * n
        color += bounce(ray, point, refraction, (1.0 - reflected) * shell.tint)

    # The light's own mirror image on the outside
    if eta > 1.0:
        halfway = ox.normalize(ox.normalize(params.light_position - point) - d)
        color += 0.6 * ox.pow(ox.max(ox.dot(n, halfway), 0.0), 250.0) * params.light_color
    ray.color = color


@ox.program
def __anyhit__opaque(shadow: Shadow):
    shadow.light = float3(0.0)
    ox.terminate_ray()


@ox.program
def __anyhit__glass(shadow: Shadow, hit: SpherePoint, shell: GlassShell):
    """Glass dims the light by what it reflects and absorbs, but does not bend it."""
    cosine = abs(ox.dot(ox.normalize(ox.get_world_ray_direction()), hit.normal))
    shadow.light *= shell.tint * (1.0 - fresnel_dielectric(cosine, shell.refractive_index))
    ox.ignore_intersection()


@ox.program
def __miss__sky(ray: Radiance):
    up = ox.max(ox.normalize(ox.get_world_ray_direction()).y, 0.0)
    ray.color = ox.lerp(float3(0.75, 0.85, 0.95), float3(0.10, 0.25, 0.60), ox.sqrt(up))
