"""From an annotation to a type: `float3`, `ox.Array2[float4]`, `ox.FixedArray[int, 8]`, `tuple[float, bool]`, classes, enums, strings.

Reports OX201 where something else stands there.
"""

from __future__ import annotations

import ast

from optixc.frontend import builtin_names as names
from optixc.frontend.declarations import Declarations
from optixc.frontend.fold import FoldError, constant_of
from optixc.frontend.resolve_name import resolve_dotted
from optixc.frontend.source_file import Diagnostics
from optixc.frontend.symbols import BuiltinName, ConstantSymbol, EnumSymbol, PythonName, SkippedName, StructSymbol, Symbol
from optixc.frontend.weak import widened
from optixc.ir import types as t

MAX_FIXED_ELEMENTS = 65536
MAX_COOP_VEC_ELEMENTS = 1024
_COOP_VEC_ELEMENTS = (t.FLOAT16, t.FLOAT32, t.INT8, t.UINT8, t.INT32, t.UINT32)
_REMEDIES = {
    "list": "ox.FixedArray[T, N] or ox.Array[T]",
    "str": "text is no value in shaders",
    "dict": "an `@ox.struct` class",
    "object": "leave the parameter without annotation",
}


def resolve_type(scope: Declarations, node: ast.expr, diagnostics: Diagnostics) -> t.Type | None:
    """The type that an annotation names, or None after a diagnostic."""
    match node:
        case ast.Constant(value=None):
            return t.VOID
        case ast.Constant(value=str() as text):
            return _resolve_text(scope, node, text, diagnostics)
        case ast.Name() | ast.Attribute():
            symbol = resolve_dotted(scope, node)
            found = type_of_symbol(scope, symbol, diagnostics)
            if found is None:
                _report_no_type(scope, node, symbol, diagnostics)
            return found
        case ast.Subscript(value=base, slice=index):
            symbol = resolve_dotted(scope, base)
            match symbol:
                case BuiltinName(name="tuple"):
                    return _resolve_tuple(scope, index, diagnostics)
                case BuiltinName(name="FixedArray"):
                    return _resolve_fixed_array(scope, node, index, diagnostics)
                case BuiltinName(name="CoopVec"):
                    return _resolve_coop_vec(scope, node, index, diagnostics)
                case BuiltinName(name=name) if name in names.ARRAY_RANKS:
                    return _resolve_array(scope, index, names.ARRAY_RANKS[name], diagnostics)
                case PythonName(module="typing", name="Final" | "Annotated" | "ClassVar"):
                    first = index.elts[0] if isinstance(index, ast.Tuple) and index.elts else index
                    return resolve_type(scope, first, diagnostics)
            _report_no_type(scope, node, symbol, diagnostics)
            return None
    _report_no_type(scope, node, None, diagnostics)
    return None


def resolve_value_type(scope: Declarations, node: ast.expr, diagnostics: Diagnostics, what: str) -> t.Type | None:
    """The type of what is no place in memory: a local, parameter or result; None after a diagnostic."""
    type_ = resolve_type(scope, node, diagnostics)
    if type_ is not None and widened(type_) != type_:
        message = f"{what} cannot be {type_}: 8 and 16 bit numbers live in memory only"
        diagnostics.add(scope.file.source, "OX201", node, message, f"write {widened(type_)}")
        return None
    return type_


def type_of_symbol(scope: Declarations, symbol: Symbol | None, diagnostics: Diagnostics) -> t.Type | None:
    """The type that a symbol is, or None if it is no type."""
    match symbol:
        case BuiltinName(name=name):
            return names.TYPE_NAMES.get(name)
        case StructSymbol(type=type_):
            return type_
        case EnumSymbol(is_flag=is_flag):
            return t.UINT32 if is_flag else t.INT32
        case ConstantSymbol(node=ast.Subscript() as inner, scope=owner):
            return resolve_type(owner, inner, diagnostics)
    return None


def _resolve_text(scope: Declarations, node: ast.expr, text: str, diagnostics: Diagnostics) -> t.Type | None:
    try:
        inner = ast.parse(text.strip(), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        diagnostics.add(scope.file.source, "OX201", node, "a type is expected, this text is none")
        return None
    for child in ast.walk(inner):
        ast.copy_location(child, node)
    return resolve_type(scope, inner, diagnostics)


def _report_no_type(scope: Declarations, node: ast.expr, symbol: Symbol | None, diagnostics: Diagnostics) -> None:
    text = ast.unparse(node)
    note = _REMEDIES.get(text.split("[")[0], "expected e.g. float, float3, ox.Array2[float4] or an `@ox.struct` class")
    if isinstance(symbol, SkippedName):
        message = f"`{text}` is no type of shaders: it is {symbol.reason}"
    elif isinstance(symbol, BuiltinName) and symbol.name in names.ARRAY_RANKS:
        message, note = f"`{text}` needs its element type", f"write {text}[float3] or the like"
    elif isinstance(symbol, BuiltinName) and symbol.name in names.SIZED_TYPES:
        message, note = f"`{text}` needs element type and size", f"write {text}[float, 8] or the like"
    else:
        message = f"`{text}` is no type"
    diagnostics.add(scope.file.source, "OX201", node, message, note)


def _resolve_tuple(scope: Declarations, index: ast.expr, diagnostics: Diagnostics) -> t.Type | None:
    elements = index.elts if isinstance(index, ast.Tuple) else [index]
    items = [resolve_type(scope, element, diagnostics) for element in elements]
    known = [item for item in items if item is not None]
    return t.Tuple(tuple(known)) if len(known) == len(items) else None


def _resolve_fixed_array(scope: Declarations, node: ast.expr, index: ast.expr, diagnostics: Diagnostics) -> t.Type | None:
    source = scope.file.source
    if not (isinstance(index, ast.Tuple) and len(index.elts) == 2):
        diagnostics.add(source, "OX201", node, "FixedArray needs an element type and a size", "write ox.FixedArray[float, 8] or the like")
        return None
    element = resolve_type(scope, index.elts[0], diagnostics)
    size = _resolve_size(scope, index.elts[1], "FixedArray", MAX_FIXED_ELEMENTS, diagnostics)
    if size is None:
        return None
    if isinstance(element, t.Array | t.Tuple | t.Void | t.CoopVec):
        diagnostics.add(source, "OX201", index.elts[0], f"a FixedArray cannot hold {element}", "numbers, vectors, matrices or structs")
        return None
    return t.FixedArray(element, size) if element is not None else None


def _resolve_size(scope: Declarations, node: ast.expr, what: str, limit: int, diagnostics: Diagnostics) -> int | None:
    try:
        size = constant_of(scope, node)
    except FoldError as error:
        diagnostics.add(scope.file.source, error.code, node, str(error))
        return None
    if not isinstance(size, int) or isinstance(size, bool) or not 1 <= size <= limit:
        diagnostics.add(scope.file.source, "OX201", node, f"the size of a {what} is an integer constant from 1 to {limit}")
        return None
    return size


def _resolve_coop_vec(scope: Declarations, node: ast.expr, index: ast.expr, diagnostics: Diagnostics) -> t.Type | None:
    source = scope.file.source
    if not (isinstance(index, ast.Tuple) and len(index.elts) == 2):
        diagnostics.add(source, "OX201", node, "CoopVec needs an element type and a size", "write ox.CoopVec[ox.float16, 32] or the like")
        return None
    element = resolve_type(scope, index.elts[0], diagnostics)
    size = _resolve_size(scope, index.elts[1], "CoopVec", MAX_COOP_VEC_ELEMENTS, diagnostics)
    if element is None or size is None:
        return None
    if element not in _COOP_VEC_ELEMENTS:
        note = "it holds " + ", ".join(map(str, _COOP_VEC_ELEMENTS))
        diagnostics.add(source, "OX201", index.elts[0], f"a CoopVec cannot hold {element}", note)
        return None
    return t.CoopVec(element, size)


def _resolve_array(scope: Declarations, index: ast.expr, rank: int, diagnostics: Diagnostics) -> t.Type | None:
    element = resolve_type(scope, index, diagnostics)
    if element is None:
        return None
    if not isinstance(element, t.Scalar | t.Vector | t.Matrix | t.Struct | t.Traversable | t.Texture | t.FixedArray):
        diagnostics.add(scope.file.source, "OX201", index, f"an array cannot hold {element}", "numbers, vectors, matrices or structs")
        return None
    if isinstance(element, t.Struct) and element.kind is not t.StructKind.PLAIN:
        diagnostics.add(scope.file.source, "OX201", index, f"an array cannot hold the {element.kind.value} class {element}")
        return None
    return t.Array(element, rank)
