"""What a launch costs that does nothing, from C and from Python, with parameters and SBT prebuilt."""

from __future__ import annotations

import statistics
import time
from dataclasses import dataclass
from typing import Any

import cffi

import optixc as ox
from benchmarks.handwritten import build, compilers
from benchmarks.ours import SHADERS, shader_module
from optixc.host import library

COUNT = 2000


@dataclass
class LaunchTime:
    """Median microseconds of an empty launch of `size` x `size`."""

    size: int
    threads: int
    lanes: int
    c: float
    python: float


def _c_function() -> tuple[Any, Any]:
    ffi = cffi.FFI()
    ffi.cdef(
        "double bench_launch_overhead(void* launch, void* pipeline, const void* params, size_t size, const void* table, uint32_t width,"
        " uint32_t height, uint32_t count);"
    )
    return ffi, ffi.dlopen(str(build("launch_overhead", compilers()[0])))


def measure(threads: int, lanes: int, size: int = 64) -> LaunchTime:
    """Back-to-back launches in one context."""
    context = ox.DeviceContext(threads=threads)
    module = context.module_create(SHADERS / "empty.py")
    raygen = context.program_group_create(raygen=module["__raygen__empty"])
    pipeline = context.pipeline_create([raygen], simd=lanes)
    table = ox.ShaderBindingTable(raygen=raygen.record())
    params = shader_module("empty").Params(unused=0)
    times = []
    for _ in range(COUNT):
        start = time.perf_counter()
        pipeline.launch(params, table, width=size, height=size)
        times.append((time.perf_counter() - start) * 1e6)
    ffi, c_library = _c_function()
    own, packed = library.ffi(), params.packed()
    address = {
        "launch": own.cast("uintptr_t", own.addressof(library.lib(), "oxrtLaunch")),
        "pipeline": own.cast("uintptr_t", pipeline._pipeline),
        "table": own.cast("uintptr_t", table.c_table(pipeline)),
    }
    pointers = {name: ffi.cast("void*", int(value)) for name, value in address.items()}
    c_time = c_library.bench_launch_overhead(
        pointers["launch"], pointers["pipeline"], ffi.from_buffer(packed), len(packed), pointers["table"], size, size, COUNT
    )
    return LaunchTime(size, threads, lanes, float(c_time), statistics.median(times))
