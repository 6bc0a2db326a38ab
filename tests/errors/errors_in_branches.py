import optixc as ox


# A name whose value had an error on one way is no error where the ways meet.
@ox.program
def __raygen__a():
    i = ox.get_launch_index().x
    n = ox.float3(1.0)
    if i == 1:
        n = missing  # E[OX301]: nothing defines it
    elif i == 2:
        (s,) = ox.get_launch_index()  # E[OX302]: 1 names for 3 values
        n = s.xyz
    else:
        n = ox.float3(3.0)
    while i < 3:
        m = absent  # E[OX301]: nothing defines it
        n = n + m
        i += 1
    match i:
        case 3:
            k = absent  # E[OX301]: nothing defines it
        case _:
            k = 1
    print(n, k)
