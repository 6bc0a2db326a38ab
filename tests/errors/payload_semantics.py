import optixc as ox
from optixc import float3


@ox.payload
class Ray:
    color: float3 = ox.payload_word(caller="r", ch="w", ms="w")
    depth: int = ox.payload_word(caller="w", ch="r")


def helper(ray: Ray):
    ray.depth = 3  # E[OX317]: a closesthit program may not write `Ray.depth`


@ox.program
def __closesthit__c(ray: Ray):
    c = ray.color  # E[OX317]: a closesthit program may not read `Ray.color`
    helper(ray)


@ox.program
def __miss__m(ray: Ray):
    ray.color = float3(0.0)
    d = ray.depth  # E[OX317]: a miss program may not read `Ray.depth`
    w = ox.get_payload_3()  # E[OX317]: a miss program may not read `Ray.depth`
    v = ox.get_payload_4()  # E[OX317]: has 4 words, so there is no word 4


@ox.program
def __anyhit__a(ray: Ray):
    ox.set_payload_0(1)  # E[OX317]: an anyhit program may not write `Ray.color`
