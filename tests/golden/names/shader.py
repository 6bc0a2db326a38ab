"""Names that C++ reserves or that the emitter would like to use itself, and letters that C++ does not take everywhere."""

import optixc as ox
from optixc import float3, int32


@ox.struct
class template:
    double: int32
    class_: float3
    thread: int32


@ox.payload
class Programs:
    int32_t: int32
    trace: int32


@ox.struct
class Params:
    out: ox.Array[int32]
    scene: ox.Traversable
    register: template


params = ox.launch_params(Params)


@ox.device
def namespace(auto: int32, params_: int32) -> int32:
    """A comment that ends in a backslash \\"""
    return auto + params_


@ox.device
def größe(ø: int32) -> int32:
    return ø + 1


@ox.program
def __raygen__main():
    thread = params.register.double
    trace = thread + params.register.thread
    long = größe(trace)
    oxrt = namespace(long, trace)
    new = Programs(oxrt, 1)
    ox.trace(params.scene, params.register.class_, float3(0.0, 0.0, 1.0), payload=new)
    params.out[0] = new.int32_t + new.trace


@ox.program
def __closesthit__delete(trace: Programs):
    thread = params.register.thread
    trace.int32_t = thread
    trace.trace = int32(ox.get_primitive_index())
