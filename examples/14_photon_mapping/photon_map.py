"""Photons in a grid, and the account of their power. Numpy only."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shader
from shader import Fate


@dataclass(frozen=True)
class Account:
    """Power by colour channel, summed in double precision, and photons counted."""

    emitted: np.ndarray
    kept: np.ndarray
    escaped: np.ndarray
    taken: np.ndarray
    photons: int
    kept_photons: int
    caustic_photons: int

    def error(self) -> float:
        """The part of the emitted power that is missing, or too much."""
        return float(np.abs(self.kept + self.escaped + self.taken - self.emitted).max() / self.emitted.max())


def account(photons: np.ndarray, taken: np.ndarray, photon_power: np.ndarray) -> Account:
    """Where the power of one photon pass went."""
    power, fate = photons["power"].astype(np.float64), photons["fate"]
    kept, caustic = fate <= Fate.CAUSTIC, fate == Fate.CAUSTIC
    return Account(
        emitted=photon_power.astype(np.float64) * len(photons),
        kept=power[kept].sum(axis=0),
        escaped=power[fate == Fate.ESCAPED].sum(axis=0),
        taken=taken.sum(axis=0, dtype=np.float64),
        photons=len(photons),
        kept_photons=int(kept.sum()),
        caustic_photons=int(caustic.sum()),
    )


def rounding_bound() -> float:
    """What float32 can lose: at each bounce one product and one sum for what is taken, and one product for what goes on, each off by at
    most half a unit in the last place of numbers below the photon's power."""
    return 4.0 * (shader.MAX_BOUNCES + 1) * 2.0**-24


def grid(photons: np.ndarray, radius: float) -> shader.Grid:
    """Sorts the kept photons into cells as wide as the radius."""
    kept = photons[photons["fate"] <= Fate.CAUSTIC]
    if len(kept) == 0:
        return shader.Grid(np.zeros(1, shader.Photon), np.zeros(2, np.uint32), (0.0, 0.0, 0.0), (1, 1, 1), radius)
    low, high = kept["position"].min(axis=0), kept["position"].max(axis=0)
    size = np.floor((high - low) / np.float32(radius)).astype(np.int64) + 1
    cells = np.minimum(np.floor((kept["position"] - low) / np.float32(radius)).astype(np.int64), size - 1)
    numbers = (cells[:, 2] * size[1] + cells[:, 1]) * size[0] + cells[:, 0]
    order = np.argsort(numbers, kind="stable")
    starts = np.concatenate([[0], np.cumsum(np.bincount(numbers, minlength=int(size.prod())))])
    return shader.Grid(kept[order], starts.astype(np.uint32), low, size, radius)
