"""Rows: launch, trace and what a program knows of the ray in flight, payload and attributes, any-hit control, exceptions, callables."""

from __future__ import annotations

import math

from optixc.ir import types as t
from optixc.ir.intrinsic_naming import device
from optixc.ir.intrinsics import Effect, Generic, Intrinsic, State
from optixc.ir.programs import AH, ALL_PROGRAMS, CC, CH, DC, EX, IS, MS, RG

RAY_PROGRAMS = frozenset({IS, AH, CH, MS})
TRACERS = frozenset({RG, CH, MS, CC})
TRAVERSERS = frozenset({RG, CH, MS, CC, DC})
CALLERS = ALL_PROGRAMS - {EX}
PAYLOAD_WORDS = 32
ATTRIBUTE_WORDS = 8

TRACE_PARAMETERS = (
    ("handle", t.TRAVERSABLE),
    ("origin", t.FLOAT3),
    ("direction", t.FLOAT3),
    ("tmin", t.FLOAT32, 0.0),
    ("tmax", t.FLOAT32, math.inf),
    ("ray_time", t.FLOAT32, 0.0),
    ("visibility_mask", t.UINT32, 255),
    ("ray_flags", t.UINT32, 0),
    ("sbt_offset", t.UINT32, 0),
    ("sbt_stride", t.UINT32, 1),
    ("miss_sbt_index", t.UINT32, 0),
)
"""In the order of `ir.nodes.Trace.arguments`; `payload` is apart."""

_LAUNCH: tuple[Intrinsic, ...] = (
    device("optixGetLaunchIndex", (), t.UINT3, "The index of this invocation.", state=State.THREAD),
    device("optixGetLaunchDimensions", (), t.UINT3, "Width, height and depth of the launch.", state=State.THREAD),
    device("optixUndefinedValue", (), t.UINT32, "An unspecified word, to end the life of a payload word cheaply.", state=State.NONE),
)

_TRACE: tuple[Intrinsic, ...] = (
    device(
        "optixTrace",
        TRACE_PARAMETERS,
        t.VOID,
        "Find the closest hit in [tmin, tmax], running intersection and any-hit programs, then run closest-hit or miss.",
        effect=Effect.WRITES,
        state=State.THREAD,
        allowed=TRACERS,
    ),
    device(
        "optixTraverse",
        TRACE_PARAMETERS,
        t.VOID,
        "Like trace without closest-hit and miss; the result is the outgoing hit object.",
        effect=Effect.WRITES,
        state=State.THREAD,
        allowed=TRAVERSERS,
    ),
    device(
        "optixInvoke",
        (),
        t.VOID,
        "Run closest-hit or miss of the outgoing hit object, then make it a nop.",
        effect=Effect.WRITES,
        state=State.HIT_OBJECT,
        allowed=TRACERS,
    ),
    device(
        "optixReportIntersection",
        (("t", t.FLOAT32), ("hit_kind", t.UINT32)),
        t.BOOL,
        "Offer a hit at t with a kind of 0 to 127 and attributes; True if it was accepted.",
        effect=Effect.WRITES,
        allowed=frozenset({IS}),
    ),
    device("optixTerminateRay", (), t.VOID, "Accept this hit and end the traversal.", effect=Effect.ENDS_PROGRAM, allowed=frozenset({AH})),
    device("optixIgnoreIntersection", (), t.VOID, "Drop this hit and go on.", effect=Effect.ENDS_PROGRAM, allowed=frozenset({AH})),
    device(
        "optixSetPayloadTypes",
        (("type_ids", t.UINT32),),
        t.VOID,
        "Which payload types this program takes; a constant, the first statement.",
        effect=Effect.WRITES,
        allowed=RAY_PROGRAMS,
    ),
)

_RAY: tuple[Intrinsic, ...] = tuple(
    device(optix, (), result, doc, allowed=allowed)
    for optix, result, doc, allowed in (
        ("optixGetWorldRayOrigin", t.FLOAT3, "The origin passed to trace.", RAY_PROGRAMS),
        ("optixGetWorldRayDirection", t.FLOAT3, "The direction passed to trace.", RAY_PROGRAMS),
        ("optixGetObjectRayOrigin", t.FLOAT3, "The origin in the current object space.", frozenset({IS, AH})),
        ("optixGetObjectRayDirection", t.FLOAT3, "The direction in the current object space, not normalised.", frozenset({IS, AH})),
        ("optixGetRayTmin", t.FLOAT32, "tmin passed to trace.", RAY_PROGRAMS),
        ("optixGetRayTmax", t.FLOAT32, "Closest hit so far; any-hit: the candidate's distance; miss: tmax of trace.", RAY_PROGRAMS),
        ("optixGetRayTime", t.FLOAT32, "The ray's time, 0 without motion.", RAY_PROGRAMS),
        ("optixGetRayFlags", t.UINT32, "Flags passed to trace, 16 bits.", RAY_PROGRAMS),
        ("optixGetRayVisibilityMask", t.UINT32, "Mask passed to trace, 8 bits.", RAY_PROGRAMS),
    )
)

_PAYLOAD: tuple[Intrinsic, ...] = tuple(
    row
    for i in range(PAYLOAD_WORDS)
    for row in (
        device(f"optixGetPayload_{i}", (), t.UINT32, f"Word {i} of the ray's payload.", allowed=RAY_PROGRAMS),
        device(
            f"optixSetPayload_{i}",
            (("value", t.UINT32),),
            t.VOID,
            f"Write word {i} of the ray's payload.",
            effect=Effect.WRITES,
            allowed=RAY_PROGRAMS,
        ),
    )
)

_ATTRIBUTES: tuple[Intrinsic, ...] = tuple(
    device(f"optixGetAttribute_{i}", (), t.UINT32, f"Word {i} of the hit's attributes.", allowed=frozenset({AH, CH}))
    for i in range(ATTRIBUTE_WORDS)
)

_EXCEPTIONS: tuple[Intrinsic, ...] = (
    device(
        "optixThrowException",
        (("code", t.INT32),),
        t.VOID,
        "End this launch index and run the exception program; code 0 to 2^30 - 1, up to eight words of details.",
        effect=Effect.ENDS_LAUNCH_INDEX,
        state=State.THREAD,
        allowed=CALLERS,
    ),
    device("optixGetExceptionCode", (), t.INT32, "Code of the exception.", state=State.THREAD, allowed=frozenset({EX})),
    *(
        device(
            f"optixGetExceptionDetail_{i}", (), t.UINT32, f"Detail {i} of a user exception.", state=State.THREAD, allowed=frozenset({EX})
        )
        for i in range(8)
    ),
)

_CALLABLES: tuple[Intrinsic, ...] = (
    device(
        "optixDirectCall",
        (("index", t.UINT32),),
        t.VOID,
        "Call the direct callable of a callables record.",
        effect=Effect.WRITES,
        state=State.THREAD,
        allowed=CALLERS,
    ),
    device(
        "optixContinuationCall",
        (("index", t.UINT32),),
        t.VOID,
        "Call the continuation callable of a callables record.",
        effect=Effect.WRITES,
        state=State.THREAD,
        allowed=TRACERS,
    ),
    device(
        "optixGetSbtDataPointer",
        (("struct", Generic.RECORD_STRUCT),),
        Generic.RECORD_STRUCT,
        "The data of the current SBT record as the given struct.",
        state=State.THREAD,
        name="get_sbt_data",
    ),
)

ROWS: tuple[Intrinsic, ...] = (*_LAUNCH, *_TRACE, *_RAY, *_PAYLOAD, *_ATTRIBUTES, *_EXCEPTIONS, *_CALLABLES)
