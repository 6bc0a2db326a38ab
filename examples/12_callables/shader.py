"""A material network: every node is a direct callable with data of its own, and calls the nodes that feed it.

Two signatures: colour nodes give a colour for a `Surface`, reflection nodes give the BSDF times the cosine for a `Surface` and a
direction. A node names its inputs by their numbers in the table's callables, so the host can wire any graph without compiling again.
"""

import optixc as ox
from optixc import float2, float3, float4, uint3, uint32
from optixc.stdlib.camera import Pinhole, pinhole_direction
from optixc.stdlib.frame import Frame, frame_from_normal, to_local, to_world
from optixc.stdlib.fresnel import fresnel_dielectric, fresnel_schlick
from optixc.stdlib.light import RectangleLight, rectangle_light, rectangle_light_pdf
from optixc.stdlib.math import INV_PI, PI, max_component, square
from optixc.stdlib.microfacet import ggx_distribution, ggx_masking_shadowing, ggx_visible_normal, ggx_visible_normal_pdf
from optixc.stdlib.random import hash_uint3, sobol_owen_2d, unit_float
from optixc.stdlib.sampling import cosine_hemisphere, cosine_hemisphere_pdf
from optixc.stdlib.self_intersection import offset_ray_origin

MAX_BOUNCES = 6
MAX_INDIRECT = 3.0


@ox.struct
class Params:
    """A launch adds number `sample` of `samples` paths per pixel. Lamps are so far away that they are the same from everywhere."""

    image: ox.Array2[float4]
    scene: ox.Traversable
    lamps: ox.Array[RectangleLight]
    camera: Pinhole
    sample: int
    samples: int


@ox.struct
class Object:
    """A mesh and its material: the number of a reflection node, and the roughness of the sharpest part of that reflection."""

    indices: ox.Array2[uint32]
    normals: ox.Array[float3]
    reflection: uint32
    roughness: float


@ox.struct
class Surface:
    """What a node may ask for: the place in object space, and the direction to the viewer in a frame whose z is the normal."""

    point: float3
    wo: float3


@ox.payload
class Path:
    """One step of a path: `done` after a miss, else where and how it goes on. `weight` is light at the end of the step to light here."""

    weight: float3
    done: int
    origin: float3
    direction: float3
    seed: uint32


params = ox.launch_params(Params)


# Colour nodes


@ox.struct
class Constant:
    color: float3


@ox.struct
class Checker:
    """Cubes of two inputs, `scale` of them per unit of length."""

    even: uint32
    odd: uint32
    scale: float


@ox.struct
class Noise:
    """From one input to the other by fractal noise, in a band around the middle: 1 is all of it, small bands have hard edges."""

    low: uint32
    high: uint32
    scale: float
    octaves: int
    band: float


@ox.struct
class Rings:
    """Rings around an axis, or veins along it, bent by noise: wood and marble."""

    early: uint32
    late: uint32
    axis: float3
    scale: float
    turbulence: float
    sharpness: float


@ox.struct
class Facing:
    """One input where the surface faces the viewer, another towards its silhouette."""

    center: uint32
    edge: uint32
    power: float


# Reflection nodes


@ox.struct
class Diffuse:
    color: uint32


@ox.struct
class Metal:
    """`color` is the reflectance at normal incidence."""

    color: uint32
    roughness: float


@ox.struct
class Velvet:
    """Fibres that stand on the surface and catch light at its edge; `base` is the cloth below them."""

    color: uint32
    base: uint32


@ox.struct
class Coat:
    """A clear layer over any other reflection."""

    base: uint32
    refractive_index: float
    roughness: float


@ox.struct
class Blend:
    """Two reflections, mixed by the first channel of a colour node."""

    first: uint32
    second: uint32
    mask: uint32


@ox.device
def lattice(x: int, y: int, z: int) -> float:
    """A random number for each point with whole coordinates."""
    return unit_float(hash_uint3(uint3(uint32(x), uint32(y), uint32(z))).x)


@ox.device
def fade(t: float) -> float:
    """A step with two continuous derivatives."""
    return t * t * t * (t * (6.0 * t - 15.0) + 10.0)


@ox.device
def value_noise(p: float3) -> float:
    """Smooth random values in [0, 1], about one hill per unit. K. Perlin, "Improving Noise", 2002, with values for gradients."""
    cell = ox.floor(p)
    x, y, z = int(cell.x), int(cell.y), int(cell.z)
    u, v, w = fade(p.x - cell.x), fade(p.y - cell.y), fade(p.z - cell.z)
    near = ox.lerp(
        ox.lerp(lattice(x, y, z), lattice(x + 1, y, z), u),
        ox.lerp(lattice(x, y + 1, z), lattice(x + 1, y + 1, z), u),
        v,
    )
    far = ox.lerp(
        ox.lerp(lattice(x, y, z + 1), lattice(x + 1, y, z + 1), u),
        ox.lerp(lattice(x, y + 1, z + 1), lattice(x + 1, y + 1, z + 1), u),
        v,
    )
    return ox.lerp(near, far, w)


@ox.device
def fractal_noise(p: float3, octaves: int) -> float:
    """Octaves of noise, each twice as fine and half as strong, in [0, 1]."""
    total = 0.0
    strength = 0.5
    for _ in range(octaves):
        total += strength * value_noise(p)
        p = 2.03 * p + float3(17.3, 5.1, 9.7)
        strength *= 0.5
    return total / (1.0 - 2.0 * strength)


@ox.device
def color_of(node: uint32, surface: Surface) -> float3:
    return ox.direct_call(node, surface, result=float3)


@ox.device
def reflection_of(node: uint32, surface: Surface, wi: float3) -> float3:
    return ox.direct_call(node, surface, wi, result=float3)


@ox.program
def __direct_callable__constant(surface: Surface, node: Constant) -> float3:
    return node.color


@ox.program
def __direct_callable__checker(surface: Surface, node: Checker) -> float3:
    cell = ox.floor(surface.point * node.scale)
    even = (int(cell.x) + int(cell.y) + int(cell.z)) % 2 == 0
    return color_of(node.even if even else node.odd, surface)


@ox.program
def __direct_callable__noise(surface: Surface, node: Noise) -> float3:
    value = fractal_noise(surface.point * node.scale, node.octaves)
    share = ox.smoothstep(0.5 - 0.5 * node.band, 0.5 + 0.5 * node.band, value)
    return ox.lerp(color_of(node.low, surface), color_of(node.high, surface), float3(share))


@ox.program
def __direct_callable__rings(surface: Surface, node: Rings) -> float3:
    along = ox.dot(surface.point, node.axis)
    away = ox.length(surface.point - along * node.axis)
    bent = node.scale * away + node.turbulence * fractal_noise(1.7 * surface.point, 5)
    share = ox.pow(0.5 + 0.5 * ox.sin(2.0 * PI * bent), node.sharpness)
    return ox.lerp(color_of(node.early, surface), color_of(node.late, surface), float3(share))


@ox.program
def __direct_callable__facing(surface: Surface, node: Facing) -> float3:
    share = ox.pow(1.0 - ox.saturate(surface.wo.z), node.power)
    return ox.lerp(color_of(node.center, surface), color_of(node.edge, surface), float3(share))


@ox.device
def ggx_reflection(wo: float3, wi: float3, roughness: float) -> float:
    """A rough mirror without its Fresnel factor, times the cosine."""
    alpha = float2(square(roughness))
    return ggx_distribution(ox.normalize(wo + wi), alpha) * ggx_masking_shadowing(wo, wi, alpha) / (4.0 * wo.z)


@ox.program
def __direct_callable__diffuse(surface: Surface, wi: float3, node: Diffuse) -> float3:
    return color_of(node.color, surface) * (INV_PI * wi.z)


@ox.program
def __direct_callable__metal(surface: Surface, wi: float3, node: Metal) -> float3:
    half_cosine = ox.dot(surface.wo, ox.normalize(surface.wo + wi))
    return fresnel_schlick(color_of(node.color, surface), half_cosine) * ggx_reflection(surface.wo, wi, node.roughness)


@ox.program
def __direct_callable__velvet(surface: Surface, wi: float3, node: Velvet) -> float3:
    """After M. Ashikhmin and others, "A Microfacet-based BRDF Generator", 2000, section 5.3, with a mean of both cosines below the bar."""
    cosine = ox.normalize(surface.wo + wi).z
    sine_squared = ox.max(1.0 - cosine * cosine, 1e-4)
    fibres = ox.exp(-cosine * cosine / (sine_squared * 0.15)) / (4.0 * (wi.z + surface.wo.z - wi.z * surface.wo.z))
    return color_of(node.color, surface) * (fibres * wi.z) + reflection_of(node.base, surface, wi)


@ox.program
def __direct_callable__coat(surface: Surface, wi: float3, node: Coat) -> float3:
    """What the layer reflects, and what it lets through on both crossings of what is below."""
    half_cosine = ox.dot(surface.wo, ox.normalize(surface.wo + wi))
    own = fresnel_dielectric(half_cosine, node.refractive_index) * ggx_reflection(surface.wo, wi, node.roughness)
    through = 1.0 - fresnel_dielectric(surface.wo.z, node.refractive_index)
    through *= 1.0 - fresnel_dielectric(wi.z, node.refractive_index)
    return float3(own) + through * reflection_of(node.base, surface, wi)


@ox.program
def __direct_callable__blend(surface: Surface, wi: float3, node: Blend) -> float3:
    share = color_of(node.mask, surface).x
    if share <= 0.0:
        return reflection_of(node.first, surface, wi)
    if share >= 1.0:
        return reflection_of(node.second, surface, wi)
    return ox.lerp(reflection_of(node.first, surface, wi), reflection_of(node.second, surface, wi), float3(share))


@ox.program
def __raygen__studio():
    i, size = ox.get_launch_index(), ox.get_launch_dimensions()
    pixel = i.y * size.x + i.x
    jitter = sobol_owen_2d(uint32(params.sample), pixel)
    screen = float2((float(i.x) + jitter.x) / float(size.x), (float(i.y) + jitter.y) / float(size.y))
    color = float3(1.0)
    step = Path(float3(1.0), 0, params.camera.eye, pinhole_direction(params.camera, screen), 0)
    bounce = 0
    while step.done == 0 and bounce <= MAX_BOUNCES:
        step.seed = hash_uint3(uint3(i.x, i.y, uint32(bounce))).x
        ox.trace(params.scene, step.origin, step.direction, payload=step)
        color *= step.weight
        if max_component(color) <= 0.0:
            step.done = 1
        bounce += 1
    if step.done == 0:
        color = float3(0.0)
    # Few bright paths over several surfaces would leave speckles: they are dimmed
    if bounce > 2:
        color *= ox.min(1.0, MAX_INDIRECT / ox.max(max_component(color), 1e-6))
    params.image[i.y, i.x] += float4(color, 1.0) / float(params.samples)


@ox.device
def shading_normal(mesh: Object) -> float3:
    triangle = ox.get_primitive_index()
    uv = ox.get_triangle_barycentrics()
    n0 = mesh.normals[mesh.indices[triangle, 0]]
    n1 = mesh.normals[mesh.indices[triangle, 1]]
    n2 = mesh.normals[mesh.indices[triangle, 2]]
    n = (1.0 - uv.x - uv.y) * n0 + uv.x * n1 + uv.y * n2
    return ox.normalize(ox.transform_normal_from_object_to_world_space(n))


@ox.device
def draw(wo: float3, alpha: float2, frame: Frame, u: float2, choice: float2) -> float3:
    """A direction: a third of them around the normal, a third around the mirror direction, a third to the lamps."""
    if choice.x < 1.0 / 3.0:
        return cosine_hemisphere(u)
    if choice.x < 2.0 / 3.0:
        return ox.reflect(-wo, ggx_visible_normal(wo, alpha, u))
    lamps = int(params.lamps.shape[0])
    lamp = params.lamps[ox.min(int(choice.y * float(lamps)), lamps - 1)]
    return to_local(frame, rectangle_light(lamp, float3(0.0), u).to_light)


@ox.device
def drawn_pdf(wo: float3, alpha: float2, wi: float3, direction: float3) -> float:
    """Density of `draw`; `direction` is wi in world space."""
    lamps = int(params.lamps.shape[0])
    lamp = 0.0
    for k in range(lamps):
        lamp += rectangle_light_pdf(params.lamps[k], float3(0.0), direction) / float(lamps)
    half = ox.normalize(wo + wi)
    mirror = ggx_visible_normal_pdf(wo, half, alpha) / (4.0 * ox.dot(wo, half))
    return (cosine_hemisphere_pdf(wi) + mirror + lamp) / 3.0


@ox.program
def __closesthit__object(step: Path, mesh: Object):
    d = ox.get_world_ray_direction()
    point = ox.get_world_ray_origin() + ox.get_ray_tmax() * d
    p0, p1, p2 = ox.get_triangle_vertex_data()
    geometric = ox.normalize(ox.transform_normal_from_object_to_world_space(ox.cross(p1 - p0, p2 - p0)))
    frame = frame_from_normal(shading_normal(mesh))
    wo = to_local(frame, -d)
    step.weight = float3(0.0)
    if wo.z <= 0.0:
        return
    alpha = float2(square(mesh.roughness))
    sample = uint32(params.sample)
    wi = draw(wo, alpha, frame, sobol_owen_2d(sample, step.seed), sobol_owen_2d(sample, step.seed ^ 0x9E3779B9))
    direction = to_world(frame, wi)
    if wi.z <= 0.0 or ox.dot(direction, geometric) <= 0.0:
        return
    surface = Surface(ox.transform_point_from_world_to_object_space(point), wo)
    step.weight = reflection_of(mesh.reflection, surface, wi) / drawn_pdf(wo, alpha, wi, direction)
    step.origin = offset_ray_origin(point, geometric)
    step.direction = direction


@ox.program
def __miss__studio(step: Path):
    """A grey room, and the lamps."""
    d = ox.get_world_ray_direction()
    light = ox.lerp(float3(0.50, 0.51, 0.54), float3(0.12, 0.14, 0.19), float3(ox.saturate(2.0 * d.y)))
    for k in range(int(params.lamps.shape[0])):
        lamp = params.lamps[k]
        if rectangle_light_pdf(lamp, float3(0.0), d) > 0.0:
            light += lamp.radiance
    step.weight = light
    step.done = 1
