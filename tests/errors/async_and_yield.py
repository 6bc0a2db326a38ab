import optixc as ox


async def helper():
    return 1


def generator():
    yield 1  # E[OX402]: `yield` is not part of restricted Python
    x = yield from [1]  # E[OX402]: `yield from` is not part of restricted Python


async def waits():
    await helper()


@ox.program
def __raygen__a():
    generator()
    helper()  # E[OX310]: an async function
