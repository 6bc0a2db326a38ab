"""The interpreter on threads with small stacks: it does what it is asked for or says what it needs, and never ends the process."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

SHADER = '''
import optixc as ox
from optixc import float3, int32, uint32


@ox.struct
class Params:
    out: ox.Array[int32]
    scene: ox.Traversable


@ox.payload
class Ray:
    depth: int32


params = ox.launch_params(Params)


@ox.program
def __raygen__deep():
    ray = Ray(0)
    ox.trace(params.scene, float3(0.2, 0.2, 0.0), float3(0.0, 0.0, 1.0), payload=ray)
    params.out[0] = ray.depth


@ox.program
def __raygen__called():
    params.out[0] = ox.direct_call(uint32(0), int32(0), result=int32)


@ox.program
def __closesthit__again(ray: Ray):
    ray.depth += 1
    if ray.depth < 31:
        ox.trace(params.scene, float3(0.2, 0.2, 0.0), float3(0.0, 0.0, 1.0), payload=ray)


@ox.program
def __anyhit__keep(ray: Ray):
    if ray.depth < 0:
        ox.ignore_intersection()


@ox.program
def __direct_callable__nested(n: int32) -> int32:
    return n if n >= 30 else ox.direct_call(uint32(0), n + 1, result=int32) + 1


@ox.program
def __exception__e():
    params.out[0] = 1000 * ox.get_exception_code()
'''
HOST = '''
import sys
import threading
from pathlib import Path

import numpy as np

import optixc as ox


@ox.struct
class Params:
    out: ox.Array[ox.int32]
    scene: ox.Traversable


kibibytes, levels, raygen, flags = int(sys.argv[2]), int(sys.argv[3]), sys.argv[4], int(sys.argv[5])
context = ox.DeviceContext(threads=1)
module, create = context.module_create(Path(sys.argv[1])), context.program_group_create
start = create(raygen=module[f"__raygen__{raygen}"])
hit = create(closesthit=module["__closesthit__again"], anyhit=module["__anyhit__keep"])
called, failed = create(direct_callable=module["__direct_callable__nested"]), create(exception=module["__exception__e"])
options = ox.PipelineCompileOptions(exception_flags=flags)
pipeline = context.pipeline_create([start, hit, called, failed], max_trace_depth=31, simd=1, options=options)
table = ox.ShaderBindingTable(start.record(), hitgroup=[hit.record()], callables=[called.record()], exception=failed.record())
scene = context.accel_build([ox.BuildInputTriangles(np.array([[0, 0, 1], [1, 0, 1], [0, 1, 1]], np.float32))])
for _ in range(levels):
    scene = context.accel_build([ox.BuildInputInstances([ox.Instance(scene)])])
out = np.zeros(1, np.int32)


told = []


def run():
    try:
        ox.interpret(pipeline, Params(out=out, scene=scene), table, 1, 0)
        told.append(f"did {out[0]}")
    except ox.LaunchFailureError as error:
        told.append(f"refused {error}")


threading.stack_size(kibibytes << 10)
threads = [threading.Thread(target=run) for _ in range(2)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
print(*told, sep="\\n")
'''


def outcome(folder: Path, kibibytes: int, levels: int = 0, raygen: str = "deep", flags: int = 0) -> str:
    """What both threads say."""
    (folder / "shader.py").write_text(SHADER)
    (folder / "host.py").write_text(HOST)
    words = [str(folder / "shader.py"), str(kibibytes), str(levels), raygen, str(flags)]
    ended = subprocess.run([sys.executable, str(folder / "host.py"), *words], capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr
    first, second = ended.stdout.splitlines()
    assert first == second
    return first


@pytest.mark.parametrize("levels", [0, 20])
@pytest.mark.parametrize("kibibytes", [32, 64, 128, 256])
def test_small_stacks_end_nothing(tmp_path: Path, kibibytes: int, levels: int) -> None:
    found = outcome(tmp_path, kibibytes, levels)
    assert found == "did 31" or "more stack than this thread has; interpret in a thread with a larger one (threading.stack_size)" in found
    assert kibibytes > 64 or found.startswith("refused")


@pytest.mark.parametrize("raygen", ["deep", "called"])
def test_a_mebibyte_is_enough(tmp_path: Path, raygen: str) -> None:
    assert outcome(tmp_path, 1024, 20, raygen) in ("did 31", "did 60")


def test_a_full_stack_is_an_exception_where_the_pipeline_asks_for_it(tmp_path: Path) -> None:
    assert outcome(tmp_path, 96, 0, "deep", 1) == "did -1000"
