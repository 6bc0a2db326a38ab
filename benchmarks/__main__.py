"""`python -m benchmarks`: measures, prints the tables, writes a JSON record, a Markdown page and a plot under build/benchmarks/."""

from __future__ import annotations

import argparse
from pathlib import Path

from tqdm import tqdm

import optixc as ox
from benchmarks import compile_time, launch_overhead, limits, machine, memory, peers, plot
from benchmarks.handwritten import BUILD, Embree, compilers
from benchmarks.measure import Clock
from benchmarks.rays import Settings, measure_row
from benchmarks.report import Results, markdown, row_details, summary
from benchmarks.scenes import SceneMissing
from benchmarks.workloads import rows

PARTS = ("rays", "limits", "compile", "launch", "memory", "peers")


def _numbers(text: str) -> tuple[int, ...]:
    return tuple(int(part) for part in text.split(","))


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("--only", action="append", default=[], metavar="ROW", help="a row, `path` or `path:sponza`; may be repeated")
    parser.add_argument("--parts", default=None, help=f"comma-separated, of {', '.join(PARTS)} (default: all; with --only: rays, limits)")
    parser.add_argument("--threads", type=_numbers, default=(1, 2), help="comma-separated numbers of threads (default 1,2)")
    parser.add_argument("--rounds", type=int, default=7, help="interleaved rounds (default 7)")
    parser.add_argument("--lanes", type=_numbers, default=(1, 8, 16), help="widths of ours (default 1,8,16)")
    parser.add_argument("--compilers", action="store_true", help="compile ours with each compiler instead of the one that optixc chooses")
    clocks = [clock.value for clock in Clock]
    parser.add_argument("--clock", choices=clocks, default=Clock.WALL.value, help="cpu: for one thread on a busy machine")
    parser.add_argument("--all-forms", action="store_true", help="time all hand-written forms in all rounds, not just the fastest")
    parser.add_argument("--output", type=Path, default=BUILD / "results", help="stem of the .json, .md and .png files")
    return parser.parse_args()


def _measure_rays(arguments: argparse.Namespace, results: Results, with_limits: bool) -> None:
    settings = Settings(
        rounds=arguments.rounds,
        lanes=arguments.lanes,
        clock=Clock(arguments.clock),
        all_forms=arguments.all_forms,
        our_compilers=tuple(compilers()) if arguments.compilers else (None,),
    )
    chosen = [(threads, *row) for threads in arguments.threads for row in rows(arguments.only)]
    embrees = {threads: Embree(threads) for threads in arguments.threads}
    contexts = {threads: ox.DeviceContext(threads=threads) for threads in arguments.threads}
    progress = tqdm(chosen, unit="row", delay=2.0, disable=None, leave=False)
    for threads, workload, scene in progress:
        progress.set_description(f"{workload.name}:{scene}, {threads} threads")
        try:
            row = measure_row(embrees[threads], contexts[threads], workload, scene, threads, settings)
        except SceneMissing as missing:
            results.skipped.append(f"{workload.name}:{scene}: {missing}")
            continue
        results.rows.append(row)
        progress.write(row_details(row) + "\n")
        # In the same minute as the row: the machine's speed changes.
        if with_limits and threads == 1:
            results.limits.append(limits.measure(embrees[1], workload, scene))


def _measure_limits(arguments: argparse.Namespace, results: Results) -> None:
    embree = Embree(1)
    for workload, scene in tqdm(rows(arguments.only), desc="limits", unit="row", delay=2.0, disable=None, leave=False):
        try:
            results.limits.append(limits.measure(embree, workload, scene))
        except SceneMissing as missing:
            results.skipped.append(f"limit of {workload.name}:{scene}: {missing}")


def _measure_others(arguments: argparse.Namespace, parts: list[str], results: Results) -> None:
    if "launch" in parts:
        results.launches = [launch_overhead.measure(threads, lanes) for threads in arguments.threads for lanes in arguments.lanes]
    if "memory" in parts:
        try:
            results.memory = [memory.measure(threads) for threads in arguments.threads]
        except SceneMissing as missing:
            results.skipped.append(f"memory: {missing}")
    if "compile" in parts:
        results.compiles = compile_time.measure_all(arguments.lanes, min(arguments.rounds, 5))
    if "peers" in parts:
        found = peers.measure_all(arguments.threads, arguments.rounds, Clock(arguments.clock))
        results.peers = found.results
        results.skipped += found.skipped


def main() -> None:
    arguments = _arguments()
    default = "rays,limits" if arguments.only else ",".join(PARTS)
    parts = (arguments.parts or default).split(",")
    for part in parts:
        if part not in PARTS:
            raise SystemExit(f"no such part: {part}; there are {', '.join(PARTS)}")
    results = Results(machine.describe())
    if "rays" in parts:
        _measure_rays(arguments, results, with_limits="limits" in parts)
    if "limits" in parts and not results.limits:
        _measure_limits(arguments, results)
    _measure_others(arguments, parts, results)
    json_path, page, picture = (arguments.output.with_suffix(suffix) for suffix in (".json", ".md", ".png"))
    results.write(json_path)
    page.write_text(markdown(results))
    print(summary(results) if results.rows else markdown(results))
    print(f"\n{json_path}\n{page}")
    if results.rows and plot.draw(results, picture):
        print(picture)


if __name__ == "__main__":
    main()
