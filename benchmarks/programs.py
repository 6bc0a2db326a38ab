"""What the program model costs: dispatch, callables, exceptions, payload words, bound values, recursion.

`python -m benchmarks.programs [--clock cpu] [--only NAME]` prints one row for each and width. One thread; medians over interleaved rounds.
Scenes are made here, no file is read.
"""

from __future__ import annotations

import argparse
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import optixc as ox
from benchmarks.measure import Clock, LaunchContender, interleave
from benchmarks.ours import SHADERS, shader_module
from optixc.stdlib import shapes

SIZE = 512
HIT_GROUPS = 32
EYE = (0.0, 0.0, 3.2)


@dataclass
class Row:
    """`value` is a ratio of seconds, or nanoseconds; it shall lie within `wanted`, if anything is wanted."""

    name: str
    lanes: int
    value: float
    wanted: tuple[float, float] | None
    unit: str = ""

    def __str__(self) -> str:
        found = f"{self.name:44} {self.lanes:2} lanes: {self.value:.3f}{self.unit}"
        if self.wanted is None:
            return found
        low, high = self.wanted
        wanted = f"{low} to {high}" if low > 0.0 else f"at most {high}"
        verdict = "" if low <= self.value <= high else "  MISSED"
        return f"{found} (wanted: {wanted}){verdict}"


class Bench:
    """One context and the scenes; makes contenders and compares them."""

    def __init__(self, rounds: int, clock: Clock) -> None:
        self.context = ox.DeviceContext(threads=1)
        self.shader = shader_module("programs")
        self.module = self.context.module_create(self.shader)
        self.rounds, self.clock = rounds, clock
        self.sheet = sheet(512)
        self.scene = self.context.accel_build([ox.BuildInputTriangles(self.sheet.vertices, self.sheet.indices)])

    def contender(
        self, name: str, lanes: int, raygen: str, hit: str, misses: tuple[str | None, ...] = (None,), **settings: Any
    ) -> LaunchContender:
        """Programs of the shader file by their short names."""
        create, module = self.context.program_group_create, self.module
        start, surface = create(raygen=module[f"__raygen__{raygen}"]), create(closesthit=module[f"__closesthit__{hit}"])
        missed = [create(miss=None if miss is None else module[f"__miss__{miss}"]) for miss in misses]
        called = ("step", "other_step") if raygen == "called" else ()
        callables = [create(direct_callable=module[f"__direct_callable__{short}"]) for short in called]
        scene = settings.pop("scene", self.scene)
        pipeline = self.context.pipeline_create([start, surface, *missed, *callables], simd=lanes, **settings)
        records = [callables[k % 2].record(self.shader.Factor(3.0 + k, 0.1 * k)) for k in range(4)] if callables else []
        table = ox.ShaderBindingTable(start.record(), [miss.record() for miss in missed], [surface.record()], records)
        return LaunchContender(name, pipeline, table, self.params(scene), SIZE, SIZE)

    def params(self, scene: ox.Accel) -> Any:
        """Parameters with an image of their own."""
        return self.shader.Params(image=np.zeros((SIZE, SIZE, 3), np.float32), scene=scene, eye=EYE, shadows=False)

    def ratio(self, contender: LaunchContender, baseline: LaunchContender) -> float:
        """Seconds of one over those of the other; their pictures are the same."""
        timings = interleave([contender, baseline], self.rounds, self.clock)
        check_same(contender, baseline)
        return 1.0 / timings.speed_up(contender.name, baseline.name)


def check_same(one: LaunchContender, other: LaunchContender) -> None:
    """Stops where pictures differ, but for rays along edges: at most one in a thousand."""
    differing = (np.abs(one.params.image - other.params.image) > 2e-3).any(axis=-1).mean()
    if differing > 1e-3:
        raise SystemExit(f"{one.name} and {other.name} show different pictures: {100.0 * differing:.2f} % of the pixels differ")


def sheet(cells: int) -> shapes.Mesh:
    """A wavy square that fills the picture; about a triangle per pixel."""
    y, x = np.meshgrid(np.linspace(1.7, -1.7, cells + 1), np.linspace(-1.7, 1.7, cells + 1), indexing="ij")
    return shapes.surface(np.stack([x, y, 0.1 * np.sin(9.0 * x) * np.cos(7.0 * y)], axis=-1))


def mirrors() -> shapes.Mesh:
    """Balls between two walls."""
    balls = [shapes.superellipsoid(1.0, 1.0, 96, 192).moved([[0.5, 0, 0, x], [0, 0.5, 0, y], [0, 0, 0.5, 0]]) for x, y in
             ((-1.0, -0.6), (0.2, 0.7), (1.1, -0.5), (-1.0, 0.9), (0.1, -0.9))]
    walls = [shapes.rectangle((-9.0, -9.0, -1.5), (18.0, 0.0, 0.0), (0.0, 18.0, 0.0)),
             shapes.rectangle((-9.0, -9.0, 3.5), (0.0, 18.0, 0.0), (18.0, 0.0, 0.0))]
    return shapes.merged([*balls, *walls])


def dispatch_source() -> str:
    """A shader file with as many closest-hit programs as there are hit groups; each has constants of its own and costs the same."""
    hits = "".join(
        f"\n\n@ox.program\ndef __closesthit__{k}(ray: Color):\n    n = abs(normal_here())\n"
        f"    ray.color = float3({0.5 + k / 64}, {1.0 - k / 64}, {0.25 + k / 128}) * n + float3({k / 256})\n"
        for k in range(HIT_GROUPS)
    )
    return f"import optixc as ox\nfrom optixc import float3\nfrom programs import Color, normal_here\n{hits}"


def dispatch(bench: Bench, lanes: int) -> Iterator[Row]:
    """The same scene through one program and through 32, whose records change from region to region, or from triangle to triangle."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "dispatch.py"
        path.write_text(dispatch_source())
        module = bench.context.module_create(path, include_dirs=[SHADERS])
        create = bench.context.program_group_create
        start, miss = create(raygen=bench.module["__raygen__narrow"]), create(miss=None)
        hits = [create(closesthit=module[f"__closesthit__{k}"]) for k in range(HIT_GROUPS)]
        one, many = ([start, miss, hits[0]], [start, miss, *hits])
        widths = {width: bench.context.pipeline_create(many, simd=width) for width in {1, lanes}}
        single = bench.context.pipeline_create(one, simd=lanes)
    triangle = np.arange(len(bench.sheet.indices))
    row, column = triangle // 2 // 512, triangle // 2 % 512
    kinds = {"agree": row // 128 * 8 + column // 64, "differ": np.random.default_rng(3).integers(0, HIT_GROUPS, len(triangle))}
    for kind, numbers in kinds.items():
        scene = bench.context.accel_build([ox.BuildInputTriangles(
            bench.sheet.vertices, bench.sheet.indices, flags=[0] * HIT_GROUPS, num_sbt_records=HIT_GROUPS,
            sbt_index_offsets=numbers.astype(np.uint32))])
        tables = [ox.ShaderBindingTable(start.record(), [miss.record()], [group.record() for group in groups])
                  for groups in ([hits[0]] * HIT_GROUPS, hits)]
        made = [LaunchContender(name, pipeline, table, bench.params(scene), SIZE, SIZE) for name, pipeline, table in (
            ("one", single, tables[0]), ("32", widths[lanes], tables[1]), ("32 scalar", widths[1], tables[1]))]
        timings = interleave(made, bench.rounds, bench.clock)
        check_same(made[1], made[2])
        wanted = (0.0, 1.05) if kind == "agree" else None
        yield Row(f"32 hit groups over one, neighbours {kind}", lanes, 1.0 / timings.speed_up("32", "one"), wanted)
        if kind == "differ" and lanes > 1:
            yield Row("32 hit groups over scalar, neighbours differ", lanes, 1.0 / timings.speed_up("32", "32 scalar"), (0.0, 1.0))


def callables(bench: Bench, lanes: int) -> Iterator[Row]:
    """Nanoseconds that a direct callable costs beyond the same arithmetic in place, for each call of each launch index."""
    called = bench.contender("called", lanes, "called", "narrow")
    in_place = bench.contender("in place", lanes, "in_place", "narrow")
    timings = interleave([called, in_place], bench.rounds, bench.clock)
    check_same(called, in_place)
    seconds = timings.median("called") - timings.median("in place")
    yield Row("a direct callable", lanes, 1e9 * seconds / (SIZE * SIZE * bench.shader.CALLS), (-5.0, 15.0), " ns")


def exceptions(bench: Bench, lanes: int) -> Iterator[Row]:
    """A program that may throw against one that does not; and with exceptions off, its bytes against those of the one that does not.

    The bytes are compared without checks of indices: a check names the line of its access by a constant in the code, and the two
    programs cannot stand on the same lines.
    """
    plain = bench.contender("plain", lanes, "narrow", "narrow")
    flags = ox.ExceptionFlags.STACK_OVERFLOW | ox.ExceptionFlags.TRACE_DEPTH | ox.ExceptionFlags.USER
    options = ox.PipelineCompileOptions(exception_flags=flags)
    on = bench.contender("on", lanes, "narrow", "throwing", options=options)
    yield Row("exceptions on, none thrown", lanes, bench.ratio(on, plain), (0.0, 1.03))
    none = ox.PipelineCompileOptions(exception_flags=ox.ExceptionFlags.NONE)
    compared = [bench.contender(hit, lanes, "narrow", hit, options=none, checks_bounds=False) for hit in ("throwing", "narrow")]
    off, without = (code_bytes(contender.pipeline.report().library) for contender in compared)
    same = off == without
    yield Row("exceptions off: bytes of code that differ", lanes, 0.0 if same else 1.0, (0.0, 0.0))


def code_bytes(library: str | Path) -> bytes:
    """The instructions of a compiled pipeline."""
    with tempfile.TemporaryDirectory() as folder:
        text = Path(folder) / "text"
        subprocess.run(["objcopy", "-O", "binary", "--only-section=.text", str(library), str(text)], check=True)
        return text.read_bytes()


def payload(bench: Bench, lanes: int) -> Iterator[Row]:
    """29 words that nobody uses."""
    wide, narrow = (bench.contender(name, lanes, name, name) for name in ("wide", "narrow"))
    yield Row("32 payload words over 3", lanes, bench.ratio(wide, narrow), (0.0, 1.05))


def bound_value(bench: Bench, lanes: int) -> Iterator[Row]:
    """A shadow ray that a bound value removes."""
    bound = bench.contender("bound", lanes, "narrow", "bound", (None, "light"), bound_values={"shadows": False}, max_trace_depth=2)
    without = bench.contender("without", lanes, "narrow", "without", (None, "light"), max_trace_depth=2)
    yield Row("a bound value over no shadow ray", lanes, bench.ratio(bound, without), (0.98, 1.02))


def recursion(bench: Bench, lanes: int) -> Iterator[Row]:
    """Balls between mirrors: 31 traces deep, and the same as a loop. The value is the speed of the recursion over the loop's."""
    mesh = mirrors()
    scene = bench.context.accel_build([ox.BuildInputTriangles(mesh.vertices, mesh.indices)])
    tree = bench.contender("tree", lanes, "tree", "tree", ("tree",), scene=scene, max_trace_depth=bench.shader.DEPTH)
    loop = bench.contender("loop", lanes, "loop", "loop", ("loop",), scene=scene)
    yield Row("speed of recursion to depth 31 over a loop", lanes, 1.0 / bench.ratio(tree, loop), (0.9, 99.0))


BENCHES: dict[str, Callable[[Bench, int], Iterator[Row]]] = {
    "dispatch": dispatch,
    "callables": callables,
    "exceptions": exceptions,
    "payload": payload,
    "bound_value": bound_value,
    "recursion": recursion,
}


def main() -> None:
    form = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(prog="python -m benchmarks.programs", description=__doc__, formatter_class=form)
    parser.add_argument("--only", action="append", choices=list(BENCHES), help="one of them; may be repeated")
    parser.add_argument("--lanes", type=lambda text: tuple(map(int, text.split(","))), default=(1, 8, 16), help="comma-separated widths")
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--clock", choices=[clock.value for clock in Clock], default=Clock.WALL.value, help="cpu: on a busy machine")
    arguments = parser.parse_args()
    bench = Bench(arguments.rounds, Clock(arguments.clock))
    for name in arguments.only or BENCHES:
        for lanes in arguments.lanes:
            for row in BENCHES[name](bench, lanes):
                print(row, flush=True)


if __name__ == "__main__":
    main()
