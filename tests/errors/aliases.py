import optixc as ox
from optixc import float3


@ox.struct
class Inner:
    x: float


@ox.struct
class Outer:
    inner: Inner


@ox.struct
class Params:
    inner: Inner
    list: ox.Array[Inner]


params = ox.launch_params(Params)


def same(inner: Inner):
    return inner  # E[OX308]: write ox.copy(inner)


def new(x: float):
    inner = Inner(x)
    return ox.copy(inner)


@ox.program
def __raygen__a():
    a = Inner(1.0)
    b = a  # E[OX308]: `b` would be a second name of the Inner `a`
    c = ox.copy(a)
    d = Outer(a)  # E[OX308]: field `inner` would be a second name
    e = Outer(ox.copy(a))
    f = e.inner  # E[OX308]: write ox.copy(e.inner)
    e.inner = a  # E[OX308]: `e.inner` would be a second name
    g = params.inner  # E[OX308]: write ox.copy(params.inner)
    h = params.list[0]
    params.list[1] = a
    i = new(2.0)
    j, k = a, c  # E[OX308]: `j` would be a second name # E[OX308]: `k` would be a second name
    l = a if a.x > 1.0 else c  # E[OX308]: second name of the Inner `a`
    m = ox.FixedArray[float, 3]()
    n = m  # E[OX308]: write ox.copy(m)
    o = same(a)


def pair(inner: Inner):
    a = Inner(1.0)
    b = Inner(2.0)
    return (a, b) if a.x > inner.x else (b, a)


def twice_the_same():
    a = Inner(1.0)
    return a, a  # E[OX308]: the result would be a second name of the Inner `a`


@ox.program
def __miss__a():
    x, y = pair(params.inner)
    z, w = twice_the_same()
    v = 1.0
    v(2.0)  # E[OX319]: `v` is a local here
    params.inner(1)  # E[OX319]: Inner is not a function
    (1 + 2)(3)  # E[OX319]: an int literal is not a function
