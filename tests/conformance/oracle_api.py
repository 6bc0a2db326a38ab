"""The recorded misuses of the host API: the same misuse of ours gives the same result code, wherever ours can express it.

Which misuse it was stands in the record's name only: single ones are in `MISUSES`, those of a family are made from the words and numbers
of the name. Null pointers, misaligned buffers, strides and wrong structure sizes cannot be written in Python; the words of the name and of
OptiX's message tell them. What OptiX does not notice (result 0) must not be refused here either. A misuse of any other name is told as not
understood, and fails.
"""

from __future__ import annotations

import re
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
# By the result there and a word of the name: refused there, accepted here.
MILDER = {"stack_continuation": "stacks of host threads are larger than 64 KiB"}
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


def _micromap(level: int) -> Misuse:
    return lambda harness: harness.context.opacity_micromap_array_build([ox.OpacityMicromap(np.zeros(4**level, np.uint8), level)])


def check_stack_helpers(harness: Harness, probe: Probe) -> None:
    """The recorded tables of the stack-size functions."""
    names = ("css_rg", "css_ms", "css_ch", "css_ah", "css_is", "css_cc", "dss_dc")
    data = {key.split("{")[0].split("[")[0]: value for key, value in probe.data.items()}
    sizes = ox.StackSizes(**dict(zip(names, data["sizes"], strict=True)))
    for row in data["out"]:
        assert list(_stack_sizes(sizes, row)) == row["out"], row


def _stack_sizes(sizes: ox.StackSizes, row: dict[str, Any]) -> tuple[int, int, int]:
    """The function of a row: its name, with arguments in it where they are not columns."""
    name, *words = row["fn"].split()
    given = {key: int(value) for key, value in (word.split("=") for word in words)}
    depth = row["traceDepth"]
    match name:
        case "ComputeStackSizes":
            return ox.util_compute_stack_sizes(sizes, depth, row["cc"], row["dc"])
        case "DCSplit":
            return ox.util_compute_stack_sizes_dc_split(sizes, given["dssTrav"], given["dssState"], depth, given["cc"], given["dcTrav"],
                                                        given["dcState"])
        case "CssCCTree":
            return ox.util_compute_stack_sizes_css_cc_tree(sizes, given["cssCCTree"], depth, given["dc"])
        case _:
            raise AssertionError(f"the stack-size function {name!r} is not known here")


def check_properties(harness: Harness, probe: Probe) -> None:
    """The recorded limits; what a device can do (core version, reordering, vectors, clusters) is its own."""
    own = (0x2005, 0x200a, 0x200b, 0x2020)
    for row in probe.data["values"]:
        number = int(row["prop"], 16)
        assert number in own or harness.context.get_property(number) == row["value"], row


RAYGEN = ("raygen", "__raygen__index")
RIBBON, LINEAR, CUBIC, QUADRATIC_ROCAPS = 0x2505, 0x2503, 0x2502, 0x2508
CURVE_TYPES = {"linear": LINEAR, "ribbon": RIBBON, "quadratic": 0x2501, "cubic": CUBIC, "catmullrom": 0x2504, "bezier": 0x2507,
               "rocaps": QUADRATIC_ROCAPS}
MISUSES: dict[str, Misuse] = {
    "zero_build_inputs": _build(),
    "mixed_tri_custom": _build(_triangles(), lambda: ox.BuildInputCustomPrimitives(BOX)),
    "mixed_sphere_curves": _build(_spheres, _curves(LINEAR)),
    "mixed_curve_types": _build(_curves(LINEAR), _curves(CUBIC)),
    "two_instance_inputs": lambda harness: harness.context.accel_build([_instances(harness), _instances(harness)]),
    "sbtIndexOffset_missing_with_2_records": _build(_triangles(num_sbt_records=2)),
    "sbtIndexOffset_with_1_record": _build(_triangles(sbt_index_offsets=np.zeros(1, np.uint32))),
    "primitiveIndexOffset_2e30": _build(_triangles(primitive_index_offset=1 << 30)),
    "primitiveIndexOffset_overflow": _build(_triangles(primitive_index_offset=0xFFFFFFFF)),
    "numSbtRecords_2e24+1": _build(_triangles(num_sbt_records=(1 << 24) + 1)),
    "buildflags_trace_and_build": _build(_triangles(), flags=12),
    "buildflags_unknown_bit": _build(_triangles(), flags=1 << 30),
    "update_without_allow": _update_without_allow,
    "curve_type_bad": _build(_curves(0x2531)),
    "sphere_ok": _build(_spheres),
    "pg_rg_missing_entry": _group("raygen", "__raygen__nope"),
    "pg_ms_missing_entry": _group("miss", "__miss__nope"),
    "pg_rg_null": _group("raygen", None),
    "pg_hg_all_null": _group("closesthit", None),
    "pipeline_zero_groups": _pipeline(),
    "pipeline_without_raygen": _pipeline(("miss", "__miss__nothing")),
    "launch_ok": _launch(),
    "launch_raygen_null": _launch(raygen=None),
    "launch_2e30_plus": _launch(width=(1 << 30) + 1),
    "launch_without_setstack": _launch(),
    "get_property_unknown": lambda harness: harness.context.get_property(0x7FFF),
    "bound_values_ok": _module(bound_values={"value": 7}),
    "bound_values_no_annotation": _module(bound_values={"value": ox.BoundValue(7)}),
    "bound_values_beyond_params": _module(bound_values={"beyond": 7}),
    "pg_hg_ch_with_ah_name": _group("closesthit", "__miss__nothing"),
}
# Names that end in a word or number, and the misuse made from it.
FAMILIES: tuple[tuple[str, Callable[[str], Misuse]], ...] = (
    (r"launch_(width|height|depth)_0", lambda side: _launch(**{side: 0})),
    (r"pipeline_maxTraceDepth_(\d+)", lambda depth: _pipeline(RAYGEN, max_trace_depth=int(depth))),
    (r"attributes_(\d+)", lambda count: _options(num_attribute_values=int(count))),
    (r"payload_(\d+)", lambda count: _options(num_payload_values=int(count))),
    (r"graph_flags_(\d+)", lambda flags: _options(traversable_graph_flags=int(flags))),
    (r"exception_flags_(\d+)", lambda flags: _options(exception_flags=int(flags))),
    (r"usesMotionBlur_(\d+)", lambda value: _options(uses_motion_blur=int(value))),
    (r"geometry_flag_invalid_(\d+)", lambda flags: _build(_triangles(flags=int(flags)))),
    (r"motion_numKeys_([01])", lambda count: _build(_triangles(), motion=ox.MotionOptions(int(count), 0.0, 1.0))),
    (r"curve_endcap_on_([a-z]+)", lambda kind: _build(_curves(CURVE_TYPES[kind], endcap_flags=1))),
    (r"omm_level_(\d+)", lambda level: _micromap(int(level))),
    (r"stack_graphDepth_(\d+)", lambda depth: _stack(1000, int(depth))),
    (r"stack_continuation_(\d+)", lambda size: _stack(int(size))),
    (r"stack_direct_(\d+)", lambda size: _stack(1000, direct=int(size))),
    (r"stack_single_level_pipeline_graphDepth(\d+)", lambda depth: _stack(1000, int(depth), traversable_graph_flags=2)),
)
# What a name or OptiX's message speaks of where the misuse has no form here.
NOT_EXPRESSIBLE = (
    (r"SEGFAULT", "the driver crashes"),
    (r"denoiser|DENOISER", "there is no denoiser"),
    (r"misalign|aligned|ALIGNMENT", "arrays of numpy are aligned, or are copied"),
    (r"_null|null_|\bnull\b|_ptr|pointer|_no_index|_no_width|_without_name|name_without|is 0$", "there are no pointers to leave out"),
    (r"[sS]tride|_size|SizeInBytes|smaller than|temp_|output_|emit_", "sizes and strides are those of the arrays"),
    (r"numVertices|index_buffer|indexFormat", "counts are those of the arrays"),
    (r"builtinIS|operation_|_kind_|debug_level|maxreg|params_|payload_types|no_types", "there is no such parameter"),
    (r"miss_base|hit_base|launch_hit", "sections of the SBT are lists"),
    (r"omm_no_allow_build", "a micromap array cannot be left out"),
)


def check_misuse(harness: Harness, probe: Probe) -> None:
    """Our call gives the recorded result code."""
    if harness.mode != "scalar":
        pytest.skip("host calls do not depend on the mode")
    misuse = misuse_of(probe.name)
    if misuse is None:
        reason = not_expressible(probe)
        assert reason is not None, f"not understood: which misuse {probe.name!r} is"
        pytest.skip(f"not expressible here: {reason}")
    result = probe.data["rcName"]
    if result != SUCCESS and (mild := next((reason for word, reason in MILDER.items() if probe.name.startswith(word)), None)):
        misuse(harness)
        pytest.skip(f"accepted here: {mild}")
    if result == SUCCESS:
        misuse(harness)
        return
    assert result in CODES, f"not understood: the result {result}"
    with pytest.raises(ox.OptixError) as caught:
        misuse(harness)
    assert caught.value.code == CODES[result]
    assert len(str(caught.value)) > 10


def misuse_of(name: str) -> Misuse | None:
    """The misuse of a name, None where the name is not known."""
    if name in MISUSES:
        return MISUSES[name]
    for pattern, make in FAMILIES:
        if found := re.fullmatch(pattern, name):
            return make(found.group(1))
    return None


def not_expressible(probe: Probe) -> str | None:
    """Why a misuse has no form here, None where the words do not tell."""
    words = f"{probe.name} {probe.data['rcName']} {str(probe.data.get('log', '')).splitlines()[0] if probe.data.get('log') else ''}"
    return next((reason for pattern, reason in NOT_EXPRESSIBLE if re.search(pattern, words)), None)
