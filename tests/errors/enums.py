import enum
from enum import IntEnum, IntFlag

import optixc as ox


class Mode(IntEnum):
    A = 1
    B = enum.auto()
    C = "text"  # E[OX208]: must be an integer constant

    def method(self):  # E[OX208]: holds members only
        return 1


class Flags(IntFlag):
    X = enum.auto()
    Y = X << 1


@ox.program
def __raygen__a():
    m = Mode.B
    n = Mode.D  # E[OX311]: has no member `D`
    o = Flags.X | Flags.Y
