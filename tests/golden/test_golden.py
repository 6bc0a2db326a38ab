"""Golden files: what the front end and the emitters make of each shader here, and that it compiles without a warning.

`pytest tests/golden --update-golden` writes the files anew; without it a missing or different file fails. A shader's OPTIONS are those
of its pipeline. Nothing is run.
"""

from __future__ import annotations

import ast
import os
import shutil
import subprocess
from pathlib import Path
from typing import Any, get_args

import pytest

from optixc import passes
from optixc.codegen.emit import emit, emitted_lanes
from optixc.frontend.compile import compile_file
from optixc.installation import include_folder
from optixc.ir import nodes
from optixc.ir import types as t
from optixc.ir import walk
from optixc.ir.intrinsic_rows import INTRINSICS
from optixc.ir.text import print_module
from optixc.ir.verify import verify
from optixc.passes.features import features
from optixc.passes.live_notes import live_notes
from optixc.passes.pipeline import link

FOLDER = Path(__file__).parent
CASES = sorted(path.parent.name for path in FOLDER.glob("*/shader.py"))
COMPILERS = [name for name in ("g++", "clang++", "clang++-19", "clang++-16") if shutil.which(name)]
WARNINGS = ("-Wall", "-Wextra", "-Wshadow", "-Werror")
FLAGS = ("-std=c++20", "-march=x86-64-v4", "-fno-exceptions", "-fno-rtti", "-fwrapv", "-fsyntax-only", *WARNINGS)


def options_of(source: str) -> dict[str, Any]:
    """The dictionary that the shader assigns to OPTIONS; bound values become literals of their Python type."""
    for statement in ast.parse(source).body:
        if isinstance(statement, ast.Assign) and ast.unparse(statement.targets[0]) == "OPTIONS":
            options: dict[str, Any] = ast.literal_eval(statement.value)
            bound = options.pop("bound_values", {})
            types: dict[type, t.Type] = {bool: t.BOOL, int: t.INT32, float: t.FLOAT32}
            literals = tuple((name, nodes.Literal(value, types[type(value)])) for name, value in bound.items())
            return {**options, "bound_values": literals}
    return {}


def outputs(case: str) -> dict[str, str]:
    """Names of golden files and what they should hold."""
    source = (FOLDER / case / "shader.py").read_text()
    here = Path.cwd()
    os.chdir(FOLDER / case)
    try:
        module = compile_file("shader.py").module
    finally:
        os.chdir(here)
    assert verify(module) == []
    texts = {}
    for lanes, name in ((1, "pipeline.cpp"), (16, "pipeline_spmd.cpp")):
        options = nodes.PipelineOptions(**{**options_of(source), "lanes": lanes})
        linked = link([module], [program.name for program in module.programs], options)
        texts["module.ir"] = print_module(module, live_notes(linked))
        pipeline = passes.run(linked, lambda name_, result: check(name_, result))
        if emitted_lanes(pipeline) == lanes:
            texts[name] = emit(pipeline, features(pipeline))
    return texts


def check(name: str, pipeline: nodes.Pipeline) -> None:
    """Every pass leaves a pipeline without faults."""
    assert verify(pipeline) == [], name


@pytest.fixture(params=CASES)
def case(request: pytest.FixtureRequest) -> str:
    name: str = request.param
    return name


def test_output_is_as_recorded(case: str, request: pytest.FixtureRequest) -> None:
    made = outputs(case)
    update = request.config.getoption("--update-golden")
    stale = {path.name for path in (FOLDER / case).iterdir() if path.suffix in (".ir", ".cpp")} - set(made)
    for name, text in made.items():
        path = FOLDER / case / name
        if update:
            path.write_text(text)
        assert path.is_file(), f"{path} is missing; look at the output and run with --update-golden"
        assert path.read_text() == text, f"{path} differs from what the compiler makes now"
    for name in stale:
        if update:
            (FOLDER / case / name).unlink()
    assert update or not stale, f"nothing makes {stale} any more"


def seen_in_golden_files() -> set[object]:
    """Node classes, operators, and effects and states of device functions that the modules of all cases have."""
    seen: set[object] = set()
    for case in CASES:
        module = compile_file(str(FOLDER / case / "shader.py")).module
        for function in (*module.helpers, *module.programs):
            for node in (*walk.statements(function.body), *walk.expressions(function.body)):
                seen.add(type(node))
                match node:
                    case nodes.Binary(op=op) | nodes.Unary(op=op):
                        seen.add(op)
                    case nodes.IntrinsicCall(name=name) | nodes.CallIntrinsic(name=name) | nodes.Trace(name=name):
                        seen |= {INTRINSICS[name].effect, (INTRINSICS[name].effect, INTRINSICS[name].state)}
    return seen


def test_every_construct_is_in_a_golden_file() -> None:
    """A new node class, operator or kind of device function needs a golden file that shows it."""
    kinds = {row.effect for row in INTRINSICS.values()} | {(row.effect, row.state) for row in INTRINSICS.values()}
    wanted = {*get_args(nodes.Stmt), *get_args(nodes.Expr), *nodes.BinaryOp, *nodes.UnaryOp, *kinds}
    assert wanted - seen_in_golden_files() == set()


def test_output_is_the_same_twice(case: str) -> None:
    assert outputs(case) == outputs(case)


@pytest.mark.parametrize("compiler", COMPILERS)
def test_output_compiles_without_a_warning(case: str, compiler: str) -> None:
    for path in sorted((FOLDER / case).glob("*.cpp")):
        command = [compiler, *FLAGS, f"-I{include_folder()}", str(path)]
        result = subprocess.run(command, capture_output=True, text=True, check=False)
        assert result.returncode == 0, result.stderr[:4000]


@pytest.mark.parametrize("compiler", COMPILERS)
def test_packets_compile_without_optimisation(compiler: str, tmp_path: Path) -> None:
    """Instructions take immediates, which a compiler that folds nothing must still see as constants."""
    command = [compiler, *(flag for flag in FLAGS if flag != "-fsyntax-only"), "-O0", "-S", "-o", str(tmp_path / "made.s")]
    source = FOLDER / "expressions" / "pipeline_spmd.cpp"
    result = subprocess.run([*command, f"-I{include_folder()}", str(source)], capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr[:4000]
