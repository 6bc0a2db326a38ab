import optixc as ox


@ox.program
def __raygen__a():
    x = max(1, 2)  # E[OX319]: `max` is a local here
    max = 3
    range = 4
    for i in range(3):  # E[OX319]: `range` is a local here
        pass
