"""The network on the host: float32 weights, their copies as shaders multiply with them, and Adam."""

from __future__ import annotations

import numpy as np

import optixc as ox
from optixc import CoopVecElemType as Element
from optixc import CoopVecMatrixDescription as Matrix
from optixc import CoopVecMatrixLayout as Layout

SHAPES = ((32, 24), (32, 32), (3, 32))
BETAS = (0.9, 0.99)


class Network:
    """Weights of three layers in one array of float32; `memory` and `gradients` are what shaders read and add to."""

    def __init__(self, context: ox.DeviceContext, seed: int = 1) -> None:
        self._context = context
        self._rows, self._optimal, self.matrices, self.biases = [], [], [], []
        start = end = 0
        for n, k in SHAPES:
            self._rows.append(Matrix(n, k, start, Element.FLOAT32))
            self._optimal.append(Matrix(n, k, end, Element.FLOAT16, Layout.TRAINING_OPTIMAL))
            self.matrices.append(end)
            start += context.coop_vec_matrix_compute_size(n, k, Element.FLOAT32, Layout.ROW_MAJOR)
            end += context.coop_vec_matrix_compute_size(n, k, Element.FLOAT16, Layout.TRAINING_OPTIMAL)
            self.biases.append(end)
            end += 64
        self.memory, self.gradients = np.zeros(end, np.uint8), np.zeros(end, np.uint8)
        self.bias_gradients = np.zeros(sum(n for n, _ in SHAPES), np.float32)
        # All weights, then all biases.
        self._weights = np.zeros(start // 4 + len(self.bias_gradients), np.float32)
        self._moments = np.zeros((2, len(self._weights)))
        self._step = 0
        random = np.random.default_rng(seed)
        for rows, (n, k) in zip(self._rows, SHAPES, strict=True):
            first = rows.offset_in_bytes // 4
            self._weights[first : first + n * k] = random.normal(0.0, np.sqrt(2.0 / k), n * k)
        self._biases_start = start // 4
        self._write()

    def learn(self, batch: int, rate: float) -> None:
        """One step down the mean gradient that the shaders left; the accumulators are zero again.

        D. P. Kingma, J. Ba, "Adam: A Method for Stochastic Optimization", 2015.
        """
        rows = self._context.coop_vec_matrix_convert(self._optimal, self.gradients, self._rows)
        gradient = np.concatenate((rows.view(np.float32), self.bias_gradients)) / batch
        self._step += 1
        for moment, beta, power in zip(self._moments, BETAS, (1, 2), strict=True):
            moment += (1.0 - beta) * (gradient**power - moment)
        mean, square = (moment / (1.0 - beta**self._step) for moment, beta in zip(self._moments, BETAS, strict=True))
        self._weights -= (rate * mean / (np.sqrt(square) + 1e-8)).astype(np.float32)
        self.gradients[:] = 0
        self.bias_gradients[:] = 0.0
        self._write()

    def _write(self) -> None:
        """The weights as shaders read them."""
        self._context.coop_vec_matrix_convert(self._rows, self._weights[: self._biases_start], self._optimal, self.memory)
        first = self._biases_start
        for place, (n, _) in zip(self.biases, SHAPES, strict=True):
            self.memory[place : place + 2 * n] = self._weights[first : first + n].astype(np.float16).view(np.uint8)
            first += n
