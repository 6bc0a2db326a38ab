"""Disney's principled BRDF of 2012, reflection only: diffuse, sheen, GGX specular and clear coat."""

import optixc as ox
from optixc import float3


@ox.struct
class Principled:
    """Record data of a principled surface; all but the color are in [0, 1]."""

    color: float3
    metallic: float
    roughness: float
    specular: float
    sheen: float
    clearcoat: float


@ox.device
def schlick(cosine: float) -> float:
    """(1 - cosine)^5."""
    m = ox.clamp(1.0 - cosine, 0.0, 1.0)
    return m * m * (m * m) * m


@ox.device
def ggx(n_h: float, alpha: float) -> float:
    """The GGX distribution of half vectors."""
    a2 = alpha * alpha
    t = 1.0 + (a2 - 1.0) * n_h * n_h
    return a2 / (3.141592654 * t * t)


@ox.device
def smith(n_v: float, alpha: float) -> float:
    """Smith's masking term over 2 cos(theta)."""
    a2 = alpha * alpha
    return 1.0 / (n_v + ox.sqrt(a2 + n_v * n_v - a2 * n_v * n_v))


@ox.device
def principled(surface: Principled, color: float3, roughness: float, n: float3, wo: float3, wi: float3) -> float3:
    """The BRDF for unit vectors; zero below the surface. `color` and `roughness` replace the record's."""
    n_l = ox.dot(n, wi)
    n_v = ox.dot(n, wo)
    if n_l <= 0.0 or n_v <= 0.0:
        return float3(0.0)
    half = ox.normalize(wo + wi)
    n_h = ox.dot(n, half)
    l_h = ox.dot(wi, half)
    luminance = 0.3 * color.x + 0.6 * color.y + 0.1 * color.z
    tint = color * (1.0 / luminance) if luminance > 0.0 else float3(1.0)
    f_l = schlick(n_l)
    f_v = schlick(n_v)
    f_h = schlick(l_h)
    fd90 = 0.5 + 2.0 * l_h * l_h * roughness
    diffuse = (1.0 + (fd90 - 1.0) * f_l) * (1.0 + (fd90 - 1.0) * f_v)
    base = float3(0.08 * surface.specular) * (1.0 - surface.metallic) + surface.metallic * color
    alpha = ox.max(0.001, roughness * roughness)
    fresnel = base + f_h * (float3(1.0) - base)
    reflected = ggx(n_h, alpha) * smith(n_l, alpha) * smith(n_v, alpha) * fresnel
    coat = 0.25 * surface.clearcoat * (0.04 + 0.96 * f_h) * ggx(n_h, 0.1) * smith(n_l, 0.25) * smith(n_v, 0.25)
    soft = (0.318309886 * diffuse) * color + (f_h * surface.sheen) * tint
    return (1.0 - surface.metallic) * soft + reflected + float3(coat)
