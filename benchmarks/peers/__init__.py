"""Primary rays with normal shading in other systems, each where it is installed, and in optixc beside them.

A peer is a module with `missing()` that says what is not installed, SHADER (whether shading of the user runs in it, rather than queries of
arrays of rays), and `make(frame, threads)` that gives a function which renders once. Each runs in a process of its own, so that no two
thread pools meet; the processes of a scene live at the same time and render in turn.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field

from benchmarks.handwritten import ROOT
from benchmarks.measure import Clock
from benchmarks.scenes import IMAGE_SIZE

OURS = "optixc_lanes"
PEERS = (OURS, "mitsuba_llvm", "numba_embree", "open3d_rays", "embreex_rays", "trimesh_rays")
SCENES = ("sibenik", "dragon")

# Renders once for each line that it reads and answers with the seconds; what the peer itself prints goes to stderr.
_CODE = """
import importlib, os, sys, time
root, name, scene, threads, clock = sys.argv[1:]
answers = os.fdopen(os.dup(1), "w", buffering=1)
os.dup2(2, 1)
sys.path.insert(0, root)
peer = importlib.import_module("benchmarks.peers." + name)
from benchmarks.peers.frame import Frame
if missing := peer.missing():
    raise SystemExit(missing)
now = time.process_time if clock == "cpu" else time.perf_counter
render = peer.make(Frame.of(scene), int(threads))
render()
print(int(peer.SHADER), file=answers)
for line in sys.stdin:
    start = now()
    render()
    print(now() - start, file=answers)
"""


@dataclass
class PeerResult:
    """One system on one scene. `ours` is the median over the rounds of its seconds over those of optixc."""

    name: str
    threads: int
    mrays_per_second: float
    shader: bool
    ours: float


class _Process:
    """A peer at work."""

    def __init__(self, peer: str, scene: str, threads: int, clock: Clock) -> None:
        self.peer = peer
        self.seconds: list[float] = []
        self._errors = tempfile.TemporaryFile("w+")  # noqa: SIM115 - `end` closes it
        command = [sys.executable, "-c", _CODE, str(ROOT), peer, scene, str(threads), clock.value]
        self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._errors, text=True, bufsize=1
        )
        first = self._answer()
        self.shader = first == "1"
        self.problem = "" if first else self._last_words()

    def run(self) -> None:
        """Renders once."""
        assert self._process.stdin is not None
        self._process.stdin.write("\n")
        answer = self._answer()
        if not answer:
            raise RuntimeError(f"{self.peer}: {self._last_words()}")
        self.seconds.append(float(answer))

    def end(self) -> None:
        """Lets the process end."""
        self._process.communicate()
        self._errors.close()

    def _answer(self) -> str:
        assert self._process.stdout is not None
        return self._process.stdout.readline().strip()

    def _last_words(self) -> str:
        self._process.wait()
        self._errors.seek(0)
        return (self._errors.read().strip().splitlines() or ["it ended without a word"])[-1]


@dataclass
class Peers:
    """What was measured, and what was skipped and why."""

    results: list[PeerResult] = field(default_factory=list)
    skipped: list[str] = field(default_factory=list)

    def measure(self, scene: str, threads: int, rounds: int, clock: Clock) -> None:
        """All systems on one scene in turn."""
        started = [_Process(peer, scene, threads, clock) for peer in PEERS]
        running = [process for process in started if not process.problem]
        self.skipped += [f"{process.peer} on {scene}, {threads} threads: {process.problem}" for process in started if process.problem]
        for number in range(rounds):
            first = number % len(running)
            for process in [*running[first:], *running[:first]]:
                process.run()
        for process in started:
            process.end()
        baseline = next((process.seconds for process in running if process.peer == OURS), [])
        for process in running:
            ratios = [own / ours for own, ours in zip(process.seconds, baseline, strict=False)]
            speed = IMAGE_SIZE * IMAGE_SIZE / statistics.median(process.seconds) / 1e6
            ours = statistics.median(ratios) if ratios else float("nan")
            self.results.append(PeerResult(f"{process.peer}: {scene}", threads, speed, process.shader, ours))


def measure_all(threads: tuple[int, ...], rounds: int, clock: Clock) -> Peers:
    """Every system on every scene that is there."""
    peers = Peers()
    for scene in SCENES:
        for count in threads:
            peers.measure(scene, count, rounds, clock)
    return peers
