"""Shader files as the host meets them: broken ones, odd ones, changed ones; the cache between; no compiler, no cache folder."""

from __future__ import annotations

import gc
import sys
import time
import weakref
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import optixc as ox
from optixc import driver, toolchain

TEXT = """import optixc as ox
from shade import shade

@ox.struct
class Params:
    values: ox.Array[ox.float32]

params = ox.launch_params(Params)

@ox.program
def __raygen__fill():
    i = ox.get_launch_index().x
    params.values[i] = shade(float(i))
"""
HELPER = """import optixc as ox

@ox.device
def shade(x):
    return 2.0 * x
"""


@ox.struct
class Params:
    values: ox.Array[ox.float32]


def shader(folder: Path, text: str = TEXT, helper: str = HELPER) -> Path:
    (folder / "shade.py").write_text(helper)
    path = folder / "shader.py"
    path.write_text(text)
    return path


def filled(context: ox.DeviceContext, path: Path) -> tuple[list[float], Any]:
    """What the shader writes for four indices, and the pipeline's report."""
    module = context.module_create(path)
    raygen = context.program_group_create(raygen=module["__raygen__fill"])
    pipeline = context.pipeline_create([raygen])
    values = np.zeros(4, np.float32)
    pipeline.launch(Params(values), ox.ShaderBindingTable(raygen=raygen.record()), 4)
    return values.tolist(), pipeline.report()


BROKEN = {
    "syntax error": b"def __raygen__x(:\n    pass\n",
    "tab mix": b"def __raygen__x():\n\tif True:\n        pass\n",
    "no programs": b"x = 3\n",
    "empty": b"",
    "unknown kind": b"import optixc as ox\n@ox.program\ndef __shader__x():\n    pass\n",
    "not UTF-8": b"def __raygen__x():\n    '\xff\xfe'\n",
    "null byte": b"def __raygen__x():\n    pass\n\0",
}


@pytest.mark.parametrize("name", list(BROKEN))
def test_broken_files_give_diagnostics(tmp_path: Path, name: str) -> None:
    path = tmp_path / "broken.py"
    path.write_bytes(BROKEN[name])
    with pytest.raises(ox.CompileError, match=r"broken\.py:\d+:\d+: error\[OX\d+\]"):
        ox.DeviceContext(cache_dir=tmp_path / "cache").module_create(path)


def test_a_byte_order_mark_is_fine(tmp_path: Path) -> None:
    path = shader(tmp_path)
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
    values, _ = filled(ox.DeviceContext(cache_dir=tmp_path / "cache"), path)
    assert values == [0.0, 2.0, 4.0, 6.0]


def test_ten_thousand_lines(tmp_path: Path) -> None:
    body = "".join(f"    x = x + {i % 7}.0\n" for i in range(10_000))
    helper = f"import optixc as ox\n\n@ox.device\ndef shade(x):\n{body}    return x\n"
    began = time.monotonic()
    context = ox.DeviceContext(cache_dir=tmp_path / "cache")
    module = context.module_create(shader(tmp_path, helper=helper))
    assert list(module) == ["__raygen__fill"]
    assert time.monotonic() - began < 60


def test_missing_files_and_wrong_sources(tmp_path: Path) -> None:
    context = ox.DeviceContext(cache_dir=tmp_path / "cache")
    with pytest.raises(ox.FileIoError, match="cannot be read"):
        context.module_create(tmp_path / "none.py")
    compiled = ModuleType("compiled")
    compiled.__file__ = "compiled.pyc"
    for wrong in ([], 3, None, sys, compiled):
        with pytest.raises(ox.InvalidValueError):
            context.module_create(wrong)


def test_the_second_time_comes_from_the_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path, cache = shader(tmp_path), tmp_path / "cache"
    values, report = filled(ox.DeviceContext(cache_dir=cache), path)
    assert values == [0.0, 2.0, 4.0, 6.0]
    assert not report.cache_hit

    def never(*arguments: Any, **more: Any) -> Any:
        raise AssertionError("a hit runs neither the front end nor a process")

    monkeypatch.setattr(driver, "compile_file", never)
    monkeypatch.setattr(toolchain.subprocess, "run", never)
    monkeypatch.setattr(toolchain, "_versions", {})
    again, report = filled(ox.DeviceContext(cache_dir=cache), path)
    assert again == values
    assert report.cache_hit


def test_a_hit_is_fast(tmp_path: Path) -> None:
    path, cache = shader(tmp_path), tmp_path / "cache"
    context = ox.DeviceContext(cache_dir=cache)
    filled(context, path)
    seconds = []
    for _ in range(10):
        began = time.perf_counter()
        module = context.module_create(path)
        context.pipeline_create([context.program_group_create(raygen=module["__raygen__fill"])])
        seconds.append(time.perf_counter() - began)
    assert min(seconds) < 0.010


@pytest.mark.parametrize("what", ["shader", "helper", "options"])
def test_changes_are_noticed(tmp_path: Path, what: str) -> None:
    context = ox.DeviceContext(cache_dir=tmp_path / "cache")
    path = shader(tmp_path)
    filled(context, path)
    if what == "helper":
        shader(tmp_path, helper=HELPER.replace("2.0", "3.0"))
        assert filled(context, path)[0] == [0.0, 3.0, 6.0, 9.0]
    elif what == "shader":
        shader(tmp_path, text=TEXT.replace("float(i))", "float(i)) + 1.0"))
        assert filled(context, path)[0] == [1.0, 3.0, 5.0, 7.0]
    else:
        module = context.module_create(path)
        raygen = context.program_group_create(raygen=module["__raygen__fill"])
        assert not context.pipeline_create([raygen], math="fast").report().cache_hit


def test_where_imports_are_looked_for_is_noticed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One name of an include folder in two current folders; then a helper that comes first in the order of search."""
    path = shader(tmp_path)
    (tmp_path / "shade.py").unlink()
    for number in (1, 2):
        (tmp_path / str(number) / "include").mkdir(parents=True)
        (tmp_path / str(number) / "include" / "shade.py").write_text(HELPER.replace("2.0", f"{number}.0"))

    def second_value() -> float:
        context = ox.DeviceContext(cache_dir=tmp_path / "cache")
        module = context.module_create(path, include_dirs=["include"])
        monkeypatch.chdir(tmp_path)
        raygen = context.program_group_create(raygen=module["__raygen__fill"])
        values = np.zeros(2, np.float32)
        context.pipeline_create([raygen]).launch(Params(values), ox.ShaderBindingTable(raygen=raygen.record()), 2)
        return float(values[1])

    for folder, expected in (("1", 1.0), ("2", 2.0), ("1", 1.0)):
        monkeypatch.chdir(tmp_path / folder)
        assert second_value() == expected
    monkeypatch.chdir(tmp_path / "2")
    (tmp_path / "shade.py").write_text(HELPER.replace("2.0", "7.0"))
    assert second_value() == 7.0


def test_a_folder_is_left_between_module_and_pipeline(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    context = ox.DeviceContext(cache_dir=tmp_path / "cache")
    shader(tmp_path)
    monkeypatch.chdir(tmp_path)
    filled(context, Path("shader.py"))
    module = context.module_create("shader.py")
    monkeypatch.chdir("/")
    raygen = context.program_group_create(raygen=module["__raygen__fill"])
    assert not context.pipeline_create([raygen], math="fast").report().cache_hit


def test_a_file_that_changes_between_module_and_pipeline(tmp_path: Path) -> None:
    context = ox.DeviceContext(cache_dir=tmp_path / "cache")
    path = shader(tmp_path)
    filled(context, path)
    module = context.module_create(path)
    raygen = context.program_group_create(raygen=module["__raygen__fill"])
    shader(tmp_path, text=TEXT.replace("float(i))", "float(i)) + 1.0"))
    with pytest.raises(ox.InvalidOperationError, match="changed since module_create"):
        context.pipeline_create([raygen], math="fast")


def test_a_pipeline_ends_with_its_last_name(tmp_path: Path) -> None:
    """Not at some later collection of garbage: its library would stay loaded, and its file in use."""
    context = ox.DeviceContext()
    raygen = context.program_group_create(raygen=context.module_create(shader(tmp_path))["__raygen__fill"])
    gc.disable()
    try:
        pipeline = context.pipeline_create([raygen])
        pipeline.launch(Params(np.zeros(4, np.float32)), ox.ShaderBindingTable(raygen=raygen.record()), 4)
        left = weakref.ref(pipeline)
        del pipeline
        assert left() is None
    finally:
        gc.enable()


def test_a_damaged_cache_is_compiled_anew(tmp_path: Path) -> None:
    cache = tmp_path / "cache"
    path = shader(tmp_path)
    filled(ox.DeviceContext(cache_dir=cache), path)
    for file in (path for path in cache.rglob("*") if path.is_file()):
        file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
    values, report = filled(ox.DeviceContext(cache_dir=cache), path)
    assert values == [0.0, 2.0, 4.0, 6.0]
    assert not report.cache_hit


def test_a_cache_folder_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    messages: list[str] = []
    context = ox.DeviceContext(
        cache_dir=tmp_path / "file" / "cache", log_callback=lambda level, tag, text: messages.append(text) if tag == "cache" else None
    )
    values, report = filled(context, shader(tmp_path))
    assert values == [0.0, 2.0, 4.0, 6.0]
    assert not report.cache_hit
    assert len(messages) == 1
    assert "cannot be written" in messages[0]
    with pytest.warns(ox.OptixcWarning, match="OPTIXC_CACHE_DIR"):
        filled(ox.DeviceContext(cache_dir=tmp_path / "file" / "cache"), shader(tmp_path))


def test_no_compiler(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("OPTIXC_CXX", raising=False)
    monkeypatch.setattr(toolchain, "_versions", {})
    context = ox.DeviceContext(cache_dir=tmp_path / "cache")
    with pytest.raises(ox.ToolchainError, match=r"install g\+\+"):
        filled(context, shader(tmp_path))


def test_live_functions(tmp_path: Path) -> None:
    factor = 3.0

    @ox.struct
    class Local:
        values: ox.Array[ox.float32]

    params = ox.launch_params(Local)

    @ox.device
    def scaled(x: float) -> float:
        return factor * x

    @ox.program
    def __raygen__live():
        i = ox.get_launch_index().x
        params.values[i] = scaled(float(i))

    context = ox.DeviceContext(cache_dir=tmp_path)
    module = context.module_create([__raygen__live])
    raygen = context.program_group_create(raygen=module["__raygen__live"])
    values = np.zeros(4, np.float32)
    for hit in (False, True):
        pipeline = context.pipeline_create([raygen])
        assert pipeline.report().cache_hit is hit
        pipeline.launch(Local(values), ox.ShaderBindingTable(raygen=raygen.record()), 4)
        assert values.tolist() == [0.0, 3.0, 6.0, 9.0]
