"""Random typed programs: scalar code, packets of 8 and 16 lanes and, where there is one, the interpreter write the same bits.

Hypothesis draws what decides a program (a seed, a size, which features it may use) and many programs share one pipeline, so that the
C++ compiler is not the clock. Without --fuzz the same 200 programs run every time; with it, 20,000 others (--programs changes that).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from modules import FEATURES, Recipe, module_text, program_text
from ways_to_run import Ways, difference, interpret, params_class

import optixc as ox

BATCH = 20
LANES_EVERY = 10
"""In a long run, one batch of so many also runs in packets, which take the C++ compiler ten times as long."""

RECIPES = st.builds(
    Recipe,
    seed=st.integers(0, 2**48),
    size=st.integers(4, 12),
    features=st.one_of(st.just(frozenset(FEATURES)), st.frozensets(st.sampled_from(FEATURES))),
)


def is_lanes_turn(count: int, long_run: bool) -> str | None:
    """The packets that batch number `count` runs in besides scalar code."""
    if long_run and count % LANES_EVERY:
        return None
    return "lanes8" if (count // LANES_EVERY if long_run else count) % 2 else "lanes16"


class Comparison:
    """Compares the batches of one run and counts."""

    def __init__(self, ways: Ways, long_run: bool) -> None:
        self.ways = ways
        self.long_run = long_run
        self.batches = 0
        self.params = params_class()
        self.interprets = hasattr(ox, "interpret")

    def compare(self, recipes: list[Recipe]) -> None:
        """All programs of one pipeline in each way; fails with the text of the first program that differs."""
        names = [f"__raygen__p{number}" for number in range(len(recipes))]
        path = self.ways.write(module_text(recipes))
        pipeline, tables = self.ways.compile(path, names, 1)
        scalar = {name: self.ways.run(pipeline, tables[name], self.params) for name in names}
        packets = is_lanes_turn(self.batches, self.long_run)
        self.batches += 1
        if packets is not None:
            wide, wide_tables = self.ways.compile(path, names, self.ways.lanes[packets])
            self._same(recipes, scalar, {name: self.ways.run(wide, wide_tables[name], self.params) for name in names}, packets)
        if self.interprets:
            results = {name: self.ways.run(pipeline, tables[name], self.params, interpret) for name in names}
            self._same(recipes, scalar, results, "interpreted")
        path.unlink()

    def _same(self, recipes: list[Recipe], scalar: dict[str, Any], other: dict[str, Any], way: str) -> None:
        for number, (recipe, name) in enumerate(zip(recipes, scalar, strict=True)):
            found = difference(scalar[name], other[name])
            assert not found, f"scalar and {way} differ, {found}\n{recipe}\n{program_text(recipe, f'p{number}')}"


def test_programs_agree(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every way gives the same bits."""
    long_run = bool(request.config.getoption("--fuzz"))
    programs = int(request.config.getoption("--programs")) if long_run else 200
    comparison = Comparison(Ways(tmp_path, monkeypatch, optimization=1 if long_run else 0), long_run)

    @settings(
        max_examples=max(1, programs // BATCH),
        deadline=None,
        database=None,
        derandomize=not long_run,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(st.lists(RECIPES, min_size=BATCH, max_size=BATCH))
    def batches(recipes: list[Recipe]) -> None:
        comparison.compare(recipes)

    batches()
    assert comparison.batches * BATCH >= programs
