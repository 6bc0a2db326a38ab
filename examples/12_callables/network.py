"""Graphs of material nodes on the host: each node becomes one record among the table's callables."""

from __future__ import annotations

from typing import Any

import shader

import optixc as ox

COLORS = ("constant", "checker", "noise", "rings", "facing")
REFLECTIONS = ("diffuse", "metal", "velvet", "coat", "blend")


class Network:
    """Nodes in the order in which they were made; a node's inputs come before it, so a graph has no circles."""

    def __init__(self, context: ox.DeviceContext, module: ox.Module) -> None:
        self.groups = {
            name: context.program_group_create(direct_callable=module[f"__direct_callable__{name}"]) for name in (*COLORS, *REFLECTIONS)
        }
        self.records: list[ox.Record] = []

    def _add(self, name: str, data: Any) -> int:
        self.records.append(self.groups[name].record(data))
        return len(self.records) - 1

    def color(self, r: float, g: float, b: float) -> int:
        return self._add("constant", shader.Constant((r, g, b)))

    def checker(self, even: int, odd: int, scale: float) -> int:
        return self._add("checker", shader.Checker(even, odd, scale))

    def noise(self, low: int, high: int, scale: float, octaves: int = 5, band: float = 0.8) -> int:
        return self._add("noise", shader.Noise(low, high, scale, octaves, band))

    def rings(self, early: int, late: int, axis: tuple[float, float, float], scale: float, turbulence: float, sharpness: float) -> int:
        return self._add("rings", shader.Rings(early, late, axis, scale, turbulence, sharpness))

    def facing(self, center: int, edge: int, power: float) -> int:
        return self._add("facing", shader.Facing(center, edge, power))

    def diffuse(self, color: int) -> int:
        return self._add("diffuse", shader.Diffuse(color))

    def metal(self, color: int, roughness: float) -> int:
        return self._add("metal", shader.Metal(color, roughness))

    def velvet(self, color: int, base: int) -> int:
        return self._add("velvet", shader.Velvet(color, base))

    def coat(self, base: int, refractive_index: float = 1.5, roughness: float = 0.12) -> int:
        return self._add("coat", shader.Coat(base, refractive_index, roughness))

    def blend(self, first: int, second: int, mask: int) -> int:
        return self._add("blend", shader.Blend(first, second, mask))


def paper(net: Network) -> int:
    """The backdrop: hardly uneven, hardly glossy."""
    return net.coat(net.diffuse(net.noise(net.color(0.50, 0.48, 0.46), net.color(0.57, 0.55, 0.53), 0.7)), roughness=0.35)


def marble(net: Network) -> int:
    white = net.noise(net.color(0.80, 0.79, 0.76), net.color(0.62, 0.61, 0.60), 2.5)
    return net.coat(net.diffuse(net.rings(white, net.color(0.10, 0.11, 0.13), (0.6, 0.48, 0.64), 1.1, 4.5, 14.0)))


def wood(net: Network) -> int:
    grain = net.noise(net.color(0.46, 0.24, 0.09), net.color(0.56, 0.32, 0.14), 9.0)
    return net.coat(net.diffuse(net.rings(grain, net.color(0.19, 0.075, 0.025), (0.75, 0.35, 0.55), 5.0, 1.1, 2.2)), roughness=0.2)


def gilded(net: Network) -> int:
    """Squares of gold on black rubber."""
    mask = net.checker(net.color(0.0, 0.0, 0.0), net.color(1.0, 1.0, 1.0), 3.0)
    rubber = net.coat(net.diffuse(net.color(0.02, 0.02, 0.022)), roughness=0.45)
    return net.blend(net.metal(net.color(1.0, 0.72, 0.28), 0.16), rubber, mask)


def rusty(net: Network) -> int:
    """Rust in patches on iron."""
    spots = net.noise(net.color(0.16, 0.045, 0.015), net.color(0.42, 0.15, 0.045), 7.0)
    mask = net.noise(net.color(0.0, 0.0, 0.0), net.color(1.0, 1.0, 1.0), 2.3, octaves=6, band=0.12)
    return net.blend(net.metal(net.color(0.56, 0.56, 0.55), 0.3), net.diffuse(spots), mask)


def car_paint(net: Network) -> int:
    """A metal that changes its colour with the angle, under lacquer."""
    return net.coat(net.metal(net.facing(net.color(0.03, 0.30, 0.62), net.color(0.55, 0.10, 0.62), 1.2), 0.38), roughness=0.1)


def cloth(net: Network) -> int:
    base = net.diffuse(net.noise(net.color(0.20, 0.012, 0.02), net.color(0.30, 0.02, 0.035), 14.0))
    return net.velvet(net.color(0.75, 0.24, 0.24), base)


def jade(net: Network) -> int:
    """A glaze over green clouds."""
    clouds = net.noise(net.color(0.04, 0.27, 0.15), net.color(0.32, 0.60, 0.38), 1.8, octaves=6)
    return net.coat(net.diffuse(net.facing(clouds, net.color(0.55, 0.75, 0.55), 3.0)), refractive_index=1.6)


def patina(net: Network) -> int:
    """Copper, with verdigris where noise says so, some of it under a blend of its own."""
    green = net.diffuse(net.noise(net.color(0.10, 0.38, 0.32), net.color(0.25, 0.55, 0.48), 5.0))
    mask = net.noise(net.color(0.0, 0.0, 0.0), net.color(1.0, 1.0, 1.0), 3.1, octaves=6, band=0.3)
    return net.blend(net.metal(net.color(0.95, 0.56, 0.42), 0.22), green, mask)


def candy(net: Network) -> int:
    """Red and white stripes under sugar."""
    stripes = net.rings(net.color(0.80, 0.76, 0.70), net.color(0.62, 0.02, 0.03), (0.0, 1.0, 0.0), 6.0, 0.0, 1.0)
    return net.coat(net.diffuse(stripes), roughness=0.15)
