"""Build the scene of a recorded probe through the public API.

Takes the probe's list of traversables (children first) and gives what a name of the file stands for: an accel or a transform. Fields
that say how the bytes lay in device memory (strides, index sizes) become the numpy type of the same width.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from oracle_files import number, numbers

import optixc as ox

INDEX_TYPES = {1: np.uint8, 2: np.uint16, 4: np.uint32}
FLOAT3, FLOAT2, HALF3, HALF2, SNORM16_3, SNORM16_2 = 0x2121, 0x2122, 0x2123, 0x2124, 0x2125, 0x2126
RAW_COMPONENTS = {FLOAT2: (np.float32, 2), FLOAT3: (np.float32, 3), HALF2: (np.float16, 2), HALF3: (np.float16, 3),
                  SNORM16_2: (np.int16, 2), SNORM16_3: (np.int16, 3)}
SRT_FLOATS, MATRIX_FLOATS = 16, 12


def build(context: ox.DeviceContext, scene: list[dict[str, Any]]) -> dict[str, Any]:
    """The traversables of the scene by name."""
    made: dict[str, Any] = {}
    for node in scene:
        made[node["name"]] = _traversable(context, node, made)
    return made


def handle_of(traversable: Any) -> int:
    """The 64-bit handle of an accel or transform."""
    return int(traversable.handle) if hasattr(traversable, "handle") else int(traversable)


def _traversable(context: ox.DeviceContext, node: dict[str, Any], made: Mapping[str, Any]) -> Any:
    match node["kind"]:
        case "GAS":
            return context.accel_build([_build_input(item, context) for item in node["buildInputs"]], build_flags=node["buildFlags"],
                                       motion_options=_motion(node))
        case "IAS":
            instances = [_instance(item, made) for item in node["instances"]]
            return context.accel_build([ox.BuildInputInstances(instances)], build_flags=node["buildFlags"],
                                       motion_options=_motion(node))
        case "static":
            return context.static_transform(made[node["child"]], _matrix(node["data"]))
        case "matrixMotion":
            keys = np.array(numbers(node["data"]), np.float32).reshape(-1, 3, 4)
            return context.matrix_motion_transform(made[node["child"]], keys, _motion(node))
        case "srtMotion":
            keys = np.array(numbers(node["data"]), np.float32).reshape(-1, SRT_FLOATS)
            return context.srt_motion_transform(made[node["child"]], keys, _motion(node))
        case kind:
            raise ValueError(f"{node['name']}: a traversable of the kind {kind!r} is not known here")


def _motion(node: dict[str, Any]) -> ox.MotionOptions | None:
    motion = node.get("motion")
    if motion is None:
        return None
    return ox.MotionOptions(motion["numKeys"], number(motion["timeBegin"]), number(motion["timeEnd"]), motion["flags"])


def _matrix(values: Any) -> np.ndarray:
    return np.array(numbers(values), np.float32).reshape(3, 4)


def _instance(item: dict[str, Any], made: Mapping[str, Any]) -> ox.Instance:
    child = made.get(item["child"], 0)
    return ox.Instance(child, _matrix(item["transform"]), instance_id=item["instanceId"], sbt_offset=item["sbtOffset"],
                       visibility_mask=item["visibilityMask"], flags=item["flags"])


def _build_input(item: dict[str, Any], context: ox.DeviceContext) -> Any:
    match item["type"]:
        case "triangles":
            return ox.BuildInputTriangles(_vertices(item), _indices(item), **_records(item), **_triangle_extras(item, context))
        case "custom":
            return ox.BuildInputCustomPrimitives(_keys(item["aabbs"], 6), **_records(item))
        case "spheres":
            radii = _keys(item["radii"], None)
            return ox.BuildInputSpheres(_keys(item["vertices"], 3), radii, **_records(item))
        case "curves":
            return _curves(item)
        case kind:
            raise ValueError(f"a build input of the type {kind!r} is not known here")


def _records(item: dict[str, Any]) -> dict[str, Any]:
    """What every input with SBT records has."""
    given: dict[str, Any] = {"flags": item["flags"], "num_sbt_records": item["numSbtRecords"]}
    if "sbtIndexOffset" in item:
        given["sbt_index_offsets"] = np.array(item["sbtIndexOffset"], INDEX_TYPES[item["sbtIndexOffsetSizeInBytes"]])
    if "primitiveIndexOffset" in item:
        given["primitive_index_offset"] = item["primitiveIndexOffset"]
    return given


def _keys(keys: list[Any], width: int | None) -> Any:
    """One array, or a list of arrays where there are motion keys."""
    arrays = [np.array(numbers(key), np.float32).reshape(-1, width) if width else np.array(numbers(key), np.float32) for key in keys]
    return arrays[0] if len(arrays) == 1 else arrays


def _vertices(item: dict[str, Any]) -> Any:
    if "rawBytes" not in item:
        return _keys(item["vertices"], 3)
    dtype, components = RAW_COMPONENTS[int(item["vertexFormat"], 16)]
    stride = item["rawStride"] or np.dtype(dtype).itemsize * components
    raw = np.array(item["rawBytes"], np.uint8)
    count = (raw.size - np.dtype(dtype).itemsize * components) // stride + 1
    rows = [raw[i * stride:i * stride + np.dtype(dtype).itemsize * components].view(dtype) for i in range(count)]
    return np.array(rows)


def _indices(item: dict[str, Any]) -> np.ndarray | None:
    if "indices" not in item:
        return None
    return np.array(item["indices"], INDEX_TYPES[item.get("indexBytes", 4)]).reshape(-1, 3)


def _triangle_extras(item: dict[str, Any], context: ox.DeviceContext) -> dict[str, Any]:
    given: dict[str, Any] = {}
    if "preTransform" in item:
        given["pre_transform"] = _matrix(item["preTransform"])
    if "omm" in item:
        given["opacity_micromap"] = _micromap(context, item["omm"], len(item["vertices"][0]) // 9)
    return given


def _micromap(context: ox.DeviceContext, omm: dict[str, Any], triangles: int) -> Any:
    maps = [ox.OpacityMicromap(np.array(one["states"], np.uint8), one["level"], ox.OpacityMicromapFormat(one["format"]))
            for one in omm["maps"]]
    # an index list that was not recorded is the identity
    indices = omm["index"] or list(range(triangles))
    dtype = np.int16 if omm["indexSize"] == 2 else np.int32
    return ox.BuildInputOpacityMicromap(context.opacity_micromap_array_build(maps), np.array(indices, dtype), omm["indexOffset"])


def _curves(item: dict[str, Any]) -> Any:
    given = {key: value for key, value in _records(item).items() if key in ("flags", "primitive_index_offset")}
    if "normals" in item:
        given["normals"] = _keys(item["normals"], 3)
    return ox.BuildInputCurves(ox.PrimitiveType(int(item["curveType"], 16)), _keys(item["vertices"], 3), _keys(item["radii"], None),
                               np.array(item["indices"], np.uint32), endcap_flags=item["endcapFlags"], **given)
