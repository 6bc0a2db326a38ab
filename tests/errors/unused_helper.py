import optixc as ox


@ox.device
def never_called(x: float) -> float:
    return x + undefined_name  # E[OX301]: `undefined_name` is not defined


@ox.program
def __raygen__a():
    pass
