"""Functions of the SPMD emitter: statements of one clone, run by all lanes of a mask at once.

What all lanes agree on stays ordinary control flow. Where they differ, each block runs under a mask of its own and is skipped if no lane
wants it; break, continue and return take lanes out of masks. An assignment keeps the other lanes' values only if some lane outside of
the mask may still read the variable: inside of the region where a variable lives (`passes.regions`) it is a plain one.
"""

from __future__ import annotations

from typing import assert_never

from optixc.codegen.assertions import assertion_call
from optixc.codegen.cpp_expr import PRIMARY
from optixc.codegen.cpp_signatures import Signatures
from optixc.codegen.cpp_spmd_calls import LaneCalls
from optixc.codegen.cpp_spmd_clones import Clones
from optixc.codegen.cpp_spmd_expr import LaneDialect, LaneExpressions, spreads_itself
from optixc.codegen.cpp_spmd_types import WideTypes
from optixc.codegen.declarations import declarations, is_changed
from optixc.codegen.names import Scope
from optixc.codegen.needs import Options
from optixc.codegen.writer import Writer
from optixc.ir.control import ends_in_loop, polls
from optixc.ir.nodes import (
    Assert,
    Assign,
    Break,
    CallCallable,
    CallHelper,
    CallIntrinsic,
    Continue,
    ElementRef,
    ForRange,
    If,
    Literal,
    Local,
    LocalRef,
    ParamsRef,
    Print,
    Return,
    Stmt,
    Trace,
    While,
)
from optixc.ir.types import Void
from optixc.ir.walk import Body, expressions, place_origin, place_root, statements
from optixc.passes.uniformity import Clone


class LaneFunction:
    """Writes one clone of a program or helper."""

    def __init__(self, writer: Writer, clone: Clone, types: WideTypes, clones: Clones, signatures: Signatures, options: Options) -> None:
        self._writer = writer
        self._clone = clone
        self._function = clone.function
        self._types = types
        self._clones = clones
        self._signatures = signatures
        self._options = options
        self._names = signatures.inner_names(clone.function)
        names = self._names
        hidden = (names.thread, names.trace, names.params, names.hit_object)
        self._scope = Scope(taken=(*names.locals.values(), *hidden, "mask", "lane", "one", "result"))
        self._dialect = LaneDialect(types, clones, clone, names, options, self._hoist)
        self._expressions = LaneExpressions(self._dialect)
        self._declarations = declarations(clone.function)
        self._calls = LaneCalls(clone, names, self._expressions, signatures, types, options)
        self._homes: dict[str, str] = {}
        """The mask that ran the declaration of each local: assignments under that mask need no selection."""
        self._loops: list[str | None] = []
        """The masks of lanes that stay in the loops around, None for loops that all lanes run alike."""

    # ---- the function --------------------------------------------------------------------------------------------------------

    def write(self) -> None:
        """Writes the whole definition and goes back to lines of the generated file."""
        for line in self._function.doc.strip().splitlines():
            self._writer.line(f"// {line.strip()}".rstrip("\\ "))
        with self._writer.block(self._clones.head(self._clone, self._names), self._function.span):
            self._write_hidden_locals()
            for local in self._declarations.at_top:
                self._homes[local.name] = self._mask
                self._writer.line(f"{self._unread(local)}{self._type(local)} {self._names.locals[local.name]}{{}};")
            self._body(self._function.body)
            if not isinstance(self._function.result, Void):
                if self._clone.returns_apart:
                    self._writer.line("return result;")
                elif ends_in_loop(self._function.body) or self._may_run_out_of_lanes():
                    self._writer.line("return {};")
        self._writer.leave_source()
        self._writer.line()

    def _may_run_out_of_lanes(self) -> bool:
        """Whether a part of the function, its return with it, is skipped where no lane is left: a conditional part can call with none."""
        return any(id(statement) in self._clone.exits for statement in statements(self._function.body))

    def _write_hidden_locals(self) -> None:
        needs, names = self._signatures.needs(self._function.name), self._names
        if needs.ray:
            self._writer.line(f"[[maybe_unused]] Lanes& {names.thread} = *{names.trace}.thread;")
        if needs.params:
            struct = next(e.type for e in expressions(self._function.body) if isinstance(e, ParamsRef))
            params = self._types.types.struct(struct)
            self._writer.line(f"const {params}& {names.params} = oxrt::launchParams<{params}>({names.thread});")
        if needs.hit_object and self._function.kind is not None:
            self._writer.line(f"oxrt::HitObjectLanes<LANES> {names.hit_object}({names.thread});")
        if self._clone.returns_apart:
            if not isinstance(self._function.result, Void):
                self._writer.line(f"{self._types.name(self._function.result, True)} result{{}};")
            if any(self._is_left(s) for s in statements(self._function.body) if isinstance(s, While | ForRange)):
                self._writer.line("Mask returned = false;")

    @property
    def _mask(self) -> str:
        return self._dialect.mask

    def _hoist(self, wanted: str, text: str) -> str:
        name = self._scope.name(wanted)
        self._writer.line(f"const Mask {name} = {text};")
        return name

    def _type(self, local: Local) -> str:
        return self._types.name(local.type, local.name in self._clone.varying)

    def _unread(self, local: Local) -> str:
        return "[[maybe_unused]] " if local.name in self._declarations.unread else ""

    # ---- blocks --------------------------------------------------------------------------------------------------------------

    def _body(self, body: Body) -> None:
        """The statements; behind one that lanes left, the rest runs only if some lane stayed."""
        for position, statement in enumerate(body):
            self._statement(statement)
            rest = body[position + 1 :]
            if rest and id(statement) in self._clone.exits:
                with self._writer.block(f"if (oxrt::any({self._mask}))"):
                    self._body(rest)
                return
            if isinstance(statement, Break | Continue | Return):
                return

    def _masked(self, mask: str, body: Body) -> None:
        outer = self._dialect.mask
        self._dialect.mask = mask
        self._body(body)
        self._dialect.mask = outer

    def _statement(self, statement: Stmt) -> None:
        match statement:
            case Assign():
                self._assign(statement)
            case If():
                self._if(statement)
            case While():
                self._while(statement)
            case ForRange():
                self._for(statement)
            case Break():
                self._break(statement)
            case Continue():
                self._continue(statement)
            case Return():
                self._return(statement)
            case CallHelper():
                self._call_helper(statement)
            case CallIntrinsic():
                self._call(statement, statement.target, self._calls.intrinsic(statement))
            case CallCallable():
                self._call(statement, statement.target, self._calls.callable(statement))
            case Trace():
                self._trace(statement)
            case Assert():
                self._assert(statement)
            case Print():
                self._writer.line(self._calls.print(statement), statement.span)
            case _:
                assert_never(statement)

    # ---- assignments ---------------------------------------------------------------------------------------------------------

    def _assign(self, statement: Assign) -> None:
        target = statement.target
        if isinstance(target, LocalRef):
            self._set(statement, target.local, self._expressions.code(statement.value).text, self._dialect.varies(statement.value))
            return
        element = place_origin(target)
        if isinstance(element, ElementRef):
            self._writer.line(self._calls.store(target, element, statement.value), statement.span)
            return
        root = place_root(target)
        assert root is not None
        value = self._expressions.stored(self._expressions.text(statement.value), statement.value, target.type)
        if root.name in self._clone.varying and not spreads_itself(statement.value, target.type):
            value = self._expressions.stored(self._expressions.wide(statement.value), statement.value, target.type)
        place = self._expressions.place(target)
        if self._calls.has_varying_index(target):
            self._writer.line(self._calls.store_item(target, statement.value), statement.span)
            return
        is_plain = root.name not in self._clone.varying or self._is_plain(root)
        guard = self._calls.guard(target)
        text = f"{place} = {value};" if is_plain else f"oxrt::assign({self._mask}, {place}, {value});"
        self._writer.line(text if guard is None else f"if ({guard}) {text}", statement.span)

    def _is_plain(self, local: Local) -> bool:
        """Whether no lane outside of the current mask will read the local."""
        return self._homes.get(local.name) == self._mask

    def _set(self, statement: Stmt, local: Local, value: str, varies: bool) -> None:
        """Gives a local a whole new value; declares it where it is declared."""
        name = self._names.locals[local.name]
        is_varying = local.name in self._clone.varying
        text = self._types.widened(value, local.type) if is_varying and not varies else value
        if id(statement) in self._declarations.at_statement:
            self._homes[local.name] = self._mask
            self._writer.line(f"{self._unread(local)}{self._type(local)} {name} = {text};", statement.span)
        elif is_varying and not self._is_plain(local):
            self._writer.line(f"oxrt::assign({self._mask}, {name}, {text});", statement.span)
        else:
            self._writer.line(f"{name} = {text};", statement.span)

    # ---- branches ------------------------------------------------------------------------------------------------------------

    def _if(self, statement: If) -> None:
        if id(statement) not in self._clone.divergent:
            self._uniform_if(statement)
            return
        test = self._dialect.condition(self._expressions.text(statement.condition))
        if not test.isidentifier() or is_changed((statement,), test):
            test = self._hoist("test", test)
        outer, then_mask, else_mask = self._mask, self._scope.name("mask"), None
        self._writer.line(f"Mask {then_mask} = {outer} & {test};", statement.span)
        if statement.then_body:
            with self._writer.block(f"if (oxrt::any({then_mask}))", statement.span):
                self._masked(then_mask, statement.then_body)
        if statement.else_body:
            else_mask = self._scope.name("mask")
            self._writer.line(f"Mask {else_mask} = oxrt::without({outer}, {test});")
            with self._writer.block(f"if (oxrt::any({else_mask}))"):
                self._masked(else_mask, statement.else_body)
        if id(statement) in self._clone.exits:
            rest = else_mask or f"oxrt::without({outer}, {test})"
            self._writer.line(f"{outer} = {then_mask} | {rest};")

    def _uniform_if(self, statement: If) -> None:
        with self._writer.block(f"if ({self._expressions.text(statement.condition)})", statement.span):
            self._body(statement.then_body)
        if statement.else_body:
            with self._writer.block("else"):
                self._body(statement.else_body)

    # ---- loops ---------------------------------------------------------------------------------------------------------------

    def _while(self, statement: While) -> None:
        loop = self._begin_loop(statement)
        if loop is None:
            condition = self._expressions.text(statement.condition)
            is_simple = not statement.condition_body
            with self._writer.block(f"while ({condition})" if is_simple else "for (;;)", statement.span):
                self._poll(statement)
                if not is_simple:
                    self._body(statement.condition_body)
                    self._writer.line(f"if (!({self._expressions.text(statement.condition)}))", statement.span)
                    with self._writer.indented():
                        self._writer.line("break;")
                self._body(statement.body)
        else:
            with self._writer.block(f"while (oxrt::any({loop}))", statement.span):
                self._poll(statement)
                turn = self._scope.name("mask")
                self._writer.line(f"Mask {turn} = {loop};", statement.span)
                self._masked(turn, statement.condition_body)
                outer, self._dialect.mask = self._mask, turn
                condition = self._expressions.text(statement.condition)
                self._dialect.mask = outer
                operand = condition if condition.isidentifier() else f"({condition})"
                self._writer.line(f"{turn} = {loop} = {loop} & {operand};", statement.span)
                with self._writer.block(f"if (oxrt::none({turn}))"):
                    self._writer.line("break;")
                self._masked(turn, statement.body)
        self._end_loop(statement)

    def _begin_loop(self, statement: While | ForRange) -> str | None:
        """Declares the mask of the lanes that loop, if they do not all loop alike."""
        loop = None
        if id(statement) in self._clone.divergent:
            loop = self._scope.name("looping")
            self._writer.line(f"Mask {loop} = {self._mask};", statement.span)
        self._loops.append(loop)
        return loop

    def _end_loop(self, statement: While | ForRange) -> None:
        self._loops.pop()
        if self._is_left(statement):
            self._writer.line(f"{self._mask} = oxrt::without({self._mask}, returned);")

    def _is_left(self, loop: While | ForRange) -> bool:
        """Whether lanes may leave the function inside of the loop, while others stay."""
        if id(loop) not in self._clone.exits:
            return False
        return any(isinstance(inner, Return) or self._clones.analysis.leaves(inner) for inner in statements((loop,)))

    def _poll(self, statement: While | ForRange) -> None:
        if polls(statement):
            self._writer.line(f"if (oxrt::isCancelled({self._names.thread}))", statement.span)
            with self._writer.indented():
                self._writer.line("break;")

    def _for(self, statement: ForRange) -> None:
        bounds = [self._expressions.text(bound) for bound in (statement.start, statement.stop, statement.step)]
        bounds_vary = any(self._dialect.varies(bound) for bound in (statement.start, statement.stop, statement.step))
        target, is_declared = statement.target, id(statement) in self._declarations.at_statement
        name, type_ = self._names.locals[target.name], self._types.types.name(target.type)
        loop = self._begin_loop(statement)
        is_varying = target.name in self._clone.varying
        if is_declared and not is_varying and self._counts_plainly(statement):
            stop = self._expressions.at(statement.stop, PRIMARY)
            stays = f" && oxrt::any({loop})" if loop is not None else ""
            head = f"for ({self._unread(target)}{type_} {name} = {bounds[0]}; {name} < {stop}{stays}; ++{name})"
        else:
            if is_declared:
                self._writer.line(f"{self._unread(target)}{self._type(target)} {name}{{}};", statement.span)
            turns = self._scope.name("range")
            range_type = f"oxrt::RangeLanes<{type_}, LANES>" if bounds_vary else f"oxrt::Range<{type_}>"
            self._writer.line(f"{range_type} {turns}({', '.join(bounds)});", statement.span)
            head = f"while ({self._next_turn(turns, name, loop, bounds_vary, is_varying)})"
        with self._writer.block(head, statement.span):
            self._poll(statement)
            if loop is None:
                self._body(statement.body)
            else:
                turn = self._scope.name("mask")
                self._writer.line(f"Mask {turn} = {loop};")
                if is_declared:
                    self._homes[target.name] = turn
                self._masked(turn, statement.body)
        self._end_loop(statement)

    def _next_turn(self, turns: str, target: str, loop: str | None, bounds_vary: bool, is_varying: bool) -> str:
        if bounds_vary:
            assert loop is not None
            return f"oxrt::any({loop} = {turns}.next({loop}, {target}))"
        if is_varying:
            return f"oxrt::any({loop or self._mask}) && oxrt::nextTurn({turns}, {loop or self._mask}, {target})"
        stays = f"oxrt::any({loop}) && " if loop is not None else ""
        return f"{stays}{turns}.next({target})"

    def _counts_plainly(self, statement: ForRange) -> bool:
        """Whether C++'s own counting loop means the same: steps of 1, and a bound that the loop cannot change."""
        if not (isinstance(statement.step, Literal) and statement.step.value == 1):
            return False
        stop = statement.stop
        return isinstance(stop, Literal) or (isinstance(stop, LocalRef) and not is_changed(statement.body, stop.local.name))

    # ---- ways out ------------------------------------------------------------------------------------------------------------

    def _break(self, statement: Break) -> None:
        loop = self._loops[-1]
        if loop is None:
            self._writer.line("break;", statement.span)
            return
        self._writer.line(f"{loop} = oxrt::without({loop}, {self._mask});", statement.span)
        self._writer.line(f"{self._mask} = false;")

    def _continue(self, statement: Continue) -> None:
        if self._loops[-1] is None:
            self._writer.line("continue;", statement.span)
        else:
            self._writer.line(f"{self._mask} = false;", statement.span)

    def _return(self, statement: Return) -> None:
        varies = statement.value is not None and self._dialect.varies(statement.value)
        value = self._expressions.text(statement.value) if statement.value is not None else None
        if value is not None and self._clone.result_varies and not varies:
            value = self._types.widened(value, self._function.result)
        if not self._clone.returns_apart:
            self._writer.line(f"return {value};" if value is not None else "return;", statement.span)
            return
        if value is not None:
            self._writer.line(f"oxrt::assign({self._mask}, result, {value});", statement.span)
        self._leave(self._mask, statement)
        self._writer.line(f"{self._mask} = false;", statement.span)

    def _leave(self, lanes: str, statement: Stmt) -> None:
        """Takes lanes that leave the function out of the loops around."""
        loops = [loop for loop in self._loops if loop is not None]
        if loops:
            self._writer.line(f"returned |= {lanes};", statement.span)
            for loop in loops:
                self._writer.line(f"{loop} = oxrt::without({loop}, {lanes});")

    # ---- calls ---------------------------------------------------------------------------------------------------------------

    def _call_helper(self, statement: CallHelper) -> None:
        target = statement.target
        name = None if target is None else self._names.locals[target.name]
        on_items = self._calls.helper_on_items(statement, name)
        if on_items is None:
            self._call(statement, target, self._calls.helper(statement))
            return
        if target is not None and id(statement) in self._declarations.at_statement:
            self._homes[target.name] = self._mask
            self._writer.line(f"{self._unread(target)}{self._type(target)} {name}{{}};", statement.span)
        self._writer.line(f"{on_items}", statement.span)
        self._leave_after(statement)

    def _call(self, statement: CallHelper | CallIntrinsic | CallCallable, target: Local | None, call: tuple[str, bool] | None) -> None:
        """Writes a call; `call` is its text and whether its result varies. Lanes for which it ended something leave."""
        if call is None:
            return
        text, varies = call
        if target is None:
            self._writer.line(f"{text};", statement.span)
        else:
            self._set(statement, target, text, varies)
        self._leave_after(statement)

    def _trace(self, statement: Trace) -> None:
        for line in self._calls.trace(statement):
            self._writer.line(line, statement.span)
        if statement.name == "trace" and self._signatures.needs(self._function.name).hit_object:
            self._writer.line(f"oxrt::makeNopHitObject({self._names.hit_object}, {self._mask});", statement.span)
        self._leave_after(statement)

    def _leave_after(self, statement: CallHelper | CallIntrinsic | CallCallable | Trace) -> None:
        """Behind a call that may have ended the program or the launch index of some lanes: these leave the function."""
        if not self._clones.analysis.leaves(statement):
            return
        gone = self._calls.gone(statement)
        if gone is not None and any(loop is not None for loop in self._loops):
            gone = self._hoist("gone", gone)
        self._leave(gone or self._mask, statement)
        self._writer.line(f"{self._mask} = {f'oxrt::without({self._mask}, {gone})' if gone is not None else 'false'};", statement.span)

    def _assert(self, statement: Assert) -> None:
        if self._options.is_checked:
            values = [self._expressions.text(value) for value in statement.values]
            condition = self._expressions.wide(statement.condition)
            self._writer.line(assertion_call(statement, [self._names.thread, self._mask], condition, values), statement.span)
