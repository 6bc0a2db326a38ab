"""A loaded pipeline: launches, headers of records, and the report of what was compiled."""

from __future__ import annotations

import os
import sys
import threading
import weakref
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from optixc.enums_program import ExceptionFlags
from optixc.errors import InvalidDeviceContextError, InvalidOperationError, InvalidValueError, ValidationFailureError, from_code
from optixc.host import bound_values, in_flight, library, structs
from optixc.host.accel import moves_by_transform
from optixc.host.array_uses import ArrayUses
from optixc.host.context import LOG_WARNING, Context
from optixc.host.graph_report import check_contexts, graph_forms, traversables
from optixc.host.groups import ProgramGroup, Record, check_layout
from optixc.host.owned import Owned
from optixc.host.sbt import ShaderBindingTable
from optixc.host.stack_sizes import StackSizes, nesting_that_fits, stack_for

STEP_MS = 50
FAULT_BOUND_VALUE = 3
MAX_STACK_SIZE = 1 << 24
MAX_GRAPH_DEPTH, SINGLE_LEVEL_DEPTH = 31, 2
_WALKED = {True: "walked through by Embree", False: "walked through by the kernels (nested, moving, or under transforms)"}
_C_SLOTS = {"direct_callable": "directCallable", "continuation_callable": "continuationCallable"}


@dataclass(frozen=True)
class PipelineReport:
    """What was compiled in, and why; `print(pipeline.report())` shows it."""

    lanes: int
    compiler: str
    compile_seconds: float
    cache_hit: bool
    library: str
    programs: tuple[str, ...]
    params_size: int
    max_trace_depth: int
    features: dict[str, str] = field(default_factory=dict)
    traces: tuple[str, ...] = ()
    ignored: tuple[str, ...] = ()
    bound_values: tuple[dict[str, Any], ...] = ()
    stack: dict[str, int] = field(default_factory=dict)
    frame_bytes: int = 0
    trace_nesting: int | None = None
    is_any_graph: bool = True
    has_native_instances: dict[str, bool] = field(default_factory=dict)
    trace_uses: tuple[dict[str, Any], ...] = ()
    calls_callables: bool = False
    functions: tuple[dict[str, Any], ...] = ()
    arrays: tuple[dict[str, Any], ...] = ()

    def __str__(self) -> str:
        source = "from the cache" if self.cache_hit else f"compiled in {self.compile_seconds:.2f} s"
        lines = [
            f"{len(self.programs)} programs, {self.lanes} lane{'s' if self.lanes > 1 else ''}, {source}, {self.compiler}",
            f"library {self.library}",
            f"launch parameters {self.params_size} bytes, trace depth {self.max_trace_depth}",
            *self.features.values(),
            *(f"trace {one}" for one in self.traces),
            *(f"stack of {name}: {size} bytes" for name, size in self.stack.items()),
            *(f"bound {one['name']} = {one['value']} ({one['reads']} reads)" for one in self.bound_values),
            *(f"ignored on a CPU: {one}" for one in self.ignored),
            *(f"graph {name}: {_WALKED[native]}" for name, native in self.has_native_instances.items()),
        ]
        return "\n".join(lines)

    def function_at(self, path: str, line: int) -> str | None:
        """The program or helper that a line of a shader file belongs to."""
        around = [one for one in self.functions if one["path"] == path and one["first"] <= line <= one["last"]]
        return min(around, key=lambda one: one["last"] - one["first"])["name"] if around else None


class Pipeline(Owned):
    """Programs compiled together; `launch` runs the raygen record's program once per launch index.

    Launches of one pipeline from several threads are serialised. A launch holds everything that it names.
    """

    def __init__(
        self,
        context: Context,
        groups: Sequence[ProgramGroup],
        path: str,
        params: dict[str, Any] | None,
        report: dict[str, Any],
        programs: Sequence[dict[str, Any]],
        exception_flags: int = 0,
        uses_motion: bool = False,
        uses_micromaps: bool = False,
    ) -> None:
        self._pipeline: Any = None
        self.exception_flags = exception_flags
        self.uses_motion = uses_motion
        self.uses_micromaps = uses_micromaps
        self._context = context
        self._groups = tuple(groups)
        self._params = params
        self.programs = {one["name"]: one for one in programs}
        self._params_type: type | None = None
        self._is_motion_told = False
        self._last_params: weakref.ref[Any] | None = None
        self._lock = threading.Lock()
        self._lib = library.lib()
        ffi = library.ffi()
        made = ffi.new("OxrtPipeline*")
        library.check(self._lib.oxrtPipelineLoad(context.handle, os.fsencode(path), made))
        self._pipeline = made[0]
        self._checked_bound_values = report.get("bound_values", ()) if context.validation else ()
        self._done = ffi.new("int*")
        self._null = ffi.NULL
        self._from_buffer = ffi.from_buffer
        info = ffi.new("OxrtPipelineInfo*")
        library.check(self._lib.oxrtPipelineGetInfo(self._pipeline, info))
        self.uid = int(info.uid)
        self._report = PipelineReport(
            lanes=int(info.lanes), params_size=int(info.paramsSize), max_trace_depth=int(info.maxTraceDepth), library=path, **report
        )
        self._provide_stack(int(info.stackSize))
        self._arrays = ArrayUses(self._report.arrays)
        for group in self._groups:
            group.linked_into(self)

    def launch(self, params: Any, sbt: ShaderBindingTable, width: int, height: int = 1, depth: int = 1) -> None:
        """Runs width x height x depth launch indices and returns when all are done; Ctrl-C stops it within a second."""
        self._check_launch(params, sbt)
        kept = in_flight.begin()
        try:
            with self._lock:
                self._live()
                data, size, table = self._pack(params, sbt)
                self._last_params = weakref.ref(params) if self._params is not None else None
                self._run(data, size, table, width, height, depth)
        finally:
            in_flight.end(kept)

    def launch_inputs(self, params: Any, sbt: ShaderBindingTable) -> tuple[Any, Any, int, Any]:
        """What a launch would give the runtime: the pipeline, the bytes of the parameters, their number, the table."""
        self._check_launch(params, sbt)
        with self._lock:
            return (self._live(), *self._pack(params, sbt))

    def _check_launch(self, params: Any, sbt: ShaderBindingTable) -> None:
        context = self._context
        if context._handle is None or self._pipeline is None or context._generation != library._Process.generation:
            self._refuse_dead()
        if type(params) is not self._params_type:
            self._check_params(params)
        if self._params is not None:
            self._arrays.check_params(params, self._look_at_graphs)
        if type(sbt) is not ShaderBindingTable:
            raise InvalidValueError(f"sbt takes a ShaderBindingTable, not {type(sbt).__name__}")

    def _look_at_graphs(self, params: Any) -> None:
        """Rays of a pipeline without motion miss what transforms move, as OptiX's do: too quiet an end for a forgotten option."""
        check_contexts(params, self._context)
        if self.uses_motion or self._is_motion_told:
            return
        moving = next((name for name, one in traversables(params) if moves_by_transform(one)), None)
        if moving is not None:
            self._is_motion_told = True
            text = f"`{moving}` of the launch parameters holds motion transforms; rays of a pipeline without motion miss what is below"
            remedy = "give pipeline_create options=ox.PipelineCompileOptions(uses_motion_blur=True)"
            self._context.log(LOG_WARNING, "LAUNCH", f"{text}; {remedy}")

    def _pack(self, params: Any, sbt: ShaderBindingTable) -> tuple[Any, int, Any]:
        table = sbt.c_table(self)
        if self._params is None:
            return self._null, 0, table
        packed = params.packed()
        if self._checked_bound_values:
            self._check_bound_values(packed)
        return self._from_buffer(packed), len(packed), table

    @property
    def groups(self) -> tuple[ProgramGroup, ...]:
        """The program groups that the pipeline was made of."""
        return self._groups

    def program_number(self, name: str) -> int:
        """The number of a program in the headers of records; -1 if the pipeline does not have it."""
        found = library.ffi().new("int32_t*")
        library.check(self._lib.oxrtPipelineFindProgram(self._live(), name.encode(), found))
        return int(found[0])

    def report(self) -> PipelineReport:
        """What was compiled in and why, compile seconds and cache hit, trace forms; and of the last launch who walked through its graphs.

        `has_native_instances` holds the traversables of its parameters by field, as long as the parameters are there.
        """
        params = self._last_params() if self._last_params is not None else None
        return replace(self._report, has_native_instances=graph_forms(params)) if params is not None else self._report

    def frame_of(self, program: str) -> int:
        """Bytes of stack that a call of a program takes."""
        return self._report.stack.get(program, 0)

    def set_stack_size(
        self,
        direct_callable_stack_size_from_traversal: int,
        direct_callable_stack_size_from_state: int,
        continuation_stack_size: int,
        max_traversable_graph_depth: int = 2,
    ) -> None:
        """OptiX's optixPipelineSetStackSize. Nobody needs to call it: the stacks of host threads hold what `max_trace_depth` allows.

        In a pipeline with ExceptionFlags.STACK_OVERFLOW, traces that nest deeper than `continuation_stack_size` is enough for, by the
        formula of `util_compute_stack_sizes`, are stack overflows. Sizes of direct callables are checked and have no effect.

        In a pipeline with ExceptionFlags.TRACE_DEPTH, and in validation, no ray may be traced against a graph of more traversables one
        below the other than `max_traversable_graph_depth`, wherever the ray would go in it.
        """
        named = {
            "direct_callable_stack_size_from_traversal": direct_callable_stack_size_from_traversal,
            "direct_callable_stack_size_from_state": direct_callable_stack_size_from_state,
            "continuation_stack_size": continuation_stack_size,
        }
        for name, value in named.items():
            if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value <= MAX_STACK_SIZE:
                raise InvalidValueError(f"{name} must be 0 to {MAX_STACK_SIZE} bytes, not {value!r}")
        deepest = MAX_GRAPH_DEPTH if self._report.is_any_graph else SINGLE_LEVEL_DEPTH
        if max_traversable_graph_depth not in range(1, deepest + 1):
            why = "" if self._report.is_any_graph else "; traversable_graph_flags of the pipeline allow a single level only"
            raise InvalidValueError(f"max_traversable_graph_depth must be 1 to {deepest}, not {max_traversable_graph_depth!r}{why}")
        total = StackSizes()
        for group in self._groups:
            total.include(group.get_stack_size(self))
        traces = nesting_that_fits(total, continuation_stack_size)
        library.check(self._lib.oxrtPipelineSetStackDepths(self._live(), traces, max_traversable_graph_depth))

    def _provide_stack(self, available: int) -> None:
        """Programs that look for overflows must have room to notice them, others for all traces that may nest."""
        report, looks = self._report, self.exception_flags & ExceptionFlags.STACK_OVERFLOW
        levels = 1 if looks or report.trace_nesting is None else min(report.trace_nesting, report.max_trace_depth)
        needed = stack_for(report.frame_bytes, levels)
        if needed > available:
            pipeline, self._pipeline = self._pipeline, None
            library.check(self._lib.oxrtPipelineDestroy(pipeline))
            raise InvalidValueError(
                f"the programs of this pipeline take up to {report.frame_bytes} bytes of stack a trace in {report.lanes} lanes, and "
                f"{levels} traces may nest; that may be {needed >> 20} MiB, and threads have {available >> 20}. Keep large FixedArrays in "
                "arrays of the parameters, use fewer lanes (simd=), lower max_trace_depth, or compile with ExceptionFlags.STACK_OVERFLOW"
            )
        library.check(self._lib.oxrtPipelineSetFrames(self._pipeline, report.frame_bytes))

    def check_record(self, record: Record) -> None:
        """Raises unless the record's data is what its programs in this pipeline read, with the arrays that they use."""
        for program in record.group.programs.values():
            linked = self.programs.get(program.name)
            if linked is not None:
                check_layout(program.name, linked["record"], linked["record_name"], record.data)
        self._arrays.check_record([program.name for program in record.group.programs.values()], record.data)

    def pack_header(self, group: ProgramGroup, data_size: int) -> bytes:
        """The 32 bytes before the data of a record that runs `group` in this pipeline."""
        ffi = library.ffi()
        names = {slot: ffi.new("char[]", program.name.encode()) for slot, program in group.programs.items()}
        desc = ffi.new("OxrtProgramGroupDesc*")
        desc.kind = int(group.kind)
        for slot, name in names.items():
            setattr(desc, _C_SLOTS.get(slot, slot), name)
        header = ffi.new("char[]", 32)
        result = self._lib.oxrtSbtRecordPackHeader(self._live(), desc, data_size, header)
        if result:
            raise from_code(result)(f"{group!r} cannot be used with this pipeline: {library.last_message()}")
        return bytes(ffi.buffer(header, 32))

    def destroy(self) -> None:
        """Unloads the pipeline; nothing happens the second time."""
        with self._lock:
            pipeline, self._pipeline = self._pipeline, None
            if pipeline is not None and self._context.is_alive:
                library.check(self._lib.oxrtPipelineDestroy(pipeline))

    def _run(self, data: Any, size: int, table: Any, width: int, height: int, depth: int) -> None:
        lib, pipeline, done = self._lib, self._pipeline, self._done
        done[0] = 0
        try:
            result = lib.oxrtLaunchBegin(pipeline, data, size, table, width, height, depth)
            if result:
                self._live()
                library.check(result)
            result = lib.oxrtLaunchWait(pipeline, STEP_MS, done)
            while not done[0]:
                result = lib.oxrtLaunchWait(pipeline, STEP_MS, done)
        except (OverflowError, TypeError) as error:
            size_text = f"{width!r} x {height!r} x {depth!r}"
            raise InvalidValueError(f"the launch size must be whole numbers of 32 bits, not {size_text}") from error
        except KeyboardInterrupt:
            self._stop()
            raise
        if result:
            self._live()
            raise self._failure(result)

    def _stop(self) -> None:
        """Cancels the launch that runs and waits for its end, so that nothing uses the caller's arrays any more."""
        while not self._done[0]:
            self._lib.oxrtLaunchCancel(self._pipeline)
            if self._lib.oxrtLaunchWait(self._pipeline, STEP_MS, self._done):
                return

    def _failure(self, result: int) -> Exception:
        message = library.last_message()
        ffi = library.ffi()
        report = ffi.new("OxrtLaunchReport*")
        self._lib.oxrtPipelineGetLaunchReport(self._pipeline, report)
        if not report.faultCode:
            return from_code(result)(message)
        path, line = ffi.string(report.path).decode(), int(report.line)
        program = self._report.function_at(path, line)
        error = from_code(result)(message.replace(f"{path}:{line}: ", f"{path}:{line}: {program}, ", 1) if program else message)
        error.fault_code, error.program, error.path, error.line = int(report.faultCode), program, path, line
        error.launch_index = tuple(int(index) for index in report.index)
        return error

    def _check_params(self, params: Any) -> None:
        if self._params is None:
            return
        layout = structs.layout_of(params)
        name, text = self._params["name"], self._params["layout"]
        if layout is None or isinstance(params, type):
            raise InvalidValueError(f"this pipeline's launch parameters are a {name}, not {type(params).__name__}")
        if layout.text != text:
            raise InvalidValueError(
                f"this pipeline's launch parameters are a {name} ({text}), not this {type(params).__name__} ({layout.text})"
            )
        self._params_type = type(params)

    def _check_bound_values(self, packed: bytes | bytearray) -> None:
        wrong = bound_values.difference(packed, self._checked_bound_values)
        if wrong is not None:
            error = ValidationFailureError(wrong)
            error.fault_code = FAULT_BOUND_VALUE
            raise error

    def _live(self) -> Any:
        """The runtime's pipeline; another thread may have destroyed it, or its context."""
        if self._pipeline is None or not self._context.is_alive:
            self._refuse_dead()
        return self._pipeline

    def _refuse_dead(self) -> None:
        # Raises for a destroyed context and in a forked child.
        _ = self._context.handle
        if self._pipeline is None:
            raise InvalidOperationError("this pipeline was destroyed")
        raise InvalidDeviceContextError("this pipeline's context is gone")

    def __repr__(self) -> str:
        lanes = f"{self._report.lanes} lane{'s' if self._report.lanes > 1 else ''}"
        return f"<Pipeline of {' '.join(self.programs)}, {lanes}{'' if self._pipeline is not None else ', destroyed'}>"

    def __del__(self) -> None:
        if getattr(self, "_pipeline", None) is not None and not sys.is_finalizing():
            self.destroy()
