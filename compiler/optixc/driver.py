"""From shader files and live functions to a shared object: front end, passes, code generation, tool chain, with the cache in between.

A file's programs are known to the cache by the text of the file and of every helper it imports, so that a hit neither parses nor
starts a process. Live functions have no such key: they are checked and emitted each time, and the C++ text is their key.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from optixc import passes, shader_keys, toolchain
from optixc.cache import Cache
from optixc.codegen.emit import emit as emit_cpp
from optixc.codegen.program_classes import trace_depth
from optixc.codegen.word_limits import first_excess
from optixc.errors import (
    InvalidAttributeAccessError,
    InvalidOperationError,
    InvalidPayloadAccessError,
    InvalidValueError,
    NotSupportedError,
    PipelineLinkError,
)
from optixc.frontend.compile import FrontendResult, compile_file, compile_functions
from optixc.installation import include_folder
from optixc.ir import layout, nodes
from optixc.ir import types as t
from optixc.ir.walk import expressions, statements
from optixc.options import EVERY_X86, BoundValue, CompileOptions
from optixc.passes.array_uses import ArrayUse, array_uses
from optixc.passes.callables import signatures_called
from optixc.passes.features import Features, features
from optixc.passes.live_notes import Carried, carried_words
from optixc.passes.live_words import numbers
from optixc.passes.pipeline import LinkError, link
from optixc.passes.specialize import parameter_path
from optixc.passes.traced_programs import constant, payload_of, traces_of
from optixc.shader_keys import dependencies_key, file_key, places
from optixc.signed_json import Json, digest
from optixc.stack_usage import frames_of_programs

PrintAfter = Callable[[str, nodes.Pipeline], None]

SPMD_LANES: tuple[int, ...] = (8, 16)
"""Packet widths that the emitter knows."""

FRAME_BASE, RAY_SIZE = 128, 512


class Unit:
    """A shader module: its programs, and its IR once somebody needs it. `key` names its text to the cache, None for live functions."""

    def __init__(self, name: str, programs: list[Json], key: str | None, make: Callable[[], FrontendResult]) -> None:
        self.name = name
        self.programs = programs
        self.key = key
        self._make = make
        self._result: FrontendResult | None = None

    @property
    def result(self) -> FrontendResult:
        """What the front end made of it."""
        if self._result is None:
            self._result = self._make()
        return self._result


_WITHOUT_MEANING = ("allow_clustered_geometry", "pipeline_launch_params_variable_name")
"""Options of OptiX that say nothing on a CPU: they are accepted, and listed by the report."""


@dataclass(frozen=True)
class Built:
    """A compiled pipeline: where it lies, its launch parameters (`name`, `layout`, `size`), what the report says, its programs."""

    library: Path
    params: Json | None
    report: Json
    programs: list[Json]


@dataclass(frozen=True)
class Emitted:
    """A pipeline as C++ text, with the linked IR and the features that it came from."""

    text: str
    pipeline: nodes.Pipeline
    features: Features


def open_file(path: Path, include_dirs: Sequence[Path], store: Cache) -> Unit:
    """The module of a shader file; the front end runs only if the cache does not know the file's text. Raises CompileError."""
    key = file_key(path, include_dirs)
    note = store.read_note(key)
    if note is not None and not any(Path(one).is_file() for one in note["absent"]):
        current = dependencies_key(key, note["dependencies"])
        if current is not None and current == note["key"]:
            then = places(path, include_dirs)
            return Unit(path.stem, note["programs"], current, lambda: _again(path, include_dirs, then, current))
    result = compile_file(str(path), include_dirs=tuple(str(folder) for folder in include_dirs))
    full_key = dependencies_key(key, result.dependencies)
    programs = describe_programs(result.module)
    if full_key is not None:
        found = {"dependencies": list(result.dependencies), "absent": list(result.absent)}
        store.write_note(key, {**found, "key": full_key, "programs": programs})
    unit = Unit(path.stem, programs, full_key, lambda: result)
    return unit


def check_bound_values(unit: Unit, values: Mapping[str, BoundValue]) -> None:
    """Raises unless each value fits a field of the module's launch parameters."""
    for name, value in values.items():
        _bound_literal(name, value, unit.result.module.params)


def open_functions(functions: Sequence[Any]) -> Unit:
    """The module of live functions. Raises CompileError."""
    result = compile_functions(list(functions))
    return Unit(result.module.name, describe_programs(result.module), None, lambda: result)


def build(units: Sequence[Unit], names: Sequence[str], options: CompileOptions, store: Cache) -> Built:
    """Compiles the named programs of the units into one pipeline, or finds it in the cache.

    Where no compiler is installed, what the cache holds from one that was there still serves.
    """
    try:
        return _build(units, names, options, store, toolchain.find_compiler(store.memory))
    except toolchain.NoCompilerError:
        for compiler in toolchain.remembered_compilers(store.memory):
            with suppress(toolchain.NoCompilerError):
                return _build(units, names, options, store, compiler, is_installed=False)
        raise


def _build(
    units: Sequence[Unit],
    names: Sequence[str],
    options: CompileOptions,
    store: Cache,
    compiler: toolchain.Compiler,
    is_installed: bool = True,
) -> Built:
    """As `build`, with this compiler. Raises NoCompilerError if it would have to run and is not installed."""
    began = time.perf_counter()
    plan = recipe(options)
    known = None
    if all(unit.key is not None for unit in units):
        known = digest("pipeline", *(str(unit.key) for unit in units), *names, options.key(), compiler.identity, *_surroundings(plan))
        note = store.read_note(known)
        entry = store.find(note["entry"]) if note is not None else None
        if note is not None and entry is not None:
            report = {**note["report"], "compile_seconds": time.perf_counter() - began, "cache_hit": True}
            return Built(entry.library, note["params"], report, note["programs"])
    chosen = variants(options)
    written = [(emit([unit.result.module for unit in units], names, one), recipe(one)) for one in chosen]
    emitted = written[-1][0]
    kernels = [part for one, how in written for part in (one.text, *how.flags())]
    key = digest("library", *kernels, compiler.identity, *_surroundings(plan))
    entry = store.find(key)
    if entry is None:
        if not is_installed:
            raise toolchain.NoCompilerError
        manifest: Json = {}

        def produce(output: Path) -> None:
            if len(written) == 1:
                manifest["frames"] = toolchain.compile_shared(emitted.text, output, compiler, plan, store.memory)
            else:
                manifest["frames"] = toolchain.compile_variants([(one.text, how) for one, how in written], output, compiler)

        entry = store.store(key, manifest, produce)
    params = _describe_params(emitted.pipeline.params)
    report = _describe(emitted, options, compiler)
    report["bound_values"] = _describe_bound([unit.result.module for unit in units], emitted.pipeline.params, emitted.pipeline.options)
    programs = [_describe_program(program) for program in emitted.pipeline.programs]
    report["frame_bytes"] = sum(entry.manifest.get("frames", {}).values())
    report["stack"] = frames_of_programs(entry.manifest.get("frames", {}), [program.name for program in emitted.pipeline.programs])
    if known is not None:
        store.write_note(known, {"entry": key, "params": params, "report": report, "programs": programs})
    finished = {**report, "compile_seconds": time.perf_counter() - began, "cache_hit": entry.hit}
    return Built(entry.library, params, finished, programs)


def emit(modules: Sequence[nodes.Module], names: Sequence[str], options: CompileOptions, print_after: PrintAfter | None = None) -> Emitted:
    """Links the named programs, runs the passes (`print_after(name, pipeline)` behind each), writes the C++ text."""
    params = next((module.params for module in modules if module.params is not None), None)
    try:
        linked = link(modules, names, pipeline_options(options, params))
    except LinkError as error:
        raise PipelineLinkError(str(error)) from error
    excess = first_excess(linked, options.pipeline.num_payload_values, options.pipeline.num_attribute_values)
    if excess is not None:
        raise (InvalidPayloadAccessError if excess[0] == "payload" else InvalidAttributeAccessError)(excess[1])
    pipeline = passes.run(linked, print_after=print_after)
    found = features(pipeline)
    return Emitted(emit_cpp(pipeline, found), pipeline, found)


def pass_names() -> tuple[str, ...]:
    """The passes in their order."""
    return tuple(name for name, _ in passes.PASSES)


def pipeline_options(options: CompileOptions, params: t.Struct | None) -> nodes.PipelineOptions:
    """The part of the options that passes and emitters know."""
    return nodes.PipelineOptions(
        max_trace_depth=options.max_trace_depth,
        lanes=lanes(options),
        fast_math=options.math == "fast",
        debug=options.debug,
        trap_nan=options.trap_nan,
        checks_bounds=options.checks_bounds,
        validation=options.validation,
        uses_motion_blur=options.pipeline.uses_motion_blur,
        allow_opacity_micromaps=options.pipeline.allow_opacity_micromaps,
        traversable_graph_flags=int(options.pipeline.traversable_graph_flags),
        primitive_type_flags=int(options.pipeline.uses_primitive_type_flags),
        exception_flags=int(options.pipeline.exception_flags),
        bound_values=tuple((name, _bound_literal(name, value, params)) for name, value in sorted(options.bound_values.items())),
    )


def variants(options: CompileOptions) -> tuple[CompileOptions, ...]:
    """The options of each set of kernels in one shared object: several only for EVERY_X86, the least instruction set first."""
    if options.target != EVERY_X86 or options.debug:
        return (options,)
    if options.simd != "auto":
        raise NotSupportedError(f"target {EVERY_X86} has kernels for each width; leave out simd={options.simd}, or name one level")
    return tuple(replace(options, target=level, simd=width) for level, width in toolchain.LANES_OF_TARGETS.items())


def lanes(options: CompileOptions) -> int:
    """Lanes to compile for: what was asked, or the widest that the processor and the emitter have. Debug builds are scalar."""
    if options.simd == "auto":
        widest = 1 if options.debug else toolchain.processor_lanes(options.target)
        return max((width for width in (1, *SPMD_LANES) if width <= widest), default=1)
    if options.simd != 1 and options.simd not in SPMD_LANES:
        raise NotSupportedError(f"simd={options.simd} is not available; use 1 or auto")
    if options.simd > toolchain.processor_lanes(options.target):
        what = "this processor has" if options.target == "native" else f"{options.target} has"
        raise NotSupportedError(f"simd={options.simd} needs more than {what}; the most is {toolchain.processor_lanes(options.target)}")
    return int(options.simd)


def describe_programs(module: nodes.Module) -> list[Json]:
    """Name, kind and record struct of each program, as JSON."""
    return [_describe_program(program) for program in module.programs]


def _describe_program(program: nodes.Function) -> Json:
    record = next((one.local.type for one in program.parameters if one.role is nodes.ParameterRole.RECORD), None)
    assert program.kind is not None
    payload = payload_of(program)
    described = isinstance(record, t.Struct)
    return {
        "name": program.name,
        "kind": program.kind.value,
        "record": layout.describe(record) if isinstance(record, t.Struct) else None,
        "record_name": record.name if described and isinstance(record, t.Struct) else None,
        "source": str(program.span),
        "stack": _estimated_frame(program),
        "payload": _payload_text(payload),
        "payload_name": payload.name if payload is not None else None,
    }


def _describe_place(function: nodes.Function) -> Json:
    """The lines of a program or helper, so that a fault can name it."""
    span = function.span
    last = max((statement.span.end_line for statement in statements(function.body)), default=span.end_line)
    return {"name": function.source_name, "path": span.path, "first": span.line, "last": last}


def _describe_trace(trace: nodes.Trace, words: Carried | None) -> Json:
    """What of a trace decides the records that it reaches, None for what is no constant; and the words of its payload."""
    sbt_offset, sbt_stride, miss = (constant(argument) for argument in trace.arguments[8:11])
    return {
        "name": trace.name,
        "place": f"{trace.span.path}:{trace.span.line}",
        "sbt_offset": sbt_offset,
        "sbt_stride": sbt_stride,
        "miss": miss,
        "payload": _payload_text(trace.payload_type),
        "payload_name": trace.payload_type.name if trace.payload_type is not None else None,
        "words": layout.payload_words(trace.payload_type) if trace.payload_type is not None else 0,
        "carried_words": numbers(words.carried) if words is not None else [],
    }


def _describe_use(use: ArrayUse) -> Json:
    """An array that a launch needs, and where it is used and written."""
    used, written = (f"{span.path}:{span.line}" if span is not None else None for span in (use.used, use.written))
    return {"path": use.path, "used": used, "written": written}


def _trace_text(use: Json) -> str:
    given = (("sbt_offset", "sbt_offset"), ("sbt_stride", "sbt_stride"), ("miss", "miss_sbt_index"))
    words = ", ".join(f"{name} {use[key] if use[key] is not None else 'varies'}" for key, name in given)
    live = "" if len(use["carried_words"]) == use["words"] else f", {len(use['carried_words'])} of them carried"
    carried = f"payload {use['payload_name']} of {use['words']} words{live}" if use["payload"] else "no payload"
    return f"{use['place']}: {use['name']}, {words}, {carried}"


def _payload_text(payload: t.Struct | None) -> str | None:
    """The words of a payload: programs and traces with equal texts fit."""
    return ",".join(map(str, layout.payload_scalars(payload))) if payload is not None else None


def _estimated_frame(program: nodes.Function) -> int:
    """Bytes of a program that is in no pipeline yet: twice its locals, and a ray for each of its traces."""
    locals_ = sum(layout.size_of(local.type) for local in program.locals if not isinstance(local.type, t.Tuple | t.Void))
    traces = sum(isinstance(statement, nodes.Trace) for statement in statements(program.body))
    return FRAME_BASE + 2 * locals_ + RAY_SIZE * traces


def _describe_params(params: t.Struct | None) -> Json | None:
    if params is None:
        return None
    return {"name": params.name, "layout": layout.describe(params), "size": layout.size_of(params)}


def _describe(emitted: Emitted, options: CompileOptions, compiler: toolchain.Compiler) -> Json:
    words = carried_words(emitted.pipeline)
    uses = [_describe_trace(trace, words.get(id(trace))) for _, trace in traces_of(emitted.pipeline) if trace.arguments]
    return {
        "compiler": str(compiler),
        "programs": [program.name for program in emitted.pipeline.programs],
        "features": {feature.name: feature.describe() for feature in emitted.features.items},
        "arrays": [_describe_use(use) for use in array_uses(emitted.pipeline)],
        "functions": [_describe_place(function) for function in (*emitted.pipeline.programs, *emitted.pipeline.helpers)],
        "traces": [str(use) for use in map(_trace_text, uses)],
        "trace_uses": uses,
        "trace_nesting": trace_depth(emitted.pipeline),
        "calls_callables": bool(signatures_called(emitted.pipeline)),
        "is_any_graph": int(options.pipeline.traversable_graph_flags) == 0,
        "ignored": [name for name in _WITHOUT_MEANING if getattr(options.pipeline, name)],
    }


def _bound_literal(name: str, value: BoundValue, params: t.Struct | None) -> nodes.Literal:
    type_ = _field_of(name, params)[0]
    match type_:
        case t.Scalar(kind=kind):
            wanted: tuple[type, ...] = {t.ScalarKind.BOOL: (bool,), t.ScalarKind.FLOAT: (int, float)}.get(kind, (int,))
            if not isinstance(value, wanted) or (kind is not t.ScalarKind.BOOL and isinstance(value, bool)):
                raise InvalidValueError(f"bound value {name!r} takes a {type_}, not {value!r}")
            return nodes.Literal(float(value) if kind is t.ScalarKind.FLOAT and not isinstance(value, tuple) else value, type_)
        case t.Vector(size=size):
            if not isinstance(value, tuple) or len(value) != size:
                raise InvalidValueError(f"bound value {name!r} takes {size} numbers, not {value!r}")
            return nodes.Literal(value, type_)
        case _:
            raise InvalidValueError(f"bound value {name!r} is a {type_}; numbers, vectors and structs of them can be bound")


def _field_of(name: str, params: t.Struct | None) -> tuple[t.Type, int]:
    """Type and offset of a field of the launch parameters, dotted inside of structs."""
    if params is None:
        raise InvalidValueError(f"bound value {name!r} is no field: the shaders have no launch parameters")
    found: t.Type = params
    offset = 0
    for part in name.split("."):
        names = [field.name for field in found.fields] if isinstance(found, t.Struct) else []
        if part not in names or not isinstance(found, t.Struct):
            raise InvalidValueError(f"bound value {name!r} is no field of {params.name}; {found} has {', '.join(names) or 'no fields'}")
        position = names.index(part)
        offset += layout.struct_layout(found).offsets[position]
        found = found.fields[position].type
    return found, offset


def _describe_bound(modules: Sequence[nodes.Module], params: t.Struct | None, options: nodes.PipelineOptions) -> list[Json]:
    """Where each bound value lies in the launch parameters, its bytes, and how many reads of the modules it replaces."""
    functions = [function for module in modules for function in (*module.helpers, *module.programs)]
    reads = Counter(parameter_path(expression) for function in functions for expression in expressions(function.body))
    described = []
    for name, literal in options.bound_values:
        data = np.array(literal.value, layout.dtype_of(t.scalar_of(literal.type) or literal.type)).tobytes()
        offset = _field_of(name, params)[1]
        described.append({"name": name, "value": str(literal.value), "offset": offset, "data": data.hex(), "reads": reads[name]})
    return described


def _again(path: Path, include_dirs: Sequence[Path], found: list[Path], expected: str) -> FrontendResult:
    """The front end's result for a file that only the cache had looked at; `found` are the places of then."""
    if places(path, include_dirs) != found:
        path, *include_dirs = found
    result = compile_file(str(path), include_dirs=tuple(str(folder) for folder in include_dirs))
    if dependencies_key(file_key(path, include_dirs), result.dependencies) != expected:
        raise InvalidOperationError(f"{path} or a file that it imports changed since module_create; create the module again")
    return result


def recipe(options: CompileOptions) -> toolchain.Build:
    """How the tool chain compiles under these options."""
    return toolchain.Build(include_folder(), options.target, options.optimization, options.math == "fast", options.debug)


def _surroundings(plan: toolchain.Build) -> tuple[str, ...]:
    """What besides program, options and compiler decides the machine code."""
    machine = f"{toolchain.processor()}{toolchain.native_target()}" if plan.target == "native" else ""
    return (shader_keys.compiler_stamp(), shader_keys.headers_digest(plan.include), machine)
