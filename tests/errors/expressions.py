import optixc as ox


@ox.program
def __raygen__a():
    a = [1, 2, 3]  # E[OX402]: a list is not part of restricted Python
    b = {1: 2}  # E[OX402]: a dict is not part of restricted Python
    c = {1, 2}  # E[OX402]: a set is not part of restricted Python
    d = [i for i in range(3)]  # E[OX402]: a list comprehension
    e = {i for i in range(3)}  # E[OX402]: a set comprehension
    f = {i: i for i in range(3)}  # E[OX402]: a dict comprehension
    g = (i for i in range(3))  # E[OX402]: a generator expression
    h = lambda x: x  # E[OX402]: a lambda
    k = True
    j = (i := 3)  # E[OX402]: an assignment expression
    l = 3j  # E[OX402]: a complex number
    m = None  # E[OX402]: None is not a value
    n = ...  # E[OX402]: `...` is not a value
    o = *a, 1  # E[OX402]: unpacking with `*`
    p = ox.FixedArray[float, 4]()
    q = p[1:3]  # E[OX402]: slices are not part
    r = 1 in (1, 2)  # E[OX405]: `in` is not part
    s = k is True  # E[OX405]: `is` is not part
