"""Options of the test run."""

from __future__ import annotations

import os

import pytest
from hypothesis import Phase, settings

# Explaining a failure runs the test under a tracer, for many minutes where each example renders. In CI the examples are the same ones
# each time, so that a red run means a change; people and `make fuzz` look for new ones.
settings.register_profile(
    "optixc", phases=[phase for phase in Phase if phase is not Phase.explain], derandomize="CI" in os.environ
)
settings.load_profile("optixc")


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--update-golden", action="store_true", help="write the golden files anew from what the compiler makes now")
    parser.addoption("--fuzz", action="store_true", help="the long run of the program generator instead of the short one")
    parser.addoption("--programs", type=int, default=20_000, help="how many programs the long run makes")
    parser.addoption("--graphs", type=int, default=300, help="how many call graphs the long run makes")
