"""The C++ file of a pipeline whose launch indices run 8 or 16 at a time.

Any-hit and intersection programs are written twice: over lanes, and scalar for rays that are traced one by one (`lanes_trace.h` says
when). Exception programs are scalar. `spmd_obstacle` names what a pipeline uses that has no form over lanes; such a pipeline is emitted
scalar altogether.
"""

from __future__ import annotations

from dataclasses import replace

from optixc.codegen.cpp_dispatch import FUNCTIONS, SLOTS
from optixc.codegen.cpp_pipeline import PipelineFile, structs_of
from optixc.codegen.cpp_scalar import ScalarFunction
from optixc.codegen.cpp_signatures import used_parameters
from optixc.codegen.cpp_spmd import LaneFunction
from optixc.codegen.cpp_spmd_clones import Clones
from optixc.codegen.cpp_spmd_expr import ATTRIBUTE_GETTER
from optixc.codegen.cpp_spmd_types import WideTypes
from optixc.codegen.helper_calls import callees_first
from optixc.codegen.needs import EXCEPTION_FLAG_STACK_OVERFLOW, REPORT, options_of
from optixc.codegen.program_classes import ProgramClass, callables_nest
from optixc.ir.intrinsic_rows import INTRINSICS
from optixc.ir.intrinsics import State
from optixc.ir.layout import payload_words
from optixc.ir.nodes import CallCallable, CallIntrinsic, Function, IntrinsicCall, ParameterRole, Pipeline
from optixc.ir.programs import ProgramKind
from optixc.ir.types import Struct, Void
from optixc.ir.walk import called_intrinsics, expressions, statements
from optixc.passes.callables import CallableSignature, callables_with, signatures_called
from optixc.passes.features import Features
from optixc.passes.traced_programs import payload_of, reachable_functions, traces_of, words_by_number
from optixc.passes.uniformity import COMMON_IN_INTERSECTION, Clone, Key

_OF_RAY = frozenset(
    """get_world_ray_origin get_world_ray_direction get_object_ray_origin get_object_ray_direction get_ray_tmin get_ray_tmax get_ray_time
    get_ray_flags get_ray_visibility_mask""".split()
)
_ALSO_SCALAR = (ProgramKind.ANYHIT, ProgramKind.INTERSECTION)


def spmd_obstacle(pipeline: Pipeline) -> str | None:
    """What keeps the pipeline from running over lanes, in the words of the report; None if nothing does."""
    for program in pipeline.programs:
        if program.kind in _ALSO_SCALAR:
            reached = (s for f in reachable_functions(pipeline, program) for s in statements(f.body))
            if any(isinstance(statement, CallCallable) for statement in reached):
                return "callables called by any-hit or intersection programs"
    return None


class SpmdFile(PipelineFile):
    """Writes one pipeline with the SPMD emitter."""

    def __init__(self, pipeline: Pipeline, features: Features) -> None:
        super().__init__(pipeline, features)
        for name in ("mask", "returned", "result", "lane", "one"):
            self._scope.name(name)
        self._wide = WideTypes(self._types, structs_of(pipeline), pipeline.options.lanes, self._scope)
        self._clones = Clones(pipeline, self._wide, self._signatures, self._scope)
        self._throws = options_of(pipeline).traces_throw

    def text(self) -> str:
        order = self._functions_over_lanes()
        self._head()
        self._writer.line(f"#include <oxrt/{'lanes_make_hit' if self._features.has('hit objects') else 'lanes_trace'}.h>")
        if self._features.has("cooperative vectors"):
            self._writer.line("#include <oxrt/lanes_coop_vec.h>")
        self._writer.line()
        self._writer.line("namespace {")
        self._writer.line()
        self._wide.aliases(self._writer)
        self._types.definitions(self._writer)
        self._wide.declarations(self._writer)
        self._wide.definitions(self._writer)
        self._declare_programs()
        scalar = self._scalar_functions()
        self._declare_functions([function for function in scalar if function.kind is None], ())
        for programs in self._classes.values():
            self._declare_lane_class(programs)
        options = options_of(self._pipeline)
        for function in scalar:
            ScalarFunction(self._writer, function, self._types, self._signatures, options).write()
        for signature in signatures_called(self._pipeline):
            self._dispatch.declare_with_place(self._callable_head(signature))
        for clone in order:
            if clone.function.kind is None:
                self._writer.line(f"{self._clones.head(clone, self._signatures.inner_names(clone.function))};")
        self._writer.line()
        for clone in order:
            LaneFunction(self._writer, clone, self._wide, self._clones, self._signatures, options).write()
        for programs in self._classes.values():
            noticed = programs.noticed - {ProgramKind.CLOSESTHIT, ProgramKind.MISS}
            self._dispatch.define_class(replace(programs, closesthit=(), miss=(), noticed=noticed))
            self._define_lane_class(programs)
        for signature in signatures_called(self._pipeline):
            self._define_callable(signature)
        for program in self._pipeline.programs:
            if program.kind is ProgramKind.RAYGEN:
                self._lane_entry(program)
        self._tables()
        self._writer.line("}  // namespace")
        self._writer.line()
        self._exported_symbol()
        return self._writer.text()

    # ---- which functions -----------------------------------------------------------------------------------------------------

    def _functions_over_lanes(self) -> list[Clone]:
        """Every clone that programs over lanes reach, callees first."""
        ordered: dict[Key, Clone] = {}
        entered: set[Key] = set()

        def visit(clone: Clone) -> None:
            if clone.key in entered:
                return
            entered.add(clone.key)
            for callee in self._clones.callees(clone):
                visit(callee)
            ordered[clone.key] = clone

        for program in self._pipeline.programs:
            if program.kind is not ProgramKind.EXCEPTION:
                visit(self._clones.analysis.program(program))
        return list(ordered.values())

    def _scalar_functions(self) -> list[Function]:
        """Any-hit, intersection and exception programs, and the helpers that they or uniform calls need."""
        single = {p.name for programs in self._classes.values() for p in (*programs.anyhit, *programs.intersection)}
        throwing = {p.name for p in self._pipeline.programs if p.kind is ProgramKind.EXCEPTION and self._throws}
        programs = [program for program in self._pipeline.programs if program.name in single | throwing]
        needed = {f.name for program in programs for f in reachable_functions(self._pipeline, program)} | set(self._clones.scalar)
        helpers = [helper for helper in callees_first(self._pipeline.helpers) if helper.name in needed]
        return [*helpers, *programs]

    # ---- classes of programs -------------------------------------------------------------------------------------------------

    def _declare_lane_class(self, programs: ProgramClass) -> None:
        name = self._signatures.program_class(programs.payload)
        payload = f"Wide<{self._types.struct(programs.payload)}>" if programs.payload is not None else "oxrt::NoPayload"
        with self._writer.block(f"struct {name}Lanes : oxrt::NoLanePrograms", tail="};"):
            self._writer.line(f"using Scalar = {name};")
            self._writer.line(f"using Payload = {payload};")
            if any(words_by_number(self._pipeline, program) for _, functions in programs.present for program in functions):
                self._writer.line("static constexpr bool usesPayloadWords = true;")
            if any(_uses_payload(self._pipeline, program) for program in (*programs.anyhit, *programs.intersection)):
                self._writer.line("static constexpr bool callbacksUsePayload = true;")
            if programs.intersection and any(_reads_hit(self._pipeline, p) for p in (*programs.anyhit, *programs.intersection)):
                self._writer.line("static constexpr bool callbacksReadHit = true;")
            words = max((_reported_words(self._pipeline, program) for program in programs.intersection), default=0)
            if words and _reads_attributes(self._pipeline, programs):
                self._writer.line(f"static constexpr int attributeWords = {words};")
            for kind, _ in programs.present:
                record = ", const OxrtRecordHeader& record" if kind is ProgramKind.INTERSECTION else ""
                self._writer.line(f"static void {FUNCTIONS[kind]}(Rays& trace, Mask mask, Payload& payload{record});")
        self._writer.line()

    def _define_lane_class(self, programs: ProgramClass) -> None:
        owner = f"{self._signatures.program_class(programs.payload)}Lanes"
        for kind, functions in programs.present:
            mask = "mask" if kind is ProgramKind.INTERSECTION else "own"
            calls = [(function, self._lane_call(function, programs.payload, owner, mask)) for function in functions]
            payload = "Payload& payload" if any("payload" in call for _, call in calls) else "Payload&"
            if kind is ProgramKind.INTERSECTION:
                self._define_intersection(owner, calls, payload)
            else:
                self._define_masked(f"{owner}::{FUNCTIONS[kind]}", SLOTS[kind], calls, payload)
            self._writer.line()

    def _define_intersection(self, owner: str, calls: list[tuple[Function, str]], payload: str) -> None:
        """One record for all lanes: as in scalar code."""
        head = f"void {owner}::intersection(Rays& trace, Mask mask, {payload}, const OxrtRecordHeader& record)"
        with self._writer.block(head), self._writer.block(f"switch (record.programs[{SLOTS[ProgramKind.INTERSECTION]}])"):
            for function, call in calls:
                self._writer.line(f"case {self._dispatch.number(function)}: {call}; break;")
            if self._pipeline.options.validation:
                self._writer.line("case OXRT_NO_PROGRAM: break;")
                self._writer.line("default: oxrt::payloadMismatch(trace, mask); break;")
            else:
                self._writer.line("default: break;")

    def _define_masked(self, name: str, slot: str, calls: list[tuple[Function, str]], payload: str) -> None:
        """Each program for the lanes whose record names it."""
        with self._writer.block(f"void {name}(Rays& trace, Mask mask, {payload})"):
            self._writer.line(f"const Wide<int32_t> program = oxrt::recordPrograms(trace.records, mask, {slot});")
            for function, call in calls:
                number = self._dispatch.number(function)
                self._writer.line(f"if (const Mask own = mask & (program == int32_t({number})); oxrt::any(own))")
                with self._writer.indented():
                    self._writer.line(f"{call};")
            if self._pipeline.options.validation:
                numbers = [*(self._dispatch.number(function) for function, _ in calls), "OXRT_NO_PROGRAM"]
                known = " | ".join(f"(program == int32_t({number}))" for number in numbers)
                self._writer.line(f"oxrt::payloadMismatch(trace, mask & !({known}));")

    def _lane_call(self, program: Function, payload: Struct | None, owner: str, mask: str) -> str:
        clone = self._clones.analysis.program(program)
        arguments = ["trace" if self._signatures.needs(program.name).ray else "*trace.thread", mask]
        own = payload_of(program)
        for parameter in program.parameters:
            type_ = self._types.name(parameter.local.type)
            match parameter.role:
                case ParameterRole.PAYLOAD:
                    carried = self._types.struct(payload) if payload is not None else ""
                    arguments.append("payload" if own == payload else f"oxrt::WidePayloadAs<{type_}, {carried}, LANES>(payload)")
                case ParameterRole.ATTRIBUTES:
                    arguments.append(f"oxrt::getAttributes<{type_}>(trace)")
                case ParameterRole.RECORD:
                    is_one = program.kind is ProgramKind.INTERSECTION
                    arguments.append(
                        f"oxrt::recordData<{type_}>(record)" if is_one else f"oxrt::loadRecord<{type_}>(trace.records, {mask})"
                    )
                case ParameterRole.VALUE:
                    raise AssertionError(f"{program.name} has an ordinary parameter")
        template = f"<{owner}>" if self._signatures.needs(program.name).programs else ""
        return f"{self._clones.name(clone)}{template}({', '.join(arguments)})"

    # ---- callables -----------------------------------------------------------------------------------------------------------

    def _callable_head(self, signature: CallableSignature) -> str:
        name = self._signatures.dispatcher_of(signature)
        arguments = ["Lanes& thread", "Mask mask", "Wide<uint32_t> index"]
        for position, type_ in enumerate(signature.arguments):
            text = self._wide.name(type_, True)
            arguments.append(f"const {text}& a{position}")
        if self._dispatch.tells_place:
            arguments.append("oxrt::Place place")
        return f"{self._wide.name(signature.result, True)} {name}_lanes({', '.join(arguments)})"

    def _define_callable(self, signature: CallableSignature) -> None:
        """Runs the callables of the records that the lanes name; lanes without one get zero, and a fault in validation."""
        slot = 0 if signature.is_direct else 1
        is_void = isinstance(signature.result, Void)
        with self._writer.block(self._callable_head(signature)):
            if not is_void:
                result = self._types.name(signature.result)
                self._writer.line(f"{self._wide.name(signature.result, True)} result = oxrt::spread<LANES>({result}{{}});")
            if callables_nest(self._pipeline):
                self._guard_stack(is_void)
            self._writer.line("oxrt::RecordLanes<LANES> records;")
            place = ", place" if self._dispatch.tells_place else ""
            self._writer.line(f"const Mask found = oxrt::findCallables(thread, records, mask, index, {slot}{place});")
            with self._writer.block("if (oxrt::none(found))"):
                self._writer.line("return;" if is_void else "return result;")
            self._writer.line(f"const Wide<int32_t> program = oxrt::recordPrograms(records, found, {slot});")
            if self._pipeline.options.validation:
                self._writer.line("Mask other = found;")
            for program in callables_with(self._pipeline, signature):
                call = self._callable_call(program)
                number = self._dispatch.number(program)
                self._writer.line(f"if (const Mask own = found & (program == int32_t({number})); oxrt::any(own))")
                with self._writer.indented():
                    self._writer.line(f"{call};" if is_void else f"oxrt::assign(own, result, {call});")
                if self._pipeline.options.validation:
                    self._writer.line(f"other = oxrt::without(other, program == int32_t({number}));")
            if self._pipeline.options.validation:
                mismatch = "oxrt::callableMismatch(thread.atLane(lane), place);"
                self._writer.line(f"oxrt::eachLane(other, [&](int lane) {{ {mismatch} }});")
            if not is_void:
                self._writer.line("return result;")
        self._writer.line()

    def _guard_stack(self, is_void: bool) -> None:
        """Callables may call each other without end: a full stack ends the lanes, by an exception where the pipeline asks for it."""
        throws = bool(self._pipeline.options.exception_flags & EXCEPTION_FLAG_STACK_OVERFLOW)
        with self._writer.block("if (oxrt::isStackFull(*thread.thread))"):
            lane = "thread.atLane(oxrt::firstLane(mask))"
            self._writer.line(f"oxrt::overflowStack<{'true' if throws else 'false'}>({lane}, place);")
            if throws:
                self._writer.line("oxrt::takeExceptions(thread, mask);")
            self._writer.line("return;" if is_void else "return result;")

    def _callable_call(self, program: Function) -> str:
        clone = self._clones.analysis.program(program)
        arguments = ["thread", "own"]
        position = 0
        for parameter in program.parameters:
            if parameter.role is ParameterRole.RECORD:
                arguments.append(f"oxrt::loadRecord<{self._types.name(parameter.local.type)}>(records, own)")
            else:
                arguments.append(f"a{position}")
                position += 1
        return f"{self._clones.name(clone)}({', '.join(arguments)})"

    # ---- launches ------------------------------------------------------------------------------------------------------------

    def _lane_entry(self, program: Function) -> None:
        """The loop over the blocks of a tile."""
        clone = self._clones.analysis.program(program)
        # Where exception programs run behind it, `thread` is the one that threw.
        thread = "caller" if self._throws else "thread"
        records = [
            f"oxrt::recordAt<{self._types.name(parameter.local.type)}>({thread}->launch->raygenRecord)"
            for parameter in program.parameters
            if parameter.role is ParameterRole.RECORD
        ]
        head = f"void run_{self._signatures.function(program.name)}(OxrtThread* {thread}, const OxrtTile* tile)"
        loop = f"oxrt::runBlocks<LANES>(*{thread}, *tile, [{thread if records else ''}](Lanes& lanes, Mask mask)"
        with self._writer.block(head), self._writer.block(loop, tail="});"):
            self._writer.line(f"{self._clones.name(clone)}({', '.join(['lanes', 'mask', *records])});")
            if self._throws:
                self._run_exceptions()
        self._writer.line()

    def _run_exceptions(self) -> None:
        """Behind the program: lanes that threw run the exception program of the SBT, one by one."""
        exceptions = [p for p in self._pipeline.programs if p.kind is ProgramKind.EXCEPTION]
        with self._writer.block("oxrt::eachLane(lanes.thrown, [&](int lane)", tail="});"):
            self._writer.line("OxrtThread* thread = &oxrt::throwingLane(lanes, lane);")
            with self._writer.block("switch (oxrt::takeException(*thread))"):
                for program in exceptions:
                    call = self._call(program, "thread->launch->exceptionRecord")
                    self._writer.line(f"case {self._dispatch.number(program)}: {call}; break;")
                self._writer.line("default: break;")

    def _lanes(self) -> int:
        return self._pipeline.options.lanes


def _reads_hit(pipeline: Pipeline, program: Function) -> bool:
    """Whether an any-hit or intersection program asks for more than the ray; intersection programs also have what their lanes share."""
    elsewhere = _OF_RAY | (COMMON_IN_INTERSECTION if program.kind is ProgramKind.INTERSECTION else frozenset())
    asked = (e.name for f in reachable_functions(pipeline, program) for e in expressions(f.body) if isinstance(e, IntrinsicCall))
    return any(INTRINSICS[name].state is State.RAY and name not in elsewhere for name in asked)


def _uses_payload(pipeline: Pipeline, program: Function) -> bool:
    """Whether the program reads or writes the payload."""
    names = {p.local.name for p in program.parameters if p.role is ParameterRole.PAYLOAD}
    return bool(names & used_parameters(program)) or words_by_number(pipeline, program) > 0


def _reads_attributes(pipeline: Pipeline, programs: ProgramClass) -> bool:
    """Whether a program of the class asks for attributes, or a hit object may keep them for one of another class."""
    if any(trace.name != "trace" for _, trace in traces_of(pipeline)):
        return True
    for program in (*programs.anyhit, *programs.closesthit):
        given = {parameter.local.name for parameter in program.parameters if parameter.role is ParameterRole.ATTRIBUTES}
        if given & used_parameters(program):
            return True
        asked = (name for function in reachable_functions(pipeline, program) for name in called_intrinsics(function.body))
        if any(name.startswith(ATTRIBUTE_GETTER) for name in asked):
            return True
    return False


def _reported_words(pipeline: Pipeline, program: Function) -> int:
    """The most attribute words that the program or a helper reports at once."""
    most = 0
    for function in reachable_functions(pipeline, program):
        for statement in statements(function.body):
            if isinstance(statement, CallIntrinsic) and statement.name == REPORT:
                offered = statement.arguments[2:]
                is_struct = len(offered) == 1 and isinstance(offered[0].type, Struct)
                most = max(most, payload_words(offered[0].type) if is_struct else len(offered))
    return most
