"""Calls and stores of the SPMD emitter that act: helpers, device functions with effects, traces, array elements."""

from __future__ import annotations

from optixc.codegen.cpp_coop_vec import checked_spans, memory_call, values_of
from optixc.codegen.cpp_expr import part_of
from optixc.codegen.cpp_scalar_calls import timed
from optixc.codegen.cpp_signatures import FunctionNames, Signatures
from optixc.codegen.cpp_spmd_expr import LaneExpressions
from optixc.codegen.cpp_spmd_items import ItemLoops, has_varying_index
from optixc.codegen.cpp_spmd_types import WideTypes
from optixc.codegen.names import string_literal
from optixc.codegen.needs import REPORT, THROW, Options
from optixc.ir.intrinsic_rows import INTRINSICS
from optixc.ir.intrinsic_rows_coop_vec import COOP_VEC_NAMES
from optixc.ir.intrinsics import Effect, Intrinsic, State
from optixc.ir.nodes import (
    CallCallable,
    CallHelper,
    CallIntrinsic,
    ComponentRef,
    ElementRef,
    Expr,
    FieldRef,
    IndexRef,
    Literal,
    LocalRef,
    Print,
    Trace,
    is_reference_type,
)
from optixc.ir.types import FixedArray, Struct
from optixc.ir.walk import chosen_items
from optixc.passes.traced_programs import PAYLOAD_SETTER, known_flags
from optixc.passes.uniformity import Clone

_HANDLE_ARGUMENT, _FLAGS_ARGUMENT = 0, 7


class LaneCalls:
    """Texts of the calls of one clone."""

    def __init__(
        self, clone: Clone, names: FunctionNames, printer: LaneExpressions, signatures: Signatures, types: WideTypes, options: Options
    ) -> None:
        self._clone = clone
        self._names = names
        self._expressions = printer
        self._signatures = signatures
        self._types = types
        self._options = options

    @property
    def _mask(self) -> str:
        return self._expressions.lanes.mask

    # ---- stores --------------------------------------------------------------------------------------------------------------

    def store(self, target: Expr, element: ElementRef, value: Expr) -> str:
        """A store to an array element, or to a part of one."""
        array = self._expressions.text(element.array)
        indices = ", ".join(self._expressions.text(index) for index in element.indices)
        if target is element:
            wide = self._expressions.wide(value)
            if self._options.checks_elements:
                return f"oxrt::checked({self._names.thread}, {self._mask}).store({wide}, {array}, {indices});"
            return f"oxrt::store<LANES>({self._mask}, {wide}, {array}, {indices});"
        part = self._part(target, element)
        setting = f"[&, value = {self._expressions.wide(value)}](auto& element, int lane) {{ oxrt::extractLane({part}, value, lane); }}"
        inside = f"oxrt::checked({self._names.thread}, {self._mask}).inside({array}, {indices})"
        return f"oxrt::eachElement<LANES>({inside if self._options.checks_elements else self._mask}, {setting}, {array}, {indices});"

    def _part(self, place: Expr, element: ElementRef) -> str:
        """A part of the scalar `element` of one lane."""
        match place:
            case FieldRef(base=base) | ComponentRef(base=base, components=(_,)):
                return part_of(place, self._part(base, element))
            case IndexRef(base=base, index=index):
                inner, position = self._part(base, element), f"oxrt::inLane({self._expressions.text(index)}, lane)"
                if self._options.is_checked and isinstance(base.type, FixedArray) and not isinstance(index, Literal):
                    return f"oxrt::checked({self._names.thread}.atLane(lane)).itemPlace({inner}, {position})"
                return f"{inner}[{position}]"
            case _:
                assert place is element
                return "element"

    def store_item(self, target: Expr, value: Expr) -> str:
        """A store to an item of a local's fixed array, vector or matrix by an index that varies, or to a part of that item."""
        loops = self._loops(self._expressions.stored(self._expressions.wide(value), value, target.type))
        place = loops.place(target)
        return loops.around(f"oxrt::assign({loops.mask}, {place}, value);")

    def has_varying_index(self, place: Expr) -> bool:
        """Whether lanes name different items on the way to a place of a local."""
        return has_varying_index(self._expressions, place)

    def _loops(self, value: str = "") -> ItemLoops:
        checked = f"oxrt::checked({self._names.thread}, {{}})" if self._options.is_checked else ""
        return ItemLoops(self._expressions, self._names.locals.values(), value, checked)

    def guard(self, place: Expr) -> str | None:
        """The condition under which the items on the way to a place of a local exist, in checked builds; None where they always do."""
        items = chosen_items(place) if self._options.is_checked else []
        texts = (f"{self._expressions.place(item.base)}, {self._expressions.text(item.index)}" for item in items)
        checked = f"oxrt::checked({self._names.thread}, {self._mask})"
        return " && ".join(f"oxrt::any({checked}.insideItems({text}))" for text in texts) or None

    # ---- calls ---------------------------------------------------------------------------------------------------------------

    def helper(self, statement: CallHelper) -> tuple[str, bool]:
        """The text, and whether the result varies."""
        arguments = tuple(self._argument(argument) for argument in statement.arguments)
        callee = self._expressions.lanes.callee(statement.function, statement.arguments)
        return self._expressions.lanes.helper_call(statement.function, statement.arguments, arguments), callee.result_varies

    def helper_on_items(self, statement: CallHelper, target: str | None) -> str | None:
        """The call for the lanes of one item after the other, where a place that the helper changes has an index that varies; else None."""
        function, nodes = statement.function, statement.arguments
        callee = self._expressions.lanes.callee(function, nodes)
        written = [parameter.written and parameter.local.by_reference for parameter in callee.function.parameters]
        if not any(changes and self.has_varying_index(node) for changes, node in zip(written, nodes, strict=True)):
            return None
        loops = self._loops()
        places = tuple(loops.place(node) if self.has_varying_index(node) else self._argument(node) for node in nodes)
        with self._expressions.lanes.under(loops.mask):
            call = self._expressions.lanes.helper_call(function, nodes, places)
        return loops.around(f"{call};" if target is None else f"oxrt::assign({loops.mask}, {target}, {call});")

    def intrinsic(self, statement: CallIntrinsic) -> tuple[str, bool] | None:
        """A device function with an effect; those without a form over lanes are each lane's own call, lowest lane first. None for a
        call that does nothing in this pipeline."""
        row = INTRINSICS[statement.name]
        if statement.name in COOP_VEC_NAMES:
            return self._coop_vec(statement, row)
        arguments = [self._expressions.text(argument) for argument in statement.arguments]
        if statement.name == "set_payload_types" or (statement.name == THROW and not self._options.user_exceptions):
            return None
        if statement.name == THROW:
            place = string_literal(f"{statement.span.path}:{statement.span.line}")
            return f"oxrt::throwException({', '.join([self._names.thread, self._mask, place, *arguments])})", False
        if statement.name == REPORT:
            return self._report(statement, arguments), True
        if statement.name.startswith(PAYLOAD_SETTER):
            index = statement.name.removeprefix(PAYLOAD_SETTER)
            return f"oxrt::setPayloadWord({self._names.trace}, {self._mask}, {index}, {arguments[0]})", False
        if row.effect is Effect.ENDS_PROGRAM:
            return f"{row.cpp}({self._names.trace}, {self._mask})", False
        if row.state is State.HIT_OBJECT:
            wide = timed(row, [self._expressions.wide(argument) for argument in statement.arguments], self._options)
            return f"{row.cpp}({', '.join([self._names.hit_object, self._mask, *wide])})", False
        assert row.state in (State.NONE, State.THREAD), f"{statement.name} has no form over lanes"
        return self._lane_by_lane(statement, row)

    def _coop_vec(self, statement: CallIntrinsic, row: Intrinsic) -> tuple[str, bool]:
        """Memory of cooperative vectors; what all lanes read alike is read once."""
        thread = self._names.thread
        varies = row.effect is not Effect.READS or any(self._expressions.lanes.varies(argument) for argument in statement.arguments)
        if self._options.checks_elements:
            state = [thread, self._mask] if varies else [f"{thread}.atLane(oxrt::anyLane({self._mask}))"]
            spans = checked_spans(statement, state)
        else:
            spans = f"oxrt::spansOf({self._mask})" if varies else "oxrt::anySpan"
        arguments = [self._expressions.text(value) for value in values_of(statement)]
        return memory_call(statement, self._types.types, spans, arguments), varies

    def _lane_by_lane(self, statement: CallIntrinsic, row: Intrinsic) -> tuple[str, bool]:
        hidden = [f"{self._names.thread}.atLane(lane)"] if row.state is State.THREAD else []
        arguments = [f"oxrt::inLane({self._expressions.text(argument)}, lane)" for argument in statement.arguments]
        if isinstance(statement.arguments[0], ElementRef):
            element = statement.arguments[0]
            indices = ", ".join(f"oxrt::inLane({self._expressions.text(index)}, lane)" for index in element.indices)
            arguments[0] = f"oxrt::inLane({self._expressions.text(element.array)}, lane).at({indices})"
        mask = self._existing(statement)
        call = f"{row.cpp}({', '.join([*hidden, *arguments])})"
        if statement.target is None:
            return f"oxrt::eachLane({mask}, [&]([[maybe_unused]] int lane) {{ {call}; }})", True
        return f"oxrt::mapActive({mask}, [&]([[maybe_unused]] int lane) {{ return {call}; }})", True

    def _existing(self, statement: CallIntrinsic) -> str:
        """The lanes that make a call: where elements are checked, those whose element there is."""
        element = statement.arguments[0] if statement.arguments else None
        if not isinstance(element, ElementRef) or not self._options.checks_elements:
            return self._mask
        where = ", ".join(self._expressions.text(part) for part in (element.array, *element.indices))
        return f"oxrt::checked({self._names.thread}, {self._mask}).inside({where})"

    def _report(self, statement: CallIntrinsic, arguments: list[str]) -> str:
        offered = statement.arguments[2:]
        words = arguments[:2]
        if len(offered) == 1 and isinstance(offered[0].type, Struct):
            struct = self._types.types.struct(offered[0].type)
            words.append(f"oxrt::attributesToLanes<{struct}, LANES>({self._expressions.wide(offered[0])})")
        elif offered:
            words.append(f"oxrt::attributeLanes<LANES>({', '.join(self._expressions.wide(argument) for argument in offered)})")
        return f"oxrt::reportIntersection<Programs>({', '.join([self._names.trace, self._mask, *words])})"

    def callable(self, statement: CallCallable) -> tuple[str, bool]:
        name = f"{self._signatures.dispatcher(statement)}_lanes"
        arguments = [
            self._argument(argument) if self._expressions.lanes.varies(argument) else self._expressions.wide(argument)
            for argument in statement.arguments
        ]
        return f"{name}({', '.join([self._names.thread, self._mask, self._expressions.wide(statement.index), *arguments])})", True

    def gone(self, statement: CallHelper | CallIntrinsic | CallCallable | Trace) -> str | None:
        """The lanes for which a call ended the program or the launch index; None for all that made it."""
        thrown, ended = f"{self._names.thread}.thrown", f"oxrt::endedLanes({self._names.trace})"
        match statement:
            case CallIntrinsic(name=name):
                return ended if name == REPORT else None
            case CallHelper(function=function):
                needs = self._signatures.needs(function)
                return " | ".join([*([ended] if needs.ends else []), *([thrown] if needs.throws else [])])
            case CallCallable() | Trace():
                return thrown

    def print(self, statement: Print) -> str:
        items = [
            string_literal(item) if isinstance(item, str) else f"oxrt::inLane({self._expressions.text(item)}, lane)"
            for item in statement.items
        ]
        words = [f"{self._names.thread}.atLane(lane)", string_literal(statement.separator), string_literal(statement.end), *items]
        return f"oxrt::eachLane({self._mask}, [&](int lane) {{ oxrt::print({', '.join(words)}); }});"

    def trace(self, statement: Trace) -> list[str]:
        """The trace; where the handle or unknown flags vary, once for each value among the lanes."""
        programs = f"{self._signatures.program_class(statement.payload_type)}Lanes"
        loops, mask_of_all = self._loops(), self._mask
        payload = "oxrt::noPayload" if statement.payload is None else loops.place(statement.payload)
        arguments = [self._expressions.text(argument) for argument in statement.arguments]
        flags = known_flags(statement)
        mask = loops.mask
        heads: list[str] = []
        hit_object = [] if statement.name == "trace" else [self._names.hit_object]
        if statement.name == "invoke":
            return [loops.around(f"oxrt::invoke<{programs}>({', '.join([self._names.thread, mask, *hit_object, payload])});")]
        if flags is not None:
            arguments[_FLAGS_ARGUMENT] = f"oxrt::KnownFlags<{flags & 0xFFFF}>()"
        for position, name in ((_HANDLE_ARGUMENT, "handle"), (_FLAGS_ARGUMENT, "flags")):
            if self._expressions.lanes.varies(statement.arguments[position]):
                own = f"{name}Lanes"
                heads.append(f"oxrt::eachValue({mask}, {arguments[position]}, [&](auto {name}, Mask {own}) {{")
                arguments[position], mask = name, own
        call = f"oxrt::{statement.name}<{programs}>({', '.join([self._names.thread, mask, *hit_object, *arguments, payload])});"
        lines = [*heads, call, *("});" for _ in heads)]
        return lines if mask_of_all is loops.mask else [loops.around(" ".join(lines))]

    def _argument(self, argument: Expr) -> str:
        """An argument of a helper; structs and fixed arrays stay places, so that they can be passed by reference."""
        is_place = is_reference_type(argument.type) and isinstance(argument, LocalRef | FieldRef | IndexRef | ElementRef)
        is_loaded = self.has_varying_index(argument) or (isinstance(argument, ElementRef) and self._expressions.lanes.varies(argument))
        return self._loops().place(argument) if is_place and not is_loaded else self._expressions.text(argument)
