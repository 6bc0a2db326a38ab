"""Area D: which kinds of programs may call which device function, by the matrix of the guide (chapter 13), function by function.

The matrix is written down here once more, apart from the compiler's table, as groups of functions with the letters of the programs.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import optixc as ox
from optixc.frontend.compile import compile_file
from optixc.ir.intrinsic_rows import ROWS
from optixc.ir.intrinsics import Generic, Intrinsic
from optixc.ir.programs import ProgramKind

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
    "RG CH MS CC DC": ["Traverse", *(f"HitObject{what}" for what in (
        "IsHit", "IsMiss", "IsNop", "GetSbtRecordIndex", "GetSbtDataPointer", *OF_A_RAY, *OF_ATTRIBUTES, *OF_A_HIT))],
    "RG CH MS CC": ["Trace", "Invoke", "MakeMissHitObject", "MakeNopHitObject", "HitObjectSetSbtRecordIndex", "ContinuationCall"],
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
        text = str(type_)
        return {"Traversable": "ox.Traversable(0)", "float32": "1.0", "int32": "1", "uint32": "1", "bool": "True"}.get(text, f"{text}(1.0)")

    return f"ox.{name}({', '.join(value(one.type) for one in row.parameters)})"


DEVICE_ROWS = {key(row): row for row in ROWS if row.optix and key(row) in ALLOWED}
UNWRITTEN = {key(row) for row in ROWS if row.optix} - ALLOWED.keys()


def test_every_row_has_its_line_in_the_matrix() -> None:
    # Cooperative vectors and texture footprints are available in all programs and have tests of their own.
    assert {name for name in UNWRITTEN if not re.match(r"optix(CoopVec|TexFootprint|MakeHitObject|HitObjectGetTraverseData"
                                                       r"|GetExceptionLineInfo)", name)} == set()


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
