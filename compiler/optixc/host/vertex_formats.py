"""OptiX's vertex formats: arrays of halves, normalised shorts and two components become float32 (n, 3)."""

from __future__ import annotations

from typing import Any

import numpy as np

from optixc.enums_scene import VertexFormat
from optixc.errors import InvalidValueError
from optixc.host.whole_numbers import take_member

_FORMATS = {
    (np.dtype(np.float32), 3): VertexFormat.FLOAT3,
    (np.dtype(np.float32), 2): VertexFormat.FLOAT2,
    (np.dtype(np.float16), 3): VertexFormat.HALF3,
    (np.dtype(np.float16), 2): VertexFormat.HALF2,
    (np.dtype(np.int16), 3): VertexFormat.SNORM16_3,
    (np.dtype(np.int16), 2): VertexFormat.SNORM16_2,
}
_SNORM_SCALE = np.float32(32767)


def to_float3(vertices: Any, vertex_format: Any, where: str) -> Any:
    """The vertices with every array (one, or one per motion key) of another format than FLOAT3 converted; others are left to the check."""
    if isinstance(vertices, list | tuple) or (isinstance(vertices, np.ndarray) and vertices.ndim == 3):
        return [_convert(key, vertex_format, where) for key in vertices]
    return _convert(vertices, vertex_format, where)


def _convert(array: Any, vertex_format: Any, where: str) -> Any:
    found = _FORMATS.get((array.dtype, array.shape[1])) if isinstance(array, np.ndarray) and array.ndim == 2 else None
    if vertex_format is not None and found != take_member(vertex_format, VertexFormat, f"{where}: vertex_format"):
        told = found.name if found is not None else f"{getattr(array, 'dtype', type(array).__name__)} of shape {np.shape(array)}"
        raise InvalidValueError(f"{where}: vertex_format is {VertexFormat(vertex_format).name}, but the array is {told}")
    if found is None or found is VertexFormat.FLOAT3:
        return array
    points = np.zeros((len(array), 3), np.float32)
    values = array.astype(np.float32)
    if array.dtype == np.int16:
        values = np.maximum(values / _SNORM_SCALE, np.float32(-1))
    points[:, : array.shape[1]] = values
    return points
