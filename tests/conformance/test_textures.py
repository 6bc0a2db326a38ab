"""Textures against the rules of texture look-up written down in numpy: texel centres, weights, wrapping, channels, sRGB."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from harness import Harness
from shaders import textures as shader

import optixc as ox

RANDOM = np.random.default_rng(5)
FLOATS = RANDOM.random((5, 7, 4), dtype=np.float32)
BYTES = RANDOM.integers(0, 256, (4, 3, 3), dtype=np.uint8)
PLACES = RANDOM.uniform(-2.5, 3.5, (301, 2)).astype(np.float32)
WRAPS = ("repeat", "clamp", "mirror", "border")


def look(harness: Harness, texture: Any, places: np.ndarray = PLACES, raygen: str = "look") -> np.ndarray:
    if "textures" not in harness.kept:
        module = harness.module("textures.py")
        harness.kept["textures"] = {
            name: harness.context.program_group_create(raygen=module[f"__raygen__{name}"]) for name in ("look", "odd_ones", "record")
        }
    groups = harness.kept["textures"]
    pipeline = harness.pipeline("textures", groups.values())
    colors = np.full((len(places), 4), np.nan, np.float32)
    record = groups[raygen].record(shader.Surface(texture)) if raygen == "record" else groups[raygen].record()
    params = shader.Params(places, colors, 0 if raygen == "record" else texture)
    harness.launch(pipeline, params, ox.ShaderBindingTable(raygen=record), len(places))
    return colors


def four_channels(texels: np.ndarray, srgb: bool) -> np.ndarray:
    """Float texels, missing channels 0 and a missing alpha 1."""
    values = texels.astype(np.float64)
    if texels.dtype == np.uint8:
        values /= 255.0
        if srgb:
            values[..., :3] = np.where(values[..., :3] <= 0.04045, values[..., :3] / 12.92, ((values[..., :3] + 0.055) / 1.055) ** 2.4)
    full = np.zeros((*texels.shape[:2], 4))
    full[..., 3] = 1.0
    full[..., : texels.shape[2]] = values
    return full


def wrapped(index: np.ndarray, size: int, wrap: str) -> np.ndarray:
    """Texel numbers inside the picture, -1 for the border."""
    if wrap == "repeat":
        return index % size
    if wrap == "clamp":
        return np.clip(index, 0, size - 1)
    if wrap == "mirror":
        return np.minimum(index % (2 * size), 2 * size - 1 - index % (2 * size))
    return np.where((index >= 0) & (index < size), index, -1)


def expected(texels: np.ndarray, filter: str, wraps: tuple[str, str], srgb: bool = False, places: np.ndarray = PLACES) -> np.ndarray:
    full = four_channels(texels, srgb)
    height, width = full.shape[:2]

    def texel(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        column, row = wrapped(x, width, wraps[0]), wrapped(y, height, wraps[1])
        return np.where(((column < 0) | (row < 0))[:, None], 0.0, full[row, column])

    # The product is rounded to float32 in programs; where it lands decides the texel.
    x, y = places[:, 0] * np.float32(width), places[:, 1] * np.float32(height)
    if filter == "nearest":
        return texel(np.floor(x).astype(int), np.floor(y).astype(int))
    x, y = x - np.float32(0.5), y - np.float32(0.5)
    left, top = np.floor(x).astype(int), np.floor(y).astype(int)
    s, t = (x - left)[:, None].astype(np.float64), (y - top)[:, None].astype(np.float64)
    upper = (1 - s) * texel(left, top) + s * texel(left + 1, top)
    lower = (1 - s) * texel(left, top + 1) + s * texel(left + 1, top + 1)
    return (1 - t) * upper + t * lower


# Seven roundings of numbers up to 1, each at most half a unit in the last place.
TOLERANCE = 7 * 0.5 * np.finfo(np.float32).eps


@pytest.mark.parametrize("wrap", WRAPS)
@pytest.mark.parametrize("filter", ["nearest", "linear"])
def test_filters_and_wraps(harness: Harness, filter: str, wrap: str) -> None:
    other = WRAPS[(WRAPS.index(wrap) + 1) % len(WRAPS)]
    for wraps in ((wrap, wrap), (wrap, other)):
        colors = look(harness, ox.Texture2D(FLOATS, filter=filter, wrap=wraps))
        np.testing.assert_allclose(colors, expected(FLOATS, filter, wraps), rtol=0, atol=TOLERANCE)


@pytest.mark.parametrize("srgb", [False, True])
def test_bytes_with_and_without_srgb(harness: Harness, srgb: bool) -> None:
    colors = look(harness, ox.Texture2D(BYTES, srgb=srgb, wrap="clamp"))
    # The power function of sRGB is good to a few units in the last place more.
    np.testing.assert_allclose(colors, expected(BYTES, "linear", ("clamp", "clamp"), srgb), rtol=0, atol=4 * TOLERANCE)


@pytest.mark.parametrize("channels", [1, 2, 3, 4])
def test_missing_channels(harness: Harness, channels: int) -> None:
    texels = FLOATS[:, :, :channels]
    colors = look(harness, ox.Texture2D(texels, filter="nearest"))
    np.testing.assert_array_equal(colors, expected(texels, "nearest", ("repeat", "repeat")).astype(np.float32))
    if channels == 1:
        np.testing.assert_array_equal(look(harness, ox.Texture2D(texels[:, :, 0], filter="nearest")), colors)


def test_texel_centres_are_exact(harness: Harness) -> None:
    height, width = 4, 8
    texels = FLOATS[np.arange(height)[:, None] % 5, np.arange(width) % 7]
    rows, columns = np.mgrid[:height, :width]
    places = np.stack([(columns.ravel() + 0.5) / width, (rows.ravel() + 0.5) / height], 1).astype(np.float32)
    np.testing.assert_array_equal(look(harness, ox.Texture2D(texels), places), texels.reshape(-1, 4))


def test_lanes_that_do_not_look_keep_their_colour(harness: Harness) -> None:
    colors = look(harness, ox.Texture2D(FLOATS, filter="nearest"), raygen="odd_ones")
    reference = expected(FLOATS, "nearest", ("repeat", "repeat")).astype(np.float32)
    reference[::2] = -1.0
    np.testing.assert_array_equal(colors, reference)


def test_a_texture_in_a_record_and_a_change_of_the_array(harness: Harness) -> None:
    array = FLOATS.copy()
    texture = ox.Texture2D(array, filter="nearest")
    array[:] = 0.0
    reference = expected(FLOATS, "nearest", ("repeat", "repeat")).astype(np.float32)
    np.testing.assert_array_equal(look(harness, texture, raygen="record"), reference)
    np.testing.assert_array_equal(look(harness, texture.handle), reference)


def test_stale_and_zero_handles_read_as_zero(harness: Harness) -> None:
    texture = ox.Texture2D(FLOATS)
    handle = int(texture.handle)
    texture.destroy()
    texture.destroy()
    with pytest.raises(ox.InvalidValueError, match="destroyed"):
        look(harness, texture)
    for stale in (handle, 0, (1 << 64) - 1):
        assert not look(harness, stale).any()


def test_coordinates_that_are_no_places(harness: Harness) -> None:
    places = np.array([[np.nan, 0.5], [np.inf, 0.5], [0.5, -np.inf], [3e38, -3e38], [1e9, 0.5]], np.float32)
    for wrap in WRAPS:
        for filter in ("nearest", "linear"):
            colors = look(harness, ox.Texture2D(FLOATS, filter=filter, wrap=wrap), places)
            assert ((colors >= 0.0) & (colors <= 1.0) | np.isnan(colors)).all()


WRONG = {
    "list": lambda: ox.Texture2D([[0.0]]),
    "float64": lambda: ox.Texture2D(np.zeros((2, 2))),
    "one axis": lambda: ox.Texture2D(np.zeros(4, np.float32)),
    "five channels": lambda: ox.Texture2D(np.zeros((2, 2, 5), np.float32)),
    "no texels": lambda: ox.Texture2D(np.zeros((0, 2, 3), np.float32)),
    "filter": lambda: ox.Texture2D(FLOATS, filter="cubic"),
    "wrap": lambda: ox.Texture2D(FLOATS, wrap="tile"),
    "three wraps": lambda: ox.Texture2D(FLOATS, wrap=("clamp", "clamp", "clamp")),
    "srgb of floats": lambda: ox.Texture2D(FLOATS, srgb=True),
    "a picture as scene": lambda: shader.Params(PLACES, np.zeros((1, 4), np.float32), ox.DeviceContext().accel_build(
        [ox.BuildInputTriangles(np.zeros((3, 3), np.float32))])),
}


@pytest.mark.parametrize("name", list(WRONG))
def test_wrong_textures_are_named(name: str) -> None:
    with pytest.raises(ox.InvalidValueError, match=r"[Tt]exture"):
        WRONG[name]()
