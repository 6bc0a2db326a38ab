"""Photon mapping: photons from the lamp are kept where they meet a diffuse surface, and gathered around the points that the camera sees.

A photon passes mirrors and glass on its way. What becomes of its power is written down: it is kept, it left the scene, or mirrors and glass
took it. Host code sorts the photons into a grid between the two passes.
"""

from enum import IntEnum

import optixc as ox
from optixc import float2, float3, float4, int3, uint32, uint64
from optixc.stdlib.bsdf import radiance_scale, smooth_dielectric_sample
from optixc.stdlib.camera import Pinhole, pinhole_direction
from optixc.stdlib.frame import frame_from_normal, to_local, to_world
from optixc.stdlib.fresnel import fresnel_schlick
from optixc.stdlib.light import RectangleLight, rectangle_light
from optixc.stdlib.math import INV_PI, PI
from optixc.stdlib.random import Pcg32, pcg32, pcg32_float, pcg32_float2
from optixc.stdlib.sampling import cosine_hemisphere

MAX_BOUNCES = 12
EPSILON = 1e-4


class Kind(IntEnum):
    """What a ray met."""

    NOTHING = 0
    DIFFUSE = 1
    METAL = 2
    GLASS = 3
    LAMP = 4


class Fate(IntEnum):
    """What became of a photon; a caustic photon was kept after mirrors or glass."""

    DIRECT = 0
    CAUSTIC = 1
    ESCAPED = 2
    LOST = 3


@ox.struct
class Photon:
    position: float3
    direction: float3
    power: float3
    fate: uint32


@ox.struct
class Grid:
    """Photons sorted by cell, cells in rows along x: those of cell c are `photons[starts[c]]` to before `photons[starts[c + 1]]`. A cell is
    as wide as photons are gathered from."""

    photons: ox.Array[Photon]
    starts: ox.Array[uint32]
    origin: float3
    size: int3
    radius: float


@ox.struct
class Params:
    """The photon pass fills `emitted` and `taken`, one for each launch index; the camera pass adds one sample of `samples` per pixel, with
    the photons in `grid`. `photon_power` is that of one photon at the lamp."""

    emitted: ox.Array[Photon]
    taken: ox.Array[float3]
    image: ox.Array2[float4]
    grid: Grid
    scene: ox.Traversable
    camera: Pinhole
    lamp: RectangleLight
    photon_power: float3
    sample: int
    samples: int


@ox.struct
class Part:
    """A mesh: `color` is the albedo, the reflectance of a metal at normal incidence, or what glass lets through per unit of length."""

    indices: ox.Array2[uint32]
    normals: ox.Array[float3]
    kind: uint32
    color: float3


@ox.payload
class Surface:
    """`normal` is the smooth one, out of the object, `distance` the length of the ray."""

    normal: float3
    color: float3
    kind: uint32
    distance: float


params = ox.launch_params(Params)


@ox.device
def look(origin: float3, direction: float3) -> Surface:
    surface = Surface(float3(0.0), float3(0.0), uint32(Kind.NOTHING), 0.0)
    ox.trace(params.scene, origin, direction, tmin=EPSILON, payload=surface)
    return surface


@ox.device
def passes(surface: Surface) -> bool:
    """Whether a path goes on without being scattered."""
    return surface.kind == Kind.METAL or surface.kind == Kind.GLASS


@ox.device
def deflect(surface: Surface, d: float3, u: float) -> tuple[float3, float3, float]:
    """A mirror's or glass's new direction, the share of the power that goes on, and the factor from power to radiance."""
    if surface.kind == Kind.METAL:
        n = surface.normal if ox.dot(surface.normal, d) < 0.0 else -surface.normal
        return ox.reflect(d, n), fresnel_schlick(surface.color, -ox.dot(d, n)), 1.0
    frame = frame_from_normal(surface.normal)
    wo = to_local(frame, -d)
    sample = smooth_dielectric_sample(1.5, wo, u)
    share = float3(1.0)
    if wo.z < 0.0:
        # The ray came through the glass
        c = surface.color
        share = float3(ox.pow(c.x, surface.distance), ox.pow(c.y, surface.distance), ox.pow(c.z, surface.distance))
    return to_world(frame, sample.wi), share, radiance_scale(1.5, wo, sample.wi)


@ox.program
def __raygen__photons():
    """One photon per launch index."""
    index = ox.get_launch_index().x
    rng = pcg32(uint64(params.sample), uint64(index))
    u = pcg32_float2(rng)
    origin = params.lamp.corner + u.x * params.lamp.edge_u + u.y * params.lamp.edge_v
    lamp_normal = ox.normalize(ox.cross(params.lamp.edge_u, params.lamp.edge_v))
    direction = to_world(frame_from_normal(lamp_normal), cosine_hemisphere(pcg32_float2(rng)))
    power = params.photon_power
    taken = float3(0.0)
    fate = uint32(Fate.LOST)
    for bounce in range(MAX_BOUNCES):
        surface = look(origin, direction)
        if surface.kind == Kind.NOTHING:
            fate = uint32(Fate.ESCAPED)
            break
        origin += surface.distance * direction
        if surface.kind == Kind.DIFFUSE:
            fate = uint32(Fate.DIRECT if bounce == 0 else Fate.CAUSTIC)
            break
        if not passes(surface):
            break
        direction, share, _ = deflect(surface, direction, pcg32_float(rng))
        taken += power * (float3(1.0) - share)
        power *= share
    if fate == Fate.LOST:
        taken += power
        power = float3(0.0)
    params.emitted[index] = Photon(origin, direction, power, fate)
    params.taken[index] = taken


@ox.device
def gathered(point: float3, n: float3, every: bool) -> float3:
    """Irradiance from the photons around a point, near ones with more weight; only caustic ones unless `every`."""
    cell = ox.floor((point - params.grid.origin) / params.grid.radius)
    size = params.grid.size
    x, y, z = int(cell.x), int(cell.y), int(cell.z)
    radius_squared = params.grid.radius * params.grid.radius
    total = float3(0.0)
    for k in range(max(z - 1, 0), min(z + 2, size.z)):
        for j in range(max(y - 1, 0), min(y + 2, size.y)):
            row = (k * size.y + j) * size.x
            first, last = max(x - 1, 0), min(x + 2, size.x)
            if first < last:
                for index in range(int(params.grid.starts[row + first]), int(params.grid.starts[row + last])):
                    photon = params.grid.photons[index]
                    away = photon.position - point
                    share = 1.0 - ox.dot(away, away) / radius_squared
                    flat = abs(ox.dot(away, n)) < 0.2 * params.grid.radius
                    if share > 0.0 and flat and ox.dot(photon.direction, n) < 0.0 and (every or photon.fate == Fate.CAUSTIC):
                        total += share * photon.power
    # The weight 1 - (r / radius)**2 has half the area of the disk
    return total * (2.0 / (PI * radius_squared))


@ox.device
def lamp_light(point: float3, n: float3, u: float2) -> float3:
    """Irradiance from the lamp, whatever stands in the way is opaque: light through glass is the photons' part."""
    light = rectangle_light(params.lamp, point, u)
    cosine = ox.dot(light.to_light, n)
    if light.pdf <= 0.0 or cosine <= 0.0:
        return float3(0.0)
    surface = look(point, light.to_light)
    if surface.kind != Kind.LAMP:
        return float3(0.0)
    return light.radiance * (cosine / light.pdf)


@ox.program
def __raygen__camera():
    i, size = ox.get_launch_index(), ox.get_launch_dimensions()
    rng = pcg32(uint64(params.sample), uint64(i.y * size.x + i.x))
    jitter = pcg32_float2(rng)
    screen = float2((float(i.x) + jitter.x) / float(size.x), (float(i.y) + jitter.y) / float(size.y))
    radiance = seen(params.camera.eye, pinhole_direction(params.camera, screen), rng)
    params.image[i.y, i.x] += float4(radiance, 1.0) / float(params.samples)


@ox.device
def diffuse_point(origin: float3, direction: float3, rng: Pcg32) -> tuple[float3, float3, float3, uint32]:
    """Through mirrors and glass to what scatters or shines: its place, the normal on this side, the path's weight by albedo, its kind."""
    weight = float3(1.0)
    for _ in range(MAX_BOUNCES):
        surface = look(origin, direction)
        origin += surface.distance * direction
        if not passes(surface):
            n = surface.normal if ox.dot(surface.normal, direction) < 0.0 else -surface.normal
            return origin, n, weight * (surface.color if surface.kind == Kind.DIFFUSE else float3(1.0)), surface.kind
        direction, share, scale = deflect(surface, direction, pcg32_float(rng))
        weight *= share * scale
    return origin, direction, float3(0.0), uint32(Kind.NOTHING)


@ox.device
def seen(origin: float3, direction: float3, rng: Pcg32) -> float3:
    """Direct light, caustics, and what one more diffuse surface sends, which all photons tell."""
    point, n, weight, kind = diffuse_point(origin, direction, rng)
    if kind == Kind.LAMP:
        return weight * params.lamp.radiance
    if kind != Kind.DIFFUSE:
        return weight * background()
    irradiance = lamp_light(point, n, pcg32_float2(rng)) + gathered(point, n, False)
    onward = to_world(frame_from_normal(n), cosine_hemisphere(pcg32_float2(rng)))
    other, other_n, other_weight, other_kind = diffuse_point(point, onward, rng)
    if other_kind == Kind.DIFFUSE:
        irradiance += other_weight * gathered(other, other_n, True)
    elif other_kind == Kind.NOTHING:
        irradiance += PI * other_weight * background()
    return weight * irradiance * INV_PI


@ox.device
def background() -> float3:
    """The dark room around."""
    return float3(0.05, 0.055, 0.065)


@ox.program
def __closesthit__part(surface: Surface, part: Part):
    triangle = ox.get_primitive_index()
    uv = ox.get_triangle_barycentrics()
    n0 = part.normals[part.indices[triangle, 0]]
    n1 = part.normals[part.indices[triangle, 1]]
    n2 = part.normals[part.indices[triangle, 2]]
    surface.normal = ox.normalize((1.0 - uv.x - uv.y) * n0 + uv.x * n1 + uv.y * n2)
    surface.color = part.color
    surface.kind = part.kind
    surface.distance = ox.get_ray_tmax()
