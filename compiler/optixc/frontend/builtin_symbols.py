"""Names of optixc as symbols: types, special forms, device functions and enumerations."""

from __future__ import annotations

from enum import IntEnum, IntFlag
from functools import cache

from optixc import enums
from optixc.frontend import builtin_names as names
from optixc.frontend.symbols import BuiltinName, EnumSymbol, FileSymbol, OptixNamespace, PythonName, SkippedName, Symbol, ValueSymbol
from optixc.frontend.weak import WEAK_FLOAT, member_type
from optixc.ir.intrinsic_rows import INTRINSICS


@cache
def builtin_symbol(name: str) -> Symbol | None:
    """What `ox.name` means to a shader, or None."""
    if (
        name in names.TYPE_NAMES
        or name in names.STRUCT_DECORATORS
        or name in names.FUNCTION_DECORATORS
        or name in names.SPECIAL_FORMS
        or name in names.ARRAY_RANKS
        or name in INTRINSICS
    ):
        return BuiltinName(name)
    if name in names.MATH_CONSTANTS:
        return ValueSymbol(WEAK_FLOAT, names.MATH_CONSTANTS[name])
    enum = getattr(enums, name, None)
    if isinstance(enum, type) and issubclass(enum, IntEnum | IntFlag):
        return enum_symbol(enum)
    return None


def enum_symbol(enum: type[IntEnum | IntFlag]) -> EnumSymbol:
    """A live enum class."""
    return EnumSymbol(enum.__name__, {member: int(value) for member, value in enum.__members__.items()}, issubclass(enum, IntFlag))


def python_builtin(name: str) -> Symbol | None:
    """What a name means that nothing in the file binds: Python's own types and the built-in functions that shaders may call."""
    if name in names.PYTHON_TYPE_NAMES or name in names.PYTHON_FUNCTIONS or name in ("tuple", "float", "int"):
        return BuiltinName(name)
    return None


def attribute_of(symbol: Symbol, name: str) -> Symbol | None:
    """What `symbol.name` means for a namespace, file, enum or Python module; None where it means nothing."""
    match symbol:
        case OptixNamespace():
            return builtin_symbol(name) or (PythonName("optixc", name) if name == "stdlib" else None)
        case FileSymbol(declarations=declarations):
            return declarations.lookup(name)
        case EnumSymbol(members=members, is_flag=is_flag):
            return ValueSymbol(member_type(is_flag, members), members[name]) if name in members else None
        case PythonName(module="math", name=""):
            if name in names.MATH_CONSTANTS:
                return ValueSymbol(WEAK_FLOAT, names.MATH_CONSTANTS[name])
            return SkippedName(f"math.{name}", f"a function of Python's math module; write `ox.{name}`", None)
        case PythonName(module=module, name=""):
            return PythonName(module, name)
    return None
