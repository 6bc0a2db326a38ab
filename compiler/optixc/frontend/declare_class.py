"""Classes of a shader file: `@ox.struct`, `@ox.payload`, `@ox.attributes`, `IntEnum` and `IntFlag`; others are host code."""

from __future__ import annotations

import ast

from optixc.enums import PayloadSemantics
from optixc.frontend import builtin_names as names
from optixc.frontend.annotations import resolve_type
from optixc.frontend.declarations import Declarations
from optixc.frontend.fold import FoldError, constant_of, fold_binary
from optixc.frontend.resolve_name import resolve_dotted
from optixc.frontend.source_file import Diagnostics
from optixc.frontend.symbols import BuiltinName, EnumSymbol, PythonName, SkippedName, StructSymbol, Symbol
from optixc.ir import types as t
from optixc.ir.layout import payload_words

MAX_PAYLOAD_WORDS = 32
MAX_ATTRIBUTE_WORDS = 8
_STAGES = {"caller": 0, "ch": 2, "ms": 4, "ah": 6, "is_": 8, "is": 8}
_ACCESS = {"": 0, "r": 1, "w": 2, "rw": 3, "wr": 3}


def declare_class(scope: Declarations, node: ast.ClassDef, diagnostics: Diagnostics) -> Symbol:
    """The symbol of a class definition."""
    for expression in node.decorator_list:
        symbol = resolve_dotted(scope, expression.func if isinstance(expression, ast.Call) else expression)
        if isinstance(symbol, BuiltinName) and symbol.name in names.STRUCT_DECORATORS:
            return _Struct(scope, node, names.STRUCT_DECORATORS[symbol.name], diagnostics).declare()
    bases = [resolve_dotted(scope, base) for base in node.bases]
    if any(isinstance(base, PythonName) and base.module == "enum" and base.name in ("IntEnum", "IntFlag") for base in bases):
        return _declare_enum(scope, node, diagnostics)
    place = scope.file.source.header_span(node)
    return SkippedName(node.name, "a class without `@ox.struct`, `@ox.payload` or `@ox.attributes`", place)


class _Struct:
    """Builds one struct type from its class."""

    def __init__(self, scope: Declarations, node: ast.ClassDef, kind: t.StructKind, diagnostics: Diagnostics) -> None:
        self.scope = scope
        self.node = node
        self.kind = kind
        self.diagnostics = diagnostics
        self.fields: list[t.StructField] = []
        self.defaults: dict[str, ast.expr] = {}

    def declare(self) -> Symbol:
        source = self.scope.file.source
        place = source.header_span(self.node)
        if self.node.bases or self.node.keywords:
            self._error(self.node.bases[0] if self.node.bases else self.node, f"`{self.node.name}` cannot inherit", "use a field instead")
        for statement in self.node.body:
            self._statement(statement)
        if not self.fields:
            self.diagnostics.add(source, "OX202", place, f"`{self.node.name}` has no fields", "write `name: type` lines")
        self._check_words()
        return StructSymbol(t.Struct(self.node.name, self.kind, tuple(self.fields)), self.defaults, place, self.scope)

    def _statement(self, statement: ast.stmt) -> None:
        match statement:
            case ast.Expr(value=ast.Constant(value=str())) | ast.Pass():
                return
            case ast.AnnAssign(target=ast.Name(id=name), annotation=annotation, value=value):
                self._field(name, annotation, value, statement)
            case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name):
                place = self.scope.file.source.header_span(statement)
                note = f"write a helper `@ox.device def {name}(...)` outside of the class"
                self.diagnostics.add(self.scope.file.source, "OX202", place, "a struct has no methods", note)
            case ast.Assign():
                self._error(statement, "a field needs a type", "write `name: type = default`")
            case _:
                self._error(statement, "a struct holds fields only", "write `name: type` lines")

    def _field(self, name: str, annotation: ast.expr, value: ast.expr | None, statement: ast.AnnAssign) -> None:
        if any(field.name == name for field in self.fields):
            self._error(statement, f"field `{name}` is defined twice", "")
            return
        if name.startswith("__") and not name.endswith("__"):
            python_name = f"_{self.node.name.lstrip('_')}{name}"
            message = f"Python gives the field `{name}` the name `{python_name}` outside of the class"
            self._error(statement, message, "begin it with one underscore")
        type_ = resolve_type(self.scope, annotation, self.diagnostics)
        if type_ is None:
            type_ = t.VOID
        elif isinstance(type_, t.CoopVec):
            note = "keep the numbers in an array and read them with ox.coop_vec_load()"
            self._error(annotation, f"a field cannot be of type {type_}", note)
            type_ = t.VOID
        elif isinstance(type_, t.Void | t.Tuple) or (isinstance(type_, t.Struct) and type_.kind is not t.StructKind.PLAIN):
            self._error(
                annotation, f"a field cannot be of type {type_}", "numbers, vectors, matrices, arrays, handles or `@ox.struct` classes"
            )
        elif self.kind is not t.StructKind.PLAIN and _holds_array(type_):
            self._error(annotation, f"a {self.kind.value} cannot hold an array", "numbers, vectors and structs of them travel with a ray")
        semantics = None
        if isinstance(value, ast.Call) and resolve_dotted(self.scope, value.func) == BuiltinName("payload_word"):
            semantics = self._semantics(value)
        elif value is not None:
            self.defaults[name] = value
        elif self.defaults:
            self._error(statement, f"field `{name}` without a default follows one with a default", "give it one too or move it up")
        self.fields.append(t.StructField(name, type_, semantics))

    def _semantics(self, call: ast.Call) -> int | None:
        if self.kind is not t.StructKind.PAYLOAD:
            self._error(call, "payload_word() belongs into an `@ox.payload` class", "")
            return None
        bits = 0
        for position, argument in enumerate(call.args):
            self._error(argument, "payload_word() takes keywords", 'write payload_word(caller="r", ch="w", ms="w")')
            if position == 0:
                return None
        for keyword in call.keywords:
            access = keyword.value.value if isinstance(keyword.value, ast.Constant) else None
            if keyword.arg not in _STAGES or not isinstance(access, str) or access not in _ACCESS:
                self._error(keyword.value, 'payload_word() takes caller, ch, ms, ah, is_, each "r", "w" or "rw"', "")
                return None
            bits |= _ACCESS[access] << _STAGES[keyword.arg]
        reads, writes = bits & 0b0101010101, bits & 0b1010101010
        if not reads or not writes:
            self._error(
                call,
                "a payload word must be written by somebody and read by somebody",
                f"this one is never {'read' if writes else 'written'}",
            )
            return None
        return int(PayloadSemantics(bits))

    def _check_words(self) -> None:
        if self.kind is t.StructKind.PLAIN or any(_has_no_words(field.type) for field in self.fields):
            return
        limit = MAX_PAYLOAD_WORDS if self.kind is t.StructKind.PAYLOAD else MAX_ATTRIBUTE_WORDS
        words = sum(payload_words(field.type) for field in self.fields)
        if words > limit:
            place = self.scope.file.source.header_span(self.node)
            message = f"{self.kind.value} `{self.node.name}` has {words} words of 32 bits, at most {limit} are possible"
            self.diagnostics.add(self.scope.file.source, "OX207", place, message)

    def _error(self, place: ast.AST, message: str, note: str) -> None:
        self.diagnostics.add(self.scope.file.source, "OX202", place, message, note)


def _holds_array(type_: t.Type) -> bool:
    match type_:
        case t.Array():
            return True
        case t.Struct(fields=fields):
            return any(_holds_array(field.type) for field in fields)
        case t.FixedArray(element=element):
            return _holds_array(element)
    return False


def _has_no_words(type_: t.Type) -> bool:
    """Whether a field, or one inside of it, has an error already."""
    match type_:
        case t.Struct(fields=fields):
            return any(_has_no_words(field.type) for field in fields)
        case t.FixedArray(element=element):
            return _has_no_words(element)
    return isinstance(type_, t.Void | t.Tuple | t.Array)


def _declare_enum(scope: Declarations, node: ast.ClassDef, diagnostics: Diagnostics) -> EnumSymbol:
    source = scope.file.source
    is_flag = any(isinstance(base, ast.Name | ast.Attribute) and ast.unparse(base).endswith("IntFlag") for base in node.bases)
    members: dict[str, int] = {}
    for statement in node.body:
        match statement:
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                number = _enum_value(scope, value, members, is_flag)
                if number is None:
                    diagnostics.add(source, "OX208", value, f"`{node.name}.{name}` must be an integer constant")
                members[name] = number or 0
            case ast.Expr(value=ast.Constant(value=str())) | ast.Pass():
                continue
            case _:
                diagnostics.add(source, "OX208", statement, "an enum in a shader file holds members only", "write `NAME = integer` lines")
    return EnumSymbol(node.name, members, is_flag)


def _enum_value(scope: Declarations, node: ast.expr, members: dict[str, int], is_flag: bool) -> int | None:
    match node:
        case ast.Call(func=func, args=[]) if resolve_dotted(scope, func) == PythonName("enum", "auto"):
            highest = max(members.values(), default=0)
            return (1 << highest.bit_length()) if is_flag else highest + 1
        case ast.Name(id=name) if name in members:
            return members[name]
        case ast.BinOp(left=left, op=op, right=right):
            a, b = _enum_value(scope, left, members, is_flag), _enum_value(scope, right, members, is_flag)
            try:
                result = fold_binary(op, a, b) if a is not None and b is not None else None
            except FoldError:
                return None
            return result if isinstance(result, int) else None
    try:
        value = constant_of(scope, node)
    except FoldError:
        return None
    return value if isinstance(value, int) and not isinstance(value, bool) else None
