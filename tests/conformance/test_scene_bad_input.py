"""Scenes that cannot be: each is refused by a named error when it is built, whatever kind of value stands where; the process lives."""

from __future__ import annotations

import threading
import warnings
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from shaders import look_down as shader

import optixc as ox

POINTS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 1]], np.float32)
CORNERS = np.array([[0, 1, 2]], np.uint32)
RADII = np.full(4, 0.1, np.float32)
FIRST = np.zeros(1, np.uint32)
LINEAR, RIBBON = ox.PrimitiveType.ROUND_LINEAR, ox.PrimitiveType.FLAT_QUADRATIC_BSPLINE
SRT = np.array([[1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0]] * 2, np.float32)
SCALARS = [None, -1, 0, 1, 3, 7, 255, 256, 2**28, 2**31, 2**32 - 1, 2**32, 2**64, -(2**70), 1.5, float("nan"), float("inf"), "x", b"x", [],
           [1], [1, 2], {}, object(), True, np.int64(-5), np.float32(3), 1j]
DTYPES = ["e", "f", "d", "b", "h", "i", "q", "B", "H", "I", "Q", "?", "D", "O", "S3", "U3", "M8[s]"]


@pytest.fixture(scope="module")
def context() -> ox.DeviceContext:
    return ox.DeviceContext(threads=1, log_callback=lambda *message: None)


def moving(*, begin: float = 0.0, end: float = 1.0, keys: int = 2, flags: int = 0, given: int = 2) -> Callable[[ox.DeviceContext], Any]:
    """A triangle with motion options."""
    inputs = [ox.BuildInputTriangles([POINTS] * given, CORNERS)]
    return lambda context: context.accel_build(inputs, motion_options=ox.MotionOptions(keys, begin, end, flags))


def strand(points: Any = POINTS, radii: Any = RADII, indices: Any = FIRST, kind: Any = LINEAR, **more: Any) -> Callable[..., Any]:
    """One curve."""
    return lambda context: context.accel_build([ox.BuildInputCurves(kind, points, radii, indices, **more)])


def placed(**members: Any) -> Callable[[ox.DeviceContext], Any]:
    """One instance of a triangle."""
    return lambda context: context.accel_build([ox.BuildInputInstances([ox.Instance(triangle(context), **members)])])


def triangle(context: ox.DeviceContext, **more: Any) -> ox.Accel:
    return context.accel_build([ox.BuildInputTriangles(POINTS, CORNERS)], **more)


def turning(quaternion: Any) -> Callable[[ox.DeviceContext], Any]:
    """A transform with this quaternion in its second key."""
    keys = SRT.copy()
    keys[1, 9:13] = quaternion
    return lambda context: context.srt_motion_transform(triangle(context), keys, ox.MotionOptions(2))


def matrices(begin: float, end: float, keys: int = 2) -> Callable[[ox.DeviceContext], Any]:
    """A matrix-motion transform."""
    matrix = np.tile(np.eye(3, 4, dtype=np.float32), (keys, 1, 1))
    return lambda context: context.matrix_motion_transform(triangle(context), matrix, ox.MotionOptions(keys, begin, end))


def above_a_dead_child(context: ox.DeviceContext) -> Any:
    child = triangle(context)
    child.destroy()
    return context.accel_build([ox.BuildInputInstances([int(child._handle)])])


def under_itself(context: ox.DeviceContext) -> Any:
    """A structure whose update names itself as its child."""
    top = context.accel_build([ox.BuildInputInstances([triangle(context)])], build_flags=ox.BuildFlags.ALLOW_UPDATE)
    return top.update([ox.BuildInputInstances([top])])


def too_deep(context: ox.DeviceContext) -> Any:
    made: Any = triangle(context)
    for _ in range(40):
        made = context.static_transform(made, np.eye(3, 4))
    return made


def micromaps(indices: Any = None, **more: Any) -> Callable[[ox.DeviceContext], Any]:
    def build(context: ox.DeviceContext) -> Any:
        array = context.opacity_micromap_array_build([ox.OpacityMicromap(np.zeros(4, np.uint8), 1)])
        given = ox.BuildInputOpacityMicromap(array, indices, **more)
        return context.accel_build([ox.BuildInputTriangles(POINTS, CORNERS, opacity_micromap=given)])
    return build


def raw_micromaps(size: int, *rows: tuple[int, int, int], histogram: Any = None) -> Callable[[ox.DeviceContext], Any]:
    return lambda context: context.opacity_micromap_array_build(np.zeros(size, np.uint8), list(rows), histogram)


REFUSED: dict[str, tuple[Callable[[ox.DeviceContext], Any], str]] = {
    "reversed range": (moving(begin=1.0, end=0.0), "timeBegin 1 is after"),
    "endless range": (moving(end=float("inf")), "must be finite"),
    "range without a number": (moving(begin=float("nan")), "must be finite"),
    "unknown motion flags": (moving(flags=4), "MotionFlags"),
    "one key of two": (moving(given=1), "1 motion keys but the motion options say 2"),
    "three keys of two": (moving(given=3), "3 motion keys but the motion options say 2"),
    "keys without options": (lambda c: c.accel_build([ox.BuildInputTriangles([POINTS] * 2, CORNERS)]), "2 motion keys"),
    "more keys than Embree takes": (moving(keys=130, given=130), "at most 129"),
    "negative number of keys": (moving(keys=-1), "num_keys"),
    "reversed transform": (matrices(1.0, 0.0), "must be before"),
    "transform of no time": (matrices(0.5, 0.5), "must be before"),
    "transform of one key": (matrices(0.0, 1.0, keys=1), "at least 2"),
    "quaternion of length zero": (turning(0), "length zero"),
    "quaternion too short for its square": (turning(1e-30), "squared length"),
    "quaternion too long for its square": (turning(1e30), "squared length"),
    "quaternion without a number": (turning(np.nan), "not finite"),
    "time that is no float": (moving(end=10**400), "are numbers, not 0.0 and 1000"),
    "transform beyond binary32": (placed(transform=np.eye(3, 4) * 1e300), "not finite"),
    "keys beyond binary32": (lambda c: c.matrix_motion_transform(triangle(c), np.full((2, 3, 4), 1e300)), "not finite"),
    "deleted child": (above_a_dead_child, "not alive"),
    "cycle": (under_itself, "keeps the traversables"),
    "graph of depth 32": (too_deep, "32 traversables deep"),
    "mask of nine bits": (placed(visibility_mask=256), "visibility_mask 256"),
    "negative mask": (placed(visibility_mask=-1), "whole numbers"),
    "id of 29 bits": (placed(instance_id=1 << 28), "instance_id"),
    "offset of 29 bits": (placed(sbt_offset=1 << 28), "sbt_offset"),
    "curve of NaN radius": (strand(radii=np.float32([0.1, np.nan, 0.1, 0.1])), "radii of curves"),
    "curve of negative radius": (strand(radii=-RADII), "radii of curves"),
    "segment past the end": (strand(indices=np.uint32([3])), "control points"),
    "segment far past the end": (strand(indices=np.uint32([2**32 - 1])), "control points"),
    "radii of another count": (strand(radii=RADII[:3].copy()), "3 radii for 4 vertices"),
    "normals of round curves": (strand(normals=POINTS), "for ribbons"),
    "normals of another count": (strand(kind=RIBBON, normals=POINTS[:2].copy()), "one vector for each vertex"),
    "no curve type": (strand(kind=ox.PrimitiveType.TRIANGLE), "curve_type"),
    "unknown end caps": (strand(endcap_flags=2), "endcap_flags"),
    "two flag words of a curve": (strand(flags=[0, 0]), "flags"),
    "rows in place of an array": (
        lambda c: c.accel_build([ox.BuildInputTriangles(POINTS.tolist())]), r"vertices .* not a list of list; make one with numpy"
    ),
    "one number for all radii": (lambda c: c.accel_build([ox.BuildInputSpheres(POINTS, [0.5])]), "radii takes .* not a list of float"),
    "inputs of two types": (
        lambda c: c.accel_build([ox.BuildInputTriangles(POINTS, CORNERS), ox.BuildInputInstances([])]),
        "input 1 is a BuildInputInstances but input 0 a BuildInputTriangles"
    ),
    "vertex past the end": (lambda c: c.accel_build([ox.BuildInputTriangles(POINTS, np.uint32([[0, 1, 4]]))]), "4 vertices"),
    "micromap past the end": (micromaps(np.int32([1])), "the array holds 1"),
    "micromap below the predefined ones": (micromaps(np.int32([-5])), "predefined ones are -1 to -4"),
    "micromaps of another count": (micromaps(np.int32([0, 0])), r"shape \(1,\)"),
    "micromap offset past the end": (micromaps(np.int32([0]), index_offset=2**32 - 1), "the array holds 1"),
    "usage that is not so": (micromaps(np.int32([0]), usage_counts=[(2, 1, 2)]), "usage counts: 2 micromaps"),
    "histogram that is not so": (raw_micromaps(1, (0, 1, 2), histogram=[(2, 1, 2)]), "histogram: 2 micromaps"),
    "micromap outside of the data": (raw_micromaps(1, (1, 1, 2)), "do not fit into the 1 bytes"),
    "micromap of 16 MiB in a byte": (raw_micromaps(1, (0, 12, 2)), "do not fit"),
    "micromap of level 13": (raw_micromaps(1, (0, 13, 1)), "level 13"),
    "micromap of no format": (raw_micromaps(1, (0, 1, 3)), "format 3"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_impossible_scenes_are_named(context: ox.DeviceContext, name: str) -> None:
    make, message = REFUSED[name]
    with pytest.raises(ox.OptixError, match=message):
        make(context)


def arrays(like: np.ndarray) -> Iterator[Any]:
    """Arrays that are wrong, or right in an unusual way, in place of `like`."""
    yield from (np.zeros(like.shape, kind) for kind in DTYPES)
    yield from (np.zeros((0, *like.shape[1:]), like.dtype), np.zeros((*like.shape, 1), like.dtype), np.zeros((), like.dtype), like[::-1],
                like[::2], np.lib.stride_tricks.as_strided(like, like.shape, (0,) * like.ndim), np.asfortranarray(like),
                like.astype(like.dtype.newbyteorder(">")), np.ma.masked_array(like), [like, like], [like, like[:1]], [like] * 130, [None])
    floats = (np.nan, np.inf, -np.inf, 3e38, -3e38, 1e-45, -1, 0)
    values = floats if like.dtype.kind == "f" else (7, np.iinfo(like.dtype).max, np.iinfo(like.dtype).max - 1)
    yield from (np.full(like.shape, value, like.dtype) for value in values)
    unaligned = np.zeros(like.nbytes + 1, np.uint8)[1:].view(like.dtype)
    yield unaligned.reshape(like.shape)


def strange(value: Any) -> Iterator[Any]:
    """What a hostile caller may give in place of a value."""
    yield from SCALARS
    yield from arrays(value if isinstance(value, np.ndarray) else POINTS)


GEOMETRY: dict[str, tuple[Any, dict[str, Any]]] = {
    "triangles": (ox.BuildInputTriangles, {"vertices": POINTS, "indices": CORNERS, "flags": 0, "num_sbt_records": 1,
                                           "sbt_index_offsets": None, "primitive_index_offset": 0, "vertex_format": None,
                                           "pre_transform": np.eye(3, 4, dtype=np.float32), "opacity_micromap": None}),
    "custom": (ox.BuildInputCustomPrimitives, {"aabbs": np.float32([[0, 0, 0, 1, 1, 1]]), "flags": 0,
                                               "sbt_index_offsets": np.zeros(1, np.uint8)}),
    "spheres": (ox.BuildInputSpheres, {"centers": POINTS, "radii": RADII, "num_sbt_records": 1}),
    "curves": (ox.BuildInputCurves, {"curve_type": RIBBON, "vertices": POINTS, "radii": RADII, "indices": FIRST, "normals": POINTS,
                                     "endcap_flags": 1, "flags": 0, "primitive_index_offset": 0}),
    "instances": (ox.BuildInputInstances, {"instances": [0, 0], "transforms": np.zeros((2, 3, 4), np.float32), "sbt_offsets": 0,
                                           "instance_ids": np.zeros(2, np.uint32), "visibility_masks": 255, "flags": 0}),
}


@pytest.mark.parametrize(("kind", "field"), [(kind, field) for kind, (_, fields) in GEOMETRY.items() for field in fields])
def test_any_value_is_taken_or_named(context: ox.DeviceContext, kind: str, field: str) -> None:
    make, fields = GEOMETRY[kind]
    for value in strange(fields[field]):
        for options in (None, ox.MotionOptions(2)):
            try_it(lambda value=value, options=options: context.accel_build([make(**{**fields, field: value})], motion_options=options))


@pytest.mark.parametrize("call", [
    lambda context, value: context.accel_build(value),
    lambda context, value: triangle(context, build_flags=value),
    lambda context, value: triangle(context, motion_options=value),
    lambda context, value: triangle(context).relocate(value),
    lambda context, value: triangle(context).emit_property(value),
    lambda context, value: triangle(context, build_flags=ox.BuildFlags.ALLOW_UPDATE).update(value),
    lambda context, value: context.static_transform(value, np.eye(3, 4)),
    lambda context, value: context.static_transform(triangle(context), value),
    lambda context, value: context.matrix_motion_transform(triangle(context), value, None),
    lambda context, value: context.srt_motion_transform(triangle(context), value, None),
    lambda context, value: context.srt_motion_transform(triangle(context), SRT, value),
    lambda context, value: context.opacity_micromap_array_build(value),
    lambda context, value: context.opacity_micromap_array_build(np.zeros(8, np.uint8), value),
    lambda context, value: context.opacity_micromap_array_build([ox.OpacityMicromap(np.zeros(4, np.uint8), 1)], flags=value),
    lambda context, value: context.opacity_micromap_array_build([ox.OpacityMicromap(value, 1)]),
    lambda context, value: context.opacity_micromap_array_build([ox.OpacityMicromap(np.zeros(4, np.uint8), value)]),
    lambda context, value: micromaps(value)(context),
    lambda context, value: micromaps(None, index_offset=value)(context),
    lambda context, value: micromaps(None, usage_counts=value)(context),
    lambda context, value: placed(transform=value)(context),
    lambda context, value: placed(flags=value)(context),
])
def test_any_argument_is_taken_or_named(context: ox.DeviceContext, call: Callable[[ox.DeviceContext, Any], Any]) -> None:
    for value in strange(POINTS):
        try_it(lambda value=value: call(context, value))


def test_what_launches_use_may_be_destroyed_meanwhile(context: ox.DeviceContext) -> None:
    # Each launch sees whole structures or none; parents keep what their children were.
    module, create = context.module_create(shader), context.program_group_create
    raygen, hit = create(raygen=module["__raygen__look"]), create(closesthit=module["__closesthit__seen"])
    miss = create(miss=None)
    pipeline = context.pipeline_create([raygen, miss, hit])
    table = ox.ShaderBindingTable(raygen=raygen.record(), miss=[miss.record()], hitgroup=[hit.record()])
    handles = np.zeros(8, np.uint64)
    results, stop = [], threading.Event()

    def launch() -> None:
        while not stop.is_set():
            seen = np.zeros(4096, np.uint32)
            pipeline.launch(shader.Params(scenes=handles, seen=seen), table, 4096)
            results.append(seen)

    thread = threading.Thread(target=launch)
    thread.start()
    for number in range(300):
        child = triangle(context)
        parent = context.accel_build([ox.BuildInputInstances([ox.Instance(child)])])
        above = context.accel_build([ox.BuildInputInstances([context.static_transform(parent, np.eye(3, 4))])])
        handles[number % 8] = int(above.handle)
        child.destroy()
        parent.destroy()
        if number % 3 == 0:
            above.destroy()
    stop.set()
    thread.join()
    assert results
    assert set(np.unique(np.concatenate(results)).tolist()) <= {0, 1}


def try_it(call: Callable[[], Any]) -> None:
    """Fails for anything but a result or an error of this library that says something."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            call()
        except ox.OptixError as error:
            assert len(str(error)) > 20
