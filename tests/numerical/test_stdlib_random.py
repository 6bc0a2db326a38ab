"""Random numbers of the shader library against published values and the properties that they promise."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest


def test_pcg32_gives_the_published_sequence(library: Any) -> None:
    # The reference program's first numbers for seed 42, sequence 54
    result = library.run_words("pcg32", np.array([[42, 54, 0, 0]]), 1)[0]
    assert [hex(word) for word in result] == ["0xa15c02b7", "0x7b47f409", "0xba1d3330", "0x83d2f293"]


@pytest.mark.parametrize(
    ("counter", "key", "expected"),
    [
        ((0, 0, 0, 0), (0, 0), (0x6627E8D5, 0xE169C58D, 0xBC57AC4C, 0x9B00DBD8)),
        ((0xFFFFFFFF,) * 4, (0xFFFFFFFF,) * 2, (0x408F276D, 0x41C83B0E, 0xA20BC7C6, 0x6D5451FD)),
        (
            (0x243F6A88, 0x85A308D3, 0x13198A2E, 0x03707344),
            (0xA4093822, 0x299F31D0),
            (0xD16CFE09, 0x94FDCCEB, 0x5001E420, 0x24126EA1),
        ),
    ],
    ids=["zeros", "ones", "pi"],
)
def test_philox_gives_the_published_answers(library: Any, counter: tuple, key: tuple, expected: tuple) -> None:
    result = library.run_words("philox", np.array([counter, (*key, 0, 0)]), 1)[0]
    assert tuple(int(word) for word in result) == expected


def test_pcg32_below_is_in_range_and_even(library: Any) -> None:
    count, bound = 60000, 6
    inputs = np.zeros((count, 4), np.uint32)
    inputs[:, 0], inputs[:, 1], inputs[:, 2] = np.arange(count), 7, bound
    values = library.run_words("pcg32_below", inputs, count)[:, 0]
    counts = np.bincount(values, minlength=bound)
    assert len(counts) == bound
    # A count is binomial: its standard deviation is sqrt(n p (1 - p)); five of them for six counts
    assert np.abs(counts - count / bound).max() < 5.0 * np.sqrt(count / bound * (1.0 - 1.0 / bound))


@pytest.mark.parametrize("seed", [0, 1, 12345])
@pytest.mark.parametrize("first", [0, 256])
def test_sobol_points_are_a_net(library: Any, seed: int, first: int) -> None:
    inputs = np.column_stack([np.arange(first, first + 256), np.full(256, seed)]).astype(np.float32)
    points = library.run("sobol", inputs)[:, :2].astype(np.float64)
    assert points.min() >= 0.0
    assert points.max() < 1.0
    for split in range(9):
        columns, rows = 2**split, 2 ** (8 - split)
        cells = (points[:, 0] * columns).astype(int) * rows + (points[:, 1] * rows).astype(int)
        assert len(set(cells.tolist())) == 256, f"{columns} x {rows}"


def test_owen_scrambles_differ_and_are_uniform(library: Any) -> None:
    count = 20000
    inputs = np.column_stack([np.full(count, 3), np.arange(count)]).astype(np.float32)
    points = library.run("sobol", inputs)[:, :2].astype(np.float64)
    # The mean of n uniform numbers has a standard deviation of 1 / sqrt(12 n)
    assert np.abs(points.mean(axis=0) - 0.5).max() < 5.0 / np.sqrt(12.0 * count)
    correlation = np.corrcoef(points.T)[0, 1]
    assert abs(correlation) < 5.0 / np.sqrt(count)
