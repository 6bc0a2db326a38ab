"""mypy on shader files and host files as the README writes them: correct ones pass, names are known, wrong uses are told."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from mypy import api

import optixc

ROOT = Path(__file__).parents[2]
EXAMPLES = sorted(path.parent for path in (ROOT / "examples").glob("*/shader.py"))

SHADER = '''
import numpy as np

import optixc as ox
from optixc import float3, float4


@ox.struct
class Params:
    image: ox.Array2[float4]
    scene: ox.Traversable
    eye: float3
    camera: ox.float3x4


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
    params.image[i.y, i.x] = float4(ox.lerp(v, ray.color, 0.5), 1.0)


@ox.program
def __closesthit__matte(ray: Radiance, material: Material):
    p0, p1, p2 = ox.get_triangle_vertex_data()
    ray.color = material.albedo * abs(ox.dot(ox.cross(p1 - p0, p2 - p0), ox.get_world_ray_direction()))


material = Material(albedo=(1, 0, 0))
material.albedo = (0.5, 0.5, 0.5)
color: float3 = material.albedo
host = Params(image=np.zeros((2, 2, 4), np.float32), scene=3, eye=np.zeros(3), camera=np.eye(3, 4))
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


@pytest.mark.parametrize("folder", EXAMPLES, ids=lambda folder: folder.name)
def test_examples_pass(monkeypatch: pytest.MonkeyPatch, cache: Path, folder: Path) -> None:
    monkeypatch.chdir(folder)
    assert check(monkeypatch, cache, *sorted(path.name for path in folder.glob("*.py"))) == ""
