"""Pages of the language reference that are tables of what the compiler itself reads."""

from __future__ import annotations

import re
from pathlib import Path

from optixc.diagnostics import CODES
from optixc.enums_extensions import CoopVecElemType, CoopVecMatrixLayout
from optixc.ir import types as t
from optixc.ir.intrinsic_rows import ROWS
from optixc.ir.intrinsic_rows_coop_vec import ROWS as COOP_VEC_ROWS
from optixc.ir.intrinsic_rows_hit import ROWS as HIT_ROWS
from optixc.ir.intrinsic_rows_hit_object import ROWS as HIT_OBJECT_ROWS
from optixc.ir.intrinsic_rows_math import ROWS as MATH_ROWS
from optixc.ir.intrinsics import Effect, Generic, Intrinsic, IntrinsicParameter
from optixc.ir.programs import ALL_PROGRAMS

_CASES = Path(__file__).resolve().parents[1] / "tests" / "errors"
_EXPECTATION = re.compile(r"^(.*?)\s*# E\[(OX\d+)\]: (.*?)(?:\s*# E\[.*)?$")

_CONSTANTS = {
    **{("matrix_layout", int(one)): one.name for one in CoopVecMatrixLayout},
    **{(f"{name}_type", int(CoopVecElemType.UNKNOWN)): "UNKNOWN" for name in ("matrix_element", "bias_element")},
    ("input_interpretation", int(CoopVecElemType.UNKNOWN)): "UNKNOWN",
}
"""Defaults that are members of enumerations, by the parameter's name and value."""

_EFFECTS = {
    Effect.ENDS_PROGRAM: " Ends the program.",
    Effect.ENDS_LAUNCH_INDEX: " Ends the launch index.",
}


def device_functions_page() -> str:
    """docs/language/device-functions.md."""
    titles = ("Launch, rays and traces", "The hit", "Hit objects", "Mathematics and memory", "Cooperative vectors")
    groups: dict[str, list[Intrinsic]] = {title: [] for title in titles}
    for row in ROWS:
        if row in HIT_ROWS:
            groups["The hit"].append(row)
        elif row in HIT_OBJECT_ROWS:
            groups["Hit objects"].append(row)
        elif row in MATH_ROWS:
            groups["Mathematics and memory"].append(row)
        elif row in COOP_VEC_ROWS:
            groups["Cooperative vectors"].append(row)
        else:
            groups["Launch, rays and traces"].append(row)
    parts = [
        "# Device functions\n\n<!-- Written by docs/generate.py from the table of device functions. -->\n\n"
        "The rule of names: drop `optix`, write the rest in snake case. Parameters with `=` have a default. Where the table says "
        "*any number*, scalars and vectors of that kind are taken and numbers are spread over vectors. Errors of mathematics are in "
        "[math.md](../math.md).\n"
    ]
    for title, rows in groups.items():
        parts.append(f"\n## {title}\n\n| Function | Result | OptiX | Allowed in | |\n|---|---|---|---|---|\n")
        parts += [_row(row) for row in rows]
    return "".join(parts)


def _row(row: Intrinsic) -> str:
    name = row.overload_of or row.name
    parameters = ", ".join(
        f"{one.name}: {_type(one.type)}" + _default(one) for one in row.parameters
    )
    allowed = "every program" if row.allowed == ALL_PROGRAMS else ", ".join(sorted(kind.value for kind in row.allowed))
    optix = f"`{row.optix}`" if row.optix else ""
    return f"| `{name}({parameters})` | {_type(row.result)} | {optix} | {allowed} | {row.doc}{_EFFECTS.get(row.effect, '')} |\n"


def _default(parameter: IntrinsicParameter) -> str:
    if parameter.optional:
        return " = None"
    if row_constant := _CONSTANTS.get((parameter.name, parameter.default)):
        return f" = {row_constant}"
    return f" = {parameter.default}" if parameter.default is not None else ""


def _type(type_: t.Type | Generic) -> str:
    if isinstance(type_, Generic):
        return {Generic.FLOATS: "any float", Generic.NUMBERS: "any number", Generic.INTEGERS: "any integer"}.get(type_, type_.value)
    return str(type_)


def errors_page() -> str:
    """docs/language/errors.md: each code with what it says in a real case, taken from the error cases of the tests."""
    examples: dict[str, tuple[str, str]] = {}
    for path in sorted(_CASES.glob("*.py")):
        for line in path.read_text(encoding="utf-8-sig").splitlines():
            found = _EXPECTATION.match(line)
            if found is not None and found[1].strip() and found[2] not in examples:
                examples[found[2]] = (found[1].strip().replace("|", "\\|"), found[3].strip().replace("|", "\\|"))
    rows = []
    for code, meaning in CODES.items():
        line, text = examples.get(code, ("", ""))
        rows.append(f"| {code} | {meaning} | {f'`{line}`' if line else ''} | {text} |\n")
    return (
        "# Errors\n\n<!-- Written by docs/generate.py from the table of codes and the error cases of the tests. -->\n\n"
        "Every mistake in a shader is reported when its module is created, all of them at once, as "
        "`file:line:column: error[OXnnn]: text` with the line and a caret; `ox.CompileError.diagnostics` holds them as data. After that "
        "compiling cannot fail: a failure would be a bug of ours.\n\n"
        "| Code | Meaning | A line that has it | What it says there |\n|---|---|---|---|\n" + "".join(rows)
    )


