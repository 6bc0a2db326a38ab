"""Small numeric helpers that shaders keep writing."""

import optixc as ox
from optixc import float2, float3

PI = 3.14159265358979323846
INV_PI = 0.31830988618379067154


@ox.device
def square(x: float) -> float:
    """x times x."""
    return x * x


@ox.device
def safe_sqrt(x: float) -> float:
    """The square root; 0 where rounding made x negative."""
    return ox.sqrt(ox.max(x, 0.0))


@ox.device
def safe_acos(x: float) -> float:
    """The arc cosine; clamps what rounding pushed out of [-1, 1]."""
    return ox.acos(ox.clamp(x, -1.0, 1.0))


@ox.device
def max_component(v: float3) -> float:
    """The largest of the three."""
    return ox.max(v.x, ox.max(v.y, v.z))


@ox.device
def luminance(color: float3) -> float:
    """Relative luminance of linear sRGB (ITU-R BT.709)."""
    return 0.2126 * color.x + 0.7152 * color.y + 0.0722 * color.z


@ox.device
def power_heuristic(pdf: float, other_pdf: float) -> float:
    """Weight of a sample that two techniques could have made. E. Veach, "Robust Monte Carlo Methods", 1997, section 9.2.4."""
    if pdf <= 0.0:
        return 0.0
    ratio = other_pdf / pdf
    return 1.0 / (1.0 + ratio * ratio)


@ox.device
def balance_heuristic(pdf: float, other_pdf: float) -> float:
    """The simpler weight of the same section."""
    return pdf / (pdf + other_pdf) if pdf > 0.0 else 0.0


@ox.device
def spherical_direction(theta: float, phi: float) -> float3:
    """Angle from z and azimuth from x to a direction."""
    sine = ox.sin(theta)
    return float3(sine * ox.cos(phi), sine * ox.sin(phi), ox.cos(theta))


@ox.device
def spherical_angles(w: float3) -> float2:
    """The reverse: theta in [0, pi], phi in [-pi, pi]."""
    return float2(safe_acos(w.z), ox.atan2(w.y, w.x))
