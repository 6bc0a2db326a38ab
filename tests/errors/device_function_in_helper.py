import optixc as ox


def inner():
    ox.terminate_ray()  # E[OX304]: terminate_ray() is only allowed in an anyhit program this helper is reached from miss program `__miss__sky`


def outer():
    inner()


@ox.program
def __miss__sky():
    outer()
