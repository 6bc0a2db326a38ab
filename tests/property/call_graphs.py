"""The text of random call graphs: programs that trace, traverse, call callables, report, ignore, terminate and throw.

A graph is a dict of bodies by program; every body works on a number `v` that comes from its caller and goes back to it. Whatever nests
costs fuel, which bounds the depth, and a call of the launch index's budget, which bounds the number of calls; so every graph ends.
Every program begins with a note in its launch index's log, so that not only results but orders and numbers of calls are compared.
"""

from __future__ import annotations

from dataclasses import dataclass, field

CALLABLES = 3
RAY_FLAGS = (0, 0, 1, 2, 4, 8, 12, 64)
HEAD = """import optixc as ox
from optixc import float3, uint32


@ox.struct
class Params:
    scene: ox.Traversable
    out: ox.Array[uint32]
    codes: ox.Array[ox.int32]
    details: ox.Array2[uint32]
    budget: ox.Array[uint32]
    log: ox.Array[uint32]


@ox.struct
class Number:
    n: uint32


@ox.payload
class Value:
    v: uint32
    fuel: uint32


@ox.payload
class Wide:
    v: uint32
    fuel: uint32
    before: float3
    twice: float


params = ox.launch_params(Params)


@ox.device
def note(tag: uint32, v: uint32):
    i = ox.get_launch_index().x
    params.log[i] = params.log[i] * 31 + tag + (v & 255)


@ox.device
def may_call(fuel: uint32) -> bool:
    i = ox.get_launch_index().x
    left = params.budget[i]
    if fuel == 0 or left == 0:
        return False
    params.budget[i] = left - 1
    return True


@ox.device
def place(v: uint32) -> float3:
    return float3(0.25 + 10.0 * float(v % 4), 0.25, 1.0)


@ox.device
def shoot(v: uint32, fuel: uint32, flags: uint32) -> uint32:
    value = Value(v, fuel)
    ox.trace(params.scene, place(v), float3(0.0, 0.0, -1.0), ray_flags=flags, sbt_stride=2, payload=value)
    return value.v


@ox.device
def shoot_wide(v: uint32, fuel: uint32, flags: uint32) -> uint32:
    wide = Wide(v, fuel, float3(float(v % 7)), 0.0)
    ox.trace(params.scene, place(v), float3(0.0, 0.0, -1.0), ray_flags=flags, sbt_offset=1, sbt_stride=2, miss_sbt_index=1, payload=wide)
    return wide.v + uint32(wide.twice)


@ox.device
def look(v: uint32, fuel: uint32, flags: uint32) -> uint32:
    value = Value(v, fuel)
    ox.traverse(params.scene, place(v), float3(0.0, 0.0, -1.0), ray_flags=flags, sbt_stride=2, payload=value)
    kind = ox.hit_object_get_hit_kind() + 2 * uint32(ox.hit_object_is_miss())
    return value.v + kind + ox.hit_object_get_sbt_record_index()


@ox.device
def look_and_invoke(v: uint32, fuel: uint32, flags: uint32) -> uint32:
    value = Value(v, fuel)
    ox.traverse(params.scene, place(v), float3(0.0, 0.0, -1.0), ray_flags=flags, sbt_stride=2, payload=value)
    if value.v % 5 == 1:
        ox.make_nop_hit_object()
    ox.invoke(payload=value)
    return value.v + uint32(ox.hit_object_is_nop())


@ox.program
def __exception__e(number: Number):
    i = ox.get_launch_index().x
    code = ox.get_exception_code()
    params.codes[i] = code
    if code >= 0:
        params.details[i, 0] = ox.get_exception_detail_0()
        params.details[i, 1] = ox.get_exception_detail_1() + number.n
"""
NESTING = {
    "direct": f"ox.direct_call(v % {CALLABLES}, v + 1, fuel - 1, result=uint32)",
    "continuation": f"ox.continuation_call(v % {CALLABLES}, v + 1, fuel - 1, result=uint32)",
    "trace": "shoot(v + 1, fuel - 1, {flags})",
    "wide trace": "shoot_wide(v + 1, fuel - 1, {flags})",
    "traverse": "look(v + 1, fuel - 1, {flags})",
    "invoke": "look_and_invoke(v + 1, fuel - 1, {flags})",
}
TRACERS = tuple(NESTING)
DIRECT_ONLY = ("direct",)
ALLOWED = {"raygen": TRACERS, "closesthit": TRACERS, "miss": TRACERS, "continuation": TRACERS, "direct": ("direct", "traverse"),
           "anyhit": DIRECT_ONLY, "intersection": DIRECT_ONLY}


@dataclass(frozen=True)
class Program:
    """One program: how it begins, how it gives `v` back, what ends it early, what it always does at its end."""

    kind: str
    header: str
    start: tuple[str, ...]
    give_back: tuple[str, ...]
    leave: str = "return"


def _callable(kind: str, number: int) -> Program:
    head = f"def __{kind}_callable__c{number}(start: uint32, fuel: uint32, number: Number) -> uint32:"
    return Program(kind, head, ("v = start + number.n",), (), "return v")


def _shading(kind: str, name: str, payload: str) -> Program:
    start = ["v = ray.v + number.n", "fuel = ray.fuel"] + (["ray.twice = 2.0 * ray.before.y"] if payload == "Wide" else [])
    return Program(kind, f"def __{kind}__{name}(ray: {payload}, number: Number):", tuple(start), ("ray.v = v",))


PROGRAMS: dict[str, Program] = {
    "raygen": Program("raygen", "def __raygen__r():", ("v = i", "fuel = uint32(FUEL)"), ("params.out[i] = v",)),
    "hit a": _shading("closesthit", "a", "Value"), "hit b": _shading("closesthit", "b", "Value"),
    "hit wide": _shading("closesthit", "w", "Wide"),
    "miss": _shading("miss", "m", "Value"), "miss wide": _shading("miss", "w", "Wide"),
    "any": _shading("anyhit", "a", "Value"),
    "any words": Program("anyhit", "def __anyhit__w():", ("v = ox.get_payload_0()", "fuel = ox.get_payload_1()"), ("ox.set_payload_0(v)",)),
    "box": Program("intersection", "def __intersection__i():", ("v = ox.get_payload_0()", "fuel = ox.get_payload_1()"),
                   ("ox.set_payload_0(v)",)),
    **{f"direct {n}": _callable("direct", n) for n in range(CALLABLES)},
    **{f"continuation {n}": _callable("continuation", n) for n in range(CALLABLES)},
}
ARITHMETIC = ("v = v * 1664525 + 1013904223", "v = v ^ (v >> 7)", "v = v + fuel", "v = v - i", "v = v // 3 + (v & 12)")
WRAPS = {"plain": "{0}", "if": "if v % {1} == {2}:\n    {0}", "if not": "if v % {1} != {2}:\n    {0}\nelse:\n    v += 1",
         "for": "for k{3} in range(v % 4):\n    v += uint32(k{3})\n    {0}",
         "while": "t{3} = 0\nwhile t{3} < 3 and v % {1} != {2}:\n    t{3} += 1\n    {0}",
         "early": "if v % {1} == {2}:\n    {0}\n    {4}"}


@dataclass
class Graph:
    """What a random graph is made of; `text()` is its shader file."""

    fuel: int = 5
    bodies: dict[str, list[str]] = field(default_factory=lambda: {name: [] for name in PROGRAMS})
    count: int = 0

    def add(self, name: str, action: str, wrap: str, number: int) -> None:
        """One more action of a program; what its kind may not do becomes arithmetic."""
        self.count += 1
        program = PROGRAMS[name]
        leave = "\n    ".join([*program.give_back, program.leave])
        modulus = 2 + number % 5
        line = self._line(program, action, number)
        self.bodies[name] += WRAPS[wrap].format(line.replace("\n", "\n    "), modulus, number % modulus, self.count, leave).split("\n")

    def _line(self, program: Program, action: str, number: int) -> str:
        if action in NESTING and action in ALLOWED[program.kind]:
            call = NESTING[action].format(flags=RAY_FLAGS[number % len(RAY_FLAGS)])
            return f"if may_call(fuel):\n    v = v * {2 * (number % 4) + 1} + {call}"
        if action == "throw":
            return f"if v % {7 + number % 17} == {number % 5}:\n    ox.throw_exception({number * 1000003}, v, fuel)"
        if action == "end":
            ending = {"anyhit": "\n    ".join([*program.give_back, ("ox.ignore_intersection()", "ox.terminate_ray()")[number % 2]]),
                      "intersection": f"v = v * 2 + uint32(ox.report_intersection({0.25 + 0.125 * (number % 7)}, v % 100, v, i))"}
            return f"if v % 3 != {number % 3}:\n    {ending.get(program.kind, 'v = v * 3')}"
        return ARITHMETIC[number % len(ARITHMETIC)]

    def text(self) -> str:
        """The shader file."""
        parts = [HEAD]
        for tag, (name, program) in enumerate(PROGRAMS.items()):
            lines = ["i = ox.get_launch_index().x", *program.start, f"note({tag}, v)", *self.bodies[name]]
            if program.kind == "intersection":
                lines.append("accepted = ox.report_intersection(0.5, v % 50, v)\nv += uint32(accepted)")
            lines += program.give_back
            if program.leave != "return":
                lines.append(program.leave)
            body = "\n".join(lines).replace("FUEL", str(self.fuel)).split("\n")
            parts.append("\n".join(["@ox.program", program.header, *(f"    {line}" for line in body)]))
        return "\n\n\n".join(parts) + "\n"
