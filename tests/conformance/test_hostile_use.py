"""Objects used where they should not be: from several threads while they go away, copied, pickled, after their time. Errors have names, and
nothing ends the process or waits for ever."""

from __future__ import annotations

import copy
import gc
import pickle
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from harness import SHADERS
from shaders import missing_arrays, read_only

import optixc as ox
from optixc.stdlib import random

COUNT = 1 << 14
MODES = [1, 8, 16]


class Scene:
    """A context with a pipeline that can be launched."""

    def __init__(self, simd: Any = "auto") -> None:
        self.context = ox.DeviceContext()
        self.module = self.context.module_create(SHADERS / "read_only.py")
        self.group = self.context.program_group_create(raygen=self.module["__raygen__read"])
        self.pipeline = self.context.pipeline_create([self.group], simd=simd)
        tables = read_only.Tables(np.zeros(COUNT, np.float32), np.zeros(COUNT, np.float32))
        self.params = read_only.Params(np.zeros(COUNT, np.float32), np.ones(COUNT, np.float32), tables, np.zeros(1, np.uint32))
        self.table = ox.ShaderBindingTable(self.group.record(read_only.Data(np.zeros(COUNT, np.float32), np.zeros(COUNT, np.float32))))

    def launch(self) -> None:
        self.pipeline.launch(self.params, self.table, width=COUNT)


def at_once(tasks: list[Callable[[], None]]) -> list[BaseException]:
    """Runs the tasks in threads of their own; what they raised."""
    raised: list[BaseException] = []

    def guarded(task: Callable[[], None]) -> None:
        try:
            task()
        except BaseException as error:
            raised.append(error)

    threads = [threading.Thread(target=guarded, args=(task,)) for task in tasks]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return raised


@pytest.mark.parametrize("what", ["pipeline", "context"])
@pytest.mark.parametrize("simd", MODES)
def test_destroyed_while_others_launch(simd: int, what: str) -> None:
    scene = Scene(simd)
    started = threading.Barrier(4)

    def launch_for_ever() -> None:
        scene.launch()
        started.wait()
        while True:
            scene.launch()

    def destroy() -> None:
        started.wait()
        getattr(scene, what).destroy()

    raised = at_once([launch_for_ever, launch_for_ever, launch_for_ever, destroy])
    expected = (ox.InvalidOperationError, "this pipeline was destroyed"), (ox.InvalidDeviceContextError, "this context was destroyed")
    kind, text = expected[what == "context"]
    assert [(type(error), str(error)) for error in raised] == [(kind, text)] * 3


def test_calls_of_a_destroyed_pipeline() -> None:
    scene = Scene()
    pipeline = scene.pipeline
    pipeline.destroy()
    calls: list[Callable[[], Any]] = [
        scene.launch, lambda: pipeline.program_number("x"), lambda: pipeline.set_stack_size(0, 0, 100),
        lambda: ox.interpret(pipeline, scene.params, scene.table, 4, 0), lambda: pipeline.pack_header(scene.group, 0)]
    for call in calls:
        with pytest.raises(ox.InvalidOperationError, match="this pipeline was destroyed"):
            call()
    assert pipeline.report().lanes > 0
    pipeline.destroy()


def test_objects_of_this_process_are_not_copied() -> None:
    """A copy that went away would free what the original still uses."""
    scene = Scene()
    accel = scene.context.accel_build([ox.BuildInputTriangles(np.eye(3, dtype=np.float32))])
    transform = scene.context.static_transform(accel, np.eye(4, dtype=np.float32)[:3])
    owned = [scene.context, scene.module, scene.group, scene.pipeline, scene.table, scene.table.raygen, accel, transform,
             ox.Texture2D(np.zeros((2, 2), np.float32))]
    for one in owned:
        for how in (copy.copy, copy.deepcopy, pickle.dumps):
            with pytest.raises(TypeError, match=f"this {type(one).__name__} cannot be copied or pickled"):
                how(one)
    gc.collect()
    scene.launch()
    assert accel.aabb.shape == (2, 3)


def test_what_a_shader_file_defines_is_copied_and_pickled() -> None:
    """Functions by their names, as Python's own; a process pool can so call a helper."""
    for one in (random.pcg32_float, missing_arrays.__raygen__read):
        assert copy.deepcopy(one) is one and pickle.loads(pickle.dumps(one)) is one
    for parameters in (copy.deepcopy(missing_arrays.params), pickle.loads(pickle.dumps(missing_arrays.params))):
        with pytest.raises(ox.InvalidOperationError, match=r"Params\.scene cannot be read here"):
            _ = parameters.scene


def test_parameters_are_copied_and_pickled() -> None:
    """Their copies stand on memory of their own; arrays of structs, which hold addresses, are pickled as the structs."""
    ones = np.ones(4, np.float32)
    materials = [missing_arrays.Material(number * ones, float(number)) for number in (1.0, 2.0)]
    params = missing_arrays.Params(ones.copy(), ones.reshape(1, 4), missing_arrays.Inner(ones, None), materials, materials, ones, 0)
    made = [copy.copy(params), copy.deepcopy(params), pickle.loads(pickle.dumps(params))]
    del params, materials
    gc.collect()
    for one in made:
        for held in (one.materials, one.pair):
            assert [source.texels.tolist() for source in held.sources] == [[1.0] * 4, [2.0] * 4]
            assert [int(item["texels"]["data"]) for item in held] == [source.texels.ctypes.data for source in held.sources]
    with pytest.raises(TypeError, match="pickle the structs"):
        pickle.dumps(made[0].materials[:1])


def test_two_contexts_in_several_threads() -> None:
    scenes = [Scene(), Scene()]

    def launch_often(scene: Scene) -> None:
        for _ in range(100):
            scene.launch()

    assert at_once([lambda scene=scene: launch_often(scene) for scene in (*scenes, *scenes)]) == []


def test_modules_and_pipelines_from_several_threads() -> None:
    context = ox.DeviceContext()
    made: list[Any] = []

    def make(simd: int) -> None:
        for _ in range(3):
            module = context.module_create(SHADERS / "read_only.py")
            made.append(context.pipeline_create([context.program_group_create(raygen=module["__raygen__read"])], simd=simd))

    assert at_once([lambda simd=simd: make(simd) for simd in (*MODES, *MODES)]) == []
    assert len({pipeline.uid for pipeline in made}) == 18


def test_cycles_of_contexts_and_their_objects_are_collected() -> None:
    for _ in range(5):
        scene = Scene()
        scene.launch()
        scene.context.scene = scene
        scene.pipeline.scene = scene
        scene.table.scene = scene
        del scene
    assert gc.collect() > 0


ENDING = """
import atexit, builtins, sys, threading, time
sys.path.insert(0, {folder!r})
from test_hostile_use import Scene
scene = Scene()
scene.launch()


class Late:
    def __del__(self):
        scene.launch()


def launch_for_ever():
    while True:
        scene.launch()


{then}
"""
ENDINGS = {
    "a thread launches": "threading.Thread(target=launch_for_ever, daemon=True).start()\ntime.sleep(0.2)",
    "at exit": "atexit.register(scene.launch)",
    "after exit": "builtins.late = Late()",
    "an exception": "raise SystemExit(0)",
}


@pytest.mark.parametrize("how", ENDINGS)
def test_the_interpreter_ends_with_live_objects(how: str) -> None:
    script = ENDING.format(folder=str(Path(__file__).parent), then=ENDINGS[how])
    ended = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stderr) == (0, "")
