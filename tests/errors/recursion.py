import optixc as ox


def untyped(n):
    return untyped(n - 1) if n > 0 else 0  # E[OX309]: its result needs a type


def device(n: int) -> int:  # E[OX309]: calls itself and uses the device function get_launch_index()
    if n > int(ox.get_launch_index().x):
        return 0
    return device(n + 1)


def fine(n: int) -> int:
    if n < 2:
        return 1
    return n * fine(n - 1)


def even(n: int) -> bool:
    return True if n == 0 else odd(n - 1)


def odd(n: int) -> bool:
    return False if n == 0 else even(n - 1)


@ox.program
def __raygen__a():
    a = untyped(3)
    b = device(3)
    c = fine(3)
    d = even(3)
