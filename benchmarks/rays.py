"""Rays per second of one row: hand-written forms, ours at several widths, all on the same rays, and whether the images agree."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field

import numpy as np

import optixc as ox
from benchmarks.handwritten import Embree, EmbreeScene, HandWritten, compilers, hand_written
from benchmarks.measure import Clock, Contender, Timings, interleave
from benchmarks.ours import Ours, ours
from benchmarks.scenes import Floats, Scene, load_scene
from benchmarks.workloads import Workload

QUALIFYING_ROUNDS = 3


@dataclass
class Entry:
    """One contender's result; speed-ups are over the best hand-written kernels of the row, the tuned one apart."""

    name: str
    mrays_per_second: float
    spread: float
    over_scalar: float
    over_tuned: float
    over_packet: float
    differing_pixels: float


@dataclass
class Row:
    """One workload on one scene with one number of threads."""

    workload: str
    scene: str
    threads: int
    rays: int
    must: float
    aim: float
    best_scalar: str
    best_tuned: str
    best_packet: str
    entries: list[Entry] = field(default_factory=list)
    failures: list[str] = field(default_factory=list)

    def entry(self, name: str) -> Entry | None:
        """The entry of that name."""
        return next((entry for entry in self.entries if entry.name == name), None)

    def as_record(self) -> dict[str, object]:
        """For JSON."""
        return asdict(self)


@dataclass
class Settings:
    """What the command line chose for rays per second."""

    rounds: int = 7
    lanes: tuple[int, ...] = (1, 8, 16)
    clock: Clock = Clock.WALL
    all_forms: bool = False
    our_compilers: tuple[str | None, ...] = (None,)


def differing(image: Floats, reference: Floats) -> float:
    """The share of pixels that differ by more than 1/1000 of the reference's mean."""
    tolerance = 1e-3 * max(float(reference[..., :3].mean()), 1e-6)
    return float(np.mean(np.abs(image[..., :3] - reference[..., :3]).max(-1) > tolerance))


def _forms(
    embree: Embree, built: EmbreeScene, workload: Workload, threads: int, names: Sequence[str], tuned: bool = False
) -> list[HandWritten]:
    return [hand_written(embree, built, workload, form, compiler, threads, tuned) for form in names for compiler in compilers()]


def _our_contenders(context: ox.DeviceContext, scene: Scene, workload: Workload, settings: Settings, row: Row) -> list[Ours]:
    made: list[Ours] = []
    for lanes in settings.lanes:
        for compiler in settings.our_compilers:
            try:
                made.append(ours(context, scene, workload, lanes, compiler))
            except (ox.OptixError, RuntimeError, NotImplementedError) as error:
                row.failures.append(f"ours {lanes}: {str(error).splitlines()[0]}")
    return made


def measure_row(embree: Embree, context: ox.DeviceContext, workload: Workload, scene_name: str, threads: int, settings: Settings) -> Row:
    """Times one row. `context` must have been made with `threads`."""
    scene = load_scene(scene_name)
    built = EmbreeScene(embree, scene, with_light=workload.name in ("path", "heavy"))
    scalars = _forms(embree, built, workload, threads, workload.scalar_forms)
    packets = _forms(embree, built, workload, threads, workload.packet_forms)
    tuned = _forms(embree, built, workload, threads, workload.scalar_forms, tuned=True)
    qualified: list[HandWritten] = [*scalars, *tuned, *packets]
    if not settings.all_forms:
        heats = interleave(qualified, QUALIFYING_ROUNDS, settings.clock)
        qualified = [one for forms in (scalars, tuned, packets) for one in sorted(forms, key=lambda one: heats.median(one.name))[:2]]
    row = Row(workload.name, scene_name, threads, 0, workload.must[scene_name], workload.aim[scene_name], "", "", "")
    own = _our_contenders(context, scene, workload, settings, row)
    contenders: list[Contender] = [*qualified, *own]
    timings = interleave(contenders, settings.rounds, settings.clock)
    row.rays = scalars[0].rays
    row.best_scalar = timings.fastest([one.name for one in qualified if one in scalars])
    row.best_tuned = timings.fastest([one.name for one in qualified if one in tuned])
    row.best_packet = timings.fastest([one.name for one in qualified if one in packets])
    everyone: list[HandWritten | Ours] = [*qualified, *own]
    for one in everyone:
        row.entries.append(_entry(one, timings, row, scalars[0].image))
    return row


def _entry(one: HandWritten | Ours, timings: Timings, row: Row, reference: Floats) -> Entry:
    return Entry(
        name=one.name,
        mrays_per_second=row.rays / timings.median(one.name) / 1e6,
        spread=timings.spread(one.name),
        over_scalar=timings.speed_up(one.name, row.best_scalar),
        over_tuned=timings.speed_up(one.name, row.best_tuned),
        over_packet=timings.speed_up(one.name, row.best_packet),
        differing_pixels=differing(one.image, reference),
    )
