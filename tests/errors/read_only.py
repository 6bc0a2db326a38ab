import optixc as ox
from optixc import float3


@ox.struct
class Params:
    eye: float3
    inner: "Inner"
    values: ox.Array[float]


@ox.struct
class Inner:
    x: float


@ox.attributes
class Hit:
    n: float3


params = ox.launch_params(Params)
LIMIT = 3


def change(inner: Inner):
    inner.x = 2.0


def rebind(inner: Inner):
    inner = Inner(1.0)  # E[OX307]: cannot be bound anew


@ox.program
def __closesthit__a(hit: Hit, record: Inner):
    params.eye = float3(1.0)  # E[OX307]: launch parameters are read-only
    params.eye.x = 1.0  # E[OX307]: launch parameters are read-only
    params.values[0] = 1.0
    params.values[0] += 1.0
    record.x = 2.0  # E[OX307]: the data of an SBT record is read-only
    hit.n = float3(1.0)  # E[OX307]: attributes are read-only
    change(params.inner)  # E[OX307]: `change` changes `inner`, but launch parameters are read-only
    change(record)  # E[OX307]: the data of an SBT record is read-only
    change(ox.copy(record))
    v = float3(1.0)
    v.xy = v.zx  # E[OX307]: several components cannot be assigned at once
    ox.LIMIT = 3  # E[OX301]: `ox` has no `LIMIT`
    (1 + 2).x = 3  # E[OX311]: has no attribute `x`
    rebind(Inner(1.0))
