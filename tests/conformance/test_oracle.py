"""Reproduce the recorded results of a real OptiX.

Every file of the folder (OXRT_ORACLE_DIR, default `../shared/oracle`) is read; every probe with rays is built, traced by the event
recorder and compared: integers, decisions and calls exactly, numbers within the relative errors of `oracle_compare`, and what may differ
only as `oracle_differences` names it. A record that is not understood fails and says so; only a record with nothing in it to compare is
skipped.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

import oracle_files
import oracle_special
import pytest
from harness import Harness
from oracle_bounds import box_differences
from oracle_compare import unlawful
from oracle_differences import REASONS, compare
from oracle_events import record
from oracle_files import Probe
from oracle_keys import not_understood
from oracle_not_copied import NOT_COPIED, must_be_refused
from oracle_scene import build

import optixc as ox

PROBES = oracle_files.probes()
TRACED = [probe for probe in PROBES if probe.rays]
OTHERS = [probe for probe in PROBES if not probe.rays]
SHOWN = 5


@pytest.fixture(scope="session")
def excused(harness: Harness) -> Iterator[Counter[str]]:
    """How many recorded rays each named difference excuses in a mode, printed at its end."""
    rays: Counter[str] = Counter()
    yield rays
    for name, count in rays.most_common():
        print(f"{harness.mode}: {count} recorded rays: {name}")


def test_the_recorded_files_are_there() -> None:
    if not PROBES:
        print(f"no recorded results in {oracle_files.folder()}: 0 probes run, all skipped")
        pytest.skip(f"no recorded results in {oracle_files.folder()}")
    print(f"{len(PROBES)} probes in {oracle_files.folder()}, {sum(len(probe.rays) for probe in TRACED)} rays")


@pytest.mark.parametrize("probe", TRACED, ids=lambda probe: probe.id)
def test_traced_probe(harness: Harness, excused: Counter[str], probe: Probe) -> None:
    assert not not_understood(probe), "not understood: " + "; ".join(not_understood(probe))
    if must_be_refused(probe):
        with pytest.raises(ox.OptixError, match="time"):
            build(harness.context, probe.scene)
        return
    scene = build(harness.context, probe.scene)
    results = record(harness, probe, scene)
    found = box_differences(probe.scene, scene)
    names: Counter[str] = Counter()
    for index, result in enumerate(results):
        differences, unexplained = compare(probe, index, result)
        names.update(differences)
        where = f"ray {index} {probe.rays[index]['in'].get('tag', '')}"
        found.extend(f"{where}: {text}" for text in unlawful(probe, index, result) + unexplained)
    excused.update(names)
    for name, count in names.items():
        print(f"{probe.id}: {count} of {len(results)} rays differ: {name} ({REASONS.get(name) or f'here: {NOT_COPIED[name]}'})")
    assert not found, f"{len(found)} differences:\n" + "\n".join(found[:SHOWN])


@pytest.mark.parametrize("probe", OTHERS, ids=lambda probe: probe.id)
def test_other_probe(harness: Harness, probe: Probe) -> None:
    """Probes without rays: queries, counts, program groups of their own, host calls."""
    if reason := oracle_special.nothing_to_compare(probe):
        pytest.skip(f"nothing to compare: {reason}")
    check = oracle_special.check_of(probe)
    assert check is not None, f"not understood: {oracle_special.why_not(probe)}"
    check(harness, probe)
