"""The command: what it prints, what it writes, how it ends."""

from __future__ import annotations

import errno
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from optixc import cli, driver, toolchain

SHADER = """import optixc as ox
from half import half

@ox.struct
class Params:
    values: ox.Array[ox.float32]
    scale: float

params = ox.launch_params(Params)

@ox.program
def __raygen__fill():
    i = ox.get_launch_index().x
    params.values[i] = half(params.scale)
"""
HELPER = """import optixc as ox

@ox.device
def half(x: float) -> float:
    return 0.5 * x
"""
SIDE_EFFECT = "\nraise SystemExit('the file was run')\n"


@pytest.fixture
def shader(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("OPTIXC_CACHE_DIR", str(tmp_path / "cache"))
    (tmp_path / "half.py").write_text(HELPER)
    path = tmp_path / "shader.py"
    path.write_text(SHADER + SIDE_EFFECT)
    return path


def test_writes_library_header_and_manifest(shader: Path, tmp_path: Path) -> None:
    assert cli.main(["shader.py", "-o", "out/made", "--depfile", "out/made.d"]) == 0
    assert (tmp_path / "out/made.so").read_bytes()[:4] == b"\x7fELF"
    assert "typedef struct Params" in (tmp_path / "out/made.h").read_text()
    manifest = json.loads((tmp_path / "out/made.json").read_text())
    assert manifest["params"] == {"name": "Params", "layout": "values:Array1[float32]@0;scale:float32@16", "size": 24}
    assert [program["name"] for program in manifest["programs"]] == ["__raygen__fill"]
    outputs, inputs = (tmp_path / "out/made.d").read_text().split(":", 1)
    assert outputs.split() == ["out/made.so", "out/made.h", "out/made.json"]
    assert [Path(name).name for name in inputs.split()] == ["shader.py", "half.py"]


def test_the_default_output_is_named_after_the_shader(shader: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main([str(shader), "-O1"]) == 0
    assert {"shader.so", "shader.h", "shader.json"} <= {path.name for path in tmp_path.iterdir()}
    assert "warning: shader.so lies beside shader.py: Python's `import shader` would take it" in capsys.readouterr().err
    assert cli.main([str(shader), "-O1", "-o", "build/shader"]) == 0
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize(("output", "made"), [("out/", "out/shader"), ("out/made.so", "out/made"), ("out/ma de-1.x", "out/ma de-1.x")])
def test_ways_to_name_the_outputs(shader: Path, tmp_path: Path, output: str, made: str) -> None:
    assert cli.main(["shader.py", "-O1", "-o", output]) == 0
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [Path(made).name + end for end in (".h", ".json", ".so")]
    header = (tmp_path / f"{made}.h").read_text()
    names = [line.split()[1] for line in header.splitlines() if line.startswith(("#ifndef", "#define"))]
    assert len(names) == 3
    assert all(name.isidentifier() for name in names)


@pytest.mark.parametrize(
    ("form", "expected"),
    [
        ("ast", "FunctionDef("),
        ("types", "params.scale: float32"),
        ("ir", "__raygen__fill"),
        ("cpp", "#include <oxrt/device.h>"),
        ("asm", "oxrt_pipeline_v1"),
        ("header", "typedef struct Params"),
    ],
)
def test_emitted_forms(shader: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], form: str, expected: str) -> None:
    assert cli.main(["shader.py", "--emit", form]) == 0
    assert expected in capsys.readouterr().out
    assert not (tmp_path / "shader.so").exists()


def test_a_file_named_in_several_ways_is_the_same_file(shader: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What the cache noted of the absolute path holds for relative ones, from any folder."""
    (shader.parent / "elsewhere").mkdir()
    for path, folder in ((str(shader), "."), ("shader.py", "."), ("./shader.py", "."), ("../shader.py", "elsewhere")):
        monkeypatch.chdir(shader.parent / folder)
        assert cli.main([path, "--emit", "cpp"]) == 0, path


def test_print_after_a_pass(shader: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["shader.py", "--print-after", "specialize", "--bind", "scale=3.0"]) == 0
    assert "3.0" in capsys.readouterr().out
    assert cli.main(["shader.py", "--print-after", "nothing"]) == cli.EXIT_USAGE
    assert "specialize" in capsys.readouterr().err
    for form in ("ast", "types"):
        assert cli.main(["shader.py", "--print-after", "specialize", "--emit", form]) == cli.EXIT_USAGE
        assert f"--emit {form}" in capsys.readouterr().err


def test_errors_of_the_shader(shader: Path, capsys: pytest.CaptureFixture[str]) -> None:
    shader.write_text(SHADER.replace("half(params.scale)", "half(nothing) + other"))
    assert cli.main(["shader.py"]) == cli.EXIT_SHADER
    printed = capsys.readouterr().err
    assert printed.count("shader.py:14:") == 2
    assert printed.count("error[OX") == 2
    assert "Traceback" not in printed


@pytest.mark.parametrize("form", [*cli.EMIT_FORMS, None])
@pytest.mark.parametrize("text", [b"def f(:\n", b"def f():\n\tif 1:\n        pass\n", b"# \xff\n", b"x = 1\0\n"])
def test_files_that_are_no_python(shader: Path, capsys: pytest.CaptureFixture[str], form: str | None, text: bytes) -> None:
    shader.write_bytes(text)
    assert cli.main(["shader.py", *(["--emit", form] if form else [])]) == cli.EXIT_SHADER
    assert "error[OX101]" in capsys.readouterr().err


@pytest.mark.parametrize("name", driver.pass_names())
def test_every_pass_can_be_printed(shader: Path, capsys: pytest.CaptureFixture[str], name: str) -> None:
    assert cli.main(["shader.py", "--print-after", name]) == 0
    printed = capsys.readouterr().out
    assert "__raygen__fill" in printed
    assert "#include" not in printed


def test_a_reader_that_has_seen_enough(shader: Path) -> None:
    command = f"'{sys.executable}' -m optixc.cli shader.py --emit asm | head -1"
    done = subprocess.run(["bash", "-c", f"set -o pipefail; {command}"], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


def test_an_output_that_cannot_be_written_is_no_traceback(shader: Path) -> None:
    command = [sys.executable, "-m", "optixc.cli", "shader.py", "--emit", "cpp"]
    with open("/dev/full", "w") as full:
        ended = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert (ended.returncode, ended.stderr) == (cli.EXIT_USAGE, "optixc: standard output cannot be written: No space left on device\n")


def test_a_disk_that_fills_up_leaves_the_old_output(
    shader: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Half a library would look finished to make; the message names the output, not a file of the cache."""
    assert cli.main(["shader.py", "-O1", "-o", "out/made"]) == 0
    before = {path.name: path.read_bytes() for path in (tmp_path / "out").iterdir()}

    def full(self: Path, content: bytes) -> int:
        with open(self, "wb") as file:
            file.write(content[:16])
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(self))

    monkeypatch.setattr(Path, "write_bytes", full)
    assert cli.main(["shader.py", "-O1", "-o", "out/made"]) == cli.EXIT_USAGE
    assert capsys.readouterr().err == "optixc: out/made.so cannot be written: No space left on device\n"
    monkeypatch.undo()
    assert {path.name: path.read_bytes() for path in (tmp_path / "out").iterdir()} == before


def test_a_name_that_is_no_text(shader: Path, tmp_path: Path) -> None:
    path = tmp_path / os.fsdecode(b"gr\xf6sse.py")
    path.write_text(SHADER)
    assert cli.main([str(path), "-O1", "-o", "out/made", "--depfile", "out/made.d"]) == 0
    assert b"gr\xf6sse.py" in (tmp_path / "out/made.d").read_bytes()


def test_a_folder_that_is_gone(shader: Path, tmp_path: Path) -> None:
    folder = tmp_path / "gone"
    folder.mkdir()
    command = f"rmdir ../gone; '{sys.executable}' -m optixc.cli ../shader.py"
    ended = subprocess.run(["bash", "-c", command], cwd=folder, capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stderr.splitlines()[-1]) == (cli.EXIT_USAGE, "optixc: the current folder is gone")


def test_text_that_the_terminal_cannot_show(shader: Path) -> None:
    shader.write_text(shader.read_text().replace("fill():", "fill():\n    print('größer')"), encoding="utf-8")
    command = [sys.executable, "-m", "optixc.cli", "shader.py", "--emit", "ir"]
    printed = subprocess.run(command, env={**os.environ, "PYTHONIOENCODING": "ascii"}, capture_output=True, check=True).stdout
    assert "größer" in printed.decode("utf-8")


def test_ctrl_c_is_no_traceback(shader: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*arguments: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(driver, "build", interrupted)
    assert cli.main(["shader.py"]) == cli.EXIT_INTERRUPTED


@pytest.mark.parametrize(
    "arguments",
    [[], ["none.py"], ["shader.py", "--simd", "3"], ["shader.py", "--bind", "scale"], ["shader.py", "-o", ""], ["shader.py", "-o", ".."]],
)
def test_wrong_usage(shader: Path, capsys: pytest.CaptureFixture[str], arguments: list[str]) -> None:
    try:
        code = cli.main(arguments)
    except SystemExit as end:
        code = int(str(end.code))
    assert code == cli.EXIT_USAGE
    assert "optixc: " in capsys.readouterr().err


def test_wrong_bound_values(shader: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for text in ("scale='x'", "nothing=1", "scale=import"):
        assert cli.main(["shader.py", "--bind", text]) == cli.EXIT_USAGE
        assert "optixc: " in capsys.readouterr().err


def test_a_missing_tool_chain(shader: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setenv("PATH", "/nowhere")
    monkeypatch.delenv("OPTIXC_CXX", raising=False)
    monkeypatch.setattr(toolchain, "_versions", {})
    assert cli.main(["shader.py"]) == cli.EXIT_TOOLCHAIN
    assert "install g++" in capsys.readouterr().err


def test_configuration_tells_what_is_there(shader: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["--print-config"]) == 0
    printed = capsys.readouterr().out
    for word in ("compiler: ", "embree: 4.", "include folder: ", "cmake package: ", "cache: ", "processor lanes: "):
        assert word in printed


def test_configuration_tells_of_a_wrong_choice(shader: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setenv("OPTIXC_CXX", "nonsense")
    assert cli.main(["--print-config"]) == 0
    assert "compiler: OPTIXC_CXX names 'nonsense'" in capsys.readouterr().out


def test_the_version(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        cli.main(["--version"])
    assert end.value.code == 0
    assert capsys.readouterr().out.startswith("optixc 0.")
