"""Interleaved timing: every round runs every contender once, and ratios are taken inside a round before their median is."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import Any, Protocol

import optixc as ox


class Clock(Enum):
    """What counts: the clock on the wall, or the processor time of this process, which other work on the machine disturbs less."""

    WALL = "wall"
    CPU = "cpu"


class Contender(Protocol):
    """Something that renders once and says how long it took."""

    name: str

    def run(self) -> float: ...


@dataclass
class LaunchContender:
    """A pipeline of ours with what a launch takes."""

    name: str
    pipeline: ox.Pipeline
    table: ox.ShaderBindingTable
    params: Any
    width: int
    height: int

    def run(self) -> float:
        """Launches once; the seconds that it took."""
        start = time.perf_counter()
        self.pipeline.launch(self.params, self.table, width=self.width, height=self.height)
        return time.perf_counter() - start


@dataclass
class Timings:
    """Seconds of every round, by contender."""

    seconds: dict[str, list[float]] = field(default_factory=dict)

    def median(self, name: str) -> float:
        """Median seconds of a contender."""
        return statistics.median(self.seconds[name])

    def spread(self, name: str) -> float:
        """Half the distance of the quartiles, over the median."""
        times = self.seconds[name]
        if len(times) < 2:
            return 0.0
        low, _, high = statistics.quantiles(times, n=4, method="inclusive")
        return (high - low) / 2 / statistics.median(times)

    def speed_up(self, name: str, baseline: str) -> float:
        """Median over the rounds of the baseline's seconds over those of `name`."""
        pairs = zip(self.seconds[baseline], self.seconds[name], strict=True)
        return statistics.median(base / own for base, own in pairs)

    def fastest(self, names: Sequence[str]) -> str:
        """The contender of `names` with the smallest median."""
        return min(names, key=self.median)


def timed(run: Callable[[], float], clock: Clock) -> float:
    """Seconds of one run by `clock`."""
    if clock is Clock.WALL:
        return run()
    start = time.process_time()
    run()
    return time.process_time() - start


def interleave(contenders: Sequence[Contender], rounds: int, clock: Clock = Clock.WALL) -> Timings:
    """Runs all contenders `rounds` times in turn after one run each that does not count; each round begins with another one."""
    timings = Timings({contender.name: [] for contender in contenders})
    for contender in contenders:
        contender.run()
    for number in range(rounds):
        first = number % len(contenders)
        for contender in [*contenders[first:], *contenders[:first]]:
            timings.seconds[contender.name].append(timed(contender.run, clock))
    return timings
