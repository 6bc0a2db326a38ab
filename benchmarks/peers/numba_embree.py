"""Numba with rtcIntersect16 called through its address: what a Python programmer can write by hand."""

from __future__ import annotations

import ctypes
import importlib.util
from collections.abc import Callable
from typing import Any

import numpy as np

from benchmarks.handwritten import Embree, EmbreeScene, embree_library
from benchmarks.peers.frame import Frame
from benchmarks.scenes import IMAGE_SIZE, mesh_scene

LANES = 16
# offsets in floats of the fields of RTCRayHit16
ORIGIN, NEAR, DIRECTION, FAR, MASK, U, V, PRIMITIVE, GEOMETRY, INSTANCE = (16 * n for n in (0, 3, 4, 8, 9, 15, 16, 17, 18, 19))
COHERENT = 1 << 16

if importlib.util.find_spec("numba") is not None:
    import numba

SHADER = True


def missing() -> str | None:
    """What has to be installed."""
    return None if importlib.util.find_spec("numba") else "numba is not installed"


def _kernel(intersect: Any) -> Any:
    @numba.njit(parallel=True, fastmath=False)
    def render(scene, arguments, eye, u, v, w, triangles, normals, image):  # type: ignore[no-untyped-def]
        size = image.shape[0]
        blocks = size // 4
        for row in numba.prange(blocks):
            storage = np.empty(16 * 21 + 16, np.float32)
            start = (64 - storage.ctypes.data % 64) % 64 // 4
            packet = storage[start : start + 16 * 21]
            words = packet.view(np.uint32)
            valid_storage = np.full(32, -1, np.int32)
            valid = valid_storage[(64 - valid_storage.ctypes.data % 64) % 64 // 4 :]
            for column in range(blocks):
                for lane in range(16):
                    x = (np.float32(column * 4 + lane % 4) + np.float32(0.5)) * np.float32(2.0 / size) - np.float32(1.0)
                    y = np.float32(1.0) - (np.float32(row * 4 + lane // 4) + np.float32(0.5)) * np.float32(2.0 / size)
                    dx = x * u[0] + y * v[0] + w[0]
                    dy = x * u[1] + y * v[1] + w[1]
                    dz = x * u[2] + y * v[2] + w[2]
                    scale = np.float32(1.0) / np.sqrt(dx * dx + dy * dy + dz * dz)
                    packet[lane], packet[16 + lane], packet[32 + lane] = eye[0], eye[1], eye[2]
                    packet[NEAR + lane] = np.float32(0.0)
                    packet[DIRECTION + lane] = dx * scale
                    packet[DIRECTION + 16 + lane] = dy * scale
                    packet[DIRECTION + 32 + lane] = dz * scale
                    packet[DIRECTION + 48 + lane] = np.float32(0.0)
                    packet[FAR + lane] = np.float32(1e16)
                    words[MASK + lane] = 0xFFFFFFFF
                    words[MASK + 32 + lane] = 0
                    words[GEOMETRY + lane] = 0xFFFFFFFF
                    words[INSTANCE + lane] = 0xFFFFFFFF
                intersect(valid.ctypes.data, scene, packet.ctypes.data, arguments)
                for lane in range(16):
                    pixel = image[row * 4 + lane // 4, column * 4 + lane % 4]
                    if words[GEOMETRY + lane] == 0xFFFFFFFF:
                        pixel[0] = pixel[1] = pixel[2] = np.float32(0.0)
                    else:
                        a, b = packet[U + lane], packet[V + lane]
                        c = np.float32(1.0) - a - b
                        triangle = triangles[words[PRIMITIVE + lane]]
                        n0, n1, n2 = normals[triangle[0]], normals[triangle[1]], normals[triangle[2]]
                        nx = c * n0[0] + a * n1[0] + b * n2[0]
                        ny = c * n0[1] + a * n1[1] + b * n2[1]
                        nz = c * n0[2] + a * n1[2] + b * n2[2]
                        scale = np.float32(0.5) / np.sqrt(nx * nx + ny * ny + nz * nz)
                        pixel[0] = nx * scale + np.float32(0.5)
                        pixel[1] = ny * scale + np.float32(0.5)
                        pixel[2] = nz * scale + np.float32(0.5)
                    pixel[3] = np.float32(1.0)

    return render


def make(frame: Frame, threads: int) -> Callable[[], Any]:
    """The scene of the hand-written kernels; a ctypes function, which Numba calls by its address."""
    numba.set_num_threads(threads)
    library = ctypes.CDLL(str(embree_library()))
    intersect = library.rtcIntersect16
    intersect.argtypes = [ctypes.c_size_t] * 4
    intersect.restype = None
    embree = Embree(threads)
    built = EmbreeScene(embree, mesh_scene("sibenik") if len(frame.vertices) < 100_000 else mesh_scene("dragon"), with_light=False)
    scene = int(embree.ffi.cast("uintptr_t", built.handle))
    # flags, feature mask, context, filter, intersect, minimal width
    arguments = np.zeros(10, np.uint32)
    arguments[:2] = COHERENT, 0xFFFFFFFF
    image = np.zeros((IMAGE_SIZE, IMAGE_SIZE, 4), np.float32)
    camera = frame.camera
    render = _kernel(intersect)

    def run() -> Any:
        render(scene, arguments.ctypes.data, camera.eye, camera.u, camera.v, camera.w, frame.triangles, frame.normals, image)
        return built, image

    run()
    if image[..., :3].max() <= 0.0:
        raise RuntimeError("the image is empty")
    return run
