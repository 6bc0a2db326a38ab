"""Sample programs that OptiX's users know, in our words: run small, in scalar code and in packets, compared with values derived by hand.

A mesh viewer, collision queries and a larger Whitted scene are under examples/, whose pictures other tests check.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shaders_of_samples as shaders

import optixc as ox

SIZE = 16
BOX = np.array([[-1.0, -1.0, -1.0, 1.0, 1.0, 1.0]], np.float32)
TRIANGLE = np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [-1.0, 1.0, 0.0]], np.float32)
BACKGROUND = np.array([0.1, 0.2, 0.3], np.float32)


class Sample:
    """One context with the pipeline of all samples in one width."""

    def __init__(self, lanes: int) -> None:
        self.context = ox.DeviceContext()
        module = self.context.module_create(Path(__file__).parent / "shaders_of_samples.py")
        create = self.context.program_group_create
        names = ("hello", "orthographic", "path", "queries", "volume", "ambient")
        self.groups = {name: create(raygen=module[f"__raygen__{name}"]) for name in names}
        self.groups |= {name: create(miss=module[f"__miss__{name}"]) for name in ("background", "dark", "lit")}
        self.groups |= {name: create(direct_callable=module[f"__direct_callable__{name}"]) for name in ("normal_shading", "phong")}
        triangle = module["__closesthit__barycentrics"]
        self.groups["triangle"] = create(closesthit=triangle)
        self.groups["cutout"] = create(closesthit=triangle, anyhit=module["__anyhit__cutout"])
        self.groups |= {name: create(closesthit=module[f"__closesthit__{name}"]) for name in ("checker", "mirror", "strand")}
        self.groups["wall"] = create(closesthit=module["__closesthit__glow"])
        sphere = module["__intersection__sphere"]
        self.groups["sphere"] = create(closesthit=module["__closesthit__normal"], intersection=sphere)
        self.groups["shaded"] = create(closesthit=module["__closesthit__callable"], intersection=sphere)
        options = ox.PipelineCompileOptions(uses_motion_blur=True)
        self.bind = lambda values: self.context.pipeline_create(
            list(self.groups.values()), max_trace_depth=2, simd=lanes, options=options, bound_values=values
        )
        self.pipeline = self.bind({})

    def render(self, raygen: str, scene: Any, hit: str = "triangle", data: Any = None, miss: str = "background", **more: Any) -> Any:
        """The picture, its first row at the bottom."""
        return self.render_records(self.pipeline, raygen, scene, [(hit, data)], miss, **more)

    def render_records(self, pipeline: Any, raygen: str, scene: Any, hits: list[tuple[str, Any]], miss: str, **more: Any) -> Any:
        """The same with a pipeline and several records; rays of type 1 are shadow rays."""
        records = [self.groups[hit].record(data) if data is not None else self.groups[hit].record() for hit, data in hits]
        callables = [self.groups[name].record() for name in ("normal_shading", "phong")]
        table = ox.ShaderBindingTable(
            raygen=self.groups[raygen].record(),
            miss=[self.groups[miss].record(), self.groups["lit"].record()],
            hitgroup=records,
            callables=callables,
        )
        image = np.zeros((SIZE, SIZE, 3), np.float32)
        values = {"depth": 1, "time": 0.0, "origins": np.zeros((1, 3), np.float32), "distances": np.zeros(1, np.float32)} | more
        width, height = (len(values["origins"]), 1) if raygen == "queries" else (SIZE, SIZE)
        pipeline.launch(shaders.Params(image=image, scene=scene, **values), table, width=width, height=height)
        return image

    def triangle(self, flags: int = 0, keys: list[Any] | None = None) -> Any:
        motion = ox.MotionOptions(2) if keys else None
        return self.context.accel_build([ox.BuildInputTriangles(keys or TRIANGLE, flags=flags)], motion_options=motion)

    def sphere(self) -> Any:
        return self.context.accel_build([ox.BuildInputCustomPrimitives(BOX)])


@pytest.fixture(scope="module", params=[1, 8, 16])
def sample(request: pytest.FixtureRequest) -> Sample:
    try:
        return Sample(request.param)
    except ox.NotSupportedError:
        pytest.skip(f"{request.param} lanes are not available here")


def places() -> tuple[Any, Any]:
    """x and y of the pixels' centres, from -1 to 1."""
    line = (2.0 * (np.arange(SIZE) + 0.5) / SIZE - 1.0).astype(np.float32)
    x, y = np.meshgrid(line, line)
    return x, y


def sphere_normals() -> tuple[Any, Any]:
    """Which pixels see the unit sphere, and its normals there."""
    x, y = places()
    inside = x * x + y * y < 1.0
    z = np.sqrt(np.maximum(0.0, 1.0 - x * x - y * y))
    return inside, np.stack([x, y, z], axis=-1)


def test_hello(sample: Sample) -> None:
    assert (sample.render("hello", 0) == np.array([0.462, 0.725, 0.0], np.float32)).all()


def test_triangle(sample: Sample) -> None:
    """Barycentric coordinates of a right triangle are half the distances from its corner."""
    image = sample.render("orthographic", sample.triangle())
    x, y = places()
    inside = x + y < -0.01
    expected = np.stack([(x + 1.0) / 2.0, (y + 1.0) / 2.0, np.ones_like(x)], axis=-1)
    np.testing.assert_allclose(image[inside], expected[inside], atol=1e-5)
    assert (image[x + y > 0.01] == BACKGROUND).all()


def test_cutouts(sample: Sample) -> None:
    """The any-hit program drops every other square of an 8 by 8 board."""
    image = sample.render("orthographic", sample.triangle(), "cutout")
    x, y = places()
    inside = x + y < -0.01
    dropped = ((4.0 * (x + 1.0)).astype(int) + (4.0 * (y + 1.0)).astype(int)) % 2 == 1
    assert (image[inside & dropped] == BACKGROUND).all()
    assert (image[inside & ~dropped][:, 2] == 1.0).all()


def test_simple_motion(sample: Sample) -> None:
    """A triangle that moves by 1 along x during the shutter is half way at time 1/2."""
    moved = TRIANGLE + np.array([1.0, 0.0, 0.0], np.float32)
    scene = sample.triangle(keys=[TRIANGLE, moved])
    x, y = places()
    for time in (0.0, 0.5, 1.0):
        image = sample.render("orthographic", scene, time=time)
        shifted = x - time
        hit = (shifted > -1.0) & (shifted + y < 0.0)
        clear = (abs(shifted + y) > 0.01) & (abs(shifted + 1.0) > 0.01)
        assert ((image[..., 2] == 1.0) == hit)[clear].all()


def test_sphere(sample: Sample) -> None:
    inside, normals = sphere_normals()
    image = sample.render("orthographic", sample.sphere(), "sphere")
    np.testing.assert_allclose(image[inside], (0.5 * (normals + 1.0))[inside], atol=2e-5)
    assert (image[~inside] == BACKGROUND).all()


def test_callable_programs(sample: Sample) -> None:
    """The record chooses the callable that shades."""
    inside, normals = sphere_normals()
    albedo = np.array([0.5, 0.25, 1.0], np.float32)
    z = normals[..., 2:]
    expected = (0.5 * (normals + 1.0) * albedo, albedo * z + 0.25 * z**16)
    for number, wanted in enumerate(expected):
        data = shaders.Surface(albedo=albedo, emission=(0, 0, 0), shader=number)
        image = sample.render("orthographic", sample.sphere(), "shaded", data)
        np.testing.assert_allclose(image[inside], wanted[inside], atol=1e-4)


def test_path_tracer(sample: Sample) -> None:
    """Between two walls that face each other light is the geometric series of albedo: e (1 - a^n) / (1 - a)."""
    wall = np.array([[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]], np.float32)
    up = np.array([0.0, 0.0, 1.0], np.float32)
    walls = np.concatenate([wall - up, wall + up])
    scene = sample.context.accel_build([ox.BuildInputTriangles(walls)])
    albedo, emission = np.array([0.5, 0.8, 0.0]), np.array([1.0, 0.5, 2.0])
    data = shaders.Surface(albedo=albedo, emission=emission, shader=0)
    for depth in (1, 2, 12):
        image = sample.render("path", scene, "wall", data, "dark", depth=depth)
        np.testing.assert_allclose(image[4, 4], emission * (1.0 - albedo**depth) / (1.0 - albedo), rtol=1e-5)


def test_raycasting(sample: Sample) -> None:
    """Distances of many rays at once: to the unit sphere from above it is z - sqrt(1 - x^2 - y^2)."""
    origins = np.random.default_rng(3).uniform([-1, -1, 2], [1, 1, 5], (1000, 3)).astype(np.float32)
    distances = np.zeros(len(origins), np.float32)
    sample.render("queries", sample.sphere(), "sphere", origins=origins, distances=distances)
    square = (origins[:, :2].astype(np.float64) ** 2).sum(axis=1)
    expected = np.where(square < 1.0, origins[:, 2] - np.sqrt(np.maximum(0.0, 1.0 - square)), -1.0)
    clear = abs(square - 1.0) > 1e-3
    np.testing.assert_allclose(distances[clear], expected[clear], atol=1e-3)
    assert (distances > 0.0).any() and (distances < 0.0).any()


def test_volume_viewer(sample: Sample) -> None:
    """Transmittance of a homogeneous sphere: exp(-sigma times the chord)."""
    inside, normals = sphere_normals()
    image = sample.render("volume", sample.sphere(), "sphere")
    chord = 2.0 * normals[..., 2]
    np.testing.assert_allclose(image[inside][:, 0], np.exp(-2.0 * chord)[inside], rtol=1e-3)
    assert (image[~inside] == 1.0).all()


def square(half: float, z: float) -> Any:
    """Two triangles."""
    a, b, c, d = ((x * half, y * half, z) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1)))
    return np.array([a, b, c, a, c, d], np.float32)


def test_whitted(sample: Sample) -> None:
    """A mirror above a checkered floor shows the sky and throws a shadow; elsewhere Lambert's law holds."""
    inputs = [ox.BuildInputTriangles(square(4.0, 0.0)), ox.BuildInputTriangles(square(0.25, 1.0))]
    floor = shaders.Surface(albedo=(1.0, 0.0, 0.0), emission=(0.0, 1.0, 0.0), shader=0)
    mirror = shaders.Surface(albedo=(0.5, 0.5, 1.0), emission=(0.0, 0.0, 0.0), shader=0)
    records = [("checker", floor), ("mirror", mirror)]
    image = sample.render_records(sample.pipeline, "orthographic", sample.context.accel_build(inputs), records, "background")
    x, y = places()
    largest = np.maximum(abs(x), abs(y))
    np.testing.assert_allclose(image[largest < 0.25], np.broadcast_to(BACKGROUND * mirror.albedo, (4 * 4, 3)), rtol=1e-6)
    # The light stands 3 above the floor, so the shadow is half as large again as the mirror.
    cosine = 3.0 / np.sqrt(9.0 + x * x + y * y)
    shade = 0.25 + 0.75 * np.where(largest < 0.375, 0.0, cosine)
    even = (np.floor(2.0 * x) + np.floor(2.0 * y)) % 2 == 0
    expected = shade[..., None] * np.where(even[..., None], floor.albedo, floor.emission)
    np.testing.assert_allclose(image[largest > 0.25], expected[largest > 0.25], atol=1e-6)


def test_hair(sample: Sample) -> None:
    """The colour of a strand of two segments goes from root to tip."""
    vertices = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0]], np.float32)
    radii = np.full(3, 0.25, np.float32)
    strand = ox.BuildInputCurves(ox.PrimitiveType.ROUND_LINEAR, vertices, radii, np.array([0, 1], np.uint32))
    colours = shaders.Surface(albedo=(1.0, 0.0, 0.0), emission=(0.0, 0.5, 1.0), shader=2)
    image = sample.render("orthographic", sample.context.accel_build([strand]), "strand", colours)
    x, y = places()
    along = ((y + 1.0) / 2.0)[..., None]
    expected = (1.0 - along) * np.array([1.0, 0.0, 0.0]) + along * np.array([0.0, 0.5, 1.0])
    np.testing.assert_allclose(image[abs(x) < 0.25], expected[abs(x) < 0.25], atol=1e-5)
    assert (image[abs(x) > 0.25] == BACKGROUND).all()


def test_bound_values(sample: Sample) -> None:
    """Ambient occlusion by as many rays as the pipeline binds: a wall hides those that go to the right below its edge."""
    wall = np.array([[1.5, -9.0, 0.0], [1.5, 9.0, 0.0], [1.5, 9.0, 1.5], [1.5, -9.0, 0.0], [1.5, 9.0, 1.5], [1.5, -9.0, 1.5]], np.float32)
    scene = sample.context.accel_build([ox.BuildInputTriangles(wall)])
    pipeline = sample.bind({"depth": 24})
    image = sample.render_records(pipeline, "ambient", scene, [("triangle", None)], "background", depth=1)
    x, _ = places()
    angles = (np.arange(24) + 0.5) * np.pi / 24
    hidden = (np.cos(angles) > 0.0) & (np.tan(angles) * (1.5 - x[..., None]) < 1.5)
    np.testing.assert_allclose(image[..., 0], 1.0 - hidden.mean(axis=-1), atol=1e-6)
