"""The smallest pipeline: a ray generation program that colours each pixel by its place. No rays, no scene."""

import optixc as ox
from optixc import float4


@ox.struct
class Params:
    """Launch parameters: what the host hands to every program of a launch."""

    image: ox.Array2[float4]


params = ox.launch_params(Params)


@ox.program
def __raygen__gradient():
    """Runs once per pixel: red grows to the right, green grows upwards."""
    i, size = ox.get_launch_index(), ox.get_launch_dimensions()
    x = (float(i.x) + 0.5) / float(size.x)
    y = 1.0 - (float(i.y) + 0.5) / float(size.y)
    params.image[i.y, i.x] = float4(x, y, 0.25, 1.0)
