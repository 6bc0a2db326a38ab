"""Damaged shader files: the front end gives diagnostics or a module, never another exception; what it accepts becomes C++ that compiles."""

from __future__ import annotations

from pathlib import Path
from random import Random

import pytest
from mutations import mutated

from optixc import driver, toolchain
from optixc.diagnostics import CompileError
from optixc.errors import OptixError
from optixc.frontend.compile import FrontendResult, compile_file
from optixc.ir.programs import ProgramKind
from optixc.ir.verify import verify
from optixc.options import CompileOptions

ROOT = Path(__file__).parents[2]
FOLDERS = ("examples/*/shader.py", "tests/golden/*/shader.py", "tests/conformance/shaders/*.py")
SHADERS = sorted(path for pattern in FOLDERS for path in ROOT.glob(pattern))
LANES = (1, 8, 16)


def front_end(path: Path, folder: Path) -> FrontendResult | None:
    """The module, or None where there are diagnostics; each of them stands in some file."""
    try:
        result = compile_file(str(path), include_dirs=[str(folder)])
        assert verify(result.module) == []
        return result
    except CompileError as error:
        assert error.diagnostics
        assert all(diagnostic.span.line >= 1 and diagnostic.message for diagnostic in error.diagnostics)
        return None


def emitted(result: FrontendResult, lanes: int) -> str | None:
    """The C++ of all programs in one pipeline; None where linking refuses them."""
    names = [program.name for program in result.module.programs]
    if not any(program.kind is ProgramKind.RAYGEN for program in result.module.programs):
        return None
    try:
        return driver.emit([result.module], names, CompileOptions(simd=lanes, optimization=0, max_trace_depth=2)).text
    except OptixError:
        return None


@pytest.mark.parametrize("shader", SHADERS, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_damaged_files(request: pytest.FixtureRequest, shader: Path, tmp_path: Path) -> None:
    """Damages of one file, the same every time; --fuzz makes many more, and compiles one in 20 that pass."""
    long_run = bool(request.config.getoption("--fuzz"))
    count = int(request.config.getoption("--programs")) // len(SHADERS) if long_run else 12
    random = Random(f"{shader.parent.name} {shader.stem} {long_run}")
    original = shader.read_text()
    path = tmp_path / "shader.py"
    accepted = 0
    for number in range(count):
        path.write_text(mutated(random, original, random.choice((1, 1, 1, 2, 4))))
        result = front_end(path, shader.parent)
        if result is None:
            continue
        text = emitted(result, LANES[number % len(LANES)])
        accepted += text is not None
        if text is not None and accepted % 20 == 1 and (long_run or number < 6):
            options = CompileOptions(simd=LANES[number % len(LANES)], optimization=0)
            toolchain.compile_shared(text, tmp_path / "shader.so", toolchain.find_compiler(None), driver.recipe(options))
