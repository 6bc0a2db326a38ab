"""Calls on cooperative vectors that read or write memory, as C++ text for both emitters.

What OptiX has as template arguments is one here too. The first argument says which memory may be touched: all of it (`oxrt::anySpan`),
or only what lies inside of the array, where indices are checked; over lanes it carries the mask.
"""

from __future__ import annotations

from optixc.codegen.cpp_types import TypeNames, scalar_name
from optixc.codegen.names import string_literal
from optixc.enums_extensions import CoopVecElemType, CoopVecMatrixLayout
from optixc.ir.intrinsic_rows import INTRINSICS
from optixc.ir.nodes import CallIntrinsic, Expr, IntrinsicCall, Literal
from optixc.ir.types import CoopVec

MAT_MUL = "coop_vec_mat_mul"
_SETTINGS = 4


def callee(node: IntrinsicCall) -> str:
    """The C++ function of a function of each element; a conversion names what it converts to."""
    cpp = INTRINSICS[node.name].cpp
    if node.name != "coop_vec_cvt":
        return cpp
    assert isinstance(node.type, CoopVec)
    return f"{cpp}<{scalar_name(node.type.element)}>"


def values_of(statement: CallIntrinsic) -> tuple[Expr, ...]:
    """The arguments without the constants of a product."""
    return statement.arguments[:-_SETTINGS] if statement.name == MAT_MUL else statement.arguments


def checked_spans(statement: CallIntrinsic, state: list[str]) -> str:
    """What touches nothing outside of the array; `state` is the thread, and the mask of lanes. A call may go over several lines, so the
    author's line is written down."""
    place = f"oxrt::Place{{{string_literal(statement.span.path)}, {statement.span.line}}}"
    return f"oxrt::checkedSpans({', '.join([*state, place])})"


def memory_call(statement: CallIntrinsic, types: TypeNames, spans: str, arguments: list[str]) -> str:
    """The call; `arguments` are the texts of `values_of`."""
    template = []
    if statement.target is not None:
        template.append(types.name(statement.target.type))
    if statement.name == MAT_MUL:
        settings = [one.value for one in statement.arguments[-_SETTINGS:] if isinstance(one, Literal)]
        inner, matrix, layout, transpose = (int(one) for one in settings if not isinstance(one, tuple))
        template += [f"oxrt::MatrixElement::{CoopVecElemType(one).name}" for one in (inner, matrix)]
        template += [f"oxrt::MatrixLayout::{CoopVecMatrixLayout(layout).name}", "true" if transpose else "false"]
    named = f"<{', '.join(template)}>" if template else ""
    return f"{INTRINSICS[statement.name].cpp}{named}({', '.join([spans, *arguments])})"
