"""Every file here is a shader with mistakes: each `# E[OXnnn]: text` says which error its line has, and there are no others."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from optixc.diagnostics import CODES, CompileError
from optixc.frontend.compile import compile_file

HERE = Path(__file__).parent
CASES = sorted(path for path in HERE.rglob("*.py") if not path.name.startswith(("test_", "helper_", "__")))
EXPECTATION = re.compile(r"# E\[(OX\d+)\]: (.*?)(?= # E\[|$)")


def expected_errors(path: Path) -> list[tuple[int, str, str]]:
    """Line, code and a part of the text of each error that the file announces."""
    found = []
    for number, line in enumerate(path.read_text(encoding="utf-8-sig").splitlines(), 1):
        found += [(number, code, text.strip()) for code, text in EXPECTATION.findall(line)]
    return found


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_errors(path: Path) -> None:
    expected = expected_errors(path)
    assert expected, "the case announces no error"
    with pytest.raises(CompileError) as caught:
        compile_file(path, include_dirs=[HERE / "include"])
    diagnostics = list(caught.value.diagnostics)
    for number, code, text in expected:
        match = next((d for d in diagnostics if (d.span.line, d.code) == (number, code) and text in f"{d.message} {d.note}"), None)
        assert match is not None, f"line {number}: {code} {text!r} is missing in:\n{caught.value}"
        diagnostics.remove(match)
    assert not diagnostics, "errors that no line announces:\n" + "\n".join(str(d) for d in diagnostics)


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_printed_form(path: Path) -> None:
    """At most 15 lines each, a headline with the place, a caret under the guilty line, no traceback of ours."""
    with pytest.raises(CompileError) as caught:
        compile_file(path, include_dirs=[HERE / "include"])
    for diagnostic in caught.value.diagnostics:
        lines = str(diagnostic).splitlines()
        assert len(lines) <= 15
        assert re.match(rf".*:\d+:\d+: error\[{diagnostic.code}\]: \S", lines[0])
        assert len(lines) == 1 or "^" in lines[2]
        assert "Traceback" not in str(diagnostic)


def test_every_code_has_a_case() -> None:
    covered = {code for path in CASES for _, code, _ in expected_errors(path)}
    elsewhere = {"OX101", "OX102", "OX103", "OX104", "OX105"}  # Files that no editor would save: tests/unit/test_frontend_input.py
    assert covered | elsewhere == set(CODES)
