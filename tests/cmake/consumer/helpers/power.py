import optixc as ox


@ox.device
def power(x: int) -> int:
    return x * x
