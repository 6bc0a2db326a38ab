"""Fixtures of the conformance tests: the mode that a test runs in and the harness of that mode."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from harness import MODES, Harness

import optixc as ox


@pytest.fixture(scope="session", params=list(MODES))
def mode(request: pytest.FixtureRequest) -> str:
    """The name of a way to run programs."""
    return str(request.param)


@pytest.fixture(scope="session")
def harness(mode: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Harness]:
    """The context and the shared pipelines of the mode; skips where the API cannot do it."""
    harness = Harness(mode, ox.DeviceContext())
    if not harness.available(tmp_path_factory.mktemp("mode")):
        pytest.skip(f"mode {mode} is not available here")
    yield harness
