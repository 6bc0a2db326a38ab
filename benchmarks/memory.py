"""Peak memory of ambient occlusion of the dragon: ours in Python, the hand-written program, and Python with the same imports alone; and
what launches of the path tracer need for each thread beyond the scene."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

import optixc as ox
from benchmarks.handwritten import BUILD, FLAGS, INCLUDE, KERNELS, ROOT, Embree, EmbreeScene, compilers, embree_library, make_job
from benchmarks.ours import ours
from benchmarks.scenes import mesh_scene
from benchmarks.workloads import WORKLOADS, Workload

ALLOWED = 1.3
# not getrusage: its peak may be that of the process which started this one
_PEAK = "print(next(line.split()[1] for line in open('/proc/self/status') if line.startswith('VmHWM:')))"
_IMPORTS = "import sys; sys.path.insert(0, sys.argv[1])\nimport benchmarks.memory\n"
_RENDER = "benchmarks.memory.render_ours(int(sys.argv[2]))\n"
_LAUNCH = "print(benchmarks.memory.growth_by_launches(int(sys.argv[2])))\n"
_PATH_LAUNCHES = 3
_MANY_THREADS = 32


@dataclass
class PeakMemory:
    """MiB at most resident. `allowed` is 1.3 times the hand-written program plus the bare interpreter."""

    threads: int
    ours: float
    hand_written: float
    interpreter: float
    per_thread: float
    """MiB that each of many threads adds when it has rendered the path tracer."""

    @property
    def allowed(self) -> float:
        """What the project asks for."""
        return ALLOWED * self.hand_written + self.interpreter


def _workload(name: str = "ambient_occlusion") -> Workload:
    """The whole image."""
    return replace(next(one for one in WORKLOADS if one.name == name), share=1)


def _resident() -> float:
    """MiB of this process in memory now."""
    line = next(line for line in Path("/proc/self/status").read_text().splitlines() if line.startswith("VmRSS:"))
    return int(line.split()[1]) / 1024


def growth_by_launches(threads: int) -> float:
    """MiB that the process grows by when the scene, the image and the threads are there and it launches."""
    rendering = ours(ox.DeviceContext(threads=threads), mesh_scene("dragon"), _workload("path"), lanes="auto")
    rendering.image.fill(0.0)
    before = _resident()
    for _ in range(_PATH_LAUNCHES):
        rendering.run()
    return _resident() - before


def render_ours(threads: int) -> None:
    """What the measured process does."""
    context = ox.DeviceContext(threads=threads)
    ours(context, mesh_scene("dragon", with_normals=False), _workload(), lanes=1).run()


def _python(code: str, threads: int) -> float:
    command = [sys.executable, "-c", _IMPORTS + code, str(ROOT), str(threads)]
    answer = subprocess.run(command, capture_output=True, text=True, check=True)
    return float(answer.stdout.split()[-1])


def _program() -> Path:
    program = BUILD / "dragon_demo"
    sources = [str(KERNELS / f"{name}.cpp") for name in ("dragon_demo", "ambient_occlusion", "scene")]
    flags = [flag for flag in FLAGS if flag not in ("-shared", "-fPIC")]
    embree = embree_library()
    BUILD.mkdir(parents=True, exist_ok=True)
    command = [compilers()[0], *flags, f"-I{INCLUDE}", *sources, "-o", str(program), str(embree), f"-Wl,-rpath,{embree.parent}", "-pthread"]
    subprocess.run(command, check=True)
    return program


def _hand_written(threads: int) -> float:
    scene = mesh_scene("dragon", with_normals=False)
    embree = Embree(threads)
    image = np.zeros((1, 1, 4), np.float32)
    job = make_job(embree, EmbreeScene(embree, scene, with_light=False), _workload(), threads, image)
    with tempfile.TemporaryDirectory() as folder:
        files = [Path(folder) / name for name in ("vertices", "triangles", "job")]
        scene.vertices.tofile(files[0])
        scene.triangles.tofile(files[1])
        files[2].write_bytes(bytes(embree.ffi.buffer(job)))
        command = [str(_program()), *map(str, files), f"threads={threads}"]
        return int(subprocess.run(command, capture_output=True, text=True, check=True).stdout) / 1024


def measure(threads: int) -> PeakMemory:
    """Four processes, one after the other; raises SceneMissing without the dragon."""
    per_thread = _python(_LAUNCH, _MANY_THREADS) / _MANY_THREADS
    return PeakMemory(threads, _python(_RENDER + _PEAK, threads) / 1024, _hand_written(threads), _python(_PEAK, threads) / 1024, per_thread)
