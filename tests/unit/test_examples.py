"""Each example runs as its README says, in a process of its own, and its picture shows what it should."""

from __future__ import annotations

import importlib
import importlib.util
import os
import re
import subprocess
import sys
import time
from pathlib import Path
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

import optixc as ox
from optixc import installation
from optixc.stdlib import shapes
from optixc.stdlib.camera import ThinLens
from optixc.stdlib.environment import environment_map
from optixc.stdlib.light import RectangleLight
from optixc.stdlib.principled import Principled

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
FOLDERS = sorted(folder.name for folder in EXAMPLES.iterdir() if re.fullmatch(r"\d\d_\w+", folder.name))


def run(example: str, *arguments: object) -> str:
    """What a host program printed; fails with its errors."""
    command = [sys.executable, EXAMPLES / example / "host.py", *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stderr == "", "progress bars stay silent when the output is no terminal"
    return done.stdout


def test_a_long_render_is_silent_without_a_terminal(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> None:
    monkeypatch.syspath_prepend(str(EXAMPLES))
    rendering = importlib.import_module("rendering")

    class Slow:
        """Launches that take longer together than a bar waits before it shows."""

        def launch(self, params: object, table: object, width: int, height: int) -> None:
            time.sleep(0.8)

    assert rendering.accumulate(Slow(), SimpleNamespace(samples=4), None, (1, 1), "slow") >= 3.2
    assert capfd.readouterr() == ("", "")


def linear(path: Path) -> np.ndarray:
    """A picture's colours, decoded to linear floats."""
    values = ox.read_image(path)[:, :, :3] / 255.0
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)


def source(example: str, name: str) -> ModuleType:
    """A module of an example that needs no others."""
    specification = importlib.util.spec_from_file_location(f"{example}_{name}", EXAMPLES / example / f"{name}.py")
    assert specification is not None and specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    sys.modules[specification.name] = module
    specification.loader.exec_module(module)
    return module


@pytest.mark.parametrize("folder", FOLDERS)
def test_every_example_is_complete(folder: str) -> None:
    readme = (EXAMPLES / folder / "README.md").read_text()
    assert (EXAMPLES / folder / "shader.py").is_file()
    assert (EXAMPLES / folder / "host.py").is_file() or (EXAMPLES / folder / "host.cpp").is_file()
    for picture in re.findall(r"!\[.*?\]\((.*?)\)", readme):
        assert (EXAMPLES / folder / picture).is_file(), picture
    assert f"]({folder})" in (EXAMPLES / "README.md").read_text()


def test_the_first_shader_of_the_readme_runs(tmp_path: Path) -> None:
    blocks = re.findall(r"```python\n(.*?)```", (EXAMPLES.parent / "README.md").read_text(), re.DOTALL)
    for block in blocks:
        (tmp_path / re.match(r"# (\w+\.py)", block)[1]).write_text(block)
    done = subprocess.run([sys.executable, "host.py"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    picture = linear(tmp_path / "triangle.png")
    assert (picture[20, 20] == 0.0).all()
    # The centroid weighs all corners alike; a third of 255 steps after encoding
    np.testing.assert_allclose(picture[512 - round(512 * 1.1 / 3), 256], 1.0 / 3.0, atol=0.01)


def test_gradient(tmp_path: Path) -> None:
    run("01_gradient", "--size", 64, "--output", tmp_path / "a.exr")
    image = ox.read_image(tmp_path / "a.exr")
    centers = ((np.arange(64) + 0.5) / 64).astype(np.float32)
    np.testing.assert_array_equal(image[:, :, 0], np.broadcast_to(centers, (64, 64)))
    np.testing.assert_array_equal(image[:, :, 1], np.broadcast_to(1.0 - centers[:, np.newaxis], (64, 64)))


def test_triangle(tmp_path: Path) -> None:
    run("02_triangle", "--size", 128, "--output", tmp_path / "a.exr")
    image = ox.read_image(tmp_path / "a.exr")[:, :, :3]
    # Where the ray through each pixel's centre meets the plane z = 0, in closed form
    x = 1.7 * 0.4142 * (2.0 * (np.arange(128) + 0.5) / 128 - 1.0)
    x, y = np.meshgrid(x, -x)
    top = y + 0.5
    right = x + 0.5 - 0.5 * top
    inside = (top > 0) & (right > 0) & (right + top < 1)
    expected = np.where(inside[..., np.newaxis], np.stack([1.0 - right - top, right, top], -1), [0.02, 0.03, 0.05])
    border = np.minimum(np.minimum(np.abs(top), np.abs(right)), np.abs(1.0 - right - top)) < 1e-5
    np.testing.assert_allclose(image[~border], expected[~border], atol=1e-5)
    assert inside.sum() > 3000


def test_mesh_viewer_shows_mesh_ground_and_sky(tmp_path: Path) -> None:
    output = run("03_mesh_viewer", "--width", 96, "--height", 64, "--samples", 4, "--output", tmp_path / "a.png")
    assert "131072 triangles" in output
    image = linear(tmp_path / "a.png")
    assert image.shape == (64, 96, 3)
    saturation = image.max(axis=2) - image.min(axis=2)
    assert saturation[16:48, 32:64].max() > 0.3, "the knot is colourful"
    ground = image[-4:]
    assert (ground.max(axis=2) - ground.min(axis=2)).max() < 0.3, "the ground is grey"


def test_mesh_viewer_reads_files(tmp_path: Path) -> None:
    pytest.importorskip("trimesh")
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    output = run("03_mesh_viewer", tmp_path / "a.obj", "--width", 32, "--height", 32, "--samples", 1, "--output", tmp_path / "a.png")
    assert output.startswith("4 triangles")


def test_ambient_occlusion_agrees_with_an_independent_estimate(tmp_path: Path) -> None:
    size, count = 48, 64
    run("04_ambient_occlusion", "--size", size, "--samples", 8, "--occlusion-rays", 8, "--output", tmp_path / "a.exr")
    image = ox.read_image(tmp_path / "a.exr")[:, :, 0]
    expected = reference_occlusion(source("04_ambient_occlusion", "courtyard"), size, count)
    # Both are means of 64 rays per pixel of values in [0, 1], over 2304 pixels: standard error of the difference below 0.5 / 64**0.5 *
    # 2**0.5 / 48 = 0.0018; pixels differ only where one of them straddles an edge
    assert abs(image.mean() - expected.mean()) < 4 * 0.0019
    assert np.percentile(np.abs(image - expected), 90) < 4 * 0.5 * (2.0 / count) ** 0.5


def reference_occlusion(courtyard: ModuleType, size: int, count: int) -> np.ndarray:
    """The courtyard through embreex and numpy: one jittered primary ray and one occlusion ray per sample."""
    embree_meshes = pytest.importorskip("embreex.mesh_construction")
    embree_scenes = pytest.importorskip("embreex.rtcore_scene")
    random = np.random.default_rng(3)
    vertices, indices = courtyard.build()
    corners = vertices[indices]
    scene = embree_scenes.EmbreeScene()
    embree_meshes.TriangleMesh(scene, corners)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)

    w = np.subtract(courtyard.TARGET, courtyard.EYE)
    right = np.cross(w, [0.0, 1.0, 0.0])
    right /= np.linalg.norm(right)
    up = np.cross(right, w) / np.linalg.norm(w)
    half = np.linalg.norm(w) * np.tan(np.radians(0.5 * courtyard.VERTICAL_FOV))
    open_share = np.zeros((size, size))
    origins = np.tile(np.array(courtyard.EYE, np.float32), (size * size, 1))
    for _ in range(count):
        x = 2.0 * (np.arange(size) + random.random((size, size))) / size - 1.0
        y = 1.0 - 2.0 * (np.arange(size)[:, np.newaxis] + random.random((size, size))) / size
        directions = (x[..., np.newaxis] * half * right + y[..., np.newaxis] * half * up + w).reshape(-1, 3)
        found = scene.run(origins, directions.astype(np.float32), output=True)
        hit = found["primID"] >= 0
        n = normals[np.maximum(found["primID"], 0)]
        n = np.where((n * directions).sum(axis=1, keepdims=True) > 0.0, -n, n)
        points = (origins + found["tfar"][:, np.newaxis] * directions + 1e-4 * n).astype(np.float32)
        points[~hit] = 0.0
        scattered = random.normal(size=points.shape)
        scattered = n + scattered / np.linalg.norm(scattered, axis=1, keepdims=True)
        scattered /= np.linalg.norm(scattered, axis=1, keepdims=True)
        blocked = scene.run(points, scattered.astype(np.float32), output=True)
        free = ~hit | (blocked["primID"] < 0) | (blocked["tfar"] > courtyard.RADIUS)
        open_share += free.reshape(size, size) / count
    return open_share


def test_ambient_occlusion_says_what_is_missing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OXRT_SCENES_DIR", str(tmp_path))
    command = [sys.executable, EXAMPLES / "04_ambient_occlusion" / "host.py", "sibenik"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "OXRT_SCENES_DIR" in done.stderr
    assert "Traceback" not in done.stderr


def test_statistics_are_printed(tmp_path: Path) -> None:
    output = run("04_ambient_occlusion", "--size", 32, "--samples", 1, "--output", tmp_path / "a.png")
    for word in ("compile", "build", "Mrays/s", "threads", "memory", str(tmp_path / "a.png")):
        assert word in output


def test_collision_queries_agree_with_brute_force() -> None:
    output = run("06_collision_queries", "--rays", 200, "--observers", 128, "--points", 512, "--steps", 60)
    assert "all answers agree" in output


def test_hair_shows_tresses_of_three_colours(tmp_path: Path) -> None:
    size = ("--width", 96, "--height", 72, "--strands", 700, "--samples", 8)
    output = run("08_hair", *size, "--output", tmp_path / "a.exr")
    assert "2100 hairs of 60900 segments" in output
    image = ox.read_image(tmp_path / "a.exr")[20:36, :, :3]
    brown, red, blond = (image[:, center - 6 : center + 6].mean(axis=(0, 1)) for center in (23, 48, 73))
    assert brown.sum() < red.sum() < blond.sum()
    # Melanin takes blue before red; the wall is bluish
    for color in (brown, red, blond):
        assert color[0] > 1.15 * color[2]
    assert image[:, :3].mean(axis=(0, 1))[0] < image[:, :3].mean(axis=(0, 1))[2]


def test_motion_blur_is_where_things_move(tmp_path: Path) -> None:
    for shutter in (0.0, 1.0):
        size = ("--width", 96, "--height", 64, "--samples", 4, "--shutter", shutter)
        output = run("09_motion_blur", *size, "--output", tmp_path / f"{shutter}.exr")
        assert "8 things, 5 of them moving" in output
    still, blurred = (ox.read_image(tmp_path / f"{shutter}.exr")[:, :, :3] for shutter in (0.0, 1.0))
    changed = np.abs(still - blurred).max(axis=2) > 0.02
    assert not changed[:8].any(), "the sky stands still"
    assert not changed[30:44, 61:63].all(axis=1).any(), "so does the pole of the flag"
    moving = {"wheel": (24, 40, 40, 56), "ball": (40, 54, 66, 82), "flag": (11, 26, 84, 90)}
    for name, (top, bottom, left, right) in moving.items():
        assert changed[top:bottom, left:right].mean() > 0.15, name


def test_instances_make_a_forest(tmp_path: Path) -> None:
    size = ("--width", 96, "--height", 54, "--samples", 2, "--trees", 20_000)
    output = run("10_instances", *size, "--output", tmp_path / "a.exr")
    assert re.search(r"20002 instances built in \d+\.\d\d s, \d+ MiB", output)
    image = ox.read_image(tmp_path / "a.exr")[:, :, :3]
    sky, land = image[:10], image[30:]
    assert (sky[..., 2] > sky[..., 0]).mean() > 0.9 and sky.std() < 0.3
    assert (land[..., 1] > land[..., 2]).mean() > 0.8
    assert land.mean() < 0.6 * sky.mean()


def test_micromaps_change_the_time_of_cutouts_and_not_the_picture(tmp_path: Path) -> None:
    saved = []
    for level in (1, 6):
        size = ("--width", 64, "--height", 64, "--samples", 2, "--leaves", 4, "--level", level)
        output = run("11_cutouts", *size, "--output", tmp_path / f"{level}.exr")
        saved.append(float(re.search(r"saved +(-?\d+\.\d) %", output)[1]))
    assert saved[0] < 30.0
    assert saved[1] > 85.0
    coarse, fine = (ox.read_image(tmp_path / f"{level}.exr") for level in (1, 6))
    np.testing.assert_array_equal(coarse, fine)


def test_the_triangle_from_cpp_is_the_one_from_python(tmp_path: Path) -> None:
    cmake = Path(sys.executable).with_name("cmake")
    if not cmake.exists():
        pytest.skip("cmake is not installed beside this Python")
    folder = EXAMPLES / "07_triangle_cpp"
    for arguments in (
        ["-S", folder, "-B", tmp_path / "build", f"-Doptixc_DIR={installation.cmake_folder()}"],
        ["--build", tmp_path / "build"],
    ):
        done = subprocess.run([cmake, *map(str, arguments)], capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    subprocess.run([tmp_path / "build" / "triangle", tmp_path / "a.ppm"], check=True, capture_output=True, env=environment)
    run("02_triangle", "--size", 512, "--output", tmp_path / "a.png")
    header = b"P6\n512 512\n255\n"
    content = (tmp_path / "a.ppm").read_bytes()
    assert content.startswith(header)
    picture = np.frombuffer(content[len(header) :], np.uint8).reshape(512, 512, 3)
    assert np.abs(picture.astype(int) - ox.read_image(tmp_path / "a.png")[:, :, :3]).max() <= 1


def test_material_network_wires_nodes_to_objects(tmp_path: Path) -> None:
    output = run("12_callables", "--width", 160, "--height", 90, "--samples", 16, "--output", tmp_path / "a.exr")
    assert "11 objects, 78 nodes in 10 programs" in output
    image = ox.read_image(tmp_path / "a.exr")[:, :, :3]
    assert np.isfinite(image).all()
    assert image.min() >= 0.0

    def color(x: float, y: float) -> np.ndarray:
        """The mean around a place given in shares of width and height."""
        return image[round(90 * y) - 2 : round(90 * y) + 3, round(160 * x) - 2 : round(160 * x) + 3].mean(axis=(0, 1))

    red, green, blue = color(0.65, 0.48), color(0.29, 0.7), color(0.92, 0.72)
    assert red[0] > 3.0 * red[1], "cloth"
    assert green[1] > 1.3 * green[0], "jade"
    assert blue[2] > 1.5 * blue[1], "lacquer"
    paper = color(0.1, 0.9)
    assert paper.max() < 1.2 * paper.min(), "paper is nearly grey"


def test_path_tracer_shows_cars_floor_and_sky(tmp_path: Path) -> None:
    output = run("13_path_tracer", "--width", 96, "--height", 54, "--samples", 4, "--every", 2, "--output", tmp_path / "a.exr")
    assert "Mrays/s" in output
    image = ox.read_image(tmp_path / "a.exr")[:, :, :3]
    assert np.isfinite(image).all()
    assert image.min() >= 0.0
    assert image.max() <= 1.0
    sky, floor, red = image[2].mean(axis=0), image[-4:].mean(axis=(0, 1)), image[26:30, 36:42].mean(axis=(0, 1))
    assert sky[0] > 1.3 * sky[2], "the evening is warm at the horizon"
    assert 0.01 < floor.mean() < sky.mean()
    assert red[0] > 2.0 * red[1], "the car in front is red"


@pytest.mark.parametrize("lit_by", ["sky", "lamp"])
def test_path_tracer_mirrors_all_light_of_a_furnace(lit_by: str) -> None:
    """A floor that loses nothing below a uniform sky, or an endless lamp: radiance 1 everywhere, whichever strategy found it."""
    shader, size = source("13_path_tracer", "shader"), 32
    context = ox.DeviceContext()
    module = context.module_create(EXAMPLES / "13_path_tracer" / "shader.py")
    path = context.program_group_create(raygen=module["__raygen__path"])
    hit = context.program_group_create(closesthit=module["__closesthit__part"])
    pipeline = context.pipeline_create([path, hit])
    lamp = RectangleLight((-1e4, 1.0, -1e4), (2e4, 0.0, 0.0), (0.0, 0.0, 2e4), (float(lit_by == "lamp"),) * 3)
    floor = shapes.rectangle((-1e5, 0.0, 1e5), (2e5, 0.0, 0.0), (0.0, 0.0, -2e5))
    box = shapes.rectangle(lamp.corner, lamp.edge_u, lamp.edge_v)
    meshes = [floor, box] if lit_by == "lamp" else [floor]
    scene = context.accel_build([ox.BuildInputInstances([
        ox.Instance(context.accel_build([ox.BuildInputTriangles(mesh.vertices, mesh.indices)]), sbt_offset=k, instance_id=k)
        for k, mesh in enumerate(meshes)])])
    mirror = Principled((1.0, 1.0, 1.0), 1.0, 0.3, 0.5, 0.0, 0.0, 0.0)
    table = ox.ShaderBindingTable(path.record(), hitgroup=[hit.record(shader.Part(mesh.indices, mesh.normals, mirror)) for mesh in meshes])
    sums = np.zeros((size, size, 4), np.float32)
    params = shader.Params(
        sums=sums, image=np.zeros_like(sums), ray_counts=np.zeros((size, size), np.uint32), scene=scene,
        camera=ThinLens((0.0, 0.6, 0.0), (0.3, 0.0, 0.0), (0.0, 0.0, -0.3), (0.0, -0.6, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
        lamp=lamp, sky=environment_map(np.full((16, 32, 3), float(lit_by == "sky"))),
        sample=0, max_bounces=3, max_indirect=1e9, exposure=0.0)
    for sample in range(16):
        params.sample = sample
        pipeline.launch(params, table, width=size, height=size)
    values = sums[:, :, 0] / sums[:, :, 3]
    # A lobe of alpha 0.09 loses below a hundredth to microfacets behind others, seen from within 30 degrees of the normal
    error = 4.0 * values.std() / size
    assert 0.99 - error < values.mean() < 1.0 + error
    assert error < 0.05


def test_photons_are_counted_and_their_power_is_conserved(tmp_path: Path) -> None:
    output = run("14_photon_mapping", "--width", 64, "--height", 36, "--samples", 2, "--photons", 50000, "--output", tmp_path / "a.exr")
    names = ("emitted", "kept", "escaped", "taken")
    power = {name: np.array(re.search(rf"{name} +\[(.*?)\]", output)[1].split(), float) for name in names}
    # Printed with four decimals: each of four numbers is off by at most half of the last
    np.testing.assert_allclose(power["kept"] + power["escaped"] + power["taken"], power["emitted"], atol=4 * 0.5e-4)
    missing, bound = map(float, re.search(r"missing +(\S+) of the power, rounding may lose (\S+)", output).groups())
    assert missing <= bound
    photons, kept, caustic = map(int, re.search(r"(\d+) photons a pass: (\d+) kept, (\d+) of them", output).groups())
    assert photons == 50000
    assert photons > kept > caustic > 0
    # Photons start with equal power, and only some of it is taken on the way: kept power is between that of direct photons and of all kept
    share = power["kept"][0] / power["emitted"][0]
    assert (kept - caustic) / photons <= share <= kept / photons
    image = ox.read_image(tmp_path / "a.exr")[:, :, :3]
    assert np.isfinite(image).all()
    assert image.min() >= 0.0


def test_a_network_learns_a_material(tmp_path: Path) -> None:
    arguments = ("--steps", 200, "--batch", 1024, "--samples", 4, "--width", 96, "--height", 54, "--output", tmp_path / "a.exr")
    output = run("15_neural_material", *arguments)
    first, last = map(float, re.search(r"error +(\S+) at first, (\S+) at last", output).groups())
    # Colours are compressed to [0, 1): their variance is at most 1/4, which is what a network that gives their mean would leave.
    assert last < first / 20.0 and last < 0.25 / 4.0
    image = ox.read_image(tmp_path / "a.exr")[:, :, :3]
    assert np.isfinite(image).all() and image.min() >= 0.0
    floor = image[50, 48]
    for start in (6, 54):
        assert (np.abs(image[14:38, start : start + 36] - floor).max(axis=2) > 0.05).mean() > 0.3, "a torus is no floor"


def test_photon_grid_holds_every_photon_in_its_cell(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(EXAMPLES / "14_photon_mapping"))
    for name in ("shader", "photon_map"):
        monkeypatch.setitem(sys.modules, name, source("14_photon_mapping", name))
    shader, photon_map = sys.modules["shader"], sys.modules["photon_map"]
    random, count = np.random.default_rng(5), 2000
    photons = np.zeros(count, shader.Photon.dtype)
    photons["position"] = random.uniform(-1.0, 2.0, (count, 3))
    photons["fate"] = random.integers(0, 4, count)
    grid = photon_map.grid(photons, 0.25)
    kept = photons[photons["fate"] <= 1]
    assert len(grid.photons) == len(kept) == grid.starts[-1]
    x, y, z = (int(grid.size[axis]) for axis in range(3))
    assert len(grid.starts) == x * y * z + 1
    for cell in range(x * y * z):
        inside = grid.photons["position"][grid.starts[cell] : grid.starts[cell + 1]]
        found = np.minimum(np.floor((inside - kept["position"].min(axis=0)) / np.float32(0.25)), [x - 1, y - 1, z - 1])
        np.testing.assert_array_equal(found, np.broadcast_to([cell % x, cell // x % y, cell // (x * y)], inside.shape))
