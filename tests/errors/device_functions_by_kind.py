import optixc as ox
from optixc import float3


@ox.program
def __raygen__start():
    a = ox.get_ray_tmax()  # E[OX304]: only allowed in
    ox.reorder()


@ox.program
def __miss__sky():
    p = ox.get_primitive_index()  # E[OX304]: only allowed in closesthit, anyhit and intersection programs
    o = ox.get_object_ray_origin()  # E[OX304]: anyhit and intersection programs
    ox.reorder()  # E[OX304]: a raygen program


@ox.program
def __direct_callable__c() -> float:
    ox.trace(ox.Traversable(0), float3(0.0), float3(0.0, 0.0, 1.0))  # E[OX304]: trace() is only allowed in
    return 1.0


@ox.program
def __exception__e():
    c = ox.get_exception_code()
    d = ox.direct_call(0, result=float)  # E[OX304]: direct_call() is only allowed in programs other than exception
    ox.throw_exception(1)  # E[OX304]: programs other than exception


@ox.program
def __closesthit__c():
    b = ox.report_intersection(1.0, 0)  # E[OX304]: an intersection program
