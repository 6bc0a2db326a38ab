"""Every statement, and where locals are declared."""

import optixc as ox
from optixc import float2, int32


@ox.struct
class Params:
    numbers: ox.Array[int32]
    count: int32
    step: int32


params = ox.launch_params(Params)


@ox.device
def collatz(n: int32) -> int32:
    """Turns until 1; the loop has no provable bound."""
    turns = 0
    while n != 1:
        n = n // 2 if n % 2 == 0 else 3 * n + 1
        turns += 1
    return turns


@ox.device
def divide(a: int32, b: int32) -> tuple[int32, int32]:
    return a // b, a % b


@ox.device
def factorial(n: int32) -> int32:
    if n <= 1:
        return 1
    return n * factorial(n - 1)


@ox.program
def __raygen__main():
    i = ox.get_launch_index().x
    total = 0
    for k in range(params.count):
        if k == 3:
            continue
        elif k > 10:
            break
        else:
            total += k
    for k in range(10, 0, params.step):
        total -= k
    for k in range(4):
        last = k * total
        total += last
    found = -1
    while found < 0:
        found = collatz(total)
        if found == 7:
            break
    while found < 10:
        found += 1
    quotient, rest = divide(total, 7)
    quotient, rest = rest, quotient
    if total > 5:  # noqa: SIM108
        kept = quotient
    else:
        kept = rest
    pair = float2(1.0, 2.0)
    pair.x = float(kept)
    match kept:
        case 0 | 1:
            total = factorial(5)
        case 2:
            total = 2
        case _:
            total += int32(pair.x)
    params.numbers[i] = total
