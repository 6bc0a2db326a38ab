"""Area D: which kinds of programs may call which device function, by the matrix of the guide (chapter 13), function by function.

The matrix is written down here once more, apart from the compiler's table, as groups of functions with the letters of the programs.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import optixc as ox
from optixc import driver, toolchain
from optixc.frontend.compile import compile_file
from optixc.ir.intrinsic_rows import ROWS
from optixc.ir.intrinsics import Effect, Generic, Intrinsic
from optixc.ir.programs import ProgramKind
from optixc.ir.types import TRAVERSABLE, VOID, FixedArray, Matrix, Tuple
from optixc.options import CompileOptions

LETTERS = {"RG": "raygen", "IS": "intersection", "AH": "anyhit", "CH": "closesthit", "MS": "miss", "EX": "exception",
           "DC": "direct_callable", "CC": "continuation_callable"}
EVERYWHERE = "RG IS AH CH MS EX DC CC"
CURVES = ("LinearCurve", "QuadraticBSpline", "QuadraticBSplineRocaps", "CubicBSpline", "CubicBSplineRocaps", "CatmullRom",
          "CatmullRomRocaps", "CubicBezier", "CubicBezierRocaps", "Ribbon")
VERTEX_DATA = [f"Get{kind}VertexData" for kind in ("Triangle", *CURVES)]
SPACES = ("WorldToObject", "ObjectToWorld")
TRANSFORMED = [f"Transform{what}From{a}To{b}Space" for what in ("Point", "Vector", "Normal")
               for a, b in (("World", "Object"), ("Object", "World"))]
OF_A_HIT = ["GetGASTraversableHandle", *(f"Get{space}TransformMatrix" for space in SPACES), *TRANSFORMED, "GetTransformListSize",
            "GetTransformListHandle", "GetPrimitiveIndex", "GetSbtGASIndex", "GetInstanceId", "GetInstanceIndex"]
OF_A_RAY = ["GetWorldRayOrigin", "GetWorldRayDirection", "GetRayTmin", "GetRayTmax", "GetRayTime", "GetRayFlags"]
OF_ATTRIBUTES = [*VERTEX_DATA, "GetRibbonNormal", "GetSphereData", "GetClusterId", "GetHitKind", "GetTriangleBarycentrics",
                 "GetCurveParameter", "GetRibbonParameters", *(f"GetAttribute_{word}" for word in range(8))]
FACES = ["IsFrontFaceHit", "IsBackFaceHit"]
MATRIX: dict[str, list[str]] = {
    EVERYWHERE: ["GetTransformTypeFromHandle", "GetInstanceChildFromHandle", "GetInstanceIdFromHandle", "GetInstanceTransformFromHandle",
                 "GetInstanceInverseTransformFromHandle", "GetStaticTransformFromHandle", "GetMatrixMotionTransformFromHandle",
                 "GetSRTMotionTransformFromHandle", "GetGASMotionTimeBegin", "GetGASMotionTimeEnd", "GetGASMotionStepCount",
                 "GetGASPointerFromHandle", "GetPrimitiveType(kind)", *(f"{face}(kind)" for face in FACES),
                 *(f"{name}FromHandle" for name in VERTEX_DATA), "GetRibbonNormalFromHandle", "GetSphereDataFromHandle",
                 "GetInstanceTraversableFromIAS", "GetLaunchIndex", "GetLaunchDimensions", "UndefinedValue", "GetSbtDataPointer"],
    "RG IS AH CH MS CC DC": ["ThrowException", "DirectCall"],
    "RG CH MS CC DC": ["Traverse", "HitObjectGetTraverseData", *(f"HitObject{what}" for what in (
        "IsHit", "IsMiss", "IsNop", "GetSbtRecordIndex", "GetSbtDataPointer", *OF_A_RAY, *OF_ATTRIBUTES, *OF_A_HIT))],
    "RG CH MS CC": ["Trace", "Invoke", "MakeHitObject", "MakeHitObjectWithRecord", "MakeMissHitObject", "MakeNopHitObject",
                    "HitObjectSetSbtRecordIndex", "ContinuationCall"],
    "IS AH CH MS": ["SetPayloadTypes", *OF_A_RAY, "GetRayVisibilityMask", *(f"{verb}Payload_{n}" for verb in ("Get", "Set")
                                                                           for n in range(32))],
    "IS AH CH": OF_A_HIT,
    "IS AH": ["GetObjectRayOrigin", "GetObjectRayDirection"],
    "AH CH": [*OF_ATTRIBUTES, "GetPrimitiveType", *FACES, "IsTriangleHit", "IsTriangleFrontFaceHit", "IsTriangleBackFaceHit"],
    "RG": ["Reorder"],
    "IS": ["ReportIntersection"],
    "AH": ["TerminateRay", "IgnoreIntersection"],
    "EX": ["GetExceptionCode", *(f"GetExceptionDetail_{n}" for n in range(8))],
}
ALLOWED = {f"optix{name}": set(letters.split()) for letters, names in MATRIX.items() for name in names}
# Device functions that need more than a value for each parameter.
SPECIAL = {"trace": "ox.trace(ox.Traversable(0), float3(0.0), float3(1.0))", "invoke": "ox.invoke()",
           "traverse": "ox.traverse(ox.Traversable(0), float3(0.0), float3(1.0))", "direct_call": "ox.direct_call(0, result=float)",
           "continuation_call": "ox.continuation_call(0, result=float)"}
HEAD = ("import optixc as ox\nfrom optixc import float2, float3\n\n\n@ox.struct\nclass Data:\n    a: float\n\n\n")


def key(row: Intrinsic) -> str:
    """OptiX's name, told apart where one name has a form for the current hit and one for a hit kind."""
    takes_kind = row.optix.removeprefix("optix") in (*FACES, "GetPrimitiveType") and row.parameters
    return f"{row.optix}(kind)" if takes_kind else row.optix


def call(row: Intrinsic) -> str:
    """A call of the row."""
    name = row.overload_of or row.name
    if name in SPECIAL:
        return SPECIAL[name]

    def value(type_: object) -> str:
        if type_ is Generic.RECORD_STRUCT:
            return "Data"
        if type_ is Generic.HANDLES:
            return "ox.FixedArray[ox.Traversable, 4]()"
        if isinstance(type_, FixedArray):
            return "ox.TraverseData()"
        text = str(type_)
        return {"Traversable": "ox.Traversable(0)", "float32": "1.0", "int32": "1", "uint32": "1", "bool": "True"}.get(text, f"{text}(1.0)")

    return f"ox.{name}({', '.join(value(one.type) for one in row.parameters)})"


DEVICE_ROWS = {key(row): row for row in ROWS if row.optix and key(row) in ALLOWED}
UNWRITTEN = {key(row) for row in ROWS if row.optix} - ALLOWED.keys()


def test_every_row_has_its_line_in_the_matrix() -> None:
    # Cooperative vectors and texture footprints are available in all programs and have tests of their own.
    assert {name for name in UNWRITTEN if not re.match(r"optix(CoopVec|TexFootprint|GetExceptionLineInfo)", name)} == set()


@pytest.mark.parametrize("letters", MATRIX)
def test_T027_T028_who_may_call(letters: str, tmp_path: Path) -> None:
    path = tmp_path / "shader.py"
    wrong = []
    for name in (f"optix{one}" for one in MATRIX[letters]):
        if name not in DEVICE_ROWS:
            continue
        allowed = {LETTERS[letter] for letter in ALLOWED[name]}
        for kind in ProgramKind:
            path.write_text(f"{HEAD}@ox.program\ndef __{kind.value}__p():\n    {call(DEVICE_ROWS[name])}\n")
            try:
                compile_file(str(path))
                compiles = True
            except ox.CompileError as error:
                compiles = False
                told = [(one.code, one.span.line) for one in error.diagnostics]
                assert told == [("OX304", 12)], f"{name} in {kind.value}: {error}"
            if compiles != (kind.value in allowed):
                wrong.append(f"{name} in {kind.value} {'compiles' if compiles else 'is refused'}")
    assert wrong == []


def test_T028_every_function_of_the_matrix_is_there() -> None:
    # The guide gives every form of the transform list; nothing of the matrix is missing here.
    assert sorted(ALLOWED.keys() - DEVICE_ROWS.keys()) == []


def statuses() -> dict[str, bool]:
    """What the page for OptiX users says about each device function: whether it is there."""
    page = (Path(__file__).parents[2] / "docs" / "coming_from_optix.md").read_text()
    lines = [line.split(" | ") for line in page.splitlines() if line.startswith("| optix") and line.count(" | ") == 4]
    return {name.removeprefix("| ").split(" to ")[0]: there == "yes" for name, _, _, there, _ in lines}


def shader_with(names: list[str]) -> str:
    """Each function in a program of a kind that may call it; results are printed, so that the C++ compiler sees every one."""
    parts = [HEAD]
    for letter, kind in LETTERS.items():
        mine = [name for name in names if next(one for one in LETTERS if one in ALLOWED[name]) == letter]
        # what must come first, and what nothing may follow
        mine.sort(key=lambda name: (name != "optixSetPayloadTypes", DEVICE_ROWS[name].effect is Effect.ENDS_PROGRAM))
        lines = [f"    {line}" for number, name in enumerate(mine) for line in use(DEVICE_ROWS[name], f"v{number}")]
        result, tail = (" -> float", ["    return 1.0"]) if kind.endswith("callable") else ("", [])
        parts.append("\n".join(["@ox.program", f"def __{kind}__p(){result}:", *(lines or ["    pass"]), *tail]))
    return "\n\n\n".join(parts) + "\n"


def use(row: Intrinsic, name: str) -> list[str]:
    """Statements that call the row and need its result."""
    if row.effect in (Effect.ENDS_PROGRAM, Effect.ENDS_LAUNCH_INDEX):
        return ["if ox.get_launch_index().x > 3:", f"    {call(row)}"]
    if row.result == VOID:
        return [call(row)]
    shown = {Matrix: "{0}[0]", FixedArray: "{0}[0]", Generic: "{0}.a"}.get(type(row.result), "{0}")
    if isinstance(row.result, Tuple):
        item, type_ = next((number, item) for number, item in enumerate(row.result.items) if item != TRAVERSABLE)
        shown = f"{{0}}[{item}]" + "[0]" * isinstance(type_, Matrix)
    if row.result == TRAVERSABLE:
        shown = "ox.get_instance_id_from_handle({0})"
    return [f"{name} = {call(row)}", f"print({shown.format(name)})"]


def compiles(folder: Path, names: list[str], simd: int) -> str:
    """What the C++ compiler has to say about a pipeline with all of these functions, unoptimised."""
    path = folder / "shader.py"
    path.write_text(shader_with(names))
    options = CompileOptions(simd=simd, optimization=0, max_trace_depth=2,
                             pipeline=ox.PipelineCompileOptions(uses_motion_blur=True, exception_flags=ox.ExceptionFlags(7)))
    module = compile_file(str(path)).module
    emitted = driver.emit([module], [program.name for program in module.programs], options)
    try:
        toolchain.compile_shared(emitted.text, folder / "pipeline.so", toolchain.find_compiler(), driver.recipe(options))
    except ox.ToolchainError as error:
        return str(error)
    return ""


@pytest.mark.parametrize("simd", [1, 8, 16])
def test_functions_that_are_there_compile(tmp_path: Path, simd: int) -> None:
    names = [name for name in DEVICE_ROWS if statuses().get(name, re.search(r"_\d+$", name) is not None)]
    assert len(names) > 200
    assert compiles(tmp_path, names, simd) == ""


@pytest.mark.parametrize("name", [name for name, there in statuses().items() if not there and name in DEVICE_ROWS] or [None])
def test_functions_that_are_missing_do_not(tmp_path: Path, name: str | None) -> None:
    assert name is None or compiles(tmp_path, [name], 1) != "", f"{name} is there: run docs/make_coming_from_optix.py"
