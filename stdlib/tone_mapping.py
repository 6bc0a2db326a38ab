"""From radiance to a display: exposure, curves that bring highlights into range, the sRGB encoding. Colours are linear sRGB."""

import optixc as ox
from optixc import float3
from optixc.stdlib.math import luminance


@ox.device
def expose(color: float3, stops: float) -> float3:
    """Twice as bright for each stop."""
    return color * ox.exp2(stops)


@ox.device
def srgb_encode_channel(x: float) -> float:
    """A linear value in [0, 1] as its sRGB code value. IEC 61966-2-1."""
    return 12.92 * x if x <= 0.0031308 else 1.055 * ox.pow(x, 1.0 / 2.4) - 0.055


@ox.device
def srgb_decode_channel(x: float) -> float:
    """The reverse."""
    return x / 12.92 if x <= 0.04045 else ox.pow((x + 0.055) / 1.055, 2.4)


@ox.device
def srgb_encode(color: float3) -> float3:
    """All three channels, clipped to [0, 1] first."""
    return float3(
        srgb_encode_channel(ox.saturate(color.x)), srgb_encode_channel(ox.saturate(color.y)), srgb_encode_channel(ox.saturate(color.z))
    )


@ox.device
def srgb_decode(color: float3) -> float3:
    """All three channels."""
    return float3(srgb_decode_channel(color.x), srgb_decode_channel(color.y), srgb_decode_channel(color.z))


@ox.device
def reinhard(color: float3, white: float) -> float3:
    """Compresses luminance so that `white` becomes 1. E. Reinhard and others, "Photographic Tone Reproduction", 2002, equation 4."""
    y = luminance(color)
    return color * ((1.0 + y / (white * white)) / (1.0 + y))


@ox.device
def filmic(color: float3) -> float3:
    """A film-like curve. K. Narkowicz, "ACES Filmic Tone Mapping Curve", 2015."""
    x = 0.6 * color
    return ox.saturate((x * (2.51 * x + float3(0.03))) / (x * (2.43 * x + float3(0.59)) + float3(0.14)))
