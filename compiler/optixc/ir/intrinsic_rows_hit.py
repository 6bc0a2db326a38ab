"""Rows: what a program knows of the hit: primitive, instance, transforms, and the vertices of built-in primitives.

The `from_handle` forms read any geometry that allows random vertex access; OptiX's deprecated short overloads of them are kept.
"""

from __future__ import annotations

from optixc.ir import types as t
from optixc.ir.intrinsic_naming import device, snake_name
from optixc.ir.intrinsics import Intrinsic, State
from optixc.ir.programs import AH, CH, IS

HIT_PROGRAMS = frozenset({IS, AH, CH})
SHADED_PROGRAMS = frozenset({AH, CH})
MATRIX = t.Matrix(3, 4)

VERTEX_FUNCTIONS: tuple[tuple[str, t.Type, str], ...] = (
    ("TriangleVertexData", t.Tuple((t.FLOAT3,) * 3), "Object-space vertices of the triangle at the ray's time."),
    ("LinearCurveVertexData", t.Tuple((t.FLOAT4,) * 2), "Control points of the linear segment, radius in w."),
    ("QuadraticBSplineVertexData", t.Tuple((t.FLOAT4,) * 3), "Control points of the quadratic B-spline, radius in w."),
    ("QuadraticBSplineRocapsVertexData", t.Tuple((t.FLOAT4,) * 3), "Control points of the quadratic B-spline, radius in w."),
    ("CubicBSplineVertexData", t.Tuple((t.FLOAT4,) * 4), "Control points of the cubic B-spline, radius in w."),
    ("CubicBSplineRocapsVertexData", t.Tuple((t.FLOAT4,) * 4), "Control points of the cubic B-spline, radius in w."),
    ("CatmullRomVertexData", t.Tuple((t.FLOAT4,) * 4), "Control points of the Catmull-Rom segment, radius in w."),
    ("CatmullRomRocapsVertexData", t.Tuple((t.FLOAT4,) * 4), "Control points of the Catmull-Rom segment, radius in w."),
    ("CubicBezierVertexData", t.Tuple((t.FLOAT4,) * 4), "Control points of the Bezier segment, radius in w."),
    ("CubicBezierRocapsVertexData", t.Tuple((t.FLOAT4,) * 4), "Control points of the Bezier segment, radius in w."),
    ("RibbonVertexData", t.Tuple((t.FLOAT4,) * 3), "Control points of the ribbon's axis, half width in w."),
    ("SphereData", t.FLOAT4, "Centre and radius of the sphere."),
)

_FROM_HANDLE = (("gas", t.TRAVERSABLE), ("primitive_index", t.UINT32), ("sbt_gas_index", t.UINT32), ("time", t.FLOAT32))

TRANSFORM_FUNCTIONS = tuple(
    f"Transform{what}From{way}Space" for what in ("Point", "Vector", "Normal") for way in ("WorldToObject", "ObjectToWorld")
)


def _vertex_rows() -> list[Intrinsic]:
    rows = []
    for function, result, doc in VERTEX_FUNCTIONS:
        optix = f"optixGet{function}"
        rows.append(device(optix, (), result, doc, allowed=SHADED_PROGRAMS))
        rows.append(device(f"{optix}FromHandle", _FROM_HANDLE, result, doc, state=State.THREAD))
        short = f"{snake_name(optix)}_of_geometry"
        rows.append(device(f"{optix}FromHandle", _FROM_HANDLE, result, doc, state=State.THREAD, name=short, overload_of=snake_name(optix)))
    return rows


_SURFACE: tuple[Intrinsic, ...] = tuple(
    device(optix, (), result, doc, allowed=allowed)
    for optix, result, doc, allowed in (
        ("optixGetPrimitiveIndex", t.UINT32, "Index in the build input, plus its offset.", HIT_PROGRAMS),
        ("optixGetSbtGASIndex", t.UINT32, "SBT index inside the geometry acceleration structure.", HIT_PROGRAMS),
        ("optixGetInstanceId", t.UINT32, "The instance's id, all ones without instance.", HIT_PROGRAMS),
        ("optixGetInstanceIndex", t.UINT32, "The instance's index in its parent, 0 without instance.", HIT_PROGRAMS),
        ("optixGetGASTraversableHandle", t.TRAVERSABLE, "The geometry acceleration structure that was hit.", HIT_PROGRAMS),
        ("optixGetHitKind", t.UINT32, "8 bits: 0xFE and 0xFF for front and back of triangles, else as reported.", SHADED_PROGRAMS),
        ("optixGetPrimitiveType", t.UINT32, "The type of the primitive that was hit, one of ox.PrimitiveType.", SHADED_PROGRAMS),
        ("optixIsFrontFaceHit", t.BOOL, "Whether the front of a built-in primitive was hit.", SHADED_PROGRAMS),
        ("optixIsBackFaceHit", t.BOOL, "Whether the back of a built-in primitive was hit.", SHADED_PROGRAMS),
        ("optixIsTriangleHit", t.BOOL, "Whether a triangle was hit.", SHADED_PROGRAMS),
        ("optixIsTriangleFrontFaceHit", t.BOOL, "Whether the front of a triangle was hit.", SHADED_PROGRAMS),
        ("optixIsTriangleBackFaceHit", t.BOOL, "Whether the back of a triangle was hit.", SHADED_PROGRAMS),
        ("optixGetTriangleBarycentrics", t.FLOAT2, "(u, v) with P = (1 - u - v) v0 + u v1 + v v2.", SHADED_PROGRAMS),
        ("optixGetCurveParameter", t.FLOAT32, "u along the curve segment.", SHADED_PROGRAMS),
        ("optixGetRibbonParameters", t.FLOAT2, "u along the axis, v across in [-1, 1].", SHADED_PROGRAMS),
        ("optixGetClusterId", t.UINT32, "The cluster's id, all ones outside of clusters.", SHADED_PROGRAMS),
        ("optixGetTransformListSize", t.UINT32, "Number of transforms above the primitive.", HIT_PROGRAMS),
        ("optixGetObjectToWorldTransformMatrix", MATRIX, "Object to world at the ray's time.", HIT_PROGRAMS),
        ("optixGetWorldToObjectTransformMatrix", MATRIX, "World to object at the ray's time.", HIT_PROGRAMS),
    )
)

_BEYOND_OPTIX: tuple[Intrinsic, ...] = (
    Intrinsic(
        "get_geometric_normal",
        "",
        (),
        t.FLOAT3,
        "oxrt::getGeometricNormal",
        "Not in OptiX: the normal in object space as the traversal found it, at no cost. Not of unit length; of triangles "
        "(p1 - p0) x (p2 - p0) but for rounding, of spheres and curves outward, of custom primitives 0.",
        state=State.RAY,
        allowed=SHADED_PROGRAMS,
    ),
)

_WITH_ARGUMENTS: tuple[Intrinsic, ...] = (
    device("optixGetTransformListHandle", (("index", t.UINT32),), t.TRAVERSABLE, "Transform `index`, 0 outermost.", allowed=HIT_PROGRAMS),
    *(
        device(f"optix{function}", (("value", t.FLOAT3),), t.FLOAT3, "Through the transform list; not normalised.", allowed=HIT_PROGRAMS)
        for function in TRANSFORM_FUNCTIONS
    ),
    device("optixGetRibbonNormal", (("parameters", t.FLOAT2),), t.FLOAT3, "Geometric normal of the ribbon.", allowed=SHADED_PROGRAMS),
    device(
        "optixGetRibbonNormalFromHandle",
        (*_FROM_HANDLE, ("parameters", t.FLOAT2)),
        t.FLOAT3,
        "Geometric normal of a ribbon.",
        state=State.THREAD,
    ),
    *(
        device(
            optix,
            (("hit_kind", t.UINT32),),
            result,
            doc,
            state=State.NONE,
            name=f"{snake_name(optix)}_of_kind",
            overload_of=snake_name(optix),
        )
        for optix, result, doc in (
            ("optixGetPrimitiveType", t.UINT32, "The primitive type that a hit kind tells."),
            ("optixIsFrontFaceHit", t.BOOL, "Whether a hit kind tells a front face."),
            ("optixIsBackFaceHit", t.BOOL, "Whether a hit kind tells a back face."),
        )
    ),
)

_HANDLES: tuple[Intrinsic, ...] = tuple(
    device(optix, (("handle", t.TRAVERSABLE),), result, doc, state=State.THREAD)
    for optix, result, doc in (
        ("optixGetTransformTypeFromHandle", t.UINT32, "One of ox.TransformType."),
        ("optixGetInstanceIdFromHandle", t.UINT32, "The id of an instance handle, 0 for others."),
        ("optixGetInstanceChildFromHandle", t.TRAVERSABLE, "The child of an instance handle, 0 for others."),
        ("optixGetInstanceTransformFromHandle", MATRIX, "Object to world of an instance handle, zero for others."),
        ("optixGetInstanceInverseTransformFromHandle", MATRIX, "World to object of an instance handle, zero for others."),
        ("optixGetGASMotionTimeBegin", t.FLOAT32, "First time of the structure's motion keys."),
        ("optixGetGASMotionTimeEnd", t.FLOAT32, "Last time of the structure's motion keys."),
        ("optixGetGASMotionStepCount", t.UINT32, "Number of the structure's motion keys."),
        ("optixGetGASPointerFromHandle", t.UINT64, "An address that no other structure has; 0 for other handles."),
    )
)

_INSTANCES: tuple[Intrinsic, ...] = (
    device(
        "optixGetInstanceTraversableFromIAS",
        (("ias", t.TRAVERSABLE), ("index", t.UINT32)),
        t.TRAVERSABLE,
        "The handle of an instance; the structure must allow random instance access.",
        state=State.THREAD,
    ),
)

# Where OptiX gives a pointer to a struct, these give its members; of motion transforms one key.
_MOTION_MEMBERS = (t.TRAVERSABLE, t.UINT32, t.UINT32, t.FLOAT32, t.FLOAT32)
_TRANSFORMS: tuple[Intrinsic, ...] = (
    device(
        "optixGetStaticTransformFromHandle",
        (("handle", t.TRAVERSABLE),),
        t.Tuple((t.TRAVERSABLE, MATRIX, MATRIX)),
        "Child, matrix and inverse of a static transform; zeros for other handles.",
        state=State.THREAD,
    ),
    device(
        "optixGetMatrixMotionTransformFromHandle",
        (("handle", t.TRAVERSABLE), ("key", t.UINT32)),
        t.Tuple((*_MOTION_MEMBERS, MATRIX)),
        "Child, number of keys, flags, begin, end and one key of a matrix-motion transform; zeros for other handles.",
        state=State.THREAD,
    ),
    device(
        "optixGetSRTMotionTransformFromHandle",
        (("handle", t.TRAVERSABLE), ("key", t.UINT32)),
        t.Tuple((*_MOTION_MEMBERS, t.Matrix(4, 4))),
        "Child, number of keys, flags, begin, end and the 16 numbers of one key of an SRT-motion transform; zeros for other handles.",
        state=State.THREAD,
    ),
)

ROWS: tuple[Intrinsic, ...] = (*_SURFACE, *_BEYOND_OPTIX, *_vertex_rows(), *_WITH_ARGUMENTS, *_HANDLES, *_INSTANCES, *_TRANSFORMS)
