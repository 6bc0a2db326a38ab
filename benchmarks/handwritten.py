"""Builds the C++ kernels of benchmarks/kernels with each compiler found and runs them on Embree scenes of the same arrays."""

from __future__ import annotations

import hashlib
import importlib.util
import os
import re
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cffi
import numpy as np
from numpy.typing import NDArray

from benchmarks.scenes import MATERIALS, QUAD_TRIANGLES, SUN, Floats, Scene
from benchmarks.workloads import Workload
from optixc.toolchain import whole_vectors

ROOT = Path(__file__).resolve().parents[1]
KERNELS = Path(__file__).resolve().parent / "kernels"
BUILD = ROOT / "build" / "benchmarks"
INCLUDE = ROOT / "runtime_cpp" / "include"
# those of compiled pipelines (and their `whole_vectors`), exceptions aside: the kernels start threads through the C++ library
FLAGS = [
    *("-std=c++20", "-O3", "-march=native", "-ffp-contract=off", "-fwrapv", "-fno-math-errno", "-fno-trapping-math"),
    *("-fPIC", "-shared", "-fno-rtti", "-fvisibility=hidden", "-w"),
]
_COMPILERS = (("g++",), ("clang++", "clang++-19", "clang++-18", "clang++-17", "clang++-16"))

_SCENE_FUNCTIONS = """
void* bench_device_create(const char* configuration); void bench_device_release(void* device);
void* bench_scene_create(void* device); void bench_scene_commit(void* scene, int join); void bench_scene_release(void* scene);
void bench_scene_add_triangles(void* device, void* scene, const float* vertices, size_t vertexCount, const unsigned* indices,
                               size_t triangleCount);
void bench_scene_add_custom(void* device, void* scene, const float* boxes, unsigned count);
void bench_scene_add_shapes(void* device, void* scene, const float* points, size_t pointCount, const unsigned* firsts, size_t count);
"""


def compilers() -> list[str]:
    """The C++ compilers to build with: g++ and one clang++, as far as they are installed."""
    found = [next((name for name in names if shutil.which(name)), None) for names in _COMPILERS]
    return [name for name in found if name is not None]


def compiler_version(compiler: str) -> str:
    """The first line of `--version`."""
    return subprocess.run([compiler, "--version"], capture_output=True, text=True, check=True).stdout.splitlines()[0]


def embree_library() -> Path:
    """The libembree4 that the embreex wheel carries."""
    spec = importlib.util.find_spec("embreex")
    if spec is None or spec.origin is None:
        raise SystemExit("the benchmarks need the embreex wheel, which carries Embree: pip install embreex")
    found = sorted((Path(spec.origin).parents[1] / "embreex.libs").glob("libembree4*"))
    if not found:
        raise SystemExit("this embreex wheel carries no libembree4")
    return found[0]


def build(source: str, compiler: str, extra_flags: tuple[str, ...] = ()) -> Path:
    """Compiles kernels/`source`.cpp unless a build of the same text, flags and compiler is there."""
    embree = embree_library()
    texts = [path.read_bytes() for path in sorted(KERNELS.glob("*.h"))] + [(KERNELS / f"{source}.cpp").read_bytes()]
    texts += [(INCLUDE / "oxrt" / "embree.h").read_bytes(), compiler_version(compiler).encode(), str(embree).encode()]
    extra_flags = (*extra_flags, *whole_vectors("clang" if "clang" in compiler else "gcc"))
    key = hashlib.sha256(b"\0".join([*texts, " ".join([*FLAGS, *extra_flags]).encode()])).hexdigest()[:16]
    output = BUILD / f"{source}-{compiler}-{key}.so"
    if not output.exists():
        BUILD.mkdir(parents=True, exist_ok=True)
        command = [compiler, *FLAGS, *extra_flags, f"-I{INCLUDE}", str(KERNELS / f"{source}.cpp"), "-o", str(output), str(embree)]
        subprocess.run([*command, f"-Wl,-rpath,{embree.parent}", "-pthread"], check=True)
    return output


class Embree:
    """One Embree device for all hand-written kernels of a run."""

    def __init__(self, threads: int) -> None:
        self.threads = threads
        self.ffi = cffi.FFI()
        self.ffi.cdef(re.sub(r"^#.*$", "", (KERNELS / "job.h").read_text(), flags=re.MULTILINE) + _SCENE_FUNCTIONS)
        # never unloaded: threads of Embree may still run its code when Python ends
        keep = self.ffi.RTLD_NOW | os.RTLD_NODELETE
        self.library: Any = self.ffi.dlopen(str(build("scene", compilers()[0])), keep)
        self.device = self.library.bench_device_create(f"threads={threads}".encode())

    def pointer(self, array: NDArray[Any], type_name: str) -> Any:
        """The address of a C-contiguous array."""
        return self.ffi.cast(type_name, array.ctypes.data)

    def kernel(self, source: str, function: str, compiler: str, extra_flags: tuple[str, ...] = ()) -> Any:
        """The function of a built kernel library."""
        ffi = cffi.FFI()
        ffi.cdef(f"void {function}(void* job);")
        library: Any = ffi.dlopen(str(build(source, compiler, extra_flags)))
        return getattr(library, function), library


def sphere_boxes(spheres: Floats) -> Floats:
    """Six floats per sphere: the boxes that Embree and ours build over."""
    return np.concatenate([spheres[:, :3] - spheres[:, 3:], spheres[:, :3] + spheres[:, 3:]], 1).astype(np.float32)


def floor_box(size: float) -> Floats:
    """The box of the floor."""
    return np.array([[-size, -1e-3, -size, size, 1e-3, size]], np.float32)


class EmbreeScene:
    """An Embree scene with the geometries of `scene`, and the arrays that it needs."""

    def __init__(self, embree: Embree, scene: Scene, with_light: bool) -> None:
        self.embree = embree
        self.scene = scene
        self.keep: list[NDArray[Any]] = []
        library, device = embree.library, embree.device
        self.handle = library.bench_scene_create(device)
        if len(scene.points):
            self._add_shapes(scene.points, scene.segments)
        elif len(scene.spheres):
            self._add_custom(sphere_boxes(scene.spheres))
            self._add_custom(floor_box(scene.floor_size))
        else:
            self._add_triangles(scene.vertices, scene.triangles)
        if with_light:
            self._add_triangles(scene.light.vertices, QUAD_TRIANGLES)
        library.bench_scene_commit(self.handle, embree.threads == 1)

    def _add_triangles(self, vertices: Floats, triangles: NDArray[np.uint32]) -> None:
        vertex_pointer, index_pointer = self.embree.pointer(vertices, "float*"), self.embree.pointer(triangles, "unsigned*")
        self.embree.library.bench_scene_add_triangles(
            self.embree.device, self.handle, vertex_pointer, len(vertices), index_pointer, len(triangles)
        )

    def _add_shapes(self, points: Floats, segments: NDArray[np.uint32]) -> None:
        firsts = self.embree.pointer(segments, "unsigned*") if len(segments) else self.embree.ffi.NULL
        pointer = self.embree.pointer(points, "float*")
        self.embree.library.bench_scene_add_shapes(self.embree.device, self.handle, pointer, len(points), firsts, len(segments))

    def _add_custom(self, boxes: Floats) -> None:
        self.keep.append(boxes)
        self.embree.library.bench_scene_add_custom(self.embree.device, self.handle, self.embree.pointer(boxes, "float*"), len(boxes))


@dataclass
class HandWritten:
    """One form of a workload, built with one compiler, ready to run."""

    name: str
    function: Any
    job: Any
    image: Floats
    keep: tuple[Any, ...]

    def run(self) -> float:
        """Renders once; the seconds that it took."""
        self.function(self.job)
        return float(self.job.seconds)

    @property
    def rays(self) -> int:
        """Rays of the last run."""
        return int(self.job.rays)


def _fill(ffi_array: Any, values: Any) -> None:
    for i, value in enumerate(values):
        ffi_array[i] = float(value)


def make_job(embree: Embree, built: EmbreeScene, workload: Workload, threads: int, image: Floats) -> Any:
    """The BenchJob of a workload."""
    scene, pointer = built.scene, embree.pointer
    width, height = workload.launch_size
    job = embree.ffi.new("BenchJob*")
    job.scene = built.handle
    job.image = pointer(image, "float*")
    job.width, job.height, job.skip, job.threads = width, height, workload.skip, threads
    for name in ("eye", "u", "v", "w"):
        _fill(getattr(job, name), getattr(scene.camera, name))
    _fill(job.pixel, (np.float32(2.0 / width), np.float32(2.0 / width)))
    job.triangles = pointer(scene.triangles, "uint32_t*")
    job.vertices, job.normals = pointer(scene.vertices, "float*"), pointer(scene.normals, "float*")
    job.materialOf, job.uvs = pointer(scene.material_of, "uint32_t*"), pointer(scene.uvs, "float*")
    job.texels = pointer(scene.texels, "uint8_t*")
    job.texelHeight, job.texelWidth = scene.texels.shape[:2]
    job.spheres = pointer(scene.spheres, "float*")
    for i in range(MATERIALS):
        material = job.materials[i]
        _fill(material.color, scene.colors[i])
        material.metallic, material.roughness, material.specular, material.sheen, material.clearcoat = map(float, scene.surfaces[i])
        material.kind = int(scene.kinds[i])
    light = job.light
    for c_name, name in (("corner", "corner"), ("edgeU", "edge_u"), ("edgeV", "edge_v"), ("n", "n"), ("radiance", "radiance")):
        _fill(getattr(light, c_name), getattr(scene.light, name))
    light.area = scene.light.area
    _fill(job.sky, scene.sky)
    _fill(job.sun, SUN)
    job.radius, job.offset, job.noiseScale, job.floorSize = scene.radius, scene.offset, scene.noise_scale, scene.floor_size
    return job


def hand_written(
    embree: Embree, built: EmbreeScene, workload: Workload, form: str, compiler: str, threads: int, tuned: bool = False
) -> HandWritten:
    """The form `form` of a workload, built with `compiler`; `tuned` with rays stored as Embree loads them (see kernels/trace.h)."""
    width, height = workload.launch_size
    image = np.zeros((height, width, 4), np.float32)
    function, library = embree.kernel(workload.source, form, compiler, ("-DBENCH_TUNED",) if tuned else ())
    job = make_job(embree, built, workload, threads, image)
    return HandWritten(f"{form}{' tuned' if tuned else ''} {compiler}", function, job, image, (library, built))
