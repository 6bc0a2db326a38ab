"""Area G: stack sizes, their formulas, and stacks that are used up."""

from __future__ import annotations

import threading
from typing import Any

import numpy as np
import pytest
from harness import SHADERS
from shaders import nesting as shader

import optixc as ox

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
OVERFLOW, TRACE_DEPTH = ox.ExceptionFlags.STACK_OVERFLOW, ox.ExceptionFlags.TRACE_DEPTH
INTERPRETED = 0
MODES = [1, 8, 16]


class Nesting:
    """One kind of nesting in a context of its own."""

    def __init__(self, kind: str, simd: int, flags: int = 0, depth: int = 31, **context: Any) -> None:
        self.is_interpreted = simd == INTERPRETED
        self.context = ox.DeviceContext(**context)
        module, create = self.context.module_create(SHADERS / "nesting.py"), self.context.program_group_create
        self.raygen = create(raygen=module[f"__raygen__{kind}"])
        self.hit = create(closesthit=module["__closesthit__again"])
        self.exception = create(exception=module["__exception__note"])
        slot = f"{kind}_callable"
        self.callables = [] if kind in ("traces", "traverses") else [create(**{slot: module[f"__{slot}__down"]})]
        options = ox.PipelineCompileOptions(exception_flags=flags, uses_motion_blur=kind != "direct")
        self.pipeline = self.context.pipeline_create([self.raygen, self.hit, self.exception, *self.callables], max_trace_depth=depth,
                                                     simd=max(simd, 1), options=options)
        self.scene = self.context.accel_build([ox.BuildInputTriangles(CORNERS)])

    def run(self, depths: list[int]) -> tuple[list[int], list[int]]:
        """What each launch index reached, and the exception that ended it."""
        out, codes = np.full(len(depths), 999, np.uint32), np.zeros(len(depths), np.int32)
        params = shader.Params(scene=self.scene, out=out, codes=codes, depth=np.array(depths, np.uint32))
        table = ox.ShaderBindingTable(raygen=self.raygen.record(), hitgroup=[self.hit.record()], exception=self.exception.record(),
                                      callables=[group.record() for group in self.callables])
        if self.is_interpreted:
            for index in range(len(depths)):
                ox.interpret(self.pipeline, params, table, len(depths), index)
        else:
            self.pipeline.launch(params, table, len(depths))
        return out.tolist(), codes.tolist()


def test_T071_a_raygen_group_needs_raygen_stack_only() -> None:
    nesting = Nesting("traces", 1)
    sizes = nesting.raygen.get_stack_size()
    assert sizes.css_rg > 0
    assert sizes == ox.StackSizes(css_rg=sizes.css_rg)
    assert nesting.hit.get_stack_size(nesting.pipeline).css_ch > 0
    context = ox.DeviceContext()
    module = context.module_create(SHADERS / "nesting.py")
    alone = context.program_group_create(raygen=module["__raygen__traces"])
    assert alone.get_stack_size().css_rg > 0
    with pytest.raises(ox.InvalidValueError, match="is not part of this pipeline"):
        alone.get_stack_size(nesting.pipeline)


def test_T072_accumulation_takes_the_larger() -> None:
    class Known:
        def __init__(self, rg: int, ch: int) -> None:
            self.sizes = ox.StackSizes(css_rg=rg, css_ch=ch)

        def get_stack_size(self, pipeline: Any = None) -> ox.StackSizes:
            return self.sizes

    total = ox.StackSizes()
    for group in (Known(10, 20), Known(15, 5)):
        ox.util_accumulate_stack_sizes(group, total)
    assert total == ox.StackSizes(css_rg=15, css_ch=20)


SIZES = ox.StackSizes(css_rg=100, css_ms=40, css_ch=200, css_ah=50, css_is=60, css_cc=30, dss_dc=20)


def test_T073_the_formula_of_the_guide() -> None:
    assert ox.util_compute_stack_sizes(SIZES, 2, 2, 3) == (60, 60, 680)
    assert ox.util_compute_stack_sizes(SIZES, 0, 2, 3)[2] == 160
    # The plain sum of the guide's first listing is an upper bound: RG + tree + depth x (CH + tree) + IS + AH.
    plain = 100 + 60 + 2 * (200 + 60) + 60 + 50
    assert (plain, plain >= ox.util_compute_stack_sizes(SIZES, 2, 2, 3)[2]) == (790, True)
    wide = ox.StackSizes(css_rg=100, css_ms=10, css_ch=10, css_ah=500, css_is=600)
    assert ox.util_compute_stack_sizes(wide, 1, 0, 0)[2] == 1200


def test_T074_callables_told_apart_and_trees() -> None:
    assert ox.util_compute_stack_sizes_dc_split(SIZES, 16, 48, 2, 2, 2, 1) == (32, 48, 680)
    other = ox.StackSizes(**{**vars(SIZES), "dss_dc": 1 << 20})
    assert ox.util_compute_stack_sizes_dc_split(other, 16, 48, 2, 2, 2, 1) == (32, 48, 680)
    other = ox.StackSizes(**{**vars(SIZES), "css_cc": 1 << 20})
    assert ox.util_compute_stack_sizes_css_cc_tree(other, max(3 * 100, 2 * 200), 2, 3)[2] == 100 + 400 + 600 + 600
    assert ox.util_compute_stack_sizes_css_cc_tree(SIZES, 400, 2, 3) == (60, 60, 100 + 400 + 600 + 600)


def test_T075_the_simple_path_tracer() -> None:
    class Known:
        def __init__(self, **sizes: int) -> None:
            self.sizes = ox.StackSizes(**sizes)

        def get_stack_size(self, pipeline: Any = None) -> ox.StackSizes:
            return self.sizes

    raygen, miss_1, miss_2 = Known(css_rg=64), Known(css_ms=32), Known(css_ms=16)
    hit_1, hit_2 = Known(css_ch=320), Known(css_ch=48)
    assert ox.util_compute_stack_sizes_simple_path_tracer(raygen, miss_1, [hit_1], miss_2, [hit_2]) == (0, 0, 432)
    assert ox.util_compute_stack_sizes_simple_path_tracer(raygen, miss_1, [], miss_2, []) == (0, 0, 64 + 32)
    total = ox.StackSizes()
    for group in (raygen, miss_1, miss_2, hit_1, hit_2):
        ox.util_accumulate_stack_sizes(group, total)
    assert ox.util_compute_stack_sizes(total, 2, 0, 0) == (0, 0, 704)


def test_T076_wrong_arguments() -> None:
    with pytest.raises(ox.InvalidValueError, match=r"begin with ox.StackSizes\(\)"):
        ox.util_compute_stack_sizes(None, 1, 0, 0)
    with pytest.raises(ox.InvalidValueError, match="closesthit_1 takes a list"):
        group = Nesting("traces", 1).raygen
        ox.util_compute_stack_sizes_simple_path_tracer(group, group, None, group, [])
    with pytest.raises(ox.InvalidValueError, match="max_trace_depth must be"):
        ox.util_compute_stack_sizes(SIZES, -1, 0, 0)


@pytest.mark.parametrize("arguments", [(0, 0, -1, 1), (0, 0, 1 << 30, 1), (0, 0, 100, 0), (0, 0, 100, 32), ("x", 0, 100, 1)])
def test_wrong_stack_sizes_are_refused(arguments: tuple[Any, ...]) -> None:
    with pytest.raises(ox.InvalidValueError):
        Nesting("traces", 1).pipeline.set_stack_size(*arguments)


@pytest.mark.parametrize("simd", MODES)
def test_T077_a_stack_that_is_16_bytes_too_small(simd: int) -> None:
    nesting = Nesting("traces", simd, flags=OVERFLOW, depth=5)
    total = ox.StackSizes()
    for group in (nesting.raygen, nesting.hit, nesting.exception):
        ox.util_accumulate_stack_sizes(group, total, nesting.pipeline)
    *direct, continuation = ox.util_compute_stack_sizes(total, 5, 0, 0)
    depths = [5 if index % 3 == 0 else index % 3 for index in range(64)]
    nesting.pipeline.set_stack_size(*direct, continuation)
    assert nesting.run(depths) == (depths, [0] * 64)
    nesting.pipeline.set_stack_size(*direct, continuation - 16)
    reached, codes = nesting.run(depths)
    assert codes == [-1 if depth == 5 else 0 for depth in depths]
    assert reached == [999 if depth == 5 else depth for depth in depths]


@pytest.mark.parametrize("simd", MODES)
def test_T078_nobody_has_to_set_stack_sizes(simd: int) -> None:
    nesting = Nesting("traces", simd)
    depths = [index % 32 for index in range(5000)]
    assert nesting.run(depths)[0] == depths


def test_depth_31_on_a_thread_with_a_small_stack() -> None:
    nesting = Nesting("traces", 1, threads=1)
    threading.stack_size(1 << 18)
    try:
        found: list[Any] = []
        thread = threading.Thread(target=lambda: found.append(nesting.run([31] * 100)[0]))
        thread.start()
        thread.join()
    finally:
        threading.stack_size(0)
    assert found == [[31] * 100]


@pytest.mark.parametrize("kind", ["direct", "continuation"])
@pytest.mark.parametrize("simd", MODES)
def test_callables_without_end_are_a_stack_overflow(kind: str, simd: int) -> None:
    nesting = Nesting(kind, simd, flags=OVERFLOW)
    endless = 4_000_000_000
    reached, codes = nesting.run([3, endless, 100, endless])
    assert codes == [0, -1, 0, -1]
    assert reached == [2 * 3 - 1, 999, 2 * 100 - 1, 999]
    with pytest.raises(ox.LaunchFailureError, match="stack is used up") as caught:
        Nesting(kind, simd).run([3, endless])
    assert caught.value.fault_code == -1
    assert caught.value.launch_index == (1, 0, 0)


def test_T079_depths_of_the_graph() -> None:
    single = ox.PipelineCompileOptions(traversable_graph_flags=ox.TraversableGraphFlags(2))
    context = ox.DeviceContext()
    group = context.program_group_create(raygen=context.module_create(SHADERS / "nesting.py")["__raygen__traces"])
    context.pipeline_create([group]).set_stack_size(0, 0, 1000, 31)
    context.pipeline_create([group], options=single).set_stack_size(0, 0, 1000, 2)
    with pytest.raises(ox.InvalidValueError, match="single level only"):
        context.pipeline_create([group], options=single).set_stack_size(0, 0, 1000, 3)


def chain(context: ox.DeviceContext, kind: str) -> tuple[Any, int]:
    """A scene and how many traversables lie one below the other in it."""
    gas = context.accel_build([ox.BuildInputTriangles(CORNERS)])
    place = np.eye(4, dtype=np.float32)[:3]
    match kind:
        case "gas":
            return gas, 1
        case "ias":
            return context.accel_build([ox.BuildInputInstances([ox.Instance(gas)])]), 2
        case "moving ias":
            motion = ox.MotionOptions(num_keys=2)
            return context.accel_build([ox.BuildInputInstances([ox.Instance(gas)])], motion_options=motion), 2
        case "transform":
            moving = context.matrix_motion_transform(gas, [place, place], ox.MotionOptions(num_keys=2))
            return context.accel_build([ox.BuildInputInstances([ox.Instance(moving)])]), 3
        case _:
            scene = gas
            for _ in range(30):
                scene = context.accel_build([ox.BuildInputInstances([ox.Instance(scene)])])
            return scene, 31


@pytest.mark.parametrize("program", ["traces", "traverses"])
@pytest.mark.parametrize("simd", [*MODES, INTERPRETED])
def test_T079_a_graph_deeper_than_configured_is_an_exception(simd: int, program: str) -> None:
    nesting = Nesting(program, simd, flags=TRACE_DEPTH, depth=1)
    depths = [index % 2 for index in range(40)]
    for kind in ("gas", "ias", "moving ias", "transform", "longest"):
        nesting.scene, needed = chain(nesting.context, kind)
        for allowed in {1, 2, 3, 31, needed}:
            nesting.pipeline.set_stack_size(0, 0, 1 << 20, allowed)
            reached, codes = nesting.run(depths)
            assert codes == [-2 if depth and allowed < needed else 0 for depth in depths]
            assert reached == [999 if code else depth for depth, code in zip(depths, codes, strict=True)]


@pytest.mark.parametrize("simd", MODES)
def test_graph_depths_without_the_flag(simd: int) -> None:
    """Without it nothing is looked at, except in validation, where the launch fails."""
    for validation in (False, True):
        nesting = Nesting("traces", simd, depth=1, validation=validation)
        nesting.scene, _ = chain(nesting.context, "ias")
        assert nesting.run([1, 0, 1]) == ([1, 0, 1], [0, 0, 0])
        nesting.pipeline.set_stack_size(0, 0, 1 << 20, 1)
        if validation:
            with pytest.raises(ox.ValidationFailureError, match=r"nesting\.py:\d+: .*deeper than max_traversable_graph_depth") as caught:
                nesting.run([1, 0, 1])
            assert caught.value.fault_code == -3
        else:
            assert nesting.run([1, 0, 1]) == ([1, 0, 1], [0, 0, 0])
