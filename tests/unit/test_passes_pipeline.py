"""Linking modules into a pipeline."""

from __future__ import annotations

from dataclasses import replace

import pytest
from ir_samples import PARAMS, assign, function, local, number, pinhole_module

from optixc.ir import nodes as n
from optixc.ir.types import FLOAT32 as FLOAT
from optixc.passes.pipeline import LinkError, link

OPTIONS = n.PipelineOptions()
NAMES = ["__raygen__pinhole", "__closesthit__matte", "__miss__sky"]


def helper(name: str, value: float) -> n.Function:
    return function(name, (n.Return(number(value), pinhole_module().programs[0].span),), result=FLOAT)


def calling_module(path: str, program: str, helpers: tuple[n.Function, ...], callee: str) -> n.Module:
    x = local("x", FLOAT)
    call = n.HelperCall(callee, (), FLOAT, pinhole_module().programs[0].span)
    return n.Module("m", path, (), None, helpers, (function(program, (assign(x, call),), locals_=(x,)),))


def test_programs_come_in_the_order_of_their_names() -> None:
    pipeline = link([pinhole_module()], list(reversed(NAMES)), OPTIONS)
    assert [program.name for program in pipeline.programs] == list(reversed(NAMES))
    assert pipeline.params == PARAMS


def test_repeated_names_count_once_and_others_stay_out() -> None:
    pipeline = link([pinhole_module()], [NAMES[0], NAMES[0]], OPTIONS)
    assert [program.name for program in pipeline.programs] == [NAMES[0]]


def test_unknown_program_is_named_with_those_that_there_are() -> None:
    with pytest.raises(LinkError, match=r"__miss__moon.*__miss__sky"):
        link([pinhole_module()], ["__miss__moon"], OPTIONS)


def test_two_different_programs_of_one_name_are_refused() -> None:
    other = replace(pinhole_module(), path="other.py", programs=(function("__miss__sky", ()),))
    with pytest.raises(LinkError, match=r"__miss__sky.*shader\.py and other\.py"):
        link([pinhole_module(), other], ["__miss__sky"], OPTIONS)


def test_the_same_program_twice_is_one() -> None:
    assert len(link([pinhole_module(), pinhole_module()], NAMES, OPTIONS).programs) == 3


def test_modules_share_their_launch_parameters() -> None:
    other = replace(pinhole_module(), path="other.py", params=replace(PARAMS, name="Others"))
    with pytest.raises(LinkError, match=r"Params in shader\.py and Others in other\.py"):
        link([pinhole_module(), other], NAMES[:1], OPTIONS)


def test_only_reached_helpers_are_taken() -> None:
    module = calling_module("a.py", "__raygen__a", (helper("used", 1.0), helper("unused", 2.0)), "used")
    assert [function_.name for function_ in link([module], ["__raygen__a"], OPTIONS).helpers] == ["used"]


def test_equal_helpers_of_two_modules_are_one() -> None:
    first = calling_module("a.py", "__raygen__a", (helper("h", 1.0),), "h")
    second = calling_module("b.py", "__raygen__b", (helper("h", 1.0),), "h")
    assert len(link([first, second], ["__raygen__a", "__raygen__b"], OPTIONS).helpers) == 1


def test_different_helpers_of_one_name_are_renamed_with_their_calls() -> None:
    first = calling_module("a.py", "__raygen__a", (helper("h", 1.0),), "h")
    second = calling_module("b.py", "__raygen__b", (helper("h", 2.0),), "h")
    pipeline = link([first, second], ["__raygen__a", "__raygen__b"], OPTIONS)
    assert [function_.name for function_ in pipeline.helpers] == ["h", "h_2"]
    (statement,) = pipeline.programs[1].body
    assert isinstance(statement, n.Assign)
    assert isinstance(statement.value, n.HelperCall)
    assert statement.value.function == "h_2"


def test_helpers_of_helpers_are_taken_and_renamed() -> None:
    inner = helper("inner", 1.0)
    outer = replace(helper("outer", 0.0), body=(n.Return(n.HelperCall("inner", (), FLOAT, inner.span), inner.span),))
    first = calling_module("a.py", "__raygen__a", (helper("inner", 5.0),), "inner")
    second = calling_module("b.py", "__raygen__b", (inner, outer), "outer")
    pipeline = link([first, second], ["__raygen__a", "__raygen__b"], OPTIONS)
    assert [function_.name for function_ in pipeline.helpers] == ["inner", "inner_2", "outer"]
    (statement,) = pipeline.helpers[2].body
    assert isinstance(statement, n.Return)
    assert isinstance(statement.value, n.HelperCall)
    assert statement.value.function == "inner_2"


def test_structs_keep_their_order_and_come_once() -> None:
    pipeline = link([pinhole_module(), pinhole_module()], NAMES, OPTIONS)
    assert [struct.name for struct in pipeline.structs] == ["Params", "Material", "Radiance"]


