"""What the emitters decide about whole functions and pipelines."""

from __future__ import annotations

from ir_samples import (
    MATERIAL,
    PARAMS,
    RADIANCE,
    assign,
    at,
    binary,
    call,
    function,
    local,
    number,
    param,
    payload,
    pinhole_module,
    ref,
    trace,
)

from optixc.codegen.cpp_pipeline import emit, structs_of
from optixc.codegen.declarations import declarations
from optixc.codegen.header import emit_header
from optixc.codegen.helper_calls import recursive_helpers
from optixc.codegen.needs import needs_of_pipeline
from optixc.codegen.program_classes import program_classes, trace_depth
from optixc.ir import nodes as n
from optixc.ir import types as t
from optixc.passes.callables import callables_with, signatures_called
from optixc.passes.features import features
from optixc.passes.pipeline import link
from optixc.passes.traced_programs import accepts, known_flags

SAME_WORDS = t.Struct("Alike", t.StructKind.PAYLOAD, (t.StructField("a", t.FLOAT32), t.StructField("bc", t.FLOAT2)))
OTHER_WORDS = t.Struct("Other", t.StructKind.PAYLOAD, (t.StructField("color", t.INT3),))


def pipeline_of(*functions: n.Function, **options: object) -> n.Pipeline:
    programs = tuple(function_ for function_ in functions if function_.kind is not None)
    helpers = tuple(function_ for function_ in functions if function_.kind is None)
    return n.Pipeline((), PARAMS, helpers, programs, n.PipelineOptions(**options))  # type: ignore[arg-type]


def tracing(name: str, flags: n.Expr | None = None, *parameters: n.Parameter) -> n.Function:
    """A function that traces a Radiance payload."""
    ray = local("next_ray", RADIANCE)
    body = (assign(ray, n.Construct(RADIANCE, (n.Literal((0.0, 0.0, 0.0), t.FLOAT3),))), trace(ref(ray), flags))
    return function(name, body, parameters, (ray,))


def shader(name: str, struct: t.Struct = RADIANCE) -> n.Function:
    return function(name, (), (payload(local("ray", struct, True)),))


def text_of(pipeline: n.Pipeline) -> str:
    return emit(pipeline, features(pipeline))


# ---- which programs a trace can run -------------------------------------------------------------------------------------------


def test_programs_of_the_same_words_belong_to_a_trace() -> None:
    misses = (shader("__miss__a"), shader("__miss__b", SAME_WORDS), shader("__miss__c", OTHER_WORDS), function("__miss__d", ()))
    pipeline = pipeline_of(tracing("__raygen__a"), *misses)
    (programs,) = program_classes(pipeline, needs_of_pipeline(pipeline)).values()
    assert [program.name for program in programs.miss] == ["__miss__a", "__miss__b", "__miss__d"]


def test_programs_that_address_registers_need_a_payload_as_long() -> None:
    reading = function("__miss__words", (n.CallIntrinsic(None, "set_payload_2", (call("get_payload_0", t.UINT32),), at(1)),))
    too_far = function("__miss__words", (n.CallIntrinsic(None, "set_payload_3", (call("get_payload_0", t.UINT32),), at(1)),))
    assert accepts(pipeline_of(reading), reading, RADIANCE)
    assert not accepts(pipeline_of(too_far), too_far, RADIANCE)
    assert not accepts(pipeline_of(reading), reading, None)


def test_depth_of_traces() -> None:
    assert trace_depth(pipeline_of(tracing("__raygen__a"), shader("__closesthit__a"))) == 1
    deeper = tracing("__closesthit__b", None, payload(local("ray", RADIANCE, True)))
    assert trace_depth(pipeline_of(tracing("__raygen__a"), deeper)) is None
    shadow = number(4 | 8, t.UINT32)
    no_closest_hit = tracing("__closesthit__b", shadow, payload(local("ray", RADIANCE, True)))
    assert trace_depth(pipeline_of(tracing("__raygen__a"), no_closest_hit)) == 2
    assert trace_depth(pipeline_of(function("__raygen__a", ()))) == 0


def test_depth_is_counted_only_where_it_can_be_passed() -> None:
    shadow = number(4 | 8, t.UINT32)
    functions = (tracing("__raygen__a"), tracing("__closesthit__b", shadow, payload(local("ray", RADIANCE, True))))
    assert "countsDepth" in text_of(pipeline_of(*functions, max_trace_depth=1))
    assert "countsDepth" not in text_of(pipeline_of(*functions, max_trace_depth=2))


def test_flags_are_known_through_or() -> None:
    flags = binary("|", number(4, t.UINT32), number(8, t.UINT32))
    assert known_flags(trace(None, flags)) == 12
    assert known_flags(trace(None, n.Convert(param("count"), t.UINT32))) is None


def test_what_no_program_uses_is_not_compiled_in() -> None:
    names = [program.name for program in pinhole_module().programs]
    text = text_of(link([pinhole_module()], names, n.PipelineOptions()))
    for absent in ("hasAnyHit", "hasIntersection", "mayThrow", "countsDepth", "exceptionPending", "isCancelled", "texture"):
        assert absent not in text
    assert "checked(" in text
    assert "checked(" not in text_of(link([pinhole_module()], names, n.PipelineOptions(checks_bounds=False)))


# ---- hidden arguments -----------------------------------------------------------------------------------------------------------


def test_needs_go_through_helpers() -> None:
    inner = function("inner", (n.Return(call("get_ray_tmax", t.FLOAT32), at(1)),), result=t.FLOAT32)
    outer = function("outer", (n.Return(n.HelperCall("inner", (), t.FLOAT32, at(1)), at(1)),), result=t.FLOAT32)
    program = function("__closesthit__a", (n.CallHelper(None, "outer", (), at(1)),))
    needs = needs_of_pipeline(pipeline_of(inner, outer, program))
    assert needs["outer"].ray
    assert needs["__closesthit__a"].ray
    assert not needs["__closesthit__a"].thread


def test_parameters_are_the_callees_own_affair() -> None:
    helper = function("h", (n.Return(param("count"), at(1)),), result=t.INT32)
    program = function("__raygen__a", (n.CallHelper(None, "h", (), at(1)),))
    needs = needs_of_pipeline(pipeline_of(helper, program))
    assert needs["h"].params
    assert needs["__raygen__a"].thread
    assert not needs["__raygen__a"].params


def test_endings_reach_callers() -> None:
    helper = function("h", (n.CallIntrinsic(None, "ignore_intersection", (), at(1)),))
    program = function("__anyhit__a", (n.CallHelper(None, "h", (), at(7)),))
    assert needs_of_pipeline(pipeline_of(helper, program))["__anyhit__a"].ends
    assert "if (oxrt::hasEnded(trace))" in text_of(pipeline_of(helper, program))


def test_throwing_costs_nothing_where_exceptions_are_off() -> None:
    throwing = function("__raygen__a", (n.CallIntrinsic(None, "throw_exception", (number(3, t.INT32),), at(1)),))
    assert "exception" not in text_of(pipeline_of(throwing)).split("*/", 1)[1].lower()
    assert "throwException" in text_of(pipeline_of(throwing, exception_flags=4))


# ---- where locals are declared --------------------------------------------------------------------------------------------------


def test_a_local_is_declared_by_its_first_assignment() -> None:
    x = local("x", t.INT32)
    first = assign(x, number(1, t.INT32))
    body = (first, assign(x, binary("+", ref(x), ref(x))))
    found = declarations(function("f", body, locals_=(x,)))
    assert found.at_statement == {id(first): x}
    assert found.at_top == []


def test_a_local_of_two_branches_is_declared_at_the_top() -> None:
    x = local("x", t.INT32)
    choice = n.If(n.Literal(True, t.BOOL), (assign(x, number(1, t.INT32)),), (assign(x, number(2, t.INT32)),), at(1))
    body = (choice, n.Return(ref(x), at(2)))
    assert declarations(function("f", body, locals_=(x,))).at_top == [x]


def test_a_local_of_one_block_is_declared_in_it() -> None:
    x = local("x", t.INT32)
    inside = assign(x, number(1, t.INT32))
    body = (n.If(n.Literal(True, t.BOOL), (inside, n.Return(ref(x), at(2))), (), at(1)),)
    assert declarations(function("f", body, locals_=(x,))).at_statement == {id(inside): x}


def test_a_local_that_lives_from_turn_to_turn_is_declared_outside() -> None:
    x = local("x", t.INT32)
    turn = n.If(binary("<", ref(x), number(3, t.INT32)), (assign(x, number(1, t.INT32)),), (), at(1))
    body = (n.While((), n.Literal(True, t.BOOL), (turn,), False, at(1)),)
    assert declarations(function("f", body, locals_=(x,))).at_top == [x]


def test_a_loop_declares_what_it_counts_with_unless_it_is_used_later() -> None:
    k = local("k", t.INT32)
    loop = n.ForRange(k, number(0, t.INT32), number(4, t.INT32), number(1, t.INT32), (), at(1))
    assert declarations(function("f", (loop,), locals_=(k,))).at_statement == {id(loop): k}
    assert declarations(function("f", (loop, n.Return(ref(k), at(2))), locals_=(k,))).at_top == [k]
    again = n.ForRange(k, number(0, t.INT32), number(9, t.INT32), number(1, t.INT32), (), at(2))
    assert declarations(function("f", (loop, again), locals_=(k,)), splits_loops=True).at_statement == {id(loop): k, id(again): k}


def test_places_that_are_only_written_are_unread() -> None:
    v = local("v", t.FLOAT3)
    body = (assign(v, n.Literal((0.0, 0.0, 0.0), t.FLOAT3)), assign(n.ComponentRef(ref(v), (0,), t.FLOAT32), number(1.0)))
    assert declarations(function("f", body, locals_=(v,))).unread == {"v"}


# ---- the file --------------------------------------------------------------------------------------------------------------------


def test_structs_come_after_those_that_they_contain() -> None:
    inner = t.Struct("Inner", t.StructKind.PLAIN, (t.StructField("x", t.FLOAT32),))
    outer = t.Struct("Outer", t.StructKind.PLAIN, (t.StructField("inner", t.FixedArray(inner, 2)),))
    pipeline = n.Pipeline((outer, inner), outer, (), (), n.PipelineOptions())
    assert structs_of(pipeline) == [inner, outer]


def test_two_structs_of_one_name_get_two() -> None:
    first = t.Struct("S", t.StructKind.PLAIN, (t.StructField("x", t.FLOAT32),))
    second = t.Struct("S", t.StructKind.PLAIN, (t.StructField("x", t.INT32),))
    text = text_of(n.Pipeline((first, second), None, (), (function("__raygen__a", ()),), n.PipelineOptions()))
    assert "struct S {" in text
    assert "struct S_ {" in text


def test_helpers_that_call_themselves_are_found() -> None:
    def calling(name: str, callee: str) -> n.Function:
        return function(name, (n.Return(n.HelperCall(callee, (), t.FLOAT32, at(1)), at(1)),), result=t.FLOAT32)

    assert recursive_helpers((calling("a", "b"), calling("b", "a"), calling("c", "a"))) == {"a", "b"}


def test_callables_are_grouped_by_signature() -> None:
    value = n.Parameter(local("x", t.FLOAT32))
    one = function("__direct_callable__one", (n.Return(number(1.0), at(1)),), (value,), result=t.FLOAT32)
    two = function("__direct_callable__two", (n.Return(number(1, t.INT32), at(1)),), (value,), result=t.INT32)
    later = function("__continuation_callable__one", (n.Return(number(1.0), at(1)),), (value,), result=t.FLOAT32)
    call_ = n.CallCallable(None, True, number(0, t.UINT32), (number(1.0),), t.FLOAT32, at(1))
    pipeline = pipeline_of(function("__raygen__a", (call_,)), one, two, later)
    (signature,) = signatures_called(pipeline)
    assert callables_with(pipeline, signature) == [one]


def test_the_header_declares_what_hosts_fill() -> None:
    module = pinhole_module()
    text = emit_header(link([module], [program.name for program in module.programs], n.PipelineOptions()), "sky")
    assert "struct { float (*data)[4]; uint64_t shape[2]; } image;" in text
    assert "float albedo[3];" in text
    assert "enum { SKY_PARAMS_SIZE = 56 };" in text
    assert '#define SKY_MISS_SKY "__miss__sky"' in text
    assert "Radiance" not in text
    assert MATERIAL.name in text
