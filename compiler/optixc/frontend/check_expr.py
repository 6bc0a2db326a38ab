"""Expressions: what each one's type is, what each name means. Operators, calls and constructors have modules of their own."""

from __future__ import annotations

import ast
import difflib

from optixc.frontend.builtin_symbols import attribute_of
from optixc.frontend.check_call import check_call
from optixc.frontend.check_operators import check_binary, check_boolean, check_compare, check_conditional, check_unary
from optixc.frontend.checked import (
    ElementUse,
    ExprInfo,
    FieldUse,
    IndexUse,
    LocalUse,
    ParamsUse,
    PayloadAccess,
    ShapeUse,
    SwizzleUse,
    TupleUse,
    VectorUse,
)
from optixc.frontend.context import Context, describe
from optixc.frontend.environment import Bound, Conflict, Partial
from optixc.frontend.near_names import other_spelling, suggestion
from optixc.frontend.places import is_payload_parameter
from optixc.frontend.refusals import refuse_expression
from optixc.frontend.resolve_static import local_names, static_symbol
from optixc.frontend.symbols import (
    BuiltinName,
    ConstantSymbol,
    EnumSymbol,
    FileSymbol,
    FunctionSymbol,
    OptixNamespace,
    ParamsSymbol,
    PythonName,
    SkippedName,
    StructSymbol,
    Symbol,
    ValueSymbol,
    VectorSymbol,
)
from optixc.frontend.weak import INVALID, WEAK_FLOAT, WEAK_INT, Invalid, is_integer, tuple_of, widened
from optixc.ir import types as t

_TABLE = "docs/language/device-functions.md lists all that there are"
_COMPONENTS = {"x": 0, "y": 1, "z": 2, "w": 3, "r": 0, "g": 1, "b": 2, "a": 3}
_MAX_LITERAL_BITS = 64


def check_expression(c: Context, node: ast.expr) -> ExprInfo:
    """The info of one expression; its parts are checked through `c.check`."""
    match node:
        case ast.Constant():
            return _check_constant(c, node)
        case ast.Name():
            return _check_name(c, node)
        case ast.Attribute():
            return _check_attribute(c, node)
        case ast.Subscript():
            return _check_subscript(c, node)
        case ast.BinOp():
            return check_binary(c, node)
        case ast.UnaryOp():
            return check_unary(c, node)
        case ast.BoolOp():
            return check_boolean(c, node)
        case ast.Compare():
            return check_compare(c, node)
        case ast.IfExp():
            return check_conditional(c, node)
        case ast.Call():
            return check_call(c, node)
        case ast.Tuple():
            return _check_tuple(c, node)
    return refuse_expression(c, node)


def _check_constant(c: Context, node: ast.Constant) -> ExprInfo:
    match node.value:
        case bool() as value:
            return ExprInfo(t.BOOL, constant=value)
        case int() as value:
            if value.bit_length() > _MAX_LITERAL_BITS:
                return c.error("OX313", node, "this integer has more than 64 bits", "no type of shaders holds it")
            return ExprInfo(WEAK_INT, constant=value)
        case float() as value:
            return ExprInfo(WEAK_FLOAT, constant=value)
    return refuse_expression(c, node)


def _check_tuple(c: Context, node: ast.Tuple) -> ExprInfo:
    items = [c.check(element) for element in node.elts]
    if any(isinstance(item.type, Invalid) for item in items):
        return ExprInfo(INVALID)
    for element, item in zip(node.elts, items, strict=True):
        if isinstance(item.type, t.Void):
            return c.error("OX321", element, "this call gives no value", "a tuple's items need one")
    return ExprInfo(tuple_of(item.type for item in items), writes=any(item.writes for item in items), fresh=all(i.fresh for i in items))


def _check_name(c: Context, node: ast.Name) -> ExprInfo:
    if node.id in c.poisoned:
        return ExprInfo(INVALID)
    binding = c.environment.get(node.id)
    match binding:
        case Bound(local=local):
            return ExprInfo(INVALID) if isinstance(local.type, t.Void) else ExprInfo(local.type, use=LocalUse(local))
        case Partial(reason=reason):
            return c.error("OX306", node, f"`{node.id}` may have no value here: {reason}", "bind it on every way, e.g. before the branch")
        case Conflict(reason=reason):
            return c.error("OX320", node, f"`{node.id}` has no one type here: {reason}", "give both one type, e.g. write 1.0 for 1")
    if node.id in local_names(c):
        return c.error("OX306", node, f"`{node.id}` is used before it is bound", "it is a local, because this function assigns it")
    symbol = static_symbol(c, node)
    if symbol is None:
        near = difflib.get_close_matches(node.id, [*local_names(c), *c.scope.definitions], 1)
        meant = f"did you mean `{near[0]}`?" if near else suggestion(node.id)
        note = other_spelling(node.id) or meant or "nothing defines it"
        return c.error("OX301", node, f"`{node.id}` is not defined", note)
    return symbol_value(c, node, symbol)


def symbol_value(c: Context, node: ast.expr, symbol: Symbol, note: str = "") -> ExprInfo:
    """A module-level name as a value."""
    match symbol:
        case ParamsSymbol(struct=struct):
            c.hooks.params(c, struct, node)
            return ExprInfo(struct, use=ParamsUse(struct))
        case ValueSymbol(type=type_, value=value):
            return ExprInfo(type_, constant=value)
        case VectorSymbol(type=vector, values=values):
            return ExprInfo(vector, use=VectorUse(values))
        case ConstantSymbol():
            use = c.hooks.constant(c, symbol)
            if use is None:
                reason = f"{c.hooks.host_constant(symbol)}, see {symbol.span}"
                message = f"`{ast.unparse(node)}` cannot be used in a shader: it is host code ({reason})"
                return c.error("OX310", node, message, "only constants and helpers can")
            info = use.body.info[symbol.node]
            if isinstance(info.type, Invalid):
                return ExprInfo(INVALID)
            return ExprInfo(info.converted or info.type, constant=info.constant, use=use)
        case SkippedName(reason=reason, span=span, code=code):
            place = f", see {span}" if span is not None else ""
            message = f"`{ast.unparse(node)}` cannot be used in a shader: it is {reason}{place}"
            return c.error(code, node, message, note or "only constants and helpers can")
        case FunctionSymbol():
            return c.error("OX402", node, f"the function `{ast.unparse(node)}` is not a value", "call it")
        case StructSymbol() | EnumSymbol():
            return c.error("OX402", node, f"the class `{ast.unparse(node)}` is not a value", "call it, or name one of its members")
        case BuiltinName():
            return c.error("OX402", node, f"`{ast.unparse(node)}` is not a value", "call it")
        case OptixNamespace() | FileSymbol() | PythonName():
            return c.error("OX402", node, f"the module `{ast.unparse(node)}` is not a value", "name something in it")


def _check_attribute(c: Context, node: ast.Attribute) -> ExprInfo:
    base_symbol = static_symbol(c, node.value)
    if base_symbol is not None and not isinstance(base_symbol, ParamsSymbol | ConstantSymbol | ValueSymbol | VectorSymbol):
        symbol = static_symbol(c, node)
        if symbol is None:
            return _unknown_member(c, node, base_symbol)
        return symbol_value(c, node, symbol)
    base = c.check(node.value)
    match base.type:
        case Invalid():
            return base
        case t.Struct() as struct:
            return _check_field(c, node, base, struct)
        case t.Vector() as vector:
            return _check_swizzle(c, node, base, vector)
        case t.Array() as array if node.attr == "shape":
            return ExprInfo(t.Tuple((t.INT32,) * array.rank), use=ShapeUse(node.value), writes=base.writes, fresh=True)
    return c.error("OX311", node, f"{describe(base.type)} has no attribute `{node.attr}`", _attribute_note(base.type))


def _attribute_note(type_: object) -> str:
    return "an array has `.shape` only" if isinstance(type_, t.Array) else "structs have fields, vectors x y z w, arrays shape"


def _unknown_member(c: Context, node: ast.Attribute, base: Symbol) -> ExprInfo:
    if isinstance(base, SkippedName):
        return symbol_value(c, node.value, base, other_spelling(node.attr))
    text = ast.unparse(node.value)
    if isinstance(base, EnumSymbol):
        near = difflib.get_close_matches(node.attr, base.members, 1)
        return c.error("OX311", node, f"`{text}` has no member `{node.attr}`", f"did you mean `{near[0]}`?" if near else "")
    if isinstance(base, PythonName) and attribute_of(base, node.attr) is None:
        return c.error("OX310", node, f"`{ast.unparse(node)}` cannot be used in a shader", "only math.pi and other constants can")
    return c.error("OX301", node, f"`{text}` has no `{node.attr}` for shaders", suggestion(node.attr) or _TABLE)


def _check_field(c: Context, node: ast.Attribute, base: ExprInfo, struct: t.Struct) -> ExprInfo:
    field = struct.field(node.attr)
    if field is None:
        near = difflib.get_close_matches(node.attr, [field.name for field in struct.fields], 1)
        note = f"did you mean `{near[0]}`?" if near else f"it has {', '.join(field.name for field in struct.fields)}"
        return c.error("OX311", node, f"`{struct}` has no field `{node.attr}`", note)
    if isinstance(field.type, t.Void):
        return ExprInfo(INVALID)
    if isinstance(base.use, LocalUse) and is_payload_parameter(c, base.use.local) and node is not c.stored:
        c.note_payload_access(base.use.local, PayloadAccess(node.attr, False, c.span(node)))
    return ExprInfo(widened(field.type), use=FieldUse(node.attr, field.type), writes=base.writes)


def _check_swizzle(c: Context, node: ast.Attribute, base: ExprInfo, vector: t.Vector) -> ExprInfo:
    components = [_COMPONENTS.get(letter, 9) for letter in node.attr]
    if not 1 <= len(components) <= 4 or max(components) >= vector.size:
        names = " ".join("xyzw"[: vector.size])
        return c.error("OX311", node, f"{vector} has no component `{node.attr}`", f"it has {names} and swizzles of up to four of them")
    type_: t.Type = vector.element if len(components) == 1 else t.Vector(vector.element, len(components))
    return ExprInfo(type_, use=SwizzleUse(tuple(components)), writes=base.writes)


def _check_subscript(c: Context, node: ast.Subscript) -> ExprInfo:
    base = c.check(node.value)
    if isinstance(base.type, Invalid):
        return base
    if isinstance(node.slice, ast.Slice):
        return c.error("OX402", node, "slices are not part of restricted Python", "index one element at a time")
    indices = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
    infos = [c.check(index) for index in indices]
    if any(isinstance(info.type, Invalid) for info in infos):
        return ExprInfo(INVALID)
    for index, info in zip(indices, infos, strict=True):
        if not is_integer(info.type):
            return c.error("OX312", index, f"an index must be an integer, this is {describe(info.type)}", "write int(...)")
    writes = base.writes or any(info.writes for info in infos)
    if isinstance(base.type, t.Array):
        return _check_element(c, node, base.type, indices, writes)
    if len(indices) != 1:
        return c.error("OX312", node, f"{describe(base.type)} takes one index", "index row and column one after the other")
    return _check_item(c, node, base, indices[0], writes)


def _check_element(c: Context, node: ast.Subscript, array: t.Array, indices: list[ast.expr], writes: bool) -> ExprInfo:
    if len(indices) != array.rank:
        return c.error("OX312", node, f"{array} takes {array.rank} indices, here are {len(indices)}", "e.g. image[y, x]")
    for index in indices:
        constant = c.info(index).constant
        if isinstance(constant, int) and constant < 0:
            return c.error("OX312", index, "an index is never negative", "indices do not count from the end; use shape")
        if not isinstance(c.type_of(index), t.Scalar):
            c.coerce(index, t.INT32 if isinstance(constant, int) and constant < 1 << 31 else t.INT64, "an index")
    # Elements read from an array are values: nothing else names them.
    return ExprInfo(widened(array.element), use=ElementUse(tuple(indices), array.element), writes=writes, fresh=True)


def _check_item(c: Context, node: ast.Subscript, base: ExprInfo, index: ast.expr, writes: bool) -> ExprInfo:
    constant = c.info(index).constant
    match base.type:
        case t.Tuple(items=items):
            if not isinstance(constant, int):
                return c.error("OX312", index, "a tuple's index must be a constant", "use a FixedArray to index by a variable")
            if not -len(items) <= constant < len(items):
                return c.error("OX312", index, f"the tuple has {len(items)} items", f"expected 0 to {len(items) - 1}")
            axis = constant % len(items)
            if isinstance(base.use, ShapeUse):
                return ExprInfo(t.INT32, use=ShapeUse(base.use.array, axis), writes=writes)
            return ExprInfo(items[axis], use=TupleUse(axis), writes=writes, fresh=base.fresh)
        case t.FixedArray(element=element, size=size) | t.CoopVec(element=element, size=size):
            stored: t.Type = element
        case t.Vector(element=element, size=size):
            stored = element
        case t.Matrix(rows=size, columns=columns):
            stored = t.Vector(t.FLOAT32, columns)
        case _:
            return c.error("OX312", node, f"{describe(base.type)} cannot be indexed", "arrays, vectors, matrices and tuples can")
    if isinstance(constant, int) and not 0 <= constant < size:
        return c.error(
            "OX312", index, f"{base.type} has no index {constant}", f"expected 0 to {size - 1}; indices do not count from the end"
        )
    if isinstance(c.info(index).type, type(WEAK_INT)):
        c.coerce(index, t.INT32, "an index")
    elif c.type_of(index) not in (t.INT32, t.UINT32):
        return c.error("OX312", index, f"this index must be int32 or uint32, it is {describe(c.info(index).type)}", "write int(...)")
    return ExprInfo(widened(stored), use=IndexUse(index, stored), writes=writes)
