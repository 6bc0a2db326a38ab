"""Compile times: cold, one process each so that nothing is warm but the disk, and loads from the cache in a running process.

What a machine does once for each compiler and width is timed apart: asking the compiler for its version, and clang's precompiled header.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import optixc as ox
from benchmarks.handwritten import ROOT, compilers

_CODE = """
import json, resource, sys, time
sys.path.insert(0, sys.argv[1])
import optixc as ox
from benchmarks.compile_time import pipeline_of
context = ox.DeviceContext(cache_dir=sys.argv[2])
start = time.perf_counter()
pipeline = pipeline_of(context, sys.argv[3], int(sys.argv[4]))
seconds = time.perf_counter() - start
children = resource.getrusage(resource.RUSAGE_CHILDREN)
print(json.dumps([seconds, pipeline.report().compile_seconds, children.ru_utime + children.ru_stime]))
"""


@dataclass
class CompileTime:
    """Seconds: all of `pipeline_create` and `module_create` cold, the C++ compiler's part of it, that part's processor time (which
    other work on the machine disturbs less), the whole from the cache, and what the first compile of the machine takes more."""

    shader: str
    lanes: int
    compiler: str
    cold: float
    cxx: float
    cxx_cpu: float
    cached: float
    once: float


_SHADERS = ROOT / "benchmarks" / "shaders"
SHADERS = {
    "triangle": ROOT / "examples" / "02_triangle" / "shader.py",
    "ambient_occlusion": _SHADERS / "ambient_occlusion.py",
    "path": _SHADERS / "path.py",
    "heavy": _SHADERS / "path.py",
    "whitted": _SHADERS / "whitted.py",
}
LEFT_OUT = {"path": "__closesthit__principled", "heavy": "__closesthit__matte"}


def pipeline_of(context: ox.DeviceContext, shader: str, lanes: int) -> ox.Pipeline:
    """A pipeline of the programs of a shader, each in a group of its own."""
    module = context.module_create(SHADERS[shader])
    names = [name for name in module if name != LEFT_OUT.get(shader)]
    groups = [context.program_group_create(**{name.strip("_").split("__")[0]: module[name]}) for name in names]
    return context.pipeline_create(groups, max_trace_depth=8 if shader == "whitted" else 2, simd=lanes)


def measure(shader: str, lanes: int, compiler: str, rounds: int = 5) -> CompileTime:
    """Medians of `rounds` cold compiles and of as many loads."""
    samples, firsts = [], []
    for _ in range(rounds):
        with tempfile.TemporaryDirectory() as folder:
            firsts.append(_cold(shader, lanes, compiler, folder))
            _forget_pipelines(Path(folder))
            samples.append(_cold(shader, lanes, compiler, folder))
    cold, cxx, cxx_cpu = (statistics.median(column) for column in zip(*samples, strict=True))
    once = statistics.median(first[0] - sample[0] for first, sample in zip(firsts, samples, strict=True))
    return CompileTime(shader, lanes, compiler, cold, cxx, cxx_cpu, _cached(shader, lanes, compiler, rounds), once)


def _cold(shader: str, lanes: int, compiler: str, folder: str) -> list[float]:
    command = [sys.executable, "-c", _CODE, str(ROOT), folder, shader, str(lanes)]
    environment = os.environ | {"OPTIXC_CXX": compiler}
    answer = subprocess.run(command, capture_output=True, text=True, check=True, env=environment)
    measured: list[float] = json.loads(answer.stdout.splitlines()[-1])
    return measured


def _forget_pipelines(folder: Path) -> None:
    """Leaves only what the cache keeps of the compiler: its version and precompiled headers."""
    for path in folder.iterdir():
        if path.is_file() and path.name != "compilers.json":
            path.unlink()


def _cached(shader: str, lanes: int, compiler: str, rounds: int) -> float:
    before = os.environ.get("OPTIXC_CXX")
    os.environ["OPTIXC_CXX"] = compiler
    try:
        with tempfile.TemporaryDirectory() as folder:
            context = ox.DeviceContext(cache_dir=folder)
            pipeline_of(context, shader, lanes)
            times = []
            for _ in range(rounds):
                start = time.perf_counter()
                pipeline_of(context, shader, lanes)
                times.append(time.perf_counter() - start)
            return statistics.median(times)
    finally:
        os.environ.pop("OPTIXC_CXX")
        if before is not None:
            os.environ["OPTIXC_CXX"] = before


def measure_all(lanes: tuple[int, ...], rounds: int) -> list[CompileTime]:
    """Every shader at every width with every compiler."""
    return [measure(shader, width, compiler, rounds) for shader in SHADERS for width in lanes for compiler in compilers()]
