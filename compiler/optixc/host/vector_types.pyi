"""Vector classes for editors and type checkers. Written by docs/generate.py; `vectors` makes the classes themselves."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from optixc.host.vectors import Vector

_Array = np.ndarray[Any, Any]

class bool2(Vector):
    x: bool
    y: bool
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | bool) -> None: ...

class bool3(Vector):
    x: bool
    y: bool
    z: bool
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | bool) -> None: ...

class bool4(Vector):
    x: bool
    y: bool
    z: bool
    w: bool
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | bool) -> None: ...

class char2(Vector):
    x: int
    y: int
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class char3(Vector):
    x: int
    y: int
    z: int
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class char4(Vector):
    x: int
    y: int
    z: int
    w: int
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class uchar2(Vector):
    x: int
    y: int
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class uchar3(Vector):
    x: int
    y: int
    z: int
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class uchar4(Vector):
    x: int
    y: int
    z: int
    w: int
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class short2(Vector):
    x: int
    y: int
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class short3(Vector):
    x: int
    y: int
    z: int
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class short4(Vector):
    x: int
    y: int
    z: int
    w: int
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class ushort2(Vector):
    x: int
    y: int
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class ushort3(Vector):
    x: int
    y: int
    z: int
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class ushort4(Vector):
    x: int
    y: int
    z: int
    w: int
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class int2(Vector):
    x: int
    y: int
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class int3(Vector):
    x: int
    y: int
    z: int
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class int4(Vector):
    x: int
    y: int
    z: int
    w: int
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class uint2(Vector):
    x: int
    y: int
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class uint3(Vector):
    x: int
    y: int
    z: int
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class uint4(Vector):
    x: int
    y: int
    z: int
    w: int
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class longlong2(Vector):
    x: int
    y: int
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class longlong3(Vector):
    x: int
    y: int
    z: int
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class longlong4(Vector):
    x: int
    y: int
    z: int
    w: int
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class ulonglong2(Vector):
    x: int
    y: int
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class ulonglong3(Vector):
    x: int
    y: int
    z: int
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class ulonglong4(Vector):
    x: int
    y: int
    z: int
    w: int
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class half2(Vector):
    x: float
    y: float
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class half3(Vector):
    x: float
    y: float
    z: float
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class half4(Vector):
    x: float
    y: float
    z: float
    w: float
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class float2(Vector):
    x: float
    y: float
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class float3(Vector):
    x: float
    y: float
    z: float
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class float4(Vector):
    x: float
    y: float
    z: float
    w: float
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class double2(Vector):
    x: float
    y: float
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class double3(Vector):
    x: float
    y: float
    z: float
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...

class double4(Vector):
    x: float
    y: float
    z: float
    w: float
    def __set__(self, instance: Any, value: Vector | Sequence[float] | _Array | float) -> None: ...
