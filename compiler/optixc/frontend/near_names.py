"""What an author may have meant by a name that optixc does not have: OptiX's and CUDA's own names, misspellings, what goes another way."""

from __future__ import annotations

import difflib
import re

from optixc import enums
from optixc.frontend import builtin_names as names
from optixc.frontend.builtin_symbols import builtin_symbol
from optixc.ir.intrinsic_naming import snake_name
from optixc.ir.intrinsic_rows import INTRINSICS

_KNOWN = (*INTRINSICS, *names.SPECIAL_FORMS, *names.TYPE_NAMES, *names.STRUCT_DECORATORS, *names.FUNCTION_DECORATORS, *names.ARRAY_RANKS)
_OTHER_WAYS = {
    "get_sbt_data_pointer": "`ox.get_sbt_data(Struct)` is the record's data, as is a program's parameter of that struct",
    "hit_object_get_sbt_data_pointer": "`ox.hit_object_get_sbt_data(Struct)` is the record's data",
    "get_exception_line_info": "the error of a failed launch tells program, path and line",
    "optix_visibility_mask": "a visibility mask is a plain number of 8 bits",
    "is_displaced_micromesh_triangle_hit": "there are no displacement micromaps: OptiX dropped them",
}
_CUDA = re.compile(r"make_(?P<vector>[a-z]+[234])|__(?P<bits>[a-z_]+)|f?(?P<math>[a-z0-9]+?)f?")
"""`make_float3`, `__float_as_uint`, `sqrtf` and `fmaxf`."""


def suggestion(name: str) -> str:
    """A note for the name, in the form `ox.name`; empty if nothing comes near."""
    known = other_spelling(name)
    if known:
        return known
    near = difflib.get_close_matches(snake_name(name), _KNOWN, 1, 0.8)
    return f"did you mean `ox.{near[0]}`?" if near else ""


def other_spelling(name: str) -> str:
    """The note for a name that OptiX, CUDA or C has for something that is there; empty for others."""
    plain = snake_name(name)
    if plain in _OTHER_WAYS:
        return _OTHER_WAYS[plain]
    if name.startswith("OPTIX_"):
        found = _member(name.removeprefix("OPTIX_"))
    else:
        cuda = _CUDA.fullmatch(name)
        candidates = (plain, *((text for text in cuda.groups() if text) if cuda else ()))
        found = next((one for one in candidates if builtin_symbol(one) is not None), "")
    return f"did you mean `ox.{found}`?" if found else ""


def _member(name: str) -> str:
    """`Enum.MEMBER` for what OptiX writes as one name, by the enum whose name is nearest to the rest of it."""
    words = name.split("_")
    found = [
        (difflib.SequenceMatcher(None, "".join(words[:split]).lower(), enum.lower()).ratio(), f"{enum}.{'_'.join(words[split:])}")
        for split in range(1, len(words))
        for enum in enums.__all__
        if hasattr(getattr(enums, enum), "__members__") and "_".join(words[split:]) in getattr(enums, enum).__members__
    ]
    likeness, member = max(found, default=(0.0, ""))
    return member if likeness > 0.8 else ""
