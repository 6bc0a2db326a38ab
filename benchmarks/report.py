"""The tables in Markdown and the record in JSON."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from pathlib import Path

from benchmarks.compile_time import CompileTime
from benchmarks.launch_overhead import LaunchTime
from benchmarks.limits import Limit
from benchmarks.memory import PeakMemory
from benchmarks.peers import PeerResult
from benchmarks.rays import Row
from benchmarks.workloads import WORKLOADS


@dataclass
class Results:
    """All that one run measured."""

    machine: dict[str, object]
    rows: list[Row] = field(default_factory=list)
    limits: list[Limit] = field(default_factory=list)
    compiles: list[CompileTime] = field(default_factory=list)
    launches: list[LaunchTime] = field(default_factory=list)
    memory: list[PeakMemory] = field(default_factory=list)
    peers: list[PeerResult] = field(default_factory=list)
    skipped: list[str] = field(default_factory=list)

    def write(self, path: Path) -> None:
        """As JSON."""
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(asdict(self), indent=1) + "\n")


def table(header: list[str], lines: list[list[str]]) -> str:
    """A Markdown table; the first column is text, the others numbers."""
    rule = ["---"] + ["---:"] * (len(header) - 1)
    return "\n".join("| " + " | ".join(line) + " |" for line in [header, rule, *lines])


def row_details(row: Row) -> str:
    """All contenders of a row."""
    lines = [
        [
            entry.name,
            f"{entry.mrays_per_second:.2f}",
            f"{100 * entry.spread:.0f} %",
            f"{entry.over_scalar:.2f}",
            f"{entry.over_tuned:.2f}",
            f"{entry.over_packet:.2f}",
            f"{entry.differing_pixels:.1e}",
        ]
        for entry in row.entries
    ]
    title = f"### {row.workload}:{row.scene}, {row.threads} thread{'s' if row.threads > 1 else ''}, {row.rays / 1e6:.2f} million rays\n\n"
    header = ["kernel", "Mrays/s", "spread", "x best scalar", "x best tuned", "x best packet", "pixels that differ"]
    return title + table(header, lines) + "".join(f"\n\n{failure}" for failure in row.failures)


def _ratio(row: Row, prefix: str, over: str = "scalar") -> str:
    found = [getattr(entry, f"over_{over}") for entry in row.entries if entry.name == prefix or entry.name.startswith(prefix + " ")]
    return f"{max(found):.2f}" if found else "-"


def summary(results: Results) -> str:
    """A table for each number of threads."""
    numbers = sorted({row.threads for row in results.rows})
    tables = [(number, _summary([row for row in results.rows if row.threads == number], results.limits)) for number in numbers]
    return "\n\n".join(f"### {number} thread{'s' if number > 1 else ''}\n\n{text}" for number, text in tables)


_WIDTHS = (1, 8, 16)


def _summary(rows: list[Row], limits: list[Limit]) -> str:
    """One line a row: ours over the best scalar and over the best packet kernel, and the part of pure traversal that is reached."""
    titles = {workload.name: workload.title for workload in WORKLOADS}
    # Limits are those of one thread.
    known = {(limit.workload, limit.scene): limit.mrays_per_second for limit in limits if rows[0].threads == 1}
    lines = []
    for row in rows:
        packets = [entry.over_scalar for entry in row.entries if entry.name == row.best_packet]
        scalar = row.entry(row.best_scalar)
        limit = known.get((row.workload, row.scene))
        lines.append(
            [
                f"{titles[row.workload]}: {row.scene}",
                f"{scalar.mrays_per_second:.2f}" if scalar else "-",
                f"{packets[0]:.2f}" if packets else "-",
                *(_ratio(row, f"ours {lanes}") for lanes in _WIDTHS),
                f"{row.must:g} / {row.aim:g}",
                _ratio(row, "ours 1", "tuned"),
                *(_ratio(row, f"ours {lanes}", "packet") for lanes in _WIDTHS[1:]),
                *([f"{limit:.2f}", *(_part(row, f"ours {lanes}", limit) for lanes in _WIDTHS)] if limit else ["-"] * 4 if known else []),
            ]
        )
    header = ["workload", "scalar C++, Mrays/s", "packet C++", "ours 1", "ours 8", "ours 16", "must / aim", "1 / tuned C++"]
    header += ["8 / packet C++", "16 / packet C++"]
    header += ["limit, Mrays/s", "1 reaches", "8 reaches", "16 reaches"] if known else []
    return table(header, lines)


def _part(row: Row, name: str, limit: float) -> str:
    """Which part of the limit the fastest of ours of that width reaches."""
    found = [entry.mrays_per_second for entry in row.entries if entry.name == name or entry.name.startswith(name + " ")]
    return f"{max(found) / limit:.2f}" if found else "-"


def _limits(results: Results) -> str:
    header = ["rays", "million", "single, ns", "packet, ns", "coherent, ns"]
    parts = []
    for limit in results.limits:
        lines = []
        for one in limit.classes:
            nanoseconds = [seconds / max(one.rays, 1) * 1e9 for seconds in (one.single, one.packet, one.coherent)]
            lines.append([one.name, f"{one.rays / 1e6:.2f}", *(f"{value:.0f}" for value in nanoseconds)])
        title = f"### {limit.workload}:{limit.scene}: at most {limit.mrays_per_second:.2f} Mrays/s on one thread"
        parts.append(title + "\n\n" + table(header, lines))
    return "\n\n".join(parts)


def _others(results: Results) -> list[str]:
    parts = []
    if results.compiles:
        lines = [
            [
                *(one.shader, str(one.lanes), one.compiler),
                *(f"{seconds:.2f}" for seconds in (one.cold, one.cxx, one.once)),
                f"{1e3 * one.cached:.1f}",
            ]
            for one in results.compiles
        ]
        header = ["shader", "lanes", "compiler", "cold, s", "of it C++, s", "once a machine, s", "from cache, ms"]
        parts.append("## Compile times\n\n" + table(header, lines))
    if results.launches:
        lines = [
            [f"{one.size} x {one.size}", str(one.threads), str(one.lanes), f"{one.c:.1f}", f"{one.python:.1f}"] for one in results.launches
        ]
        parts.append("## Empty launch\n\n" + table(["size", "threads", "lanes", "from C, us", "from Python, us"], lines))
    if results.memory:
        lines = [
            [
                str(one.threads),
                *(f"{value:.0f}" for value in (one.ours, one.hand_written, one.interpreter, one.allowed)),
                f"{one.per_thread:.2f}",
            ]
            for one in results.memory
        ]
        header = ["threads", "ours, MiB", "hand-written, MiB", "bare interpreter, MiB", "allowed, MiB", "a thread of the path tracer, MiB"]
        parts.append("## Peak memory, ambient occlusion of the dragon\n\n" + table(header, lines))
    return parts


def markdown(results: Results) -> str:
    """Everything, the summary first."""
    parts = ["# Measurements", "\n".join(f"- {key}: {value}" for key, value in results.machine.items())]
    if results.rows:
        parts += ["## Speed over the best hand-written scalar kernel", summary(results)]
    if results.peers:
        lines = [
            [one.name, str(one.threads), f"{one.mrays_per_second:.2f}", "yes" if one.shader else "no", f"{one.ours:.2f}"]
            for one in results.peers
        ]
        header = ["system", "threads", "Mrays/s", "runs the user's shading", "speed of optixc over it"]
        parts.append("## Primary rays in other systems\n\n" + table(header, lines))
    parts += _others(results)
    if results.limits:
        parts += ["## Pure traversal of the same rays", _limits(results)]
    if results.rows:
        parts += ["## All kernels", *(row_details(row) for row in results.rows)]
    parts += [f"Skipped: {text}" for text in results.skipped]
    return "\n\n".join(parts) + "\n"
