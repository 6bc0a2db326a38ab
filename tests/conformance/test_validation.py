"""Area B: launches in validation mode. Each fault is told with its code, program, line and launch index, in scalar code and in packets."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from harness import SHADERS
from shaders import faults as shader

import optixc as ox

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
BOX = np.array([[0, 0, 0, 1, 1, 1]], np.float32)
COUNT, GUILTY = 50, 37
LINES = (SHADERS / "faults.py").read_text().splitlines()
GROUPS: dict[str, dict[str, str]] = {
    "faults": {"raygen": "__raygen__faults"}, "pair raygen": {"raygen": "__raygen__pair"},
    "word": {"closesthit": "__closesthit__word"}, "pair": {"closesthit": "__closesthit__pair"},
    "number": {"closesthit": "__closesthit__number"}, "anyhit pair": {"anyhit": "__anyhit__pair"},
    "box pair": {"intersection": "__intersection__pair"},
    "miss": {"miss": "__miss__word"}, "miss pair": {"miss": "__miss__pair"},
    "direct": {"direct_callable": "__direct_callable__one"}, "continuation": {"continuation_callable": "__continuation_callable__one"},
    "float": {"direct_callable": "__direct_callable__float"}, "exception": {"exception": "__exception__note"}}
HITS = ("word", "pair", "number", "anyhit pair", "box pair")


class Checked:
    """A pipeline of all programs, its scenes and its table; one launch index of a launch does what a test asks for."""

    def __init__(self, simd: int, validation: bool = True, **options: Any) -> None:
        self.context = ox.DeviceContext(validation=validation, threads=2, log_callback=lambda *message: None)
        module = self.context.module_create(SHADERS / "faults.py")
        create, build = self.context.program_group_create, self.context.accel_build
        self.groups = {name: create(**{slot: module[one] for slot, one in slots.items()}) for name, slots in GROUPS.items()}
        flags = ox.ExceptionFlags.USER
        self.pipeline = self.context.pipeline_create(list(self.groups.values()), simd=simd, max_trace_depth=2,
                                                     options=ox.PipelineCompileOptions(exception_flags=flags, **options))
        self.gas, self.box = build([ox.BuildInputTriangles(CORNERS)]), build([ox.BuildInputCustomPrimitives(BOX)])
        self.ias = build([ox.BuildInputInstances([ox.Instance(self.gas)])])
        self.deep = build([ox.BuildInputInstances([ox.Instance(self.ias)])])
        stale = build([ox.BuildInputTriangles(CORNERS)])
        self.stale = int(stale.handle)
        stale.destroy()

    def rays(self, wrong: dict[str, Any], scene: Any = None) -> np.ndarray:
        """One ray for each launch index, down onto the triangle; that of the guilty index with other values."""
        rays = np.zeros(COUNT, shader.Ray.dtype)
        rays["origin"], rays["direction"], rays["tmax"] = (0.25, 0.25, 5.0), (0.0, 0.0, -1.0), 100.0
        rays["scene"] = int((scene or self.gas).handle)
        for name, value in wrong.items():
            rays[name][GUILTY] = value
        return rays

    def launch(self, rays: np.ndarray, raygen: str = "faults") -> Any:
        record = {name: group.record() for name, group in self.groups.items()}
        table = ox.ShaderBindingTable(raygen=record[raygen], miss=[record["miss"], record["miss pair"]],
                                      hitgroup=[record[name] for name in HITS], exception=record["exception"],
                                      callables=[record["direct"], record["continuation"], record["float"]])
        params = shader.Params(rays=rays, out=np.zeros(COUNT, np.uint32), numbers=np.zeros((4, 5), np.uint32),
                               codes=np.zeros(COUNT, np.int32))
        self.pipeline.launch(params, table, COUNT)
        return params

    def check_fine(self) -> None:
        """A launch without faults, right after."""
        assert self.launch(self.rays({})).out.tolist() == [11] * COUNT


@pytest.fixture(scope="module", params=[1, 8, 16])
def checked(request: pytest.FixtureRequest) -> Checked:
    return Checked(request.param)


@dataclass(frozen=True)
class Fault:
    """What one launch index does, and what is said about it: OptiX's code, the text, the line that the message points at."""

    code: int
    text: str
    line: str
    wrong: dict[str, Any]
    program: str = "shoot"
    scene: str = "gas"


TRACE = "ox.trace(ray.scene, ray.origin"
NAN, INF = float("nan"), float("inf")
FAULTS = {
    "NaN in the origin": Fault(-9, r"invalid ray.*nan", TRACE, {"origin": (NAN, 0, 0)}),
    "infinite origin": Fault(-9, r"invalid ray.*inf", TRACE, {"origin": (0, -INF, 0)}),
    "NaN in the direction": Fault(-9, "invalid ray", TRACE, {"direction": (0, 0, NAN)}),
    "negative tmin": Fault(-9, r"invalid ray.*-0.5", TRACE, {"tmin": -0.5}),
    "NaN as tmin": Fault(-9, "invalid ray", TRACE, {"tmin": NAN}),
    "infinite tmin": Fault(-9, "invalid ray", TRACE, {"tmin": INF}),
    "NaN as tmax": Fault(-9, "invalid ray", TRACE, {"tmax": NAN}),
    "negative tmin of a traversal": Fault(-9, "invalid ray", "tmin=-1.0)", {"mode": shader.TRAVERSE}, "__raygen__faults"),
    "stale handle": Fault(-5, "no traversable of this context", TRACE, {"scene": "stale"}),
    "made-up handle": Fault(-5, "no traversable of this context", TRACE, {"scene": 123456789}),
    "miss index": Fault(-6, "miss_sbt_index is not below the number of miss records", TRACE,
                        {"miss_index": 2, "origin": (50.0, 50.0, 5.0)}),
    "hit record": Fault(-7, "behind the end of the hit group records", TRACE, {"sbt_offset": 5}),
    "payload of a closest hit": Fault(-33, "another payload", TRACE, {"sbt_offset": 1}),
    "payload of a closest hit of no trace": Fault(-33, "another payload", TRACE, {"sbt_offset": 2}),
    "payload of an any hit": Fault(-33, "another payload", TRACE, {"sbt_offset": 3}),
    "payload of an intersection": Fault(-33, "another payload", TRACE, {"sbt_offset": 4, "scene": "box"}),
    "payload of a miss": Fault(-33, "another payload", TRACE, {"miss_index": 1, "origin": (50.0, 50.0, 5.0)}),
    "nesting": Fault(-2, "nest deeper than max_trace_depth", TRACE, {"mode": shader.NESTED}),
    "read": Fault(2, r"index out of range \(0, 5\)", "params.numbers[0, ray.index]", {"mode": shader.READ, "index": 5}, "__raygen__faults"),
    "read in a helper": Fault(2, r"index out of range \(0, 6\)", "return params.numbers", {"mode": shader.READ_IN_HELPER, "index": 6},
                              "read"),
    "write": Fault(2, r"index out of range \(4, 0\)", "params.numbers[ray.index, 0] = 5", {"mode": shader.WRITE, "index": 4},
                   "__raygen__faults"),
    "atomic": Fault(2, r"index out of range \(0, 4294967295\)", "ox.atomic_add", {"mode": shader.ATOMIC, "index": 0xffffffff},
                    "__raygen__faults"),
    "assertion": Fault(1, "indices are small", "assert ray.index", {"mode": shader.ASSERT, "index": 100}, "__raygen__faults"),
    "callables record": Fault(-12, "callables record", "ox.direct_call(ray.index", {"mode": shader.DIRECT, "index": 3}, "__raygen__faults"),
    "no direct callable": Fault(-13, "callables record", "ox.direct_call(ray.index", {"mode": shader.DIRECT, "index": 1},
                                "__raygen__faults"),
    "no continuation callable": Fault(-14, "callables record", "ox.continuation_call", {"mode": shader.CONTINUATION, "index": 0},
                                      "__raygen__faults"),
    "arguments of a callable": Fault(-10, "other arguments", "ox.direct_call(ray.index", {"mode": shader.DIRECT, "index": 2},
                                     "__raygen__faults"),
}


def line_of(text: str) -> int:
    found = [number for number, line in enumerate(LINES, 1) if text in line]
    assert len(found) == 1, (text, found)
    return found[0]


@pytest.mark.parametrize("name", FAULTS)
def test_T013_T014_faults_are_told(checked: Checked, name: str) -> None:
    fault = FAULTS[name]
    wrong = dict(fault.wrong)
    if isinstance(wrong.get("scene"), str):
        named = getattr(checked, wrong["scene"])
        wrong["scene"] = named if isinstance(named, int) else int(named.handle)
    if wrong.get("scene") == int(checked.box.handle):
        wrong["origin"] = (0.5, 0.5, 5.0)
    with pytest.raises(ox.ValidationFailureError, match=fault.text) as caught:
        checked.launch(checked.rays(wrong))
    error = caught.value
    assert (error.code, error.fault_code, error.launch_index) == (7053, fault.code, (GUILTY, 0, 0))
    assert (error.path, error.program) == (str(SHADERS / "faults.py"), fault.program)
    line = line_of(fault.line)
    assert error.line in (line, line + 1)
    assert str(error).startswith(f"{error.path}:{error.line}: {fault.program}, launch index (37, 0, 0): ")
    checked.check_fine()


def test_T012_a_launch_without_faults_is_done_when_it_returns(checked: Checked) -> None:
    checked.check_fine()
    fine = checked.rays({"direction": (0, 0, 0), "tmax": INF})
    assert checked.launch(fine).out[GUILTY] == 101


def test_T016_exceptions_of_the_user_are_no_faults(checked: Checked) -> None:
    params = checked.launch(checked.rays({"mode": shader.THROW}))
    assert params.codes.tolist() == [77 if index == GUILTY else 0 for index in range(COUNT)]


def test_T016_the_first_fault_is_kept(checked: Checked) -> None:
    rays = checked.rays({})
    rays["tmin"] = -1.0
    rays["mode"], rays["index"] = shader.READ, 100
    with pytest.raises(ox.ValidationFailureError) as caught:
        checked.launch(rays)
    assert caught.value.fault_code == -9
    assert str(caught.value).count("launch index") == 1
    checked.check_fine()


def test_other_launches_go_on(checked: Checked) -> None:
    """Faults of one pipeline while another one, of another context, runs."""
    other = Checked(1)
    failures: list[BaseException] = []
    stop = threading.Event()

    def work() -> None:
        try:
            while not stop.is_set():
                other.check_fine()
        except BaseException as error:
            failures.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    for _ in range(30):
        with pytest.raises(ox.ValidationFailureError):
            checked.launch(checked.rays({"tmin": -1.0}))
    stop.set()
    thread.join()
    assert failures == []


@pytest.mark.parametrize("simd", [1, 8, 16])
def test_without_validation_nothing_is_told(simd: int) -> None:
    loose = Checked(simd, validation=False)
    for name in ("NaN in the origin", "negative tmin", "stale handle", "miss index", "hit record", "payload of a closest hit",
                 "callables record", "arguments of a callable"):
        wrong = dict(FAULTS[name].wrong)
        if wrong.get("scene") == "stale":
            wrong["scene"] = loose.stale
        out = loose.launch(loose.rays(wrong)).out
        assert [value for index, value in enumerate(out.tolist()) if index != GUILTY] == [11] * (COUNT - 1), name


GRAPHS: dict[int, dict[str, tuple[Callable[[Checked], Any], int | None]]] = {
    1: {"gas": (lambda c: c.gas, None), "ias": (lambda c: c.ias, -5), "deep": (lambda c: c.deep, -5)},
    2: {"gas": (lambda c: c.gas, -15), "ias": (lambda c: c.ias, None), "deep": (lambda c: c.deep, -5)},
    3: {"gas": (lambda c: c.gas, None), "ias": (lambda c: c.ias, None), "deep": (lambda c: c.deep, -5)},
    0: {"gas": (lambda c: c.gas, None), "ias": (lambda c: c.ias, None), "deep": (lambda c: c.deep, None)}}


@pytest.mark.parametrize("simd", [1, 8, 16])
@pytest.mark.parametrize("flags", GRAPHS)
def test_X10_traversables_that_the_graph_flags_leave_out(simd: int, flags: int) -> None:
    made = Checked(simd, traversable_graph_flags=ox.TraversableGraphFlags(flags))
    for name, (scene, code) in GRAPHS[flags].items():
        rays = made.rays({}, scene(made))
        if code is None:
            assert made.launch(rays).out.tolist() == [11] * COUNT, name
            continue
        with pytest.raises(ox.ValidationFailureError, match="traversable_graph_flags") as caught:
            made.launch(rays)
        assert caught.value.fault_code == code, name


@pytest.mark.parametrize("simd", [1, 8, 16])
def test_X13_primitives_that_the_type_flags_leave_out(simd: int) -> None:
    flags = ox.PrimitiveTypeFlags
    made = Checked(simd, uses_primitive_type_flags=flags.TRIANGLE | flags.SPHERE)
    spheres = made.context.accel_build([ox.BuildInputSpheres(np.float32([[0.25, 0.25, 0]]), np.float32([1.0]))])
    made.check_fine()
    assert made.launch(made.rays({}, spheres)).out.tolist() == [11] * COUNT
    inside = made.context.accel_build([ox.BuildInputInstances([ox.Instance(made.gas), ox.Instance(made.box)])])
    line = ox.BuildInputCurves(
        ox.PrimitiveType.ROUND_LINEAR, np.float32([[0, 0, 0], [1, 0, 0]]), np.float32([0.1, 0.1]), np.zeros(1, np.uint32)
    )
    for scene in (made.box, inside, made.context.accel_build([line])):
        with pytest.raises(ox.ValidationFailureError, match="uses_primitive_type_flags leave out") as caught:
            made.launch(made.rays({}, scene))
        assert caught.value.fault_code == -8


@pytest.mark.parametrize("simd", [1, 8, 16])
def test_X16_micromaps_that_the_pipeline_does_not_ask_for(simd: int) -> None:
    for allowed in (False, True):
        made = Checked(simd, allow_opacity_micromaps=allowed)
        array = made.context.opacity_micromap_array_build([ox.OpacityMicromap(np.ones(1, np.uint8), 0)])
        mapped = ox.BuildInputTriangles(CORNERS, opacity_micromap=ox.BuildInputOpacityMicromap(array))
        accel = made.context.accel_build([mapped])
        rays = made.rays({}, accel)
        if allowed:
            assert made.launch(rays).out.tolist() == [11] * COUNT
        else:
            with pytest.raises(ox.ValidationFailureError, match="allow_opacity_micromaps"):
                made.launch(rays)
