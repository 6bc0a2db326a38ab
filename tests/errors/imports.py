import optixc as ox
from helper_good import half, missing
from helper_bad import broken
import helper_good as good
import helper_cycle


@ox.program
def __raygen__a():
    a = half(2.0)
    b = missing(1)  # E[OX206]: defines no `missing`
    c = good.half(3.0)
    d = good.other  # E[OX301]: `good` has no `other`
    e = helper_cycle.twice(1.0)
