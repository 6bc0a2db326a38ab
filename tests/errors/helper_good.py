"""A helper file of the case `imports`."""

import optixc as ox


@ox.device
def half(x):
    return 0.5 * x
