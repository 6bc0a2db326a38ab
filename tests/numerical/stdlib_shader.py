"""Programs that run functions of the shader library over arrays: launch index i reads row i of `inputs` and writes row i of `outputs`."""

import optixc as ox
from optixc import float3, float4, uint2, uint4, uint32, uint64
from optixc.stdlib import bsdf, curves, environment, hair, light, microfacet, principled, random, sampling


@ox.struct
class Params:
    """`a` and `b` parametrise the function under test."""

    inputs: ox.Array[float4]
    outputs: ox.Array[float4]
    a: float4
    b: float4


@ox.struct
class Words:
    """The same for integers."""

    inputs: ox.Array[uint4]
    outputs: ox.Array[uint4]


params = ox.launch_params(Params)


@ox.device
def load() -> float4:
    return params.inputs[ox.get_launch_index().x]


@ox.device
def store(v: float3, w: float):
    params.outputs[ox.get_launch_index().x] = float4(v, w)


@ox.device
def material() -> principled.Principled:
    """a: base colour and metallic; b: roughness, specular, anisotropic, coat."""
    return principled.Principled(params.a.xyz, params.a.w, params.b.x, params.b.y, params.b.z, params.b.w, 0.2)


@ox.program
def __raygen__pcg32(words: Words):
    i = ox.get_launch_index().x
    x = words.inputs[i]
    rng = random.pcg32(uint64(x.x), uint64(x.y))
    r0 = random.pcg32_next(rng)
    r1 = random.pcg32_next(rng)
    r2 = random.pcg32_next(rng)
    r3 = random.pcg32_next(rng)
    words.outputs[i] = uint4(r0, r1, r2, r3)


@ox.program
def __raygen__pcg32_below(words: Words):
    i = ox.get_launch_index().x
    x = words.inputs[i]
    rng = random.pcg32(uint64(x.x), uint64(x.y))
    words.outputs[i] = uint4(random.pcg32_below(rng, x.z), random.hash_uint(x.x), 0, 0)


@ox.program
def __raygen__philox(words: Words):
    """Row 2 i is the counter, the first half of row 2 i + 1 the key."""
    i = ox.get_launch_index().x
    key = words.inputs[2 * i + 1]
    words.outputs[i] = random.philox(words.inputs[2 * i], uint2(key.x, key.y))


@ox.program
def __raygen__sobol():
    """x: index, y: seed."""
    x = load()
    p = random.sobol_owen_2d(uint32(x.x), uint32(x.y))
    store(float3(p.x, p.y, 0.0), 0.0)


@ox.program
def __raygen__sample_cosine_hemisphere():
    w = sampling.cosine_hemisphere(load().xy)
    store(w, sampling.cosine_hemisphere_pdf(w))


@ox.program
def __raygen__pdf_cosine_hemisphere():
    store(float3(0.0), sampling.cosine_hemisphere_pdf(load().xyz))


@ox.program
def __raygen__sample_uniform_hemisphere():
    w = sampling.uniform_hemisphere(load().xy)
    store(w, sampling.uniform_hemisphere_pdf(w))


@ox.program
def __raygen__pdf_uniform_hemisphere():
    store(float3(0.0), sampling.uniform_hemisphere_pdf(load().xyz))


@ox.program
def __raygen__sample_uniform_sphere():
    store(sampling.uniform_sphere(load().xy), sampling.uniform_sphere_pdf())


@ox.program
def __raygen__pdf_uniform_sphere():
    store(float3(0.0), sampling.uniform_sphere_pdf())


@ox.program
def __raygen__sample_uniform_cone():
    store(sampling.uniform_cone(load().xy, params.a.x), sampling.uniform_cone_pdf(params.a.x))


@ox.program
def __raygen__pdf_uniform_cone():
    store(float3(0.0), sampling.uniform_cone_pdf(params.a.x) if load().z >= params.a.x else 0.0)


@ox.program
def __raygen__sample_visible_sphere():
    """a: centre and radius; seen from the origin."""
    w = sampling.visible_sphere(params.a.xyz, params.a.w, float3(0.0), load().xy)
    store(w, sampling.visible_sphere_pdf(params.a.xyz, params.a.w, float3(0.0)))


@ox.program
def __raygen__pdf_visible_sphere():
    w = load().xyz
    along = ox.dot(w, params.a.xyz)
    inside = along > 0.0 and ox.dot(params.a.xyz, params.a.xyz) - along * along < params.a.w * params.a.w
    store(float3(0.0), sampling.visible_sphere_pdf(params.a.xyz, params.a.w, float3(0.0)) if inside else 0.0)


@ox.program
def __raygen__uniform_disk():
    p = sampling.uniform_disk(load().xy)
    store(float3(p.x, p.y, 0.0), sampling.uniform_disk_pdf())


@ox.program
def __raygen__uniform_triangle():
    p = sampling.uniform_triangle(load().xy)
    store(float3(p.x, p.y, 0.0), sampling.uniform_triangle_pdf(float3(0.0), float3(1.0, 0.0, 0.0), float3(0.0, 1.0, 0.0)))


@ox.device
def rectangle() -> light.RectangleLight:
    return light.RectangleLight(params.a.xyz, params.b.xyz, float3(0.3, params.b.w, 0.9), float3(1.0))


@ox.program
def __raygen__sample_rectangle_light():
    sample = light.rectangle_light(rectangle(), float3(0.0), load().xy)
    store(sample.to_light, sample.pdf)


@ox.program
def __raygen__pdf_rectangle_light():
    store(float3(0.0), light.rectangle_light_pdf(rectangle(), float3(0.0), load().xyz))


@ox.program
def __raygen__sample_lambert():
    """a: wo."""
    sample = bsdf.lambert_sample(float3(1.0), params.a.xyz, load().xy)
    store(sample.wi, bsdf.lambert_pdf(params.a.xyz, sample.wi))


@ox.program
def __raygen__pdf_lambert():
    wi = load().xyz
    store(bsdf.lambert_eval(float3(1.0), params.a.xyz, wi), bsdf.lambert_pdf(params.a.xyz, wi))


@ox.program
def __raygen__sample_conductor():
    """a: wo; b: roughness x and y."""
    sample = bsdf.conductor_sample(float3(0.2), float3(3.9), params.b.xy, params.a.xyz, load().xy)
    store(sample.wi if sample.weight.x > 0.0 else float3(0.0), sample.pdf)


@ox.program
def __raygen__weight_conductor():
    sample = bsdf.conductor_sample(float3(0.2), float3(3.9), params.b.xy, params.a.xyz, load().xy)
    store(sample.weight, sample.pdf)


@ox.program
def __raygen__pdf_conductor():
    wi = load().xyz
    value = bsdf.conductor_eval(float3(0.2), float3(3.9), params.b.xy, params.a.xyz, wi)
    store(value, bsdf.conductor_pdf(params.b.xy, params.a.xyz, wi))


@ox.program
def __raygen__reverse_conductor():
    """The BRDF with the directions exchanged."""
    store(bsdf.conductor_eval(float3(0.2), float3(3.9), params.b.xy, load().xyz, params.a.xyz), 0.0)


@ox.program
def __raygen__sample_dielectric():
    """a: wo and index; b: roughness x and y."""
    sample = bsdf.dielectric_sample(params.a.w, params.b.xy, params.a.xyz, load().xyz)
    store(sample.wi if sample.weight.x > 0.0 else float3(0.0), sample.pdf)


@ox.program
def __raygen__weight_dielectric():
    sample = bsdf.dielectric_sample(params.a.w, params.b.xy, params.a.xyz, load().xyz)
    store(sample.weight, sample.pdf)


@ox.program
def __raygen__pdf_dielectric():
    wi = load().xyz
    value = bsdf.dielectric_eval(params.a.w, params.b.xy, params.a.xyz, wi)
    store(float3(value), bsdf.dielectric_pdf(params.a.w, params.b.xy, params.a.xyz, wi))


@ox.program
def __raygen__reverse_dielectric():
    """The BSDF with the directions exchanged, brought to the same side by the squared ratio of indices."""
    wi = load().xyz
    value = bsdf.dielectric_eval(params.a.w, params.b.xy, wi, params.a.xyz)
    store(float3(value / bsdf.radiance_scale(params.a.w, params.a.xyz, wi)), 0.0)


@ox.program
def __raygen__smooth_dielectric():
    sample = bsdf.smooth_dielectric_sample(params.a.w, params.a.xyz, load().x)
    store(sample.wi, sample.weight.x)


@ox.program
def __raygen__sample_principled():
    """wo lies in the plane y = 0 and has z = inputs.w."""
    x = load()
    wo = float3(ox.sqrt(1.0 - x.w * x.w), 0.0, x.w)
    sample = principled.principled_sample(material(), wo, x.xyz)
    store(sample.wi if sample.pdf > 0.0 else float3(0.0), sample.pdf)


@ox.program
def __raygen__weight_principled():
    x = load()
    wo = float3(ox.sqrt(1.0 - x.w * x.w), 0.0, x.w)
    sample = principled.principled_sample(material(), wo, x.xyz)
    store(sample.weight, sample.pdf)


@ox.program
def __raygen__pdf_principled():
    x = load()
    wo = float3(ox.sqrt(1.0 - x.w * x.w), 0.0, x.w)
    store(principled.principled_eval(material(), wo, x.xyz), principled.principled_pdf(material(), wo, x.xyz))


@ox.program
def __raygen__reverse_principled():
    x = load()
    wo = float3(ox.sqrt(1.0 - x.w * x.w), 0.0, x.w)
    store(principled.principled_eval(material(), x.xyz, wo), 0.0)


@ox.program
def __raygen__pdf_visible_normal():
    """a: wo; b: roughness."""
    store(float3(0.0), microfacet.ggx_visible_normal_pdf(params.a.xyz, load().xyz, params.b.xy))


@ox.program
def __raygen__sample_visible_normal():
    wm = microfacet.ggx_visible_normal(params.a.xyz, params.b.xy, load().xy)
    store(wm, microfacet.ggx_visible_normal_pdf(params.a.xyz, wm, params.b.xy))


@ox.program
def __raygen__sample_environment(map: environment.EnvironmentMap):
    sample = environment.environment_sample(map, load().xy)
    store(sample.to_light, sample.pdf)


@ox.program
def __raygen__pdf_environment(map: environment.EnvironmentMap):
    w = load().xyz
    store(environment.environment_radiance(map, w), environment.environment_pdf(map, w))


@ox.device
def fibre() -> hair.Hair:
    """b: roughness along and across, tilt, absorption."""
    return hair.Hair(float3(params.b.w), params.b.x, params.b.y, params.b.z, 1.55)


@ox.program
def __raygen__sample_hair():
    """a: wo and h."""
    u = load()
    sample = hair.hair_sample(fibre(), params.a.w, params.a.xyz, u.xy, u.zw)
    store(sample.wi, sample.pdf)


@ox.program
def __raygen__pdf_hair():
    wi = load().xyz
    store(hair.hair_eval(fibre(), params.a.w, params.a.xyz, wi), hair.hair_pdf(fibre(), params.a.w, params.a.xyz, wi))


@ox.program
def __raygen__weight_hair():
    u = load()
    store(hair.hair_sample(fibre(), params.a.w, params.a.xyz, u.xy, u.zw).weight, 0.0)


@ox.program
def __raygen__cubic_bspline():
    """Row: parameter. The control points are a corner of the unit cube each, with radii 1 to 4."""
    p = (float4(0.0, 0.0, 0.0, 1.0), float4(1.0, 0.0, 0.0, 2.0), float4(1.0, 1.0, 0.0, 3.0), float4(1.0, 1.0, 1.0, 4.0))
    u = load().x
    if params.a.x == 0.0:
        point = curves.cubic_bspline_point(p, u) if params.a.y == 0.0 else curves.catmull_rom_point(p, u)
        store(point.xyz, point.w)
    else:
        store(curves.cubic_bspline_tangent(p, u) if params.a.y == 0.0 else curves.catmull_rom_tangent(p, u), 0.0)
