"""The printed form of the IR: `--emit ir`, `--print-after PASS` and the golden files.

Deterministic: equal modules give equal text. It reads like the source with every type written out; nothing parses it back.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from types import MappingProxyType

from optixc.ir.nodes import (
    ArrayShape,
    Assert,
    Assign,
    Binary,
    Break,
    CallCallable,
    CallHelper,
    CallIntrinsic,
    ComponentRef,
    Construct,
    Continue,
    Convert,
    ElementRef,
    Expr,
    FieldRef,
    ForRange,
    Function,
    HelperCall,
    If,
    IndexRef,
    IntrinsicCall,
    Literal,
    Local,
    LocalRef,
    Logical,
    Module,
    ParameterRole,
    ParamsRef,
    Pipeline,
    Print,
    Return,
    Select,
    Stmt,
    Trace,
    TupleItem,
    Unary,
    Uniformity,
    While,
)
from optixc.ir.types import VOID, Struct

_COMPONENTS = "xyzw"
_INDENT = "    "


Notes = Mapping[int, tuple[str, ...]]
"""Lines of comment, by the id of the function or statement behind whose first line they stand."""


def print_module(module: Module | Pipeline, notes: Notes = MappingProxyType({})) -> str:
    """The text of a module or pipeline, ended by a newline."""
    lines: list[str] = []
    if isinstance(module, Module):
        lines.append(f"module {module.name}")
    else:
        lines.append(f"pipeline lanes={module.options.lanes} max_trace_depth={module.options.max_trace_depth}")
    if module.params is not None:
        lines.append(f"launch_params {module.params}")
    for struct in module.structs:
        lines += ["", *_struct(struct)]
    for function in (*module.helpers, *module.programs):
        lines += ["", *_function(function, notes)]
    return "\n".join(lines) + "\n"


def print_expression(expression: Expr) -> str:
    """The text of one expression."""
    return _expression(expression)


def _struct(struct: Struct) -> Iterator[str]:
    yield f"{struct.kind.value} {struct.name}:"
    for field in struct.fields:
        semantics = "" if field.semantics is None else f" semantics=0x{field.semantics:x}"
        yield f"{_INDENT}{field.name}: {field.type}{semantics}"


def _local(local: Local) -> str:
    uniformity = "" if local.uniformity is Uniformity.UNKNOWN else f"{local.uniformity.value} "
    reference = "&" if local.by_reference else ""
    return f"{local.name}: {uniformity}{reference}{local.type}"


def _function(function: Function, notes: Notes) -> Iterator[str]:
    parameters = []
    for parameter in function.parameters:
        role = "" if parameter.role is ParameterRole.VALUE else f"{parameter.role.value} "
        written = " written" if parameter.written else ""
        parameters.append(f"{role}{_local(parameter.local)}{written}")
    keyword = "def" if function.kind is None else "program"
    result = "" if function.result == VOID else f" -> {function.result}"
    yield f"{keyword} {function.name}({', '.join(parameters)}){result}:"
    yield from (f"{_INDENT}# {note}" for note in notes.get(id(function), ()))
    for local in function.locals:
        yield f"{_INDENT}local {_local(local)}"
    yield from _body(function.body, _INDENT, notes)


def _body(body: tuple[Stmt, ...], indent: str, notes: Notes) -> Iterator[str]:
    if not body:
        yield f"{indent}pass"
    for statement in body:
        yield from _statement(statement, indent, notes)


def _statement(statement: Stmt, indent: str, notes: Notes) -> Iterator[str]:
    match statement:
        case If():
            yield f"{indent}if {_expression(statement.condition)}:"
            yield from _body(statement.then_body, indent + _INDENT, notes)
            if statement.else_body:
                yield f"{indent}else:"
                yield from _body(statement.else_body, indent + _INDENT, notes)
        case While():
            yield f"{indent}while{'' if statement.bounded else ' unbounded'} {_expression(statement.condition)}:"
            if statement.condition_body:
                yield f"{indent}{_INDENT}before condition:"
                yield from _body(statement.condition_body, indent + 2 * _INDENT, notes)
            yield from _body(statement.body, indent + _INDENT, notes)
        case ForRange():
            bounds = ", ".join(_expression(bound) for bound in (statement.start, statement.stop, statement.step))
            yield f"{indent}for {statement.target.name} in range({bounds}):"
            yield from _body(statement.body, indent + _INDENT, notes)
        case _:
            yield indent + _simple_statement(statement)
            yield from (f"{indent}# {note}" for note in notes.get(id(statement), ()))


def _simple_statement(
    statement: Assign | Break | Continue | Return | CallHelper | CallIntrinsic | Trace | CallCallable | Assert | Print,
) -> str:
    match statement:
        case Assign():
            return f"{_expression(statement.target)} = {_expression(statement.value)}"
        case Break():
            return "break"
        case Continue():
            return "continue"
        case Return():
            return "return" if statement.value is None else f"return {_expression(statement.value)}"
        case CallHelper():
            return f"{_target(statement.target)}call {statement.function}({_list(statement.arguments)})"
        case CallIntrinsic():
            return f"{_target(statement.target)}do {statement.name}({_list(statement.arguments)})"
        case Trace():
            payload = "" if statement.payload is None else f" payload {_expression(statement.payload)}: {statement.payload_type}"
            return f"{statement.name}({_list(statement.arguments)}){payload}"
        case CallCallable():
            kind = "direct_call" if statement.is_direct else "continuation_call"
            arguments = _list((statement.index, *statement.arguments))
            return f"{_target(statement.target)}{kind}({arguments}) -> {statement.result}"
        case Assert():
            shown = f" shows {_list(statement.values)}" if statement.values else ""
            return f"assert {_expression(statement.condition)}, {statement.message!r}{shown}"
        case Print():
            items = ", ".join(repr(item) if isinstance(item, str) else _expression(item) for item in statement.items)
            return f"print({items}, sep={statement.separator!r}, end={statement.end!r})"


def _target(target: Local | None) -> str:
    return "" if target is None else f"{target.name} = "


def _list(expressions: tuple[Expr, ...]) -> str:
    return ", ".join(_expression(expression) for expression in expressions)


def _expression(expression: Expr) -> str:
    return _PRINTERS[type(expression)](expression)


def _literal(literal: Literal) -> str:
    values = literal.value if isinstance(literal.value, tuple) else (literal.value,)
    return f"{literal.type}({', '.join(repr(value) for value in values)})"


def _component(reference: ComponentRef) -> str:
    return f"{_expression(reference.base)}.{''.join(_COMPONENTS[index] for index in reference.components)}"


def _binary(binary: Binary) -> str:
    return f"({_expression(binary.left)} {binary.op.value} {_expression(binary.right)}):{binary.type}"


def _unary(unary: Unary) -> str:
    space = " " if unary.op.value.isalpha() else ""
    return f"({unary.op.value}{space}{_expression(unary.operand)})"


def _logical(logical: Logical) -> str:
    return f"({_expression(logical.left)} {'and' if logical.is_and else 'or'} {_expression(logical.right)})"


def _select(select: Select) -> str:
    return f"({_expression(select.if_true)} if {_expression(select.condition)} else {_expression(select.if_false)})"


_PRINTERS: dict[type, Callable[..., str]] = {
    Literal: _literal,
    LocalRef: lambda node: node.local.name,
    ParamsRef: lambda _: "params",
    FieldRef: lambda node: f"{_expression(node.base)}.{node.name}",
    ComponentRef: _component,
    IndexRef: lambda node: f"{_expression(node.base)}[{_expression(node.index)}]",
    TupleItem: lambda node: f"{_expression(node.base)}[{node.index}]",
    ElementRef: lambda node: f"{_expression(node.array)}[{_list(node.indices)}]",
    ArrayShape: lambda node: f"{_expression(node.array)}.shape[{node.axis}]",
    Unary: _unary,
    Binary: _binary,
    Logical: _logical,
    Select: _select,
    Convert: lambda node: f"convert[{node.type}]({_expression(node.operand)})",
    Construct: lambda node: f"{node.type}({_list(node.arguments)})",
    IntrinsicCall: lambda node: f"{node.name}({_list(node.arguments)})",
    HelperCall: lambda node: f"{node.function}({_list(node.arguments)})",
}
