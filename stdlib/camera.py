"""Cameras: from a point of the image, (0, 0) at its upper left corner and (1, 1) at its lower right, to a ray."""

import optixc as ox
from optixc import float2, float3
from optixc.stdlib.math import PI
from optixc.stdlib.sampling import uniform_disk


@ox.struct
class Pinhole:
    """`w` leads from the eye to the centre of the image plane, `u` to its right and `v` to its upper edge from there."""

    eye: float3
    u: float3
    v: float3
    w: float3


@ox.struct
class ThinLens:
    """The image plane lies in focus; `lens_u` and `lens_v` are the lens's half axes."""

    eye: float3
    u: float3
    v: float3
    w: float3
    lens_u: float3
    lens_v: float3


@ox.struct
class Panorama:
    """Sees all directions: longitude along the image's width, latitude down its height; `forward` is in the middle."""

    eye: float3
    forward: float3
    right: float3
    up: float3


@ox.device
def look_at(eye: float3, target: float3, up: float3, vertical_fov: float, aspect: float) -> Pinhole:
    """A camera that looks at `target`; the field of view is in radians, `aspect` is width over height."""
    w = target - eye
    right = ox.normalize(ox.cross(w, up))
    half_height = ox.length(w) * ox.tan(0.5 * vertical_fov)
    return Pinhole(eye, (half_height * aspect) * right, half_height * ox.normalize(ox.cross(right, w)), w)


@ox.device
def pinhole_direction(camera: Pinhole, screen: float2) -> float3:
    """The unit direction of the ray from `camera.eye`."""
    return ox.normalize((2.0 * screen.x - 1.0) * camera.u + (1.0 - 2.0 * screen.y) * camera.v + camera.w)


@ox.device
def thin_lens_ray(camera: ThinLens, screen: float2, u: float2) -> tuple[float3, float3]:
    """Origin on the lens and unit direction towards the point in focus. PBRT 4ed. 5.2.3."""
    lens = uniform_disk(u)
    offset = lens.x * camera.lens_u + lens.y * camera.lens_v
    focus = (2.0 * screen.x - 1.0) * camera.u + (1.0 - 2.0 * screen.y) * camera.v + camera.w
    return camera.eye + offset, ox.normalize(focus - offset)


@ox.device
def panorama_direction(camera: Panorama, screen: float2) -> float3:
    """The unit direction of the ray from `camera.eye`."""
    phi = (2.0 * screen.x - 1.0) * PI
    theta = screen.y * PI
    sine = ox.sin(theta)
    return (sine * ox.cos(phi)) * camera.forward + (sine * ox.sin(phi)) * camera.right + ox.cos(theta) * camera.up
