"""Writes docs/math.md: measured error and time of each function, scalar and over lanes, in precise and in fast mode.

    python -m benchmarks.math_table [FILE]
"""

from __future__ import annotations

import ctypes
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from benchmarks.machine import describe
from optixc.toolchain import find_compiler, processor_lanes

sys.path.append(str(Path(__file__).resolve().parents[1] / "tests" / "numerical"))

from math_kernels import Floats, Kernels, build_kernels, errors, exact, pairs, samples

NAMES = "sqrt rsqrt sin cos tan asin acos atan atan2 sinh cosh tanh exp exp2 log log2 log10 pow hypot fmod".split()
PAIRS = ("atan2", "pow", "hypot", "fmod")
ERROR_SAMPLES = 1_000_000
TIMED, REPEATS = 4096, 60
HEAD = """# Accuracy and speed of the maths

Made by `python -m benchmarks.math_table`; do not edit. Errors: the largest in units in the last place over {count:,} arguments (any bit
pattern, the usual ranges, special values), against long double; 0.5 is the nearest float32. Times: nanoseconds a value, of loops over
{timed} values between 0.1 and 0.9 in the first-level cache. Scalars and lanes give the same bits. float64 functions are those of the C
library.

{machine}

| function | precise: ulp | fast: ulp |{times}
|---|---|---|{rule}
"""


def nanoseconds(kernels: Kernels, name: str, x: Floats, y: Floats) -> float:
    """Time a value, the least of several rounds."""
    output = np.empty_like(x)
    arrays = (x, y, output) if name in PAIRS else (x, output)
    pointers = [array.ctypes.data_as(ctypes.c_void_p) for array in arrays]
    function, count = getattr(kernels.library, name), ctypes.c_long(len(x))
    best = float("inf")
    for _ in range(REPEATS):
        began = time.perf_counter()
        function(*pointers, count)
        best = min(best, time.perf_counter() - began)
    return best * 1e9 / len(x)


def worst(kernels: Kernels, name: str) -> float:
    """The largest error."""
    arguments = pairs(ERROR_SAMPLES // 4) if name in PAIRS else (samples(ERROR_SAMPLES // 3),)
    return float(errors(kernels.call(name, *arguments), exact(name, *arguments)).max())


def table() -> str:
    """The whole page."""
    compiler = find_compiler()
    widths = [lanes for lanes in (1, 8, 16) if lanes <= processor_lanes()]
    generator = np.random.default_rng(1)
    x, y = (generator.uniform(0.1, 0.9, TIMED).astype(np.float32) for _ in range(2))
    with tempfile.TemporaryDirectory() as folder:
        kernels = {(n, fast): build_kernels(Path(folder), compiler, n, fast) for n in widths for fast in (False, True)}
        columns = [(n, fast) for fast in (False, True) for n in widths]
        titles = "".join(f" {'fast' if fast else 'precise'} {n}: ns |" for n, fast in columns)
        rows = []
        for name in NAMES:
            times = "".join(f" {nanoseconds(kernels[column], name, x, y):.2f} |" for column in columns)
            rows.append(f"| {name} | {worst(kernels[1, False], name):.3f} | {worst(kernels[1, True], name):.3f} |{times}")
    about = describe()
    machine = f"{about['processor']}, {about['system']}, {compiler.kind} {'.'.join(map(str, compiler.version))}"
    head = HEAD.format(count=ERROR_SAMPLES, timed=TIMED, machine=machine, times=titles, rule="---|" * len(columns))
    return head + "\n".join(rows) + "\n"


if __name__ == "__main__":
    target = Path(sys.argv[1] if len(sys.argv) > 1 else "docs/math.md")
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(table())
