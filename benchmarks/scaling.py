"""Scaling with threads: one process with N threads against N processes of one thread each, which share nothing.

`python -m benchmarks.scaling --threads 1,2,4,8,16` renders the path tracer. The processes are the control: what the machine's clock,
caches and memory take away from N busy cores they lose too; what is left is the cost of sharing a launch.
"""

from __future__ import annotations

import argparse
import math
import multiprocessing
import os
import statistics
import time
from collections.abc import Callable
from typing import Any

import optixc as ox
from benchmarks.ours import ours
from benchmarks.scenes import load_scene
from benchmarks.workloads import WORKLOADS

SECONDS = 1.0
WARM_UP = 3


def renderer(scene: str, lanes: int, threads: int) -> Callable[[], float]:
    """Renders the path tracer once and gives the seconds."""
    workload = next(one for one in WORKLOADS if one.name == "path")
    made = ours(ox.DeviceContext(threads=threads), load_scene(scene), workload, lanes)
    for _ in range(WARM_UP):
        made.run()
    return made.run


def rate(run: Callable[[], float]) -> float:
    """Pictures a second, by the median of as many as fit into `SECONDS`."""
    times = []
    end = time.perf_counter() + SECONDS
    while time.perf_counter() < end or len(times) < 3:
        times.append(run())
    return 1.0 / statistics.median(times)


def _worker(scene: str, lanes: int, number: int, barrier: Any, rates: Any) -> None:
    os.sched_setaffinity(0, {sorted(os.sched_getaffinity(0))[number]})
    run = renderer(scene, lanes, 1)
    barrier.wait()
    own = rate(run)
    barrier.wait()  # all go on until all have measured
    rates[number] = own


def control_rate(scene: str, lanes: int, processes: int) -> float:
    """Pictures a second of all processes together."""
    spawn = multiprocessing.get_context("spawn")
    barrier, rates = spawn.Barrier(processes), spawn.Array("d", processes)
    workers = [spawn.Process(target=_worker, args=(scene, lanes, i, barrier, rates)) for i in range(processes)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    if any(worker.exitcode for worker in workers):
        raise RuntimeError("a process of the control failed; its message stands above")
    return math.fsum(rates[:])


def main() -> None:
    """Prints a row for each number of threads."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.scaling", description=__doc__)
    parser.add_argument("--scene", default="sponza")
    parser.add_argument("--lanes", type=int, default=16)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--threads", default="1,2", help="comma-separated, 1 first")
    arguments = parser.parse_args()
    counts = [int(text) for text in arguments.threads.split(",")]
    renderers = {n: renderer(arguments.scene, arguments.lanes, n) for n in counts}
    own: dict[int, list[float]] = {n: [] for n in counts}
    control: dict[int, list[float]] = {n: [] for n in counts}
    for _ in range(arguments.rounds):
        for n in counts:
            own[n].append(rate(renderers[n]))
            control[n].append(control_rate(arguments.scene, arguments.lanes, n))
    print("| threads | x one thread | control: x one process | share of the control |\n| ---: | ---: | ---: | ---: |")
    for n in counts:
        ours_gain = statistics.median(own[n]) / statistics.median(own[counts[0]])
        control_gain = statistics.median(control[n]) / statistics.median(control[counts[0]])
        print(f"| {n} | {ours_gain:.2f} | {control_gain:.2f} | {ours_gain / control_gain:.2f} |")


if __name__ == "__main__":
    main()
