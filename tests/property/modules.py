"""A shader file of many random programs: what they share, helpers of each, and a ray generation program for each."""

from __future__ import annotations

from dataclasses import dataclass
from random import Random

from expressions import INPUT_COLUMNS, Callee, Scope
from statements import OUTPUT_COLUMNS, OUTPUT_TYPES, Body
from types_of_programs import NUMBERS, SCALARS, VECTORS, StructType

FEATURES = ("effects", "structs", "arrays", "matrices", "loops", "match", "exits", "memory", "truth", "helpers", "tuples")

STRUCTS = (
    StructType("Small", (("a", "int8"), ("b", "uint8"), ("c", "int16"), ("d", "uint16"), ("e", "float16"), ("f", "bool"))),
    StructType("Wide", (("n", "int64"), ("x", "float64"), ("v", "float3"), ("w", "uint2"))),
    StructType("Nested", (("first", "Small"), ("k", "int32"), ("second", "Wide"), ("list", "ox.FixedArray[float32, 4]"))),
    StructType("Packed", (("c", "uchar4"), ("h", "half4"), ("s", "short2"), ("b", "char3"), ("u", "ushort3"), ("l", "longlong2"))),
    StructType("Rows", (("items", "ox.FixedArray[Small, 2]"), ("rows", "ox.FixedArray[float3, 4]"), ("m", "float3x4"))),
)


def _class_texts() -> str:
    """The struct classes as source."""
    fields = ("".join(f"    {name}: {of}\n" for name, of in struct.fields) for struct in STRUCTS)
    return "\n\n".join(f"@ox.struct\nclass {struct.name}:\n{text}" for struct, text in zip(STRUCTS, fields, strict=True))


PRELUDE = f'''
import optixc as ox
from enum import IntEnum, IntFlag
from optixc import bool2, bool3, bool4, float3x3, float3x4, float4x4
from optixc import {", ".join(VECTORS)}
from optixc import int8, uint8, int16, uint16, float16, uchar4, half4, short2, char3, ushort3, {", ".join(NUMBERS)}

LIMIT = 7
AXIS = float3(0.25, -2.0, 1.5)


class Mode(IntEnum):
    FIRST = 1
    SECOND = 2


class Bits(IntFlag):
    A = 1
    B = 4
    C = 8
    BOTH = A | B


@ox.struct
class Params:
{chr(10).join(f"    in_{of}: ox.Array2[{of}]{chr(10)}    out_{of}: ox.Array2[{of}]" for of in NUMBERS)}


@ox.struct
class State:
    count: int32
    trail: uint32


{_class_texts()}

params = ox.launch_params(Params)


@ox.device
def tick(state: State, step: int32) -> int32:
    state.count = state.count * 3 + step
    state.trail = (state.trail << 5) ^ (state.trail >> 3) ^ ox.uint32(step)
    return state.count


@ox.device
def flip(state: State, value: bool) -> bool:
    state.trail = state.trail * 7 + (uint32(1) if value else 2)
    return (state.trail & 8) != 0 or value


@ox.device
def scale(state: State, value: float32, factor: float32 = 0.5) -> float32:
    state.count += 1
    return value * factor + ox.float32(state.count)


@ox.device
def int_bits(value: float32) -> int32:
    return 0x7fc00000 if value != value else ox.float_as_int(value)


@ox.device
def stir(small: Small, by: int32) -> int32:
    small.a, small.c = small.c + by, small.a
    small.e *= 0.5
    return small.a if small.f else small.c


@ox.device
def mingle(first: Small, second: Small) -> bool:
    first.d += second.b
    second.f = not first.f
    return first.d > second.d


@ox.device
def turn(values: ox.FixedArray[float32, 4], by: int32) -> float32:
    values[by & 3], values[(by + 1) & 3] = values[(by + 1) & 3], values[by & 3]
    return values[0]


@ox.device
def small_of(number: int32, x: float32) -> Small:
    if number > LIMIT:
        return Small(number, 2, number, 4, x, True)
    return Small(a=1, b=uint32(number), c=-number, d=Bits.BOTH, e=x + AXIS.y, f=False)


@ox.device
def blend(a, b, t=0.25):
    if a > b:
        return a - b * t
    return a + b * t


@ox.device
def ordered(a, b):
    if a < b:
        return a, b
    return b, a


@ox.device
def climb(n: int32, x: uint32) -> uint32:
    if n <= 0 or x == 0:
        return x
    return climb(n - 1, x * 1664525 + 1013904223) ^ (x >> 7)


@ox.device
def shorter(n: int32, x: uint32) -> uint32:
    return climb(n & 7, x)
'''

EFFECTS = (
    Callee("tick", (("state", "State"), ("step", "int32")), "int32"),
    Callee("flip", (("state", "State"), ("value", "bool")), "bool"),
    Callee("scale", (("state", "State"), ("value", "float32"), ("factor", "float32")), "float32", defaults=1),
    Callee("stir", (("small", "Small"), ("by", "int32")), "int32"),
    Callee("mingle", (("first", "Small"), ("second", "Small")), "bool"),
    Callee("turn", (("values", "ox.FixedArray[float32, 4]"), ("by", "int32")), "float32"),
)
PURE = (
    Callee("blend", (("a", "float32"), ("b", "float32"), ("t", "float32")), "float32", defaults=1),
    Callee("blend", (("a", "float64"), ("b", "float64"), ("t", "float64")), "float64"),
    Callee("shorter", (("n", "int32"), ("x", "uint32")), "uint32"),
)


@dataclass(frozen=True)
class Recipe:
    """What decides one program: equal recipes give equal text. Fewer features and a smaller size give simpler programs."""

    seed: int
    size: int
    features: frozenset[str]


def module_text(recipes: list[Recipe]) -> str:
    """The shader file with `__raygen__p0`, `__raygen__p1` ..."""
    return PRELUDE + "".join(program_text(recipe, f"p{number}") for number, recipe in enumerate(recipes))


def program_text(recipe: Recipe, name: str) -> str:
    """One program with its own helpers."""
    random = Random(f"{recipe.seed} {recipe.size} {sorted(recipe.features)}")
    callees: list[Callee] = list(PURE) if "helpers" in recipe.features else []
    text = ""
    for number in range(random.randrange(3) if "helpers" in recipe.features else 0):
        helper, lines = _helper(random, recipe, f"{name}_h{number}", list(callees))
        callees.append(helper)
        text += lines
    scope = Scope(random, recipe.features, callees=callees + list(EFFECTS if "effects" in recipe.features else ()))
    scope.references.append(("state", "State"))
    body = Body(scope, STRUCTS, "v")
    body.budget = recipe.size
    body.add("i = int32(ox.get_launch_index().x)")
    body.add("state = State(1, 0)")
    # The first names read the inputs, so that no program is constant.
    for of in random.sample(NUMBERS, 3):
        name_of = body.fresh()
        body.add(f"{name_of} = params.in_{of}[i, {random.randrange(INPUT_COLUMNS)}]")
        scope.names[name_of] = of
    body.statements(recipe.size)
    if "tuples" in recipe.features:
        _take_apart(body, random)
    body.add("pass")
    _observe(body)
    return f"{text}\n\n@ox.program\ndef __raygen__{name}():\n" + "\n".join(body.lines) + "\n"


def _helper(random: Random, recipe: Recipe, name: str, callees: list[Callee]) -> tuple[Callee, str]:
    """A helper with annotated parameters, which may change the caller's state."""
    has_state = "effects" in recipe.features and random.random() < 0.5
    types = [random.choice((*SCALARS, *VECTORS)) for _ in range(random.randint(1, 3))]
    parameters = tuple(([("state", "State")] if has_state else []) + [(f"a{number}", of) for number, of in enumerate(types)])
    result = random.choice((*SCALARS, *VECTORS))
    known = list(callees)
    scope = Scope(random, recipe.features - {"memory"}, in_program=False, callees=known + list(EFFECTS if has_state else ()))
    scope.names.update((name_of, of) for name_of, of in parameters if of != "State")
    scope.references += [(name_of, of) for name_of, of in parameters if of == "State"]
    body = Body(scope, STRUCTS, "w")
    body.result = result
    body.budget = max(1, recipe.size // 3)
    body.statements(body.budget)
    body.add(f"return {body.returned()}")
    heading = ", ".join(f"{name_of}: {of}" for name_of, of in parameters)
    lines = f"\n\n@ox.device\ndef {name}({heading}) -> {result}:\n" + "\n".join(body.lines) + "\n"
    return Callee(name, parameters, result), lines


def _take_apart(body: Body, random: Random) -> None:
    """A helper with two results."""
    of = random.choice(("int32", "float32", "uint64"))
    low, high = body.fresh(), body.fresh()
    body.add(f"{low}, {high} = ordered({body.make.expression(of, 2)}, {body.make.expression(of, 2)})")
    body.scope.names[low] = body.scope.names[high] = of


def _observe(body: Body) -> None:
    """Everything that has a value goes to memory, type by type, so that a wrong bit anywhere is seen."""
    columns = dict.fromkeys(OUTPUT_TYPES, 0)
    found = [*body.scope.names.items(), *body.scope.places, *body.scope.read_only, ("state.count", "int32"), ("state.trail", "uint32")]
    parts: list[tuple[str, str]] = []
    for text, type_ in found:
        if type_ in VECTORS:
            element, size = VECTORS[type_]
            parts += [(f"{text}.{letter}", element) for letter in "xyzw"[:size]]
        elif type_ == "bool":
            parts.append((f"(1 if {text} else 0)", "int32"))
        elif type_ in NUMBERS:
            parts.append((text, type_))
    for text, type_ in parts[::-1]:
        if columns[type_] < OUTPUT_COLUMNS:
            operator = "+=" if columns[type_] < 4 else "="
            body.add(f"params.out_{type_}[i, {columns[type_]}] {operator} {text}")
            columns[type_] += 1
