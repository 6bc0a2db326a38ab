"""Primary rays with normal shading in other systems, each where it is installed.

A peer is a module with NAME, SHADER (whether the user's own shading runs in it), `missing()` that says what is not installed, and
`make(scene, threads)` that gives a function which renders once and returns an image or a hit mask.
"""

from __future__ import annotations

import json
import statistics
import subprocess
import sys

from benchmarks.handwritten import ROOT

PEERS = ("mitsuba_llvm", "numba_embree", "open3d_rays", "embreex_rays", "trimesh_rays")
SCENES = ("sibenik", "dragon")

_CODE = """
import json, sys, time
sys.path.insert(0, sys.argv[1])
import importlib
peer = importlib.import_module("benchmarks.peers." + sys.argv[2])
from benchmarks.peers.frame import Frame
threads, rounds = int(sys.argv[4]), int(sys.argv[5])
frame = Frame.of(sys.argv[3])
render = peer.make(frame, threads)
start = time.perf_counter()
render()
first = time.perf_counter() - start
times = []
for _ in range(rounds):
    start = time.perf_counter()
    render()
    times.append(time.perf_counter() - start)
print(json.dumps([first, times]))
"""


def _missing(peer: str) -> str | None:
    code = f"import sys; sys.path.insert(0, {str(ROOT)!r})\nfrom benchmarks.peers import {peer}\nprint({peer}.missing() or '')"
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    return answer.stderr.strip().splitlines()[-1] if answer.returncode else answer.stdout.strip() or None


def measure_all(threads: tuple[int, ...], rounds: int) -> tuple[list[dict[str, object]], list[str]]:
    """Every peer on every scene, in a process of its own so that no two thread pools meet; and what was skipped and why."""
    results: list[dict[str, object]] = []
    skipped: list[str] = []
    for peer in PEERS:
        if reason := _missing(peer):
            skipped.append(f"{peer}: {reason}")
            continue
        for scene in SCENES:
            for count in threads:
                command = [sys.executable, "-c", _CODE, str(ROOT), peer, scene, str(count), str(rounds)]
                answer = subprocess.run(command, capture_output=True, text=True, check=False)
                if answer.returncode:
                    skipped.append(f"{peer} on {scene}: {answer.stderr.strip().splitlines()[-1]}")
                    continue
                first, times = json.loads(answer.stdout.splitlines()[-1])
                results.append(
                    {
                        "name": f"{peer}: {scene}",
                        "threads": count,
                        "mrays_per_second": 1024 * 1024 / statistics.median(times) / 1e6,
                        "first_seconds": first,
                        "shader": peer in ("mitsuba_llvm", "numba_embree"),
                    }
                )
    return results, skipped
