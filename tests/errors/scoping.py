import optixc as ox
from optixc import float3


@ox.program
def __raygen__a():
    i = ox.get_launch_index()
    if i.x > 3:
        a = 1.0
    b = a  # E[OX306]: it is bound if the condition in line 8 holds, but not if the condition in line 8 does not hold
    while i.y > 5:
        c = 1
        break
    d = c  # E[OX306]: at the break in line 13, but not if the loop in line 11 does not run
    for k in range(int(i.x)):
        e = k
    f = e  # E[OX306]: `e` may have no value here
    g = k  # E[OX306]: `k` may have no value here
    h = late  # E[OX306]: `late` is used before it is bound
    late = 1
    for m in range(4):
        fine = m
    n = fine + m
    if i.x > 1:
        o = 1
    else:
        o = 2.5
    p = o  # E[OX320]: `o` has no one type here: it is int32 if the condition
    q = 0
    for _ in range(10):
        q = q + 0.5  # E[OX320]: `q` changes its type in the loop: it is int32 before and float32 after
    match i.x:
        case 1:
            r = 1
    s = r  # E[OX306]: but not if no case of the match in line 32 fits
