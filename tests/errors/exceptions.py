import optixc as ox


@ox.program
def __raygen__a():
    try:  # E[OX401]: `try` is not part of restricted Python
        x = 1
    except ValueError:
        x = 2
    raise ValueError("no")  # E[OX401]: `raise` is not part of restricted Python
