"""Every hit, of whatever primitive, asks for the data of triangles, spheres and curves at once."""

import optixc as ox
from optixc import float3, float4


@ox.struct
class Params:
    """Row i: (type, 0, 0, 0), then the triangle's vertices, the sphere, and the first control points of the two curves."""

    found: ox.Array2[float4]
    scene: ox.Traversable


@ox.payload
class Data:
    index: int


params = ox.launch_params(Params)


@ox.program
def __raygen__down():
    x = ox.get_launch_index().x
    data = Data(int(x))
    ox.trace(params.scene, float3(float(x), 0.0, 5.0), float3(0.0, 0.0, -1.0), payload=data)


@ox.program
def __closesthit__everything(data: Data):
    row = data.index
    params.found[row, 0] = float4(float(ox.get_primitive_type()), 0.0, 0.0, 0.0)
    p0, p1, p2 = ox.get_triangle_vertex_data()
    params.found[row, 1] = float4(p0, 0.0)
    params.found[row, 2] = float4(p1, 0.0)
    params.found[row, 3] = float4(p2, 0.0)
    params.found[row, 4] = ox.get_sphere_data()
    line = ox.get_linear_curve_vertex_data()
    params.found[row, 5] = line[0]
    curve = ox.get_cubic_bspline_vertex_data()
    params.found[row, 6] = curve[0]
