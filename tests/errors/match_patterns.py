import optixc as ox


@ox.program
def __raygen__a():
    x = ox.get_launch_index().x
    match x:
        case y if y > 3:  # E[OX407]: a pattern that binds a name
            pass
    match x:
        case [1, 2]:  # E[OX407]: this pattern is not part
            pass
        case ox.sin:  # E[OX402]: `ox.sin` is not a value
            pass
        case -1:  # E[OX313]: this pattern is uint32
            pass
        case 1 | 2:
            pass
        case True:  # E[OX407]: this pattern is a bool
            pass
    match 1.5:  # E[OX407]: match takes an integer
        case 1:
            pass
