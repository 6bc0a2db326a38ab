"""One shared object with kernels for several instruction sets: the loader takes what the processor runs, and refuses what it does not.

OXRT_MAX_ISA makes the runtime take this machine for a lesser one.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from optixc import cli, toolchain

ROOT = Path(__file__).resolve().parents[2]
LEVELS = {"x86-64": 1, "x86-64-v3": 8, "x86-64-v4": 16}
LAUNCH = """
import functools, sys
import numpy as np
import optixc as ox
from optixc import api
from optixc.stdlib.math import PI

@ox.struct
class Params:
    values: ox.Array[ox.float32]

params = ox.launch_params(Params)

@ox.program
def __raygen__fill():
    i = ox.get_launch_index().x
    params.values[i] = ox.sqrt(float(i)) * PI

api.CompileOptions = functools.partial(api.CompileOptions, target=sys.argv[1])
context = ox.DeviceContext(cache_dir=sys.argv[2])
raygen = context.program_group_create(raygen=context.module_create([__raygen__fill])["__raygen__fill"])
pipeline = context.pipeline_create([raygen])
values = np.zeros(37, np.float32)
pipeline.launch(Params(values), ox.ShaderBindingTable(raygen=raygen.record()), 37)
np.testing.assert_array_equal(values, np.sqrt(np.arange(37, dtype=np.float32)) * np.float32(np.pi))
print(pipeline.report().lanes)
"""

pytestmark = pytest.mark.skipif(toolchain.processor_lanes() < 16, reason="this processor has no AVX-512: nothing lesser to stand for")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The launching program, and a cache that its runs share."""
    made = tmp_path_factory.mktemp("targets")
    (made / "launch.py").write_text(LAUNCH)
    return made


def launched(folder: Path, target: str, level: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, str(folder / "launch.py"), target, str(folder / "cache")], capture_output=True, text=True,
                          check=False, env={**os.environ, "OXRT_MAX_ISA": level}, timeout=300)


@pytest.mark.parametrize(("level", "lanes"), LEVELS.items())
def test_the_loader_takes_what_the_processor_runs(folder: Path, level: str, lanes: int) -> None:
    done = launched(folder, "x86-64", level)
    assert (done.returncode, done.stdout.strip(), done.stderr) == (0, str(lanes), "")


@pytest.mark.parametrize(("target", "level"), [("x86-64-v4", "x86-64-v3"), ("x86-64-v4", "x86-64"), ("x86-64-v3", "x86-64")])
def test_kernels_that_the_processor_lacks_are_refused(folder: Path, target: str, level: str) -> None:
    done = launched(folder, target, level)
    assert done.returncode == 1
    said = done.stderr.strip().splitlines()[-1]
    assert said.startswith("optixc.errors.NotSupportedError")
    for word in (f"compiled for {target}", f"it has {level})", "--target x86-64"):
        assert word in said


@pytest.mark.parametrize("level", LEVELS)
def test_native_follows_the_lesser_processor(folder: Path, level: str) -> None:
    done = launched(folder, "native", level)
    assert (done.returncode, done.stdout.strip(), done.stderr) == (0, str(LEVELS[level]), "")


def test_an_unknown_level_is_named(folder: Path) -> None:
    said = launched(folder, "native", "avx").stderr.strip().splitlines()[-1]
    assert said.startswith("optixc.errors.InvalidValueError: OXRT_MAX_ISA is")


@pytest.mark.parametrize("name", ["clang++", "g++"])
def test_the_command_writes_one_symbol(tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch,
                                       capsys: pytest.CaptureFixture[str]) -> None:
    found = next((one for one in toolchain.installed_compilers() if Path(one.command).name.startswith(name)), None)
    if found is None:
        pytest.skip(f"{name} is not installed")
    monkeypatch.setenv("OPTIXC_CXX", found.command)
    monkeypatch.setenv("OPTIXC_CACHE_DIR", str(tmp_path / "cache"))
    shader = str(ROOT / "examples" / "01_gradient" / "shader.py")
    assert cli.main([shader, "--target", "x86-64", "-o", str(tmp_path / "made")]) == 0
    if shutil.which("nm"):
        listed = subprocess.run(["nm", "-D", "--defined-only", str(tmp_path / "made.so")], capture_output=True, text=True, check=True)
        assert re.findall(r" \w (\w+)", listed.stdout) == ["oxrt_pipeline_v1"]
        needs = subprocess.run(["readelf", "-d", str(tmp_path / "made.so")], capture_output=True, text=True, check=True)
        assert set(re.findall(r"NEEDED.*\[(\w+)\.", needs.stdout)) <= {"libm", "libc"}
    assert cli.main([shader, "--target", "x86-64", "--simd", "8"]) == cli.EXIT_USAGE
    assert cli.main([shader, "--target", "x86-64-v3", "--simd", "16"]) == cli.EXIT_USAGE
    assert "the most is 8" in capsys.readouterr().err
