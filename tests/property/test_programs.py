"""Random typed programs: scalar code, packets of 8 and 16 lanes and, where there is one, the interpreter write the same bits.

Hypothesis draws what decides a program (a seed, a size, which features it may use) and many programs share one pipeline, so that the
C++ compiler is not the clock. Without --fuzz the same 200 programs run every time, each in one width of packets; with it, 20,000 others
(--programs changes that) in both.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from modules import FEATURES, Recipe, module_text, program_text
from ways_to_run import Ways, difference, interpret, params_class

BATCH = 20
LONG_BATCH = 50
OPTIMIZED_EVERY = 40
"""In a long run all batches are compiled without optimisation, which is what tests our own part: no flag of ours lets an optimiser change
a result. One batch of so many is compiled as users' pipelines are, so that this is tested as well."""

RECIPES = st.builds(
    Recipe,
    seed=st.integers(0, 2**48),
    size=st.integers(4, 12),
    features=st.one_of(st.just(frozenset(FEATURES)), st.frozensets(st.sampled_from(FEATURES))),
)


class Comparison:
    """Compares the batches of one run and counts the different programs."""

    def __init__(self, ways: Ways, long_run: bool, wanted: int) -> None:
        self.ways = ways
        self.long_run = long_run
        self.wanted = wanted
        self.batches = 0
        self.seen: set[Recipe] = set()
        self.params = params_class()

    def compare(self, recipes: list[Recipe]) -> None:
        """All programs of one pipeline in each way; fails with the text of the first program that differs."""
        recipes = [recipe for recipe in recipes if recipe not in self.seen]
        if len(self.seen) >= self.wanted or not recipes:
            return
        self.batches += 1
        self.ways.optimization = 3 if self.long_run and self.batches % OPTIMIZED_EVERY == 0 else 0
        names = [f"__raygen__p{number}" for number in range(len(recipes))]
        path = self.ways.write(module_text(recipes))
        scalar, tables, groups = self.ways.compile(path, names)
        results = {name: self.ways.run(scalar, tables[name], self.params) for name in names}
        for packets in self._packets():
            wide = self.ways.pipeline(groups, self.ways.lanes[packets])
            self._same(recipes, results, {name: self.ways.run(wide, tables[name], self.params) for name in names}, packets)
        interpreted = {name: self.ways.run(scalar, tables[name], self.params, interpret) for name in names}
        self._same(recipes, results, interpreted, "interpreted")
        path.unlink()
        self.seen.update(recipes)

    def _packets(self) -> list[str]:
        """In a short run the batches take turns with the widths."""
        widths = list(self.ways.lanes)
        return widths if self.long_run else [widths[self.batches % len(widths)]]

    def _same(self, recipes: list[Recipe], scalar: dict[str, Any], other: dict[str, Any], way: str) -> None:
        for number, (recipe, name) in enumerate(zip(recipes, scalar, strict=True)):
            found = difference(scalar[name], other[name])
            assert not found, f"scalar and {way} differ, {found}\n{recipe}\n{program_text(recipe, f'p{number}')}"


def test_programs_agree(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every way gives the same bits."""
    long_run = bool(request.config.getoption("--fuzz"))
    programs = int(request.config.getoption("--programs")) if long_run else 200
    batch = LONG_BATCH if long_run else BATCH
    comparison = Comparison(Ways(tmp_path, monkeypatch), long_run, programs)

    # More batches than needed: Hypothesis may draw the same program again, and each counts once.
    @settings(
        max_examples=2 * (programs // batch + 1),
        deadline=None,
        database=None,
        derandomize=not long_run,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(st.lists(RECIPES, min_size=batch, max_size=batch, unique=True))
    def batches(recipes: list[Recipe]) -> None:
        comparison.compare(recipes)

    batches()
    print(f"{len(comparison.seen)} programs in {comparison.batches} pipelines")
    assert len(comparison.seen) >= programs
