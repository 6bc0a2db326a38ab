"""The call that checks an assertion, with places in its message for the values that it shows."""

from __future__ import annotations

from optixc.codegen.names import string_literal
from optixc.ir.nodes import Assert
from optixc.passes.checks import author_text

VALUE = "\x01"
"""Where the runtime puts a value into a message."""


def assertion_call(statement: Assert, state: list[str], condition: str, values: list[str]) -> str:
    """`state` is what comes first: the thread, and the mask of lanes."""
    if not values:
        return f"oxrt::assertTrue({', '.join([*state, condition, string_literal(statement.message)])});"
    shown = ", ".join(f"{author_text(value)} = {VALUE}" for value in statement.values)
    message = string_literal(f"{statement.message} ({shown})")
    # The place comes early: a long call goes over several lines, and the first has the author's number.
    return f"oxrt::assertTrue({', '.join([state[0], 'oxrt::Place::current()', *state[1:], condition, message, *values])});"
