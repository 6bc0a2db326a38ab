"""Static types of the device functions and of the vector classes, as stub files made from the tables that the compiler reads."""

from __future__ import annotations

import re

from optixc.frontend.builtin_names import SPECIAL_FORMS
from optixc.ir import types as t
from optixc.ir.intrinsic_rows import INTRINSICS, OVERLOADS, ROWS
from optixc.ir.intrinsics import Generic, Intrinsic, IntrinsicParameter, ParameterType

_HEAD = '''"""Device functions for editors and type checkers. Written by docs/generate.py from the table of device functions."""

# mypy: disable-error-code="overload-overlap"

from typing import Any, TypeVar, overload

from optixc.host.annotations import Texture, Traversable
from optixc.host.matrices import float3x3, float3x4, float4x4
from optixc.host.vectors import Vector, float2, float3, float4, uint3

_V = TypeVar("_V", bound=Vector)
_S = TypeVar("_S")
_P = TypeVar("_P", bound=tuple[Any, ...])

{names}
'''
_NAMES = "{names}\n"

_SPECIAL = '''
{traces}
def invoke(payload: _P | Any = ...) -> Any:
    """Run the program that the hit object chose, with this payload."""

def get_sbt_data(struct: type[_S]) -> _S:
    """The data of the current SBT record, as this struct."""

def hit_object_get_sbt_data(struct: type[_S]) -> _S:
    """The data of the hit object's SBT record, as this struct."""

def report_intersection(t: float, hit_kind: int, *attributes: Any) -> bool:
    """Offer a hit at distance t; attributes are a struct or up to 8 words. Whether it was accepted."""

def throw_exception(code: int, *details: float) -> None:
    """End the launch index and run the exception program."""

@overload
def direct_call(index: int, *args: Any, result: type[_S]) -> _S: ...
@overload
def direct_call(index: int, *args: Any) -> None:
    """Call the direct callable of this record; `result` names its type."""

@overload
def continuation_call(index: int, *args: Any, result: type[_S]) -> _S: ...
@overload
def continuation_call(index: int, *args: Any) -> None:
    """Call the continuation callable of this record; `result` names its type."""
'''

_TRACE = '''
@overload
def {name}({parameters}, *, payload: _P) -> _P: ...
@overload
def {name}({parameters}, *, payload: Any = ...) -> None:
    """{doc}"""
'''

_FAMILIES = {
    "bool": "bool",
    **dict.fromkeys(("char", "uchar", "short", "ushort", "int", "uint", "longlong", "ulonglong"), "int"),
    **dict.fromkeys(("half", "float", "double"), "float"),
}

_VECTORS_HEAD = '''"""Vector classes for editors and type checkers. Written by docs/generate.py; `vectors` makes the classes themselves."""

from collections.abc import Iterator, Sequence
from typing import Any, Self, overload

import numpy as np

from optixc.host.vectors import Vector

_Array = np.ndarray[Any, Any]
'''

_ARITHMETIC = ("add", "sub", "mul", "floordiv", "mod", "pow", "radd", "rsub", "rmul", "rfloordiv", "rmod", "rpow")
_OPERATORS = {
    "Floats": ("float", (*_ARITHMETIC, "truediv", "rtruediv")),
    "Integers": ("int", (*_ARITHMETIC, "and", "or", "xor", "rand", "ror", "rxor", "lshift", "rshift")),
}
_OPERATOR = """    @overload
    def __{name}__(self, other: Self | {scalar}) -> Self: ...
    @overload
    def __{name}__(self, other: Any) -> Any: ...
"""
_WIDENED = {"char": "int", "short": "int", "uchar": "uint", "ushort": "uint", "half": "float"}
"""What a field of a storage family is when it is read."""
_BASES = {"bool": "Vector", "int": "_Integers", "float": "_Floats"}


def device_functions_stub() -> str:
    """The text of device_functions.pyi."""
    parts = [_HEAD]
    names = list(dict.fromkeys(row.overload_of or row.name for row in ROWS))
    for name in names:
        if name in SPECIAL_FORMS:
            continue
        rows = OVERLOADS.get(name) or (INTRINSICS[name],)
        signatures = [text for row in rows for text in _signatures(row)]
        doc = rows[0].doc.replace('"', '\\"')
        prefix = "@overload\n" if len(signatures) > 1 else ""
        heads = [f"{prefix}def {name}({signature})" for signature in signatures]
        parts += [f"{head} -> {result}: ...\n" for head, result in zip(heads, _results(rows), strict=True)][:-1]
        parts.append(f'{heads[-1]} -> {_results(rows)[-1]}:\n    """{doc}"""\n\n')
    traces = "".join(_trace(name) for name in ("trace", "traverse"))
    parts.append(_SPECIAL.format(traces=traces.strip("\n") + "\n"))
    text = "".join(parts)
    # As the linter wants them: numbers in names by value.
    public = sorted(set(re.findall(r"^def (\w+)", text, re.MULTILINE)), key=_natural)
    listed = "".join(f'    "{name}",\n' for name in public)
    return text.replace(_NAMES, f"__all__ = [\n{listed}]\n")


def _natural(name: str) -> list[tuple[int, str]]:
    return [(int(part), "") if part.isdigit() else (0, part) for part in re.split(r"(\d+)", name)]


def _trace(name: str) -> str:
    row = INTRINSICS[name]
    parameters = ", ".join(_parameter(parameter, _plain(parameter.type)) for parameter in row.parameters)
    return _TRACE.format(name=name, parameters=parameters, doc=row.doc)


def _plain(type_: ParameterType) -> str:
    """A type of the table as Python's type checkers know it."""
    match type_:
        case t.Scalar(kind=kind):
            return {t.ScalarKind.BOOL: "bool", t.ScalarKind.FLOAT: "float"}.get(kind, "int")
        case t.Tuple(items=items):
            return f"tuple[{', '.join(_plain(item) for item in items)}]"
        case t.Void():
            return "None"
        case t.Vector() | t.Matrix() | t.Traversable() | t.Texture():
            return str(type_)
        case _:
            return "Any"


def _parameter(parameter: IntrinsicParameter, type_: str) -> str:
    return f"{parameter.name}: {type_}" + (" = ..." if parameter.default is not None or parameter.optional else "")


_ANY = frozenset({Generic.HANDLES, Generic.COOP_VEC, Generic.COOP_VEC_OR_NUMBER, Generic.COOP_VEC_TYPE, Generic.MEMORY})
"""Parameters that type checkers take as they come."""

_FORMS: dict[Generic, tuple[str, ...]] = {
    Generic.FLOATS: ("float", "_V"),
    Generic.NUMBERS: ("int", "float", "_V"),
    Generic.INTEGERS: ("int", "_V"),
    Generic.FLOAT_VECTOR: ("_V",),
}


def _forms(row: Intrinsic) -> tuple[str, ...]:
    """What the first argument may be: one signature each."""
    first = row.parameters[0].type if row.parameters else None
    return _FORMS.get(first, ("Any",)) if isinstance(first, Generic) else ("",)


def _signatures(row: Intrinsic) -> list[str]:
    found = []
    for form in _forms(row):
        several = len(row.parameters) > 1 and form == "_V" and row.parameters[0].type is not Generic.FLOAT_VECTOR
        texts = []
        for parameter in row.parameters:
            if parameter.type in _ANY:
                texts.append(_parameter(parameter, "Any"))
            elif row.parameters[0].type is Generic.ARRAY and parameter.name == "index":
                texts.append(_parameter(parameter, "int | tuple[int, ...]"))
            elif isinstance(parameter.type, Generic):
                scalar = "float" if parameter.type is Generic.ELEMENT else form
                texts.append(_parameter(parameter, "_V | float" if several and scalar == "_V" else scalar))
            else:
                texts.append(_parameter(parameter, _plain(parameter.type)))
        found.append(", ".join(texts))
    return found


def _results(rows: tuple[Intrinsic, ...]) -> list[str]:
    found = []
    for row in rows:
        for form in _forms(row):
            if row.result is Generic.SAME:
                found.append(form)
            elif row.result is Generic.COOP_VEC:
                found.append("Any")
            elif row.result is Generic.ELEMENT:
                found.append("Any" if form == "Any" else "float")
            else:
                found.append("Any" if form == "_V" and row.result == t.BOOL else _plain(row.result))
    return found


def vector_types_stub() -> str:
    """The text of vector_types.pyi: operators, components, and what a field of the type may be given (a descriptor's `__set__`)."""
    parts = [_VECTORS_HEAD]
    for base, (scalar, operators) in _OPERATORS.items():
        parts.append(f"\nclass _{base}(Vector):\n{''.join(_OPERATOR.format(name=name, scalar=scalar) for name in operators)}")
    for family, scalar in _FAMILIES.items():
        for size in (2, 3, 4):
            components = "".join(f"    {letter}: {scalar}\n" for letter in "xyzw"[:size])
            given = f"Vector | Sequence[float] | _Array | {'bool' if scalar == 'bool' else 'float'}"
            read = f"{_WIDENED[family]}{size}" if family in _WIDENED else "Self"
            setter = f"    def __get__(self, instance: Any, owner: Any = ...) -> {read}: ...\n"
            setter += f"    def __set__(self, instance: Any, value: {given}) -> None: ...\n"
            items = f"    def __getitem__(self, index: int) -> {scalar}: ...\n    def __iter__(self) -> Iterator[{scalar}]: ...\n"
            items += f"    def __setitem__(self, index: int, value: {'bool' if scalar == 'bool' else 'float'}) -> None: ...\n"
            parts.append(f"\nclass {family}{size}({_BASES[scalar]}):\n{components}{items}{setter}")
    return "".join(parts)
