import optixc as ox


@ox.payload
class Ray:
    x: float


params = ox.launch_params(Ray)  # E[OX205]: must be an `@ox.struct` class
more = ox.launch_params()  # E[OX205]: takes one struct class


@ox.program
def __raygen__b():
    pass
