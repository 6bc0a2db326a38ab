"""Writes docs/coming_from_optix.md: every OptiX host and device function and struct with its name here, its status and what differs.

Device functions come from the compiler's one table, host functions from the table below, structs from optix_structs; a test looks their
names up.
Run `python docs/make_coming_from_optix.py` after a change of either.
"""

from __future__ import annotations

import re
from pathlib import Path

import optix_structs

from optixc.ir.intrinsic_rows import INTRINSICS, ROWS
from optixc.ir.intrinsics import Intrinsic
from optixc.ir.programs import ALL_PROGRAMS, ProgramKind

PAGE = Path(__file__).with_name("coming_from_optix.md")
THERE, ABSENT, NEEDLESS = "yes", "no", "not needed"

HOST: tuple[tuple[str, str, str, str], ...] = (
    ("optixInit, optixInitWithHandle, optixUninitWithHandle, optixQueryFunctionTable", "", NEEDLESS, "the package loads its library"),
    ("optixGetErrorName", "get_error_name", THERE, "exceptions carry `code`, an `ox.Result`, and a sentence with the remedy"),
    ("optixGetErrorString", "get_error_string", THERE, ""),
    ("optixDeviceContextCreate", "DeviceContext", THERE, "validation, log callback, cache folder and threads are arguments"),
    ("optixDeviceContextDestroy", "DeviceContext.destroy", THERE, "later use of anything made from it is a named error"),
    ("optixDeviceContextGetProperty", "DeviceContext.get_property", THERE, "gives the number"),
    ("optixDeviceContextSetLogCallback", "DeviceContext.set_log_callback", THERE, "callback(level, tag, message); both swapped at once"),
    ("optixDeviceContextSetCacheEnabled", "DeviceContext.set_cache_enabled", THERE, "OPTIXC_CACHE_MAXSIZE=0 wins"),
    ("optixDeviceContextGetCacheEnabled", "DeviceContext.get_cache_enabled", THERE, ""),
    ("optixDeviceContextSetCacheLocation", "DeviceContext.set_cache_location", THERE, "default: OPTIXC_CACHE_DIR, then the user's"),
    ("optixDeviceContextGetCacheLocation", "DeviceContext.get_cache_location", THERE, ""),
    ("optixDeviceContextSetCacheDatabaseSizes", "DeviceContext.set_cache_database_sizes", THERE, ""),
    ("optixDeviceContextGetCacheDatabaseSizes", "DeviceContext.get_cache_database_sizes", THERE, "default 512 MiB and 1 GiB"),
    ("optixModuleCreate", "DeviceContext.module_create", THERE, "a Python file, module or list of functions; C++ is made per pipeline"),
    ("optixModuleCreateWithTasks", "DeviceContext.module_create_with_tasks", THERE, "one task a module"),
    ("optixTaskExecute", "Task.execute", THERE, "splits off nothing"),
    ("optixModuleGetCompilationState", "Module.get_compilation_state", THERE, ""),
    ("optixModuleDestroy", "Module.destroy", THERE, "optional; groups and pipelines go on"),
    ("optixBuiltinISModuleGet", "", NEEDLESS, "built-in primitives bring their intersection programs"),
    ("optixProgramGroupCreate", "DeviceContext.program_group_create", THERE, "one group a call; its programs take one payload class"),
    ("optixProgramGroupDestroy", "", NEEDLESS, "groups are garbage collected"),
    ("optixProgramGroupGetStackSize", "ProgramGroup.get_stack_size", THERE, "bytes of real frames; an estimate before a pipeline exists"),
    ("optixPipelineCreate", "DeviceContext.pipeline_create", THERE, "compiles; `bound_values`, `simd`, `math`, `debug` are arguments"),
    ("optixPipelineDestroy", "Pipeline.destroy", THERE, "optional"),
    ("optixPipelineSetStackSize", "Pipeline.set_stack_size", THERE, "never needed; with STACK_OVERFLOW it limits nesting"),
    ("optixUtilAccumulateStackSizes", "util_accumulate_stack_sizes", THERE, ""),
    ("optixUtilComputeStackSizes", "util_compute_stack_sizes", THERE, "gives the three numbers"),
    ("optixUtilComputeStackSizesDCSplit", "util_compute_stack_sizes_dc_split", THERE, ""),
    ("optixUtilComputeStackSizesCssCCTree", "util_compute_stack_sizes_css_cc_tree", THERE, ""),
    ("optixUtilComputeStackSizesSimplePathTracer", "util_compute_stack_sizes_simple_path_tracer", THERE, ""),
    ("optixSbtRecordPackHeader", "ProgramGroup.record", THERE, "`group.record(data)`; the table packs headers"),
    ("OptixShaderBindingTable", "ShaderBindingTable", THERE, "`explain()`, `check(pipeline, scene)`, `from_materials()` besides"),
    ("optixLaunch", "Pipeline.launch", THERE, "synchronous; parameters are a struct instance"),
    ("optixAccelComputeMemoryUsage", "Accel.memory_usage", THERE, "memory is the library's; `aabb` too"),
    ("optixAccelEmitProperty", "Accel.emit_property", THERE, "compacted size, boxes of each motion key"),
    ("optixAccelBuild", "DeviceContext.accel_build", THERE, "inputs are numpy arrays"),
    ("optixAccelBuild with OPERATION_UPDATE", "Accel.update", THERE, "the handle stays"),
    ("optixAccelCompact", "Accel.compact", THERE, "another accel; Embree's structures are compact as built"),
    ("optixAccelGetRelocationInfo, optixCheckRelocationCompatibility, optixAccelRelocate", "Accel.relocate", THERE, "gives another accel"),
    ("optixConvertPointerToTraversableHandle", "DeviceContext.static_transform", THERE, "and matrix_motion_, srt_motion_transform"),
    ("optixClusterAccelComputeMemoryUsage, optixClusterAccelBuild", "", ABSENT, "no clusters on a CPU"),
    ("optixOpacityMicromapArrayBuild", "DeviceContext.opacity_micromap_array_build", THERE, "a list of `OpacityMicromap`, or raw bytes"),
    ("optixOpacityMicromapArrayComputeMemoryUsage", "", NEEDLESS, "memory is the library's"),
    ("optixOpacityMicromapArrayGetRelocationInfo, optixOpacityMicromapArrayRelocate", "", NEEDLESS, "arrays stay where they are"),
    ("optixMicromapIndexToBaseBarycentrics", "micromap_index_to_base_barycentrics", THERE, "gives the three corners"),
    ("optixBaseBarycentricsToMicroBarycentrics", "base_barycentrics_to_micro_barycentrics", THERE, ""),
    ("optixDisplacementMicromapArrayBuild, optixDisplacementMicromapArrayComputeMemoryUsage", "", ABSENT, "dropped by OptiX 9"),
    ("optixCoopVecMatrixConvert", "DeviceContext.coop_vec_matrix_convert", THERE, "buffers are numpy arrays; returns the output"),
    ("optixCoopVecMatrixComputeSize", "DeviceContext.coop_vec_matrix_compute_size", THERE, "optimal layouts hold floats as float32"),
    ("OptixCoopVecMatrixDescription", "CoopVecMatrixDescription", THERE, "a size of 0 is the one that the rest gives"),
    ("OptixNetworkDescription", "NetworkDescription", THERE, "or a plain list of matrices"),
    (
        "optixDenoiserCreate, optixDenoiserCreateWithUserModel, optixDenoiserDestroy, optixDenoiserComputeMemoryResources, "
        "optixDenoiserSetup, optixDenoiserInvoke, optixDenoiserComputeIntensity, optixDenoiserComputeAverageColor, "
        "optixUtilDenoiserSplitImage, optixUtilDenoiserInvokeTiled, optixUtilGetPixelStride",
        "",
        ABSENT,
        "rays are traced here, images are not filtered: give the image, albedo and normals (numpy arrays) to a denoiser library",
    ),
)

# Device functions of OptiX 9 that have no row in the table.
ABSENT_DEVICE: tuple[tuple[str, str], ...] = (
    (
        "optixGetMicroTriangleVertexData, optixGetMicroTriangleBarycentricsData, optixIsDisplacedMicromeshTriangleHit, "
        "optixIsDisplacedMicromeshTriangleFrontFaceHit, optixIsDisplacedMicromeshTriangleBackFaceHit",
        "dropped by OptiX 9",
    ),
    ("optixGetExceptionLineInfo", "failed launches tell path and line"),
    ("optixTexFootprint2D, optixTexFootprint2DLod, optixTexFootprint2DGrad", ""),
)

_LETTERS = {
    ProgramKind.RAYGEN: "RG",
    ProgramKind.INTERSECTION: "IS",
    ProgramKind.ANYHIT: "AH",
    ProgramKind.CLOSESTHIT: "CH",
    ProgramKind.MISS: "MS",
    ProgramKind.EXCEPTION: "EX",
    ProgramKind.DIRECT_CALLABLE: "DC",
    ProgramKind.CONTINUATION_CALLABLE: "CC",
}
_RENAMED = {
    "optixGetSbtDataPointer": "takes the struct class; a program's struct parameter is the same data",
    "optixHitObjectGetSbtDataPointer": "takes the struct class",
    "optixTrace": "keywords with defaults; payload is a struct, or a tuple that comes back",
    "optixCoopVecLoad": "the type comes first; an array and an offset for the pointer",
    "optixCoopVecCvt": "the type comes first; float16 and float32 to each other too",
    "optixCoopVecMatMul": "template arguments are keywords with defaults, n and k those of the types; float32 matrices too",
    "optixCoopVecOuterProductAccumulate": "sums are kept as float32; float32 vectors too",
    "optixCoopVecGetMatrixSize": "template arguments are arguments, and constants",
    "optixTraverse": "as trace()",
    "optixInvoke": "payload as for trace()",
    "optixDirectCall": "arguments and `result=`; checked against the pipeline's callables",
    "optixContinuationCall": "arguments and `result=`; checked against the pipeline's callables",
    "optixReorder": "accepted; no effect",
    "optixThrowException": "code and up to eight details in one function",
}
_NUMBERED = re.compile(r"_\d+$")
INTRODUCTION = """# Coming from OptiX

Every host function, device function and struct of OptiX, its name here, whether it is there, and what differs. The rule for names: drop
`optix`, write the rest in snake case; enums keep OptiX's values (`OptixRayFlags` is `ox.RayFlags`). Kinds of programs: RG raygen,
IS intersection, AH any-hit, CH closest-hit, MS miss, EX exception, DC direct callable, CC continuation callable.

What surprises most:

- Shaders are Python functions that are parsed, not run. A program's kind is its prefix, its parameters are recognised by type.
- A callable's last `@ox.struct` parameter is the data of its SBT record, unless the calls of the pipeline pass it as an argument.
- Stack sizes never have to be set. Callables that call each other without end are a stack overflow, not a crash.
- A launch returns when it is done. A fault names program line and launch index; other launches go on.
- Numbers of payload and attribute words follow from the classes; `PipelineCompileOptions` may limit them (errors 7202 and 7203).
- Arrays are the caller's numpy memory. A read-only array where the pipeline writes is refused before the launch.
- In validation mode a launch that does what OptiX leaves undefined raises 7053; the exception has `program`, `line`, `launch_index` and
  OptiX's `fault_code`.
- `pipeline.report()` says what was compiled in and which line asked for it; `sbt.check(pipeline, scene)` finds wrong tables early.

This page is made by `python docs/make_coming_from_optix.py`.
"""


def page() -> str:
    """The text of the page."""
    lines = [INTRODUCTION, "## Host functions", "", "| OptiX | here | there | difference |", "|---|---|---|---|"]
    lines += [f"| {optix} | {f'`{name}`' if name else ''} | {status} | {difference} |" for optix, name, status, difference in HOST]
    lines += optix_structs.section()
    lines += ["", "## Device functions", "", "| OptiX | here | in | there | remark |", "|---|---|---|---|---|"]
    seen: set[str] = set()
    for row in ROWS:
        family = _NUMBERED.sub("", row.optix)
        if row.optix and family not in seen:
            seen.add(family)
            lines.append(_device_line(row))
    lines += [f"| {optix} | | | {ABSENT} | {remark} |" for optix, remark in ABSENT_DEVICE]
    return "\n".join(lines) + "\n"


def _device_line(row: Intrinsic) -> str:
    allowed = "all" if row.allowed == ALL_PROGRAMS else " ".join(text for kind, text in _LETTERS.items() if kind in row.allowed)
    name = row.overload_of or row.name
    assert name in INTRINSICS
    if _NUMBERED.search(row.optix):
        last_number = sum(_NUMBERED.sub("", other.optix) == _NUMBERED.sub("", row.optix) for other in ROWS) - 1
        return f"| {row.optix} to _{last_number} | `{name}` to `_{last_number}` | {allowed} | {THERE} | one function a word |"
    return f"| {row.optix} | `{name}` | {allowed} | {THERE} | {_RENAMED.get(row.optix, row.doc)} |"


if __name__ == "__main__":
    PAGE.write_text(page())
