"""The explicit host surface: OptiX's objects, from the device context on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

from optixc import driver
from optixc.cache import Cache
from optixc.enums_program import ProgramGroupKind
from optixc.enums_scene import BuildFlags
from optixc.errors import InvalidValueError
from optixc.host import transforms
from optixc.host.accel import Accel
from optixc.host.bound_values import NO_ANNOTATION, merge, plain_values
from optixc.host.context import LOG_PRINT, LOG_WARNING, Context, LogCallback
from optixc.host.groups import Module, Program, ProgramGroup
from optixc.host.inputs import BuildInput, MotionOptions
from optixc.host.pipeline import Pipeline
from optixc.options import CompileOptions, PipelineCompileOptions, Simd

_Slot = Program | None


class DeviceContext(Context):
    """Owns acceleration structures, modules and pipelines, and the cache folder of compiled pipelines.

    `validation` checks launches and makes them report what OptiX leaves undefined; `log_callback(level, tag, message)` gets what the
    runtime and the compiler say; `cache_dir` is the folder of compiled pipelines (default: OPTIXC_CACHE_DIR, else the user's cache
    folder); `threads` bounds launches and builds.
    """

    def __init__(
        self,
        validation: bool = False,
        log_callback: LogCallback | None = None,
        cache_dir: str | Path | None = None,
        threads: int | None = None,
    ) -> None:
        super().__init__(validation, log_callback, threads)
        self.cache = Cache(Path(cache_dir) if cache_dir is not None else None, lambda text: self.log(LOG_WARNING, "cache", text))

    def module_create(
        self,
        source: ModuleType | str | Path | Sequence[Any],
        *,
        include_dirs: Sequence[str | Path] = (),
        bound_values: Mapping[str, Any] | None = None,
    ) -> Module:
        """The programs of a Python module or shader file (parsed, never run), or of a list of live functions.

        `bound_values` are those of the pipelines that the module becomes part of. Raises CompileError with every error that the shader
        has, FileIoError for a file that cannot be read.
        """
        _ = self.handle
        values = plain_values(bound_values)
        unit = self._open(source, [Path(folder) for folder in include_dirs])
        driver.check_bound_values(unit, {name: bound.value for name, bound in values.items()})
        return Module(unit, unit.programs, values)

    def _open(self, source: Any, include_dirs: list[Path]) -> driver.Unit:
        if isinstance(source, ModuleType):
            path = getattr(source, "__file__", None)
            if path is None:
                raise InvalidValueError(f"module {source.__name__} has no file; pass a list of its programs instead")
            return driver.open_file(Path(path), include_dirs, self.cache)
        if isinstance(source, str | Path):
            return driver.open_file(Path(source), include_dirs, self.cache)
        if isinstance(source, Sequence) and source:
            return driver.open_functions(source)
        raise InvalidValueError(f"module_create takes a Python module, a path, or a list of programs, not {source!r:.60}")

    def program_group_create(self, **programs: _Slot) -> ProgramGroup:
        """A group: `raygen=`, `miss=`, `exception=`, or `closesthit=, anyhit=, intersection=`, or `direct_callable=,
        continuation_callable=`; each a program of a module or None."""
        _ = self.handle
        return ProgramGroup(programs)

    def pipeline_create(
        self,
        groups: Sequence[ProgramGroup],
        max_trace_depth: int = 1,
        *,
        options: PipelineCompileOptions | None = None,
        bound_values: Mapping[str, Any] | None = None,
        simd: Simd = "auto",
        math: str = "precise",
        debug: bool = False,
    ) -> Pipeline:
        """Compiles the programs of `groups` together, or takes them from the cache.

        `max_trace_depth` bounds recursive traces; `bound_values` become constants; `simd` is "auto", 1, 8 or 16 lanes; `math` is
        "precise" or "fast"; `debug` checks array bounds and assertions and keeps line information.
        """
        _ = self.handle
        if isinstance(groups, ProgramGroup) or not isinstance(groups, Sequence) or not groups:
            raise InvalidValueError("pipeline_create takes a list of program groups, at least one")
        for group in groups:
            if not isinstance(group, ProgramGroup):
                raise InvalidValueError(f"pipeline_create takes program groups, not {type(group).__name__}")
        if not any(group.kind is ProgramGroupKind.RAYGEN for group in groups):
            raise InvalidValueError("a pipeline needs a raygen group: nothing else can begin a launch")
        used = list(dict.fromkeys(program for group in groups for program in group.programs.values()))
        modules = list({id(program.module): program.module for program in used}.values())
        units = list(dict.fromkeys(module.unit for module in modules))
        bound = merge([*((module.unit.name, module.bound_values) for module in modules), ("pipeline_create", plain_values(bound_values))])
        chosen = CompileOptions(
            pipeline=options or PipelineCompileOptions(),
            max_trace_depth=max_trace_depth,
            simd=simd,
            math=math,
            debug=debug,
            validation=self.validation,
            bound_values={name: one.value for name, one in bound.items()},
        )
        built = driver.build(units, [program.name for program in used], chosen, self.cache)
        for one in built.report["bound_values"]:
            annotation = bound[one["name"]].annotation or NO_ANNOTATION
            self.log(LOG_PRINT, "COMPILER", f"bound value {one['name']} = {one['value']} ({annotation}) replaces {one['reads']} reads")
        return Pipeline(self, groups, str(built.library), built.params, built.report, built.programs, chosen.pipeline)

    def accel_build(
        self,
        inputs: Sequence[BuildInput],
        build_flags: BuildFlags | int = BuildFlags.NONE,
        motion_options: MotionOptions | None = None,
    ) -> Accel:
        """Builds a GAS from geometry inputs (all of one type) or an IAS from one instances input."""
        return Accel(self, inputs, build_flags, motion_options)

    def static_transform(self, child: Any, transform: Any) -> transforms.Transform:
        """A traversable: `child` (accel, transform or handle) under a 3x4 matrix."""
        return transforms.static_transform(self, child, transform)

    def matrix_motion_transform(self, child: Any, keys: Any, motion_options: MotionOptions | None = None) -> transforms.Transform:
        """A traversable: `child` under matrices of shape (num_keys, 3, 4), blended by element; by default over the times 0 to 1."""
        return transforms.matrix_motion_transform(self, child, keys, motion_options)

    def srt_motion_transform(self, child: Any, keys: Any, motion_options: MotionOptions | None = None) -> transforms.Transform:
        """A traversable: `child` under scale, rotation and translation of shape (num_keys, 16), blended by component and the quaternion
        normalised; members in OptiX's order sx a b pvx sy c pvy sz pvz qx qy qz qw tx ty tz. By default over the times 0 to 1."""
        return transforms.srt_motion_transform(self, child, keys, motion_options)
