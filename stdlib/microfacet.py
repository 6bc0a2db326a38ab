"""The GGX distribution of microfacet normals, in a local frame with z along the macroscopic normal.

`roughness` is alpha along x and y: 0 is smooth, 1 is rough. E. Heitz, "Understanding the Masking-Shadowing Function in
Microfacet-Based BRDFs", JCGT 2014, unless another source is named.
"""

import optixc as ox
from optixc import float2, float3
from optixc.stdlib.math import PI, safe_sqrt


@ox.device
def ggx_distribution(wm: float3, roughness: float2) -> float:
    """Area of microfacets with normal `wm` per steradian and macroscopic area; 0 below the horizon. Equation 85."""
    if wm.z <= 0.0:
        return 0.0
    x = wm.x / roughness.x
    y = wm.y / roughness.y
    d = x * x + y * y + wm.z * wm.z
    return 1.0 / (PI * roughness.x * roughness.y * d * d)


@ox.device
def ggx_lambda(w: float3, roughness: float2) -> float:
    """The auxiliary function of Smith's masking. Equations 72 and 86."""
    z_squared = w.z * w.z
    if z_squared == 0.0:
        return 1e30
    x = w.x * roughness.x
    y = w.y * roughness.y
    return 0.5 * (ox.sqrt(1.0 + (x * x + y * y) / z_squared) - 1.0)


@ox.device
def ggx_masking(w: float3, roughness: float2) -> float:
    """The share of microfacets that `w` sees, of those that face it. Equation 43."""
    return 1.0 / (1.0 + ggx_lambda(w, roughness))


@ox.device
def ggx_masking_shadowing(wo: float3, wi: float3, roughness: float2) -> float:
    """The share that both see, correlated by height. Equation 99."""
    return 1.0 / (1.0 + ggx_lambda(wo, roughness) + ggx_lambda(wi, roughness))


@ox.device
def ggx_visible_normal(wo: float3, roughness: float2, u: float2) -> float3:
    """A microfacet normal out of those that `wo` (above the horizon) sees.
    J. Dupuy, A. Benyoub, "Sampling Visible GGX Normals with Spherical Caps", 2023."""
    stretched = ox.normalize(float3(wo.x * roughness.x, wo.y * roughness.y, wo.z))
    phi = 2.0 * PI * u.x
    z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z
    sine = safe_sqrt(1.0 - z * z)
    h = float3(sine * ox.cos(phi), sine * ox.sin(phi), z) + stretched
    return ox.normalize(float3(h.x * roughness.x, h.y * roughness.y, ox.max(h.z, 1e-7)))


@ox.device
def ggx_visible_normal_pdf(wo: float3, wm: float3, roughness: float2) -> float:
    """Density of `ggx_visible_normal` per steradian of normals. Equation 16."""
    cosine = ox.dot(wo, wm)
    if wo.z <= 0.0 or cosine <= 0.0:
        return 0.0
    return ggx_masking(wo, roughness) * ggx_distribution(wm, roughness) * cosine / wo.z
