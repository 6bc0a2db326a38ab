"""What an author may have meant by a name that optixc does not have: OptiX's and CUDA's own names, misspellings, what goes another way."""

from __future__ import annotations

import difflib
import re

from optixc.frontend import builtin_names as names
from optixc.frontend.builtin_symbols import builtin_symbol
from optixc.ir.intrinsic_naming import snake_name
from optixc.ir.intrinsic_rows import INTRINSICS

_KNOWN = (*INTRINSICS, *names.SPECIAL_FORMS, *names.TYPE_NAMES, *names.STRUCT_DECORATORS, *names.FUNCTION_DECORATORS, *names.ARRAY_RANKS)
_OTHER_WAYS = {
    "get_sbt_data_pointer": "`ox.get_sbt_data(Struct)` is the record's data, as is a program's parameter of that struct",
    "hit_object_get_sbt_data_pointer": "`ox.hit_object_get_sbt_data(Struct)` is the record's data",
    "get_exception_line_info": "the error of a failed launch tells program, path and line",
    "is_displaced_micromesh_triangle_hit": "there are no displacement micromaps: OptiX dropped them",
}
_CUDA = re.compile(r"make_(?P<vector>[a-z]+[234])|__(?P<bits>[a-z_]+)|f?(?P<math>[a-z0-9]+?)f?")
"""`make_float3`, `__float_as_uint`, `sqrtf` and `fmaxf`."""


def suggestion(name: str) -> str:
    """A note for the name, in the form `ox.name`; empty if nothing comes near."""
    plain = snake_name(name)
    if plain in _OTHER_WAYS:
        return _OTHER_WAYS[plain]
    cuda = _CUDA.fullmatch(name)
    candidates = (plain, *((text for text in cuda.groups() if text) if cuda else ()))
    found = next((one for one in candidates if builtin_symbol(one) is not None), None)
    if found is None:
        near = difflib.get_close_matches(plain, _KNOWN, 1, 0.8)
        found = near[0] if near else None
    return "" if found is None else f"did you mean `ox.{found}`?"
