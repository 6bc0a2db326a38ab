"""Ray tracing as a query engine: rays in, answers out. Each query is a ray generation program of its own, launched in one dimension.

The arrays of a query are the data of its ray generation record, so that one pipeline serves all three.
"""

import optixc as ox
from optixc import float3, int32, uint2

OCCLUSION = ox.RayFlags.TERMINATE_ON_FIRST_HIT | ox.RayFlags.DISABLE_CLOSESTHIT
CLOSEST_MISS = 0
CLEAR_MISS = 1


@ox.struct
class Params:
    scene: ox.Traversable


@ox.struct
class ProbeQuery:
    """Ray `i` starts at `origins[i]`; `distances[i]` is infinite and `triangles[i]` is -1 where it hits nothing."""

    origins: ox.Array[float3]
    directions: ox.Array[float3]
    distances: ox.Array[float]
    triangles: ox.Array[int32]


@ox.struct
class SightQuery:
    """`visible[i]` becomes 1 if the points numbered `pairs[i]` see each other."""

    points: ox.Array[float3]
    pairs: ox.Array[uint2]
    visible: ox.Array[int32]


@ox.struct
class MotionQuery:
    """Points that fly for `seconds` and bounce; a bounce keeps the share `restitution` of the speed along the normal."""

    positions: ox.Array[float3]
    velocities: ox.Array[float3]
    bounces: ox.Array[int32]
    seconds: float
    restitution: float
    clearance: float


@ox.payload
class Contact:
    """The first triangle along a ray, its distance in units of the direction's length, its normal against the ray."""

    distance: float
    triangle: int
    normal: float3


@ox.payload
class Sight:
    clear: int


params = ox.launch_params(Params)


@ox.program
def __raygen__probe(query: ProbeQuery):
    """Nearest triangle along each ray."""
    i = ox.get_launch_index().x
    contact = Contact(ox.inf, -1, float3(0.0))
    ox.trace(params.scene, query.origins[i], query.directions[i], miss_sbt_index=CLOSEST_MISS, payload=contact)
    query.distances[i] = contact.distance
    query.triangles[i] = contact.triangle


@ox.program
def __raygen__sight(query: SightQuery):
    """Does the segment between two points cross the mesh?"""
    i = ox.get_launch_index().x
    pair = query.pairs[i]
    start = query.points[pair.x]
    sight = Sight(0)
    ox.trace(
        params.scene,
        start,
        query.points[pair.y] - start,
        tmax=1.0,
        ray_flags=OCCLUSION,
        miss_sbt_index=CLEAR_MISS,
        payload=sight,
    )
    query.visible[i] = sight.clear


@ox.program
def __raygen__move(query: MotionQuery):
    """Moves each point to where it is after `seconds`, bouncing off what it meets; a point rests after eight bounces in one step."""
    i = ox.get_launch_index().x
    position = query.positions[i]
    velocity = query.velocities[i]
    remaining = query.seconds
    bounces = 0
    while remaining > 0.0 and bounces < 8:
        contact = Contact(ox.inf, -1, float3(0.0))
        ox.trace(params.scene, position, velocity, tmax=remaining, miss_sbt_index=CLOSEST_MISS, payload=contact)
        if contact.triangle < 0:
            position += remaining * velocity
            break
        # Stop a little in front of the surface, on the side the point came from
        position += contact.distance * velocity + query.clearance * contact.normal
        velocity -= (1.0 + query.restitution) * ox.dot(velocity, contact.normal) * contact.normal
        remaining -= contact.distance
        bounces += 1
    query.positions[i] = position
    query.velocities[i] = velocity
    query.bounces[i] += bounces


@ox.program
def __closesthit__contact(contact: Contact):
    p0, p1, p2 = ox.get_triangle_vertex_data()
    n = ox.normalize(ox.cross(p1 - p0, p2 - p0))
    contact.distance = ox.get_ray_tmax()
    contact.triangle = int(ox.get_primitive_index())
    contact.normal = -n if ox.dot(n, ox.get_world_ray_direction()) > 0.0 else n


@ox.program
def __miss__clear(sight: Sight):
    sight.clear = 1
