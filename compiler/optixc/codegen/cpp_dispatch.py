"""From an SBT record to the program that it names: one struct of dispatchers per payload class, one dispatcher per callable signature.

The structs are declared before the programs, because programs trace; their functions are defined after them.
"""

from __future__ import annotations

from optixc.codegen.cpp_signatures import Signatures, used_parameters
from optixc.codegen.cpp_types import TypeNames
from optixc.codegen.needs import EXCEPTION_FLAG_STACK_OVERFLOW
from optixc.codegen.program_classes import ProgramClass, callables_nest
from optixc.codegen.writer import Writer
from optixc.ir.nodes import Function, ParameterRole, Pipeline, is_reference_type
from optixc.ir.programs import ProgramKind
from optixc.ir.types import Struct, Void
from optixc.passes.callables import CallableSignature, callables_with
from optixc.passes.traced_programs import payload_of

SLOTS = {
    ProgramKind.CLOSESTHIT: "oxrt::SLOT_CLOSESTHIT",
    ProgramKind.ANYHIT: "oxrt::SLOT_ANYHIT",
    ProgramKind.INTERSECTION: "oxrt::SLOT_INTERSECTION",
    ProgramKind.MISS: "0",
}
FUNCTIONS = {
    ProgramKind.CLOSESTHIT: "closestHit",
    ProgramKind.ANYHIT: "anyHit",
    ProgramKind.INTERSECTION: "intersection",
    ProgramKind.MISS: "miss",
}

# OptiX's primitive type flags, by what a scene needs.
_CUSTOM, _SPHERES, _CURVES = 1, 1 << 6, 0b1111_1011_1110


class Dispatch:
    """Writes the dispatchers of one pipeline."""

    def __init__(self, writer: Writer, pipeline: Pipeline, types: TypeNames, signatures: Signatures) -> None:
        self._writer = writer
        self._pipeline = pipeline
        self._types = types
        self._signatures = signatures
        self._numbers = {program.name: number for number, program in enumerate(pipeline.programs)}
        self._callables_nest = callables_nest(pipeline)

    # ---- payload classes -----------------------------------------------------------------------------------------------------

    def declare_class(self, programs: ProgramClass) -> None:
        """What a trace with this payload can run."""
        name = self._signatures.program_class(programs.payload)
        payload = self._payload_name(programs.payload)
        carried = f"a {payload} payload" if programs.payload is not None else "no payload"
        self._writer.line(f"/* What a trace with {carried} can run. */")
        with self._writer.block(f"struct {name} : oxrt::NoPrograms", tail="};"):
            self._writer.line(f"using Payload = {payload};")
            for constant, value in self._constants(programs):
                type_ = "bool" if value == "true" else "uint32_t"
                self._writer.line(f"static constexpr {type_} {constant} = {value};")
            for kind, functions in programs.present:
                inline = "OXRT_INLINE " if kind is ProgramKind.ANYHIT and self._signatures.inlines(functions) else ""
                head = f"static {inline}void {FUNCTIONS[kind]}"
                self._writer.line(f"{head}(oxrt::Ray& trace, Payload& payload, const OxrtRecordHeader& record);")
        self._writer.line()

    def _constants(self, programs: ProgramClass) -> list[tuple[str, str]]:
        options = self._pipeline.options
        kinds = [kind for kind, _ in programs.present]
        constants = [
            ("hasClosestHit", ProgramKind.CLOSESTHIT in kinds),
            ("hasAnyHit", ProgramKind.ANYHIT in kinds),
            ("inlinesAnyHit", ProgramKind.ANYHIT in kinds and self._signatures.inlines(dict(programs.present)[ProgramKind.ANYHIT])),
            ("hasIntersection", ProgramKind.INTERSECTION in kinds),
            ("hasMiss", ProgramKind.MISS in kinds),
            ("mayThrow", programs.may_throw or programs.depth_throws or (programs.overflow_throws and programs.counts_depth)),
            ("countsDepth", programs.counts_depth),
            ("depthThrows", programs.counts_depth and programs.depth_throws),
            ("graphDepthThrows", programs.depth_throws),
            ("checksStack", programs.checks_stack),
            ("overflowThrows", programs.checks_stack and programs.overflow_throws),
            ("usesTime", options.uses_motion_blur),
            ("usesMicromaps", options.allow_opacity_micromaps),
            ("isValidated", options.validation),
        ]
        texts = [(name, "true") for name, is_on in constants if is_on]
        if programs.counts_depth:
            texts.append(("maxTraceDepth", str(options.max_trace_depth)))
        if options.validation and options.traversable_graph_flags:
            texts.append(("graphFlags", str(options.traversable_graph_flags)))
        excluded = _excluded_needs(options.primitive_type_flags)
        if options.validation and excluded:
            texts.append(("excludedNeeds", " | ".join(excluded)))
        return texts

    def define_class(self, programs: ProgramClass) -> None:
        """The dispatchers of one payload class."""
        owner = self._signatures.program_class(programs.payload)
        for kind, functions in programs.present:
            calls = [(function, self._program_call(function, programs.payload, owner)) for function in functions]
            uses_ray = any("trace" in call.replace("oxrt::", "") for _, call in calls)
            uses_payload = any("payload" in call for _, call in calls)
            trace = "oxrt::Ray& trace" if uses_ray or self._pipeline.options.validation else "oxrt::Ray&"
            payload = "Payload& payload" if uses_payload else "Payload&"
            with self._writer.block(f"void {owner}::{FUNCTIONS[kind]}({trace}, {payload}, const OxrtRecordHeader& record)"):
                self._switch(f"record.programs[{SLOTS[kind]}]", calls, mismatch="*trace.thread")
            self._writer.line()

    def _switch(self, number: str, calls: list[tuple[Function, str]], mismatch: str | None) -> None:
        is_validated = self._pipeline.options.validation and mismatch is not None
        if len(calls) == 1 and not is_validated:
            self._writer.line(f"if ({number} == {self.number(calls[0][0])})")
            with self._writer.indented():
                self._writer.line(f"{calls[0][1]};")
            return
        with self._writer.block(f"switch ({number})"):
            for function, call in calls:
                self._writer.line(f"case {self.number(function)}: {call}; break;")
            if is_validated:
                self._writer.line("case OXRT_NO_PROGRAM: break;")
                self._writer.line(f"default: oxrt::payloadMismatch({mismatch}); break;")
            else:
                self._writer.line("default: break;")

    def number(self, program: Function) -> str:
        """The enumerator of a program's number."""
        return f"number::{self._signatures.function(program.name)}"

    def _program_call(self, program: Function, payload: Struct | None, owner: str) -> str:
        needs = self._signatures.needs(program.name)
        arguments = ["trace"] if needs.ray else ["*trace.thread"] if needs.thread else []
        own = payload_of(program)
        for parameter in program.parameters:
            type_ = self._types.name(parameter.local.type)
            match parameter.role:
                case ParameterRole.PAYLOAD:
                    is_same = own == payload or parameter.local.name not in used_parameters(program)
                    arguments.append("payload" if own == payload else f"oxrt::PayloadAs<{type_}, Payload>(payload)")
                    assert own is not None and (is_same or payload is not None)
                case ParameterRole.ATTRIBUTES:
                    arguments.append(f"oxrt::getAttributes<{type_}>(trace)")
                case ParameterRole.RECORD:
                    arguments.append(f"oxrt::recordData<{type_}>(record)")
                case ParameterRole.VALUE:
                    raise AssertionError(f"{program.name} has an ordinary parameter")
        template = f"<{owner}>" if needs.programs else ""
        return f"{self._signatures.function(program.name)}{template}({', '.join(arguments)})"

    def _payload_name(self, payload: Struct | None) -> str:
        return self._types.struct(payload) if payload is not None else "oxrt::NoPayload"

    # ---- callables -----------------------------------------------------------------------------------------------------------

    def callable_head(self, signature: CallableSignature) -> str:
        name = self._signatures.dispatcher_of(signature)
        arguments = ["OxrtThread& thread", "uint32_t index"]
        for position, type_ in enumerate(signature.arguments):
            text = self._types.name(type_)
            arguments.append(f"const {text}& a{position}" if is_reference_type(type_) else f"{text} a{position}")
        if self.tells_place:
            arguments.append("oxrt::Place place")
        return f"{self._types.name(signature.result)} {name}({', '.join(arguments)})"

    @property
    def tells_place(self) -> bool:
        """Whether a callable's dispatcher may have to tell where the call stands."""
        return self._pipeline.options.validation or self._callables_nest

    def declare_callable(self, signature: CallableSignature) -> None:
        self.declare_with_place(self.callable_head(signature))

    def declare_with_place(self, head: str) -> None:
        """Declares a callable's dispatcher; where it takes a place, callers need not name theirs."""
        self._writer.line(f"{head.removesuffix(')')} = oxrt::Place::current());" if self.tells_place else f"{head};")

    def define_callable(self, signature: CallableSignature) -> None:
        """Runs the callable of record `index`; without one the result is zero, and a fault in validation."""
        slot = 0 if signature.is_direct else 1
        result = "" if isinstance(signature.result, Void) else " {}"
        with self._writer.block(self.callable_head(signature)):
            if self._callables_nest:
                throws = "true" if self._pipeline.options.exception_flags & EXCEPTION_FLAG_STACK_OVERFLOW else "false"
                self._writer.line(f"if (!oxrt::enterCallable<{throws}>(thread, place)) return{result};")
            place = ", place" if self.tells_place else ""
            self._writer.line(f"const OxrtRecordHeader* record = oxrt::findCallable(thread, index, {slot}{place});")
            with self._writer.block(f"switch (record ? record->programs[{slot}] : OXRT_NO_PROGRAM)"):
                for program in callables_with(self._pipeline, signature):
                    call = f"{self._signatures.function(program.name)}({', '.join(self._callable_arguments(program))})"
                    run = f"{call}; return;" if isinstance(signature.result, Void) else f"return {call};"
                    self._writer.line(f"case {self.number(program)}: {run}")
                if self._pipeline.options.validation:
                    self._writer.line(f"case OXRT_NO_PROGRAM: return{result};")
                    self._writer.line(f"default: oxrt::callableMismatch(thread, place); return{result};")
                else:
                    self._writer.line(f"default: return{result};")
        self._writer.line()

    def _callable_arguments(self, program: Function) -> list[str]:
        arguments = ["thread"] if self._signatures.needs(program.name).thread else []
        position = 0
        for parameter in program.parameters:
            if parameter.role is ParameterRole.RECORD:
                arguments.append(f"oxrt::recordData<{self._types.name(parameter.local.type)}>(*record)")
            else:
                arguments.append(f"a{position}")
                position += 1
        return arguments


def _excluded_needs(primitive_type_flags: int) -> list[str]:
    """What scenes must not need by OptiX's flags of primitive types; no flags allow everything here."""
    if not primitive_type_flags:
        return []
    kinds = ((_CUSTOM, "OXRT_SCENE_HAS_CUSTOM"), (_CURVES, "OXRT_SCENE_HAS_CURVES"), (_SPHERES, "OXRT_SCENE_HAS_SPHERES"))
    return [name for flags, name in kinds if not primitive_type_flags & flags]
