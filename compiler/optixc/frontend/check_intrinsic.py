"""Calls of device functions that a row of the table describes in full, and atomic operations."""

from __future__ import annotations

import ast

from optixc.frontend.arguments import bind_arguments, check_written, refuse_stars
from optixc.frontend.checked import Argument, AtomicUse, DefaultArgument, ExprInfo, IntrinsicUse
from optixc.frontend.context import Context, describe
from optixc.frontend.conversions import can_convert, common_type
from optixc.frontend.weak import INVALID, CheckType, Invalid, is_float, is_integer, is_number, is_weak
from optixc.ir import types as t
from optixc.ir.intrinsic_rows import INTRINSICS, OVERLOADS
from optixc.ir.intrinsics import Effect, Generic, Intrinsic
from optixc.ir.programs import ALL_PROGRAMS

_FLOAT_ATOMICS = frozenset({"atomic_add", "atomic_sub", "atomic_exch", "atomic_min", "atomic_max"})
_WRAP_ATOMICS = frozenset({"atomic_inc", "atomic_dec"})


def check_intrinsic(c: Context, node: ast.Call, name: str) -> ExprInfo:
    """A call of `ox.name`."""
    if name == "pow" and len(node.args) == 3:
        return c.error("OX305", node, "pow() takes two arguments", "write (x ** y) % z")
    if name in ("min", "max") and len(node.args) > 2 and not any(isinstance(argument, ast.Starred) for argument in node.args):
        # min(a, b, c) is min(min(a, b), c), in the tree as well: all later stages know two arguments.
        *first, last = node.args
        node.args = [ast.copy_location(ast.Call(node.func, first, []), node), last]
    if name in OVERLOADS:
        check_written(c, node)
    row = _choose_row(c, node, name)
    optional = [parameter.name for parameter in row.parameters if parameter.default is not None]
    bound = bind_arguments(c, node, name, [parameter.name for parameter in row.parameters], optional)
    if name not in OVERLOADS:
        check_written(c, node)
    if bound is None or any(isinstance(c.info(argument).type, Invalid) for argument in bound if argument is not None):
        require_row(c, row, name, node)
        return ExprInfo(INVALID)
    require_row(c, row, name, node)
    result = _convert_arguments(c, node, row, bound)
    if result is None or (name == "set_payload_types" and not _check_payload_types(c, node, bound)):
        return ExprInfo(INVALID)
    arguments: list[Argument] = []
    for parameter, argument in zip(row.parameters, bound, strict=True):
        if argument is not None:
            arguments.append(argument)
        else:
            assert parameter.default is not None and not isinstance(parameter.type, Generic)
            arguments.append(DefaultArgument(parameter.default, parameter.type))
    writes = row.effect is not Effect.PURE or any(c.info(argument).writes for argument in bound if argument is not None)
    if row.effect is not Effect.PURE:
        c.instance.writes = True
    return ExprInfo(result, use=IntrinsicUse(row, tuple(arguments)), writes=writes, fresh=True)


def _check_payload_types(c: Context, node: ast.Call, bound: list[ast.expr | None]) -> bool:
    """set_payload_types() stands first in its program, unconditionally, with a constant (OptiX guide, section 14)."""
    symbol = c.instance.symbol
    body = symbol.node.body if symbol is not None and symbol.kind is not None else []
    statements = [s for s in body if not (isinstance(s, ast.Expr) and isinstance(s.value, ast.Constant))]
    is_first = bool(statements) and isinstance(statements[0], ast.Expr) and statements[0].value is node
    if not is_first:
        c.error("OX305", node, "set_payload_types() must be the first statement of its program", "it cannot be conditional")
        return False
    if bound[0] is not None and c.info(bound[0]).constant is None:
        c.error("OX305", bound[0], "set_payload_types() takes a constant", "write ox.PayloadTypeID.ID_0 or the like")
        return False
    return True


def require_row(c: Context, row: Intrinsic, name: str, node: ast.AST) -> None:
    """Note which programs may call this row; maths needs nothing of a program."""
    if row.optix or row.allowed != ALL_PROGRAMS:
        c.require(f"{name}()", row.allowed, node)


def _choose_row(c: Context, node: ast.Call, name: str) -> Intrinsic:
    """Of several parameter lists the one that takes as many arguments as the call has, and fixed arrays where they are."""
    rows = OVERLOADS.get(name, (INTRINSICS[name],))
    if any(isinstance(argument, ast.Starred) for argument in node.args):
        return rows[0]
    given = {keyword.arg for keyword in node.keywords}
    count = len(node.args) + len(given)

    def fits(row: Intrinsic) -> bool:
        required = sum(parameter.default is None for parameter in row.parameters)
        return required <= count <= len(row.parameters) and given <= {parameter.name for parameter in row.parameters}

    fitting = [row for row in rows if fits(row)]
    if len(fitting) < 2:
        return fitting[0] if fitting else rows[0]
    return next((row for row in fitting if _arrays_fit(c, node, row)), fitting[0])


def _arrays_fit(c: Context, node: ast.Call, row: Intrinsic) -> bool:
    """Whether the arguments by position are fixed arrays where the row wants handles, and only there."""
    return all(
        isinstance(c.info(argument).type, t.FixedArray) == (parameter.type is Generic.HANDLES or isinstance(parameter.type, t.FixedArray))
        for parameter, argument in zip(row.parameters, node.args, strict=False)
    )


def _convert_arguments(c: Context, node: ast.Call, row: Intrinsic, bound: list[ast.expr | None]) -> t.Type | None:
    """Convert to the parameters' types; the result's type, or None after a diagnostic."""
    generic = [
        (argument, parameter.type)
        for parameter, argument in zip(row.parameters, bound, strict=True)
        if argument is not None and isinstance(parameter.type, Generic) and parameter.type not in (Generic.ELEMENT, Generic.HANDLES)
    ]
    joined: t.Type | None = None
    if generic:
        joined = _joined_type(c, node, row, [argument for argument, _ in generic], generic[0][1])
        if joined is None:
            return None
    element = joined.element if isinstance(joined, t.Vector) else joined
    for parameter, argument in zip(row.parameters, bound, strict=True):
        if argument is None:
            continue
        what = f"argument `{parameter.name}`"
        if not isinstance(parameter.type, Generic):
            if not c.coerce(argument, parameter.type, what):
                return None
        elif parameter.type is Generic.HANDLES:
            type_ = c.type_of(argument)
            if not (isinstance(type_, t.FixedArray) and type_.element == t.TRAVERSABLE):
                c.error("OX302", argument, f"{what} must be a fixed array of traversables, this is {describe(type_)}",
                        "fill an ox.FixedArray[ox.Traversable, N]() with get_transform_list_handle(i)")
                return None
        elif parameter.type is Generic.ELEMENT:
            if element is None or not c.coerce(argument, element, what):
                return None
        elif joined is not None:
            c.info(argument).converted = joined
            if c.info(argument).constant is None and is_weak(c.info(argument).type):
                c.coerce(argument, element or joined, what)
                c.info(argument).converted = joined
    if isinstance(row.result, Generic):
        return element if row.result is Generic.ELEMENT else joined
    if isinstance(joined, t.Vector) and row.result == t.BOOL:
        c.error("OX302", node, f"{row.name}() takes a number, this is {joined}", "ask each component")
        return None
    return row.result


def _joined_type(c: Context, node: ast.Call, row: Intrinsic, arguments: list[ast.expr], form: Generic) -> t.Type | None:
    """The one type that all generic arguments meet in: numbers are spread over vectors beside them."""
    joined: CheckType = c.type_of(arguments[0])
    for argument in arguments[1:]:
        met = common_type(joined, c.type_of(argument))
        if met is None:
            text = f"{describe(joined)} and {describe(c.type_of(argument))}"
            c.error("OX302", node, f"{row.name}() does not take {text} together", "convert one of them")
            return None
        joined = met
    scalar = joined.element if isinstance(joined, t.Vector) else joined
    fits = is_number(scalar)
    if form is Generic.INTEGERS:
        fits = is_integer(scalar)
    elif form is Generic.FLOAT_VECTOR:
        fits = fits and isinstance(joined, t.Vector)
    if not fits:
        c.error("OX302", arguments[0], f"{row.name}() takes {form.value}, this is {describe(joined)}", _expected(form))
        return None
    if form in (Generic.FLOATS, Generic.FLOAT_VECTOR) and not is_float(scalar):
        scalar = t.FLOAT32
    elif is_weak(scalar):
        scalar = t.FLOAT32 if is_float(scalar) else t.INT32
    assert isinstance(scalar, t.Scalar)
    return t.Vector(scalar, joined.size) if isinstance(joined, t.Vector) else scalar


def _expected(form: Generic) -> str:
    return {Generic.FLOAT_VECTOR: "e.g. float3", Generic.INTEGERS: "write int(...)"}.get(form, "expected numbers or vectors")


def check_atomic(c: Context, node: ast.Call, row: Intrinsic) -> ExprInfo:
    """`atomic_add(array, index, value)`; the index is an integer, or a tuple with one integer per axis."""
    names = [parameter.name for parameter in row.parameters]
    bound = bind_arguments(c, node, row.name, names) if refuse_stars(c, node) else None
    check_written(c, node)
    c.instance.writes = True
    if bound is None:
        return ExprInfo(INVALID)
    array, index, *values = [argument for argument in bound if argument is not None]
    if any(isinstance(c.info(argument).type, Invalid) for argument in (array, index, *values)):
        return ExprInfo(INVALID)
    type_ = c.info(array).type
    if not isinstance(type_, t.Array) or not _is_atomic_element(row, type_.element):
        note = "an array of int32, uint32, int64, uint64" + (" or float32, float64" if row.name in _FLOAT_ATOMICS else "")
        if row.name in _WRAP_ATOMICS:
            note = "an array of uint32"
        return c.error("OX302", array, f"{row.name}() does not work on {describe(type_)}", note)
    indices = list(index.elts) if isinstance(index, ast.Tuple) else [index]
    if len(indices) != type_.rank:
        return c.error("OX312", index, f"{type_} takes {type_.rank} indices, here are {len(indices)}", "write (y, x) for two axes")
    for item in indices:
        if not is_integer(c.info(item).type):
            return c.error("OX312", item, f"an index must be an integer, this is {describe(c.info(item).type)}", "write int(...)")
        if is_weak(c.info(item).type) and not c.coerce(item, t.INT32, "an index"):
            return ExprInfo(INVALID)
    for value in values:
        if not can_convert(c.info(value).type, type_.element) or not c.coerce(value, type_.element, "the value"):
            if not isinstance(c.info(value).type, Invalid):
                c.coerce(value, type_.element, "the value")
            return ExprInfo(INVALID)
    return ExprInfo(type_.element, use=AtomicUse(row, array, tuple(indices), tuple(values)), writes=True)


def _is_atomic_element(row: Intrinsic, element: t.Type) -> bool:
    if not isinstance(element, t.Scalar) or element.bits not in (32, 64) or element.kind is t.ScalarKind.BOOL:
        return False
    if row.name in _WRAP_ATOMICS:
        return element == t.UINT32
    return element.kind is not t.ScalarKind.FLOAT or row.name in _FLOAT_ATOMICS
