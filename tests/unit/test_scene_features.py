"""The table of scene features: every test that it names exists, every row names one, every benchmark can be run."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "scene_features.md").read_text()
ROWS = [line for line in PAGE.splitlines() if line.startswith("| ") and not line.startswith("| OptiX |")]


def names_of_tests() -> set[str]:
    """Names of all test functions."""
    files = (ROOT / "tests").rglob("test_*.py")
    trees = (ast.parse(path.read_text()) for path in files if "golden" not in path.parts and "errors" not in path.parts)
    return {node.name for tree in trees for node in tree.body if isinstance(node, ast.FunctionDef) and node.name.startswith("test_")}


def test_every_test_exists() -> None:
    known = names_of_tests()
    assert [name for name in re.findall(r"`(test_\w+)`", PAGE) if name not in known] == []


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.split("|")[1].strip())
def test_every_row_is_complete(row: str) -> None:
    cells = [cell.strip() for cell in row.strip("|").split("|")]
    assert len(cells) == 4 and all(cells)
    assert re.search(r"`test_\w+`", cells[2])


def test_every_benchmark_exists() -> None:
    for module in re.findall(r"`python -m (benchmarks[\w.]*)", PAGE):
        path = ROOT / module.replace(".", "/")
        assert path.with_suffix(".py").is_file() or (path / "__main__.py").is_file(), module
