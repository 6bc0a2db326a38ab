"""The whole C++ file of a pipeline: structs, dispatchers, helpers, programs, entry points, and the one exported symbol.

Takes a pipeline that all passes ran on; the text compiles without warnings and depends on nothing but its input.
"""

from __future__ import annotations

from collections.abc import Sequence

from optixc.codegen.cpp_dispatch import Dispatch
from optixc.codegen.cpp_scalar import ScalarFunction
from optixc.codegen.cpp_signatures import Signatures
from optixc.codegen.cpp_types import TypeNames, structs_within
from optixc.codegen.helper_calls import callees_first, recursive_helpers
from optixc.codegen.names import Scope, string_literal
from optixc.codegen.needs import needs_of_pipeline, options_of
from optixc.codegen.program_classes import program_classes
from optixc.codegen.writer import Writer
from optixc.ir.layout import size_of
from optixc.ir.nodes import Function, ParameterRole, Pipeline
from optixc.ir.programs import ProgramKind
from optixc.ir.types import Struct
from optixc.ir.walk import expressions
from optixc.passes.callables import CallableSignature, signatures_called
from optixc.passes.drop_dead_words import unread_fields
from optixc.passes.features import Features
from optixc.passes.traced_programs import traces_of
from optixc.version import __version__

_KINDS = {kind: f"OXRT_KIND_{kind.name}" for kind in ProgramKind}


def emit(pipeline: Pipeline, features: Features) -> str:
    """The text of pipeline.cpp."""
    return PipelineFile(pipeline, features).text()


class PipelineFile:
    """Writes one pipeline with the scalar emitter."""

    def __init__(self, pipeline: Pipeline, features: Features) -> None:
        self._pipeline = pipeline
        self._features = features
        self._writer = Writer()
        self._scope = Scope(taken=("number", "programs", "variants", "Payload", "Programs", "LANES", "Wide", "Mask", "Lanes", "Rays"))
        self._types = TypeNames(structs_of(pipeline), self._scope, unread_fields(pipeline))
        needs = needs_of_pipeline(pipeline)
        self._classes = program_classes(pipeline, needs)
        self._signatures = Signatures(pipeline, self._types, self._scope, needs, self._classes)
        self._dispatch = Dispatch(self._writer, pipeline, self._types, self._signatures)

    def text(self) -> str:
        self._head()
        self._writer.line("namespace {")
        self._writer.line()
        self._types.definitions(self._writer)
        self._declare_programs()
        self._declare_functions(self._pipeline.helpers, signatures_called(self._pipeline))
        for function in (*callees_first(self._pipeline.helpers), *self._pipeline.programs):
            ScalarFunction(self._writer, function, self._types, self._signatures, options_of(self._pipeline)).write()
        for programs in self._classes.values():
            self._dispatch.define_class(programs)
        for signature in signatures_called(self._pipeline):
            self._dispatch.define_callable(signature)
        for program in self._pipeline.programs:
            if program.kind is ProgramKind.RAYGEN:
                self._entry(program)
        self._tables()
        self._writer.line("}  // namespace")
        self._writer.line()
        self._exported_symbol()
        return self._writer.text()

    def _head(self) -> None:
        self._writer.line("/* Made by optixc. Compiled features:")
        for feature in self._features.compiled_in:
            self._writer.line(f"   {feature.describe()}")
        self._writer.line("*/")
        self._writer.line("#include <oxrt/device.h>")
        if self._features.has("hit objects"):
            self._writer.line("#include <oxrt/device_make_hit.h>")
        if self._features.has("textures"):
            self._writer.line("#include <oxrt/device_texture.h>")
        if self._features.has("cooperative vectors"):
            self._writer.line("#include <oxrt/coop_vec.h>")
        self._writer.line()

    def _declare_programs(self) -> None:
        """Numbers of programs, and the classes of those that traces run."""
        numbers = ", ".join(self._signatures.function(program.name) for program in self._pipeline.programs)
        self._writer.line("/* Program numbers, as SBT records hold them. */")
        self._writer.line("namespace number {")
        self._writer.line(f"enum : int32_t {{ {numbers} }};")
        self._writer.line("}")
        self._writer.line()
        for programs in self._classes.values():
            self._dispatch.declare_class(programs)

    def _declare_functions(self, helpers: Sequence[Function], signatures: Sequence[CallableSignature]) -> None:
        """Functions that others call before their definition."""
        for signature in signatures:
            self._dispatch.declare_callable(signature)
        recursive = recursive_helpers(self._pipeline.helpers)
        for helper in helpers:
            if helper.name in recursive:
                self._writer.line(f"{self._signatures.head(helper, self._signatures.inner_names(helper))};")
        if signatures or any(helper.name in recursive for helper in helpers):
            self._writer.line()

    def _entry(self, program: Function) -> None:
        """The loop over a tile of launch indices."""
        throws = self._signatures.needs(program.name).throws
        call = self._call(program, "thread->launch->raygenRecord")
        capture = "thread" if throws or "thread" in call else ""
        with (
            self._writer.block(f"void run_{self._signatures.function(program.name)}(OxrtThread* thread, const OxrtTile* tile)"),
            self._writer.block(f"oxrt::forEachIndex(*thread, *tile, [{capture}]", tail="});"),
        ):
            self._writer.line(f"{call};")
            if throws:
                self._run_exception()
        self._writer.line()

    def _run_exception(self) -> None:
        """Behind the program: the exception that is pending, if any, goes to the exception program of the SBT."""
        exceptions = [p for p in self._pipeline.programs if p.kind is ProgramKind.EXCEPTION]
        self._writer.line("if (thread->exceptionPending)")
        with self._writer.indented():
            if not exceptions:
                self._writer.line("oxrt::takeException(*thread);")
                return
            with self._writer.block("switch (oxrt::takeException(*thread))"):
                for program in exceptions:
                    call = self._call(program, "thread->launch->exceptionRecord")
                    self._writer.line(f"case {self._dispatch.number(program)}: {call}; break;")
                self._writer.line("default: break;")

    def _call(self, program: Function, record: str) -> str:
        """The call of a program that has no ray; `record` is the address of its SBT record."""
        arguments = ["*thread"] if self._signatures.needs(program.name).thread else []
        arguments += [
            f"oxrt::recordAt<{self._types.name(parameter.local.type)}>({record})"
            for parameter in program.parameters
            if parameter.role is ParameterRole.RECORD
        ]
        return f"{self._signatures.function(program.name)}({', '.join(arguments)})"

    def _tables(self) -> None:
        with self._writer.block("const OxrtProgram programs[] =", tail="};"):
            for program in self._pipeline.programs:
                record = next((p.local.type for p in program.parameters if p.role is ParameterRole.RECORD), None)
                size = f"sizeof({self._types.name(record)})" if record is not None else "0"
                run = f"run_{self._signatures.function(program.name)}" if program.kind is ProgramKind.RAYGEN else "nullptr"
                assert program.kind is not None
                self._writer.line(f"{{{string_literal(program.name)}, {_KINDS[program.kind]}, {size}, {run}}},")
        self._writer.line(f"const OxrtPipelineVariant variants[] = {{{self._variant()}}};")
        for struct in (self._pipeline.params, *record_structs(self._pipeline)):
            if struct is not None:
                self._writer.line(f"static_assert(sizeof({self._types.struct(struct)}) == {size_of(struct)});")
        self._writer.line()

    def _variant(self) -> str:
        """The kernels of this file: instruction set, lanes, programs."""
        return f"{{oxrt::BUILT_ISA, {self._lanes()}, programs, {len(self._pipeline.programs)}}}"

    def _lanes(self) -> int:
        return 1

    def _exported_symbol(self) -> None:
        params = self._pipeline.params
        size = f"{size_of(params)}" if params is not None else "0"
        fields = ["OXRT_PIPELINE_ABI", "1", "variants", size, str(self._pipeline.options.max_trace_depth), string_literal(__version__)]
        self._writer.line('extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary oxrt_pipeline_v1 = {')
        with self._writer.indented():
            self._writer.line(f"{', '.join(fields)}}};")


def structs_of(pipeline: Pipeline) -> list[Struct]:
    """Every struct that the file must define, each after those that it contains."""
    roots: list[Struct] = [*pipeline.structs, *((pipeline.params,) if pipeline.params is not None else ())]
    roots += [trace.payload_type for _, trace in traces_of(pipeline) if trace.payload_type is not None]
    for function in (*pipeline.helpers, *pipeline.programs):
        types = [parameter.local.type for parameter in function.parameters] + [local.type for local in function.locals]
        types += [function.result, *(expression.type for expression in expressions(function.body))]
        roots += [struct for type_ in types for struct in structs_within(type_)]
    return list(dict.fromkeys(struct for root in roots for struct in structs_within(root)))


def record_structs(pipeline: Pipeline) -> list[Struct]:
    """The structs of SBT record data, in order of the programs."""
    records = (p.local.type for program in pipeline.programs for p in program.parameters if p.role is ParameterRole.RECORD)
    return list(dict.fromkeys(record for record in records if isinstance(record, Struct)))
