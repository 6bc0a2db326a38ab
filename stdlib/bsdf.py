"""BSDFs in a local frame with z along the normal; `wo` and `wi` both point away from the surface.

`..._eval` is the BSDF without the cosine, `..._sample` draws wi, `..._pdf` is the density of that per steradian. A sampler returns a
`BsdfSample`, whose `weight` is the BSDF times |cosine| over density; a weight of zero means that nothing was drawn.
"""

import optixc as ox
from optixc import float2, float3
from optixc.stdlib.fresnel import fresnel_conductor, fresnel_dielectric
from optixc.stdlib.math import INV_PI
from optixc.stdlib.microfacet import (
    ggx_distribution,
    ggx_masking,
    ggx_masking_shadowing,
    ggx_visible_normal,
    ggx_visible_normal_pdf,
)
from optixc.stdlib.sampling import cosine_hemisphere, cosine_hemisphere_pdf


@ox.struct
class BsdfSample:
    """`pdf` is 0 for a perfectly smooth surface, whose directions have no density."""

    wi: float3
    weight: float3
    pdf: float


@ox.device
def no_sample() -> BsdfSample:
    """Nothing drawn: absorbed."""
    return BsdfSample(float3(0.0, 0.0, 1.0), float3(0.0), 0.0)


@ox.device
def lambert_eval(albedo: float3, wo: float3, wi: float3) -> float3:
    """Diffuse reflection."""
    return albedo * INV_PI if wo.z * wi.z > 0.0 else float3(0.0)


@ox.device
def lambert_sample(albedo: float3, wo: float3, u: float2) -> BsdfSample:
    """Cosine-weighted, on the side of wo."""
    wi = cosine_hemisphere(u)
    pdf = cosine_hemisphere_pdf(wi)
    return BsdfSample(wi if wo.z > 0.0 else -wi, albedo, pdf)


@ox.device
def lambert_pdf(wo: float3, wi: float3) -> float:
    """Density of `lambert_sample`."""
    return abs(wi.z) * INV_PI if wo.z * wi.z > 0.0 else 0.0


@ox.device
def mirror_sample(reflectance: float3, wo: float3) -> BsdfSample:
    """A perfectly smooth mirror."""
    return BsdfSample(float3(-wo.x, -wo.y, wo.z), reflectance, 0.0)


@ox.device
def smooth_dielectric_sample(eta: float, wo: float3, u: float) -> BsdfSample:
    """Clear glass, smooth: reflects or refracts at random. `eta` is the index below the surface over that above.

    The weight is that of power; radiance carried from the eye is also scaled by `radiance_scale` on refraction. PBRT 4ed. 9.5.
    """
    relative = eta if wo.z > 0.0 else 1.0 / eta
    cosine = abs(wo.z)
    reflected = fresnel_dielectric(cosine, relative)
    if u < reflected:
        return BsdfSample(float3(-wo.x, -wo.y, wo.z), float3(1.0), 0.0)
    transmitted = ox.sqrt(ox.max(1.0 - (1.0 - cosine * cosine) / (relative * relative), 0.0))
    return BsdfSample(float3(-wo.x / relative, -wo.y / relative, -transmitted if wo.z > 0.0 else transmitted), float3(1.0), 0.0)


@ox.device
def radiance_scale(eta: float, wo: float3, wi: float3) -> float:
    """The factor on radiance that goes from wi to wo through a dielectric: 1 for reflection, else the squared ratio of indices."""
    if wo.z * wi.z > 0.0:
        return 1.0
    return 1.0 / (eta * eta) if wo.z > 0.0 else eta * eta


@ox.device
def conductor_eval(eta: float3, k: float3, roughness: float2, wo: float3, wi: float3) -> float3:
    """Rough metal with the complex index eta + i k. Cook-Torrance with GGX, single scattering; PBRT 4ed. 9.6.5."""
    if wo.z <= 0.0 or wi.z <= 0.0:
        return float3(0.0)
    wm = ox.normalize(wo + wi)
    scale = ggx_distribution(wm, roughness) * ggx_masking_shadowing(wo, wi, roughness) / (4.0 * wo.z * wi.z)
    return fresnel_conductor(ox.max(ox.dot(wo, wm), 0.0), eta, k) * scale


@ox.device
def conductor_sample(eta: float3, k: float3, roughness: float2, wo: float3, u: float2) -> BsdfSample:
    """Reflects about a visible microfacet normal."""
    if wo.z <= 0.0:
        return no_sample()
    wm = ggx_visible_normal(wo, roughness, u)
    wi = ox.reflect(-wo, wm)
    if wi.z <= 0.0:
        return no_sample()
    shadowing = ggx_masking_shadowing(wo, wi, roughness) / ggx_masking(wo, roughness)
    weight = fresnel_conductor(ox.max(ox.dot(wo, wm), 0.0), eta, k) * shadowing
    return BsdfSample(wi, weight, conductor_pdf(roughness, wo, wi))


@ox.device
def conductor_pdf(roughness: float2, wo: float3, wi: float3) -> float:
    """Density of `conductor_sample`."""
    if wo.z <= 0.0 or wi.z <= 0.0:
        return 0.0
    wm = ox.normalize(wo + wi)
    return ggx_visible_normal_pdf(wo, wm, roughness) / (4.0 * ox.max(ox.dot(wo, wm), 1e-12))


@ox.device
def dielectric_half_vector(relative: float, wo: float3, wi: float3) -> float3:
    """The microfacet normal, in the upper hemisphere, that takes wo to wi; `relative` is the index on wi's side over that on wo's."""
    h = ox.normalize(wo + (relative if wo.z * wi.z < 0.0 else 1.0) * wi)
    return h if h.z >= 0.0 else -h


@ox.device
def dielectric_eval(eta: float, roughness: float2, wo: float3, wi: float3) -> float:
    """Rough glass, as power (see `radiance_scale`). B. Walter and others, "Microfacet Models for Refraction through Rough Surfaces", 2007,
    with GGX and height-correlated masking."""
    if wo.z == 0.0 or wi.z == 0.0:
        return 0.0
    relative = eta if wo.z > 0.0 else 1.0 / eta
    wm = dielectric_half_vector(relative, wo, wi)
    o_dot_m = ox.dot(wo, wm)
    i_dot_m = ox.dot(wi, wm)
    if o_dot_m * wo.z <= 0.0 or i_dot_m * wi.z <= 0.0:
        return 0.0
    reflected = fresnel_dielectric(abs(o_dot_m), relative)
    shape = ggx_distribution(wm, roughness) * ggx_masking_shadowing(wo, wi, roughness)
    if wo.z * wi.z > 0.0:
        return reflected * shape / (4.0 * abs(wo.z * wi.z))
    denominator = i_dot_m * relative + o_dot_m
    jacobian = abs(i_dot_m * o_dot_m) * relative * relative / (denominator * denominator)
    return (1.0 - reflected) * shape * jacobian / abs(wo.z * wi.z)


@ox.device
def dielectric_sample(eta: float, roughness: float2, wo: float3, u: float3) -> BsdfSample:
    """Reflects or refracts about a visible microfacet normal; `u.z` chooses which."""
    if wo.z == 0.0:
        return no_sample()
    relative = eta if wo.z > 0.0 else 1.0 / eta
    upper = wo if wo.z > 0.0 else -wo
    wm = ggx_visible_normal(upper, roughness, u.xy)
    if wo.z < 0.0:
        wm = -wm
    cosine = ox.dot(wo, wm)
    reflected = fresnel_dielectric(cosine, relative)
    wi = 2.0 * cosine * wm - wo
    if u.z >= reflected:
        transmitted = ox.sqrt(ox.max(1.0 - (1.0 - cosine * cosine) / (relative * relative), 0.0))
        wi = (cosine / relative - transmitted) * wm - wo / relative
        if wi.z * wo.z >= 0.0:
            return no_sample()
    elif wi.z * wo.z <= 0.0:
        return no_sample()
    weight = ggx_masking_shadowing(wo, wi, roughness) / ggx_masking(wo, roughness)
    return BsdfSample(wi, float3(weight), dielectric_pdf(eta, roughness, wo, wi))


@ox.device
def dielectric_pdf(eta: float, roughness: float2, wo: float3, wi: float3) -> float:
    """Density of `dielectric_sample`."""
    if wo.z == 0.0 or wi.z == 0.0:
        return 0.0
    relative = eta if wo.z > 0.0 else 1.0 / eta
    wm = dielectric_half_vector(relative, wo, wi)
    o_dot_m = ox.dot(wo, wm)
    i_dot_m = ox.dot(wi, wm)
    if o_dot_m * wo.z <= 0.0 or i_dot_m * wi.z <= 0.0:
        return 0.0
    side = 1.0 if wo.z > 0.0 else -1.0
    normals = ggx_visible_normal_pdf(side * wo, wm, roughness)
    reflected = fresnel_dielectric(abs(o_dot_m), relative)
    if wo.z * wi.z > 0.0:
        return reflected * normals / (4.0 * abs(o_dot_m))
    denominator = i_dot_m * relative + o_dot_m
    return (1.0 - reflected) * normals * abs(i_dot_m) * relative * relative / (denominator * denominator)
