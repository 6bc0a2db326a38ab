"""The names that `optixc` gives to shaders besides the device functions of the intrinsic table: types, decorators, special forms."""

from __future__ import annotations

import math

from optixc.ir import types as t
from optixc.ir.intrinsic_rows_hit_object import TRAVERSE_DATA

_ELEMENTS = {
    "bool": t.BOOL,
    "char": t.INT8,
    "uchar": t.UINT8,
    "short": t.INT16,
    "ushort": t.UINT16,
    "int": t.INT32,
    "uint": t.UINT32,
    "longlong": t.INT64,
    "ulonglong": t.UINT64,
    "half": t.FLOAT16,
    "float": t.FLOAT32,
    "double": t.FLOAT64,
}

SCALAR_TYPES: dict[str, t.Scalar] = {
    "bool": t.BOOL,
    "int": t.INT32,
    "float": t.FLOAT32,
    "int8": t.INT8,
    "uint8": t.UINT8,
    "int16": t.INT16,
    "uint16": t.UINT16,
    "int32": t.INT32,
    "uint32": t.UINT32,
    "int64": t.INT64,
    "uint64": t.UINT64,
    "float16": t.FLOAT16,
    "float32": t.FLOAT32,
    "float64": t.FLOAT64,
}

VECTOR_TYPES: dict[str, t.Vector] = {
    f"{prefix}{size}": t.Vector(element, size) for prefix, element in _ELEMENTS.items() for size in (2, 3, 4)
}

MATRIX_TYPES: dict[str, t.Matrix] = {f"float{rows}x{columns}": t.Matrix(rows, columns) for rows, columns in ((3, 3), (3, 4), (4, 4))}

TYPE_NAMES: dict[str, t.Type] = {
    **SCALAR_TYPES,
    **VECTOR_TYPES,
    **MATRIX_TYPES,
    "Traversable": t.TRAVERSABLE,
    "Texture": t.TEXTURE,
    "TraverseData": TRAVERSE_DATA,
}

PYTHON_TYPE_NAMES = frozenset({"bool", "int", "float"})

ARRAY_RANKS = {"Array": 1, "Array1": 1, "Array2": 2, "Array3": 3}

SIZED_TYPES = frozenset({"FixedArray", "CoopVec"})
"""Types of an element type and a number of elements."""

STRUCT_DECORATORS = {
    "struct": t.StructKind.PLAIN,
    "payload": t.StructKind.PAYLOAD,
    "attributes": t.StructKind.ATTRIBUTES,
}

FUNCTION_DECORATORS = frozenset({"program", "device"})

SPECIAL_FORMS = frozenset(
    {
        "trace",
        "traverse",
        "invoke",
        "report_intersection",
        "throw_exception",
        "direct_call",
        "continuation_call",
        "get_sbt_data",
        "hit_object_get_sbt_data",
        "copy",
        "launch_params",
        "payload_word",
        *SIZED_TYPES,
    }
)

PYTHON_FUNCTIONS = frozenset({"abs", "min", "max", "range", "print", "len", "pow", "breakpoint"})
"""Built-in functions of Python that shaders may call; all others are refused by name."""

MATH_CONSTANTS: dict[str, float] = {"pi": math.pi, "e": math.e, "tau": math.tau, "inf": math.inf, "nan": math.nan}

CONVERSION_REMEDIES = {"round": "ox.rint", "sum": "a loop", "divmod": "`//` and `%`", "sorted": "a loop"}
