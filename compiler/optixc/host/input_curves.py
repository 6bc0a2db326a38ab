"""Build inputs of spheres and curves."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from optixc.enums_scene import CurveEndcapFlags, PrimitiveType
from optixc.errors import InvalidValueError
from optixc.host import library
from optixc.host.inputs import BuildInput, Keys, Records, fill_keys, pointer_to, take_index_array, take_keys
from optixc.host.whole_numbers import take_member

_ENDCAPS = (CurveEndcapFlags.DEFAULT, CurveEndcapFlags.ON)
# Control points of a segment.
CURVE_CONTROL_POINTS = {
    PrimitiveType.ROUND_LINEAR: 2,
    PrimitiveType.ROUND_QUADRATIC_BSPLINE: 3,
    PrimitiveType.ROUND_CUBIC_BSPLINE: 4,
    PrimitiveType.ROUND_CATMULLROM: 4,
    PrimitiveType.ROUND_CUBIC_BEZIER: 4,
    PrimitiveType.ROUND_QUADRATIC_BSPLINE_ROCAPS: 3,
    PrimitiveType.ROUND_CUBIC_BSPLINE_ROCAPS: 4,
    PrimitiveType.ROUND_CATMULLROM_ROCAPS: 4,
    PrimitiveType.ROUND_CUBIC_BEZIER_ROCAPS: 4,
    PrimitiveType.FLAT_QUADRATIC_BSPLINE: 3,
}


def _check_key_counts(where: str, **keys: list[Any]) -> None:
    counts = {name: len(arrays) for name, arrays in keys.items()}
    if len(set(counts.values())) > 1:
        raise InvalidValueError(f"{where}: the numbers of motion keys differ: {', '.join(f'{n} of {name}' for name, n in counts.items())}")


def _take_radii(value: Any, keys: int, count: int, where: str) -> list[np.ndarray[Any, Any]]:
    """The radii of each motion key; a number stands for `count` of them at every key."""
    if isinstance(value, int | float | np.integer | np.floating) and not isinstance(value, bool):
        return [np.full(count, value, np.float32)] * keys
    return take_keys(value, ("n",), f"{where}.radii")


@dataclass
class BuildInputSpheres(Records, BuildInput):
    """Spheres: float32 centers (n, 3) and radii (n,), or one radius for all, a number or (1,).

    A ray that starts inside hits nothing. Negative radii act as their absolute value; zero and NaN are never hit.
    """

    centers: Keys
    radii: Keys

    def fill(self, target: Any, kept: list[Any]) -> None:
        where = "BuildInputSpheres"
        centers = take_keys(self.centers, ("n", 3), f"{where}.centers")
        radii = _take_radii(self.radii, len(centers), 1, where)
        _check_key_counts(where, centers=centers, radii=radii)
        count = len(centers[0])
        if len(radii[0]) not in (1, count):
            raise InvalidValueError(f"{where}: {len(radii[0])} radii for {count} spheres; give one for each, or one for all")
        target.type = library.lib().OXRT_BUILD_INPUT_SPHERES
        target.numKeys = len(centers)
        target.vertices = fill_keys(centers, kept)
        target.radii = fill_keys(radii, kept)
        target.singleRadius = len(radii[0]) == 1
        target.numVertices = target.numPrimitives = count
        self.fill_records(target, count, kept, where)


@dataclass
class BuildInputCurves(BuildInput):
    """Curves of one basis: float32 vertices (n, 3), radii (n,) or a number, and for each segment the index of its first control point.

    `normals` (n, 3) orient ribbons; without them a ribbon lies across the bends of its strand. Linear curves have spherical ends always;
    `endcap_flags` ON closes the others by discs at both ends of every strand. Curves have one SBT record and one flag word.
    """

    num_sbt_records: ClassVar[int] = 1

    curve_type: PrimitiveType | int
    vertices: Keys
    radii: Keys
    indices: Any
    normals: Keys = field(default=None, kw_only=True)
    endcap_flags: CurveEndcapFlags | int = field(default=CurveEndcapFlags.DEFAULT, kw_only=True)
    flags: Any = field(default=0, kw_only=True)
    primitive_index_offset: int = field(default=0, kw_only=True)

    def fill(self, target: Any, kept: list[Any]) -> None:
        where = "BuildInputCurves"
        kind = PrimitiveType(take_member(self.curve_type, CURVE_CONTROL_POINTS, f"{where}: curve_type"))
        vertices = take_keys(self.vertices, ("n", 3), f"{where}.vertices")
        count = len(vertices[0])
        radii = _take_radii(self.radii, len(vertices), count, where)
        _check_key_counts(where, vertices=vertices, radii=radii)
        if len(radii[0]) != count:
            raise InvalidValueError(f"{where}: {len(radii[0])} radii for {count} vertices; curves need one for each")
        indices = take_index_array(self.indices, ("m",), f"{where}.indices")
        needed = CURVE_CONTROL_POINTS[kind]
        if indices.size and int(indices.max()) + needed > count:
            raise InvalidValueError(
                f"{where}.indices holds {int(indices.max())}: a segment has {needed} control points, but there are {count} vertices"
            )
        target.type = library.lib().OXRT_BUILD_INPUT_CURVES
        target.curveType = int(kind)
        target.numKeys = len(vertices)
        target.vertices = fill_keys(vertices, kept)
        target.radii = fill_keys(radii, kept)
        target.numVertices = count
        target.indices = pointer_to(indices, "uint32_t*", kept)
        target.numPrimitives = len(indices)
        target.endcapFlags = take_member(self.endcap_flags, _ENDCAPS, f"{where}: endcap_flags")
        if self.normals is not None:
            if kind is not PrimitiveType.FLAT_QUADRATIC_BSPLINE:
                raise InvalidValueError(f"{where}: normals are for ribbons (FLAT_QUADRATIC_BSPLINE), not for {kind.name}")
            normals = take_keys(self.normals, ("n", 3), f"{where}.normals")
            if len(normals) != len(vertices) or len(normals[0]) != count:
                raise InvalidValueError(f"{where}: normals need one vector for each vertex and key")
            target.normals = fill_keys(normals, kept)
        # curves have one SBT record, so one word of flags
        Records(flags=self.flags, primitive_index_offset=self.primitive_index_offset).fill_records(target, len(indices), kept, where)
