"""Reflectance of smooth surfaces for unpolarised light. Cosines are against the normal, on the side of the incoming direction."""

import optixc as ox
from optixc import float3


@ox.device
def fresnel_dielectric(cosine: float, eta: float) -> float:
    """Reflected share at a boundary of two transparent media; `eta` is the index of the far side over that of the near side, `cosine`
    is not negative. 1 on total internal reflection. PBRT 4ed. 9.3.5."""
    transmitted_squared = 1.0 - (1.0 - cosine * cosine) / (eta * eta)
    if transmitted_squared <= 0.0:
        return 1.0
    transmitted = ox.sqrt(transmitted_squared)
    parallel = (eta * cosine - transmitted) / (eta * cosine + transmitted)
    perpendicular = (cosine - eta * transmitted) / (cosine + eta * transmitted)
    return 0.5 * (parallel * parallel + perpendicular * perpendicular)


@ox.device
def fresnel_conductor_channel(cosine: float, eta: float, k: float) -> float:
    """Reflected share at a metal with the complex index eta + i k, seen from air. PBRT 4ed. 9.3.6; S. Lagarde, 2013."""
    cosine_squared = cosine * cosine
    sine_squared = 1.0 - cosine_squared
    t0 = eta * eta - k * k - sine_squared
    a2_plus_b2 = ox.sqrt(t0 * t0 + 4.0 * eta * eta * k * k)
    t1 = a2_plus_b2 + cosine_squared
    a = ox.sqrt(ox.max(0.5 * (a2_plus_b2 + t0), 0.0))
    t2 = 2.0 * a * cosine
    perpendicular = (t1 - t2) / (t1 + t2)
    t3 = cosine_squared * a2_plus_b2 + sine_squared * sine_squared
    t4 = t2 * sine_squared
    return 0.5 * (perpendicular + perpendicular * (t3 - t4) / (t3 + t4))


@ox.device
def fresnel_conductor(cosine: float, eta: float3, k: float3) -> float3:
    """The same for three wavelengths, e.g. gold: eta (0.143, 0.375, 1.442), k (3.983, 2.386, 1.603)."""
    return float3(
        fresnel_conductor_channel(cosine, eta.x, k.x),
        fresnel_conductor_channel(cosine, eta.y, k.y),
        fresnel_conductor_channel(cosine, eta.z, k.z),
    )


@ox.device
def fresnel_schlick(normal_reflectance: float3, cosine: float) -> float3:
    """An approximation from the reflectance at normal incidence. C. Schlick, 1994."""
    m = ox.clamp(1.0 - cosine, 0.0, 1.0)
    m2 = m * m
    return normal_reflectance + (float3(1.0) - normal_reflectance) * (m2 * m2 * m)
