"""The page for OptiX users: up to date, and every name in it exists."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

import optixc as ox
from optixc.host.groups import Module
from optixc.host.tasks import Task

SCRIPT = Path(__file__).parents[2] / "docs" / "make_coming_from_optix.py"
_spec = importlib.util.spec_from_file_location("make_coming_from_optix", SCRIPT)
assert _spec is not None
assert _spec.loader is not None
maker = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(maker)


def test_the_page_is_up_to_date() -> None:
    assert maker.PAGE.read_text() == maker.page(), "run python docs/make_coming_from_optix.py"


@pytest.mark.parametrize("row", [row for row in maker.HOST if row[1]], ids=lambda row: row[1])
def test_host_names_exist(row: tuple[str, str, str, str]) -> None:
    found: object = {"Module": Module, "Task": Task}.get(row[1].split(".")[0], ox)
    for part in row[1].split(".") if found is ox else row[1].split(".")[1:]:
        found = getattr(found, part)


def test_every_device_name_is_importable() -> None:
    names = {row.overload_of or row.name for row in maker.ROWS if row.optix}
    assert [name for name in sorted(names) if not hasattr(ox, name)] == []
