"""Names, lines, numbers and expressions of generated C++."""

from __future__ import annotations

import math
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st
from ir_samples import at, binary, call, local, number, ref

from optixc.codegen.cpp_expr import Expressions
from optixc.codegen.cpp_literals import number as text_of_number
from optixc.codegen.cpp_literals import shortest_float32
from optixc.codegen.cpp_scalar_dialect import ScalarDialect
from optixc.codegen.cpp_signatures import FunctionNames, Signatures
from optixc.codegen.cpp_types import TypeNames
from optixc.codegen.names import Scope, identifier, string_literal
from optixc.codegen.needs import Options
from optixc.codegen.writer import MAX_LINE, Writer
from optixc.ir import nodes as n
from optixc.ir import types as t

LOCALS = {name: local(name, t.INT32) for name in "abcd"} | {name: local(name, t.FLOAT32) for name in "xyz"}
LOCALS |= {"v": local("v", t.FLOAT3), "u": local("u", t.UINT32), "p": local("p", t.BOOL), "q": local("q", t.BOOL)}
LOCALS |= {"f": local("f", t.FixedArray(t.FLOAT32, 4)), "image": local("image", t.Array(t.FLOAT32, 2))}


def printer(is_checked: bool = False) -> Expressions:
    """Prints expressions over LOCALS."""
    pipeline = n.Pipeline((), None, (), (), n.PipelineOptions())
    types = TypeNames((), Scope())
    names = FunctionNames({name: name for name in LOCALS}, "thread", "trace", "params", "hitObject")
    options = Options(is_checked=is_checked, checks_elements=is_checked, user_exceptions=False, traces_throw=False)
    return Expressions(ScalarDialect(types, Signatures(pipeline, types, Scope(), {}, {}), names, options))


def e(name: str) -> n.LocalRef:
    return ref(LOCALS[name])


def text(expression: n.Expr) -> str:
    return printer().text(expression)


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("color", "color"),
        ("float", "float_"),
        ("template", "template_"),
        ("__x", "x"),
        ("a__b", "a_b"),
        ("_", "unused"),
        ("ø", "uf8"),
        ("int32_t", "int32_t_"),
        ("OxrtThread", "OxrtThread_"),
        ("_9", "n9"),
    ],
)
def test_identifiers(name: str, expected: str) -> None:
    assert identifier(name) == expected


def test_scopes_keep_names_apart() -> None:
    outer = Scope(taken=("thread",))
    inner = Scope(outer)
    made = [inner.name(wanted) for wanted in ("thread", "thread", "x", "x", "x")]
    assert made == ["thread_", "thread_2", "x", "x_", "x_2"]
    assert Scope(outer).name("x") == "x"


@given(st.lists(st.text(alphabet="_ab9øint", min_size=1, max_size=8), max_size=12))
def test_scopes_give_valid_names_once(names: list[str]) -> None:
    scope = Scope()
    given_ = [scope.name(name) for name in names]
    assert len(set(given_)) == len(given_)
    assert all(name.isidentifier() and name.isascii() and "__" not in name and not name.startswith("_") for name in given_)


def test_string_literals_are_bytes_of_utf8() -> None:
    assert string_literal('a"b\\c\n?ä') == '"a\\"b\\\\c\\n\\?\\303\\244"'


def test_line_directives_stand_only_where_lines_jump() -> None:
    writer = Writer()
    with writer.block("void f()", at(10)):
        writer.line("a;", at(11))
        writer.line("b;", at(15))
    writer.leave_source()
    writer.line()
    writer.line("int x;")
    assert writer.text().splitlines() == [
        '#line 10 "shader.py"', "void f() {", "    a;", '#line 15 "shader.py"', "    b;", "}", "", '#line 9 "pipeline.cpp"', "int x;",
    ]  # fmt: skip


def test_generated_lines_are_numbered_right() -> None:
    writer = Writer()
    writer.line("a;", at(3))
    writer.leave_source()
    writer.line("b;")
    lines = writer.text().splitlines()
    place = next(i for i, line in enumerate(lines) if line.endswith('"pipeline.cpp"'))
    assert lines[place] == f'#line {place + 2} "pipeline.cpp"'


def test_long_lines_break_after_commas_but_not_in_strings() -> None:
    writer = Writer()
    writer.line(f'f("{"a, " * 30}", {", ".join(["argument"] * 20)});')
    lines = writer.text().splitlines()
    assert len(lines) > 1
    assert all(line.count('"') % 2 == 0 for line in lines)
    assert all(len(line) <= MAX_LINE for line in lines[1:])


@given(st.floats(width=32, allow_nan=False, allow_infinity=False))
def test_float_literals_read_back_exactly(value: float) -> None:
    assert struct.pack("f", float(shortest_float32(value))) == struct.pack("f", value)


@pytest.mark.parametrize(
    ("value", "scalar", "expected"),
    [
        (0.1, t.FLOAT32, "0.1f"),
        (3.0, t.FLOAT32, "3.0f"),
        (1e16, t.FLOAT32, "1e16f"),
        (0.1, t.FLOAT64, "0.1"),
        (math.inf, t.FLOAT32, "__builtin_inff()"),
        (-math.inf, t.FLOAT64, "-__builtin_inf()"),
        (5, t.UINT32, "5u"),
        (-(2**31), t.INT32, "INT32_MIN"),
        (2**63, t.UINT64, "UINT64_C(9223372036854775808)"),
        (True, t.BOOL, "true"),
    ],
)
def test_numbers(value: float, scalar: t.Scalar, expected: str) -> None:
    assert text_of_number(value, scalar) == expected


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        (binary("-", e("a"), binary("-", e("b"), e("c"))), "a - (b - c)"),
        (binary("-", binary("-", e("a"), e("b")), e("c")), "a - b - c"),
        (binary("*", binary("+", e("x"), e("y")), e("z")), "(x + y) * z"),
        (binary("/", e("x"), binary("*", e("y"), e("z"))), "x / (y * z)"),
        (binary("+", e("x"), binary("+", e("y"), e("z"))), "x + (y + z)"),
        (binary("&", e("a"), binary("+", e("b"), e("c"))), "a & (b + c)"),
        (binary("|", binary("&", e("a"), e("b")), e("c")), "(a & b) | c"),
        (binary("&", binary("&", e("a"), e("b")), e("c")), "a & b & c"),
        (binary("<", binary("+", e("a"), e("b")), e("c")), "a + b < c"),
        (binary("//", e("a"), e("b")), "oxrt::floorDivide(a, b)"),
        (binary("//", e("u"), number(4, t.UINT32)), "u / 4u"),
        (binary("//", e("u"), number(0, t.UINT32)), "oxrt::floorDivide(u, 0u)"),
        (binary("//", e("a"), number(4, t.INT32)), "oxrt::floorDivide(a, 4)"),
        (binary("<<", e("a"), number(3, t.INT32)), "a << 3"),
        (binary("<<", e("a"), number(32, t.INT32)), "oxrt::shiftLeft(a, 32)"),
        (binary("%", e("x"), e("y")), "oxrt::modulo(x, y)"),
        (n.Unary(n.UnaryOp.NEGATE, n.Unary(n.UnaryOp.NEGATE, e("a"), t.INT32), t.INT32), "-(-a)"),
        (n.Unary(n.UnaryOp.NEGATE, binary("+", e("a"), e("b")), t.INT32), "-(a + b)"),
        (binary("-", e("x"), number(-1.0)), "x - -1.0f"),
        (n.Logical(False, n.Logical(True, e("p"), e("q"), t.BOOL), e("p"), t.BOOL), "(p && q) || p"),
        (n.Logical(True, n.Logical(False, e("p"), e("q"), t.BOOL), e("p"), t.BOOL), "(p || q) && p"),
        (n.Select(e("p"), e("x"), n.Select(e("q"), e("y"), e("z"), t.FLOAT32), t.FLOAT32), "p ? x : q ? y : z"),
        (binary("+", n.Select(e("p"), e("x"), e("y"), t.FLOAT32), e("z")), "(p ? x : y) + z"),
        (n.Unary(n.UnaryOp.NOT, binary("<", e("a"), e("b")), t.BOOL), "!(a < b)"),
        (n.Convert(e("x"), t.INT32), "oxrt::convert<int32_t>(x)"),
        (n.Convert(e("a"), t.FLOAT32), "float(a)"),
        (n.Convert(e("x"), t.FLOAT3), "oxrt::float3(x)"),
        (n.Convert(e("v"), t.INT3), "oxrt::convert<int32_t>(v)"),
        (n.ComponentRef(e("v"), (1,), t.FLOAT32), "v.y"),
        (n.ComponentRef(binary("+", e("v"), e("v")), (2, 0), t.FLOAT2), "oxrt::swizzle<2, 0>(v + v)"),
        (n.ComponentRef(binary("+", e("v"), e("v")), (2,), t.FLOAT32), "(v + v).z"),
        (n.Literal((1.0, 1.0, 1.0), t.FLOAT3), "oxrt::float3(1.0f)"),
        (n.ElementRef(e("image"), (e("a"), e("b")), t.FLOAT32, at(1)), "image.at(a, b)"),
        (n.ArrayShape(e("image"), 1, t.INT32), "int32_t(image.shape[1])"),
        (call("max", t.FLOAT32, e("x"), e("y")), "oxrt::max(x, y)"),
        (call("get_ray_tmax", t.FLOAT32), "oxrt::getRayTmax(trace)"),
        (call("get_launch_index", t.UINT3), "oxrt::getLaunchIndex(thread)"),
    ],
)
def test_expressions(expression: n.Expr, expected: str) -> None:
    assert text(expression) == expected


def test_checked_access_names_the_array_and_its_indices() -> None:
    checked = printer(is_checked=True)
    assert checked.text(n.ElementRef(e("image"), (e("a"), e("b")), t.FLOAT32, at(1))) == "oxrt::checked(thread).load(image, a, b)"
    assert checked.text(n.IndexRef(e("f"), e("a"), t.FLOAT32)) == "oxrt::checked(thread).item(f, a)"
    assert checked.text(n.IndexRef(e("f"), number(1, t.INT32), t.FLOAT32)) == "f[1]"


def test_stored_vectors_are_narrowed() -> None:
    half4 = t.Vector(t.FLOAT16, 4)
    value = ref(local("v", t.FLOAT4))
    assert printer().stored("v", value, half4) == "oxrt::convert<oxrt::half>(v)"
    assert printer().stored("v", value, t.FLOAT4) == "v"


def test_literals_beyond_binary32_are_infinite() -> None:
    """As in the interpreter, and as 1e400 is in Python."""
    assert text_of_number(1e50, t.FLOAT32) == text_of_number(1e400, t.FLOAT32) == "__builtin_inff()"
    assert text_of_number(-3.5e38, t.FLOAT32) == "-__builtin_inff()"
    assert text_of_number(3.4028235e38, t.FLOAT32) == "3.4028235e38f"
    assert text_of_number(1e50, t.FLOAT64) == "1e50"
