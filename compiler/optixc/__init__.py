"""optixc: OptiX's programming model on CPUs. Shader programs in restricted Python, compiled to C++ on Embree.

Shaders use the decorators, types and device functions; the host uses `DeviceContext` and what it makes. See the README for a first
shader.
"""

from __future__ import annotations

from math import e, inf, nan, pi, tau
from typing import TYPE_CHECKING, Any

from optixc import enums, errors
from optixc.api import DeviceContext
from optixc.api_programs import DEVICE_FUNCTIONS, device, device_function, launch_params, program
from optixc.diagnostics import CompileError
from optixc.enums import *  # noqa: F403
from optixc.errors import *  # noqa: F403
from optixc.host.accel import Accel
from optixc.host.annotations import Array, Array2, Array3, CoopVec, FixedArray, Texture, Traversable, TraverseData
from optixc.host.bound_values import BoundValue
from optixc.host.context import OptixcWarning
from optixc.host.coop_vec import CoopVecMatrixDescription, NetworkDescription
from optixc.host.groups import Module, Program, ProgramGroup, Record
from optixc.host.image import read_image, write_image
from optixc.host.input_curves import BuildInputCurves, BuildInputSpheres
from optixc.host.inputs import BuildInputCustomPrimitives, BuildInputInstances, BuildInputTriangles, Instance, MotionOptions
from optixc.host.matrices import float3x3, float3x4, float4x4
from optixc.host.micromap_curve import (
    barycentrics_to_micromap_index,
    base_barycentrics_to_micro_barycentrics,
    micromap_index_to_base_barycentrics,
)
from optixc.host.opacity import BuildInputOpacityMicromap, OpacityMicromap, OpacityMicromapArray
from optixc.host.opacity_bake import BakedOpacity, bake_opacity_micromap
from optixc.host.pipeline import Pipeline, PipelineReport
from optixc.host.sbt import ShaderBindingTable
from optixc.host.scalars import float16, float32, float64, int8, int16, int32, int64, uint8, uint16, uint32, uint64
from optixc.host.stack_sizes import (
    StackSizes,
    util_accumulate_stack_sizes,
    util_compute_stack_sizes,
    util_compute_stack_sizes_css_cc_tree,
    util_compute_stack_sizes_dc_split,
    util_compute_stack_sizes_simple_path_tracer,
)
from optixc.host.structs import attributes, copy, payload, payload_word, struct
from optixc.host.tasks import Task
from optixc.host.texture import Texture2D
from optixc.host.transforms import Transform
from optixc.host.vectors import (
    bool2,
    bool3,
    bool4,
    char2,
    char3,
    char4,
    double2,
    double3,
    double4,
    float2,
    float3,
    float4,
    half2,
    half3,
    half4,
    int2,
    int3,
    int4,
    longlong2,
    longlong3,
    longlong4,
    short2,
    short3,
    short4,
    uchar2,
    uchar3,
    uchar4,
    uint2,
    uint3,
    uint4,
    ulonglong2,
    ulonglong3,
    ulonglong4,
    ushort2,
    ushort3,
    ushort4,
)
from optixc.interpret.launch import interpret
from optixc.options import PipelineCompileOptions
from optixc.toolchain import ToolchainError
from optixc.version import __version__

__all__ = [
    "Accel",
    "Array",
    "Array2",
    "Array3",
    "BakedOpacity",
    "BoundValue",
    "BuildInputCurves",
    "BuildInputCustomPrimitives",
    "BuildInputInstances",
    "BuildInputOpacityMicromap",
    "BuildInputSpheres",
    "BuildInputTriangles",
    "CompileError",
    "CoopVec",
    "CoopVecMatrixDescription",
    "DeviceContext",
    "FixedArray",
    "Instance",
    "Module",
    "MotionOptions",
    "NetworkDescription",
    "OpacityMicromap",
    "OpacityMicromapArray",
    "OptixcWarning",
    "Pipeline",
    "PipelineCompileOptions",
    "PipelineReport",
    "Program",
    "ProgramGroup",
    "Record",
    "ShaderBindingTable",
    "StackSizes",
    "Task",
    "Texture",
    "Texture2D",
    "ToolchainError",
    "Transform",
    "Traversable",
    "TraverseData",
    "__version__",
    "attributes",
    "bake_opacity_micromap",
    "barycentrics_to_micromap_index",
    "base_barycentrics_to_micro_barycentrics",
    "bool2",
    "bool3",
    "bool4",
    "char2",
    "char3",
    "char4",
    "copy",
    "device",
    "double2",
    "double3",
    "double4",
    "e",
    "float2",
    "float3",
    "float3x3",
    "float3x4",
    "float4",
    "float4x4",
    "float16",
    "float32",
    "float64",
    "half2",
    "half3",
    "half4",
    "inf",
    "int2",
    "int3",
    "int4",
    "int8",
    "int16",
    "int32",
    "int64",
    "interpret",
    "launch_params",
    "longlong2",
    "longlong3",
    "longlong4",
    "micromap_index_to_base_barycentrics",
    "nan",
    "payload",
    "payload_word",
    "pi",
    "program",
    "read_image",
    "short2",
    "short3",
    "short4",
    "struct",
    "tau",
    "uchar2",
    "uchar3",
    "uchar4",
    "uint2",
    "uint3",
    "uint4",
    "uint8",
    "uint16",
    "uint32",
    "uint64",
    "ulonglong2",
    "ulonglong3",
    "ulonglong4",
    "ushort2",
    "ushort3",
    "ushort4",
    "util_accumulate_stack_sizes",
    "util_compute_stack_sizes",
    "util_compute_stack_sizes_css_cc_tree",
    "util_compute_stack_sizes_dc_split",
    "util_compute_stack_sizes_simple_path_tracer",
    "write_image",
]
__all__ += enums.__all__
__all__ += errors.__all__


if TYPE_CHECKING:
    from optixc import device_functions
    from optixc.device_functions import *  # noqa: F403

    # Type checkers take for public what this list names, and nothing else of an installed package.
    __all__ += device_functions.__all__
else:

    def __getattr__(name: str) -> Any:
        found = device_function(name)
        if found is None:
            raise AttributeError(f"module 'optixc' has no attribute {name!r}")
        globals()[name] = found
        return found

    def __dir__() -> list[str]:
        return sorted({*globals(), *DEVICE_FUNCTIONS})
