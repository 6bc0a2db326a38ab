"""The runner of recorded results knows probes by what stands in them: changed copies are compared or told, never passed over."""

from __future__ import annotations

import copy
import json
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import oracle_files
import oracle_special
import pytest
import test_oracle
from harness import Harness
from oracle_api import misuse_of, not_expressible
from oracle_counts import is_instance_build
from oracle_differences import compare
from oracle_events import record
from oracle_files import Probe
from oracle_keys import not_understood
from oracle_scene import build

PROBES = oracle_files.probes()
TRACED = [probe for probe in PROBES if probe.rays]
SMALL = [probe for probe in TRACED if len(probe.rays) <= 20][::8]
TRIANGLES = {"name": "g", "kind": "GAS", "buildFlags": 16, "emittedAabb": [0, 0, 0, 1, 1, 0], "buildInputs": [
    {"type": "triangles", "vertices": [[0, 0, 0, 1, 0, 0, 0, 1, 0]], "flags": [0], "numSbtRecords": 1}]}
GIVEN = {"root": "g", "o": [0.25, 0.25, 1], "d": [0, 0, -1], "tmin": 0, "tmax": 9, "time": 0, "mask": 255, "flags": 0, "sbtOffset": 0,
         "sbtStride": 1, "missIdx": 0}
RAY = {"in": GIVEN, "returned": 1, "p": [0, 1, 1000, 7000], "nev": 2, "events": [
    {"ev": "AH", "rec": 0, "prim": 0, "hitKind": 254, "tmin": 0, "tmax": 1, "u": 0.25, "v": 0.25},
    {"ev": "CH", "rec": 0, "prim": 0, "hitKind": 254, "ptype": "0x2531", "tmin": 0, "tmax": 1}]}
PLAIN = {"name": "plain", "pipeline": {"usesMotionBlur": False, "traversableGraphFlags": 0, "omm": False}, "scene": [TRIANGLES],
         "hitgroups": [{"kind": "tri", "ctype": "0x0", "endcap": 0, "ch": True, "ah": True, "data": {"id": 0, "ahMode": 0, "ahArg": 0}}],
         "miss": [{"id": 0, "ahMode": 0, "ahArg": 0}], "rays": [RAY]}
MORE = {"ev": "AH", "rec": 0, "prim": 7, "hitKind": 254, "tmin": 0, "tmax": 3}
Change = Callable[[dict[str, Any]], None]


def _plain(change: Change) -> Probe:
    data = copy.deepcopy(PLAIN)
    change(data)
    return Probe("any group", data)


STRANGE: dict[str, Change] = {
    "a key of the probe": lambda data: data.update(validation=True),
    "a key of the pipeline": lambda data: data["pipeline"].update(clusters=1),
    "a kind of traversable": lambda data: data["scene"][0].update(kind="cluster"),
    "a key of a traversable": lambda data: data["scene"][0].update(relocated=True),
    "a type of build input": lambda data: data["scene"][0]["buildInputs"][0].update(type="grids"),
    "a key of a build input": lambda data: data["scene"][0]["buildInputs"][0].update(displacement=[0]),
    "a kind of hit group": lambda data: data["hitgroups"][0].update(kind="grid"),
    "an any-hit mode": lambda data: data["hitgroups"][0]["data"].update(ahMode=8),
    "a key of a ray": lambda data: data["rays"][0]["in"].update(cone=0.5),
    "an event": lambda data: data["rays"][0]["events"].append({"ev": "EX", "rec": 0}),
    "a key of an event": lambda data: data["rays"][0]["events"][0].update(curvature=0.5)}


@pytest.mark.parametrize("name", STRANGE)
def test_what_is_not_known_is_told(name: str) -> None:
    assert not not_understood(_plain(lambda data: None))
    assert len(not_understood(_plain(STRANGE[name]))) == 1


WRONG: dict[str, Change] = {
    "a distance": lambda data: data["rays"][0]["events"][1].update(tmax=1.001),
    "a primitive": lambda data: data["rays"][0]["events"][0].update(prim=1),
    "a miss": lambda data: data["rays"][0].update(events=[{"ev": "MS", "rec": 0, "tmin": 0, "tmax": 9}], nev=1, p=[0, 0, 0, 9000]),
    "a payload": lambda data: data["rays"][0].update(p=[0, 2, 1000, 7000]),
    "one more call": lambda data: data["rays"][0]["events"].insert(0, MORE)}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_record_is_not_excused(harness: Harness, name: str) -> None:
    for change, is_right in ((lambda data: None, True), (WRONG[name], False)):
        probe = _plain(change)
        results = record(harness, probe, build(harness.context, probe.scene))
        _, unexplained = compare(probe, 0, results[0])
        assert (not unexplained) == is_right


def test_names_of_probes_and_groups_decide_nothing() -> None:
    if not PROBES:
        pytest.skip("no recorded results")
    for number, probe in enumerate(PROBES):
        renamed = Probe("group", {**probe.data, "name": f"probe {number}"})
        if probe.rays:
            assert not not_understood(renamed)
        elif is_instance_build(probe):
            assert oracle_special.check_of(renamed) is None  # the name alone says what was done: told
        else:
            assert oracle_special.check_of(renamed) is oracle_special.check_of(probe)


def test_an_unknown_misuse_is_told_and_those_of_a_family_are_made() -> None:
    assert misuse_of("launch_height_0") is not None
    assert misuse_of("stack_graphDepth_77") is not None
    unknown = Probe("15_api_errors", {"name": "cluster_without_templates", "rc": 7001, "rcName": "OPTIX_ERROR_INVALID_VALUE",
                                      "log": "[2][ACCEL] clusters need templates"})
    assert misuse_of(unknown.name) is None
    assert not_expressible(unknown) is None


@pytest.mark.parametrize("probe", SMALL, ids=lambda probe: probe.id)
def test_a_probe_alone_with_some_of_its_rays_in_a_group_of_another_name(harness: Harness, probe: Probe) -> None:
    for rays in (probe.rays[:1], probe.rays[1::2]):
        if rays:
            alone = Probe("some group", {**probe.data, "name": "renamed", "rays": rays})
            test_oracle.test_traced_probe(harness, Counter(), alone)


def test_rays_of_another_form_are_told() -> None:
    for rays in ([1, 2], [{"origin": [0, 0, 0]}], []):
        probe = Probe("group", {**PLAIN, "rays": rays})
        assert not probe.rays
        assert oracle_special.check_of(probe) is None
        assert "rays" in oracle_special.why_not(probe)
    assert not_understood(Probe("group", {**PLAIN, "rays": [{"in": GIVEN}]}))


def test_files_may_be_split_and_one_that_is_none_is_told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    for index in range(2):
        (tmp_path / f"{index}.json").write_text(json.dumps({"group": "one", "probes": [{**PLAIN, "name": f"probe {index}"}]}))
    (tmp_path / "broken.json").write_text("{")
    (tmp_path / "list.json").write_text("[1]")
    monkeypatch.setenv("OXRT_ORACLE_DIR", str(tmp_path))
    found = oracle_files.probes()
    assert [probe.id for probe in found] == ["one-probe 0", "one-probe 1", "broken-broken.json", "list-list.json"]
    assert [oracle_special.check_of(probe) for probe in found if not probe.rays] == [None, None]
