import optixc as ox


def sometimes(x):  # E[OX316]: can reach its end without a return
    if x > 1:
        return 1


def mixed(x):
    if x > 1:
        return 1
    return ox.float3(1.0)  # E[OX316]: this returns float3, an earlier return an int literal


def declared(x: float) -> int:
    return x  # E[OX302]: the result must be int32, this is float32


def nothing() -> None:
    return 1  # E[OX316]: `nothing` returns None


def bare(x) -> float:
    if x > 1:
        return  # E[OX316]: here is no value
    return 1.0


def no_value():
    pass


@ox.program
def __raygen__a():
    a = sometimes(1)
    b = mixed(1)
    c = declared(1.0)
    nothing()
    d = bare(1)
    e = no_value()  # E[OX321]: this call gives no value
    f = 1 + no_value()  # E[OX303]: nothing (the call gives no value)
    return 3  # E[OX316]: a raygen program returns no value


@ox.program
def __miss__a() -> float:  # E[OX316]: a miss program returns no value
    return 1.0  # E[OX316]: a miss program returns no value
