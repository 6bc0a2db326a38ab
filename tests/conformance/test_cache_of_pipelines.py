"""Area C: the folder of compiled pipelines as contexts and processes use it. Settings of the cache are in test_context.py."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from harness import SHADERS
from shaders import bound as shader

import optixc as ox
from optixc import shader_keys, toolchain

SHADER = SHADERS / "bound.py"
LIGHT = shader.Light((1.0, 0.5, 0.0), False)
OTHER_PROCESS = """
import json, sys
import numpy as np
import optixc as ox
from shaders import bound as shader
folder, path, turns = sys.argv[1], sys.argv[2], int(sys.argv[3])
told = []
for k in range(turns):
    context = ox.DeviceContext(cache_dir=folder, log_callback=lambda level, tag, text: level < 4 and told.append(text))
    group = context.program_group_create(raygen=context.module_create(path)["__raygen__branch"])
    bound = {"k": 3} if k % 2 else {}
    pipeline = context.pipeline_create([group], simd=1, bound_values=bound)
    out = np.zeros(1, np.float32)
    light = shader.Light((1.0, 0.5, 0.0), False)
    pipeline.launch(shader.Params(out=out, k=3, light=light), ox.ShaderBindingTable(raygen=group.record()), 1)
    report = pipeline.report()
    print(json.dumps([report.cache_hit, report.library, float(out[0])]))
print(json.dumps(told))
"""


def run(folder: Path, told: list[str] | None = None, path: Path = SHADER, **options: Any) -> tuple[float, Any]:
    """The result of a fresh context with this cache folder, and the pipeline's report."""
    heard = told if told is not None else []
    context = ox.DeviceContext(cache_dir=folder, log_callback=lambda level, tag, text: heard.append(text) if level < 4 else None)
    group = context.program_group_create(raygen=context.module_create(path)["__raygen__branch"])
    pipeline = context.pipeline_create([group], simd=1, **options)
    out = np.zeros(1, np.float32)
    pipeline.launch(shader.Params(out=out, k=3, light=LIGHT), ox.ShaderBindingTable(raygen=group.record()), 1)
    return float(out[0]), pipeline.report()


def start(folder: Path, path: Path = SHADER, turns: int = 1) -> subprocess.Popen[str]:
    environment = {**os.environ, "PYTHONPATH": str(SHADERS.parent)}
    return subprocess.Popen([sys.executable, "-c", OTHER_PROCESS, str(folder), str(path), str(turns)], stdout=subprocess.PIPE, text=True,
                            env=environment)


def said(process: subprocess.Popen[str]) -> list[Any]:
    text, _ = process.communicate()
    assert process.returncode == 0
    return [json.loads(line) for line in text.splitlines()]


def test_T017_where_compiled_pipelines_are_by_default(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    for name in ("OPTIXC_CACHE_DIR", "OPTIXC_CACHE_MAXSIZE", "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("HOME", str(tmp_path))
    context = ox.DeviceContext()
    assert context.get_cache_location() == str(tmp_path / ".cache" / "optixc")
    assert context.get_cache_enabled()
    assert context.get_cache_database_sizes() == (1 << 29, 1 << 30)


def test_T021_another_process_finds_what_one_has_compiled(tmp_path: Path) -> None:
    (missed, library, value), _ = said(start(tmp_path))
    code = Path(library).read_bytes()
    (hit, again, same), told = said(start(tmp_path))
    assert (missed, hit) == (False, True)
    assert (again, same, told) == (library, value, [])
    assert Path(again).read_bytes() == code


def test_T021_bound_values_have_entries_of_their_own(tmp_path: Path) -> None:
    values, libraries, hits = [], [], []
    for bound in ({"k": 3}, {"k": 4}, {"k": 3}, {}):
        value, report = run(tmp_path, bound_values=bound)
        values.append(value > 2000)
        libraries.append(report.library)
        hits.append(report.cache_hit)
    assert values == [False, True, False, False]
    assert hits == [False, False, True, False]
    assert libraries[0] == libraries[2]
    assert len(set(libraries)) == 3


def test_without_a_compiler_the_cache_still_serves(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    folder, empty = tmp_path / "cache", tmp_path / "empty"
    value, _ = run(folder)
    monkeypatch.setattr(toolchain, "_versions", {})
    monkeypatch.setenv("PATH", str(empty))
    monkeypatch.delenv("OPTIXC_CXX", raising=False)
    again, report = run(folder)
    assert (again, report.cache_hit) == (value, True)
    for other, options in ((folder, {"bound_values": {"k": 7}}), (empty, {})):
        with pytest.raises(ox.ToolchainError, match=r"no C\+\+ compiler found: install g\+\+ 12"):
            run(other, **options)


def test_a_warning_names_the_callers_line(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    context = ox.DeviceContext(cache_dir=tmp_path / "file")
    with pytest.warns(ox.OptixcWarning, match=r"the cache folder .* cannot be written") as told:
        context.module_create(SHADER)
    assert [one.filename for one in told] == [__file__]


def test_T023_two_processes_compile_at_once(tmp_path: Path) -> None:
    other = tmp_path / "other.py"
    other.write_text(SHADER.read_text().replace("1000.0", "1500.0"))
    cache = tmp_path / "cache"
    processes = [start(cache, path, turns=4) for path in (SHADER, SHADER, other)]
    found = [said(process) for process in processes]
    values = [[round(value) for _, _, value in lines[:-1]] for lines in found]
    assert values == [[1000] * 4, [1000] * 4, [1500] * 4]
    assert [lines[-1] for lines in found] == [[], [], []]
    assert not list(cache.glob("new-*"))
    assert all(said(start(cache, path))[0][0] for path in (SHADER, other))


def flipped(at: float) -> Callable[[bytes], bytes]:
    def flip(data: bytes) -> bytes:
        position = int(at * (len(data) - 1))
        return data[:position] + bytes([data[position] ^ 4]) + data[position + 1 :]

    return flip


DAMAGES: dict[str, Callable[[bytes], bytes]] = {
    **{f"a bit at {round(100 * at)} %": flipped(at) for at in (0.0, 0.01, 0.3, 0.7, 1.0)},
    "nothing left": lambda data: b"", "cut in half": lambda data: data[: len(data) // 2], "last byte missing": lambda data: data[:-1],
    "one byte more": lambda data: data + b"\0", "zeros": lambda data: bytes(len(data)), "text": lambda data: b"[" * 100_000,
}


@pytest.fixture(scope="module")
def filled(tmp_path_factory: pytest.TempPathFactory) -> tuple[dict[str, bytes], float]:
    """The files of a cache that holds one pipeline, and its result."""
    folder = tmp_path_factory.mktemp("filled")
    value, _ = run(folder)
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}, value


@pytest.mark.parametrize("damage", DAMAGES)
def test_damaged_files_are_made_anew(filled: tuple[dict[str, bytes], float], tmp_path: Path, damage: str) -> None:
    files, value = filled
    kinds = {Path(name).suffix for name in files}
    assert {".so", ".json", ".note"} <= kinds
    for number, victim in enumerate(files):
        # A folder of its own, because the process remembers compilers by folder.
        folder = tmp_path / str(number)
        folder.mkdir()
        for name, data in files.items():
            (folder / name).write_bytes(DAMAGES[damage](data) if name == victim else data)
        told: list[str] = []
        found, report = run(folder, told)
        assert found == value
        if victim == "compilers.json":
            assert report.cache_hit
            continue
        assert told == [f"the cache file {folder / victim} is damaged; it is not used, and what it held is compiled again"]
        # A note only saves the front end's work; what is loaded is whole.
        assert report.cache_hit == victim.endswith(".note")
        assert (folder / victim).read_bytes() == files[victim]
        told.clear()
        assert run(folder, told)[1].cache_hit
        assert told == []


def test_every_region_of_a_library_is_covered(filled: tuple[dict[str, bytes], float], tmp_path: Path) -> None:
    """Flips in steps of a page and everywhere in the headers: the entry is absent each time, without a compile."""
    files, _ = filled
    for name, data in files.items():
        (tmp_path / name).write_bytes(data)
    (library,) = (name for name in files if name.endswith(".so"))
    store = ox.DeviceContext(cache_dir=tmp_path, log_callback=lambda *message: None).cache
    key = library.split("-")[0]
    assert store.find(key) is not None
    data = files[library]
    for position in {*range(0, 512, 7), *range(0, len(data), 251)}:
        (tmp_path / library).write_bytes(data[:position] + bytes([data[position] ^ 1 << position % 8]) + data[position + 1 :])
        assert store.find(key) is None, position
    (tmp_path / library).write_bytes(data)
    assert store.find(key) is not None


def test_entries_of_other_versions_are_not_found(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    first, before = run(tmp_path)
    for change in ("version", "headers", "compiler"):
        with monkeypatch.context() as patch:
            if change == "version":
                patch.setattr(shader_keys, "compiler_stamp", lambda: "another version of the compiler")
            elif change == "headers":
                patch.setattr(shader_keys, "headers_digest", lambda include: "other headers")
            else:
                patch.setattr(toolchain.Compiler, "identity", property(lambda self: "another compiler"))
            value, report = run(tmp_path)
        assert value == first
        assert not report.cache_hit, change
        assert Path(report.library).name.split("-")[0] != Path(before.library).name.split("-")[0]
    assert run(tmp_path)[1].cache_hit


def test_a_changed_shader_is_compiled_again(tmp_path: Path) -> None:
    path = tmp_path / "changing.py"
    path.write_text(SHADER.read_text())
    assert round(run(tmp_path / "cache", path=path)[0]) == 1000
    path.write_text(SHADER.read_text().replace("1000.0", "1700.0"))
    value, report = run(tmp_path / "cache", path=path)
    assert (round(value), report.cache_hit) == (1700, False)


def test_a_module_whose_file_changed_is_stale(tmp_path: Path) -> None:
    """The cache knew the file, so that nobody has parsed it when it changes."""
    path, cache = tmp_path / "changing.py", tmp_path / "cache"
    path.write_text(SHADER.read_text())
    run(cache, path=path)
    context = ox.DeviceContext(cache_dir=cache)
    module = context.module_create(path)
    group = context.program_group_create(raygen=module["__raygen__branch"])
    assert context.pipeline_create([group], simd=1).report().cache_hit
    path.write_text(SHADER.read_text().replace("1000.0", "1900.0"))
    with pytest.raises(ox.InvalidOperationError, match=r"changing\.py or a file that it imports changed since module_create; create"):
        context.pipeline_create([group], simd=1, bound_values={"k": 3})
    fresh = context.program_group_create(raygen=context.module_create(path)["__raygen__branch"])
    context.pipeline_create([fresh], simd=1, bound_values={"k": 3})
    path.unlink()
    with pytest.raises(ox.OptixError, match="changing"):
        context.pipeline_create([group], simd=1, bound_values={"k": 4})
