"""Rows: cooperative vectors, the products of matrices with them, and the accumulators that training adds to.

OptiX's template arguments are arguments here, by keyword: types, layouts and flags must be constants. Arrays stand for pointers, with
offsets in bytes as in OptiX. `check_coop_vec` knows which types go together; the rows say what stands in the manual.
"""

from __future__ import annotations

from optixc.enums_extensions import CoopVecElemType, CoopVecMatrixLayout
from optixc.ir.intrinsic_naming import Parameters, device, parameters_of
from optixc.ir.intrinsics import Effect, Generic, Intrinsic, IntrinsicParameter, ParameterType, State
from optixc.ir.types import BOOL, INT32, UINT32, VOID

_VECTOR, _TYPE, _MEMORY = Generic.COOP_VEC, Generic.COOP_VEC_TYPE, Generic.MEMORY


def _row(optix: str, parameters: Parameters, result: ParameterType, doc: str, effect: Effect = Effect.PURE) -> Intrinsic:
    return device(f"optixCoopVec{optix}", parameters, result, doc, effect=effect, state=State.NONE)


def _one(optix: str, doc: str) -> Intrinsic:
    return _row(optix, (("vector", _VECTOR),), _VECTOR, doc)


def _two(optix: str, doc: str, second: Generic = _VECTOR) -> Intrinsic:
    return _row(optix, (("a", _VECTOR), ("b", second)), _VECTOR, doc)


_MAT_MUL = Intrinsic(
    name="coop_vec_mat_mul",
    optix="optixCoopVecMatMul",
    parameters=(
        *parameters_of((("type", _TYPE), ("vector", _VECTOR), ("matrix", _MEMORY), ("matrix_offset_in_bytes", UINT32, 0))),
        IntrinsicParameter("bias", _MEMORY, optional=True),
        *parameters_of(
            (
                ("bias_offset_in_bytes", UINT32, 0),
                ("row_column_stride_in_bytes", UINT32, 0),
                ("input_interpretation", INT32, int(CoopVecElemType.UNKNOWN)),
                ("matrix_layout", INT32, int(CoopVecMatrixLayout.ROW_MAJOR)),
                ("transpose", BOOL, False),
                ("matrix_element_type", INT32, int(CoopVecElemType.UNKNOWN)),
                ("bias_element_type", INT32, int(CoopVecElemType.UNKNOWN)),
            )
        ),
    ),
    result=_VECTOR,
    cpp="oxrt::coopVecMatMul",
    doc="matrix * vector + bias, as a vector of `type`; an element type that is UNKNOWN is that of the vector or result.",
    effect=Effect.READS,
    state=State.NONE,
)

ROWS: tuple[Intrinsic, ...] = (
    _row(
        "Load",
        (("type", _TYPE), ("array", _MEMORY), ("offset_in_bytes", UINT32, 0)),
        _VECTOR,
        "The vector of `type` that stands in an array, from this offset.",
        Effect.READS,
    ),
    _one("Exp2", "2 to the power of each element."),
    _one("Log2", "Logarithm to base 2 of each element."),
    _one("Tanh", "Hyperbolic tangent of each element."),
    _row(
        "Cvt",
        (("type", _TYPE), ("vector", _VECTOR)),
        _VECTOR,
        "The elements as float16 or float32.",
    ),
    _two("Min", "The smaller of each two elements.", Generic.COOP_VEC_OR_NUMBER),
    _two("Max", "The greater of each two elements.", Generic.COOP_VEC_OR_NUMBER),
    _two("Mul", "Product, element by element."),
    _two("Add", "Sum, element by element."),
    _two("Sub", "Difference, element by element."),
    _two("Step", "0 where the element of b is below that of a, else 1."),
    _row("FFMA", (("a", _VECTOR), ("b", _VECTOR), ("c", _VECTOR)), _VECTOR, "a * b + c, element by element, without rounding in between."),
    _MAT_MUL,
    _row(
        "ReduceSumAccumulate",
        (("vector", _VECTOR), ("array", _MEMORY), ("offset_in_bytes", UINT32, 0)),
        VOID,
        "Add each element to the one in memory, atomically.",
        Effect.WRITES,
    ),
    _row(
        "OuterProductAccumulate",
        (
            ("a", _VECTOR),
            ("b", _VECTOR),
            ("matrix", _MEMORY),
            ("offset_in_bytes", UINT32, 0),
            ("matrix_layout", INT32, int(CoopVecMatrixLayout.TRAINING_OPTIMAL)),
        ),
        VOID,
        "Add a * transpose(b) to the matrix in memory, atomically.",
        Effect.WRITES,
    ),
    _row(
        "GetMatrixSize",
        (
            ("n", UINT32),
            ("k", UINT32),
            ("element_type", INT32),
            ("matrix_layout", INT32, int(CoopVecMatrixLayout.INFERENCING_OPTIMAL)),
            ("row_column_stride_in_bytes", UINT32, 0),
        ),
        UINT32,
        "Bytes of a matrix of n rows and k columns, a multiple of 64; a constant.",
    ),
)

COOP_VEC_NAMES = frozenset(row.name for row in ROWS)

MEMORY_ARGUMENTS: dict[str, int] = {"coop_vec_reduce_sum_accumulate": 1, "coop_vec_outer_product_accumulate": 2}
"""Which argument of a function that writes is the array."""
