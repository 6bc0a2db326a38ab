"""The cache folder: whole entries only, bounded, harmless where it cannot be written."""

from __future__ import annotations

import json
import multiprocessing
import os
from collections.abc import Callable
from pathlib import Path

import pytest

from optixc.cache import DEFAULT_MAX_SIZE, Cache, default_folder, max_size
from optixc.signed_json import digest


def opened(folder: Path, limit: int = 1 << 20) -> tuple[Cache, list[str]]:
    warnings: list[str] = []
    return Cache(folder, warnings.append, limit), warnings


def writes(data: bytes) -> Callable[[Path], object]:
    return lambda output: output.write_bytes(data)


def test_what_was_stored_is_found(tmp_path: Path) -> None:
    store, warnings = opened(tmp_path)
    made = store.store("k", {"a": 1}, writes(b"code"))
    found = store.find("k")
    assert not made.hit
    assert found is not None
    assert found.hit
    assert found.library.read_bytes() == b"code"
    assert found.manifest == {"a": 1}
    assert store.find("other") is None
    assert warnings == []


def test_damaged_entries_are_absent_and_told(tmp_path: Path) -> None:
    store, warnings = opened(tmp_path)
    entry = store.store("k", {}, writes(b"code"))
    entry.library.write_bytes(b"c0de")
    assert store.find("k") is None
    store.store("k", {}, writes(b"code"))
    assert store.find("k") is not None
    (tmp_path / "k.json").write_text("{")
    assert store.find("k") is None
    (tmp_path / "k.json").write_text(json.dumps({"library": "gone.so", "checksum": "", "manifest": {}}))
    assert store.find("k") is None
    assert ["is damaged" in warning for warning in warnings] == [True] * 3
    assert store.find("k") is None, "it was taken away, and is absent without a word"
    assert len(warnings) == 3


@pytest.mark.parametrize("kind", ["json", "note"])
def test_every_flipped_bit_and_every_truncation_is_noticed(tmp_path: Path, kind: str) -> None:
    store, _ = opened(tmp_path)
    store.store("k", {"frames": {"f": 128}, "text": "ä"}, writes(b"code"))
    store.write_note("k", {"entry": "k", "stack": 48})
    look = store.find if kind == "json" else store.read_note
    path = tmp_path / f"k.{kind}"
    whole = path.read_bytes()
    assert look("k") is not None
    for position in range(len(whole)):
        for bit in range(8):
            path.write_bytes(whole[:position] + bytes([whole[position] ^ 1 << bit]) + whole[position + 1 :])
            assert look("k") is None, (position, bit)
        path.write_bytes(whole[:position])
        assert look("k") is None, position
    path.write_bytes(whole + b" ")
    assert look("k") is None
    path.write_bytes(whole)
    assert look("k") is not None


@pytest.mark.parametrize("kind", ["json", "note"])
def test_files_under_another_key_are_noticed(tmp_path: Path, kind: str) -> None:
    store, _ = opened(tmp_path)
    store.store("k", {}, writes(b"code"))
    store.write_note("k", {"entry": "k"})
    os.replace(tmp_path / f"k.{kind}", tmp_path / f"other.{kind}")
    assert (store.find if kind == "json" else store.read_note)("other") is None


def test_notes_are_checked_too(tmp_path: Path) -> None:
    store, _ = opened(tmp_path)
    store.write_note("n", {"entry": "k"})
    assert store.read_note("n") == {"entry": "k"}
    path = tmp_path / "n.note"
    path.write_text(path.read_text().replace('"k"', '"j"'))
    assert store.read_note("n") is None


def test_the_least_recently_used_goes_first(tmp_path: Path) -> None:
    store, _ = opened(tmp_path, limit=11_000)
    for number in range(4):
        store.store(f"k{number}", {}, writes(bytes(1900)))
        for path in tmp_path.glob(f"k{number}*"):
            os.utime(path, (1000 + number, 1000 + number))
    assert store.find("k0") is not None
    store.store("k4", {}, writes(bytes(3000)))
    assert store.find("k0") is not None, "it was used last"
    assert store.find("k1") is None
    assert store.find("k4") is not None
    assert sum(path.stat().st_size for path in tmp_path.iterdir()) <= 11_000


def test_an_entry_larger_than_the_limit_works_but_is_not_kept(tmp_path: Path) -> None:
    store, warnings = opened(tmp_path, limit=1000)
    entry = store.store("k", {}, writes(bytes(2000)))
    assert entry.library.read_bytes() == bytes(2000)
    assert store.find("k") is None
    assert "larger than the cache limit" in warnings[0]


def test_without_a_cache_nothing_is_written(tmp_path: Path) -> None:
    store, warnings = opened(tmp_path / "none", limit=0)
    entry = store.store("k", {}, writes(b"code"))
    store.write_note("n", {})
    assert entry.library.read_bytes() == b"code"
    assert store.find("k") is None
    assert store.read_note("n") is None
    assert not (tmp_path / "none").exists()
    assert warnings == []


def test_a_folder_that_cannot_be_written_is_told_once(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    store, warnings = opened(tmp_path / "file" / "cache")
    for _ in range(2):
        entry = store.store("k", {}, writes(b"code"))
        store.write_note("n", {})
        assert entry.library.read_bytes() == b"code"
    assert len(warnings) == 1
    assert "OPTIXC_CACHE_DIR" in warnings[0]


def test_settings_from_the_environment(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    for text, expected in (("", DEFAULT_MAX_SIZE), ("0", 0), ("1000000", 1000000), ("-5", DEFAULT_MAX_SIZE), ("abc", DEFAULT_MAX_SIZE)):
        monkeypatch.setenv("OPTIXC_CACHE_MAXSIZE", text)
        assert max_size() == expected
    monkeypatch.setenv("OPTIXC_CACHE_DIR", str(tmp_path))
    assert default_folder() == tmp_path
    monkeypatch.setenv("OPTIXC_CACHE_DIR", "~/compiled")
    assert default_folder() == Path.home() / "compiled"
    monkeypatch.delenv("OPTIXC_CACHE_DIR")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "xdg"))
    assert default_folder() == tmp_path / "xdg" / "optixc"


def test_parts_of_a_key_do_not_run_together() -> None:
    assert digest("ab", "c") != digest("a", "bc")
    assert digest("a", b"b") == digest(b"a", "b")


def _store_many(folder: str, number: int) -> None:
    store, _ = opened(Path(folder))
    for turn in range(40):
        store.store("shared", {"by": number}, writes(bytes([number]) * (100 + turn)))
        entry = store.find("shared")
        assert entry is None or len(set(entry.library.read_bytes())) == 1


def test_processes_may_share_a_folder(tmp_path: Path) -> None:
    context = multiprocessing.get_context("spawn")
    processes = [context.Process(target=_store_many, args=(str(tmp_path), number)) for number in (1, 2)]
    for process in processes:
        process.start()
    for process in processes:
        process.join(60)
        assert process.exitcode == 0
    store, _ = opened(tmp_path)
    assert store.find("shared") is not None
    assert not list(tmp_path.glob("new-*"))
