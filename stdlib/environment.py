"""Light from an environment map, drawn in proportion to its brightness.

The map is latitude and longitude: row 0 looks up (+y), the middle column looks along -z, columns grow to the right (+x).
`environment_map` makes the tables from an array, on the host; the other functions are for shaders. PBRT 4ed. 12.5, A.4.
"""

import numpy as np
import numpy.typing as npt

import optixc as ox
from optixc import float2, float3
from optixc.stdlib.math import INV_PI, PI, safe_acos


@ox.struct
class EnvironmentMap:
    """`rows[i]` is the share of rows above and including i, `columns[i, j]` that of columns within row i; `density` is per unit square."""

    radiance: ox.Array2[float3]
    density: ox.Array2[float]
    rows: ox.Array[float]
    columns: ox.Array2[float]


@ox.struct
class EnvironmentSample:
    """`pdf` is per steradian."""

    to_light: float3
    radiance: float3
    pdf: float


def environment_map(rgb: npt.ArrayLike) -> EnvironmentMap:
    """Tables for a (height, width, 3) array of linear radiance; an all-black map is drawn from uniformly."""
    radiance = np.ascontiguousarray(rgb, np.float32)
    height, width = radiance.shape[:2]
    weights = radiance.astype(np.float64) @ [0.2126, 0.7152, 0.0722]
    weights *= np.sin((np.arange(height) + 0.5) * np.pi / height)[:, np.newaxis]
    if weights.sum() <= 0.0:
        weights = np.ones((height, width)) * np.sin((np.arange(height) + 0.5) * np.pi / height)[:, np.newaxis]
    row_sums = weights.sum(axis=1)
    shares = np.divide(weights, row_sums[:, np.newaxis], out=np.full((height, width), 1.0 / width), where=row_sums[:, np.newaxis] > 0.0)
    return EnvironmentMap(
        radiance=radiance,
        density=(weights / weights.mean()).astype(np.float32),
        rows=(np.cumsum(row_sums) / row_sums.sum()).astype(np.float32),
        columns=np.cumsum(shares, axis=1).astype(np.float32),
    )


@ox.device
def environment_direction(place: float2) -> float3:
    """From a point of the unit square, (0, 0) upper left, to the direction that it shows."""
    phi = (2.0 * place.x - 1.0) * PI
    theta = place.y * PI
    sine = ox.sin(theta)
    return float3(sine * ox.sin(phi), ox.cos(theta), -sine * ox.cos(phi))


@ox.device
def environment_place(direction: float3) -> float2:
    """The reverse, for a unit direction."""
    return float2(0.5 + 0.5 * INV_PI * ox.atan2(direction.x, -direction.z), INV_PI * safe_acos(direction.y))


@ox.device
def first_above_row(environment: EnvironmentMap, u: float) -> int:
    """The first row whose share of all is above u."""
    low = 0
    high = int(environment.rows.shape[0]) - 1
    while low < high:
        middle = (low + high) // 2
        if environment.rows[middle] > u:
            high = middle
        else:
            low = middle + 1
    return low


@ox.device
def first_above_column(environment: EnvironmentMap, row: int, u: float) -> int:
    """The first column of a row whose share of the row is above u."""
    low = 0
    high = int(environment.columns.shape[1]) - 1
    while low < high:
        middle = (low + high) // 2
        if environment.columns[row, middle] > u:
            high = middle
        else:
            low = middle + 1
    return low


@ox.device
def environment_sample(environment: EnvironmentMap, u: float2) -> EnvironmentSample:
    """A direction in proportion to luminance, constant within a texel's square."""
    # Row, then column; what is left of u places the point inside the texel
    row = first_above_row(environment, u.y)
    above = 0.0
    if row > 0:
        above = environment.rows[row - 1]
    column = first_above_column(environment, row, u.x)
    before = 0.0
    if column > 0:
        before = environment.columns[row, column - 1]
    down = (u.y - above) / ox.max(environment.rows[row] - above, 1e-20)
    across = (u.x - before) / ox.max(environment.columns[row, column] - before, 1e-20)

    height, width = float(environment.columns.shape[0]), float(environment.columns.shape[1])
    place = float2((float(column) + ox.saturate(across)) / width, (float(row) + ox.saturate(down)) / height)
    sine = ox.sin(place.y * PI)
    pdf = environment.density[row, column] / (2.0 * PI * PI * sine) if sine > 0.0 else 0.0
    return EnvironmentSample(environment_direction(place), environment.radiance[row, column], pdf)


@ox.device
def environment_texel(environment: EnvironmentMap, direction: float3) -> tuple[int, int]:
    """Row and column that a direction sees."""
    place = environment_place(direction)
    height, width = int(environment.columns.shape[0]), int(environment.columns.shape[1])
    row = ox.clamp(int(place.y * float(height)), 0, height - 1)
    column = ox.clamp(int(place.x * float(width)), 0, width - 1)
    return row, column


@ox.device
def environment_radiance(environment: EnvironmentMap, direction: float3) -> float3:
    """What arrives from a unit direction; the nearest texel, as `environment_sample` sees it."""
    row, column = environment_texel(environment, direction)
    return environment.radiance[row, column]


@ox.device
def environment_pdf(environment: EnvironmentMap, direction: float3) -> float:
    """Density of `environment_sample` per steradian."""
    row, column = environment_texel(environment, direction)
    sine = ox.sqrt(ox.max(1.0 - direction.y * direction.y, 0.0))
    return environment.density[row, column] / (2.0 * PI * PI * sine) if sine > 0.0 else 0.0
