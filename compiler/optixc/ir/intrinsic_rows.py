"""The table of device functions: all rows, by name. See `intrinsics` for what a row means."""

from __future__ import annotations

from optixc.ir import intrinsic_rows_coop_vec, intrinsic_rows_hit, intrinsic_rows_hit_object, intrinsic_rows_math, intrinsic_rows_ray
from optixc.ir.intrinsics import Intrinsic

ROWS: tuple[Intrinsic, ...] = (
    *intrinsic_rows_ray.ROWS,
    *intrinsic_rows_hit.ROWS,
    *intrinsic_rows_hit_object.ROWS,
    *intrinsic_rows_math.ROWS,
    *intrinsic_rows_coop_vec.ROWS,
)

INTRINSICS: dict[str, Intrinsic] = {row.name: row for row in ROWS}

ATOMIC_NAMES: frozenset[str] = frozenset(row.name for row in intrinsic_rows_math.ATOMICS)

OVERLOADS: dict[str, tuple[Intrinsic, ...]] = {
    name: (INTRINSICS[name], *(row for row in ROWS if row.overload_of == name))
    for name in dict.fromkeys(row.overload_of for row in ROWS if row.overload_of)
}
"""Functions with several parameter lists, by the name that authors write."""
