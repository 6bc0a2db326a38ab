"""mypy and pyright on shader files and host files: correct ones pass, names and fields are known, wrong uses are told.

pyright is no requirement of the tests: what PyPI has under that name fetches the checker from npm when it first runs. Where it is
installed it has to be content with the same files.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from mypy import api

import optixc

ROOT = Path(__file__).parents[2]
EXAMPLES = sorted(path.parent for path in (ROOT / "examples").glob("*/shader.py"))
SHADERS = sorted(path for pattern in ("samples", "golden/*", "conformance/shaders") for path in (ROOT / "tests").glob(f"{pattern}/*.py"))
STDLIB = sorted((ROOT / "stdlib").glob("*.py"))

SHADER = '''
from typing import assert_type

import numpy as np

import optixc as ox
from optixc import float3, float4


@ox.struct
class Params:
    image: ox.Array2[float4]
    scene: ox.Traversable
    eye: float3
    camera: ox.float3x4
    weights: ox.FixedArray[float, 4]
    counts: ox.Array[ox.uint32]
    noise: ox.Texture


@ox.struct
class Material:
    albedo: float3
    roughness: float = 0.5


@ox.payload
class Radiance:
    color: float3


params = ox.launch_params(Params)


@ox.program
def __raygen__pinhole():
    i, size = ox.get_launch_index(), ox.get_launch_dimensions()
    x = 2.0 * (float(i.x) + 0.5) / float(size.x) - 1.0
    ray = Radiance(float3(0.0))
    ox.trace(params.scene, params.eye, ox.normalize(x * params.eye), tmin=0.0, payload=ray)
    words = ox.trace(params.scene, params.eye, params.eye, payload=(1, 2))
    v = float3(1.0)
    v.x = ox.max(1.0, 2.0)
    ray.color.y = float(ox.max(1, words[0]))
    v[1] = 0.5
    rows = params.camera * 2.0 + params.camera
    rows[0] = ox.tex2d(params.noise, v.x, v.y)
    table = ox.FixedArray[ox.int32, 4](1, 2, 3, 4)
    table[i.x & 3] += 2
    before = ox.atomic_add(params.counts, table[0], 1)
    params.image[i.y, i.x] = float4(ox.lerp(v, ray.color, params.weights[1]), float(before)) + rows[0]
    assert_type(params.image[i.y, i.x], float4)
    assert_type(2.0 * params.eye - v / 3.0, float3)
    assert_type(ox.floor(params.eye * 2.0).x, float)
    assert_type(rows[0].w, float)


@ox.program
def __closesthit__matte(ray: Radiance, material: Material):
    p0, p1, p2 = ox.get_triangle_vertex_data()
    ray.color = material.albedo * abs(ox.dot(ox.cross(p1 - p0, p2 - p0), ox.get_world_ray_direction()))


material = Material(albedo=(1, 0, 0))
material.albedo = (0.5, 0.5, 0.5)
color: float3 = material.albedo
counts = np.zeros(4, np.uint32)
host = Params(np.zeros((2, 2, 4), np.float32), 3, eye=np.zeros(3), camera=np.eye(3, 4), weights=[1, 2, 3, 4], counts=counts, noise=None)
assert_type(host.eye.x, float)
assert_type(material.roughness, float)
'''


def check(monkeypatch: pytest.MonkeyPatch, cache: Path, *arguments: str) -> str:
    """What mypy says with unannotated functions checked as well, "" if nothing."""
    monkeypatch.setenv("MYPYPATH", str(Path(optixc.__file__).parents[1]))
    options = ["--config-file=", f"--cache-dir={cache}", "--check-untyped-defs", "--follow-imports=silent", "--no-error-summary"]
    output, errors, _ = api.run([*options, f"--python-executable={sys.executable}", "--ignore-missing-imports", *arguments])
    return output + errors


@pytest.fixture(scope="module")
def cache(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("mypy")


def test_a_correct_file_passes(monkeypatch: pytest.MonkeyPatch, cache: Path, tmp_path: Path) -> None:
    (tmp_path / "scene.py").write_text(SHADER)
    assert check(monkeypatch, cache, str(tmp_path / "scene.py")) == ""


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ('Material(albedo="red")', 'Argument "albedo" to "Material"'),
        ("Material(color=(1, 0, 0))", 'Unexpected keyword argument "color"'),
        ("ox.normalise(color)", 'has no attribute "normalise"'),
        ("ox.cross(color)", 'Missing positional argument "b"'),
        ("count: int = ox.sqrt(2.0)", "Incompatible types in assignment"),
    ],
)
def test_wrong_uses_are_told(monkeypatch: pytest.MonkeyPatch, cache: Path, tmp_path: Path, line: str, told: str) -> None:
    (tmp_path / "scene.py").write_text(SHADER + line + "\n")
    said = check(monkeypatch, cache, str(tmp_path / "scene.py"))
    assert told in said
    assert len(said.splitlines()) <= 3


def test_other_shaders_pass(monkeypatch: pytest.MonkeyPatch, cache: Path) -> None:
    # mypy takes a name for a FixedArray, which payload32 has, for a variable; `shader` is one module to it.
    named = {path.stem: path for path in SHADERS if path.stem not in ("shader", "payload32") and not path.stem.startswith("test_")}
    assert check(monkeypatch, cache, *map(str, named.values())) == ""


def test_nothing_is_silenced() -> None:
    """What a checker says is no reason to write more than the shader."""
    files = [*EXAMPLES[0].parent.rglob("*.py"), *STDLIB, *SHADERS]
    assert [path for path in files if path.stem != "test_samples" and "type: ignore" in path.read_text()] == []


def pyright(*arguments: str) -> str:
    """What pyright says, "" if nothing."""
    program = shutil.which("pyright", path=str(Path(sys.executable).parent)) or shutil.which("pyright")
    if program is None:
        pytest.skip("pyright is not installed (pip install pyright)")
    done = subprocess.run([program, "--pythonpath", sys.executable, *arguments], capture_output=True, text=True)
    if done.returncode not in (0, 1):
        pytest.skip(f"pyright does not run: {(done.stdout + done.stderr)[-200:]}")
    return "" if done.returncode == 0 else done.stdout


def test_pyright_passes_what_is_correct(tmp_path: Path) -> None:
    (tmp_path / "scene.py").write_text(SHADER)
    files = [tmp_path / "scene.py", *EXAMPLES[0].parent.rglob("*.py"), *STDLIB, *(path for path in SHADERS if "test_" not in path.stem)]
    assert pyright(*map(str, files)) == ""


def test_pyright_tells_wrong_uses(tmp_path: Path) -> None:
    wrong = ['Material(albedo="red")', "Material(color=(1, 0, 0))", "ox.normalise(color)", "ox.cross(color)", "count: int = ox.sqrt(2.0)"]
    (tmp_path / "scene.py").write_text(SHADER + "\n".join(wrong) + "\n")
    said = pyright(str(tmp_path / "scene.py"))
    first = len(SHADER.splitlines()) + 1
    assert [number for number in range(first, first + len(wrong)) if f"scene.py:{number}:" not in said] == []


@pytest.mark.parametrize("folder", EXAMPLES, ids=lambda folder: folder.name)
def test_examples_pass(monkeypatch: pytest.MonkeyPatch, cache: Path, folder: Path) -> None:
    monkeypatch.chdir(folder)
    assert check(monkeypatch, cache, *sorted(path.name for path in folder.glob("*.py"))) == ""
