"""Bound values, constant conditions, and what is dropped behind them."""

from __future__ import annotations

import math

import pytest
from ir_samples import PARAMS, RADIANCE, assign, at, binary, call, function, local, number, param, pinhole_module, ref, trace

from optixc import passes
from optixc.ir import nodes as n
from optixc.ir import types as t
from optixc.passes import arithmetic
from optixc.passes.features import features
from optixc.passes.fold_constants import fold, fold_constants
from optixc.passes.remove_unused import remove_unused
from optixc.passes.specialize import specialize


def pipeline_of(*programs: n.Function, helpers: tuple[n.Function, ...] = (), **options: object) -> n.Pipeline:
    return n.Pipeline((PARAMS,), PARAMS, helpers, programs, n.PipelineOptions(**options))  # type: ignore[arg-type]


def raygen(*body: n.Stmt, locals_: tuple[n.Local, ...] = ()) -> n.Function:
    return function("__raygen__main", body, locals_=locals_)


def ending(value: float) -> n.CallIntrinsic:
    """A statement that stays whatever happens around it."""
    return n.CallIntrinsic(None, "set_payload_0", (number(value, t.UINT32),), at(1))


def body_of(pipeline: n.Pipeline) -> tuple[n.Stmt, ...]:
    return pipeline.programs[0].body


def test_bound_values_replace_reads_of_the_parameter() -> None:
    x = local("x", t.INT32)
    bound = (("count", number(7, t.INT32)),)
    result = specialize(pipeline_of(raygen(assign(x, param("count")), locals_=(x,)), bound_values=bound))
    assert body_of(result) == (assign(x, number(7, t.INT32)),)


def test_other_parameters_stay() -> None:
    x = local("x", t.INT32)
    pipeline = pipeline_of(raygen(assign(x, param("count")), locals_=(x,)), bound_values=(("uses_sky", n.Literal(True, t.BOOL)),))
    assert body_of(specialize(pipeline)) == body_of(pipeline)


@pytest.mark.parametrize(("value", "kept"), [(True, 1.0), (False, 2.0)])
def test_the_branch_that_cannot_run_goes(value: bool, kept: float) -> None:
    choice = n.If(n.Literal(value, t.BOOL), (ending(1.0),), (ending(2.0),), at(1))
    assert body_of(fold_constants(pipeline_of(raygen(choice)))) == (ending(kept),)


def test_a_loop_that_never_turns_goes() -> None:
    loop = n.While((), n.Literal(False, t.BOOL), (ending(1.0),), False, at(1))
    assert body_of(fold_constants(pipeline_of(raygen(loop, ending(2.0))))) == (ending(2.0),)


def test_nothing_stands_behind_a_return() -> None:
    body = (n.Return(None, at(1)), ending(1.0))
    assert body_of(fold_constants(pipeline_of(raygen(*body)))) == body[:1]


def test_a_throw_ends_the_program_only_where_exceptions_are_on() -> None:
    body = (n.CallIntrinsic(None, "throw_exception", (number(3, t.INT32),), at(1)), ending(1.0))
    assert body_of(fold_constants(pipeline_of(raygen(*body)))) == body
    assert body_of(fold_constants(pipeline_of(raygen(*body), exception_flags=4))) == body[:1]


def test_logic_folds_around_one_constant_side() -> None:
    flag = ref(local("flag", t.BOOL))
    true, false = n.Literal(True, t.BOOL), n.Literal(False, t.BOOL)
    assert fold(n.Logical(True, true, flag, t.BOOL)) == flag
    assert fold(n.Logical(True, false, flag, t.BOOL)) == false
    assert fold(n.Logical(False, true, flag, t.BOOL)) == true
    assert fold(n.Logical(False, flag, false, t.BOOL)) == flag
    assert fold(n.Logical(False, flag, true, t.BOOL)) == n.Logical(False, flag, true, t.BOOL)
    assert fold(n.Select(false, flag, true, t.BOOL)) == true


@pytest.mark.parametrize(
    ("op", "left", "right", "scalar", "result"),
    [
        ("+", 2**31 - 1, 1, t.INT32, -(2**31)),
        ("-", 0, 1, t.UINT32, 2**32 - 1),
        ("*", 65536, 65536, t.INT32, 0),
        ("//", -7, 2, t.INT32, -4),
        ("%", -7, 2, t.INT32, 1),
        ("//", 1, 0, t.INT32, 0),
        ("//", -(2**31), -1, t.INT32, -(2**31)),
        ("+", 0.1, 0.2, t.FLOAT32, 0.30000001192092896),
        ("<", 1.0, 2.0, t.FLOAT32, True),
        ("==", math.nan, math.nan, t.FLOAT32, False),
    ],
)
def test_numbers_fold_as_they_are_computed(op: str, left: float, right: float, scalar: t.Scalar, result: object) -> None:
    folded = fold(binary(op, number(left, scalar), number(right, scalar)))
    assert isinstance(folded, n.Literal)
    assert folded.value == result


def test_float_division_is_left_to_the_compiler() -> None:
    division = binary("/", number(1.0), number(3.0))
    assert fold(division) == division


@pytest.mark.parametrize(
    ("value", "scalar", "result"),
    [
        (1e10, t.INT32, 2**31 - 1),
        (-1e10, t.INT32, -(2**31)),
        (-1.5, t.UINT32, 0),
        (-1.9, t.INT32, -1),
        (math.nan, t.INT32, 0),
        (300, t.UINT8, 44),
    ],
)
def test_conversions_saturate_from_floats_and_wrap_from_integers(value: float, scalar: t.Scalar, result: int) -> None:
    assert arithmetic.convert(value, scalar) == result


def test_unread_locals_go_with_what_only_they_read() -> None:
    a, b = local("a", t.FLOAT32), local("b", t.FLOAT32)
    result = remove_unused(pipeline_of(raygen(assign(a, number(1.0)), assign(b, ref(a)), ending(1.0), locals_=(a, b))))
    assert body_of(result) == (ending(1.0),)
    assert result.programs[0].locals == ()


def test_debug_builds_keep_unread_locals() -> None:
    a = local("a", t.FLOAT32)
    pipeline = pipeline_of(raygen(assign(a, number(1.0)), locals_=(a,)), debug=True)
    assert remove_unused(pipeline) == pipeline


def test_a_call_that_writes_stays_without_its_target() -> None:
    x = local("x", t.FLOAT32)
    body = n.CallHelper(x, "h", (), at(1))
    writer = function("h", (ending(1.0), n.Return(number(1.0), at(1))), result=t.FLOAT32)
    result = remove_unused(pipeline_of(raygen(body, locals_=(x,)), helpers=(writer,)))
    assert body_of(result) == (n.CallHelper(None, "h", (), at(1)),)


def test_a_bound_value_removes_the_trace_and_all_that_it_needed() -> None:
    shadow = local("shadow", RADIANCE)
    black = n.Construct(RADIANCE, (n.Literal((0.0, 0.0, 0.0), t.FLOAT3),))
    body = (assign(shadow, black), trace(ref(shadow)), n.Return(number(1.0), at(1)))
    tracing = function("lit", body, locals_=(shadow,), result=t.FLOAT32)
    x = local("x", t.FLOAT32)
    use = n.CallIntrinsic(None, "set_payload_0", (call("float_as_uint", t.UINT32, ref(x)),), at(1))
    choice = n.If(param("uses_sky"), (n.CallHelper(x, "lit", (), at(1)), use), (), at(1))
    programs = (raygen(choice, locals_=(x,)), *pinhole_module().programs[2:])
    pipeline = pipeline_of(*programs, helpers=(tracing,), bound_values=(("uses_sky", n.Literal(False, t.BOOL)),))
    result = passes.run(pipeline)
    assert result.helpers == ()
    assert body_of(result) == ()


def test_print_after_sees_every_pass_in_order() -> None:
    seen: list[str] = []
    passes.run(pipeline_of(raygen()), lambda name, _: seen.append(name))
    assert seen == [name for name, _ in passes.PASSES]


def test_features_name_the_line_that_asked() -> None:
    module = pinhole_module()
    found = features(n.Pipeline(module.structs, module.params, (), module.programs, n.PipelineOptions()))
    described = [feature.describe() for feature in found.compiled_in]
    assert described == ["miss programs: shader.py:14", "closesthit programs: shader.py:9", "array bounds checks: shader.py:6"]
    assert not found.has("callables")


def test_features_of_ray_flags() -> None:
    shadow = local("shadow", RADIANCE)
    culling = raygen(trace(ref(shadow), number(16, t.UINT32), line=8), locals_=(shadow,))
    found = features(pipeline_of(culling))
    assert found.has("face and any-hit culling")
    assert not found.has("occlusion queries")
