"""Small pieces of IR made by hand, for tests of passes and emitters that shall not need a front end."""

from __future__ import annotations

from optixc.ir import nodes as n
from optixc.ir import types as t
from optixc.ir.programs import program_kind
from optixc.source import Span

MATERIAL = t.Struct("Material", t.StructKind.PLAIN, (t.StructField("albedo", t.FLOAT3),))
RADIANCE = t.Struct("Radiance", t.StructKind.PAYLOAD, (t.StructField("color", t.FLOAT3),))
PARAMS = t.Struct(
    "Params",
    t.StructKind.PLAIN,
    (
        t.StructField("image", t.Array(t.FLOAT4, 2)),
        t.StructField("scene", t.TRAVERSABLE),
        t.StructField("eye", t.FLOAT3),
        t.StructField("count", t.INT32),
        t.StructField("uses_sky", t.BOOL),
    ),
)


def at(line: int) -> Span:
    """A place in the made-up file shader.py."""
    return Span("shader.py", line, 4, line, 20)


def local(name: str, type_: t.Type, by_reference: bool = False) -> n.Local:
    return n.Local(name, type_, by_reference)


def ref(local_: n.Local) -> n.LocalRef:
    return n.LocalRef(local_)


def number(value: float, type_: t.Scalar = t.FLOAT32) -> n.Literal:
    return n.Literal(value, type_)


def param(name: str) -> n.FieldRef:
    """A field of the launch parameters."""
    field = PARAMS.field(name)
    assert field is not None
    return n.FieldRef(n.ParamsRef(PARAMS), name, field.type)


def binary(op: str, left: n.Expr, right: n.Expr, type_: t.Type | None = None) -> n.Binary:
    operator = n.BinaryOp(op)
    comparisons = ("==", "!=", "<", "<=", ">", ">=")
    return n.Binary(operator, left, right, type_ or (t.BOOL if op in comparisons else left.type), at(1))


def component(base: n.Expr, index: int) -> n.ComponentRef:
    scalar = t.scalar_of(base.type)
    assert scalar is not None
    return n.ComponentRef(base, (index,), scalar)


def call(name: str, type_: t.Type, *arguments: n.Expr) -> n.IntrinsicCall:
    return n.IntrinsicCall(name, arguments, type_, at(1))


def assign(target: n.Local | n.Place, value: n.Expr, line: int = 1) -> n.Assign:
    return n.Assign(ref(target) if isinstance(target, n.Local) else target, value, at(line))


def trace(payload: n.Expr | None, flags: n.Expr | None = None, line: int = 1, name: str = "trace") -> n.Trace:
    """A trace of the parameters' scene with every argument at its default."""
    uint = t.UINT32
    arguments = (
        param("scene"),
        param("eye"),
        n.Literal((0.0, 0.0, -1.0), t.FLOAT3),
        number(0.0),
        number(1e16),
        number(0.0),
        number(255, uint),
        flags or number(0, uint),
        number(0, uint),
        number(1, uint),
        number(0, uint),
    )
    payload_type = payload.type if payload is not None else None
    assert payload_type is None or isinstance(payload_type, t.Struct)
    return n.Trace(name, arguments, payload, payload_type, at(line))


def function(
    name: str,
    body: tuple[n.Stmt, ...],
    parameters: tuple[n.Parameter, ...] = (),
    locals_: tuple[n.Local, ...] = (),
    result: t.Type = t.VOID,
    line: int = 1,
) -> n.Function:
    """A program if the name has a program's prefix, else a helper."""
    return n.Function(name, name, program_kind(name), parameters, result, locals_, body, at(line))


def payload(local_: n.Local) -> n.Parameter:
    return n.Parameter(local_, n.ParameterRole.PAYLOAD, written=True)


def record(local_: n.Local) -> n.Parameter:
    return n.Parameter(local_, n.ParameterRole.RECORD)


def pinhole_module() -> n.Module:
    """One program of each kind that a first picture needs."""
    ray, index = local("ray", RADIANCE), local("i", t.UINT3)
    pixel = n.ElementRef(param("image"), (component(ref(index), 1), component(ref(index), 0)), t.FLOAT4, at(6))
    color = n.FieldRef(ref(ray), "color", t.FLOAT3)
    raygen = function(
        "__raygen__pinhole",
        (
            assign(index, call("get_launch_index", t.UINT3), 3),
            assign(ray, n.Construct(RADIANCE, (n.Literal((0.0, 0.0, 0.0), t.FLOAT3),)), 4),
            trace(ref(ray), line=5),
            n.Assign(pixel, n.Construct(t.FLOAT4, (color, number(1.0))), at(6)),
        ),
        locals_=(index, ray),
        line=2,
    )
    hit, material, corners = local("ray", RADIANCE, True), local("material", MATERIAL), local("corners", t.Tuple((t.FLOAT3,) * 3))
    edge = binary("-", n.TupleItem(ref(corners), 1, t.FLOAT3), n.TupleItem(ref(corners), 0, t.FLOAT3))
    shade = binary(
        "*",
        n.FieldRef(ref(material), "albedo", t.FLOAT3),
        call("abs", t.FLOAT32, call("dot", t.FLOAT32, edge, call("get_world_ray_direction", t.FLOAT3))),
    )
    closesthit = function(
        "__closesthit__matte",
        (
            assign(corners, call("get_triangle_vertex_data", corners.type), 10),
            assign(n.FieldRef(ref(hit), "color", t.FLOAT3), shade, 11),
        ),
        (payload(hit), record(material)),
        (corners,),
        line=9,
    )
    sky = n.Literal((0.5, 0.7, 1.0), t.FLOAT3)
    miss = function("__miss__sky", (assign(n.FieldRef(ref(hit), "color", t.FLOAT3), sky, 15),), (payload(hit),), line=14)
    return n.Module("shader", "shader.py", (PARAMS, MATERIAL, RADIANCE), PARAMS, (), (raygen, closesthit, miss))
