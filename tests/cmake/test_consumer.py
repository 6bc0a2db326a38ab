"""A CMake project that uses the installed package: find_package, a shader as a build step, a program without Python."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from optixc import installation

SOURCE = Path(__file__).parent / "consumer"


def run(*command: object, cwd: Path | None = None) -> str:
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False, timeout=300, cwd=cwd)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def tool(name: str) -> str:
    """CMake or ninja of this environment, else of PATH."""
    beside = Path(sys.executable).with_name(name)
    found = str(beside) if beside.is_file() else shutil.which(name)
    if found is None:
        pytest.skip(f"{name} is not installed")
    return found


@pytest.mark.parametrize("generator", ["Ninja", "Unix Makefiles"])
def test_a_shader_is_a_build_step(tmp_path: Path, generator: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OPTIXC_CACHE_DIR", str(tmp_path / "cache"))
    source, build = tmp_path / "source", tmp_path / "build"
    shutil.copytree(SOURCE, source)
    make = tool("ninja" if generator == "Ninja" else "make")
    run(
        tool("cmake"),
        "-S",
        source,
        "-B",
        build,
        "-G",
        generator,
        f"-DCMAKE_MAKE_PROGRAM={make}",
        f"-Doptixc_DIR={installation.cmake_folder()}",
    )
    assert "Compiling shader squares.py" in run(tool("cmake"), "--build", build)
    assert run(build / "consumer").split() == ["0", "1", "4", "9", "16"]

    # Nothing changed: nothing is compiled
    assert "Compiling shader" not in run(tool("cmake"), "--build", build)

    # A file that the shader imports changed: the shader is compiled anew
    helper = source / "helpers" / "power.py"
    helper.write_text(helper.read_text().replace("x * x", "x * x * x"))
    assert "Compiling shader squares.py" in run(tool("cmake"), "--build", build)
    assert run(build / "consumer").split() == ["0", "1", "8", "27", "64"]


def test_one_shared_object_for_several_processors(tmp_path: Path) -> None:
    source, build = tmp_path / "source", tmp_path / "build"
    shutil.copytree(SOURCE, source)
    lists = source / "CMakeLists.txt"
    lists.write_text(lists.read_text().replace("SOURCES squares.py", "SOURCES squares.py OPTIONS --target x86-64"))
    run(tool("cmake"), "-S", source, "-B", build, f"-Doptixc_DIR={installation.cmake_folder()}")
    run(tool("cmake"), "--build", build)
    for level in ("x86-64", "x86-64-v3", "x86-64-v4"):
        done = subprocess.run([build / "consumer"], env={**os.environ, "OXRT_MAX_ISA": level}, capture_output=True, text=True, check=True)
        assert done.stdout.split() == ["0", "1", "4", "9", "16"]


def test_an_error_in_the_shader_fails_the_build_with_its_place(tmp_path: Path) -> None:
    source, build = tmp_path / "source", tmp_path / "build"
    shutil.copytree(SOURCE, source)
    shader = source / "squares.py"
    shader.write_text(shader.read_text().replace("power(int(i))", "power(nothing)"))
    run(tool("cmake"), "-S", source, "-B", build, f"-Doptixc_DIR={installation.cmake_folder()}")
    done = subprocess.run([tool("cmake"), "--build", str(build)], capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode != 0
    assert "squares.py:19:30:" in done.stdout + done.stderr
    assert "error[OX301]" in done.stdout + done.stderr
