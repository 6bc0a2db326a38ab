"""What a fresh machine may lack, and that one Embree serves the whole process: each failure is one message with its remedy."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from optixc import installation, toolchain

ROOT = Path(__file__).resolve().parents[2]
RENDER = """
import numpy as np
import optixc as ox
corners = np.float32([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
accel = ox.DeviceContext(threads=1).accel_build([ox.BuildInputTriangles(corners)])
assert accel.aabb.tolist() == [[0, 0, 0], [1, 1, 0]]
"""
EMBREEX = """
import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene
scene = EmbreeScene()
mesh = TriangleMesh(scene, np.float32([[[0, 0, 0], [1, 0, 0], [0, 1, 0]]]))
hits = scene.run(np.float32([[0.2, 0.2, -1], [2, 2, -1]]), np.float32([[0, 0, 1], [0, 0, 1]]))
assert hits.tolist() == [0, -1]
"""
MAPPED = """
maps = open("/proc/self/maps").read().split()
assert len({word for word in maps if "libembree" in word}) == 1, maps
"""


def python(code: str, **environment: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-c", code]
    return subprocess.run(command, env={**os.environ, **environment}, capture_output=True, text=True, check=False, timeout=300)


@pytest.mark.parametrize("code", [EMBREEX + RENDER + MAPPED, RENDER + EMBREEX + MAPPED, RENDER + EMBREEX + RENDER + MAPPED],
                         ids=["before", "after", "between"])
def test_embreex_shares_the_library(code: str) -> None:
    if installation.embree_path() is None:
        pytest.skip("the embreex package is not here, or OXRT_EMBREE names another library")
    done = python(code)
    assert (done.returncode, done.stderr) == (0, "")


def last_line(done: subprocess.CompletedProcess[str]) -> str:
    assert done.returncode == 1, done.stdout
    return done.stderr.strip().splitlines()[-1]


def test_no_embree() -> None:
    said = last_line(python(RENDER, OXRT_EMBREE="/nowhere/libembree4.so.4"))
    assert said.startswith("optixc.errors.LibraryNotFoundError: ")
    for word in ("/nowhere/libembree4.so.4", "pip install embreex", "OXRT_EMBREE"):
        assert word in said


def test_an_embree_that_is_too_old(tmp_path: Path) -> None:
    library = tmp_path / "libembree3.so"
    source = ROOT / "tests" / "runtime" / "old_embree.cpp"
    toolchain.compile_shared(source.read_text(), library, toolchain.find_compiler(), toolchain.Build(ROOT / "runtime_cpp" / "include"))
    said = last_line(python(RENDER, OXRT_EMBREE=str(library)))
    for word in ("is Embree 3.13, but version 4 is needed", "pip install embreex"):
        assert word in said


FAKE_PYTHON = """#!/bin/sh
case "$2" in *{word}*) exit 1;; esac
exit 0
"""


@pytest.mark.parametrize("goal", ["demo", "test"])
@pytest.mark.parametrize(
    ("word", "message"),
    [("ensurepip", "has no ensurepip, so it cannot make a virtual environment. Debian: apt-get install python3-venv"),
     ("version_info", "optixc needs Python 3.11 or newer")],
)
def test_a_python_that_will_not_do(tmp_path: Path, goal: str, word: str, message: str) -> None:
    fake = tmp_path / "python3"
    fake.write_text(FAKE_PYTHON.format(word=word))
    fake.chmod(0o755)
    command = ["make", "--no-print-directory", goal, f"PYTHON={fake}", f"VENV={tmp_path / 'venv'}"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode != 0
    assert message in done.stdout
    assert len(done.stdout.strip().splitlines()) == 1
    assert not (tmp_path / "venv").exists()
