"""The wheel holds all that is needed, and works where neither the source tree nor an editable install is."""

from __future__ import annotations

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
LAUNCH = """
import sys
from pathlib import Path
import numpy as np
import optixc as ox
assert Path(ox.__file__).is_relative_to(sys.argv[1]), ox.__file__
Path("shader.py").write_text('''
import optixc as ox
from optixc.stdlib.math import PI

@ox.struct
class Params:
    values: ox.Array[ox.float32]

params = ox.launch_params(Params)

@ox.program
def __raygen__fill():
    i = ox.get_launch_index().x
    params.values[i] = 2.0 * float(i) * (PI / PI)
''')

@ox.struct
class Params:
    values: ox.Array[ox.float32]

context = ox.DeviceContext(cache_dir="cache")
raygen = context.program_group_create(raygen=context.module_create("shader.py")["__raygen__fill"])
values = np.zeros(5, np.float32)
context.pipeline_create([raygen]).launch(Params(values), ox.ShaderBindingTable(raygen=raygen.record()), 5)
assert values.tolist() == [0, 2, 4, 6, 8]
"""


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "wheel", "--quiet", "--no-build-isolation", "--no-deps"]
    environment = {**os.environ, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    done = subprocess.run([*pip, "--config-settings", f"build-dir={folder / 'build'}", "--wheel-dir", str(folder), str(ROOT)],
                          env=environment, capture_output=True, text=True, check=False, timeout=600)
    if "scikit_build_core" in done.stderr and "No module" in done.stderr:
        pytest.skip("scikit-build-core is not installed")
    assert done.returncode == 0, done.stderr
    return next(folder.glob("optixc-*.whl"))


def test_what_it_holds(wheel: Path) -> None:
    assert "-py3-none-" in wheel.name
    names = set(zipfile.ZipFile(wheel).namelist())
    headers = {f"optixc/include/oxrt/{path.name}" for path in (ROOT / "runtime_cpp" / "include" / "oxrt").glob("*.h")}
    stdlib = {f"optixc/stdlib/{path.name}" for path in (ROOT / "stdlib").glob("*.py")}
    others = {"optixc/lib/liboxrt.so", "optixc/py.typed", "optixc/cmake/optixcConfig.cmake", "optixc/cmake/OptixcAddPipeline.cmake"}
    assert headers | stdlib | others <= names
    assert not [name for name in names if name.startswith(("tests", "examples", "benchmarks")) or "/tests/" in name]


def test_it_runs_on_its_own(wheel: Path, tmp_path: Path) -> None:
    site = tmp_path / "site"
    zipfile.ZipFile(wheel).extractall(site)
    # Without the site module no editable install can come first; the packages it depends on are named instead.
    packages = [folder for folder in sys.path if folder.endswith("-packages")]
    environment = {**os.environ, "PYTHONPATH": ":".join([str(site), *packages])}
    done = subprocess.run([sys.executable, "-S", "-c", LAUNCH, str(site)], env=environment, cwd=tmp_path, capture_output=True, text=True,
                          check=False, timeout=300)
    assert (done.returncode, done.stderr) == (0, "")
