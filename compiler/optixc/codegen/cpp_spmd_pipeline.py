"""The C++ file of a pipeline whose launch indices run 8 or 16 at a time.

Any-hit and intersection programs stay scalar: Embree calls them for one ray at a time (`lanes_trace.h` says why); everything else is
written over lanes. `spmd_obstacle` names what a pipeline uses that has no form over lanes yet; such a pipeline is emitted scalar.
"""

from __future__ import annotations

from dataclasses import replace

from optixc.codegen.cpp_dispatch import FUNCTIONS, SLOTS
from optixc.codegen.cpp_pipeline import PipelineFile, callees_first, structs_of
from optixc.codegen.cpp_scalar import ScalarFunction
from optixc.codegen.cpp_spmd import LaneFunction
from optixc.codegen.cpp_spmd_clones import Clones, Key
from optixc.codegen.cpp_spmd_types import WideTypes
from optixc.codegen.needs import options_of
from optixc.codegen.program_classes import ProgramClass, payload_of, reachable_functions
from optixc.ir.intrinsic_rows import INTRINSICS
from optixc.ir.intrinsics import State
from optixc.ir.nodes import CallCallable, CallIntrinsic, Function, IntrinsicCall, ParameterRole, Pipeline, Trace
from optixc.ir.programs import ProgramKind
from optixc.ir.types import Struct
from optixc.ir.walk import expressions, statements
from optixc.passes.features import Features
from optixc.passes.uniformity import Clone

_OVER_LANES = (ProgramKind.RAYGEN, ProgramKind.MISS, ProgramKind.CLOSESTHIT)
_SCALAR = (ProgramKind.ANYHIT, ProgramKind.INTERSECTION)
_PAYLOAD_WORDS = ("get_payload_", "set_payload_")


def spmd_obstacle(pipeline: Pipeline) -> str | None:
    """What keeps the pipeline from running over lanes, in the words of the report; None if nothing does."""
    if pipeline.options.exception_flags:
        return "exceptions"
    for program in pipeline.programs:
        if program.kind not in (*_OVER_LANES, *_SCALAR):
            return f"{program.kind.value.replace('_', ' ')} programs" if program.kind is not None else "a helper"
        for function in reachable_functions(pipeline, program):
            found = _obstacle_in(function, program.kind in _SCALAR)
            if found is not None:
                return found
    return None


def _obstacle_in(function: Function, is_scalar: bool) -> str | None:
    names = [e.name for e in expressions(function.body) if isinstance(e, IntrinsicCall)]
    for statement in statements(function.body):
        if isinstance(statement, CallCallable):
            return "callables"
        if isinstance(statement, Trace) and statement.name != "trace":
            return "hit objects"
        if isinstance(statement, CallIntrinsic):
            names.append(statement.name)
    for name in names:
        if INTRINSICS[name].state is State.HIT_OBJECT:
            return "hit objects"
        if not is_scalar and name.startswith(_PAYLOAD_WORDS):
            return "payload registers by number"
    return None


class SpmdFile(PipelineFile):
    """Writes one pipeline with the SPMD emitter."""

    def __init__(self, pipeline: Pipeline, features: Features) -> None:
        super().__init__(pipeline, features)
        for name in ("LANES", "Wide", "Mask", "Lanes", "Rays", "mask", "returned", "result", "lane", "one"):
            self._scope.name(name)
        self._wide = WideTypes(self._types, structs_of(pipeline), pipeline.options.lanes)
        self._clones = Clones(pipeline, self._wide, self._signatures, self._scope)
        self._by_name: dict[Key, Clone] = {}

    def text(self) -> str:
        order = self._functions_over_lanes()
        self._head()
        self._writer.line("#include <oxrt/lanes_trace.h>")
        self._writer.line()
        self._writer.line("namespace {")
        self._writer.line()
        self._wide.aliases(self._writer)
        self._types.definitions(self._writer)
        self._wide.declarations(self._writer)
        self._wide.definitions(self._writer)
        self._declarations()
        for programs in self._classes.values():
            self._declare_lane_class(programs)
        options = options_of(self._pipeline)
        for function in self._scalar_functions():
            ScalarFunction(self._writer, function, self._types, self._signatures, options).write()
        for clone in order:
            if clone.function.kind is None:
                self._writer.line(f"{self._clones.head(clone, self._signatures.inner_names(clone.function))};")
        self._writer.line()
        for clone in order:
            LaneFunction(self._writer, clone, self._wide, self._clones, self._signatures, options).write()
        for programs in self._classes.values():
            self._dispatch.define_class(replace(programs, closesthit=(), miss=()))
            self._define_lane_class(programs)
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
            if program.kind in _OVER_LANES:
                visit(self._clones.analysis.program(program))
        return list(ordered.values())

    def _scalar_functions(self) -> list[Function]:
        """Any-hit and intersection programs, and the helpers that they or uniform calls need."""
        programs = [program for program in self._pipeline.programs if program.kind in _SCALAR]
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
            for kind, _ in _present(programs):
                self._writer.line(f"static void {FUNCTIONS[kind]}(Rays& trace, Mask mask, Payload& payload);")
        self._writer.line()

    def _define_lane_class(self, programs: ProgramClass) -> None:
        owner = f"{self._signatures.program_class(programs.payload)}Lanes"
        for kind, functions in _present(programs):
            calls = [(function, self._lane_call(function, programs.payload)) for function in functions]
            payload = "Payload& payload" if any("payload" in call for _, call in calls) else "Payload&"
            with self._writer.block(f"void {owner}::{FUNCTIONS[kind]}(Rays& trace, Mask mask, {payload})"):
                self._writer.line(f"const Wide<int32_t> program = oxrt::recordPrograms(trace, mask, {SLOTS[kind]});")
                for function, call in calls:
                    self._writer.line(f"if (const Mask own = mask & (program == int32_t({self._dispatch.number(function)})); oxrt::any(own))")
                    with self._writer.indented():
                        self._writer.line(f"{call};")
                if self._pipeline.options.validation:
                    known = " | ".join(f"(program == int32_t({self._dispatch.number(function)}))" for function in functions)
                    self._writer.line(f"oxrt::payloadMismatch(trace, mask & !({known} | (program == int32_t(OXRT_NO_PROGRAM))));")
            self._writer.line()

    def _lane_call(self, program: Function, payload: Struct | None) -> str:
        clone = self._clones.analysis.program(program)
        arguments = ["trace" if self._signatures.needs(program.name).ray else "*trace.thread", "own"]
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
                    arguments.append(f"oxrt::loadRecord<{type_}>(trace, own)")
                case ParameterRole.VALUE:
                    raise AssertionError(f"{program.name} has an ordinary parameter")
        return f"{self._clones.name(clone)}({', '.join(arguments)})"

    # ---- launches ------------------------------------------------------------------------------------------------------------

    def _lane_entry(self, program: Function) -> None:
        """The loop over the blocks of a tile."""
        clone = self._clones.analysis.program(program)
        records = [
            f"oxrt::recordAt<{self._types.name(parameter.local.type)}>(thread->launch->raygenRecord)"
            for parameter in program.parameters
            if parameter.role is ParameterRole.RECORD
        ]
        with self._writer.block(f"void run_{self._signatures.function(program.name)}(OxrtThread* thread, const OxrtTile* tile)"):
            with self._writer.block(f"oxrt::runBlocks<LANES>(*thread, *tile, [{'thread' if records else ''}](Lanes& lanes, Mask mask)", tail="});"):
                self._writer.line(f"{self._clones.name(clone)}({', '.join(['lanes', 'mask', *records])});")
        self._writer.line()

    def _variant(self) -> str:
        lanes = self._pipeline.options.lanes
        isa = "OXRT_ISA_X86_64_V4" if lanes == 16 else "OXRT_ISA_X86_64_V3"
        return f"{{{isa}, {lanes}, programs, {len(self._pipeline.programs)}}}"


def _present(programs: ProgramClass) -> list[tuple[ProgramKind, tuple[Function, ...]]]:
    kinds = ((ProgramKind.CLOSESTHIT, programs.closesthit), (ProgramKind.MISS, programs.miss))
    return [(kind, functions) for kind, functions in kinds if functions]


