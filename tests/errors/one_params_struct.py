import optixc as ox


@ox.struct
class Params:
    x: float


@ox.struct
class Other:
    y: float


params = ox.launch_params(Params)
more = ox.launch_params(Other)


@ox.program
def __raygen__a():
    a = params.x
    b = more.y  # E[OX205]: the launch parameters are Params elsewhere and Other here
