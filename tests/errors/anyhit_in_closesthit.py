import optixc as ox


@ox.payload
class Ray:
    color: ox.float3


@ox.program
def __closesthit__surface(ray: Ray):
    ray.color = ox.float3(0.0)
    ox.ignore_intersection()  # E[OX304]: ignore_intersection() is only allowed in an anyhit program this is closesthit program `__closesthit__surface`
