"""A neural material: a small network learns a glazed material in launches, and then shades a torus beside the material itself.

The network has 24 inputs (waves of the point on the surface, cosines and their powers), two hidden layers of 32 and a colour. A launch
index of `__raygen__learn` is one sample of a batch: forwards, then the gradient of its squared error backwards, added to accumulators
that all launch indices share.
"""

import optixc as ox
from optixc import CoopVecMatrixLayout, float2, float3, float4, uint3, uint32, uint64
from optixc.stdlib.camera import Pinhole, pinhole_direction
from optixc.stdlib.math import PI
from optixc.stdlib.random import pcg32, pcg32_float2

INPUTS = 24
WIDTH = 32
OCTAVES = 4
OPTIMAL = CoopVecMatrixLayout.TRAINING_OPTIMAL
Input = ox.CoopVec[ox.float16, INPUTS]
Hidden = ox.CoopVec[ox.float16, WIDTH]
Color = ox.CoopVec[ox.float16, 3]

SMALLEST = 6e-8
"""A hidden value of at least this, the smallest float16 above zero, passes its gradient on."""
EPSILON = 1e-3
SUN = 1.3
AMBIENT = 0.3


@ox.struct
class Params:
    """`network` and `gradients` hold matrices at the offsets `matrices`; biases stand in the network, and apart as gradients."""

    network: ox.Array[ox.uint8]
    gradients: ox.Array[ox.uint8]
    bias_gradients: ox.Array[ox.float32]
    matrices: uint3
    biases: uint3
    errors: ox.Array[ox.float32]
    step: uint32
    image: ox.Array2[float4]
    scene: ox.Traversable
    camera: Pinhole
    light: float3
    sample: int
    samples: int


@ox.struct
class Torus:
    """The torus around the y axis at `center`, shaded by the network or by what the network learned from."""

    center: float3
    radius: float
    is_neural: bool


@ox.payload
class Ray:
    color: float3


params = ox.launch_params(Params)


# ---- what is learned ---------------------------------------------------------------------------------------------------------


@ox.device
def reflectance(point: float2, cosines: float3) -> float3:
    """Cream and blue glaze with gold lines between; cosines are n.l, n.v and n.h. Black behind the surface."""
    x, y = 2.0 * PI * point.x, 2.0 * PI * point.y
    wave = ox.sin(4.0 * x + ox.sin(y)) * ox.cos(2.0 * y)
    blue = ox.smoothstep(0.05, 0.35, wave)
    gold = ox.smoothstep(0.3, 0.1, abs(wave - 0.2))
    base = ox.lerp(float3(0.85, 0.78, 0.62), float3(0.04, 0.12, 0.42), blue)
    diffuse = base * (1.0 - 0.8 * gold)
    edge = 0.04 + 0.5 * (1.0 - cosines.y) ** 5
    glaze = edge * (1.0 - gold) * cosines.z**48 * 6.0
    metal = float3(1.0, 0.72, 0.3) * (gold * cosines.z**12 * 1.5)
    return (diffuse + metal + float3(glaze)) * cosines.x


@ox.device
def compressed(color: float3) -> float3:
    """Bright colours count no more than dark ones."""
    return color / (color + 1.0)


# ---- the network -------------------------------------------------------------------------------------------------------------


@ox.device
def features(point: float2, cosines: float3):
    """Waves of each coordinate, twice as short each time, then the cosines and powers of the one that highlights depend on."""
    v = Input(1.0)
    for octave in range(OCTAVES):
        x, y = 2.0 * PI * point.x * float(1 << octave), 2.0 * PI * point.y * float(1 << octave)
        v[4 * octave] = ox.sin(x)
        v[4 * octave + 1] = ox.cos(x)
        v[4 * octave + 2] = ox.sin(y)
        v[4 * octave + 3] = ox.cos(y)
    v[16] = cosines.x
    v[17] = cosines.y
    v[18] = cosines.z
    v[19] = cosines.z**4
    v[20] = cosines.z**12
    v[21] = cosines.z**48
    v[22] = (1.0 - cosines.y) ** 5
    return v


@ox.device
def hidden_layer(v, matrix: uint32, bias: uint32):
    out = ox.coop_vec_mat_mul(Hidden, v, params.network, matrix, params.network, bias, matrix_layout=OPTIMAL)
    return ox.coop_vec_max(out, 0.0)


@ox.device
def color_layer(v):
    return ox.coop_vec_mat_mul(
        Color, v, params.network, params.matrices.z, params.network, params.biases.z, matrix_layout=OPTIMAL
    )


@ox.device
def neural_reflectance(point: float2, cosines: float3) -> float3:
    first = hidden_layer(features(point, cosines), params.matrices.x, params.biases.x)
    out = color_layer(hidden_layer(first, params.matrices.y, params.biases.y))
    color = ox.clamp(float3(out[0], out[1], out[2]), 0.0, 0.95)
    return color / (1.0 - color)


# ---- learning ----------------------------------------------------------------------------------------------------------------


@ox.device
def add_gradients(delta, below, matrix: uint32, bias: uint32):
    """The gradients of a hidden layer: those of its matrix are delta * transpose(what the layer was given)."""
    ox.coop_vec_outer_product_accumulate(delta, below, params.gradients, matrix)
    ox.coop_vec_reduce_sum_accumulate(ox.coop_vec_cvt(ox.CoopVec[ox.float32, WIDTH], delta), params.bias_gradients, bias)


@ox.device
def passed_back(delta, matrix: uint32, values):
    """The gradient of the values below a layer, where they are not cut off at zero."""
    back = ox.coop_vec_mat_mul(Hidden, delta, params.network, matrix, matrix_layout=OPTIMAL, transpose=True)
    return ox.coop_vec_mul(back, ox.coop_vec_step(Hidden(SMALLEST), values))


@ox.program
def __raygen__learn():
    i = ox.get_launch_index().x
    rng = pcg32(uint64(i), uint64(params.step))
    point, first_two, last = pcg32_float2(rng), pcg32_float2(rng), pcg32_float2(rng)
    # Half of the samples lie near the highlight, where the material changes fast.
    near = 1.0 - 0.3 * last.x * last.x if last.y < 0.5 else last.x
    cosines = float3(first_two.x, first_two.y, near)

    v = features(point, cosines)
    first = hidden_layer(v, params.matrices.x, params.biases.x)
    second = hidden_layer(first, params.matrices.y, params.biases.y)
    out = color_layer(second)

    difference = float3(out[0], out[1], out[2]) - compressed(reflectance(point, cosines))
    params.errors[i] = ox.dot(difference, difference) / 3.0
    delta = Color(difference.x, difference.y, difference.z)
    ox.coop_vec_outer_product_accumulate(delta, second, params.gradients, params.matrices.z)
    ox.coop_vec_reduce_sum_accumulate(ox.coop_vec_cvt(ox.CoopVec[ox.float32, 3], delta), params.bias_gradients, 8 * WIDTH)
    delta_second = passed_back(delta, params.matrices.z, second)
    add_gradients(delta_second, first, params.matrices.y, 4 * WIDTH)
    delta_first = passed_back(delta_second, params.matrices.y, first)
    add_gradients(delta_first, v, params.matrices.x, 0)


# ---- the picture -------------------------------------------------------------------------------------------------------------


@ox.program
def __raygen__camera():
    i, size = ox.get_launch_index(), ox.get_launch_dimensions()
    rng = pcg32(uint64(i.x + size.x * i.y), uint64(params.sample))
    u = pcg32_float2(rng)
    screen = float2((float(i.x) + u.x) / float(size.x), (float(i.y) + u.y) / float(size.y))
    ray = Ray(float3(0.0))
    ox.trace(params.scene, params.camera.eye, pinhole_direction(params.camera, screen), 0.0, 1e16, payload=ray)
    old = params.image[i.y, i.x]
    new = float4(ray.color, 1.0)
    params.image[i.y, i.x] = old + (new - old) / float(params.sample + 1)


@ox.device
def is_lit(position: float3, n: float3) -> bool:
    """Whether nothing stands between a point and the light; the miss program is what says so."""
    shadow = Ray(float3(-1.0))
    flags = ox.RayFlags.TERMINATE_ON_FIRST_HIT | ox.RayFlags.DISABLE_CLOSESTHIT
    ox.trace(params.scene, position + n * EPSILON, params.light, 0.0, 1e16, ray_flags=flags, payload=shadow)
    return shadow.color.x >= 0.0


@ox.program
def __closesthit__torus(ray: Ray, torus: Torus):
    direction = ox.normalize(ox.get_world_ray_direction())
    position = ox.get_world_ray_origin() + ox.get_ray_tmax() * ox.get_world_ray_direction()
    offset = position - torus.center
    around = ox.sqrt(offset.x * offset.x + offset.z * offset.z)
    ring = float3(offset.x, 0.0, offset.z) * (torus.radius / around)
    n = ox.normalize(offset - ring)
    point = float2(ox.atan2(offset.z, offset.x) / (2.0 * PI) + 0.5, ox.atan2(offset.y, around - torus.radius) / (2.0 * PI) + 0.5)

    halfway = ox.normalize(params.light - direction)
    facing = max(ox.dot(n, params.light), 0.0)
    cosines = float3(facing, max(-ox.dot(n, direction), 0.0), max(ox.dot(n, halfway), 0.0))
    if facing > 0.0 and not is_lit(position, n):
        cosines.x = 0.0
    # The sky is a second light from all sides, without a highlight.
    from_sky = float3(0.5 + 0.5 * n.y, cosines.y, 0.0)
    if torus.is_neural:
        ray.color = SUN * neural_reflectance(point, cosines) + AMBIENT * neural_reflectance(point, from_sky)
    else:
        ray.color = SUN * reflectance(point, cosines) + AMBIENT * reflectance(point, from_sky)


@ox.program
def __closesthit__floor(ray: Ray):
    position = ox.get_world_ray_origin() + ox.get_ray_tmax() * ox.get_world_ray_direction()
    light = SUN * params.light.y if is_lit(position, float3(0.0, 1.0, 0.0)) else 0.0
    ray.color = float3(0.3, 0.29, 0.28) * (light + AMBIENT)


@ox.program
def __miss__sky(ray: Ray):
    height = ox.normalize(ox.get_world_ray_direction()).y
    ray.color = ox.lerp(float3(0.62, 0.66, 0.7), float3(0.25, 0.38, 0.6), ox.saturate(height * 2.0))
