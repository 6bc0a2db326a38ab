import optixc as ox
from optixc import float3


@ox.struct
class Material:
    color: float3


@ox.payload
class Ray:
    color: float3


@ox.attributes
class Hit:
    n: float3


@ox.program
def __raygen__a(ray: Ray):  # E[OX315]: a raygen program does not take a parameter of type Ray
    pass


@ox.program
def __miss__a(hit: Hit):  # E[OX315]: a miss program does not take
    pass


@ox.program
def __miss__b(ray):  # E[OX315]: parameter `ray` of a program needs a type
    c = ray.color


@ox.program
def __closesthit__a(a: Material, b: Material):  # E[OX315]: a second record
    pass


@ox.program
def __closesthit__b(x: float):  # E[OX315]: does not take a parameter of type float32
    pass


@ox.program
def __anyhit__c(*args):  # E[OX404]: a program takes plain parameters only
    pass


@ox.program
def __anyhit__d(ray: Ray = 1):  # E[OX404]: a program takes plain parameters only
    pass


@ox.program
def __anyhit__e(ray: Missing):  # E[OX201]: `Missing` is no type
    x = ray.color


def variadic(*values):  # E[OX404]: `*values` is not part
    return 1


def keywords(**values):  # E[OX404]: `**values` is not part
    return 1


def two(a, b=2):
    return a + b


@ox.program
def __raygen__b():
    a = variadic(1)
    b = keywords(x=1)
    c = two(*(1, 2))  # E[OX404]: `*` in a call
    d = two(**{})  # E[OX404]: `**` in a call
    e = two(1, c=3)  # E[OX305]: no parameter `c`
    f = two()  # E[OX305]: misses `a`
    g = two(1, 2, 3)  # E[OX305]: takes 2 arguments, here are 3
    h = two(1)


def doubled(x, x):  # E[OX404]: two parameters are called `x`
    return x


@ox.program
def __miss__doubled(r: Material, r: Ray):  # E[OX404]: two parameters are called `r`
    y = doubled(1, 2)
