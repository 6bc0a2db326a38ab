"""Orthonormal frames: local coordinates with z along a normal."""

import optixc as ox
from optixc import float3


@ox.struct
class Frame:
    """Three orthonormal vectors, right-handed."""

    tangent: float3
    bitangent: float3
    normal: float3


@ox.device
def frame_from_normal(n: float3) -> Frame:
    """Any frame around a unit normal, without branches on its direction.
    T. Duff and others, "Building an Orthonormal Basis, Revisited", JCGT 2017."""
    sign = 1.0 if n.z >= 0.0 else -1.0
    a = -1.0 / (sign + n.z)
    b = n.x * n.y * a
    return Frame(float3(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), float3(b, sign + n.y * n.y * a, -n.y), n)


@ox.device
def frame_from_tangent(n: float3, direction: float3) -> Frame:
    """The frame whose tangent is `direction` made perpendicular to the unit normal; `direction` must not be parallel to it."""
    tangent = ox.normalize(direction - ox.dot(n, direction) * n)
    return Frame(tangent, ox.cross(n, tangent), n)


@ox.device
def to_world(frame: Frame, v: float3) -> float3:
    """Local coordinates to world."""
    return v.x * frame.tangent + v.y * frame.bitangent + v.z * frame.normal


@ox.device
def to_local(frame: Frame, v: float3) -> float3:
    """World coordinates to local."""
    return float3(ox.dot(v, frame.tangent), ox.dot(v, frame.bitangent), ox.dot(v, frame.normal))
