"""A principled material: metals, plastics and coats with a few artist's parameters, in a local frame with z along the normal.

A Lambertian base and a GGX layer over it, in the manner of B. Burley, "Physically Based Shading at Disney", 2012; the base gets what
both crossings of a dielectric layer let through, so that light is never made and both directions may be exchanged.
"""

import optixc as ox
from optixc import float2, float3
from optixc.stdlib.bsdf import BsdfSample, no_sample
from optixc.stdlib.fresnel import fresnel_schlick
from optixc.stdlib.math import INV_PI, luminance
from optixc.stdlib.microfacet import ggx_distribution, ggx_masking_shadowing, ggx_visible_normal, ggx_visible_normal_pdf
from optixc.stdlib.sampling import cosine_hemisphere

MIN_ROUGHNESS = 1e-3
COAT_REFLECTANCE = 0.04


@ox.struct
class Principled:
    """All in [0, 1]. `specular` 0.5 is an index of 1.5; `anisotropic` stretches highlights along x; `coat` is a clear layer on top."""

    base_color: float3
    metallic: float
    roughness: float
    specular: float
    anisotropic: float
    coat: float
    coat_roughness: float


@ox.device
def principled_alpha(material: Principled) -> float2:
    """Roughness of the base layer along x and y. Burley 2012, 5.4."""
    alpha = material.roughness * material.roughness
    aspect = ox.sqrt(1.0 - 0.9 * material.anisotropic)
    return float2(ox.max(alpha / aspect, MIN_ROUGHNESS), ox.max(alpha * aspect, MIN_ROUGHNESS))


@ox.device
def principled_coat_alpha(material: Principled) -> float2:
    """Roughness of the coat."""
    return float2(ox.max(material.coat_roughness * material.coat_roughness, MIN_ROUGHNESS))


@ox.device
def principled_reflectance(material: Principled) -> float3:
    """Reflectance of the base layer at normal incidence: grey for dielectrics, the base colour for metals."""
    return ox.lerp(float3(0.08 * material.specular), material.base_color, float3(material.metallic))


@ox.device
def ggx_reflection(alpha: float2, wo: float3, wi: float3, wm: float3) -> float:
    """A GGX layer without its Fresnel factor."""
    return ggx_distribution(wm, alpha) * ggx_masking_shadowing(wo, wi, alpha) / (4.0 * wo.z * wi.z)


@ox.device
def principled_eval(material: Principled, wo: float3, wi: float3) -> float3:
    """The BRDF without the cosine; 0 below the horizon."""
    if wo.z <= 0.0 or wi.z <= 0.0:
        return float3(0.0)
    wm = ox.normalize(wo + wi)
    cosine = ox.dot(wo, wm)

    # Base: diffuse light enters and leaves through the layer
    f0 = principled_reflectance(material)
    through = (float3(1.0) - fresnel_schlick(f0, wo.z)) * (float3(1.0) - fresnel_schlick(f0, wi.z))
    diffuse = material.base_color * through * ((1.0 - material.metallic) * INV_PI)
    base = diffuse + fresnel_schlick(f0, cosine) * ggx_reflection(principled_alpha(material), wo, wi, wm)

    # Coat: takes from the base, on both crossings, what it reflects itself
    coat = material.coat * fresnel_schlick(float3(COAT_REFLECTANCE), cosine).x
    dimmed_o = 1.0 - material.coat * fresnel_schlick(float3(COAT_REFLECTANCE), wo.z).x
    dimmed_i = 1.0 - material.coat * fresnel_schlick(float3(COAT_REFLECTANCE), wi.z).x
    return base * (dimmed_o * dimmed_i) + float3(coat * ggx_reflection(principled_coat_alpha(material), wo, wi, wm))


@ox.device
def principled_choice(material: Principled, wo: float3) -> float2:
    """Probabilities of drawing from the diffuse base and from the coat; the rest goes to the base's layer."""
    f0 = principled_reflectance(material)
    glossy = luminance(fresnel_schlick(f0, wo.z))
    diffuse = (1.0 - material.metallic) * luminance(material.base_color) * (1.0 - glossy)
    coat = material.coat * fresnel_schlick(float3(COAT_REFLECTANCE), wo.z).x
    total = diffuse + glossy + coat
    if total <= 0.0:
        return float2(0.0, 0.0)
    return float2(diffuse / total, coat / total)


@ox.device
def principled_sample(material: Principled, wo: float3, u: float3) -> BsdfSample:
    """Draws from one of the lobes; `u.z` chooses which. The weight accounts for all of them."""
    if wo.z <= 0.0:
        return no_sample()
    choice = principled_choice(material, wo)
    wi = float3(0.0, 0.0, 1.0)
    if u.z < choice.x:
        wi = cosine_hemisphere(u.xy)
    elif u.z < choice.x + choice.y:
        wi = ox.reflect(-wo, ggx_visible_normal(wo, principled_coat_alpha(material), u.xy))
    else:
        wi = ox.reflect(-wo, ggx_visible_normal(wo, principled_alpha(material), u.xy))
    pdf = principled_pdf(material, wo, wi)
    if wi.z <= 0.0 or pdf <= 0.0:
        return no_sample()
    return BsdfSample(wi, principled_eval(material, wo, wi) * (wi.z / pdf), pdf)


@ox.device
def principled_pdf(material: Principled, wo: float3, wi: float3) -> float:
    """Density of `principled_sample`."""
    if wo.z <= 0.0 or wi.z <= 0.0:
        return 0.0
    choice = principled_choice(material, wo)
    wm = ox.normalize(wo + wi)
    per_wi = 1.0 / (4.0 * ox.max(ox.dot(wo, wm), 1e-12))
    base = ggx_visible_normal_pdf(wo, wm, principled_alpha(material)) * per_wi
    coat = ggx_visible_normal_pdf(wo, wm, principled_coat_alpha(material)) * per_wi
    return choice.x * wi.z * INV_PI + choice.y * coat + (1.0 - choice.x - choice.y) * base
