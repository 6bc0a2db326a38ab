"""The explicit host surface: OptiX's objects, from the device context on."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

from numpy.typing import NDArray

from optixc import driver
from optixc.cache import Cache
from optixc.enums_extensions import CoopVecElemType, CoopVecMatrixLayout
from optixc.enums_program import ProgramGroupKind
from optixc.enums_scene import BuildFlags, OpacityMicromapFlags
from optixc.errors import DiskCacheInvalidPathError, DiskCachePermissionError, InvalidValueError, OptixError
from optixc.host import coop_vec, transforms
from optixc.host.accel import Accel
from optixc.host.bound_values import NO_ANNOTATION, merge, plain_values
from optixc.host.context import LOG_ERROR, LOG_PRINT, LOG_WARNING, Context, LogCallback
from optixc.host.coop_vec import CoopVecMatrixDescription, NetworkDescription
from optixc.host.groups import Module, Program, ProgramGroup
from optixc.host.inputs import BuildInput, MotionOptions
from optixc.host.opacity import OpacityMicromapArray, build_array
from optixc.host.pipeline import Pipeline
from optixc.host.tasks import Task, TaskModule
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
        folder = _folder(cache_dir, "cache_dir") if cache_dir is not None else None
        self.cache = Cache(folder, lambda text: self.log(LOG_WARNING, "cache", text))

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
        unit = self._open(source, _folders(include_dirs))
        driver.check_bound_values(unit, {name: bound.value for name, bound in values.items()})
        return Module(unit, unit.programs, values)

    def module_create_with_tasks(
        self,
        source: ModuleType | str | Path | Sequence[Any],
        *,
        include_dirs: Sequence[str | Path] = (),
        bound_values: Mapping[str, Any] | None = None,
    ) -> tuple[TaskModule, Task]:
        """A module that is compiled when its task is executed, on any thread; `get_compilation_state()` tells how far it is."""
        _ = self.handle
        values = plain_values(bound_values)
        folders = _folders(include_dirs)

        def compile_source() -> tuple[driver.Unit, list[dict[str, Any]]]:
            unit = self._open(source, folders)
            driver.check_bound_values(unit, {name: bound.value for name, bound in values.items()})
            return unit, unit.programs

        module = TaskModule(compile_source, values)
        return module, Task(module)

    def set_cache_enabled(self, is_enabled: bool) -> None:
        """Switches the cache folder on or off; OPTIXC_CACHE_MAXSIZE=0 keeps it off. Raises if nothing can be written there."""
        if not is_enabled:
            self.cache.is_on = False
            return
        self._use_cache()

    def get_cache_enabled(self) -> bool:
        """Whether compiled pipelines are kept."""
        return self.cache.enabled

    def set_cache_location(self, location: str | Path) -> None:
        """Another folder for compiled pipelines. Raises if the cache is on and nothing can be written there, and switches it off."""
        self.cache.folder = _folder(location, "the cache location").absolute()
        if self.cache.enabled:
            self._use_cache()

    def get_cache_location(self) -> str:
        """The folder, empty if the environment switched the cache off."""
        return "" if self.cache.is_forced_off else str(self.cache.folder)

    def set_cache_database_sizes(self, low_water_mark: int, high_water_mark: int) -> None:
        """Bytes: above the high mark the entries unused for longest go, down to the low one; 0 for either keeps everything."""
        for name, value in (("low_water_mark", low_water_mark), ("high_water_mark", high_water_mark)):
            if not isinstance(value, int) or isinstance(value, bool) or value < 0:
                raise InvalidValueError(f"{name} must be at least 0 bytes, not {value!r}")
        if low_water_mark and high_water_mark and high_water_mark < low_water_mark:
            raise InvalidValueError(f"the high water mark {high_water_mark} is below the low one, {low_water_mark}")
        self.cache.set_sizes(low_water_mark, high_water_mark)

    def get_cache_database_sizes(self) -> tuple[int, int]:
        """The low and the high water mark in bytes; both 0 if the environment switched the cache off."""
        return (0, 0) if self.cache.is_forced_off else (self.cache.low, self.cache.limit)

    def _use_cache(self) -> None:
        try:
            self.cache.switch_on()
        except PermissionError as error:
            raise DiskCachePermissionError(f"the cache folder {self.cache.folder} cannot be written; choose another") from error
        except OSError as error:
            reason = error.strerror or error
            raise DiskCacheInvalidPathError(f"the cache folder {self.cache.folder} cannot be made ({reason}); give another") from error

    def _open(self, source: Any, include_dirs: list[Path]) -> driver.Unit:
        """The front end's work, its errors told to the log callback as well."""
        try:
            return self._open_source(source, include_dirs)
        except OptixError as error:
            self.tell(LOG_ERROR, "COMPILER", str(error))
            # The compiler's own frames tell an author of shaders nothing.
            raise error.with_traceback(None) from error.__cause__

    def _open_source(self, source: Any, include_dirs: list[Path]) -> driver.Unit:
        if isinstance(source, ModuleType):
            path = getattr(source, "__file__", None)
            if path is None:
                raise InvalidValueError(f"module {source.__name__} has no file; pass a list of its programs instead")
            if not path.endswith(".py"):
                raise InvalidValueError(f"module {source.__name__} comes from {path}, which is no Python source; pass its path")
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
        trap_nan: bool = False,
        checks_bounds: bool = True,
    ) -> Pipeline:
        """Compiles the programs of `groups` together, or takes them from the cache.

        `max_trace_depth` bounds recursive traces; `bound_values` become constants; `simd` is "auto", 1, 8 or 16 lanes; `math` is
        "precise" or "fast"; `debug` checks array bounds and assertions and keeps line information; with it,
        `trap_nan` ends the launch at the first NaN. `checks_bounds=False` leaves out the look at array indices, which costs up to some
        percent; an index out of range then reads and writes other memory.
        """
        _ = self.handle
        _check_groups(groups)
        if options is not None and not isinstance(options, PipelineCompileOptions):
            raise InvalidValueError(f"options takes an ox.PipelineCompileOptions, not {type(options).__name__}")
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
            trap_nan=trap_nan,
            checks_bounds=checks_bounds,
            validation=self.validation,
            bound_values={name: one.value for name, one in bound.items()},
        )
        built = driver.build(units, [program.name for program in used], chosen, self.cache)
        seconds = built.report["compile_seconds"]
        how = "taken from the cache" if built.report["cache_hit"] else f"compiled in {seconds:.2f} s"
        self.log(LOG_PRINT, "COMPILER", f"pipeline of {len(used)} programs {how}")
        for one in built.report["bound_values"]:
            annotation = bound[one["name"]].annotation or NO_ANNOTATION
            self.log(LOG_PRINT, "COMPILER", f"bound value {one['name']} = {one['value']} ({annotation}) replaces {one['reads']} reads")
        return Pipeline(
            self,
            groups,
            str(built.library),
            built.params,
            built.report,
            built.programs,
            int(chosen.pipeline.exception_flags),
            chosen.pipeline.uses_motion_blur,
            chosen.pipeline.allow_opacity_micromaps,
        )

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

    def opacity_micromap_array_build(
        self,
        data: Any,
        descs: Any = None,
        histogram: Any = None,
        *,
        flags: OpacityMicromapFlags | int = OpacityMicromapFlags.NONE,
    ) -> OpacityMicromapArray:
        """Micromaps for triangles: a list of OpacityMicromap; or raw bytes (uint8) with `descs`, rows of (byte_offset, subdivision_level,
        format), and optionally `histogram`, rows of (count, subdivision_level, format), which must agree with them."""
        _ = self.handle
        return build_array(self, data, descs, histogram, flags)

    def coop_vec_matrix_compute_size(
        self, n: int, k: int, element_type: CoopVecElemType, layout: CoopVecMatrixLayout, row_column_stride_in_bytes: int = 0
    ) -> int:
        """Bytes of a matrix of n rows and k columns, a multiple of 64, as `coop_vec_get_matrix_size` gives them in shaders."""
        return coop_vec.compute_size(n, k, element_type, layout, row_column_stride_in_bytes)

    def coop_vec_matrix_convert(
        self,
        input_network: NetworkDescription | Iterable[CoopVecMatrixDescription],
        input: NDArray[Any],
        output_network: NetworkDescription | Iterable[CoopVecMatrixDescription],
        output: NDArray[Any] | None = None,
        *,
        num_networks: int = 1,
        input_stride: int = 0,
        output_stride: int = 0,
    ) -> NDArray[Any]:
        """Convert the matrices of networks of one shape to other layouts and element types; gives the output.

        Without `output` it is a new array of bytes. The strides, in bytes, lie between networks and are ignored for one network.
        """
        return coop_vec.convert(input_network, input, output_network, output, num_networks, input_stride, output_stride)


def _check_groups(groups: Any) -> None:
    if isinstance(groups, ProgramGroup) or not isinstance(groups, Sequence) or not groups:
        raise InvalidValueError("pipeline_create takes a list of program groups, at least one")
    for group in groups:
        if not isinstance(group, ProgramGroup):
            raise InvalidValueError(f"pipeline_create takes program groups, not {type(group).__name__}")
    if not any(group.kind is ProgramGroupKind.RAYGEN for group in groups):
        raise InvalidValueError("a pipeline needs a raygen group: nothing else can begin a launch")


def _folder(path: Any, what: str) -> Path:
    if not isinstance(path, str | Path) or not str(path) or "\0" in str(path):
        raise InvalidValueError(f"{what} takes a folder, a path that is not empty, not {path!r:.60}")
    return Path(path)


def _folders(include_dirs: Any) -> list[Path]:
    if isinstance(include_dirs, str | Path) or not isinstance(include_dirs, Sequence):
        raise InvalidValueError(f"include_dirs takes a list of folders, not {include_dirs!r:.60}")
    return [_folder(folder, "include_dirs") for folder in include_dirs]
