"""read_image and write_image: what comes back is what was written, and wrong calls are named."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from optixc.errors import FileIoError, InvalidFileFormatError, InvalidValueError
from optixc.host.image import read_image, write_image

pytest.importorskip("OpenImageIO")


@pytest.mark.parametrize("channels", [1, 3, 4])
@pytest.mark.parametrize("extension", [".png", ".bmp", ".tga"])
def test_bytes_come_back(tmp_path: Path, extension: str, channels: int) -> None:
    array = np.random.default_rng(1).integers(0, 256, (5, 7, channels), np.uint8)
    write_image(tmp_path / f"a{extension}", array)
    again = read_image(tmp_path / f"a{extension}")
    assert again.dtype == np.uint8
    np.testing.assert_array_equal(again, array)


def test_sixteen_bits_come_back(tmp_path: Path) -> None:
    array = np.random.default_rng(1).integers(0, 65536, (5, 7, 4), np.uint16)
    write_image(tmp_path / "a.png", array)
    np.testing.assert_array_equal(read_image(tmp_path / "a.png"), array)


@pytest.mark.parametrize("channels", [1, 3, 4])
@pytest.mark.parametrize("extension", [".exr", ".tif"])
def test_floats_come_back(tmp_path: Path, extension: str, channels: int) -> None:
    array = np.random.default_rng(1).normal(0.0, 100.0, (5, 7, channels)).astype(np.float32)
    write_image(tmp_path / f"a{extension}", array)
    np.testing.assert_array_equal(read_image(tmp_path / f"a{extension}"), array)


def test_hdr_keeps_eight_bits_of_mantissa(tmp_path: Path) -> None:
    array = np.random.default_rng(1).uniform(0.5, 1.0, (5, 7, 3)).astype(np.float32) * 1000.0
    write_image(tmp_path / "a.hdr", array)
    np.testing.assert_allclose(read_image(tmp_path / "a.hdr"), array, rtol=2.0**-7)


def test_floats_are_srgb_encoded_after_exposure(tmp_path: Path) -> None:
    array = np.full((2, 2, 4), 0.25, np.float32)
    write_image(tmp_path / "a.png", array, exposure=1.0)
    # sRGB(0.5) = 0.7354, times 255 = 187.5; alpha 0.25 stays linear and is not exposed
    np.testing.assert_array_equal(read_image(tmp_path / "a.png")[0, 0], [188, 188, 188, 64])


def test_values_outside_the_range_and_nan(tmp_path: Path) -> None:
    write_image(tmp_path / "a.png", np.array([[np.nan, np.inf, -np.inf, 2.0, -1.0]], np.float32))
    np.testing.assert_array_equal(read_image(tmp_path / "a.png")[0, :, 0], [0, 255, 0, 255, 0])


def test_the_first_row_is_the_top_one(tmp_path: Path) -> None:
    array = np.zeros((3, 2, 3), np.uint8)
    array[0] = 255
    write_image(tmp_path / "a.png", array)
    assert read_image(tmp_path / "a.png")[:, 0, 0].tolist() == [255, 0, 0]


def test_the_callers_array_is_untouched(tmp_path: Path) -> None:
    array = np.full((2, 2, 3), 0.25, np.float32)
    write_image(tmp_path / "a.exr", array, exposure=3.0)
    write_image(tmp_path / "a.png", array, exposure=3.0)
    assert (array == 0.25).all()


@pytest.mark.parametrize(
    "array",
    [
        np.zeros((2, 2, 2), np.float32),
        np.zeros((2, 2, 3), np.int64),
        np.zeros((0, 2, 3), np.float32),
        np.zeros(4, np.float32),
        np.zeros((2, 2, 3), np.complex64),
    ],
    ids=["two channels", "int64", "empty", "one axis", "complex"],
)
def test_wrong_arrays_are_refused(tmp_path: Path, array: np.ndarray) -> None:
    with pytest.raises(InvalidValueError, match="the array must"):
        write_image(tmp_path / "a.png", array)
    assert not list(tmp_path.iterdir())


def test_wrong_paths_are_named(tmp_path: Path) -> None:
    pixels = np.zeros((2, 2, 3), np.uint8)
    with pytest.raises(InvalidFileFormatError, match=r"\.exr"):
        write_image(tmp_path / "a.xyz", pixels)
    with pytest.raises(FileIoError, match="no folder"):
        write_image(tmp_path / "missing" / "a.png", pixels)
    with pytest.raises(FileIoError, match="no file"):
        read_image(tmp_path / "a.png")
    (tmp_path / "text.png").write_text("not a picture")
    with pytest.raises(InvalidFileFormatError, match=r"text\.png"):
        read_image(tmp_path / "text.png")


def test_a_failed_write_keeps_the_old_file(tmp_path: Path) -> None:
    folder = tmp_path / "a.png"
    folder.mkdir()
    with pytest.raises(FileIoError):
        write_image(folder, np.zeros((2, 2, 3), np.uint8))
    assert list(tmp_path.iterdir()) == [folder]


@pytest.mark.parametrize("exposure", [float("nan"), 1e9, -121, "x", None])
def test_an_exposure_that_no_picture_has(tmp_path: Path, exposure: object) -> None:
    with pytest.raises(InvalidValueError, match="exposure is a number of stops"):
        write_image(tmp_path / "x.png", np.zeros((2, 2, 3)), exposure)  # type: ignore[arg-type]
