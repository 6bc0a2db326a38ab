"""The page for OptiX users: up to date, and every name in it exists."""

from __future__ import annotations

import importlib
import inspect
import re
import sys
from pathlib import Path
from typing import Any

import pytest

import optixc as ox
from optixc.host.groups import Module
from optixc.host.tasks import Task

sys.path.insert(0, str(Path(__file__).parents[2] / "docs"))
maker = importlib.import_module("make_coming_from_optix")
optix_structs = importlib.import_module("optix_structs")
sys.path.pop(0)


def look_up(name: str) -> Any:
    found: Any = {"Module": Module, "Task": Task}.get(name.split(".")[0], ox)
    for part in name.split(".") if found is ox else name.split(".")[1:]:
        found = getattr(found, part)
    return found


def test_the_page_is_up_to_date() -> None:
    assert maker.PAGE.read_text() == maker.page(), "run python docs/make_coming_from_optix.py"


@pytest.mark.parametrize("row", [row for row in maker.HOST if row[1]], ids=lambda row: row[1])
def test_host_names_exist(row: tuple[str, str, str, str]) -> None:
    look_up(row[1])


@pytest.mark.parametrize("row", [row for row in optix_structs.STRUCTS if row[1]], ids=lambda row: row[0].split(",")[0])
def test_struct_fields_have_their_places(row: tuple[str, str, str]) -> None:
    """Names right behind "is" are arguments or attributes of what stands for the struct."""
    _, here, remark = row
    found = look_up(here)
    known = {*inspect.signature(found).parameters, *dir(found)} if callable(found) else set(dir(found))
    assert [argument for argument in re.findall(r"\bis `(\w+)`", remark) if argument not in known] == []


def test_names_of_enumerations_exist() -> None:
    for name in re.findall(r"`ox\.([\w.]+)`", optix_structs.ENUMS):
        look_up(name)


def test_every_device_name_is_importable() -> None:
    names = {row.overload_of or row.name for row in maker.ROWS if row.optix}
    assert [name for name in sorted(names) if not hasattr(ox, name)] == []
