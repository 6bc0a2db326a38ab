"""Area A: names of results, threads, repeatability, launches in steps."""

from __future__ import annotations

import threading
from typing import Any

import numpy as np
import pytest
from shaders import host_checks as shader

import optixc as ox
from optixc.host import library

UNKNOWN = "Unrecognized OptixResult code"
RAYS = 256


def test_T002_failing_calls_carry_a_code() -> None:
    with pytest.raises(ox.OptixError) as caught:
        ox.DeviceContext(threads=-1)
    assert caught.value.code == 7001
    assert (ox.get_error_name(caught.value.code), ox.get_error_string(7001)) == ("OPTIX_ERROR_INVALID_VALUE", "Invalid value")
    assert (ox.get_error_name(0), ox.get_error_string(0)) == ("OPTIX_SUCCESS", "Success")
    assert (ox.get_error_name(12345), ox.get_error_string(12345)) == (UNKNOWN, UNKNOWN)
    assert all(ox.get_error_name(code) == f"OPTIX_{code.name}" and ox.get_error_string(code) != UNKNOWN for code in ox.Result)


def test_T002_results_of_the_c_interface() -> None:
    ffi, lib = library.ffi(), library.lib()

    def said(code: int) -> tuple[str, str]:
        return ffi.string(lib.oxrtGetErrorName(code)).decode(), ffi.string(lib.oxrtGetErrorString(code)).decode()

    assert said(0) == ("OXRT_SUCCESS", "Success")
    assert said(7001) == ("OXRT_ERROR_INVALID_VALUE", "Invalid value")
    assert said(12345) == (UNKNOWN.replace("Optix", "Oxrt"),) * 2
    assert lib.oxrtContextCreate(ffi.NULL, ffi.NULL) == 7001


def test_functions_are_looked_up_when_the_library_is_opened() -> None:
    # A destructor may run while cffi reads a declaration under its lock; looking up a function takes that lock too.
    functions = {name for name in dir(library.lib()) if name.startswith("oxrt")}
    assert "oxrtAccelDestroy" in functions
    assert functions <= vars(library.lib()).keys()


def mesh(seed: int) -> np.ndarray:
    """Triangles around a square grid of corners, each a little off."""
    random = np.random.default_rng(seed)
    corners = random.uniform(-1.0, 1.0, (200, 1, 3)) + random.uniform(-0.4, 0.4, (200, 3, 3))
    return corners.reshape(-1, 3).astype(np.float32)


def rendered(context: ox.DeviceContext, seed: int) -> list[float]:
    """A pipeline of its own over a mesh of its own; what the rays see."""
    module, create = context.module_create(shader), context.program_group_create
    raygen = create(raygen=module["__raygen__rays"])
    hit, miss = create(closesthit=module["__closesthit__paint"]), create(miss=module["__miss__nothing"])
    pipeline = context.pipeline_create([raygen, hit, miss])
    records = [hit.record(shader.Paint(float(number))) for number in range(200)]
    table = ox.ShaderBindingTable(raygen=raygen.record(), miss=[miss.record()], hitgroup=records)
    gas = context.accel_build([ox.BuildInputTriangles(mesh(seed), num_sbt_records=200, sbt_index_offsets=np.arange(200, dtype=np.uint32))])
    moves = np.random.default_rng(seed + 1).uniform(-0.5, 0.5, (RAYS, 3))
    seen = []
    for move in moves[:16]:
        transform = np.concatenate([np.eye(3), move[:, None]], axis=1).astype(np.float32)
        top = context.accel_build([ox.BuildInputInstances([ox.Instance(gas, transform)])])
        hits = np.zeros(4, np.float32)
        pipeline.launch(shader.Params(hits, top, 1.0), table, 4)
        seen += hits.tolist()
    return seen


def test_T005_threads_share_a_context() -> None:
    context = ox.DeviceContext()
    serial = {seed: rendered(context, seed) for seed in range(4)}
    assert len({tuple(seen) for seen in serial.values()}) == 4
    found: list[tuple[int, list[float]]] = []
    threads = [threading.Thread(target=lambda seed=number % 4: found.append((seed, rendered(context, seed)))) for number in range(32)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 32
    assert all(seen == serial[seed] for seed, seen in found)


def test_T006_the_same_input_gives_the_same_bits() -> None:
    first, again = (ox.DeviceContext() for _ in range(2))
    assert rendered(first, 7) == rendered(first, 7) == rendered(again, 7)


def launch_in_steps(context: ox.DeviceContext, raygen: str, scale: float) -> tuple[Any, Any]:
    module = context.module_create(shader)
    group = context.program_group_create(raygen=module[f"__raygen__{raygen}"])
    pipeline = context.pipeline_create([group])
    params = shader.Params(np.zeros(1, np.float32), 0, scale)
    handle, data, size, table = pipeline.launch_inputs(params, ox.ShaderBindingTable(raygen=group.record()))
    assert library.lib().oxrtLaunchBegin(handle, data, size, table, 1, 1, 1) == 0
    return handle, (pipeline, params, table)


def test_T007_a_launch_begins_before_it_is_done() -> None:
    context, done = ox.DeviceContext(threads=2), library.ffi().new("int*")
    handle, _kept = launch_in_steps(context, "endless", 1.0)
    # The program never ends, so that a begin that waited for it would not have come back.
    assert library.lib().oxrtLaunchWait(handle, 1, done) == 0
    assert done[0] == 0
    assert library.lib().oxrtLaunchCancel(handle) == 0
    while not done[0]:
        result = library.lib().oxrtLaunchWait(handle, 50, done)
    assert result == ox.LaunchCancelledError.code


def test_T007_launches_keep_their_order() -> None:
    # Python launches return when the work is done, so what one wrote is what the next one reads.
    context = ox.DeviceContext(threads=2)
    seen = np.zeros(1, np.float32)
    module, create = context.module_create(shader), context.program_group_create
    raygen, miss = create(raygen=module["__raygen__rays"]), create(miss=module["__miss__nothing"])
    pipeline = context.pipeline_create([raygen, miss])
    table = ox.ShaderBindingTable(raygen=raygen.record(), miss=[miss.record()])
    for number in range(1, 50):
        pipeline.launch(shader.Params(seen, 0, float(number)), table, 1)
        assert seen[0] == -float(number)
