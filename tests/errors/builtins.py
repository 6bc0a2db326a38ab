import optixc as ox


@ox.program
def __raygen__a():
    a = sum(1, 2)  # E[OX406]: Python's built-in `sum`
    b = round(1.5)  # E[OX406]: use ox.rint
    c = isinstance(1, int)  # E[OX406]: Python's built-in `isinstance`
    d = sorted(1)  # E[OX406]: Python's built-in `sorted`
    e = str(1)  # E[OX406]: Python's built-in `str`
    f = getattr(1, "x")  # E[OX406]: name the field
    for i in enumerate(3):  # E[OX401]: a loop runs over range(...) only
        pass
    h = pow(2, 3, 5)  # E[OX305]: pow() takes two arguments
    abs = 3
    k = abs(1)  # E[OX319]: `abs` is a local here
