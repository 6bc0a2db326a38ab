"""OptiX's stack sizes: what each group needs, and the guide's formulas (chapter 6.8) that add them up.

Stacks here are those of host threads, which are large, so that nobody needs any of this: traces as deep as `max_trace_depth` always fit.
The numbers are real frames of the compiled programs; the functions are OptiX's, with OptiX's results.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, Protocol

from optixc.errors import InvalidValueError
from optixc.host import library

MAX_TRACE_DEPTH = 31
DEFAULT_CALLABLE_DEPTH = 2
ALIGNMENT = 16


@dataclass
class StackSizes:
    """OptixStackSizes: bytes of one frame of each kind of program, continuation stack (css) and direct stack (dss)."""

    css_rg: int = 0
    css_ms: int = 0
    css_ch: int = 0
    css_ah: int = 0
    css_is: int = 0
    css_cc: int = 0
    dss_dc: int = 0

    def include(self, other: StackSizes) -> None:
        """Each member becomes the larger one."""
        for field in fields(self):
            setattr(self, field.name, max(getattr(self, field.name), getattr(other, field.name)))


class Group(Protocol):
    """What has stack sizes: a program group."""

    def get_stack_size(self, pipeline: Any = None) -> StackSizes: ...


_MEMBER_OF_SLOT = {
    "raygen": "css_rg",
    "miss": "css_ms",
    "closesthit": "css_ch",
    "anyhit": "css_ah",
    "intersection": "css_is",
    "continuation_callable": "css_cc",
    "direct_callable": "dss_dc",
}


def sizes_of(slots: dict[str, int]) -> StackSizes:
    """The sizes of a group from the bytes of the program in each slot; the exception program's stack is not configurable."""
    named = {_MEMBER_OF_SLOT[slot]: -(-size // ALIGNMENT) * ALIGNMENT for slot, size in slots.items() if slot in _MEMBER_OF_SLOT}
    return StackSizes(**named)


def util_accumulate_stack_sizes(group: Group, stack_sizes: StackSizes, pipeline: Any = None) -> StackSizes:
    """Raises each member of `stack_sizes` to what `group` needs; begin with `StackSizes()`."""
    _check(stack_sizes)
    stack_sizes.include(group.get_stack_size(pipeline))
    return stack_sizes


def util_compute_stack_sizes(
    stack_sizes: StackSizes, max_trace_depth: int, max_cc_depth: int, max_dc_depth: int
) -> tuple[int, int, int]:
    """Direct stack from traversal, direct stack from state, continuation stack."""
    _check(stack_sizes, max_trace_depth=max_trace_depth, max_cc_depth=max_cc_depth, max_dc_depth=max_dc_depth)
    direct = max_dc_depth * stack_sizes.dss_dc
    return direct, direct, _continuation(stack_sizes, max_trace_depth, max_cc_depth * stack_sizes.css_cc)


def util_compute_stack_sizes_dc_split(
    stack_sizes: StackSizes,
    dss_dc_from_traversal: int,
    dss_dc_from_state: int,
    max_trace_depth: int,
    max_cc_depth: int,
    max_dc_depth_from_traversal: int,
    max_dc_depth_from_state: int,
) -> tuple[int, int, int]:
    """The same with direct callables told apart by their caller: intersection and any-hit programs, or the others."""
    _check(
        stack_sizes,
        dss_dc_from_traversal=dss_dc_from_traversal,
        dss_dc_from_state=dss_dc_from_state,
        max_trace_depth=max_trace_depth,
        max_cc_depth=max_cc_depth,
        max_dc_depth_from_traversal=max_dc_depth_from_traversal,
        max_dc_depth_from_state=max_dc_depth_from_state,
    )
    continuation = _continuation(stack_sizes, max_trace_depth, max_cc_depth * stack_sizes.css_cc)
    return max_dc_depth_from_traversal * dss_dc_from_traversal, max_dc_depth_from_state * dss_dc_from_state, continuation


def util_compute_stack_sizes_css_cc_tree(
    stack_sizes: StackSizes, css_cc_tree: int, max_trace_depth: int, max_dc_depth: int
) -> tuple[int, int, int]:
    """The same with the bytes of the whole tree of continuation callables given."""
    _check(stack_sizes, css_cc_tree=css_cc_tree, max_trace_depth=max_trace_depth, max_dc_depth=max_dc_depth)
    direct = max_dc_depth * stack_sizes.dss_dc
    return direct, direct, _continuation(stack_sizes, max_trace_depth, css_cc_tree)


def util_compute_stack_sizes_simple_path_tracer(
    raygen: Group, miss_1: Group, closesthit_1: Sequence[Group], miss_2: Group, closesthit_2: Sequence[Group], pipeline: Any = None
) -> tuple[int, int, int]:
    """For a path tracer of two ray types whose closest-hit programs of the first trace the second, without callables."""
    for name, groups in (("closesthit_1", closesthit_1), ("closesthit_2", closesthit_2)):
        if groups is None or not all(hasattr(group, "get_stack_size") for group in groups):
            raise InvalidValueError(f"{name} takes a list of program groups")
    start = raygen.get_stack_size(pipeline).css_rg
    first_miss, second_miss = (group.get_stack_size(pipeline).css_ms for group in (miss_1, miss_2))
    first_hit, second_hit = (
        max((group.get_stack_size(pipeline).css_ch for group in groups), default=0) for groups in (closesthit_1, closesthit_2)
    )
    return 0, 0, start + max(first_miss, first_hit + max(second_miss, second_hit))


def nesting_that_fits(stack_sizes: StackSizes, continuation: int) -> int:
    """How many traces may nest on a continuation stack of this size."""
    tree = DEFAULT_CALLABLE_DEPTH * stack_sizes.css_cc
    return max((depth for depth in range(MAX_TRACE_DEPTH + 1) if _continuation(stack_sizes, depth, tree) <= continuation), default=0)


def stack_for(frames: int, levels: int) -> int:
    """Bytes of a thread's stack on which `levels` traces may nest, if all functions together take `frames`; an upper bound."""
    return int(library.lib().OXRT_STACK_RESERVE) + (levels + 2) * frames


def _continuation(sizes: StackSizes, trace_depth: int, callable_tree: int) -> int:
    shading = max(sizes.css_ch, sizes.css_ms) + callable_tree
    traversal = min(trace_depth, 1) * max(shading, sizes.css_is + sizes.css_ah)
    return sizes.css_rg + callable_tree + (max(1, trace_depth) - 1) * shading + traversal


def _check(stack_sizes: StackSizes, **numbers: int) -> None:
    if not isinstance(stack_sizes, StackSizes):
        raise InvalidValueError(f"stack_sizes takes a StackSizes, not {type(stack_sizes).__name__}; begin with ox.StackSizes()")
    for name, value in numbers.items():
        if not isinstance(value, int) or isinstance(value, bool) or value < 0:
            raise InvalidValueError(f"{name} must be a whole number of at least 0, not {value!r}")
