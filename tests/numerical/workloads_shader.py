"""The workloads of the OptiX paper's section 8 in small: a path tracer without recursion, photons both ways, lines of sight.

S. Parker and others, "OptiX: A General Purpose Ray Tracing Engine", 2010.
"""

import optixc as ox
from optixc import Array, Array2, float2, float3, uint3, uint8, uint32
from optixc.stdlib.frame import frame_from_normal, to_world
from optixc.stdlib.random import hash_uint3, unit_float
from optixc.stdlib.sampling import uniform_hemisphere, uniform_hemisphere_pdf, uniform_sphere

MAX_BOUNCES = 64
PHOTON_DEPTH = 8
ABSORBED = 0
CUT = 1
ESCAPED = 2


@ox.struct
class Deposit:
    photon: uint32
    bounce: uint32
    position: float3


@ox.struct
class Params:
    scene: ox.Traversable
    albedo: float
    radiance: Array2[float]
    bounces: Array2[uint32]
    deposits: Array[Deposit]
    count: Array[uint32]
    fates: Array[uint32]
    points: Array[float3]
    sight: Array2[uint8]
    reverse: bool


@ox.struct
class Surface:
    is_mirror: bool


@ox.payload
class Path:
    """What the closest hit makes of a ray: where it goes on, and its part of the light that comes from there."""

    throughput: float
    goes_on: bool
    bounce: uint32
    origin: float3
    direction: float3


@ox.payload
class Photon:
    number: uint32
    bounce: uint32


@ox.payload
class Hit:
    position: float3
    normal: float3
    hit: bool


@ox.payload
class Sight:
    clear: bool


params = ox.launch_params(Params)


@ox.device
def draw(number: uint32, bounce: uint32, salt: uint32) -> float3:
    """Three numbers in [0, 1) for a bounce of a path."""
    bits = hash_uint3(uint3(number, bounce, salt))
    return float3(unit_float(bits.x), unit_float(bits.y), unit_float(bits.z))


@ox.device
def facing_normal() -> float3:
    """The unit normal of the triangle that was hit, on the side of the ray's origin."""
    p0, p1, p2 = ox.get_triangle_vertex_data()
    n = ox.normalize(ox.cross(p1 - p0, p2 - p0))
    return -n if ox.dot(n, ox.get_world_ray_direction()) > 0.0 else n


@ox.device
def hit_point() -> float3:
    return ox.get_world_ray_origin() + ox.get_ray_tmax() * ox.get_world_ray_direction()


@ox.device
def path_number() -> uint32:
    index, size = ox.get_launch_index(), ox.get_launch_dimensions()
    return index.y * size.x + index.x


@ox.program
def __raygen__furnace():
    index, size = ox.get_launch_index(), ox.get_launch_dimensions()
    x, y = (float(index.x) + 0.5) / float(size.x) - 0.5, (float(index.y) + 0.5) / float(size.y) - 0.5
    path = Path(1.0, True, uint32(0), float3(0.0, 1.0, 4.0), ox.normalize(float3(x, y - 0.2, -1.0)))
    throughput = 1.0
    while path.goes_on and path.bounce < MAX_BOUNCES:
        ox.trace(params.scene, path.origin, path.direction, payload=path)
        throughput *= path.throughput
        path.bounce += 1
    params.radiance[index.y, index.x] = 0.0 if path.goes_on else throughput
    params.bounces[index.y, index.x] = path.bounce


@ox.program
def __closesthit__scatter(path: Path, surface: Surface):
    n = facing_normal()
    path.origin = hit_point() + 1e-4 * n
    if surface.is_mirror:
        path.throughput = params.albedo
        path.direction = ox.reflect(ox.get_world_ray_direction(), n)
    else:
        u = draw(path_number(), path.bounce, uint32(1))
        wi = uniform_hemisphere(float2(u.x, u.y))
        path.throughput = params.albedo / ox.pi * wi.z / uniform_hemisphere_pdf(wi)
        path.direction = to_world(frame_from_normal(n), wi)


@ox.program
def __miss__white(path: Path):
    path.throughput = 1.0
    path.goes_on = False


@ox.device
def deposit(number: uint32, bounce: uint32, position: float3):
    slot = ox.atomic_add(params.count, 0, uint32(1))
    if slot < uint32(params.deposits.shape[0]):
        params.deposits[slot] = Deposit(number, bounce, position)


@ox.device
def survives(number: uint32, bounce: uint32) -> bool:
    """Russian roulette at a scattering; tells the fate of a photon that ends."""
    if draw(number, bounce, uint32(2)).z >= params.albedo:
        ox.atomic_add(params.fates, ABSORBED, uint32(1))
        return False
    if bounce + 1 >= PHOTON_DEPTH:
        ox.atomic_add(params.fates, CUT, uint32(1))
        return False
    return True


@ox.device
def scattered(number: uint32, bounce: uint32, n: float3) -> float3:
    u = draw(number, bounce, uint32(3))
    return to_world(frame_from_normal(n), uniform_hemisphere(float2(u.x, u.y)))


@ox.device
def emitted(number: uint32) -> float3:
    u = draw(number, uint32(0), uint32(4))
    return uniform_sphere(float2(u.x, u.y))


@ox.program
def __raygen__photons_recursive():
    number = ox.get_launch_index().x
    photon = Photon(number, uint32(0))
    ox.trace(params.scene, float3(0.1, 0.2, 0.3), emitted(number), payload=photon)


@ox.program
def __closesthit__photon(photon: Photon):
    position, n = hit_point(), facing_normal()
    deposit(photon.number, photon.bounce, position)
    if survives(photon.number, photon.bounce):
        onward = Photon(photon.number, photon.bounce + 1)
        ox.trace(params.scene, position + 1e-4 * n, scattered(photon.number, photon.bounce, n), payload=onward)


@ox.program
def __miss__photon(photon: Photon):
    ox.atomic_add(params.fates, ESCAPED, uint32(1))


@ox.program
def __raygen__photons_iterative():
    number = ox.get_launch_index().x
    origin, direction = float3(0.1, 0.2, 0.3), emitted(number)
    for step in range(PHOTON_DEPTH):
        bounce = uint32(step)
        hit = Hit(float3(0.0), float3(0.0), False)
        ox.trace(params.scene, origin, direction, sbt_offset=1, miss_sbt_index=1, payload=hit)
        if not hit.hit:
            ox.atomic_add(params.fates, ESCAPED, uint32(1))
            break
        deposit(number, bounce, hit.position)
        if not survives(number, bounce):
            break
        origin, direction = hit.position + 1e-4 * hit.normal, scattered(number, bounce, hit.normal)


@ox.program
def __closesthit__surface(hit: Hit):
    hit.position, hit.normal, hit.hit = hit_point(), facing_normal(), True


@ox.program
def __raygen__sight():
    """Index (x, y) looks from point x to point x + 1 + y, around the end of the list; the other way round in reverse."""
    index, size = ox.get_launch_index(), ox.get_launch_dimensions()
    here, there = params.points[index.x], params.points[(index.x + 1 + index.y) % size.x]
    if params.reverse:
        here, there = there, here
    sight = Sight(True)
    ox.trace(params.scene, here, there - here, tmax=1.0, ray_flags=ox.RayFlags.DISABLE_CLOSESTHIT, payload=sight)
    params.sight[index.y, index.x] = uint8(1 if sight.clear else 0)


@ox.program
def __anyhit__block(sight: Sight):
    sight.clear = False
    ox.terminate_ray()
