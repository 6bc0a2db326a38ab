"""Light scattered by a hair: a dielectric cylinder with tilted scales and a coloured inside, by modes R, TT, TRT and the rest.

Local frames have x along the fibre, towards its tip; y and z may lie anyhow. `h` in [-1, 1] says where across the fibre it was hit: the
sine of the angle from the normal to `wo` about x (`fibre_offset`). The scattering functions hold the cosine already: integrated over the
sphere they give the share of light scattered, 1 for a fibre that absorbs nothing.
M. Chiang, B. Bitterli, C. Tappan, B. Burley, "A Practical and Controllable Hair and Fur Model for Production Path Tracing", 2016, after
S. Marschner and others, 2003, and E. d'Eon and others, 2011; PBRT 4ed. 9.9.
"""

import optixc as ox
from optixc import float2, float3, float4
from optixc.stdlib.bsdf import BsdfSample
from optixc.stdlib.fresnel import fresnel_dielectric
from optixc.stdlib.math import PI, safe_sqrt

MODES = 4
SQRT_PI_OVER_8 = 0.626657069


@ox.struct
class Hair:
    """Absorption per radius of the fibre; roughness along and across the fibre in (0, 1]; the tilt of the scales in radians; the index
    of refraction, 1.55 for human hair."""

    absorption: float3
    longitudinal_roughness: float
    azimuthal_roughness: float
    scale_tilt: float
    refractive_index: float


@ox.struct
class HairModes:
    """What the modes have for one `wo` and `h`: how much of the light each carries, and by mode longitudinal variances, tilted angles of
    wo, azimuths of their peaks; `width` is that of all azimuthal peaks."""

    reflected: float3
    passed: float3
    returned: float3
    rest: float3
    variance: float4
    sine: float4
    cosine: float4
    azimuth: float4
    width: float


@ox.device
def hair_absorption_from_melanin(eumelanin: float, pheomelanin: float) -> float3:
    """Concentrations: eumelanin 0.3 is blond, 1.3 brown, 8 black; pheomelanin makes hair red. d'Eon and others, section 6.1."""
    return eumelanin * float3(0.419, 0.697, 1.37) + pheomelanin * float3(0.187, 0.4, 1.05)


@ox.device
def hair_absorption_from_color(color: float3, azimuthal_roughness: float) -> float3:
    """The absorption with which much hair together looks about like `color`. Chiang and others, equation 9."""
    b = azimuthal_roughness
    scale = 5.969 + b * (-0.215 + b * (2.532 + b * (-10.73 + b * (5.574 + b * 0.245))))
    root = float3(ox.log(color.x), ox.log(color.y), ox.log(color.z)) / scale
    return root * root


@ox.device
def fibre_offset(tangent: float3, normal: float3, wo: float3) -> float:
    """`h` of a hit with a unit normal that is perpendicular to the unit tangent."""
    across = wo - ox.dot(wo, tangent) * tangent
    return ox.clamp(ox.dot(tangent, ox.cross(normal, ox.normalize(across))), -1.0, 1.0)


@ox.device
def bessel_i0(x: float) -> float:
    """The modified Bessel function of order 0, by its series; for |x| up to 12."""
    quarter = 0.25 * x * x
    term = 1.0
    total = 1.0
    for k in range(1, 16):
        term *= quarter / float(k * k)
        total += term
    return total


@ox.device
def log_bessel_i0(x: float) -> float:
    """Its logarithm for x >= 0 of any size."""
    if x > 12.0:
        return x + 0.5 * (ox.log(1.0 / (2.0 * PI * x)) + 1.0 / (4.0 * x))
    return ox.log(bessel_i0(x))


@ox.device
def longitudinal(sine_i: float, cosine_i: float, sine_o: float, cosine_o: float, variance: float) -> float:
    """Density of the inclination. d'Eon and others, equation 7."""
    a = cosine_i * cosine_o / variance
    b = sine_i * sine_o / variance
    if variance <= 0.1:
        return ox.exp(log_bessel_i0(a) - b - 1.0 / variance + 0.69314718 + ox.log(0.5 / variance))
    return ox.exp(-b) * bessel_i0(a) / (ox.sinh(1.0 / variance) * 2.0 * variance)


@ox.device
def logistic_below(x: float, width: float) -> float:
    """The share of a logistic distribution below x."""
    return 1.0 / (1.0 + ox.exp(-x / width))


@ox.device
def azimuthal(angle: float, width: float) -> float:
    """Density at an angle of any number of turns: a logistic distribution cut off at half a turn."""
    turned = angle - 2.0 * PI * ox.floor((angle + PI) / (2.0 * PI))
    e = ox.exp(-abs(turned) / width)
    share = 2.0 * logistic_below(PI, width) - 1.0
    return e / (width * (1.0 + e) * (1.0 + e) * share)


@ox.device
def azimuthal_sample(u: float, width: float) -> float:
    """An angle with that density."""
    below = logistic_below(-PI, width)
    x = -width * ox.log(1.0 / (below + u * (1.0 - 2.0 * below)) - 1.0)
    return ox.clamp(x, -PI, PI)


@ox.device
def hair_modes(hair: Hair, h: float, wo: float3) -> HairModes:
    """Everything that does not depend on `wi`."""
    sine_o = wo.x
    cosine_o = safe_sqrt(1.0 - sine_o * sine_o)

    # The ray inside: its inclination, and where it leaves
    eta = hair.refractive_index
    sine_t = sine_o / eta
    cosine_t = safe_sqrt(1.0 - sine_t * sine_t)
    eta_projected = ox.sqrt(ox.max(eta * eta - sine_o * sine_o, 0.0)) / ox.max(cosine_o, 1e-4)
    sine_gamma_t = ox.clamp(h / eta_projected, -1.0, 1.0)
    gamma_o = ox.asin(h)
    gamma_t = ox.asin(sine_gamma_t)
    path = 2.0 * safe_sqrt(1.0 - sine_gamma_t * sine_gamma_t) / cosine_t
    through = float3(ox.exp(-hair.absorption.x * path), ox.exp(-hair.absorption.y * path), ox.exp(-hair.absorption.z * path))

    # Attenuation: reflected outside, through, reflected once inside, and all that follow
    f = fresnel_dielectric(ox.min(cosine_o * safe_sqrt(1.0 - h * h), 1.0), eta)
    passed = (1.0 - f) * (1.0 - f) * through
    returned = passed * through * f
    rest = returned * f * through / (float3(1.0) - f * through)

    # Roughness as variances; scales tilt the first three modes. Chiang and others, equations 7 and 8
    m, n = hair.longitudinal_roughness, hair.azimuthal_roughness
    root = 0.726 * m + 0.812 * m * m + 3.7 * ox.pow(m, 20.0)
    variance = root * root * float4(1.0, 0.25, 4.0, 4.0)
    width = SQRT_PI_OVER_8 * (0.265 * n + 1.194 * n * n + 5.372 * ox.pow(n, 22.0))
    tilt = hair.scale_tilt * float4(-2.0, 1.0, 4.0, 0.0)
    sine = sine_o * ox.cos(tilt) + cosine_o * ox.sin(tilt)
    cosine = abs(cosine_o * ox.cos(tilt) - sine_o * ox.sin(tilt))
    azimuth = float4(0.0, 1.0, 2.0, 3.0) * (2.0 * gamma_t + PI) - float4(2.0 * gamma_o)
    return HairModes(float3(f), passed, returned, rest, variance, sine, cosine, azimuth, width)


@ox.device
def hair_shares(modes: HairModes) -> float4:
    """How often each mode is drawn: in proportion to its mean attenuation."""
    one = float3(1.0)
    shares = float4(ox.dot(one, modes.reflected), ox.dot(one, modes.passed), ox.dot(one, modes.returned), ox.dot(one, modes.rest))
    return shares / (shares.x + shares.y + shares.z + shares.w)


@ox.device
def hair_value(modes: HairModes, wo: float3, wi: float3) -> float4:
    """The scattering function, and in w the density of `hair_sample`."""
    cosine_i = safe_sqrt(1.0 - wi.x * wi.x)
    phi = ox.atan2(wi.z, wi.y) - ox.atan2(wo.z, wo.y)
    shares = hair_shares(modes)
    density = float4(0.0)
    for p in range(MODES):
        around = azimuthal(phi - modes.azimuth[p], modes.width) if p < MODES - 1 else 0.5 / PI
        density[p] = longitudinal(wi.x, cosine_i, modes.sine[p], modes.cosine[p], modes.variance[p]) * around
    value = density.x * modes.reflected + density.y * modes.passed + density.z * modes.returned + density.w * modes.rest
    return float4(value, ox.dot(density, shares))


@ox.device
def hair_eval(hair: Hair, h: float, wo: float3, wi: float3) -> float3:
    """Light from `wi` that goes to `wo`, per steradian."""
    return hair_value(hair_modes(hair, h, wo), wo, wi).xyz


@ox.device
def hair_pdf(hair: Hair, h: float, wo: float3, wi: float3) -> float:
    """Density of `hair_sample` per steradian."""
    return hair_value(hair_modes(hair, h, wo), wo, wi).w


@ox.device
def hair_sample_modes(modes: HairModes, wo: float3, u: float2, around: float2) -> BsdfSample:
    """`hair_sample` with modes that are there already."""
    # The mode; what is left of its number chooses the azimuth
    shares = hair_shares(modes)
    chosen = 0
    rest = u.x
    while chosen < MODES - 1 and rest >= shares[chosen]:
        rest -= shares[chosen]
        chosen += 1
    v = modes.variance[chosen]
    sine_o, cosine_o = modes.sine[chosen], modes.cosine[chosen]

    # Inclination: d'Eon and others, "A Fast Method for Importance Sampling Hair", 2013
    cosine_theta = 1.0 + v * ox.log(ox.max(u.y, 1e-5) + (1.0 - u.y) * ox.exp(-2.0 / v))
    sine_theta = safe_sqrt(1.0 - cosine_theta * cosine_theta)
    sine_i = ox.clamp(-cosine_theta * sine_o + sine_theta * ox.cos(2.0 * PI * around.x) * cosine_o, -1.0, 1.0)
    cosine_i = safe_sqrt(1.0 - sine_i * sine_i)

    # Azimuth
    turn = 2.0 * PI * around.y
    if chosen < MODES - 1:
        turn = modes.azimuth[chosen] + azimuthal_sample(around.y, modes.width)
    phi = ox.atan2(wo.z, wo.y) + turn
    wi = float3(sine_i, cosine_i * ox.cos(phi), cosine_i * ox.sin(phi))
    value = hair_value(modes, wo, wi)
    if not (value.w > 0.0):
        return BsdfSample(wi, float3(0.0), 0.0)
    return BsdfSample(wi, value.xyz / value.w, value.w)


@ox.device
def hair_sample(hair: Hair, h: float, wo: float3, u: float2, around: float2) -> BsdfSample:
    """A direction, by mode and inclination from `u`, by azimuth from `around`; the weight is the scattering function over the density."""
    return hair_sample_modes(hair_modes(hair, h, wo), wo, u, around)
