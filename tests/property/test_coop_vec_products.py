"""Products of matrices with cooperative vectors of every type, layout and size: right within their roundings, and equal to the bit in
scalar code, in packets of 8 and 16, in checked builds and in the interpreter."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from coop_vec_products import ROWS, Memory, Params, Product, every_type, products
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import optixc as ox

INTERPRETED = (0, 3, 16)


@pytest.fixture(scope="module")
def context(tmp_path_factory: pytest.TempPathFactory) -> Any:
    return ox.DeviceContext(cache_dir=tmp_path_factory.mktemp("cache"), threads=1)


def results(context: Any, memory: Memory, path: Path) -> dict[str, np.ndarray[Any, Any]]:
    """What each way to run writes; the interpreter runs some launch indices only."""
    path.write_text(memory.text())
    module = context.module_create(path, include_dirs=[Path(__file__).parent])
    raygen = context.program_group_create(raygen=module["__raygen__products"])
    table = ox.ShaderBindingTable(raygen=raygen.record())
    found = {}
    for name, lanes, debug in (("scalar", 1, False), ("8 lanes", 8, False), ("16 lanes", 16, False), ("16 checked lanes", 16, True)):
        pipeline = context.pipeline_create([raygen], simd=lanes, debug=debug)
        found[name] = np.full((ROWS, memory.columns), -1.0)
        pipeline.launch(Params(out=found[name], **memory.arrays), table, width=ROWS)
    found["interpreter"] = found["scalar"].copy()
    for row in INTERPRETED:
        found["interpreter"][row] = -1.0
        ox.interpret(pipeline, Params(out=found["interpreter"], **memory.arrays), table, (ROWS, 1, 1), (row, 0, 0))
    return found


def compare(context: Any, wanted: list[Product], seed: int, folder: Path) -> None:
    memory = Memory(context, wanted, seed)
    found = results(context, memory, folder / "products.py")
    memory.check(found["scalar"])
    for name, out in found.items():
        assert np.array_equal(out, found["scalar"], equal_nan=True), name


def test_every_type_with_every_layout(context: Any, tmp_path: Path) -> None:
    """X40: each row of the table of supported types, and float32."""
    wanted = every_type()
    for start in range(0, len(wanted), 16):
        compare(context, wanted[start : start + 16], start, tmp_path)


@settings(max_examples=4, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture])
@given(wanted=st.lists(products(), min_size=3, max_size=6), seed=st.integers(0, 1000))
def test_random_products(context: Any, tmp_path: Path, wanted: list[Product], seed: int) -> None:
    compare(context, wanted, seed, tmp_path)
