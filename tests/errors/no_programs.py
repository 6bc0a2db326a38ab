"""Only helpers."""  # E[OX209]: the file has no programs

import optixc as ox


@ox.device
def half(x: float):
    return 0.5 * x
