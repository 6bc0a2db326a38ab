"""Area P: opacity micromaps."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from harness import Harness
from scenes import CORNER, calls, gas, hitgroup, ias, instance, missed, ray, trace, translation, triangles

import optixc as ox

IGNORE = 1
TWO, FOUR = ox.OpacityMicromapFormat.FORMAT_2_STATE, ox.OpacityMicromapFormat.FORMAT_4_STATE
RAY_DISABLE_ANYHIT, RAY_ENFORCE_ANYHIT, RAY_2_STATE = 1, 2, 1024
INSTANCE_2_STATE, INSTANCE_DISABLE = 16, 32
ALLOW_DISABLE = 128
FOUR_STATES = (0, 1, 2, 3)


def mapped(
    states: Any, level: int, kind: int = FOUR, flags: int = 0, index: Any = (), corners: Any = CORNER, offset: int = 0
) -> dict[str, Any]:
    """A triangle input with one micromap for all."""
    maps = [{"level": level, "format": int(kind), "states": list(states)}]
    return triangles(corners, (flags,), omm={"indexingMode": 1, "index": list(index), "indexSize": 4, "indexOffset": offset, "maps": maps})


def centroids(level: int) -> np.ndarray:
    """The middle of every micro-triangle, in order."""
    return np.mean(ox.micromap_index_to_base_barycentrics(np.arange(4**level), level), axis=0)


def shoot(harness: Harness, scene: list[dict[str, Any]], level: int, mode: int = 0, **more: Any) -> list[Any]:
    """A ray at every micro-triangle of the triangle CORNER."""
    rays = [ray((float(u), float(v), 1.0), **more) for u, v in centroids(level)]
    return trace(harness, scene, rays, [hitgroup(anyhit_mode=mode)], micromaps=True)


def outcomes(results: list[Any]) -> str:
    """For each ray: - a miss, o a hit without any-hit program, a a hit after it, i a miss after it."""
    return "".join(("i" if calls(result) else "-") if missed(result) else ("a" if calls(result) else "o") for result in results)


def test_T216_bytes_of_a_micromap() -> None:
    sizes = [[ox.OpacityMicromap(np.zeros(4**level, np.uint8), level, kind).packed().size for level in range(9)] for kind in (TWO, FOUR)]
    assert sizes == [[1, 1, 2, 8, 32, 128, 512, 2048, 8192], [1, 1, 4, 16, 64, 256, 1024, 4096, 16384]]


def test_T217_T233_mixed_levels_and_formats(harness: Harness) -> None:
    maps = [ox.OpacityMicromap(np.zeros(4**level, np.uint8), level, kind) for level, kind in ((9, TWO), (9, TWO), (8, FOUR))]
    array = harness.context.opacity_micromap_array_build(maps)
    assert (array.size_in_bytes, array.count) == (81920, 3)
    harness.context.opacity_micromap_array_build(
        np.zeros(81920, np.uint8), [(65536, 8, 2), (0, 9, 1), (32768, 9, 1)], [(1, 9, 1), (1, 9, 1), (1, 8, 2)]
    )


def test_T218_T219_T220_the_order_of_micro_triangles() -> None:
    middles = [(centroids(2)[i] * 12).round().astype(int).tolist() for i in range(16)]
    assert middles == [
        [1, 1],
        [2, 2],
        [4, 1],
        [1, 4],
        [2, 5],
        [4, 4],
        [5, 5],
        [5, 2],
        [7, 1],
        [8, 2],
        [10, 1],
        [7, 4],
        [4, 7],
        [2, 8],
        [1, 7],
        [1, 10],
    ]
    assert np.array(ox.micromap_index_to_base_barycentrics(37, 3)).tolist() == [[0.625, 0.125], [0.75, 0.125], [0.625, 0.25]]
    assert np.array(ox.micromap_index_to_base_barycentrics(1000, 5)).tolist() == [[0.1875, 0.75], [0.21875, 0.75], [0.1875, 0.78125]]


def test_T221_children_lie_inside_and_tile() -> None:
    for level in range(5):
        below = ox.barycentrics_to_micromap_index(*centroids(level + 1).T, level)
        assert (below == np.arange(4 ** (level + 1)) // 4).all()


@pytest.mark.parametrize("level", range(10))
def test_T222_T224_every_point_lies_in_its_micro_triangle(level: int) -> None:
    random = np.random.default_rng(222)
    points = random.dirichlet((1, 1, 1), 3000)[:, 1:].astype(np.float32)
    corners = ox.micromap_index_to_base_barycentrics(ox.barycentrics_to_micromap_index(*points.T, level), level)
    inner = ox.base_barycentrics_to_micro_barycentrics(points, *corners)
    assert min(inner.min(), (1 - inner.sum(axis=1)).min()) > -1e-3
    for number, expected in enumerate(((0, 0), (1, 0), (0, 1))):
        assert ox.base_barycentrics_to_micro_barycentrics(corners[number], *corners) == pytest.approx(
            np.tile(np.float32(expected), (len(points), 1)), abs=1e-4
        )


def test_T223_known_points() -> None:
    for point, expected in (((1, 0), (2, 10, 42)), ((0, 1), (3, 15, 63)), ((1 / 3, 1 / 3), (1, 5, 21)), ((0.6, 0.3), (2, 11, 45))):
        assert tuple(int(ox.barycentrics_to_micromap_index(*point, level)) for level in (1, 2, 3)) == expected


@pytest.mark.parametrize("level", [0, 1, 3, 5])
def test_T225_two_states(harness: Harness, level: int) -> None:
    states = np.arange(4**level) % 2
    assert outcomes(shoot(harness, [gas(mapped(states, level, TWO))], level)) == "".join("-o"[state] for state in states)


@pytest.mark.parametrize("level", [2, 4, 6, 7, 9])
@pytest.mark.parametrize("kind", [TWO, FOUR])
def test_T225_T226_states_of_fine_maps(harness: Harness, kind: Any, level: int) -> None:
    random = np.random.default_rng(226 + level)
    states = random.integers(0, 2 * int(kind), 4**level)
    chosen = random.choice(4**level, 200, replace=4**level < 200)
    rays = [ray((float(u), float(v), 1.0)) for u, v in centroids(level)[chosen]]
    results = trace(harness, [gas(mapped(states, level, kind))], rays, micromaps=True)
    assert outcomes(results) == "".join("-oaa"[states[i]] for i in chosen)


def test_neighbouring_rays_meet_unlike_maps(harness: Harness) -> None:
    random = np.random.default_rng(227)
    right = [[2.0, 0.0, 0.0], [3.0, 0.0, 0.0], [2.0, 1.0, 0.0]]
    coarse, fine = random.integers(0, 4, 4), random.integers(0, 2, 4**5)
    scene = [
        gas(mapped(coarse, 1), mapped(fine, 5, TWO, corners=right), name="both"),
        gas(mapped(fine, 5, TWO), triangles(right), name="one", build_flags=ALLOW_DISABLE),
        ias(
            instance("both"),
            instance("both", translation(4.0, 0.0, 0.0), flags=INSTANCE_2_STATE),
            instance("one", translation(8.0, 0.0, 0.0)),
            instance("one", translation(12.0, 0.0, 0.0), flags=INSTANCE_DISABLE),
        ),
    ]
    points = random.dirichlet((1, 1, 1), 300)[:, 1:].astype(np.float32)
    places = random.integers(0, 8, 300)
    rays = [ray((float(u + 2 * x), float(v), 1.0), root="ias") for (u, v), x in zip(points, places, strict=True)]
    results = trace(harness, scene, rays, [hitgroup(0), hitgroup(1)], micromaps=True)
    expected = ""
    for (u, v), place in zip(points, places, strict=True):
        rough = coarse[int(ox.barycentrics_to_micromap_index(u, v, 1))]
        exact = fine[int(ox.barycentrics_to_micromap_index(u, v, 5))]
        expected += ("-oaa"[rough], "-o"[exact], "-o-o"[rough], "-o"[exact], "-o"[exact], "a", "a", "a")[place]
    assert outcomes(results) == expected


def test_T226_T228_T229_four_states(harness: Harness) -> None:
    scene = [gas(mapped(FOUR_STATES, 1))]
    assert outcomes(shoot(harness, scene, 1)) == "-oaa"
    assert outcomes(shoot(harness, scene, 1, mode=IGNORE)) == "-oii"
    assert outcomes(shoot(harness, scene, 1, flags=RAY_2_STATE)) == "-o-o"
    assert outcomes(shoot(harness, scene, 1, flags=RAY_ENFORCE_ANYHIT)) == "-aaa"
    assert outcomes(shoot(harness, scene, 1, flags=RAY_DISABLE_ANYHIT)) == "-ooo"
    assert outcomes(shoot(harness, [gas(mapped(FOUR_STATES, 1, flags=1))], 1)) == "-oaa"
    placed = [*scene, ias(instance(flags=INSTANCE_2_STATE))]
    assert outcomes(shoot(harness, placed, 1, root="ias")) == "-o-o"


def test_T227_maps_can_be_disabled(harness: Harness) -> None:
    for flags, expected in ((0, "aaaa"), (1, "oooo")):
        placed = [gas(mapped(FOUR_STATES, 1, flags=flags), build_flags=ALLOW_DISABLE), ias(instance(flags=INSTANCE_DISABLE))]
        assert outcomes(shoot(harness, placed, 1, root="ias")) == expected
        assert outcomes(shoot(harness, placed, 1, root="ias", flags=RAY_2_STATE)) == expected


def test_T230_predefined_and_offset_indices(harness: Harness) -> None:
    for index, expected in ((-1, "----"), (-2, "oooo"), (-3, "aaaa"), (-4, "aaaa")):
        assert outcomes(shoot(harness, [gas(mapped(FOUR_STATES, 1, index=[index]))], 1)) == expected
    assert outcomes(shoot(harness, [gas(mapped(FOUR_STATES, 1, index=[-4]))], 1, flags=RAY_2_STATE)) == "oooo"


def build(harness: Harness, array: Any, indices: Any, flags: int = 0, **more: Any) -> Any:
    """A GAS of one triangle with micromaps."""
    corners = np.array(CORNER, np.float32)
    return harness.context.accel_build(
        [ox.BuildInputTriangles(corners, opacity_micromap=ox.BuildInputOpacityMicromap(array, indices, **more))], flags
    )


def test_T230_T231_offset_and_narrow_indices(harness: Harness) -> None:
    array = harness.context.opacity_micromap_array_build(
        [ox.OpacityMicromap(np.array([i], np.uint8), 0, TWO) for i in (0, 0, 0, 0, 0, 0, 0, 1)]
    )
    one = [ray((0.2, 0.2, 1.0))]
    for dtype in (np.int16, np.int32):
        made = {"gas": build(harness, array, np.array([2, 9], dtype)[::2], index_offset=5)}
        assert outcomes(trace(harness, [gas(triangles(CORNER))], one, micromaps=True, made=made)) == "o"
    made = {"gas": build(harness, array, None)}  # linear: triangle i has micromap i
    assert outcomes(trace(harness, [gas(triangles(CORNER))], one, micromaps=True, made=made)) == "-"


def test_T232_what_does_not_fit_is_named(harness: Harness) -> None:
    context = harness.context
    make = context.opacity_micromap_array_build
    for arguments, text in (
        ((np.zeros(1, np.uint8), [(0, 2, 2)]), "do not fit"),
        ((np.zeros(4, np.uint8), [(0, 1, 2)], [(2, 1, 2)]), "histogram"),
        ((np.zeros(4, np.uint8), [(0, 13, 1)]), "level 13"),
        ((np.zeros(4, np.uint8), [(0, 0, 3)]), "format 3"),
        (([ox.OpacityMicromap(np.zeros(3, np.uint8), 1)],), "4 whole numbers"),
        (([ox.OpacityMicromap(np.array([0, 1, 2, 1]), 1, TWO)],), "2-state"),
        (([ox.OpacityMicromap(np.array([0, -1, 0, 0]), 1)],), "not -1"),
    ):
        with pytest.raises(ox.InvalidValueError, match=text):
            make(*arguments)
    array = make([ox.OpacityMicromap(np.zeros(4, np.uint8), 1)])
    for indices, more, text in (
        (np.array([1], np.int32), {}, "the array holds 1"),
        (np.array([-5], np.int32), {}, "-1 to -4"),
        (np.array([1 << 32], np.int64), {}, "triangle 0 is 4294967296"),
        (np.array([0, 0], np.int32), {}, "shape"),
        (np.array([0], np.int32), {"usage_counts": [(2, 1, 2)]}, "usage"),
    ):
        with pytest.raises(ox.InvalidValueError, match=text):
            build(harness, array, indices, **more)


def test_T234_updates_of_micromaps_need_their_flag(harness: Harness) -> None:
    array = harness.context.opacity_micromap_array_build([ox.OpacityMicromap(np.array([i], np.uint8), 0, TWO) for i in (0, 1)])
    corners = np.array(CORNER, np.float32)
    other = [ox.BuildInputTriangles(corners, opacity_micromap=ox.BuildInputOpacityMicromap(array, np.array([1], np.int32)))]
    with pytest.raises(ox.InvalidValueError, match="ALLOW_OPACITY_MICROMAP_UPDATE"):
        build(harness, array, np.array([0], np.int32), int(ox.BuildFlags.ALLOW_UPDATE)).update(other)
    accel = build(harness, array, np.array([0], np.int32), int(ox.BuildFlags.ALLOW_UPDATE | ox.BuildFlags.ALLOW_OPACITY_MICROMAP_UPDATE))
    one, scene = [ray((0.2, 0.2, 1.0))], [gas(triangles(CORNER))]
    assert outcomes(trace(harness, scene, one, micromaps=True, made={"gas": accel})) == "-"
    accel.update(other)
    assert outcomes(trace(harness, scene, one, micromaps=True, made={"gas": accel})) == "o"


def test_maps_are_ignored_where_the_pipeline_does_not_ask(harness: Harness) -> None:
    results = trace(harness, [gas(mapped(FOUR_STATES, 1))], [ray((float(u), float(v), 1.0)) for u, v in centroids(1)])
    assert outcomes(results) == "aaaa"


@pytest.mark.parametrize("far", [0.0, 300.0])
@pytest.mark.parametrize("wrap", ["repeat", "clamp"])
@pytest.mark.parametrize("filter", ["linear", "nearest"])
def test_T235_a_baked_map_never_contradicts_the_picture(filter: str, wrap: str, far: float) -> None:
    random = np.random.default_rng(235)
    alpha = np.kron(random.random((9, 13)) > 0.5, np.ones((4, 4))).astype(np.float32)
    # far outside, float32 coordinates are rounded by a good part of a texel
    uvs = (random.uniform(-0.7, 1.2, (30, 2)) + (far if wrap == "repeat" else 0.0)).astype(np.float32)
    baked = ox.bake_opacity_micromap(alpha, uvs, level=4, filter=filter, wrap=wrap)
    assert 0.0 < baked.known < 1.0
    for number, corners in enumerate(uvs.reshape(-1, 3, 2)):
        points = random.dirichlet((1, 1, 1), 2000).astype(np.float32)
        read = _read(alpha, points @ corners, filter, wrap)
        index = int(baked.indices[number])
        states = (
            np.full(2000, -1 - index) if index < 0 else baked.maps[index].states[ox.barycentrics_to_micromap_index(*points[:, 1:].T, 4)]
        )
        assert (read[states == 1] >= 0.5).all()
        assert (read[states == 0] < 0.5).all()


def _read(alpha: np.ndarray, uvs: np.ndarray, filter: str, wrap: str) -> np.ndarray:
    """The picture as a texture of this filter and wrap mode reads it."""
    height, width = alpha.shape

    def texel(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        inside = (y % height, x % width) if wrap == "repeat" else (np.clip(y, 0, height - 1), np.clip(x, 0, width - 1))
        return np.asarray(alpha[inside])

    x, y = uvs[:, 0].astype(np.float64) * width, uvs[:, 1].astype(np.float64) * height
    if filter == "nearest":
        return texel(np.floor(x).astype(int), np.floor(y).astype(int))
    left, top = np.floor(x - 0.5).astype(int), np.floor(y - 0.5).astype(int)
    s, t = x - 0.5 - left, y - 0.5 - top
    read = [[texel(left + i, top + j) for i in (0, 1)] for j in (0, 1)]
    return np.asarray((1 - t) * ((1 - s) * read[0][0] + s * read[0][1]) + t * ((1 - s) * read[1][0] + s * read[1][1]))


UVS = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
CHECKERS = (np.arange(64).reshape(8, 8) % 3 * 100).astype(np.uint8)


@pytest.mark.parametrize(("uvs", "expected"), [
    (0.0 * UVS + 0.3, None), (UVS[[0, 1, 1]], None), (3.0 * UVS - 1.0, None), (1e6 * UVS, None), (UVS[:0], None),
    (np.where(UVS == 1.0, np.nan, UVS), r"uvs\[1\] is \[nan"), (np.where(UVS == 1.0, np.inf, UVS), r"uvs\[1\] is \[inf"),
    (1e9 * UVS, "at most 16777216"), ("x", "shape"), (UVS.astype(complex), "complex"), ([[0.0, 1.0], [0.0]], "array of numbers")])
def test_texture_coordinates_of_every_kind(uvs: Any, expected: str | None) -> None:
    for wrap in ("repeat", "clamp"):
        if expected is None:
            assert len(ox.bake_opacity_micromap(CHECKERS, uvs, level=2, wrap=wrap).indices) == len(uvs) // 3
        else:
            with pytest.raises(ox.InvalidValueError, match=expected):
                ox.bake_opacity_micromap(CHECKERS, uvs, level=2, wrap=wrap)


@pytest.mark.parametrize(("given", "expected"), [
    ({"level": True}, "level"), ({"level": 13}, "level"), ({"cutoff": float("nan")}, "cutoff"), ({"cutoff": "x"}, "cutoff"),
    ({"indices": [[0, 1, -1]]}, "below 3"), ({"indices": np.zeros((1, 3))}, "rows of three"), ({"indices": [[0, 1, 2], [0]]}, "array"),
    ({"alpha": CHECKERS > 3}, "bool"), ({"alpha": np.zeros((0, 4), np.uint8)}, "one channel"), ({"wrap": "mirror"}, "mirror")])
def test_what_cannot_be_baked_is_named(given: dict[str, Any], expected: str) -> None:
    with pytest.raises(ox.InvalidValueError, match=expected):
        ox.bake_opacity_micromap(**({"alpha": CHECKERS, "uvs": UVS} | given))


@pytest.mark.parametrize("filter", ["linear", "nearest"])
def test_a_baked_map_knows_what_lies_clear_of_the_outline(filter: str) -> None:
    # Opaque below a slanted line in a picture of 128 texels; level 4 makes micro-triangles of 8 texels
    size, level = 128, 4
    x, y = np.meshgrid(np.arange(size) + 0.5, np.arange(size) + 0.5)
    alpha = np.clip(0.5 + (0.83 * x + 0.56 * y - 88.0), 0.0, 1.0).astype(np.float32)
    corners = np.array([[0.05, 0.05], [0.95, 0.05], [0.05, 0.95]])
    baked = ox.bake_opacity_micromap(alpha, corners, level=level, filter=filter, wrap="clamp")
    states = baked.maps[int(baked.indices[0])].states
    parts = np.stack(ox.micromap_index_to_base_barycentrics(np.arange(4**level), level)).astype(np.float64)
    places = size * (corners[0] + parts[..., :1] * (corners[1] - corners[0]) + parts[..., 1:] * (corners[2] - corners[0]))
    height = 0.83 * places[..., 0] + 0.56 * places[..., 1] - 88.0
    # A filter reads texels at most 1.5 away in x and y, so beyond 1.5 * (0.83 + 0.56) nothing of the other side is seen
    margin = 2.1
    assert (states[(height > margin).all(axis=0)] == 1).all()
    assert (states[(height < -margin).all(axis=0)] == 0).all()
    crossed = ((height > 0.5).any(axis=0)) & ((height < -0.5).any(axis=0))
    assert crossed.sum() > 10
    assert (states[crossed] >= 2).all()
