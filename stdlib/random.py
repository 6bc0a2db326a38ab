"""Random numbers: a sequential generator (PCG32), counter-based hashes (PCG, Philox) and Owen-scrambled Sobol points."""

import optixc as ox
from optixc import float2, uint2, uint3, uint4, uint32, uint64


@ox.struct
class Pcg32:
    """The state of a PCG32 generator; `increment` is odd and chooses the sequence."""

    state: uint64
    increment: uint64


@ox.device
def pcg32_next(rng: Pcg32) -> uint32:
    """32 random bits; steps the generator. M. O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms
    for Random Number Generation", 2014 (XSH RR 64/32)."""
    old = rng.state
    rng.state = old * uint64(6364136223846793005) + rng.increment
    shifted = uint32(((old >> 18) ^ old) >> 27)
    rotation = uint32(old >> 59)
    return (shifted >> rotation) | (shifted << ((32 - rotation) & 31))


@ox.device
def pcg32(seed: uint64, sequence: uint64) -> Pcg32:
    """A generator; different sequences are independent. Give each pixel or ray a sequence of its own."""
    rng = Pcg32(0, (sequence << 1) | 1)
    pcg32_next(rng)
    rng.state += seed
    pcg32_next(rng)
    return rng


@ox.device
def pcg32_float(rng: Pcg32) -> float:
    """A float in [0, 1), a multiple of 2^-24."""
    return unit_float(pcg32_next(rng))


@ox.device
def pcg32_float2(rng: Pcg32) -> float2:
    """A point of the unit square."""
    x = pcg32_float(rng)
    y = pcg32_float(rng)
    return float2(x, y)


@ox.device
def pcg32_below(rng: Pcg32, bound: uint32) -> uint32:
    """A whole number in [0, bound), without bias. D. Lemire, "Fast Random Integer Generation in an Interval", 2019."""
    product = uint64(pcg32_next(rng)) * uint64(bound)
    low = uint32(product & 0xFFFFFFFF)
    if low < bound:
        threshold = (0 - bound) % bound
        while low < threshold:
            product = uint64(pcg32_next(rng)) * uint64(bound)
            low = uint32(product & 0xFFFFFFFF)
    return uint32(product >> 32)


@ox.device
def unit_float(bits: uint32) -> float:
    """The upper 24 bits as a float in [0, 1)."""
    return float(bits >> 8) * 5.9604644775390625e-08


@ox.device
def hash_uint(x: uint32) -> uint32:
    """A well mixed word. M. Jarzynski, M. Olano, "Hash Functions for GPU Rendering", 2020 (`pcg`)."""
    state = x * uint32(747796405) + uint32(2891336453)
    word = ((state >> ((state >> 28) + 4)) ^ state) * uint32(277803737)
    return (word >> 22) ^ word


@ox.device
def hash_uint3(x: uint3) -> uint3:
    """Three well mixed words of three, e.g. pixel x, pixel y, frame. Same source (`pcg3d`)."""
    v = x * uint32(1664525) + uint32(1013904223)
    v.x += v.y * v.z
    v.y += v.z * v.x
    v.z += v.x * v.y
    v.x ^= v.x >> 16
    v.y ^= v.y >> 16
    v.z ^= v.z >> 16
    v.x += v.y * v.z
    v.y += v.z * v.x
    v.z += v.x * v.y
    return v


@ox.device
def philox_round(counter: uint4, key: uint2) -> uint4:
    """One round of `philox`."""
    low0 = counter.x * uint32(0xD2511F53)
    low1 = counter.z * uint32(0xCD9E8D57)
    high0 = ox.mul_hi(counter.x, uint32(0xD2511F53))
    high1 = ox.mul_hi(counter.z, uint32(0xCD9E8D57))
    return uint4(high1 ^ counter.y ^ key.x, low1, high0 ^ counter.w ^ key.y, low0)


@ox.device
def philox(counter: uint4, key: uint2) -> uint4:
    """Four words for each counter and key, of statistical quality enough for any simulation (Philox-4x32-10).
    J. Salmon and others, "Parallel Random Numbers: As Easy as 1, 2, 3", 2011."""
    result = counter
    round_key = key
    for _ in range(10):
        result = philox_round(result, round_key)
        round_key = uint2(round_key.x + uint32(0x9E3779B9), round_key.y + uint32(0xBB67AE85))
    return result


@ox.device
def owen_scramble(x: uint32, seed: uint32) -> uint32:
    """A nested uniform scramble of the digits of `x` in base 2, chosen by `seed`.
    B. Burley, "Practical Hash-based Owen Scrambling", 2020, after Laine and Karras."""
    x = ox.reverse_bits(x)
    x += seed
    x ^= x * uint32(0x6C50B47C)
    x ^= x * uint32(0xB82F1E52)
    x ^= x * uint32(0xC7AFE638)
    x ^= x * uint32(0x8D22F6E6)
    return ox.reverse_bits(x)


@ox.device
def sobol_second(index: uint32) -> uint32:
    """Dimension 1 of the Sobol sequence; dimension 0 is `reverse_bits`.
    T. Kollig, A. Keller, "Efficient Multidimensional Sampling", 2002."""
    result = uint32(0)
    direction = uint32(0x80000000)
    while index != 0:
        if (index & 1) != 0:
            result ^= direction
        index >>= 1
        direction ^= direction >> 1
    return result


@ox.device
def sobol_owen_2d(index: uint32, seed: uint32) -> float2:
    """Point `index` of a (0, 2)-sequence with a shuffle and scrambles of its own for each seed: any 2^k points from a multiple of 2^k on
    hit every elementary interval once. Further pairs of dimensions: the same index with another seed (padding). Same source as
    `owen_scramble`."""
    shuffled = owen_scramble(index, hash_uint(seed))
    x = owen_scramble(ox.reverse_bits(shuffled), hash_uint(seed ^ uint32(0x68BC21EB)))
    y = owen_scramble(sobol_second(shuffled), hash_uint(seed ^ uint32(0x02E5BE93)))
    return float2(unit_float(x), unit_float(y))


@ox.device
def pixel_sample_2d(sample: uint32, pixel: uint32, dimension: uint32) -> float2:
    """Point `sample` of the sequence that a pixel has for one purpose, its `dimension`: `sobol_owen_2d` with a seed for the pair."""
    return sobol_owen_2d(sample, hash_uint(pixel) + dimension * uint32(0x9E3779B9))
