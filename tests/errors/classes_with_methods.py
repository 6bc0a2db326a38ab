import optixc as ox
from optixc import float3


@ox.struct
class Ball:
    center: float3

    def radius(self):  # E[OX202]: a struct has no methods
        return 1.0

    @property
    def area(self):  # E[OX202]: a struct has no methods
        return 1.0


class Plain:
    x: float


@ox.program
def __raygen__a():
    p = Plain()  # E[OX310]: a class without `@ox.struct`
    b = Ball(float3(0.0))
    c = b.radius()  # E[OX319]: Ball has no methods
