"""Finding compilers without starting them twice, and clear errors where there is none."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from optixc import toolchain
from optixc.enums import Result
from optixc.installation import include_folder


@pytest.fixture(autouse=True)
def forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(toolchain, "_versions", {})
    monkeypatch.delenv("OPTIXC_CXX", raising=False)


def compiler(folder: Path, name: str, version_text: str) -> Path:
    """A fake compiler that counts its starts in NAME.starts."""
    path = folder / name
    path.write_text(f"#!/bin/sh\necho start >> {path}.starts\n/bin/cat <<'EOF'\n{version_text}\nEOF\n")
    path.chmod(0o755)
    return path


CLANG_17 = "clang version 17.0.6\nTarget: x86_64"
CLANG_14 = "Debian clang version 14.0.6\nTarget: x86_64"
GCC_13 = "g++ (Debian 13.2.0-1) 13.2.0\nCopyright (C) 2023 Free Software Foundation, Inc."
GCC_11 = "g++ (Ubuntu 11.4.0) 11.4.0\nCopyright (C) 2021 Free Software Foundation, Inc."


def test_clang_is_preferred_and_old_compilers_are_passed_over(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    compiler(tmp_path, "g++", GCC_13)
    compiler(tmp_path, "clang++", CLANG_14)
    assert (toolchain.find_compiler().kind, toolchain.find_compiler().version) == ("gcc", (13, 2, 0))
    compiler(tmp_path, "clang++-17", CLANG_17)
    found = toolchain.find_compiler()
    assert (found.kind, found.version) == ("clang", (17, 0, 6))


def test_a_known_compiler_is_not_started(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    path = compiler(tmp_path, "clang++", CLANG_17)
    memory = tmp_path / "memory"
    first = toolchain.find_compiler(memory)
    monkeypatch.setattr(toolchain, "_versions", {})
    assert toolchain.find_compiler(memory) == first
    assert path.with_name("clang++.starts").read_text().count("start") == 1


def test_another_file_under_the_name_is_another_compiler(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    compiler(tmp_path, "clang++", CLANG_17)
    first = toolchain.find_compiler(tmp_path)
    compiler(tmp_path, "clang++", CLANG_17.replace("17.0.6", "18.1.80"))
    second = toolchain.find_compiler(tmp_path)
    assert second.version == (18, 1, 80)
    assert second.identity != first.identity


def test_no_compiler_is_one_clear_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    compiler(tmp_path, "g++", GCC_11)
    with pytest.raises(toolchain.ToolchainError, match=r"install g\+\+ 12 or newer") as caught:
        toolchain.find_compiler()
    assert caught.value.code == Result.ERROR_INTERNAL_COMPILER_ERROR


@pytest.mark.parametrize(("name", "message"), [("nothing-there", "not an executable"), ("old", r"not clang\+\+ 16")])
def test_a_wrong_optixc_cxx_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, message: str) -> None:
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    compiler(tmp_path, "old", GCC_11)
    monkeypatch.setenv("OPTIXC_CXX", name)
    with pytest.raises(toolchain.ToolchainError, match=message):
        toolchain.find_compiler()


def test_a_failing_compile_shows_the_compilers_words(tmp_path: Path) -> None:
    plan = toolchain.Build(include=tmp_path)
    with pytest.raises(toolchain.ToolchainError, match="nonsense"):
        toolchain.compile_shared("nonsense;", tmp_path / "x.so", toolchain.find_compiler(), plan)
    assert not (tmp_path / "x.so").exists()
    assert not list(tmp_path.glob("optixc-*"))


def test_assembly_and_shared_object(tmp_path: Path) -> None:
    plan = toolchain.Build(include=tmp_path, target="x86-64-v3")
    found = toolchain.find_compiler()
    text = 'extern "C" __attribute__((visibility("default"))) int answer() { return 42; }'
    assert "answer" in toolchain.compile_assembly(text, found, plan)
    toolchain.compile_shared(text, tmp_path / "answer.so", found, plan)
    assert (tmp_path / "answer.so").read_bytes()[:4] == b"\x7fELF"


def test_flags_tell_builds_apart(tmp_path: Path) -> None:
    builds = [
        toolchain.Build(tmp_path),
        toolchain.Build(tmp_path, optimization=0),
        toolchain.Build(tmp_path, target="x86-64-v3"),
        toolchain.Build(tmp_path, fast_math=True),
        toolchain.Build(tmp_path, debug=True),
    ]
    assert len({build.flags() for build in builds}) == len(builds)
    assert "-ffp-contract=off" in builds[0].flags()


def test_lanes_of_targets() -> None:
    assert toolchain.processor_lanes("x86-64-v3") == 8
    assert toolchain.processor_lanes("x86-64-v4") == 16
    assert toolchain.processor_lanes() in (1, 8, 16)


SUM = """#include <oxrt/device.h>
extern "C" __attribute__((visibility("default"))) float sum(const oxrt::float3* v) { return oxrt::dot(*v, oxrt::float3(1.0f, 1.0f, 1.0f)); }
"""


def test_headers_are_parsed_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    found = next((one for one in toolchain.installed_compilers() if one.kind == "clang"), None)
    if found is None:
        pytest.skip("clang++ is not installed")
    plan, memory = toolchain.Build(include=include_folder()), tmp_path / "memory"
    runs: list[list[str]] = []
    real = toolchain._run
    monkeypatch.setattr(toolchain, "_run", lambda compiler, arguments: (runs.append(arguments), real(compiler, arguments)))
    for name in ("a", "b"):
        toolchain.compile_shared(SUM, tmp_path / f"{name}.so", found, plan, memory)
        for header in (memory / "headers").glob("*.h"):
            header.write_text(header.read_text())
            os.utime(header, (1e9, 1e9))
    assert ["c++-header" in run for run in runs] == [True, False, False]
    assert ["-include-pch" in run for run in runs] == [False, True, True]

    # A damaged one is made anew
    made = next((memory / "headers").glob("*.pch"))
    made.write_bytes(b"nonsense")
    toolchain.compile_shared(SUM, tmp_path / "c.so", found, plan, memory)
    assert (tmp_path / "c.so").is_file()
    assert made.stat().st_size > 1000
    toolchain.compile_shared(SUM, tmp_path / "d.so", found, toolchain.Build(include=include_folder(), optimization=1), memory)
    assert len(list((memory / "headers").glob("*.pch"))) == 2

    # A folder that cannot be written does without
    (tmp_path / "file").write_text("")
    toolchain.compile_shared(SUM, tmp_path / "e.so", found, plan, tmp_path / "file")
    assert (tmp_path / "e.so").is_file()


def test_a_compiler_that_is_killed_is_told_apart(tmp_path: Path) -> None:
    path = tmp_path / "g++"
    path.write_text("#!/bin/sh\nkill -9 $$\n")
    path.chmod(0o755)
    killed = toolchain.Compiler(str(path), str(path), 1, 1, "gcc", (12, 2, 0))
    with pytest.raises(toolchain.ToolchainError, match="was ended by signal 9; if memory ran out"):
        toolchain.compile_shared("int x;", tmp_path / "x.so", killed, toolchain.Build(include=tmp_path))


def test_a_wrong_folder_for_temporary_files_does_not_matter(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TMPDIR", "/nowhere")
    toolchain.compile_shared("int x;", tmp_path / "x.so", toolchain.find_compiler(), toolchain.Build(include=tmp_path))
