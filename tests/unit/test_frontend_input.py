"""Files that no editor would save: every one gives a diagnostic or compiles, none a traceback."""

from __future__ import annotations

from pathlib import Path

import pytest

from optixc.diagnostics import CompileError
from optixc.frontend.compile import FrontendResult, compile_file, compile_text

HEAD = "import optixc as ox\n@ox.program\ndef __raygen__a():\n"


def errors_of(text: str) -> list[str]:
    with pytest.raises(CompileError) as caught:
        compile_text(text, "shader.py")
    return [diagnostic.code for diagnostic in caught.value.diagnostics]


def compiled(body: str) -> FrontendResult:
    return compile_text(HEAD + body, "shader.py")


@pytest.mark.parametrize(
    "body",
    [
        "    x = 1.0\n    y = " + " + ".join(["x"] * 5_000) + "\n",
        "    x = 1.0\n    y = " + " + ".join(["x"] * 100_000) + "\n",
        "    y = " + "(" * 300 + "1" + ")" * 300 + "\n",
        "    y = " + "-" * 5_000 + "1\n",
        "    y = " + "not " * 5_000 + "True\n",
        "    y = " + "2 ** " * 3_000 + "1\n",
        "    x = True\n    y = " + " and ".join(["x"] * 5_000) + "\n",
        "    x = 1\n    y = " + " < ".join(["x"] * 5_000) + "\n",
        "    x = 1\n    if x == 0:\n        y = 1\n" + "".join(f"    elif x == {i}:\n        y = 1\n" for i in range(1, 400)),
        "    x = 1\n    match x:\n" + "".join(f"        case {i}:\n            y = 1\n" for i in range(400)),
        "".join("    " + " " * i + "if True:\n" for i in range(99)) + "    " + " " * 99 + "x = " + "-" * 100 + "1\n",
    ],
    ids=["sum", "long sum", "parentheses", "minus", "not", "power", "and", "compare", "elif", "match", "if and minus"],
)
def test_deep_nesting_is_a_diagnostic(body: str) -> None:
    assert set(errors_of(HEAD + body)) <= {"OX103", "OX101"}


def test_a_long_sum_is_told_where_it_stands() -> None:
    with pytest.raises(CompileError) as caught:
        compile_text(HEAD + "    x = 1.0\n    y = " + " + ".join(["x"] * 5_000) + "\n", "shader.py")
    assert [diagnostic.span.line for diagnostic in caught.value.diagnostics] == [HEAD.count("\n") + 2]


def test_nesting_below_the_limit_compiles() -> None:
    compiled("    x = 1.0\n    y = " + " + ".join(["x"] * 150) + "\n")
    compiled("    y = " + "(" * 150 + "1" + ")" * 150 + "\n")


def test_helpers_that_call_each_other_too_deep() -> None:
    chain = "".join(f"def h{i}(x):\n    return h{i + 1}(x)\n" for i in range(1_000)) + "def h1000(x):\n    return x\n"
    assert "OX103" in errors_of("import optixc as ox\n" + chain + "@ox.program\ndef __raygen__a():\n    y = h0(1)\n")


def test_helpers_with_two_signatures_each_do_not_explode() -> None:
    chain = (
        "".join(f"def h{i}(x, y):\n    return h{i + 1}(x, 1.0) + h{i + 1}(1, y)\n" for i in range(30))
        + "def h30(x, y):\n    return x + y\n"
    )
    result = compile_text("import optixc as ox\n" + chain + "@ox.program\ndef __raygen__a():\n    y = h0(1, 2)\n", "shader.py")
    assert len(result.module.helpers) < 150


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("def f(:\n", "OX101"),
        (HEAD + "    x = 1\n\ty = 2\n", "OX101"),
        (HEAD + "    x = 1\0\n", "OX101"),
        (HEAD + "    x = " + "9" * 5_000 + "\n", "OX313"),
        ("", "OX209"),
        (HEAD + "    return 1\n", "OX316"),
        (HEAD + "    break\n", "OX401"),
        (HEAD + "    continue\n", "OX401"),
        ("import optixc as ox\ndef helper():\n    return 1\n", "OX209"),
    ],
)
def test_bad_text(text: str, code: str) -> None:
    assert errors_of(text) == [code]


def test_bom_and_encodings(tmp_path: Path) -> None:
    shader = tmp_path / "shader.py"
    shader.write_bytes(b"\xef\xbb\xbf" + (HEAD + "    x = 1\n").encode())
    assert compile_file(shader).module.programs[0].name == "__raygen__a"
    shader.write_bytes(b"# -*- coding: latin-1 -*-\n# \xe4\n" + (HEAD + "    x = 1\n").encode())
    assert compile_file(shader).module.programs[0].name == "__raygen__a"
    shader.write_bytes(b"# \xff\xfe\n")
    with pytest.raises(CompileError, match=r"OX101.*decoded"):
        compile_file(shader)


def test_missing_file_and_folder(tmp_path: Path) -> None:
    for path in (tmp_path / "missing.py", tmp_path):
        with pytest.raises(CompileError, match="OX102"):
            compile_file(path)


def test_too_many_lines(tmp_path: Path) -> None:
    shader = tmp_path / "shader.py"
    shader.write_text("#\n" * 300_000)
    with pytest.raises(CompileError, match="OX105"):
        compile_file(shader)


def test_windows_line_ends(tmp_path: Path) -> None:
    shader = tmp_path / "shader.py"
    shader.write_bytes((HEAD + "    x = unknown\n").replace("\n", "\r\n").encode())
    with pytest.raises(CompileError) as caught:
        compile_file(shader)
    assert caught.value.diagnostics[0].source == "    x = unknown"


def test_names_of_cpp_and_unicode_are_fine() -> None:
    names = ["template", "namespace", "__x", "größe", "double", "auto", "this", "int32", "float"]
    result = compiled("".join(f"    {name} = {i}\n" for i, name in enumerate(names)))
    assert {local.name for local in result.module.programs[0].locals} == set(names)


def test_columns_count_characters() -> None:
    with pytest.raises(CompileError) as caught:
        compiled("    größe = unbekannt\n")
    assert caught.value.diagnostics[0].span.column == 12


def test_nothing_is_executed(tmp_path: Path) -> None:
    shader = tmp_path / "shader.py"
    marker = tmp_path / "executed"
    shader.write_text(f"open({str(marker)!r}, 'w')\nimport sys\nsys.exit(3)\n" + HEAD + "    x = 1\n")
    compile_file(shader)
    assert not marker.exists()


def test_files_that_import_each_other(tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text("import b\n" + HEAD + "    x = b.twice(2.0)\ndef once(x):\n    return x\n")
    (tmp_path / "b.py").write_text("import a\ndef twice(x):\n    return a.once(x) + a.once(x)\n")
    result = compile_file(tmp_path / "a.py")
    assert [helper.name for helper in result.module.helpers] == ["once", "twice"]
    assert result.dependencies == (str(tmp_path / "b.py"),)


def test_include_folders_come_after_the_shader_folder(tmp_path: Path) -> None:
    (tmp_path / "include").mkdir()
    (tmp_path / "include" / "lib.py").write_text("def value():\n    return 1\n")
    (tmp_path / "shader.py").write_text("from lib import value\n" + HEAD + "    x = value()\n")
    assert compile_file(tmp_path / "shader.py", [tmp_path / "include"]).dependencies == (str(tmp_path / "include" / "lib.py"),)
    (tmp_path / "lib.py").write_text("def value():\n    return 2\n")
    assert compile_file(tmp_path / "shader.py", [tmp_path / "include"]).dependencies == (str(tmp_path / "lib.py"),)


def test_relative_imports(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """From the package itself, from outside of the current folder, and beside the file that a link leads to."""
    (tmp_path / "pack" / "inner").mkdir(parents=True)
    (tmp_path / "pack" / "__init__.py").write_text("def value():\n    return 1\n")
    (tmp_path / "pack" / "inner" / "lib.py").write_text("from ...pack import value\ndef twice():\n    return 2 * value()\n")
    shader = tmp_path / "pack" / "inner" / "shader.py"
    shader.write_text("from . import lib\nfrom .. import value\n" + HEAD + "    x = value() + lib.twice()\n")
    files = [str(tmp_path / "pack" / one) for one in ("__init__.py", "inner/lib.py")]
    (tmp_path / "link.py").symlink_to(shader)
    for folder, path in ((shader.parent, "shader.py"), (tmp_path / "pack", "inner/shader.py"), (tmp_path, str(shader))):
        monkeypatch.chdir(folder)
        assert sorted(compile_file(path).dependencies) == files
    monkeypatch.chdir(tmp_path)
    assert str(tmp_path / "pack" / "inner" / "lib.py") in compile_file("link.py").dependencies


def test_all_errors_in_one_run() -> None:
    assert errors_of(HEAD + "    a = one\n    b = two\n    c = a + b\n    d = three\n") == ["OX301", "OX301", "OX301"]


def test_printed_form() -> None:
    with pytest.raises(CompileError) as caught:
        compile_text("import optixc as ox\n@ox.program\ndef __closesthit__surface():\n    ox.ignore_intersection()\n", "shader.py")
    assert str(caught.value) == (
        "shader.py:4:5: error[OX304]: ignore_intersection() is only allowed in an anyhit program\n"
        "    4 |     ox.ignore_intersection()\n"
        "      |     ^^^^^^^^^^^^^^^^^^^^^^^^ this is closesthit program `__closesthit__surface`"
    )


def test_long_lines_are_clipped() -> None:
    with pytest.raises(CompileError) as caught:
        compiled("    y = 1.0 + " + "1.0 + " * 60 + "unknown\n")
    lines = str(caught.value).splitlines()
    assert max(len(line) for line in lines) < 250
    assert lines[1][lines[2].index("^") :].startswith("unknown")
