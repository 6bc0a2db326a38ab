import optixc as ox
from optixc import float3, float4


@ox.struct
class Params:
    image: ox.Array2[float4]
    values: ox.Array[float]
    scene: ox.Traversable


params = ox.launch_params(Params)


@ox.program
def __raygen__a():
    v = float3(1.0)
    a = v.w  # E[OX311]: float3 has no component `w`
    b = v.xyzxyz  # E[OX311]: has no component
    c = params.immage  # E[OX311]: did you mean `image`?
    d = params.image[1]  # E[OX312]: takes 2 indices, here are 1
    e = params.values[1.5]  # E[OX312]: an index must be an integer
    f = params.values[-1]  # E[OX312]: an index is never negative
    g = v[3]  # E[OX312]: float3 has no index 3
    h = (1, 2)
    k = 1
    i = h[k]  # E[OX312]: a tuple's index must be a constant
    j = h[2]  # E[OX312]: the tuple has 2 items
    l = params.scene[0]  # E[OX312]: Traversable cannot be indexed
    m = k.real  # E[OX311]: int32 has no attribute `real`
    n = v.normalize()  # E[OX319]: write ox.normalize(v)
    o = params.image.size  # E[OX311]: an array has `.shape` only
    p = v[1, 2]  # E[OX312]: takes one index
    q = len(v)  # E[OX302]: len() takes an array
