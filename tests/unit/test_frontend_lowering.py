"""What lowering promises: Python's order of evaluation, short circuits kept, the author's names, pure expressions."""

from __future__ import annotations

import textwrap

import pytest

from optixc.frontend.compile import compile_text
from optixc.ir.text import print_module

PRELUDE = """
import optixc as ox
from optixc import float2, float3, float4, uint32

@ox.struct
class Rng:
    state: uint32

@ox.struct
class Params:
    out: ox.Array[float]
    bytes: ox.Array2[ox.uchar4]
    halves: ox.Array[ox.float16]
    scene: ox.Traversable
    table: ox.FixedArray[float, 4]

@ox.struct
class Material:
    albedo: float3

params = ox.launch_params(Params)

def step(rng: Rng) -> float:
    rng.state = rng.state * 3
    return float(rng.state)

def store(i, value):
    params.out[i] = value
    return value
"""


def lowered(body: str, extra: str = "") -> list[str]:
    """The lines of the body of a ray generation program, without its locals."""
    text = (
        PRELUDE
        + textwrap.dedent(extra)
        + "\n@ox.program\ndef __raygen__a():\n"
        + textwrap.indent(textwrap.dedent(body).strip("\n"), "    ")
        + "\n"
    )
    lines = print_module(compile_text(text, "shader.py").module).split("program __raygen__a")[1].splitlines()[1:]
    return [line[4:] for line in lines if line.strip() and not line.startswith("    local ")]


def test_calls_that_write_keep_their_order() -> None:
    assert lowered("rng = Rng(1)\nx = step(rng) - step(rng)") == [
        "rng = Rng(uint32(1))",
        "result = call step(rng)",
        "result_2 = call step(rng)",
        "x = (result - result_2):float32",
    ]


def test_what_a_later_call_changes_is_read_before() -> None:
    lines = lowered("rng = Rng(1)\nx = float(rng.state) + step(rng)")
    assert lines[1:] == ["value = convert[float32](rng.state)", "result = call step(rng)", "x = (value + result):float32"]


def test_what_no_call_can_change_stays_in_place() -> None:
    lines = lowered("rng = Rng(1)\ny = 2.0\nx = y * step(rng)")
    assert lines[2:] == ["result = call step(rng)", "x = (y * result):float32"]


def test_array_elements_are_read_before_a_later_store() -> None:
    lines = lowered("x = params.out[0] + store(0, 2.0)")
    assert lines == [
        "value = params.out[int32(0)]",
        "result = call store(int32(0), float32(2.0))",
        "x = (value + result):float32",
    ]


def test_keyword_arguments_are_evaluated_in_the_order_of_the_source() -> None:
    lines = lowered("rng = Rng(1)\nx = pair(b=step(rng), a=step(rng))", "def pair(a, b):\n    return a - b\n")
    assert lines[1:] == ["result = call step(rng)", "result_2 = call step(rng)", "x = pair(result_2, result)"]


def test_short_circuit_keeps_the_right_side_conditional() -> None:
    assert lowered("rng = Rng(1)\nb = rng.state > 1 and step(rng) > 2.0")[1:] == [
        "condition = (rng.state > uint32(1)):bool",
        "if condition:",
        "    result = call step(rng)",
        "    condition = (result > float32(2.0)):bool",
        "b = condition",
    ]


def test_conditional_expression_runs_one_branch() -> None:
    assert lowered("rng = Rng(1)\nx = step(rng) if rng.state > 1 else 0.5")[1:] == [
        "if (rng.state > uint32(1)):bool:",
        "    result = call step(rng)",
        "    chosen = result",
        "else:",
        "    chosen = float32(0.5)",
        "x = chosen",
    ]


def test_chained_comparison_evaluates_the_middle_once() -> None:
    lines = lowered("rng = Rng(1)\nb = 1.0 < step(rng) < 3.0")
    assert sum("call step" in line for line in lines) == 1


def test_while_condition_that_writes_is_evaluated_each_turn() -> None:
    lines = lowered("rng = Rng(1)\nwhile step(rng) < 100.0:\n    pass")
    assert any(line.strip() == "result = call step(rng)" for line in lines)
    assert len(lines) > 2


def test_swap_reads_both_before_it_writes() -> None:
    lines = lowered("a = 1.0\nb = 2.0\na, b = b, a")
    assert lines[2:] == ["value = a", "a = b", "b = value"]


def test_rotation_of_components() -> None:
    lines = lowered("v = float2(1.0, 2.0)\nv.x, v.y = v.y, v.x")
    assert lines[1:] == ["value = v.x", "v.x = v.y", "v.y = value"]


def test_augmented_element_evaluates_its_index_once() -> None:
    lines = lowered("rng = Rng(1)\nparams.out[int(step(rng))] += 1.0")
    assert sum("call step" in line for line in lines) == 1


def test_loop_variable_that_the_body_changes() -> None:
    lines = lowered("for i in range(4):\n    i = i * 2\n    params.out[i] = 1.0")
    assert lines[:2] == ["for counter in range(int32(0), int32(4), int32(1)):", "    i = counter"]


def test_tuple_payload() -> None:
    lines = lowered("a, b = ox.trace(params.scene, float3(0.0), float3(1.0), payload=(1, 2.0))")
    assert lines[0] == "payload = PayloadWords_uint32_float32(uint32(1), float32(2.0))"
    assert lines[1].startswith("trace(") and lines[1].endswith("payload payload: PayloadWords_uint32_float32")
    assert lines[2:] == ["a = payload.w0", "b = payload.w1"]


def test_storage_types_widen_and_narrow() -> None:
    lines = lowered("p = params.bytes[0, 0]\nparams.bytes[0, 1] = p\nh = params.halves[0]\nx = ox.uint8(300.5 + h)")
    assert lines[0] == "p = convert[uint4](params.bytes[int32(0), int32(0)])"
    assert lines[1] == "params.bytes[int32(0), int32(1)] = p"
    assert lines[2] == "h = convert[float32](params.halves[int32(0)])"
    assert lines[3] == "x = convert[uint32](convert[uint8]((float32(300.5) + h):float32))"


def test_dead_statements_are_left_out() -> None:
    assert lowered("return\nx = 1")[-1] == "return"


def test_record_data_in_a_helper_is_passed_on() -> None:
    extra = "def albedo():\n    return ox.get_sbt_data(Material).albedo\n"
    text = PRELUDE + extra + "@ox.program\ndef __raygen__a():\n    x = albedo()\n"
    printed = print_module(compile_text(text, "shader.py").module)
    assert "def albedo(record: &Material)" in printed
    assert "program __raygen__a(record record: &Material)" in printed
    assert "x = albedo(record)" in printed


def test_match_takes_the_first_case_that_fits() -> None:
    lines = lowered("x = 3\nmatch x:\n    case 1 | 2:\n        y = 1\n    case 3 if x > 2:\n        y = 2\n    case _:\n        y = 3")
    assert lines[1] == "if ((x == int32(1)):bool or (x == int32(2)):bool):"
    assert "    if ((x == int32(3)):bool and (x > int32(2)):bool):" in lines


@pytest.mark.parametrize(
    ("expression", "printed"),
    [
        ("1 / 2", "float32(0.5)"),
        ("7 // 2", "int32(3)"),
        ("-7 % 3", "int32(2)"),
        ("2 ** 10", "int32(1024)"),
        ("1 << 4 | 3", "int32(19)"),
        ("uint32(7)", "uint32(7)"),
        ("float(3)", "float32(3.0)"),
        ("int(-3.7)", "int32(-3)"),
        ("ox.RayFlags.DISABLE_ANYHIT | ox.RayFlags.TERMINATE_ON_FIRST_HIT", "uint32(5)"),
        ("~ox.RayFlags.DISABLE_ANYHIT", "uint32(2046)"),
        ("uint32(7) & ~4", "(uint32(7) & uint32(4294967291)):uint32"),
        ("min(3, len(params.out), 5)", "min(min(int32(3), params.out.shape[0]), int32(5))"),
        ("1 << len(params.out)", "(int32(1) << params.out.shape[0]):int32"),
        ("uint32(7) & ~(1 << len(params.out))", "(uint32(7) & (~(uint32(1) << params.out.shape[0]):uint32)):uint32"),
        ("0.5 * (1 << len(params.out))", "(float32(0.5) * convert[float32]((int32(1) << params.out.shape[0]):int32)):float32"),
        ("ox.float3x3()[2].x", f"float3x3({', '.join(['float32(0.0)'] * 9)})[int32(2)].x"),
        ("1 < 2 < 3", "bool(True)"),
        ("not 0", "bool(True)"),
        ("len(params.out)", "params.out.shape[0]"),
        ("params.bytes.shape[1]", "params.bytes.shape[1]"),
        ("len(params.table)", "int32(4)"),
        ("float3(1, 2, 3)", "float3(1.0, 2.0, 3.0)"),
        ("float4(float3(1.0), 2.0)", "float4(1.0, 1.0, 1.0, 2.0)"),
        ("ox.max(float3(1.0), 0.0)", "max(float3(1.0, 1.0, 1.0), float3(0.0, 0.0, 0.0))"),
    ],
)
def test_expressions(expression: str, printed: str) -> None:
    assert lowered(f"x = {expression}") == [f"x = {printed}"]


def test_names_that_change_their_type_get_numbers() -> None:
    lines = lowered("x = 1\nx = 2.5\ny = x")
    assert lines == ["x = int32(1)", "x_2 = float32(2.5)", "y = x_2"]


def test_literal_takes_the_type_of_the_name() -> None:
    assert lowered("x = 1.0\nx = 2") == ["x = float32(1.0)", "x = float32(2.0)"]


def test_print_of_an_f_string() -> None:
    assert lowered('x = 1\nprint("a", x)\nprint(f"x={x}", x, sep=", ")')[1:] == [
        "print('a', x, sep=' ', end='\\n')",
        "print('x=', x, ', ', x, sep='', end='\\n')",
    ]


def test_one_helper_per_signature() -> None:
    text = (
        PRELUDE
        + "def twice(x):\n    return x + x\n@ox.program\ndef __raygen__a():\n    a = twice(1)\n    b = twice(1.5)\n    c = twice(2)\n"
    )
    module = compile_text(text, "shader.py").module
    assert [(helper.name, str(helper.result)) for helper in module.helpers] == [("twice", "int32"), ("twice_2", "float32")]


def test_same_input_same_text() -> None:
    text = PRELUDE + "@ox.program\ndef __raygen__a():\n    a = step(Rng(1))\n"
    assert print_module(compile_text(text, "shader.py").module) == print_module(compile_text(text, "shader.py").module)


def test_components_of_colours_are_those_of_vectors() -> None:
    colour = lowered("v = float4(1.0)\nv.a = 0.5\nparams.out[0] = v.bgr.x + v.r")
    assert colour == lowered("v = float4(1.0)\nv.w = 0.5\nparams.out[0] = v.zyx.x + v.x")
    assert any("v.w = " in line for line in colour)
