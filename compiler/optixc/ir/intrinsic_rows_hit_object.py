"""Rows: the outgoing hit object, its getters and makers, and reorder."""

from __future__ import annotations

from optixc.ir import types as t
from optixc.ir.intrinsic_naming import Parameters, device
from optixc.ir.intrinsic_rows_hit import MATRIX, TRANSFORM_FUNCTIONS, VERTEX_FUNCTIONS
from optixc.ir.intrinsic_rows_ray import ATTRIBUTE_WORDS, TRACERS, TRAVERSERS
from optixc.ir.intrinsics import Effect, Generic, Intrinsic, State
from optixc.ir.programs import RG

_GETTERS: tuple[tuple[str, t.Type, str], ...] = (
    ("IsHit", t.BOOL, "Whether it is a hit."),
    ("IsMiss", t.BOOL, "Whether it is a miss."),
    ("IsNop", t.BOOL, "Whether it is a nop."),
    ("GetSbtRecordIndex", t.UINT32, "The record that invoke would use."),
    ("GetGASTraversableHandle", t.TRAVERSABLE, "The geometry acceleration structure, 0 if not a hit."),
    ("GetWorldRayOrigin", t.FLOAT3, "The ray's origin."),
    ("GetWorldRayDirection", t.FLOAT3, "The ray's direction."),
    ("GetRayTmin", t.FLOAT32, "The ray's tmin."),
    ("GetRayTmax", t.FLOAT32, "The hit's distance, or tmax of a miss."),
    ("GetRayTime", t.FLOAT32, "The ray's time."),
    ("GetRayFlags", t.UINT32, "The ray's flags."),
    ("GetWorldToObjectTransformMatrix", MATRIX, "World to object at the ray's time."),
    ("GetObjectToWorldTransformMatrix", MATRIX, "Object to world at the ray's time."),
    ("GetTransformListSize", t.UINT32, "Number of transforms; 0 for miss and nop."),
    ("GetClusterId", t.UINT32, "The cluster's id, all ones outside of clusters."),
    ("GetPrimitiveIndex", t.UINT32, "The primitive's index."),
    ("GetSbtGASIndex", t.UINT32, "SBT index inside the geometry acceleration structure."),
    ("GetInstanceId", t.UINT32, "The instance's id."),
    ("GetInstanceIndex", t.UINT32, "The instance's index."),
    ("GetHitKind", t.UINT32, "The hit kind."),
    ("GetTriangleBarycentrics", t.FLOAT2, "(u, v) of a triangle."),
    ("GetCurveParameter", t.FLOAT32, "u of a curve."),
    ("GetRibbonParameters", t.FLOAT2, "(u, v) of a ribbon."),
    *((f"GetAttribute_{i}", t.UINT32, f"Word {i} of the attributes.") for i in range(ATTRIBUTE_WORDS)),
    *((f"Get{function}", result, doc) for function, result, doc in VERTEX_FUNCTIONS),
)

TRAVERSE_DATA = t.FixedArray(t.UINT32, 20)
"""A hit as words that can be stored: `ox.TraverseData`."""

_RAY_OF_HIT = (("handle", t.TRAVERSABLE), ("origin", t.FLOAT3), ("direction", t.FLOAT3), ("tmin", t.FLOAT32))
_TRANSFORMS = (("transforms", Generic.HANDLES), ("num_transforms", t.UINT32))
_FORMULA = (("sbt_offset", t.UINT32), ("sbt_stride", t.UINT32))
_ATTRIBUTES: Parameters = tuple((f"attribute_{i}", t.UINT32, 0) for i in range(ATTRIBUTE_WORDS))
_NUMBERS_OF_HIT: Parameters = (
    ("sbt_gas_index", t.UINT32),
    ("primitive_index", t.UINT32),
    ("hit_kind", t.UINT32),
    *_ATTRIBUTES,
)
_DISTANCE_AND_TIME = (("tmax", t.FLOAT32), ("ray_time", t.FLOAT32))


def _maker(optix: str, parameters: Parameters, doc: str, name: str = "", overload_of: str = "") -> Intrinsic:
    return device(
        optix,
        parameters,
        t.VOID,
        doc,
        effect=Effect.WRITES,
        state=State.HIT_OBJECT,
        allowed=TRACERS,
        name=name,
        overload_of=overload_of,
    )


_HIT_MAKERS: tuple[Intrinsic, ...] = (
    _maker(
        "optixMakeHitObject",
        (*_RAY_OF_HIT, ("ray_time", t.FLOAT32), ("ray_flags", t.UINT32), ("traverse_data", TRAVERSE_DATA), *_TRANSFORMS),
        "Make the outgoing hit object the hit that the traverse data of an earlier one tell, below these transforms.",
    ),
    _maker(
        "optixMakeHitObject",
        (*_RAY_OF_HIT, *_DISTANCE_AND_TIME, *_FORMULA, ("instance_index", t.UINT32), *_NUMBERS_OF_HIT),
        "Make the outgoing hit object a hit at tmax of this primitive; its record by the formula (OptiX 8).",
        name="make_hit_object_of_instance",
        overload_of="make_hit_object",
    ),
    _maker(
        "optixMakeHitObject",
        (*_RAY_OF_HIT, *_DISTANCE_AND_TIME, *_FORMULA, ("instance_index", t.UINT32), *_TRANSFORMS, *_NUMBERS_OF_HIT),
        "Make the outgoing hit object a hit at tmax of this primitive below these transforms; its record by the formula (OptiX 8).",
        name="make_hit_object_below_transforms",
        overload_of="make_hit_object",
    ),
    _maker(
        "optixMakeHitObjectWithRecord",
        (
            *_RAY_OF_HIT,
            *_DISTANCE_AND_TIME,
            ("sbt_record_index", t.UINT32),
            ("instance_index", t.UINT32),
            *_TRANSFORMS,
            *_NUMBERS_OF_HIT,
        ),
        "Make the outgoing hit object a hit at tmax of this primitive with this record (OptiX 8).",
    ),
)

_MAKERS: tuple[Intrinsic, ...] = (
    *_HIT_MAKERS,
    device(
        "optixMakeMissHitObject",
        (
            ("miss_sbt_index", t.UINT32),
            ("origin", t.FLOAT3),
            ("direction", t.FLOAT3),
            ("tmin", t.FLOAT32),
            ("tmax", t.FLOAT32),
            ("ray_time", t.FLOAT32, 0.0),
            ("ray_flags", t.UINT32, 0),
        ),
        t.VOID,
        "Make the outgoing hit object a miss.",
        effect=Effect.WRITES,
        state=State.HIT_OBJECT,
        allowed=TRACERS,
    ),
    device(
        "optixMakeNopHitObject",
        (),
        t.VOID,
        "Make the outgoing hit object a nop.",
        effect=Effect.WRITES,
        state=State.HIT_OBJECT,
        allowed=TRACERS,
    ),
    device(
        "optixHitObjectSetSbtRecordIndex",
        (("index", t.UINT32),),
        t.VOID,
        "Choose the record that invoke uses.",
        effect=Effect.WRITES,
        state=State.HIT_OBJECT,
        allowed=TRACERS,
    ),
    device(
        "optixReorder",
        (("coherence_hint", t.UINT32, 0), ("num_coherence_hint_bits", t.UINT32, 0)),
        t.VOID,
        "Ask for threads to be grouped by hit object and hint; never changes results.",
        effect=Effect.WRITES,
        state=State.HIT_OBJECT,
        allowed=frozenset({RG}),
    ),
)

ROWS: tuple[Intrinsic, ...] = (
    *(
        device(f"optixHitObject{function}", (), result, f"Outgoing hit object: {doc}", state=State.HIT_OBJECT, allowed=TRAVERSERS)
        for function, result, doc in _GETTERS
    ),
    *(
        device(
            f"optixHitObject{function}",
            (("value", t.FLOAT3),),
            t.FLOAT3,
            "Through the outgoing hit object's transforms; not normalised.",
            state=State.HIT_OBJECT,
            allowed=TRAVERSERS,
        )
        for function in TRANSFORM_FUNCTIONS
    ),
    device(
        "optixHitObjectGetTraverseData",
        (),
        TRAVERSE_DATA,
        "The hit as words that make_hit_object takes.",
        state=State.HIT_OBJECT,
        allowed=TRAVERSERS,
    ),
    device(
        "optixHitObjectGetTransformListHandle",
        (("index", t.UINT32),),
        t.TRAVERSABLE,
        "Outgoing hit object: transform `index`, 0 outermost.",
        state=State.HIT_OBJECT,
        allowed=TRAVERSERS,
    ),
    device(
        "optixHitObjectGetRibbonNormal",
        (("parameters", t.FLOAT2),),
        t.FLOAT3,
        "Outgoing hit object: geometric normal of the ribbon.",
        state=State.HIT_OBJECT,
        allowed=TRAVERSERS,
    ),
    device(
        "optixHitObjectGetSbtDataPointer",
        (("struct", Generic.RECORD_STRUCT),),
        Generic.RECORD_STRUCT,
        "The data of the record that invoke would use, as the given struct.",
        state=State.HIT_OBJECT,
        allowed=TRAVERSERS,
        name="hit_object_get_sbt_data",
        cpp="oxrt::hitObjectGetSbtData",
    ),
    *_MAKERS,
)
