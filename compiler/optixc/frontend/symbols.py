"""What a module-level name of a shader file can mean, as data.

`declare` makes symbols from the tree, the checker reads them. A name that shaders cannot use stays known as a `SkippedName`, so that
its use is told with the place of its definition.
"""

from __future__ import annotations

import ast
from dataclasses import dataclass
from typing import TYPE_CHECKING

from optixc.frontend.weak import CheckType, ConstantValue
from optixc.ir import types as t
from optixc.ir.programs import ProgramKind
from optixc.source import Span

if TYPE_CHECKING:
    from optixc.frontend.declarations import Declarations


@dataclass(frozen=True)
class OptixNamespace:
    """`import optixc as ox`: attributes are `BuiltinName`s."""


@dataclass(frozen=True)
class BuiltinName:
    """A name of optixc (`float3`, `trace`, `RayFlags`) or a built-in function of Python (`abs`, `range`) that we know."""

    name: str


@dataclass(frozen=True)
class PythonName:
    """A name of Python's own library that declarations may use: `enum.IntEnum`, `typing.Final`, module `math`."""

    module: str
    name: str


@dataclass(frozen=True, eq=False)
class StructSymbol:
    """An `@ox.struct`, `@ox.payload` or `@ox.attributes` class; `defaults` holds the expressions of fields that have one."""

    type: t.Struct
    defaults: dict[str, ast.expr]
    span: Span
    scope: Declarations


@dataclass(frozen=True, eq=False)
class FunctionSymbol:
    """A program (`kind` set) or a helper. Identity is the definition: two symbols are never equal."""

    name: str
    node: ast.FunctionDef
    kind: ProgramKind | None
    decorator: str
    span: Span
    scope: Declarations


@dataclass(frozen=True, eq=False)
class ParamsSymbol:
    """`params = ox.launch_params(T)`."""

    struct: t.Struct
    span: Span


@dataclass(frozen=True, eq=False)
class ConstantSymbol:
    """A module-level constant: an expression that every use evaluates anew, in the scope of its definition."""

    node: ast.expr
    annotation: ast.expr | None
    span: Span
    scope: Declarations


@dataclass(frozen=True)
class ValueSymbol:
    """A constant that is known already: an enum's member, `math.pi`, a captured value of a live function."""

    type: CheckType
    value: ConstantValue


@dataclass(frozen=True)
class VectorSymbol:
    """A captured vector of a live function."""

    type: t.Vector
    values: tuple[ConstantValue, ...]


@dataclass(frozen=True, eq=False)
class EnumSymbol:
    """An `IntEnum` or `IntFlag`, of the file or of optixc."""

    name: str
    members: dict[str, int]
    is_flag: bool = False


@dataclass(frozen=True, eq=False)
class FileSymbol:
    """An imported helper file."""

    declarations: Declarations


@dataclass(frozen=True)
class SkippedName:
    """A name that exists but means nothing to shaders; `reason` completes "which is ..."."""

    name: str
    reason: str
    span: Span | None
    code: str = "OX310"


Symbol = (
    OptixNamespace
    | BuiltinName
    | PythonName
    | StructSymbol
    | FunctionSymbol
    | ParamsSymbol
    | ConstantSymbol
    | ValueSymbol
    | VectorSymbol
    | EnumSymbol
    | FileSymbol
    | SkippedName
)
