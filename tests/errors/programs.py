import optixc as ox


@ox.program
def __shader__a():  # E[OX204]: a program of unknown kind
    pass


@ox.program
def plain():  # E[OX204]: a program of unknown kind
    pass


@ox.program
@staticmethod  # E[OX210]: no other decorator
def __raygen__b():
    pass


def __raygen__twice():
    pass


def __raygen__twice():  # E[OX203]: `__raygen__twice` is defined twice
    pass


@ox.program
def __miss__c():
    __raygen__b()  # E[OX319]: `__raygen__b` is a program and cannot be called
