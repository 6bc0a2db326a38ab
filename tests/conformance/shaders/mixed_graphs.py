"""Rays through graphs of all kinds of geometry: what was hit and where it hangs, any-hit calls, and whether anything is in the way.

Boxes are intersected here, at the ray's time: the intersection program reports where the ray enters and where it leaves.
"""

import optixc as ox
from optixc import Array, Array2, Traversable, float3, uint32

ENTERED = 1
LEFT = 2


@ox.struct
class Ray:
    origin: float3
    direction: float3
    tmin: float
    tmax: float
    time: float
    mask: uint32
    flags: uint32
    sbt_offset: uint32
    handle: Traversable


@ox.struct
class Hit:
    is_hit: uint32
    primitive: uint32
    gas_index: uint32
    instance_id: uint32
    instance_index: uint32
    kind: uint32
    record: uint32
    calls: uint32
    is_occluded: uint32
    t: float
    u: float


@ox.struct
class Params:
    rays: Array[Ray]
    hits: Array[Hit]
    to_world: Array2[float]
    to_object: Array2[float]
    boxes: Array2[float]
    eye: float3
    scene: Traversable


@ox.struct
class Record:
    id: uint32
    first_box: uint32
    boxes: uint32  # for each motion key
    ignores: uint32


@ox.payload
class Seen:
    ray: uint32
    calls: uint32
    missed: uint32
    asks: uint32  # whether the closest hit is to be written down


params = ox.launch_params(Params)


@ox.device
def finish(i: uint32, seen: Seen, shadow: Seen):
    params.hits[i].calls = seen.calls
    params.hits[i].is_occluded = 1 - shadow.missed


@ox.program
def __raygen__rays():
    i = ox.get_launch_index().x
    ray = params.rays[i]
    seen = Seen(i, 0, 0, 1)
    ox.trace(ray.handle, ray.origin, ray.direction, tmin=ray.tmin, tmax=ray.tmax, ray_time=ray.time, visibility_mask=ray.mask,
             ray_flags=ray.flags, sbt_offset=ray.sbt_offset, sbt_stride=1, payload=seen)
    shadow = Seen(i, 0, 0, 0)
    ox.trace(ray.handle, ray.origin, ray.direction, tmin=ray.tmin, tmax=ray.tmax, ray_time=ray.time, visibility_mask=ray.mask,
             ray_flags=ray.flags | ox.RayFlags.TERMINATE_ON_FIRST_HIT | ox.RayFlags.DISABLE_CLOSESTHIT, sbt_offset=ray.sbt_offset,
             sbt_stride=1, payload=shadow)
    finish(i, seen, shadow)


@ox.program
def __raygen__eye():
    i = ox.get_launch_index().x
    ray = params.rays[i]
    seen = Seen(i, 0, 0, 1)
    ox.trace(params.scene, params.eye, ray.direction, tmin=0.0, tmax=1e16, ray_time=ray.time, visibility_mask=ray.mask, payload=seen)
    shadow = Seen(i, 0, 0, 0)
    ox.trace(params.scene, params.eye, ray.direction, tmin=0.0, tmax=1e16, ray_time=ray.time, visibility_mask=ray.mask,
             ray_flags=ox.RayFlags.TERMINATE_ON_FIRST_HIT | ox.RayFlags.DISABLE_CLOSESTHIT, payload=shadow)
    finish(i, seen, shadow)


@ox.program
def __miss__nothing(seen: Seen):
    seen.missed = 1


@ox.device
def note(seen: Seen, record: Record, u: float):
    i = seen.ray
    if seen.asks != 0:
        params.hits[i] = Hit(1, ox.get_primitive_index(), ox.get_sbt_gas_index(), ox.get_instance_id(), ox.get_instance_index(),
                             ox.get_hit_kind(), record.id, 0, 0, ox.get_ray_tmax(), u)
        to_world, to_object = ox.get_object_to_world_transform_matrix(), ox.get_world_to_object_transform_matrix()
        for row in range(3):
            for column in range(4):
                params.to_world[i, 4 * row + column] = to_world[row][column]
                params.to_object[i, 4 * row + column] = to_object[row][column]


@ox.program
def __closesthit__solid(seen: Seen, record: Record):
    note(seen, record, 0.0)


@ox.program
def __closesthit__curve(seen: Seen, record: Record):
    note(seen, record, ox.get_curve_parameter())


@ox.program
def __anyhit__count(seen: Seen, record: Record):
    seen.calls = seen.calls + 1
    if record.ignores != 0:
        ox.ignore_intersection()


@ox.device
def side(row: uint32, later: uint32, column: int, fraction: float) -> float:
    return (1.0 - fraction) * params.boxes[row, column] + fraction * params.boxes[later, column]


@ox.program
def __intersection__box(record: Record):
    row = record.first_box + ox.get_primitive_index()
    later = row
    fraction = 0.0
    gas = ox.get_gas_traversable_handle()
    steps = ox.get_gas_motion_step_count(gas)
    if steps > 1:
        begin, end = ox.get_gas_motion_time_begin(gas), ox.get_gas_motion_time_end(gas)
        position = min(max(float(steps - 1) * (ox.get_ray_time() - begin) / (end - begin), 0.0), float(steps - 1))
        key = min(uint32(position), steps - 2)
        fraction = position - float(key)
        row = row + key * record.boxes
        later = row + record.boxes
    low = float3(side(row, later, 0, fraction), side(row, later, 1, fraction), side(row, later, 2, fraction))
    high = float3(side(row, later, 3, fraction), side(row, later, 4, fraction), side(row, later, 5, fraction))
    origin, direction = ox.get_object_ray_origin(), ox.get_object_ray_direction()
    first, second = (low - origin) / direction, (high - origin) / direction
    entry = max(max(min(first.x, second.x), min(first.y, second.y)), min(first.z, second.z))
    leave = min(min(max(first.x, second.x), max(first.y, second.y)), max(first.z, second.z))
    if entry <= leave:
        ox.report_intersection(entry, ENTERED)
        ox.report_intersection(leave, LEFT)
