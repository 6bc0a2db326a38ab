"""Calls of the functions of cooperative vectors: their types, the constants that OptiX takes as template arguments, and what fits together.

The table of supported types is OptiX's (guide, chapter 11) with one row more: float32 in all places.
"""

from __future__ import annotations

import ast
from collections.abc import Callable

from optixc import coop_vec_layout as layouts
from optixc.enums_extensions import CoopVecElemType as Element
from optixc.enums_extensions import CoopVecMatrixLayout as Layout
from optixc.frontend.annotations import resolve_type
from optixc.frontend.arguments import bind_arguments
from optixc.frontend.check_intrinsic import require_row
from optixc.frontend.checked import Argument, CoopVecUse, DefaultArgument, ExprInfo
from optixc.frontend.context import Context, describe
from optixc.frontend.weak import INVALID, Invalid, is_number
from optixc.ir import types as t
from optixc.ir.intrinsic_rows import INTRINSICS
from optixc.ir.intrinsics import Effect, Generic, Intrinsic

Given = dict[str, ast.expr | None]

ELEMENTS: dict[t.Scalar, Element] = {
    t.FLOAT16: Element.FLOAT16,
    t.FLOAT32: Element.FLOAT32,
    t.UINT8: Element.UINT8,
    t.INT8: Element.INT8,
    t.UINT32: Element.UINT32,
    t.INT32: Element.INT32,
}
_SCALARS = {element: scalar for scalar, element in ELEMENTS.items()}
_MATRIX_ALIGNMENT, _VECTOR_ALIGNMENT, _ACCUMULATOR_ALIGNMENT = 64, 16, 4
_FLOAT_VECTORS = (Element.FLOAT16, Element.FLOAT32)
_MAKING = "write ox.CoopVec[ox.float16, 32] or the like"
_MAX_OFFSET = (1 << 32) - 1


def check_coop_vec(c: Context, node: ast.Call, name: str) -> ExprInfo:
    """A call of `ox.coop_vec_...`."""
    row = INTRINSICS[name]
    optional = [one.name for one in row.parameters if one.default is not None or one.optional]
    bound = bind_arguments(c, node, name, [one.name for one in row.parameters], optional)
    require_row(c, row, name, node)
    if bound is None:
        return ExprInfo(INVALID)
    given: Given = dict(zip((one.name for one in row.parameters), bound, strict=True))
    if not _check_arguments(c, node, given):
        return ExprInfo(INVALID)
    return _RULES.get(name, _check_elements)(c, node, row, given)


def _check_arguments(c: Context, node: ast.Call, given: Given) -> bool:
    """Checks all arguments but types in the order of the source; `bias=None` is none."""
    bias = given.get("bias")
    if isinstance(bias, ast.Constant) and bias.value is None:
        given["bias"] = None
    fine = True
    for argument in (*node.args, *(keyword.value for keyword in node.keywords)):
        if argument is not given.get("type") and argument is not (bias if given.get("bias") is None else None):
            fine = not isinstance(c.check(argument).type, Invalid) and fine
    return fine


# ---- one argument -------------------------------------------------------------------------------------------------------------


def _vector_type(c: Context, given: Given, name: str = "type") -> t.CoopVec | None:
    node = given[name]
    assert node is not None
    type_ = resolve_type(c.scope, node, c.diagnostics)
    if type_ is not None and not isinstance(type_, t.CoopVec):
        c.error("OX302", node, f"argument `{name}` must be a type of cooperative vectors, this is {type_}", _MAKING)
        return None
    return type_


def _vector(c: Context, node: ast.expr | None, what: str) -> t.CoopVec | None:
    assert node is not None
    type_ = c.info(node).type
    if isinstance(type_, t.CoopVec):
        return type_
    c.error("OX302", node, f"{what} must be a cooperative vector, this is {describe(type_)}", _MAKING)
    return None


def _memory(c: Context, node: ast.expr | None, element: t.Scalar | None, what: str) -> bool:
    """An array whose numbers are of this type, or plain bytes; only bytes for what has no type of its own."""
    assert node is not None
    type_ = c.info(node).type
    wanted = (t.UINT8,) if element is None else (element, t.UINT8)
    if isinstance(type_, t.Array) and type_.element in wanted:
        return True
    expected = " or ".join(f"ox.Array[ox.{one}]" for one in dict.fromkeys(wanted))
    c.error("OX302", node, f"{what} must be {expected}, this is {describe(type_)}", "the bytes of any numpy array are array.view(np.uint8)")
    return False


def _offset(c: Context, given: Given, name: str, alignment: int) -> Argument | None:
    """An offset in bytes; a constant one must be aligned, others are checked when they run."""
    node = given[name]
    if node is None:
        return DefaultArgument(0, t.UINT32)
    constant = c.info(node).constant
    if isinstance(constant, int) and 0 <= constant <= _MAX_OFFSET and constant % alignment:
        note = f"the next one is {-(-constant // alignment) * alignment}"
        c.error("OX322", node, f"`{name}` is {constant}, which is no multiple of {alignment}", note)
        return None
    return node if c.coerce(node, t.UINT32, f"argument `{name}`") else None


def _constant(c: Context, row: Intrinsic, given: Given, name: str) -> int | None:
    """The value of an argument that OptiX takes as a template argument; the default where it is left out."""
    node = given[name]
    if node is None:
        return int(next(one.default for one in row.parameters if one.name == name) or 0)
    constant = c.info(node).constant
    if constant is None or isinstance(constant, float):
        c.error("OX322", node, f"`{name}` must be a constant", "it decides which code is compiled")
        return None
    return int(constant)


def _element(c: Context, row: Intrinsic, given: Given, name: str, default: Element) -> Element | None:
    value = _constant(c, row, given, name)
    if value is None or value == Element.UNKNOWN:
        return None if value is None else default
    if value not in list(Element):
        c.error("OX322", given[name] or ast.Pass(), f"{value} is no element type", "take one of ox.CoopVecElemType")
        return None
    return Element(value)


def _layout(c: Context, row: Intrinsic, given: Given) -> Layout | None:
    value = _constant(c, row, given, "matrix_layout")
    if value is not None and value not in list(Layout):
        c.error("OX322", given["matrix_layout"] or ast.Pass(), f"{value} is no matrix layout", "take one of ox.CoopVecMatrixLayout")
        return None
    return None if value is None else Layout(value)


# ---- the functions ------------------------------------------------------------------------------------------------------------


def _use(c: Context, row: Intrinsic, result: t.Type, arguments: list[Argument], settings: tuple[int, ...] = ()) -> ExprInfo:
    writes = row.effect is Effect.WRITES
    c.instance.writes = c.instance.writes or writes
    writes = writes or any(c.info(one).writes for one in arguments if isinstance(one, ast.expr))
    return ExprInfo(result, use=CoopVecUse(row, tuple(arguments), settings), writes=writes)


def _check_elements(c: Context, node: ast.Call, row: Intrinsic, given: Given) -> ExprInfo:
    """A function of each element: all vectors have one type; min and max take a number for the second."""
    first_name = row.parameters[0].name
    vector = _vector(c, given[first_name], f"argument `{first_name}`")
    if vector is None:
        return ExprInfo(INVALID)
    if row.name in ("coop_vec_exp2", "coop_vec_log2", "coop_vec_tanh") and vector.element.kind is not t.ScalarKind.FLOAT:
        return c.error("OX322", node, f"{row.name}() takes float16 and float32, this is {vector}", "convert it with ox.coop_vec_cvt()")
    for parameter in row.parameters[1:]:
        argument = given[parameter.name]
        assert argument is not None
        what = f"argument `{parameter.name}`"
        if parameter.type is Generic.COOP_VEC_OR_NUMBER and is_number(c.info(argument).type):
            if not c.coerce(argument, vector.element, what):
                return ExprInfo(INVALID)
        elif c.info(argument).type != vector:
            message = f"{what} must be {vector}, this is {describe(c.info(argument).type)}"
            return c.error("OX302", argument, message, "all vectors of a call are of one type")
    return _use(c, row, vector, [one for one in given.values() if one is not None])


def _check_cvt(c: Context, node: ast.Call, row: Intrinsic, given: Given) -> ExprInfo:
    target, source = _vector_type(c, given), _vector(c, given["vector"], "argument `vector`")
    if target is None or source is None:
        return ExprInfo(INVALID)
    if target.size != source.size:
        message = f"{source} has {source.size} elements, {target} has {target.size}"
        return c.error("OX322", node, message, "conversion keeps the number of elements")
    if target.element.kind is not t.ScalarKind.FLOAT:
        message = f"coop_vec_cvt() converts to float16 and float32, not to {target.element}"
        return c.error("OX322", node, message, "convert element by element")
    assert given["vector"] is not None
    return _use(c, row, target, [given["vector"]])


def _check_load(c: Context, node: ast.Call, row: Intrinsic, given: Given) -> ExprInfo:
    target = _vector_type(c, given)
    if target is None or not _memory(c, given["array"], target.element, "argument `array`"):
        return ExprInfo(INVALID)
    offset = _offset(c, given, "offset_in_bytes", _VECTOR_ALIGNMENT)
    assert given["array"] is not None
    return ExprInfo(INVALID) if offset is None else _use(c, row, target, [given["array"], offset])


def _check_mat_mul(c: Context, node: ast.Call, row: Intrinsic, given: Given) -> ExprInfo:
    result, vector = _vector_type(c, given), _vector(c, given["vector"], "argument `vector`")
    layout = _layout(c, row, given)
    transpose = _constant(c, row, given, "transpose")
    if result is None or vector is None or layout is None or transpose is None:
        return ExprInfo(INVALID)
    matrix = _element(c, row, given, "matrix_element_type", ELEMENTS[vector.element])
    inner = _element(c, row, given, "input_interpretation", matrix or Element.UNKNOWN)
    bias = _element(c, row, given, "bias_element_type", ELEMENTS[result.element])
    if matrix is None or inner is None or bias is None:
        return ExprInfo(INVALID)
    problem = _type_problem(vector, inner, matrix, bias, result) or _layout_problem(matrix, layout, bool(transpose))
    if problem is not None:
        return c.error("OX322", node, *problem)
    stored = None if layout in layouts.OPTIMAL else _SCALARS[matrix]
    if not _memory(c, given["matrix"], stored, "argument `matrix`"):
        return ExprInfo(INVALID)
    if given["bias"] is not None and not _memory(c, given["bias"], _SCALARS[bias], "argument `bias`"):
        return ExprInfo(INVALID)
    stride = _stride(c, given, (result.size, vector.size), matrix, layout)
    offset = _offset(c, given, "matrix_offset_in_bytes", _MATRIX_ALIGNMENT)
    bias_offset = _offset(c, given, "bias_offset_in_bytes", _VECTOR_ALIGNMENT)
    if stride is None or offset is None or bias_offset is None:
        return ExprInfo(INVALID)
    assert given["vector"] is not None and given["matrix"] is not None
    arguments: list[Argument] = [given["vector"], given["matrix"], offset, stride]
    if given["bias"] is not None:
        arguments += [given["bias"], bias_offset]
    return _use(c, row, result, arguments, (int(inner), int(matrix), int(layout), transpose))


def _stride(c: Context, given: Given, shape: tuple[int, int], element: Element, layout: Layout) -> Argument | None:
    node = given["row_column_stride_in_bytes"]
    if node is None:
        return DefaultArgument(0, t.UINT32)
    constant = c.info(node).constant
    problem = layouts.stride_problem(*shape, element, layout, constant) if isinstance(constant, int) and constant >= 0 else None
    if problem is not None:
        c.error("OX322", node, problem, "0 stands for no gaps")
        return None
    return node if c.coerce(node, t.UINT32, "argument `row_column_stride_in_bytes`") else None


def _type_problem(vector: t.CoopVec, inner: Element, matrix: Element, bias: Element, result: t.CoopVec) -> tuple[str, str] | None:
    """What does not fit in the types of a product, with the remedy; None for a row of OptiX's table."""
    given = ELEMENTS[vector.element]
    if ELEMENTS[result.element] is not bias:
        return f"the bias is {bias.name}, the result {ELEMENTS[result.element].name}", "both must be of one type"
    if matrix in layouts.BYTES:
        signed = Element.INT8 in (inner, matrix)
        if inner not in layouts.BYTES:
            return f"a matrix of {matrix.name} takes its input as INT8 or UINT8, not as {inner.name}", "leave input_interpretation out"
        wanted = Element.INT32 if signed else Element.UINT32
        if bias is not wanted:
            return f"this product is {wanted.name}, bias and result are {bias.name}", "signed if matrix or input is signed"
        return None
    if matrix not in layouts.FLOATS:
        return f"a matrix cannot hold {matrix.name}", "it holds FLOAT16, FLOAT32, FLOAT8_E4M3, FLOAT8_E5M2, INT8 or UINT8"
    if inner is not matrix:
        return f"a matrix of {matrix.name} takes its input as {matrix.name}, not as {inner.name}", "leave input_interpretation out"
    wanted = Element.FLOAT32 if matrix is Element.FLOAT32 else Element.FLOAT16
    if given is not wanted:
        return f"a matrix of {matrix.name} multiplies vectors of {_SCALARS[wanted]}, this is {vector}", "convert it with ox.coop_vec_cvt()"
    if bias is not wanted:
        return f"this product is {wanted.name}, bias and result are {bias.name}", f"take ox.CoopVec[ox.{_SCALARS[wanted]}, {result.size}]"
    return None


def _layout_problem(matrix: Element, layout: Layout, transpose: bool) -> tuple[str, str] | None:
    remedy = "convert the matrix with coop_vec_matrix_convert() on the host"
    if matrix in layouts.FLOAT8 and layout not in layouts.OPTIMAL:
        return f"a matrix of {matrix.name} has an optimal layout, not {layout.name}", remedy
    if transpose and layout not in layouts.OPTIMAL:
        other = Layout.COLUMN_MAJOR if layout is Layout.ROW_MAJOR else Layout.ROW_MAJOR
        return f"a transposed matrix has an optimal layout, not {layout.name}", f"a transposed {layout.name} is {other.name}"
    if transpose and matrix not in _FLOAT_VECTORS:
        return f"a matrix of {matrix.name} cannot be transposed", "FLOAT16 and FLOAT32 can"
    return None


def _check_reduce(c: Context, node: ast.Call, row: Intrinsic, given: Given) -> ExprInfo:
    vector = _vector(c, given["vector"], "argument `vector`")
    if vector is None:
        return ExprInfo(INVALID)
    if ELEMENTS[vector.element] not in _FLOAT_VECTORS:
        return c.error("OX322", node, f"{row.name}() adds float16 and float32, this is {vector}", "use ox.atomic_add() for integers")
    if not _memory(c, given["array"], vector.element, "argument `array`"):
        return ExprInfo(INVALID)
    offset = _offset(c, given, "offset_in_bytes", _ACCUMULATOR_ALIGNMENT)
    assert given["vector"] is not None and given["array"] is not None
    return ExprInfo(INVALID) if offset is None else _use(c, row, t.VOID, [given["vector"], given["array"], offset])


def _check_outer_product(c: Context, node: ast.Call, row: Intrinsic, given: Given) -> ExprInfo:
    a, b = (_vector(c, given[name], f"argument `{name}`") for name in ("a", "b"))
    layout = _layout(c, row, given)
    if a is None or b is None or layout is None:
        return ExprInfo(INVALID)
    if a.element != b.element or ELEMENTS[a.element] not in _FLOAT_VECTORS:
        message = f"the vectors of an outer product are both float16 or both float32, here are {a} and {b}"
        return c.error("OX322", node, message, "convert one with ox.coop_vec_cvt()")
    if layout is not Layout.TRAINING_OPTIMAL:
        message = f"products are added to a matrix of layout TRAINING_OPTIMAL, not {layout.name}"
        return c.error("OX322", node, message, "coop_vec_matrix_convert() makes other layouts of it on the host")
    if not _memory(c, given["matrix"], None, "argument `matrix`"):
        return ExprInfo(INVALID)
    offset = _offset(c, given, "offset_in_bytes", _ACCUMULATOR_ALIGNMENT)
    assert given["a"] is not None and given["b"] is not None and given["matrix"] is not None
    return ExprInfo(INVALID) if offset is None else _use(c, row, t.VOID, [given["a"], given["b"], given["matrix"], offset])


def _check_matrix_size(c: Context, node: ast.Call, row: Intrinsic, given: Given) -> ExprInfo:
    n, k, stride = (_constant(c, row, given, name) for name in ("n", "k", "row_column_stride_in_bytes"))
    element, layout = _element(c, row, given, "element_type", Element.UNKNOWN), _layout(c, row, given)
    if n is None or k is None or stride is None or element is None or layout is None:
        return ExprInfo(INVALID)
    if element is Element.UNKNOWN or n < 1 or k < 1:
        return c.error("OX322", node, "a matrix has at least one row and column and a known element type", "")
    problem = layouts.stride_problem(n, k, element, layout, stride)
    if problem is None and element in layouts.FLOAT8 and layout not in layouts.OPTIMAL:
        problem = f"a matrix of {element.name} has an optimal layout, not {layout.name}"
    size = layouts.matrix_size(n, k, element, layout, stride)
    if problem is None and size > _MAX_OFFSET:
        problem = f"this matrix has {size} bytes, which are more than 32 bits count"
    if problem is not None:
        return c.error("OX322", node, problem, "")
    return ExprInfo(t.UINT32, constant=size)


_RULES: dict[str, Callable[[Context, ast.Call, Intrinsic, Given], ExprInfo]] = {
    "coop_vec_cvt": _check_cvt,
    "coop_vec_load": _check_load,
    "coop_vec_mat_mul": _check_mat_mul,
    "coop_vec_reduce_sum_accumulate": _check_reduce,
    "coop_vec_outer_product_accumulate": _check_outer_product,
    "coop_vec_get_matrix_size": _check_matrix_size,
}
