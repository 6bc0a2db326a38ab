"""Operators: arithmetic, comparisons, boolean operators, conditional expressions; folding of literals."""

from __future__ import annotations

import ast
from collections.abc import Sequence

from optixc.frontend.checked import ExprInfo
from optixc.frontend.context import Context, describe
from optixc.frontend.conversions import common_type, weak_of
from optixc.frontend.fold import FoldError, fold_binary, fold_comparison, fold_unary
from optixc.frontend.weak import (
    INVALID,
    WEAK_INT,
    CheckType,
    ConstantValue,
    Invalid,
    WeakInt,
    default_type,
    is_float,
    is_integer,
    is_number,
    is_weak,
)
from optixc.ir import types as t

OPERATOR_TEXT: dict[type[ast.AST], str] = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.Mult: "*",
    ast.Div: "/",
    ast.FloorDiv: "//",
    ast.Mod: "%",
    ast.Pow: "**",
    ast.MatMult: "@",
    ast.BitAnd: "&",
    ast.BitOr: "|",
    ast.BitXor: "^",
    ast.LShift: "<<",
    ast.RShift: ">>",
    ast.USub: "-",
    ast.UAdd: "+",
    ast.Invert: "~",
    ast.Not: "not",
    ast.Eq: "==",
    ast.NotEq: "!=",
    ast.Lt: "<",
    ast.LtE: "<=",
    ast.Gt: ">",
    ast.GtE: ">=",
}

_BITWISE = (ast.BitAnd, ast.BitOr, ast.BitXor)
_SHIFTS = (ast.LShift, ast.RShift)
_DIVISIONS = (ast.Div, ast.FloorDiv, ast.Mod)
_CLOSED = (ast.Add, ast.Sub, ast.Mult, ast.FloorDiv, ast.Mod, ast.BitAnd, ast.BitOr, ast.BitXor)
"""Operators that give integers without a type of their own where both operands are such: `(1 << n) - 1`."""


def element_of(type_: CheckType) -> CheckType:
    """The scalar of a vector, else the type itself."""
    return type_.element if isinstance(type_, t.Vector) else type_


def check_unary(c: Context, node: ast.UnaryOp) -> ExprInfo:
    """`-x`, `+x`, `~x`, `not x`."""
    if isinstance(node.op, ast.Not):
        operand = check_condition(c, node.operand)
        constant = not operand.constant if operand.constant is not None else None
        return ExprInfo(operand.type if isinstance(operand.type, Invalid) else t.BOOL, constant=constant, writes=operand.writes)
    operand = c.check(node.operand)
    if isinstance(operand.type, Invalid):
        return operand
    if operand.constant is not None and is_weak(operand.type):
        flag_bits = operand.type.flag_bits if isinstance(operand.type, WeakInt) else 0
        value = fold_unary(node.op, operand.constant, flag_bits)
        if value is not None:
            return ExprInfo(operand.type if isinstance(node.op, ast.Invert) else weak_of(value), constant=value)
    if isinstance(operand.type, WeakInt):
        return ExprInfo(operand.type, writes=operand.writes)
    element = element_of(operand.type)
    fits = is_integer(element) if isinstance(node.op, ast.Invert) else is_number(element)
    if isinstance(operand.type, t.Matrix) and not isinstance(node.op, ast.Invert):
        fits = True
    if not fits:
        text = OPERATOR_TEXT[type(node.op)]
        note = "expected an integer" if isinstance(node.op, ast.Invert) else "expected a number or vector"
        return c.error("OX303", node, f"`{text}` does not take {describe(operand.type)}", note)
    return ExprInfo(c.settle(node.operand), writes=operand.writes)


def check_binary(c: Context, node: ast.BinOp) -> ExprInfo:
    """`left op right`; both operands get the type in which they meet."""
    left, right = c.check(node.left), c.check(node.right)
    if isinstance(left.type, Invalid) or isinstance(right.type, Invalid):
        return ExprInfo(INVALID)
    folded = _fold(c, node, left, right)
    if folded is not None:
        return folded
    if isinstance(node.op, _DIVISIONS) and right.constant == 0 and not isinstance(right.constant, bool):
        return c.error("OX314", node.right, "this divides by the constant zero", "Python would raise ZeroDivisionError")
    writes = left.writes or right.writes
    if isinstance(left.type, WeakInt) and isinstance(right.type, WeakInt) and isinstance(node.op, _CLOSED):
        return ExprInfo(WEAK_INT, writes=writes)
    for operand, info, other in ((node.left, left, right), (node.right, right, left)):
        joins = is_integer(info.type) and is_integer(element_of(other.type)) and not isinstance(node.op, ast.Div | ast.Pow)
        if is_weak(info.type) and info.constant is None and not joins:
            c.settle(operand)
    result = _binary_type(c, node)
    if isinstance(node.op, _SHIFTS) and isinstance(left.type, WeakInt) and isinstance(result, t.Scalar):
        return ExprInfo(left.type, writes=writes)
    return ExprInfo(INVALID if result is None else result, writes=writes)


def _fold(c: Context, node: ast.BinOp, left: ExprInfo, right: ExprInfo) -> ExprInfo | None:
    if left.constant is None or right.constant is None or not (is_weak(left.type) and is_weak(right.type)):
        return None
    try:
        value: ConstantValue | None = fold_binary(node.op, left.constant, right.constant)
    except FoldError as error:
        return c.error(error.code, node, str(error))
    if value is None:
        return None
    flags = [info.type for info in (left, right) if isinstance(info.type, WeakInt) and info.type.flag_bits]
    return ExprInfo(flags[0] if flags and isinstance(node.op, _BITWISE) else weak_of(value), constant=value)


def _binary_type(c: Context, node: ast.BinOp) -> t.Type | None:
    """The result's type, with both operands converted; None after a diagnostic."""
    left, right = c.type_of(node.left), c.type_of(node.right)
    if isinstance(node.op, _SHIFTS):
        return _shift_type(c, node, left, right)
    if isinstance(node.op, ast.MatMult):
        return _matrix_type(c, node, left, right)
    if isinstance(left, t.Matrix) or isinstance(right, t.Matrix):
        return _matrix_arithmetic(c, node, left, right)
    if left == t.BOOL and right == t.BOOL and isinstance(node.op, _BITWISE):
        return t.BOOL
    common = common_type(left, right)
    element = element_of(common) if common is not None else None
    if common is None or element is None or not is_number(element):
        return _refuse_types(c, node, left, right)
    if isinstance(node.op, _BITWISE) and not is_integer(element):
        return _refuse_types(c, node, left, right, "expected integers")
    if isinstance(node.op, ast.Div) and is_integer(element):
        wide = isinstance(element, t.Scalar) and element.bits == 64
        element = t.FLOAT64 if wide else t.FLOAT32
    if isinstance(node.op, ast.Pow):
        exponent = c.info(node.right).constant
        if is_integer(element) and exponent is not None and exponent < 0:
            c.error("OX313", node.right, "an integer to a negative power is not an integer", "write a float base, e.g. 2.0 ** -1")
            return None
    assert isinstance(element, t.Scalar)
    if isinstance(node.op, ast.BitAnd) and element.kind is t.ScalarKind.UINT:
        _keep_bits(c, node, element.bits)
    result = t.Vector(element, common.size) if isinstance(common, t.Vector) else element
    for operand, type_ in ((node.left, left), (node.right, right)):
        target = result if isinstance(type_, t.Vector) else element
        if not _convert_operand(c, operand, target):
            return None
    return result


def _keep_bits(c: Context, node: ast.BinOp, bits: int) -> None:
    """`flags & ~4`: of a negative literal, whose bits go on without end, an unsigned number keeps as many as it has itself."""
    for operand in (node.left, node.right):
        info = c.info(operand)
        if isinstance(info.type, WeakInt) and isinstance(info.constant, int) and -(1 << bits) <= info.constant < 0:
            info.constant &= (1 << bits) - 1


def _convert_operand(c: Context, node: ast.expr, target: t.Type) -> bool:
    """Convert an operand to the common type; integers under `/` become floats too."""
    info = c.info(node)
    scalar = target.element if isinstance(target, t.Vector) else target
    if isinstance(scalar, t.Scalar) and is_float(scalar) and is_integer(element_of(info.type)):
        info.converted = target
        return True
    return c.coerce(node, target, "this operand")


def _shift_type(c: Context, node: ast.BinOp, left: CheckType, right: CheckType) -> t.Type | None:
    if not is_integer(element_of(left)) or not is_integer(element_of(right)):
        return _refuse_types(c, node, left, right, "expected integers")
    count = c.info(node.right).constant
    if count is not None and count < 0:
        c.error("OX313", node.right, "a shift count is never negative", "shift the other way")
        return None
    if isinstance(right, t.Vector) and not (isinstance(left, t.Vector) and left.size == right.size):
        return _refuse_types(c, node, left, right)
    if isinstance(right, WeakInt):
        if not c.coerce(node.right, t.UINT32, "a shift count"):
            return None
    elif element_of(right) not in (t.INT32, t.UINT32):
        return _refuse_types(c, node, left, right, "a shift count is int32 or uint32")
    return default_type(left) if is_weak(left) else c.settle(node.left)


def _matrix_type(c: Context, node: ast.BinOp, left: CheckType, right: CheckType) -> t.Type | None:
    if isinstance(left, t.Matrix) and isinstance(right, t.Vector) and right == t.Vector(t.FLOAT32, left.columns):
        return t.Vector(t.FLOAT32, left.rows)
    if isinstance(left, t.Matrix) and isinstance(right, t.Matrix) and left.columns == right.rows:
        return t.Matrix(left.rows, right.columns)
    return _refuse_types(c, node, left, right, "expected matrix @ vector or matrix @ matrix with sizes that match")


def _matrix_arithmetic(c: Context, node: ast.BinOp, left: CheckType, right: CheckType) -> t.Type | None:
    if isinstance(node.op, ast.Add | ast.Sub) and left == right and isinstance(left, t.Matrix):
        return left
    if isinstance(node.op, ast.Mult):
        for matrix, number, operand in ((left, right, node.right), (right, left, node.left)):
            if isinstance(matrix, t.Matrix) and is_number(number) and c.coerce(operand, t.FLOAT32, "this operand"):
                return matrix
    return _refuse_types(c, node, left, right, "write `@` for the matrix product")


def _refuse_types(c: Context, node: ast.BinOp, left: CheckType, right: CheckType, note: str = "") -> t.Type | None:
    text = OPERATOR_TEXT[type(node.op)]
    c.error("OX303", node, f"`{text}` does not take {describe(left)} and {describe(right)}", note or _meeting_note(left, right))
    return None


def _meeting_note(left: CheckType, right: CheckType) -> str:
    """What to write so that two types meet."""
    a, b = element_of(left), element_of(right)
    if t.BOOL in (a, b):
        return "a bool is no number: write `1.0 if b else 0.0`, or int(b)"
    if is_integer(a) and is_integer(b) and isinstance(a, t.Scalar) and isinstance(b, t.Scalar) and a != b:
        signed = a if a.kind is t.ScalarKind.INT else b
        unsigned = b if signed is a else a
        return f"signed and unsigned do not mix: write {signed}(...) or {unsigned}(...) around one of them"
    if isinstance(left, t.CoopVec) or isinstance(right, t.CoopVec):
        return "write ox.coop_vec_add(a, b) and its like"
    if isinstance(left, t.Vector) and isinstance(right, t.Vector):
        return "vectors of one size are needed"
    return "expected numbers or vectors"


def check_condition(c: Context, node: ast.expr) -> ExprInfo:
    """An expression whose truth is asked: a bool, or a number that is compared with zero as Python does."""
    if isinstance(node, ast.BoolOp):
        infos = [check_condition(c, value) for value in node.values]
        info = ExprInfo(t.BOOL, writes=any(info.writes for info in infos))
        if any(isinstance(info.type, Invalid) for info in infos):
            info = ExprInfo(INVALID)
        c.instance.info[node] = info
        return info
    info = c.check(node)
    if isinstance(info.type, Invalid) or info.type == t.BOOL:
        return info
    if is_number(info.type):
        if is_weak(info.type):
            c.settle(node)
        if info.constant is not None:
            info.constant = bool(info.constant)
        info.converted = t.BOOL
        return info
    note = "compare components, or use == and != of whole vectors" if isinstance(info.type, t.Vector) else "expected a bool"
    return c.error("OX302", node, f"a condition must be a bool or a number, this is {describe(info.type)}", note)


def check_boolean(c: Context, node: ast.BoolOp) -> ExprInfo:
    """`a and b`, `a or b` as values: of bools only, because Python would give one of the operands."""
    infos = [c.check(value) for value in node.values]
    writes = any(info.writes for info in infos)
    if any(isinstance(info.type, Invalid) for info in infos):
        return ExprInfo(INVALID)
    word = "and" if isinstance(node.op, ast.And) else "or"
    for value, info in zip(node.values, infos, strict=True):
        if info.type != t.BOOL:
            return c.error("OX303", value, f"`{word}` takes bools, this is {describe(info.type)}", "write a comparison, e.g. `!= 0`")
    return ExprInfo(t.BOOL, writes=writes)


def check_compare(c: Context, node: ast.Compare) -> ExprInfo:
    """`a < b <= c`; all operands meet in one type."""
    operands = [node.left, *node.comparators]
    infos = [c.check(operand) for operand in operands]
    if any(isinstance(info.type, Invalid) for info in infos):
        return ExprInfo(INVALID)
    for op in node.ops:
        if isinstance(op, ast.In | ast.NotIn):
            return c.error("OX405", node, "`in` is not part of restricted Python", "compare with each value")
        if isinstance(op, ast.Is | ast.IsNot):
            return c.error("OX405", node, "`is` is not part of restricted Python", "write == or !=")
    values = [info.constant for info in infos if info.constant is not None]
    results = [fold_comparison(op, a, b) for op, a, b in zip(node.ops, values, values[1:], strict=False)]
    constant = all(results) if len(values) == len(infos) else None
    if constant is not None and all(is_weak(info.type) for info in infos):
        for operand in operands:
            c.settle(operand)
        return ExprInfo(t.BOOL, constant=constant)
    common = _common_of(c, node, operands)
    if common is None:
        return ExprInfo(INVALID)
    for operand in operands:
        if not c.coerce(operand, common, "this operand"):
            return ExprInfo(INVALID)
    return ExprInfo(t.BOOL, constant=constant, writes=any(info.writes for info in infos))


def _common_of(c: Context, node: ast.Compare, operands: Sequence[ast.expr]) -> t.Type | None:
    common = c.type_of(operands[0])
    for operand in operands[1:]:
        right = c.type_of(operand)
        met = common_type(common, right)
        if met is None:
            c.error("OX303", node, f"{describe(common)} and {describe(right)} cannot be compared", _meeting_note(common, right))
            return None
        common = met
    if is_weak(common):
        common = default_type(common)
    assert not isinstance(common, Invalid) and not is_weak(common)
    ordered = any(not isinstance(op, ast.Eq | ast.NotEq) for op in node.ops)
    comparable = (t.Scalar,) if ordered else (t.Scalar, t.Vector, t.Traversable, t.Texture)
    if not isinstance(common, comparable) or (ordered and common == t.BOOL):
        note = "order scalars; compare vectors by component" if isinstance(common, t.Vector) else "numbers can be compared"
        text = OPERATOR_TEXT[type(node.ops[0])]
        c.error("OX303", node, f"`{text}` does not take {describe(common)}", note)
        return None
    if isinstance(common, t.Vector) and any(not isinstance(c.type_of(operand), t.Vector) for operand in operands):
        c.error("OX303", node, "a vector and a number cannot be compared", f"write {common}(x) around the number")
        return None
    return common


def check_conditional(c: Context, node: ast.IfExp) -> ExprInfo:
    """`a if condition else b`; both branches meet in one type."""
    condition = check_condition(c, node.test)
    then, other = c.check(node.body), c.check(node.orelse)
    if isinstance(then.type, Invalid) or isinstance(other.type, Invalid) or isinstance(condition.type, Invalid):
        return ExprInfo(INVALID)
    common = common_type(then.type, other.type)
    if common is not None and isinstance(common, t.Vector) and not (isinstance(then.type, t.Vector) and isinstance(other.type, t.Vector)):
        common = None
    if common is None or isinstance(common, t.Void):
        message = f"the branches are {describe(then.type)} and {describe(other.type)}"
        return c.error("OX302", node, message, "both must give one type")
    writes = condition.writes or then.writes or other.writes
    if not is_weak(common) and not isinstance(common, Invalid):
        if isinstance(common, t.Tuple):
            c.settle(node.body)
            c.settle(node.orelse)
            common = default_type(common)
        for branch in (node.body, node.orelse):
            if not c.coerce(branch, default_type(common), "this branch"):
                return ExprInfo(INVALID)
    return ExprInfo(common, writes=writes, fresh=then.fresh and other.fresh)
