"""`interpret`: one launch index of a pipeline in CPython, with the shader's own source, lines and variables.

Rays go through the same runtime and the same records as a launch. Results agree with compiled code bit for bit in precise mode;
`print` and `breakpoint` work, and a debugger steps through the shader file.
"""

from __future__ import annotations

import ctypes
import threading
import weakref
from collections.abc import Iterable
from typing import Any

import numpy as np

from optixc.errors import InvalidValueError
from optixc.frontend.checked import FunctionInstance
from optixc.host import in_flight, library
from optixc.host.pipeline import Pipeline
from optixc.host.sbt import ShaderBindingTable
from optixc.interpret.machine import Machine

_machines: weakref.WeakKeyDictionary[Pipeline, Machine] = weakref.WeakKeyDictionary()
_lock = threading.RLock()


def interpret(
    pipeline: Pipeline, params: Any, sbt: ShaderBindingTable, size: int | Iterable[int], index: int | Iterable[int]
) -> None:
    """Runs launch index `index` of a launch of `size` (one to three numbers each) in Python; arrays in `params` are written.

    Raises what a program raises (AssertionError, IndexError for an index outside of an array), LaunchFailureError for traces nested
    too deep, InvalidValueError for a size or index that a launch would refuse.
    """
    if not isinstance(pipeline, Pipeline):
        raise InvalidValueError(f"interpret takes a pipeline, not {type(pipeline).__name__}")
    extent, place = _three(size, "size"), _three(index, "index", missing=0)
    if any(one >= limit for one, limit in zip(place, extent, strict=True)):
        raise InvalidValueError(f"index {place} lies outside of the launch size {extent}")
    with _lock:
        machine = _machines.get(pipeline)
        if machine is None:
            machine = _machines[pipeline] = _machine(pipeline)
        kept = in_flight.begin()
        try:
            _run(machine, *pipeline.launch_inputs(params, sbt), extent, place)
        finally:
            in_flight.end(kept)


def _run(
    machine: Machine, handle: Any, data: Any, data_size: int, table: Any, extent: tuple[int, ...], place: tuple[int, ...]
) -> None:
    ffi, lib = library.ffi(), library.lib()
    made = ffi.new("OxrtInterpreter*")
    scene = (machine.uses_motion, machine.uses_micromaps)
    library.check(lib.oxrtInterpreterCreate(handle, data, data_size, table, *extent, *scene, machine.callback, ffi.NULL, made))
    try:
        lib.oxrtInterpreterSetIndex(made[0], *place)
        held = ctypes.create_string_buffer(bytes(ffi.buffer(data, data_size)) if data_size else b"\0")
        machine.load_params(ctypes.addressof(held))
        machine.run(made[0], table)
    finally:
        lib.oxrtInterpreterDestroy(made[0])


def _machine(pipeline: Pipeline) -> Machine:
    """The programs of a pipeline by their numbers in the records."""
    instances: dict[str, FunctionInstance] = {}
    params = None
    for program in dict.fromkeys(program for group in pipeline.groups for program in group.programs.values()):
        checked = program.module.unit.result.checked
        params = params or checked.params
        instances[program.name] = next(one for one in checked.programs if one.name == program.name)
    numbers = {pipeline.program_number(name): instance for name, instance in instances.items()}
    depth = pipeline.report().max_trace_depth
    return Machine(numbers, params, depth, pipeline.exception_flags, pipeline.uses_motion, pipeline.uses_micromaps)


def _three(numbers: int | Iterable[int], what: str, missing: int = 1) -> tuple[int, ...]:
    given = tuple(numbers) if isinstance(numbers, Iterable) else (numbers,)
    if not 1 <= len(given) <= 3 or not all(isinstance(one, int | np.integer) and one >= 0 for one in given):
        raise InvalidValueError(f"{what} takes one to three whole numbers, not {numbers!r}")
    return (*map(int, given), *(missing,) * (3 - len(given)))
