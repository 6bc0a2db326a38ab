"""One context per mode and the pipelines that the conformance tests of that mode share.

A mode is a way to run programs: scalar code, 8 or 16 lanes, or the interpreter. Pipelines are made once per mode and kept; what a mode
cannot do is found out by asking the API, never by looking at the machine.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import optixc as ox

SHADERS = Path(__file__).parent / "shaders"

MODES = {"scalar": 1, "simd8": 8, "simd16": 16, "interpreter": 1}
HIT_PROGRAMS = {"tri": ("recorder.py", "triangle", None), "custom": ("recorder.py", "custom", "__intersection__custom"),
                "sphere": ("recorder_spheres.py", "sphere", None), "curve": ("recorder_curves.py", "curve", None)}
PROBE_OF_MODE = """
import optixc as ox


@ox.program
def __raygen__nothing():
    pass
"""


class Harness:
    """A context in one mode; modules and pipelines are cached by what they are made of."""

    def __init__(self, mode: str, context: ox.DeviceContext) -> None:
        self.mode = mode
        self.context = context
        self.kept: dict[Any, Any] = {}  # program groups of a test file, by a name of its own
        self._modules: dict[str, Any] = {}
        self._pipelines: dict[Any, Any] = {}

    def available(self, folder: Path) -> bool:
        """Whether the API can make and run a pipeline in this mode."""
        if self.mode == "interpreter" and not hasattr(ox, "interpret"):
            return False
        path = folder / "nothing.py"
        path.write_text(PROBE_OF_MODE)
        try:
            module = self.context.module_create(path)
            self.context.pipeline_create([self.context.program_group_create(raygen=module["__raygen__nothing"])],
                                         simd=MODES[self.mode])
        except (ox.OptixError, NotImplementedError):
            return False
        return True

    def module(self, name: str) -> Any:
        """The module of a shader file of this folder."""
        if name not in self._modules:
            self._modules[name] = self.context.module_create(SHADERS / name)
        return self._modules[name]

    def pipeline(self, key: Any, groups: Iterable[Any], **options: Any) -> Any:
        """The pipeline kept under `key`, made of `groups` the first time."""
        if key not in self._pipelines:
            self._pipelines[key] = self.context.pipeline_create(list(groups), simd=MODES[self.mode], **options)
        return self._pipelines[key]

    def launch(self, pipeline: Any, params: Any, sbt: Any, width: int, height: int = 1, depth: int = 1) -> None:
        """Run the pipeline, or interpret every launch index of it."""
        if self.mode != "interpreter":
            pipeline.launch(params, sbt, width=width, height=height, depth=depth)
            return
        for z in range(depth):
            for y in range(height):
                for x in range(width):
                    ox.interpret(pipeline, params, sbt, (width, height, depth), (x, y, z))

    def recorder(self, kinds: tuple[str, ...], motion: bool, micromaps: bool) -> tuple[dict[Any, Any], Any]:
        """The event recorder for these kinds of hit groups: its groups by role or (kind, closest hit, any hit), and the pipeline."""
        key = ("recorder", kinds, motion, micromaps)
        if key not in self.kept:
            self.kept[key] = self._recorder_groups(kinds)
        groups = self.kept[key]
        options = ox.PipelineCompileOptions(uses_motion_blur=motion, allow_opacity_micromaps=micromaps)
        return groups, self.pipeline(key, groups.values(), options=options)

    def _recorder_groups(self, kinds: tuple[str, ...]) -> dict[Any, Any]:
        create = self.context.program_group_create
        base = self.module("recorder.py")
        groups: dict[Any, Any] = {"raygen": create(raygen=base["__raygen__main"]), "miss": create(miss=base["__miss__log"])}
        for kind in kinds:
            file, stem, intersection = HIT_PROGRAMS[kind]
            module = self.module(file)
            for closesthit in (True, False):
                for anyhit in (True, False):
                    groups[kind, closesthit, anyhit] = create(
                        closesthit=module[f"__closesthit__{stem}"] if closesthit else None,
                        anyhit=module[f"__anyhit__{stem}"] if anyhit else None,
                        intersection=module[intersection] if intersection else None)
        return groups
