"""What a user may choose about a compile: OptiX's pipeline options and ours, checked once, here.

Values are plain data; nothing here knows compilers or the IR.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from optixc.enums_program import ExceptionFlags
from optixc.enums_scene import PrimitiveTypeFlags, TraversableGraphFlags
from optixc.errors import InvalidValueError

Simd = Literal["auto"] | int
MAX_TRACE_DEPTH = 31
TARGETS = ("native", "x86-64", "x86-64-v3", "x86-64-v4")
EVERY_X86 = "x86-64"
"""The target whose shared object holds kernels for each level of x86-64, to be chosen where it is loaded."""
BoundValue = bool | int | float | tuple[bool | int | float, ...]


@dataclass(frozen=True)
class PipelineCompileOptions:
    """OptiX's OptixPipelineCompileOptions. Payload and attribute counts are taken from the shader's classes; if given they are limits,
    except that 0 payload values means that there is none, and that fewer than 2 attribute values count as 2.

    `allow_clustered_geometry` is accepted and has no effect: there are no clusters on a CPU. So is
    `pipeline_launch_params_variable_name`: programs say `ox.launch_params` themselves.
    """

    uses_motion_blur: bool = False
    traversable_graph_flags: TraversableGraphFlags = TraversableGraphFlags.ANY
    num_payload_values: int | None = None
    num_attribute_values: int | None = None
    exception_flags: ExceptionFlags = ExceptionFlags.NONE
    pipeline_launch_params_variable_name: str | None = None
    uses_primitive_type_flags: PrimitiveTypeFlags | int = 0
    allow_opacity_micromaps: bool = False
    allow_clustered_geometry: bool = False

    def __post_init__(self) -> None:
        counts = (("num_payload_values", 32), ("num_attribute_values", 8))
        for name, limit in (*counts, ("exception_flags", 7), ("traversable_graph_flags", 3)):
            value = getattr(self, name)
            may_be_absent = value is None and (name, limit) in counts
            if not may_be_absent and (not isinstance(value, int) or isinstance(value, bool) or not 0 <= value <= limit):
                raise InvalidValueError(f"{name} must be 0 to {limit}, not {value!r}")
        kinds = self.uses_primitive_type_flags
        if not isinstance(kinds, int) or isinstance(kinds, bool) or not 0 <= kinds < 1 << 32:
            raise InvalidValueError(f"uses_primitive_type_flags combines PrimitiveTypeFlags, it is not {kinds!r}")
        variable = self.pipeline_launch_params_variable_name
        if variable is not None and not isinstance(variable, str):
            raise InvalidValueError(f"pipeline_launch_params_variable_name is a name or None, not {variable!r}")
        for name in ("uses_motion_blur", "allow_opacity_micromaps", "allow_clustered_geometry"):
            if getattr(self, name) not in (False, True):
                raise InvalidValueError(f"{name} must be False or True, not {getattr(self, name)!r}")


@dataclass(frozen=True)
class CompileOptions:
    """Everything that decides the machine code of a pipeline besides its programs."""

    pipeline: PipelineCompileOptions = PipelineCompileOptions()
    max_trace_depth: int = 1
    simd: Simd = "auto"
    math: str = "precise"
    debug: bool = False
    trap_nan: bool = False
    checks_bounds: bool = True
    validation: bool = False
    target: str = "native"
    optimization: int = 3
    bound_values: Mapping[str, BoundValue] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if isinstance(self.simd, bool) or self.simd not in ("auto", 1, 8, 16):
            raise InvalidValueError(f'simd must be "auto", 1, 8 or 16, not {self.simd!r}')
        if self.trap_nan and not self.debug:
            raise InvalidValueError("trap_nan is for debug builds: give debug=True (--debug) as well")
        if self.math not in ("precise", "fast"):
            raise InvalidValueError(f'math must be "precise" or "fast", not {self.math!r}')
        if self.target not in TARGETS:
            raise InvalidValueError(f"target must be one of {', '.join(TARGETS)}, not {self.target!r}")
        if self.optimization not in (0, 1, 2, 3):
            raise InvalidValueError(f"the optimisation level must be 0 to 3, not {self.optimization!r}")
        is_number = isinstance(self.max_trace_depth, int) and not isinstance(self.max_trace_depth, bool)
        if not is_number or not 0 <= self.max_trace_depth <= MAX_TRACE_DEPTH:
            raise InvalidValueError(f"max_trace_depth must be 0 to {MAX_TRACE_DEPTH}, not {self.max_trace_depth!r}")
        for name in ("debug", "trap_nan", "checks_bounds", "validation"):
            if not isinstance(getattr(self, name), bool):
                raise InvalidValueError(f"{name} must be False or True, not {getattr(self, name)!r}")

    def key(self) -> str:
        """A text that is equal exactly for equal options."""
        bound = sorted((name, repr(value)) for name, value in self.bound_values.items())
        told = ("max_trace_depth", "simd", "math", "debug", "trap_nan", "checks_bounds", "validation", "target", "optimization")
        return repr((self.pipeline, [getattr(self, name) for name in told], bound))
