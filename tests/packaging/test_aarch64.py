"""Other processors: what the scalar emitter writes, and the parts of the runtime that know processors, compile for aarch64."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from optixc import toolchain

ROOT = Path(__file__).resolve().parents[2]
FLAGS = ["-std=c++20", "-O1", "-ffp-contract=off", "-fwrapv", "-fno-exceptions", "-fno-rtti", "-fPIC", "-w"]


def cross_compilers() -> list[list[str]]:
    """Commands that compile for aarch64: clang without a system's headers, and the cross g++ of Debian."""
    clang = next((one.command for one in toolchain.installed_compilers() if one.kind == "clang"), None)
    found = [[clang, "--target=aarch64-linux-gnu", "-ffreestanding"]] if clang is not None else []
    gcc = shutil.which("aarch64-linux-gnu-g++")
    return [*found, *([[gcc]] if gcc is not None else [])]


def compile_quietly(command: list[str], *arguments: object) -> None:
    done = subprocess.run([*command, *map(str, arguments)], capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == 0, done.stderr[:3000]


@pytest.mark.parametrize("case", sorted(path.parent.name for path in (ROOT / "tests" / "golden").glob("*/pipeline.cpp")))
def test_scalar_pipelines(tmp_path: Path, case: str) -> None:
    compilers = cross_compilers()
    if not compilers:
        pytest.skip("no clang++ and no aarch64-linux-gnu-g++ (Debian: apt-get install g++-aarch64-linux-gnu)")
    for command in compilers:
        source = ROOT / "tests" / "golden" / case / "pipeline.cpp"
        compile_quietly(command, *FLAGS, f"-I{ROOT / 'runtime_cpp' / 'include'}", "-c", source, "-o", tmp_path / "pipeline.o")


def test_the_runtime() -> None:
    gcc = shutil.which("aarch64-linux-gnu-g++")
    if gcc is None:
        pytest.skip("no aarch64-linux-gnu-g++ (Debian: apt-get install g++-aarch64-linux-gnu)")
    for name in ("cpu", "launch", "pipeline", "pool", "trace_services"):
        folders = [f"-I{ROOT / 'runtime_cpp' / folder}" for folder in ("include", "src")]
        compile_quietly([gcc], "-std=c++20", "-fsyntax-only", *folders, ROOT / "runtime_cpp" / "src" / f"{name}.cpp")
