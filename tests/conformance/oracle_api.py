"""The recorded misuses of the host API: the same misuse of ours gives the same result code, wherever ours can express it.

Null pointers, misaligned buffers, strides and wrong structure sizes cannot be written in Python and are skipped by name. What OptiX does
not notice (result 0) must not be refused here either, unless `STRICTER` says why.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from harness import SHADERS, Harness
from oracle_files import Probe
from shaders import launch as shader

import optixc as ox

SUCCESS = "OPTIX_SUCCESS"
CODES = {"OPTIX_ERROR_INVALID_VALUE": ox.Result.ERROR_INVALID_VALUE, "OPTIX_ERROR_LAUNCH_FAILURE": ox.Result.ERROR_LAUNCH_FAILURE,
         "OPTIX_ERROR_INVALID_PAYLOAD_ACCESS": ox.Result.ERROR_INVALID_PAYLOAD_ACCESS}
STRICTER: dict[str, str] = {}
LARGE_STACKS = "stacks of host threads are larger than 64 KiB"
MILDER = {f"stack_continuation_{size}": LARGE_STACKS for size in (65535, 65536, 65537, 1048576)}
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
BOX = np.array([[0, 0, 0, 1, 1, 1]], np.float32)
Misuse = Callable[[Harness], Any]


def _build(*inputs: Any, flags: int = 0, motion: Any = None) -> Misuse:
    return lambda harness: harness.context.accel_build([one() for one in inputs], build_flags=flags, motion_options=motion)


def _triangles(**more: Any) -> Callable[[], Any]:
    return lambda: ox.BuildInputTriangles(CORNERS, **more)


def _spheres() -> Any:
    return ox.BuildInputSpheres(np.zeros((1, 3), np.float32), np.ones(1, np.float32))


def _curves(kind: int, **more: Any) -> Callable[[], Any]:
    points = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]], np.float32)
    return lambda: ox.BuildInputCurves(ox.PrimitiveType(kind), points, np.full(4, 0.1, np.float32), np.array([0], np.uint32), **more)


def _instances(harness: Harness) -> Any:
    accel = harness.context.accel_build([ox.BuildInputTriangles(CORNERS)])
    return ox.BuildInputInstances([ox.Instance(accel, np.eye(3, 4, dtype=np.float32))])


def _update_without_allow(harness: Harness) -> None:
    harness.context.accel_build([ox.BuildInputTriangles(CORNERS)]).update([ox.BuildInputTriangles(CORNERS)])


def _group(kind: str, name: str | None) -> Misuse:
    def misuse(harness: Harness) -> Any:
        module = harness.module("launch.py")
        return harness.context.program_group_create(**{kind: None if name is None else module[name]})
    return misuse


def _pipeline(*names: tuple[str, str], **options: Any) -> Misuse:
    def misuse(harness: Harness) -> Any:
        module, create = harness.module("launch.py"), harness.context.program_group_create
        return harness.context.pipeline_create([create(**{kind: module[name]}) for kind, name in names], **options)
    return misuse


def _options(**given: Any) -> Misuse:
    return lambda harness: _pipeline(RAYGEN, options=ox.PipelineCompileOptions(**given))(harness)


def _launch(width: int = 1, height: int = 1, depth: int = 1, **sections: Any) -> Misuse:
    def misuse(harness: Harness) -> None:
        module, create = harness.module("launch.py"), harness.context.program_group_create
        raygen, miss = create(raygen=module["__raygen__index"]), create(miss=module["__miss__nothing"])
        pipeline = harness.pipeline("misuse", [raygen, miss])
        one = np.zeros(4, np.uint32)
        given = {"raygen": raygen.record(shader.Data(0, 0.0, (0, 0, 0))), "miss": [miss.record()], "hitgroup": []} | sections
        pipeline.launch(shader.Params(indices=one, dimensions=one, scene=0, value=0), ox.ShaderBindingTable(**given), width=width,
                        height=height, depth=depth)
    return misuse


def _module(**more: Any) -> Misuse:
    return lambda harness: harness.context.module_create(SHADERS / "launch.py", **more)


def _stack(continuation: int, depth: int = 2, direct: int = 0, **options: Any) -> Misuse:
    def misuse(harness: Harness) -> None:
        _pipeline(RAYGEN, options=ox.PipelineCompileOptions(**options))(harness).set_stack_size(direct, direct, continuation, depth)
    return misuse


def check_stack_helpers(harness: Harness, probe: Probe) -> None:
    """The recorded tables of the stack-size functions."""
    names = ("css_rg", "css_ms", "css_ch", "css_ah", "css_is", "css_cc", "dss_dc")
    data = {key.split("{")[0].split("[")[0]: value for key, value in probe.data.items()}
    sizes = ox.StackSizes(**dict(zip(names, data["sizes"], strict=True)))
    for row in data["out"]:
        if row["fn"] == "ComputeStackSizes":
            assert list(ox.util_compute_stack_sizes(sizes, row["traceDepth"], row["cc"], row["dc"])) == row["out"], row


def check_properties(harness: Harness, probe: Probe) -> None:
    """The recorded limits; what a device can do (core version, reordering, vectors, clusters) is its own."""
    own = (0x2005, 0x200a, 0x200b, 0x2020)
    for row in probe.data["values"]:
        number = int(row["prop"], 16)
        assert number in own or harness.context.get_property(number) == row["value"], row


RAYGEN = ("raygen", "__raygen__index")
RIBBON, LINEAR, CUBIC, QUADRATIC_ROCAPS = 0x2505, 0x2503, 0x2502, 0x2508
MISUSES: dict[str, Misuse] = {
    "zero_build_inputs": _build(),
    "mixed_tri_custom": _build(_triangles(), lambda: ox.BuildInputCustomPrimitives(BOX)),
    "mixed_sphere_curves": _build(_spheres, _curves(LINEAR)),
    "mixed_curve_types": _build(_curves(LINEAR), _curves(CUBIC)),
    "two_instance_inputs": lambda harness: harness.context.accel_build([_instances(harness), _instances(harness)]),
    "geometry_flag_invalid_64": _build(_triangles(flags=64)),
    "sbtIndexOffset_missing_with_2_records": _build(_triangles(num_sbt_records=2)),
    "sbtIndexOffset_with_1_record": _build(_triangles(sbt_index_offsets=np.zeros(1, np.uint32))),
    "primitiveIndexOffset_2e30": _build(_triangles(primitive_index_offset=1 << 30)),
    "primitiveIndexOffset_overflow": _build(_triangles(primitive_index_offset=0xFFFFFFFF)),
    "numSbtRecords_2e24+1": _build(_triangles(num_sbt_records=(1 << 24) + 1)),
    "motion_numKeys_1": _build(_triangles(), motion=ox.MotionOptions(1, 0.0, 1.0)),
    "buildflags_trace_and_build": _build(_triangles(), flags=12),
    "buildflags_unknown_bit": _build(_triangles(), flags=1 << 30),
    "update_without_allow": _update_without_allow,
    "curve_type_bad": _build(_curves(0x2531)),
    "curve_endcap_on_rocaps": _build(_curves(QUADRATIC_ROCAPS, endcap_flags=1)),
    "curve_endcap_on_ribbon": _build(_curves(RIBBON, endcap_flags=1)),
    "sphere_ok": _build(_spheres),
    "attributes_9": _options(num_attribute_values=9),
    "attributes_0": _options(num_attribute_values=0),
    "attributes_1": _options(num_attribute_values=1),
    "payload_33": _options(num_payload_values=33),
    "graph_flags_3": _options(traversable_graph_flags=3),
    "exception_flags_128": _options(exception_flags=128),
    "pg_rg_missing_entry": _group("raygen", "__raygen__nope"),
    "pg_ms_missing_entry": _group("miss", "__miss__nope"),
    "pg_rg_null": _group("raygen", None),
    "pg_hg_all_null": _group("closesthit", None),
    "pipeline_maxTraceDepth_0": _pipeline(RAYGEN, max_trace_depth=0),
    "pipeline_maxTraceDepth_1": _pipeline(RAYGEN, max_trace_depth=1),
    "pipeline_maxTraceDepth_31": _pipeline(RAYGEN, max_trace_depth=31),
    "pipeline_maxTraceDepth_32": _pipeline(RAYGEN, max_trace_depth=32),
    "pipeline_zero_groups": _pipeline(),
    "pipeline_without_raygen": _pipeline(("miss", "__miss__nothing")),
    "launch_ok": _launch(),
    "launch_raygen_null": _launch(raygen=None),
    "launch_width_0": _launch(width=0),
    "launch_height_0": _launch(height=0),
    "launch_depth_0": _launch(depth=0),
    "launch_2e30_plus": _launch(width=(1 << 30) + 1),
    "launch_without_setstack": _launch(),
    "get_property_unknown": lambda harness: harness.context.get_property(0x7FFF),
    "usesMotionBlur_2": _options(uses_motion_blur=2),
    "bound_values_ok": _module(bound_values={"value": 7}),
    "bound_values_no_annotation": _module(bound_values={"value": ox.BoundValue(7)}),
    "bound_values_beyond_params": _module(bound_values={"beyond": 7}),
    "pg_hg_ch_with_ah_name": _group("closesthit", "__miss__nothing"),
    "stack_graphDepth_0": _stack(1000, 0),
    "stack_graphDepth_255": _stack(1000, 255),
    "stack_continuation_0": _stack(0),
    "stack_continuation_65535": _stack(65535),
    "stack_continuation_65536": _stack(65536),
    "stack_continuation_65537": _stack(65537),
    "stack_continuation_1048576": _stack(1048576),
    "stack_direct_65537": _stack(1000, direct=65537),
    "stack_single_level_pipeline_graphDepth3": _stack(1000, 3, traversable_graph_flags=2),
}
NEEDED = {"mixed_sphere_curves": ("spheres", "curves"), "mixed_curve_types": ("curves",), "curve_type_bad": ("curves",),
          "curve_endcap_on_rocaps": ("rocaps curves",), "curve_endcap_on_ribbon": ("ribbons",), "sphere_ok": ("spheres",)}


def has_check(probe: Probe) -> bool:
    """Whether the misuse can be expressed here."""
    return probe.name in MISUSES and (probe.data.get("rcName") in CODES or probe.data.get("rcName") == SUCCESS)


def check_misuse(harness: Harness, probe: Probe) -> None:
    """Our call gives the recorded result code."""
    if harness.mode != "scalar":
        pytest.skip("host calls do not depend on the mode")
    if reason := STRICTER.get(probe.name):
        pytest.skip(f"refused here: {reason}")
    if reason := MILDER.get(probe.name):
        MISUSES[probe.name](harness)
        pytest.skip(f"accepted here: {reason}")
    if probe.data["rcName"] == SUCCESS:
        MISUSES[probe.name](harness)
        return
    with pytest.raises(ox.OptixError) as caught:
        MISUSES[probe.name](harness)
    assert caught.value.code == CODES[probe.data["rcName"]]
    assert len(str(caught.value)) > 10
