import optixc as ox
from optixc import float3


@ox.struct
class Data:
    x: float


@ox.attributes
class Hit:
    n: float3


@ox.program
def __intersection__a():
    a = ox.report_intersection(1.0, 200)  # E[OX313]: a hit kind is 0 to 127
    b = ox.report_intersection(1.0, 0, Data(1.0))  # E[OX302]: Data is no attributes class
    c = ox.report_intersection(1.0, 0, float3(1.0))  # E[OX302]: a word is a number of 32 bits
    d = ox.report_intersection(1.0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9)  # E[OX305]: at most 8 words
    e = ox.report_intersection(1.0, 0, Hit(float3(1.0)))
    f = ox.report_intersection(1.0)  # E[OX305]: misses `hit_kind`
    g = ox.get_sbt_data(float)  # E[OX302]: takes an `@ox.struct` class
    h = ox.get_sbt_data(Data).x
    i = ox.direct_call()  # E[OX305]: misses the index
    j = ox.direct_call(1, 2, kind=float)  # E[OX305]: has no parameter `kind`
    k = ox.direct_call(1, 2.0)  # E[OX321]: this call gives no value
    l = ox.copy(1, 2)  # E[OX305]: takes 1 argument
    m = ox.launch_params(Data)  # E[OX402]: belongs to module level
    ox.throw_exception(-1)  # E[OX313]: an exception code is 0 to
