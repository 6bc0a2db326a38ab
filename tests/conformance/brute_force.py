"""A reference tracer in numpy: float64, no acceleration structure, every primitive of the scene tried for every ray.

Scenes are given in the form of the recorded files: a list of traversables by name, children first (see `oracle_scene`). The rules are
those of OptiX: open intervals for built-in primitives, masks at every level, flags of the innermost instance, facing by the winding
in object space, motion by linear interpolation. Triangles, spheres and custom boxes; curves are not tried.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

# A barycentric coordinate this near to 0 is on the edge for binary32.
EDGE = 2e-6
NO_INSTANCE = 0xFFFFFFFF
FRONT_FACE, BACK_FACE, SPHERE = 0xFE, 0xFF, 0x8A
RAY_DISABLE_ANYHIT, RAY_ENFORCE_ANYHIT, RAY_CULL_BACK, RAY_CULL_FRONT = 1, 2, 16, 32
RAY_CULL_DISABLED, RAY_CULL_ENFORCED = 64, 128
GEOMETRY_DISABLE_ANYHIT, GEOMETRY_DISABLE_CULLING = 1, 4
INSTANCE_DISABLE_CULLING, INSTANCE_FLIP, INSTANCE_DISABLE_ANYHIT, INSTANCE_ENFORCE_ANYHIT = 1, 2, 4, 8
START_VANISH, END_VANISH = 1, 2


@dataclass(frozen=True)
class Path:
    """Where in the graph a primitive hangs: composed transforms and what the instances on the way add up to."""

    to_world: Floats
    to_object: Floats
    sbt_offset: int = 0
    instance_id: int = NO_INSTANCE
    instance_index: int = 0
    flags: int = 0


@dataclass(frozen=True)
class Hit:
    """One candidate: a primitive that the ray meets inside its interval, before any-hit programs."""

    t: float
    primitive: int
    gas_index: int
    hit_kind: int
    u: float
    v: float
    geometry_flags: int
    path: Path

    @property
    def is_triangle(self) -> bool:
        """Whether the primitive is a triangle."""
        return self.hit_kind in (FRONT_FACE, BACK_FACE)


@dataclass(frozen=True)
class Box:
    """A custom primitive whose box the ray meets inside its interval, and where it enters it."""

    enter: float
    primitive: int
    gas_index: int
    geometry_flags: int
    path: Path


@dataclass(frozen=True)
class _Ray:
    origin: Floats
    direction: Floats
    tmin: float
    tmax: float
    time: float
    mask: int


def scene_candidates(scene: list[dict[str, Any]], given: dict[str, Any]) -> list[Hit]:
    """Every triangle and sphere that the ray meets, nearest first; culling and any-hit states are not looked at."""
    found = [hit for _, _, _, hits in leaves(scene, given) for hit in hits]
    return sorted(found, key=lambda hit: hit.t)


def scene_boxes(scene: list[dict[str, Any]], given: dict[str, Any]) -> list[Box]:
    """Every custom primitive whose box the ray meets."""
    found = []
    for item, path, ray, _ in leaves(scene, given):
        if item["type"] == "custom":
            found.extend(_boxes(item, path, ray))
    return found


def edges_passed(scene: list[dict[str, Any]], given: dict[str, Any], tolerance: float = EDGE) -> dict[int, float]:
    """The triangles of whose edges or vertices the ray passes one within a barycentric tolerance, and where it does."""
    found: dict[int, float] = {}
    for item, _, ray, _ in leaves(scene, given):
        if item["type"] == "triangles":
            with np.errstate(all="ignore"):
                u, v, t, _ = _barycentrics(_corners(item), ray)
                least = np.minimum(np.minimum(u, v), 1.0 - u - v)
            on_edge = (np.abs(least) < tolerance) & (t > ray.tmin) & (t < ray.tmax)
            found.update({primitive(item, i): float(t[i]) for i in np.flatnonzero(on_edge)})
    return found


def visible(hit: Hit, ray_flags: int) -> bool:
    """Whether the ray's culling flags let the candidate through; CULL_..._ANYHIT judge the state after the ray's own flag."""
    enabled = anyhit_enabled(hit.geometry_flags, hit.path.flags, ray_flags)
    if ray_flags & (RAY_CULL_ENFORCED if enabled else RAY_CULL_DISABLED):
        return False
    if not hit.is_triangle or hit.geometry_flags & GEOMETRY_DISABLE_CULLING or hit.path.flags & INSTANCE_DISABLE_CULLING:
        return True
    return not ray_flags & (RAY_CULL_FRONT if hit.hit_kind == FRONT_FACE else RAY_CULL_BACK)


def anyhit_enabled(geometry_flags: int, instance_flags: int, ray_flags: int) -> bool:
    """Whether any-hit runs: the ray's flag beats the innermost instance's, which beats the geometry's; ENFORCE beats DISABLE."""
    enabled = not geometry_flags & GEOMETRY_DISABLE_ANYHIT
    for disable, enforce, flags in ((INSTANCE_DISABLE_ANYHIT, INSTANCE_ENFORCE_ANYHIT, instance_flags),
                                    (RAY_DISABLE_ANYHIT, RAY_ENFORCE_ANYHIT, ray_flags)):
        if flags & enforce:
            enabled = True
        elif flags & disable:
            enabled = False
    return enabled


def leaves(scene: list[dict[str, Any]], given: dict[str, Any]) -> Iterator[tuple[dict[str, Any], Path, _Ray, list[Hit]]]:
    """Every build input under the root with the ray in its space and the built-in hits."""
    nodes = {node["name"]: node for node in scene}
    mask = int(given["mask"]) & 0xFF
    if mask == 0 or given["root"] not in nodes:
        return
    ray = _Ray(_vector(given["o"]), _vector(given["d"]), float(given["tmin"]), float(given["tmax"]), float(given["time"]), mask)
    for node, path in _walk(nodes, given["root"], Path(_identity(), _identity()), ray):
        if not _exists(node, ray.time):
            continue
        with np.errstate(all="ignore"):
            local = replace(ray, origin=path.to_object[:, :3] @ ray.origin + path.to_object[:, 3],
                            direction=path.to_object[:, :3] @ ray.direction)
        first_record = 0
        for item in node["buildInputs"]:
            keyed = _at_time(item, node.get("motion"), ray.time)
            keyed["firstRecord"] = first_record
            yield keyed, path, local, _hits(keyed, path, local)
            first_record += item["numSbtRecords"]


def _walk(nodes: dict[str, Any], name: str, path: Path, ray: _Ray) -> Iterator[tuple[dict[str, Any], Path]]:
    node = nodes.get(name)
    if node is None or not _exists(node, ray.time):
        return
    if node["kind"] == "GAS":
        yield node, path
    elif node["kind"] == "IAS":
        for index, instance in enumerate(node["instances"]):
            if instance["visibilityMask"] & ray.mask:
                matrix = np.array(instance["transform"], np.float64).reshape(3, 4)
                if abs(np.linalg.det(matrix[:, :3])) > 0.0:
                    below = _below(path, matrix)
                    yield from _walk(nodes, instance["child"], replace(
                        below, sbt_offset=path.sbt_offset + instance["sbtOffset"], instance_id=instance["instanceId"],
                        instance_index=index, flags=instance["flags"]), ray)
    else:
        matrix = transform_at(node, ray.time)
        if abs(np.linalg.det(matrix[:, :3])) > 0.0:
            yield from _walk(nodes, node["child"], _below(path, matrix), ray)


def _below(path: Path, matrix: Floats) -> Path:
    return replace(path, to_world=compose(path.to_world, matrix), to_object=compose(inverse(matrix), path.to_object))


def _exists(node: dict[str, Any], time: float) -> bool:
    motion = node.get("motion")
    if motion is None or motion["numKeys"] < 2:
        return True
    return not ((motion["flags"] & START_VANISH and time < motion["timeBegin"])
                or (motion["flags"] & END_VANISH and time > motion["timeEnd"]))


def key_at(motion: dict[str, Any], time: float) -> tuple[int, float]:
    """The key before `time` and the fraction to the next one, clamped to the range."""
    intervals = motion["numKeys"] - 1
    begin, end = float(motion["timeBegin"]), float(motion["timeEnd"])
    position = min(max(intervals * (time - begin) / (end - begin), 0.0), float(intervals))
    key = min(math.floor(position), intervals - 1)
    return key, position - key


def transform_at(node: dict[str, Any], time: float) -> Floats:
    """The 3x4 matrix of a static, matrix-motion or SRT-motion transform at a time."""
    data = np.array([float(value) for value in node["data"]], np.float64)
    if node["kind"] == "static":
        return data.reshape(3, 4)
    key, fraction = key_at(node["motion"], time)
    if node["kind"] == "matrixMotion":
        keys = data.reshape(-1, 3, 4)
        return (1.0 - fraction) * keys[key] + fraction * keys[key + 1]
    keys = data.reshape(-1, 16)
    return srt_matrix((1.0 - fraction) * keys[key] + fraction * keys[key + 1])


def srt_matrix(srt: Floats) -> Floats:
    """Translation times rotation times scale-shear; the quaternion is normalised."""
    sx, a, b, pvx, sy, c, pvy, sz, pvz, qx, qy, qz, qw, tx, ty, tz = srt
    x, y, z, w = np.array([qx, qy, qz, qw]) / math.sqrt(qx * qx + qy * qy + qz * qz + qw * qw)
    rotation = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                         [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                         [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    scale = np.array([[sx, a, b, pvx], [0, sy, c, pvy], [0, 0, sz, pvz]])
    matrix = rotation @ scale
    matrix[:, 3] += (tx, ty, tz)
    return matrix


def compose(outer: Floats, inner: Floats) -> Floats:
    """The 3x4 matrix that applies `inner` first."""
    result = outer[:, :3] @ inner
    result[:, 3] += outer[:, 3]
    return np.asarray(result, np.float64)


def inverse(matrix: Floats) -> Floats:
    """The 3x4 matrix that undoes `matrix`."""
    linear = np.linalg.inv(matrix[:, :3])
    return np.concatenate([linear, (-linear @ matrix[:, 3])[:, None]], axis=1)


def _at_time(item: dict[str, Any], motion: dict[str, Any] | None, time: float) -> dict[str, Any]:
    """The build input with one key: that of the time."""
    keyed = dict(item)
    for name in ("vertices", "radii", "aabbs"):
        if name in item:
            keys = [_vector(key) for key in item[name]]
            if len(keys) == 1 or motion is None or motion["numKeys"] < 2:
                keyed[name] = keys[0]
            else:
                key, fraction = key_at(motion, time)
                keyed[name] = (1.0 - fraction) * keys[key] + fraction * keys[key + 1]
    return keyed


def _hits(item: dict[str, Any], path: Path, ray: _Ray) -> list[Hit]:
    with np.errstate(all="ignore"):
        match item["type"]:
            case "triangles":
                return _triangle_hits(item, path, ray)
            case "spheres":
                return _sphere_hits(item, path, ray)
            case _:
                return []


def _corners(item: dict[str, Any]) -> Floats:
    points = item["vertices"].reshape(-1, 3)
    if "preTransform" in item:
        matrix = np.array(item["preTransform"], np.float64).reshape(3, 4)
        points = points @ matrix[:, :3].T + matrix[:, 3]
    if "indices" in item:
        return np.asarray(points[np.array(item["indices"]).reshape(-1, 3)], np.float64)
    return np.asarray(points[:len(points) // 3 * 3].reshape(-1, 3, 3), np.float64)


def _barycentrics(corners: Floats, ray: _Ray) -> tuple[Floats, Floats, Floats, Floats]:
    """u, v, t and the determinant (positive for a front face) of the ray and every triangle's plane."""
    a = corners[:, 0]
    ab, ac = corners[:, 1] - a, corners[:, 2] - a
    p = np.cross(ray.direction, ac)
    determinant = np.sum(ab * p, axis=1)
    to_origin = ray.origin - a
    q = np.cross(to_origin, ab)
    u = np.sum(to_origin * p, axis=1) / determinant
    v = q @ ray.direction / determinant
    return u, v, np.sum(ac * q, axis=1) / determinant, determinant


def _triangle_hits(item: dict[str, Any], path: Path, ray: _Ray) -> list[Hit]:
    u, v, t, determinant = _barycentrics(_corners(item), ray)
    inside = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (t > ray.tmin) & (t < ray.tmax)
    front = (determinant > 0.0) != bool(path.flags & INSTANCE_FLIP)
    return [Hit(float(t[i]), primitive(item, i), record(item, i), FRONT_FACE if front[i] else BACK_FACE, float(u[i]), float(v[i]),
                flags(item, i), path) for i in np.flatnonzero(inside)]


def _sphere_hits(item: dict[str, Any], path: Path, ray: _Ray) -> list[Hit]:
    centers = item["vertices"].reshape(-1, 3)
    radii = np.broadcast_to(np.abs(item["radii"]), (len(centers),))
    to_center = ray.origin - centers
    a = ray.direction @ ray.direction
    b = to_center @ ray.direction
    across = to_center - (b / a)[:, None] * ray.direction
    root = a * (radii * radii - np.sum(across * across, axis=1))
    # without the difference of two large numbers where the ray begins near a large sphere
    t = (np.sum(to_center * to_center, axis=1) - radii * radii) / (np.sqrt(root) - b)
    inside = (root > 0.0) & (radii > 0.0) & (t > ray.tmin) & (t < ray.tmax)
    return [Hit(float(t[i]), primitive(item, i), record(item, i), SPHERE, 0.0, 0.0, flags(item, i), path)
            for i in np.flatnonzero(inside)]


def _boxes(item: dict[str, Any], path: Path, ray: _Ray) -> list[Box]:
    boxes = item["aabbs"].reshape(-1, 6)
    with np.errstate(all="ignore"):
        near = (boxes[:, :3] - ray.origin) / ray.direction
        far = (boxes[:, 3:] - ray.origin) / ray.direction
        enter = np.nanmax(np.minimum(near, far), axis=1)
        leave = np.nanmin(np.maximum(near, far), axis=1)
    met = (enter <= leave) & (leave >= ray.tmin) & (enter <= ray.tmax) & np.all(boxes[:, :3] <= boxes[:, 3:], axis=1)
    return [Box(float(enter[i]), primitive(item, i), record(item, i), flags(item, i), path) for i in np.flatnonzero(met)]


def primitive(item: dict[str, Any], index: int) -> int:
    return int(index) + int(item.get("primitiveIndexOffset", 0))


def _local_record(item: dict[str, Any], index: int) -> int:
    return min(int(item["sbtIndexOffset"][index]), item["numSbtRecords"] - 1) if "sbtIndexOffset" in item else 0


def record(item: dict[str, Any], index: int) -> int:
    return int(item["firstRecord"]) + _local_record(item, index)


def flags(item: dict[str, Any], index: int) -> int:
    return int(item["flags"][_local_record(item, index)])


def _identity() -> Floats:
    return np.eye(3, 4)


def _vector(values: Any) -> Floats:
    """The numbers that were traced: of binary32, of which the files hold nine digits."""
    with np.errstate(over="ignore"):
        return np.array([float(value) for value in values], np.float32).astype(np.float64)
