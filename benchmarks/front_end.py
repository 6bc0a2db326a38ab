"""The checker's and lowering's processor time for files of 300 to 30,000 lines full of conditions: `python -m benchmarks.front_end`."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

from optixc.frontend.compile import compile_file

SIZES = (300, 1_000, 3_000, 10_000, 30_000)
REPEATS = 3

_HEAD = '''import optixc as ox
from optixc import float3


@ox.struct
class Params:
    out: ox.Array[float3]
    limit: float


params = ox.launch_params(Params)
'''
_HELPER = '''

@ox.device
def shade_{number}(a: float, b: int, v: float3) -> float:
    result = a
    if a > 0.5 and b < 7:
        result = a * 2.0 + v.x
        if b == 3:
            result += v.y
        elif b == 4:
            result -= v.z * params.limit
        else:
            result *= 0.5
    elif a > 0.25 or b > 9:
        w = ox.normalize(v) * a
        result = ox.dot(w, v) if b > 10 else ox.length(w)
    else:
        for i in range(b):
            if i % 2 == 0:
                result += float(i) * 0.25
            elif result > 10.0:
                break
            else:
                result -= 1.0
    while result > params.limit:
        result = result * 0.5 if result > 4.0 else result - 1.0
    match b:
        case 0 | 1:
            params.out[b] = v * result
        case _:
            pass
    return result
'''
_PROGRAM = '''

@ox.program
def __raygen__main():
    i = ox.get_launch_index()
    total = 0.0
'''
_CALL = "    total += shade_{number}(float(i.x), int(i.y), float3(float(i.x)))\n"


def shader_text(lines: int) -> str:
    """A file of about that many lines: helpers of branches and loops, and a program that calls them all."""
    fixed = len((_HEAD + _PROGRAM).splitlines()) + 1
    count = max(1, (lines - fixed) // (len(_HELPER.splitlines()) + 1))
    helpers = "".join(_HELPER.replace("{number}", str(number)) for number in range(count))
    calls = "".join(_CALL.replace("{number}", str(number)) for number in range(count))
    return f"{_HEAD}{helpers}{_PROGRAM}{calls}    params.out[i.x] = float3(total)\n"


def seconds(path: Path) -> float:
    """The best of some runs: parsing, checking and lowering of one file."""
    found = []
    for _ in range(REPEATS):
        start = time.process_time()
        compile_file(str(path))
        found.append(time.process_time() - start)
    return min(found)


def main() -> None:
    """Prints the curve."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "shader.py"
        path.write_text(shader_text(SIZES[0]))
        compile_file(str(path))
        print("| lines | ms | microseconds a line |\n| ---: | ---: | ---: |")
        for size in SIZES:
            text = shader_text(size)
            path.write_text(text)
            count = text.count("\n")
            taken = seconds(path)
            print(f"| {count} | {1e3 * taken:.0f} | {1e6 * taken / count:.0f} |", flush=True)


if __name__ == "__main__":
    main()
