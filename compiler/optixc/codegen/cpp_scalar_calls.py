"""Calls of the scalar emitter that act: helpers, device functions with effects, traces, callables."""

from __future__ import annotations

from optixc.codegen.cpp_coop_vec import checked_spans, memory_call, values_of
from optixc.codegen.cpp_expr import Expressions, part_of
from optixc.codegen.cpp_signatures import FunctionNames, Signatures
from optixc.codegen.cpp_types import TypeNames
from optixc.codegen.names import Scope, string_literal
from optixc.codegen.needs import REPORT, THROW, Options
from optixc.ir.intrinsic_rows import ATOMIC_NAMES, INTRINSICS
from optixc.ir.intrinsic_rows_coop_vec import COOP_VEC_NAMES
from optixc.ir.intrinsics import Effect, Intrinsic, State
from optixc.ir.nodes import (
    CallCallable,
    CallHelper,
    CallIntrinsic,
    ElementRef,
    Expr,
    FieldRef,
    Function,
    IndexRef,
    Literal,
    LocalRef,
    ParamsRef,
    Trace,
    is_reference_type,
)
from optixc.ir.types import Struct
from optixc.ir.walk import chosen_items, expressions, place_origin
from optixc.passes.traced_programs import known_flags

_FLAGS_ARGUMENT = 7


def timed(row: Intrinsic, arguments: list[str], options: Options) -> list[str]:
    """The arguments of a device function; the time of a ray is 0 in pipelines without motion."""
    if options.uses_motion or row.state is not State.HIT_OBJECT:
        return arguments
    return ["0.0f" if parameter.name == "ray_time" else text for parameter, text in zip(row.parameters, arguments, strict=True)]


class ScalarCalls:
    """Texts of the calls of one function, and after which of them it returns."""

    def __init__(
        self, function: Function, names: FunctionNames, printer: Expressions, signatures: Signatures, types: TypeNames, options: Options
    ) -> None:
        self._function = function
        self._names = names
        self._expressions = printer
        self._signatures = signatures
        self._types = types
        self._options = options
        hidden = (names.thread, names.trace, names.params, names.hit_object)
        self._scope = Scope(taken=(*names.locals.values(), *hidden))

    def fresh(self, wanted: str) -> str:
        """A name for a local of the emitter's own."""
        return self._scope.name(wanted)

    def params_struct(self) -> Struct:
        """The launch parameters that the function reads."""
        return next(expression.type for expression in expressions(self._function.body) if isinstance(expression, ParamsRef))

    def ending(self, statement: CallHelper | CallIntrinsic | CallCallable | Trace) -> str | None:
        """The condition under which the function returns after the call; "" for always, None for never."""
        match statement:
            case CallIntrinsic(name=name):
                if name == REPORT:
                    return self._has_ended()
                is_end = INTRINSICS[name].effect in (Effect.ENDS_PROGRAM, Effect.ENDS_LAUNCH_INDEX)
                return "" if is_end else None
            case CallHelper(function=function):
                needs = self._signatures.needs(function)
                conditions = [self._has_ended()] if needs.ends else []
                if needs.throws:
                    conditions.append(self._is_pending())
                return " || ".join(conditions) or None
            case CallCallable() | Trace():
                return self._is_pending() if self._options.traces_throw else None

    def guard(self, place: Expr) -> str | None:
        """The condition under which a place exists, in checked builds; None where it always does."""
        if not self._options.checks_elements:
            return None
        conditions, element = [], place_origin(place)
        if isinstance(element, ElementRef):
            indices = ", ".join(self._expressions.text(index) for index in element.indices)
            conditions.append(f"oxrt::checked({self._names.thread}).contains({self._expressions.text(element.array)}, {indices})")
        for item in chosen_items(place) if self._options.is_checked else ():
            base, index = self._expressions.place(item.base), self._expressions.text(item.index)
            conditions.append(f"oxrt::checked({self._names.thread}).containsItem({base}, {index})")
        return " && ".join(conditions) or None

    def _has_ended(self) -> str:
        return f"oxrt::hasEnded({self._names.trace})"

    def _is_pending(self) -> str:
        return f"{self._names.thread}.exceptionPending"

    # ---- texts ---------------------------------------------------------------------------------------------------------------

    def helper(self, statement: CallHelper) -> str:
        hidden = self._signatures.hidden_arguments(statement.function, self._names)
        arguments = [self._argument(argument) for argument in statement.arguments]
        return f"{self._signatures.callee(statement.function)}({', '.join([*hidden, *arguments])})"

    def intrinsic(self, statement: CallIntrinsic) -> str | None:
        """None for a call that does nothing in this pipeline."""
        row = INTRINSICS[statement.name]
        if statement.name in COOP_VEC_NAMES:
            spans = checked_spans(statement, [self._names.thread]) if self._options.checks_elements else "oxrt::anySpan"
            return memory_call(statement, self._types, spans, [self._expressions.text(value) for value in values_of(statement)])
        arguments = [self._expressions.text(argument) for argument in statement.arguments]
        if statement.name == REPORT:
            return self._report(statement, arguments)
        if statement.name == THROW:
            return self._throw(statement, arguments)
        if statement.name in ATOMIC_NAMES:
            return self._atomic(statement, arguments)
        arguments = timed(row, arguments, self._options)
        hidden = {
            State.NONE: [],
            State.THREAD: [self._names.thread],
            State.RAY: [self._names.trace],
            State.HIT_OBJECT: [self._names.hit_object],
        }[row.state]
        return f"{row.cpp}({', '.join([*hidden, *arguments])})"

    def _atomic(self, statement: CallIntrinsic, arguments: list[str]) -> str:
        """The first argument is the element's place; where it is checked and does not exist, the result is zero."""
        place = statement.arguments[0]
        call = f"{INTRINSICS[statement.name].cpp}({', '.join([self._expressions.place(place), *arguments[1:]])})"
        guard = self.guard(place)
        return call if guard is None else f"{guard} ? {call} : {self._types.name(place.type)}()"

    def _report(self, statement: CallIntrinsic, arguments: list[str]) -> str:
        offered = statement.arguments[2:]
        words = arguments[:2]
        if offered:
            is_struct = len(offered) == 1 and isinstance(offered[0].type, Struct)
            words.append(arguments[2] if is_struct else f"oxrt::attributeWords({', '.join(arguments[2:])})")
        return f"oxrt::reportIntersection<Programs>({self._names.trace}, {', '.join(words)})"

    def _throw(self, statement: CallIntrinsic, arguments: list[str]) -> str | None:
        if not self._options.user_exceptions:
            return None
        place = string_literal(f"{statement.span.path}:{statement.span.line}")
        return f"oxrt::throwException({', '.join([self._names.thread, place, *arguments])})"

    def callable(self, statement: CallCallable) -> str:
        name = self._signatures.dispatcher(statement)
        arguments = [self._names.thread, self._expressions.text(statement.index)]
        return f"{name}({', '.join([*arguments, *(self._argument(argument) for argument in statement.arguments)])})"

    def trace(self, statement: Trace) -> str:
        programs = self._signatures.program_class(statement.payload_type)
        payload = "oxrt::noPayload" if statement.payload is None else self._reference(statement.payload)
        arguments = [self._expressions.text(argument) for argument in statement.arguments]
        if arguments:
            flags = known_flags(statement)
            if flags is not None:
                arguments[_FLAGS_ARGUMENT] = f"oxrt::KnownFlags<{flags & 0xFFFF}>()"
        hit_object = [] if statement.name == "trace" else [self._names.hit_object]
        words = [self._names.thread, *hit_object, *arguments, payload]
        return f"oxrt::{statement.name}<{programs}>({', '.join(words)})"

    def _argument(self, argument: Expr) -> str:
        """An argument of a helper; structs and fixed arrays stay places, so that they can be passed by reference."""
        is_place = is_reference_type(argument.type) and isinstance(argument, LocalRef | FieldRef | IndexRef | ElementRef)
        return self._reference(argument) if is_place else self._expressions.text(argument)

    def _reference(self, place: Expr) -> str:
        """A place that is passed by reference; in checked builds one that exists in any case."""
        match place:
            case FieldRef(base=base):
                return part_of(place, self._reference(base))
            case IndexRef(base=base, index=index) if self._options.is_checked and not isinstance(index, Literal):
                return f"oxrt::checked({self._names.thread}).itemPlace({self._reference(base)}, {self._expressions.text(index)})"
            case _:
                return self._expressions.place(place)
