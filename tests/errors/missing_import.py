import optixc as ox
from optixc.stdlib.nothing import thing
from .sibling import other


@ox.program
def __raygen__a():
    a = thing(1)  # E[OX206]: imported from module `optixc.stdlib.nothing`
    b = other(1)  # E[OX206]: imported from module `.sibling`
