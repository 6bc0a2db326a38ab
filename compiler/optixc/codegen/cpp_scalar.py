"""Functions of the scalar emitter: one launch index at a time, statement by statement as the author wrote them."""

from __future__ import annotations

from typing import assert_never

from optixc.codegen.assertions import assertion_call
from optixc.codegen.cpp_expr import AND, UNARY, Expressions
from optixc.codegen.cpp_scalar_calls import ScalarCalls
from optixc.codegen.cpp_scalar_dialect import ScalarDialect
from optixc.codegen.cpp_signatures import Signatures
from optixc.codegen.cpp_types import TypeNames
from optixc.codegen.declarations import declarations, is_changed
from optixc.codegen.names import string_literal
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
    Expr,
    ForRange,
    Function,
    If,
    Literal,
    Local,
    LocalRef,
    Print,
    Return,
    Stmt,
    Trace,
    Unary,
    UnaryOp,
    While,
)
from optixc.ir.types import Void
from optixc.ir.walk import Body
from optixc.source import Span


class ScalarFunction:
    """Writes one program or helper."""

    def __init__(self, writer: Writer, function: Function, types: TypeNames, signatures: Signatures, options: Options) -> None:
        self._writer = writer
        self._function = function
        self._types = types
        self._signatures = signatures
        self._options = options
        self._names = signatures.inner_names(function)
        self._expressions = Expressions(ScalarDialect(types, signatures, self._names, options))
        self._declarations = declarations(function, splits_loops=True)
        self._calls = ScalarCalls(function, self._names, self._expressions, signatures, types, options)

    def write(self) -> None:
        """Writes the whole definition and goes back to lines of the generated file."""
        for line in self._function.doc.strip().splitlines():
            self._writer.line(f"// {line.strip()}".rstrip("\\ "))
        with self._writer.block(self._signatures.head(self._function, self._names), self._function.span):
            self._write_hidden_locals()
            for local in self._declarations.at_top:
                self._writer.line(f"{self._unread(local)}{self._types.name(local.type)} {self._names.locals[local.name]}{{}};")
            self._body(self._function.body)
            if not isinstance(self._function.result, Void) and ends_in_loop(self._function.body):
                self._writer.line("return {};")
        self._writer.leave_source()
        self._writer.line()

    def _write_hidden_locals(self) -> None:
        needs, names = self._signatures.needs(self._function.name), self._names
        if needs.ray and needs.names_thread:
            self._writer.line(f"OxrtThread& {names.thread} = *{names.trace}.thread;")
        if needs.params:
            params = self._types.struct(self._calls.params_struct())
            self._writer.line(f"const {params}& {names.params} = oxrt::launchParams<{params}>({names.thread});")
        if needs.hit_object and self._function.kind is not None:
            self._writer.line(f"oxrt::HitObject {names.hit_object}({names.thread});")

    def _unread(self, local: Local) -> str:
        return "[[maybe_unused]] " if local.name in self._declarations.unread else ""

    # ---- statements ----------------------------------------------------------------------------------------------------------

    def _body(self, body: Body) -> None:
        for statement in body:
            self._statement(statement)

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
                self._writer.line("break;", statement.span)
            case Continue():
                self._writer.line("continue;", statement.span)
            case Return():
                value = f" {self._expressions.text(statement.value)}" if statement.value is not None else ""
                self._writer.line(f"return{value};", statement.span)
            case CallHelper():
                self._call(statement, statement.target, self._calls.helper(statement))
            case CallIntrinsic():
                self._call(statement, statement.target, self._calls.intrinsic(statement))
            case CallCallable():
                self._call(statement, statement.target, self._calls.callable(statement))
            case Trace():
                self._call(statement, None, self._calls.trace(statement))
            case Assert():
                self._assert(statement)
            case Print():
                self._print(statement)
            case _:
                assert_never(statement)

    def _assign(self, statement: Assign) -> None:
        value = self._expressions.stored(self._expressions.text(statement.value), statement.value, statement.target.type)
        if isinstance(statement.target, LocalRef):
            self._writer.line(f"{self._target(statement, statement.target.local)} = {value};", statement.span)
            return
        text = f"{self._expressions.place(statement.target)} = {value};"
        guard = self._calls.guard(statement.target)
        if guard is None:
            self._writer.line(text, statement.span)
            return
        self._writer.line(f"if ({guard})", statement.span)
        with self._writer.indented():
            self._writer.line(text, statement.span)

    def _target(self, statement: Stmt, local: Local) -> str:
        """The left side of an assignment to a local: its declaration if it is declared here."""
        name = self._names.locals[local.name]
        if id(statement) in self._declarations.at_statement:
            return f"{self._unread(local)}{self._types.name(local.type)} {name}"
        return name

    def _if(self, statement: If) -> None:
        condition: Expr | None = statement.condition
        then_body, else_body = statement.then_body, statement.else_body
        if not then_body:
            condition, then_body, else_body = Unary(UnaryOp.NOT, statement.condition, statement.condition.type), else_body, ()
        head = "if"
        span: Span | None = statement.span
        while condition is not None:
            self._writer.line(f"{head} ({self._expressions.text(condition)}) {{", span)
            with self._writer.indented():
                self._body(then_body)
            condition = None
            if len(else_body) == 1 and isinstance(else_body[0], If) and else_body[0].then_body:
                nested = else_body[0]
                head, span = "} else if", nested.span
                condition, then_body, else_body = nested.condition, nested.then_body, nested.else_body
        if else_body:
            self._writer.line("} else {")
            with self._writer.indented():
                self._body(else_body)
        self._writer.line("}")

    def _while(self, statement: While) -> None:
        """Loops that may never end look whether the launch is to stop."""
        goes_on = [f"!oxrt::isCancelled({self._names.thread})"] if polls(statement) else []
        if statement.condition_body:
            with self._writer.block(f"while ({' '.join(goes_on) or 'true'})", statement.span):
                self._body(statement.condition_body)
                self._writer.line(f"if (!{self._expressions.at(statement.condition, UNARY)})", statement.span)
                with self._writer.indented():
                    self._writer.line("break;")
                self._body(statement.body)
            return
        is_endless = isinstance(statement.condition, Literal) and statement.condition.value is True
        conditions = [self._expressions.at(statement.condition, AND + 1 if goes_on else 0)] if not (is_endless and goes_on) else []
        with self._writer.block(f"while ({' && '.join(conditions + goes_on)})", statement.span):
            self._body(statement.body)

    def _for(self, statement: ForRange) -> None:
        target = self._names.locals[statement.target.name]
        type_ = self._types.name(statement.target.type)
        start, stop, step = (self._expressions.text(bound) for bound in (statement.start, statement.stop, statement.step))
        is_declared = id(statement) in self._declarations.at_statement
        if is_declared and self._counts_plainly(statement):
            head = f"for ({type_} {target} = {start}; {target} < {stop}; ++{target})"
        elif is_declared:
            head = f"for ({self._unread(statement.target)}{type_} {target} : oxrt::Range<{type_}>({start}, {stop}, {step}))"
        else:
            range_name = self._calls.fresh("range")
            head = f"for (oxrt::Range<{type_}> {range_name}({start}, {stop}, {step}); {range_name}.next({target});)"
        with self._writer.block(head, statement.span):
            if polls(statement):
                self._writer.line(f"if (oxrt::isCancelled({self._names.thread}))", statement.span)
                with self._writer.indented():
                    self._writer.line("break;")
            self._body(statement.body)

    def _counts_plainly(self, statement: ForRange) -> bool:
        """Whether C++'s own counting loop means the same: steps of 1, and a bound that the loop cannot change."""
        if not (isinstance(statement.step, Literal) and statement.step.value == 1):
            return False
        stop = statement.stop
        return isinstance(stop, Literal) or (isinstance(stop, LocalRef) and not is_changed(statement.body, stop.local.name))

    def _call(self, statement: CallHelper | CallIntrinsic | CallCallable | Trace, target: Local | None, call: str | None) -> None:
        """Writes a call that can write, and the return after it where it may have ended the program or the launch index."""
        if call is None:
            return
        self._writer.line(f"{self._target(statement, target)} = {call};" if target is not None else f"{call};", statement.span)
        if isinstance(statement, Trace) and statement.name == "trace" and self._signatures.needs(self._function.name).hit_object:
            self._writer.line(f"oxrt::makeNopHitObject({self._names.hit_object});", statement.span)
        condition = self._calls.ending(statement)
        if condition is None:
            return
        leave = "return;" if isinstance(self._function.result, Void) else "return {};"
        if condition == "":
            self._writer.line(leave)
            return
        self._writer.line(f"if ({condition})", statement.span)
        with self._writer.indented():
            self._writer.line(leave)

    def _assert(self, statement: Assert) -> None:
        if self._options.is_checked:
            values = [self._expressions.text(value) for value in statement.values]
            condition = self._expressions.text(statement.condition)
            self._writer.line(assertion_call(statement, [self._names.thread], condition, values), statement.span)

    def _print(self, statement: Print) -> None:
        items = [string_literal(item) if isinstance(item, str) else self._expressions.text(item) for item in statement.items]
        words = [self._names.thread, string_literal(statement.separator), string_literal(statement.end), *items]
        self._writer.line(f"oxrt::print({', '.join(words)});", statement.span)
