"""Reproduce the recorded results of a real OptiX.

Every file of the folder (OXRT_ORACLE_DIR, default `../shared/oracle`) is read; every probe with a scene and rays is built, traced by the
event recorder and compared: integers, decisions and calls exactly, numbers within the relative errors of `oracle_compare`, and what may
differ only as `oracle_differences` names it. A probe that needs a feature that is not there yet is skipped by the feature's name.
"""

from __future__ import annotations

from collections import Counter

import oracle_files
import oracle_special
import pytest
from harness import Harness
from oracle_compare import unlawful
from oracle_differences import REASONS, Known, compare, not_copied
from oracle_events import record
from oracle_features import FEATURES, missing, needed
from oracle_files import Probe
from oracle_scene import build

import optixc as ox

PROBES = oracle_files.probes()
TRACED = [probe for probe in PROBES if probe.scene and probe.rays]
OTHERS = [probe for probe in PROBES if not (probe.scene and probe.rays)]
SHOWN = 5


@pytest.fixture(scope="session")
def known() -> Known:
    """Every recorded candidate of every ray."""
    return Known(TRACED)


def test_the_recorded_files_are_there() -> None:
    if not PROBES:
        print(f"no recorded results in {oracle_files.folder()}: 0 probes run, all skipped")
        pytest.skip(f"no recorded results in {oracle_files.folder()}")
    unsupported = Counter(name for probe in TRACED for name in missing(probe)[:1])
    print(f"{len(PROBES)} probes in {oracle_files.folder()}")
    print(f"skipped for a missing feature: {sum(unsupported.values())} {dict(unsupported)}")
    unknown = {name for probe in TRACED for name in needed(probe)} - set(FEATURES)
    assert not unknown, f"features that the table does not know: {unknown}"


@pytest.mark.parametrize("name", FEATURES)
def test_the_feature_table_tells_the_truth(harness: Harness, name: str) -> None:
    feature = FEATURES[name]
    if feature.supported:
        feature.use(harness)
        return
    with pytest.raises((ox.OptixError, AttributeError, NotImplementedError, TypeError, FileNotFoundError)):
        feature.use(harness)


@pytest.mark.parametrize("probe", TRACED, ids=lambda probe: probe.id)
def test_traced_probe(harness: Harness, known: Known, probe: Probe) -> None:
    if absent := missing(probe):
        pytest.skip(f"needs {', '.join(absent)}")
    if reason := not_copied(probe):
        pytest.skip(f"not to be copied: {reason}")
    scene = build(harness.context, probe.scene)
    results = record(harness, probe, scene)
    found: list[str] = []
    names: Counter[str] = Counter()
    for index, result in enumerate(results):
        differences, unexplained = compare(probe, index, result, known)
        names.update(differences)
        where = f"ray {index} {probe.rays[index]['in'].get('tag', '')}"
        found.extend(f"{where}: {text}" for text in unlawful(probe, index, result) + unexplained)
    for name, count in names.items():
        print(f"{probe.id}: {count} of {len(results)} rays differ: {name} ({REASONS[name]})")
    assert not found, f"{len(found)} differences:\n" + "\n".join(found[:SHOWN])


@pytest.mark.parametrize("probe", OTHERS, ids=lambda probe: probe.id)
def test_other_probe(harness: Harness, probe: Probe) -> None:
    """Probes without rays: queries, counts, program groups of their own, host calls."""
    check = oracle_special.check_of(probe)
    if check is None:
        pytest.skip(f"no check for {probe.id} yet: {oracle_special.why_not(probe)}")
    if reason := not_copied(probe):
        pytest.skip(f"not to be copied: {reason}")
    if absent := [name for name in (*needed(probe), *check.features) if not FEATURES[name].supported]:
        pytest.skip(f"needs {', '.join(absent)}")
    check.run(harness, probe)
