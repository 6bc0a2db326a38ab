import optixc as ox

counter = 0


@ox.program
def __raygen__a():
    global counter  # E[OX401]: `global` is not part of restricted Python
    import math  # E[OX401]: an import inside a function
    from math import pi  # E[OX401]: an import inside a function

    def inner():  # E[OX401]: a function inside a function
        return 1

    class Inner:  # E[OX401]: a class inside a function
        pass

    with open("x") as f:  # E[OX401]: `with` is not part of restricted Python
        pass
    x = 1
    del x  # E[OX401]: `del` is not part of restricted Python


@ox.program
def __raygen__loops():
    for i in [1, 2]:  # E[OX401]: a loop runs over range(...) only
        pass
    for a, b in range(3):  # E[OX401]: the target of a loop must be a name
        pass
    for i in range(3):
        pass
    else:
        x = 1  # E[OX401]: `else` of a loop
    while True:
        break
    else:
        y = 1  # E[OX401]: `else` of a loop
    for i in range(1.5):  # E[OX302]: range() takes integers
        pass
    for i in range(0, 10, 0):  # E[OX314]: the step of range() is zero
        pass
    for i in range(0, 10, 1, 2):  # E[OX305]: range() takes one to three arguments
        pass
    r = range(3)  # E[OX402]: range() stands in `for` only
