"""A network for every launch index against numpy's matrix products over all of them: `python -m benchmarks.coop_vec [--clock cpu]`.

One thread, ours and OpenBLAS's; medians over interleaved rounds. The network has 32 inputs, two hidden layers of 64 and 3 outputs; inputs
and outputs are float32 in memory for all. numpy multiplies all rows at once, and by blocks that stay in the cache; the better counts.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

import optixc as ox
from benchmarks.measure import Clock, LaunchContender, interleave
from benchmarks.ours import shader_module
from optixc import CoopVecElemType as Element
from optixc import CoopVecMatrixDescription as Matrix
from optixc import CoopVecMatrixLayout as Layout

SIZES = (32, 64, 64, 3)
SHAPES = tuple(zip(SIZES[1:], SIZES[:-1], strict=True))
BLOCK = 2048
SCALE = 1.0 / 64.0
FORMS = {
    "float16": (Element.FLOAT16, Layout.INFERENCING_OPTIMAL, np.float16),
    "float32": (Element.FLOAT32, Layout.INFERENCING_OPTIMAL, np.float32),
    "float16_rows": (Element.FLOAT16, Layout.ROW_MAJOR, np.float16),
    "int8": (Element.INT8, Layout.INFERENCING_OPTIMAL, np.int32),
    "loops": (Element.FLOAT32, Layout.ROW_MAJOR, np.float32),
}
BLAS_THREADS = "OPENBLAS_NUM_THREADS"
Floats = np.ndarray[Any, np.dtype[np.float32]]


@dataclass
class NumpyContender:
    """A function of numpy that computes all outputs once."""

    name: str
    compute: Callable[[], None]

    def run(self) -> float:
        """Computes once; the seconds that it took."""
        start = time.perf_counter()
        self.compute()
        return time.perf_counter() - start


class Network:
    """Weights that all contenders share, inputs, and what numpy makes of them."""

    def __init__(self, count: int) -> None:
        random = np.random.default_rng(3)
        # Multiples of 1/64 below 2 are int8 times the scale, so that the integers have the same weights; some inputs are beyond.
        self.layers = [np.round(random.normal(0.0, k**-0.5, (n, k)) / SCALE).clip(-127, 127).astype(np.float32) * np.float32(SCALE)
                       for n, k in SHAPES]
        self.biases = [np.zeros(n, np.float32) for n, _ in SHAPES]
        self.features = np.round(random.normal(0.0, 0.3, (count, SIZES[0])) / SCALE).astype(np.float32) * np.float32(SCALE)
        self.out = np.zeros((count, SIZES[-1]), np.float32)

    def all_at_once(self) -> None:
        """One product of matrices for each layer."""
        self._apply(self.features, self.out)

    def by_blocks(self) -> None:
        """The same for some rows at a time, whose hidden values stay in the cache."""
        for start in range(0, len(self.features), BLOCK):
            self._apply(self.features[start : start + BLOCK], self.out[start : start + BLOCK])

    def _apply(self, rows: Floats, out: Floats) -> None:
        for number, (weights, bias) in enumerate(zip(self.layers, self.biases, strict=True)):
            is_last = number == len(SHAPES) - 1
            rows = np.matmul(rows, weights.T, out=out if is_last else None)
            rows += bias
            if not is_last:
                np.maximum(rows, 0.0, out=rows)


def contender(context: ox.DeviceContext, network: Network, name: str, lanes: int) -> LaunchContender:
    """One form of the shader at one width."""
    shader = shader_module("coop_vec")
    raygen = context.program_group_create(raygen=context.module_create(shader)[f"__raygen__{name}"])
    pipeline = context.pipeline_create([raygen], simd=lanes)
    element, layout, bias_type = FORMS[name]
    parts, matrices, biases, end = [], [], [], 0
    for weights, bias, (n, k) in zip(network.layers, network.biases, SHAPES, strict=True):
        given = np.rint(weights / SCALE).astype(np.int8) if element is Element.INT8 else weights
        plain = Element.INT8 if element is Element.INT8 else Element.FLOAT32
        stored = context.coop_vec_matrix_convert([Matrix(n, k, 0, plain)], given, [Matrix(n, k, 0, element, layout)])
        size = context.coop_vec_matrix_compute_size(n, k, element, layout)
        padded = np.zeros(size + 256, np.uint8)
        padded[: stored.size] = stored
        padded[size : size + n * np.dtype(bias_type).itemsize] = bias.astype(bias_type).view(np.uint8)
        parts.append(padded)
        matrices.append(end)
        biases.append(end + size)
        end += padded.size
    weights_of_loops = np.concatenate([part for w, b in zip(network.layers, network.biases, strict=True) for part in (w.reshape(-1), b)])
    params = shader.Params(network.features.reshape(-1), np.concatenate(parts), matrices, biases, weights_of_loops,
                           np.zeros_like(network.out), SCALE)
    table = ox.ShaderBindingTable(raygen=raygen.record())
    return LaunchContender(f"{name} {lanes}", pipeline, table, params, len(network.features), 1)


def main() -> None:
    form = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(prog="python -m benchmarks.coop_vec", description=__doc__, formatter_class=form)
    parser.add_argument("--count", type=int, default=512 * 512, help="launch indices")
    parser.add_argument("--lanes", type=lambda text: tuple(map(int, text.split(","))), default=(1, 8, 16), help="comma-separated widths")
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--clock", choices=[clock.value for clock in Clock], default=Clock.WALL.value, help="cpu: on a busy machine")
    arguments = parser.parse_args()
    if os.environ.get(BLAS_THREADS) != "1":
        # OpenBLAS reads it when numpy is imported.
        os.environ[BLAS_THREADS] = "1"
        os.execv(sys.executable, [sys.executable, "-m", "benchmarks.coop_vec", *sys.argv[1:]])
    context, network = ox.DeviceContext(threads=1), Network(arguments.count)
    ours = [contender(context, network, name, lanes) for name in FORMS for lanes in arguments.lanes]
    numpys = [NumpyContender("numpy at once", network.all_at_once), NumpyContender("numpy by blocks", network.by_blocks)]
    for one in (*numpys, *ours):
        one.run()
    for one in ours:
        # float16 rounds each layer to 11 bits; int8 rounds and limits what goes into a layer, so it is another network.
        worst = float(np.abs(one.params.out - network.out).max())
        assert one.name.startswith("int8") or worst < 0.02, f"{one.name} differs from numpy by {worst}"
    timings = interleave([*numpys, *ours], arguments.rounds, Clock(arguments.clock))
    best = timings.fastest([one.name for one in numpys])
    operations = 2.0 * sum(n * k for n, k in SHAPES) * arguments.count
    print(f"{arguments.count} networks of {sum(n * k for n, k in SHAPES)} weights")
    for one in (*numpys, *ours):
        seconds = timings.median(one.name)
        ratio = timings.speed_up(one.name, best)
        print(f"{one.name:18} {1e3 * seconds:8.1f} ms {operations / seconds / 1e9:7.1f} GFLOP/s  {ratio:5.2f} of {best}")


if __name__ == "__main__":
    main()
