import numpy as np
import optixc as ox
from math import floor
import math

from somewhere import thing
from optixc import nonsense

table = np.zeros(3)
host_only = open


def unused(x):
    return np.sin(x)


if True:
    conditional = 1

twice = 1
twice = 2


@ox.program
def __raygen__a():
    a = np.sin(1.0)  # E[OX206]: imported from module `numpy`
    b = table  # E[OX310]: `table` cannot be used in a shader: it is host code
    c = thing(1)  # E[OX206]: imported from module `somewhere`
    d = nonsense(1)  # E[OX206]: optixc, which gives shaders no `nonsense`
    e = conditional  # E[OX310]: bound by a statement of host code (`if`)
    f = twice  # E[OX310]: bound 2 times
    g = undefined_thing  # E[OX301]: `undefined_thing` is not defined
    h = ox.normalise(1)  # E[OX301]: did you mean `ox.normalize`?
    i = math.sin(1.0)  # E[OX310]: write `ox.sin`
    j = floor(1.0)  # E[OX310]: write `ox.floor`
    k = ox.RayFlags.NOTHING  # E[OX311]: has no member `NOTHING`
    l = ox  # E[OX402]: the module `ox` is not a value
    m = ox.sin  # E[OX402]: `ox.sin` is not a value
    n = ox.RayFlags  # E[OX402]: the class `ox.RayFlags` is not a value
    o = h2()  # E[OX301]: `h2` is not defined
    p = unused  # E[OX402]: the function `unused` is not a value
