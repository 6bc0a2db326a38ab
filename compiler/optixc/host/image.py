"""Pictures from and to files through OpenImageIO, which is imported when the first picture is read or written.

Arrays are (height, width, channels), the first row is the top one. Colour of floats is linear, colour of uint8 and uint16 is sRGB
encoded; alpha is linear and not multiplied into the colour. Textures do not come here: they take arrays.
"""

from __future__ import annotations

import functools
import importlib
import os
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import numpy.typing as npt

from optixc.errors import FileIoError, InvalidFileFormatError, InvalidValueError, LibraryNotFoundError

_INTEGER_FORMATS = frozenset({".png", ".jpg", ".jpeg", ".bmp", ".tga"})
_FLOAT_FORMATS = frozenset({".exr", ".hdr", ".tif", ".tiff", ".pfm"})
_MOST_STOPS = 120  # 2 ** 120 still is a float32
_CHANNELS = {".hdr": (3,), ".pfm": (1, 3), ".jpg": (1, 3), ".jpeg": (1, 3), ".bmp": (1, 3, 4), ".tga": (1, 3, 4)}


@functools.cache
def _image_library() -> ModuleType:
    try:
        return importlib.import_module("OpenImageIO")
    except ImportError as error:
        raise LibraryNotFoundError("reading and writing pictures needs OpenImageIO: pip install OpenImageIO") from error


def read_image(path: str | os.PathLike[str]) -> npt.NDArray[Any]:
    """The picture of a file, (height, width, channels): uint8 or uint16 as stored, anything else as float32.

    Raises FileIoError for a file that is missing or broken, InvalidFileFormatError for one of no known format.
    """
    source = Path(path)
    if not source.is_file():
        raise FileIoError(f"read_image: there is no file {source}")
    library = _image_library()
    configuration = library.ImageSpec()
    configuration.attribute("oiio:UnassociatedAlpha", 1)
    file = library.ImageInput.open(str(source), configuration)
    if file is None:
        raise InvalidFileFormatError(f"read_image: {source} is not a picture of a known format: {library.geterror().strip()}")
    try:
        stored = str(file.spec().format)
        pixels = file.read_image(stored if stored in ("uint8", "uint16") else "float")
        if pixels is None:
            raise FileIoError(f"read_image: {source} cannot be read: {file.geterror().strip()}")
    finally:
        file.close()
    return np.ascontiguousarray(pixels)


def write_image(path: str | os.PathLike[str], array: npt.ArrayLike, exposure: float = 0.0) -> None:
    """Writes a picture; the extension of `path` says how: .png .jpg .bmp .tga of 8 bits (16 from uint16, PNG only), or .exr .hdr .tif
    .pfm of floats.

    `array` is (height, width) or (height, width, 1, 3 or 4), of floats, uint8 or uint16. Floats are multiplied by 2 ** `exposure` and,
    for a format of integers, clipped to [0, 1] and sRGB encoded, NaN as black. Formats without alpha drop it. The file appears whole
    or not at all. Raises InvalidValueError for another shape or type, InvalidFileFormatError for another extension, FileIoError where
    the file cannot be written.
    """
    target = Path(path)
    extension = target.suffix.lower()
    if extension not in _INTEGER_FORMATS | _FLOAT_FORMATS:
        known = " ".join(sorted(_INTEGER_FORMATS | _FLOAT_FORMATS))
        raise InvalidFileFormatError(f"write_image: {target.name}: the extension must be one of {known}")
    pixels = _checked(array)
    if not isinstance(exposure, int | float | np.number) or not abs(exposure) <= _MOST_STOPS:
        raise InvalidValueError(f"write_image: exposure is a number of stops, -{_MOST_STOPS} to {_MOST_STOPS}, not {exposure!r}")
    if not np.issubdtype(pixels.dtype, np.floating) and exposure != 0.0:
        raise InvalidValueError(f"write_image: exposure works on linear floats, not on an array of {pixels.dtype}")
    if extension in _INTEGER_FORMATS:
        pixels = _encoded(pixels, exposure)
        if pixels.dtype == np.uint16 and extension != ".png":
            raise InvalidValueError(f"write_image: {target.name}: 16 bits need .png")
    else:
        pixels = _linear(pixels, exposure)
    if not target.parent.is_dir():
        raise FileIoError(f"write_image: there is no folder {target.parent}")
    _store(target, _with_channels(pixels, _CHANNELS.get(extension, (1, 3, 4))))


def _checked(array: npt.ArrayLike) -> npt.NDArray[Any]:
    """The array with three axes, of a shape and type that a picture can have."""
    pixels = np.asarray(array)
    if pixels.ndim == 2:
        pixels = pixels[:, :, np.newaxis]
    if pixels.ndim != 3 or pixels.shape[2] not in (1, 3, 4) or pixels.size == 0:
        shape = np.shape(array)
        raise InvalidValueError(f"write_image: the array must be (height, width) or (height, width, 1, 3 or 4), not {shape}")
    if pixels.dtype not in (np.uint8, np.uint16) and not np.issubdtype(pixels.dtype, np.floating):
        raise InvalidValueError(f"write_image: the array must hold floats, uint8 or uint16, not {pixels.dtype}")
    return pixels


def _encoded(pixels: npt.NDArray[Any], exposure: float) -> npt.NDArray[Any]:
    """Linear floats as sRGB bytes; integers as they are."""
    if not np.issubdtype(pixels.dtype, np.floating):
        return pixels
    values = np.array(pixels, np.float32)
    color = values[:, :, :3]
    with np.errstate(over="ignore"):
        color *= np.float32(2.0**exposure)
    values = np.clip(np.nan_to_num(values, nan=0.0, posinf=1.0, neginf=0.0), 0.0, 1.0)
    color = values[:, :, :3]
    color[...] = np.where(color <= 0.0031308, 12.92 * color, 1.055 * color ** (1.0 / 2.4) - 0.055)
    return (values * 255.0 + 0.5).astype(np.uint8)


def _linear(pixels: npt.NDArray[Any], exposure: float) -> npt.NDArray[Any]:
    """Floats times the exposure; integers decoded from sRGB."""
    values = np.array(pixels, np.float32)
    color = values[:, :, :3]
    if np.issubdtype(pixels.dtype, np.floating):
        color *= np.float32(2.0**exposure)
    else:
        values /= np.iinfo(pixels.dtype).max
        color[...] = np.where(color <= 0.04045, color / 12.92, ((color + 0.055) / 1.055) ** 2.4)
    return values


def _with_channels(pixels: npt.NDArray[Any], allowed: tuple[int, ...]) -> npt.NDArray[Any]:
    """The picture without alpha, or grey as three channels, where the format wants that."""
    channels = pixels.shape[2]
    if channels == 4 and 4 not in allowed:
        pixels = pixels[:, :, :3]
    elif channels == 1 and 1 not in allowed:
        pixels = np.repeat(pixels, 3, axis=2)
    return np.ascontiguousarray(pixels)


def _store(target: Path, pixels: npt.NDArray[Any]) -> None:
    """Writes beside the target and renames."""
    library = _image_library()
    height, width, channels = pixels.shape
    draft = target.with_name(f".{target.stem}.{os.getpid()}{target.suffix}")
    specification = library.ImageSpec(width, height, channels, str(pixels.dtype) if pixels.dtype != np.float32 else "float")
    specification.attribute("oiio:UnassociatedAlpha", 1)
    specification.attribute("oiio:ColorSpace", "lin_rec709" if pixels.dtype == np.float32 else "sRGB")
    file = library.ImageOutput.create(str(draft))
    if file is None:
        raise InvalidFileFormatError(f"write_image: {target.name}: {library.geterror().strip()}")
    try:
        if not file.open(str(draft), specification) or not file.write_image(pixels) or not file.close():
            raise FileIoError(f"write_image: {target} cannot be written: {file.geterror().strip()}")
        os.replace(draft, target)
    except OSError as error:
        raise FileIoError(f"write_image: {target} cannot be written: {error}") from error
    finally:
        draft.unlink(missing_ok=True)
