"""What launches that run still read: values that another thread takes out of structs and records stay until the launch ends."""

from __future__ import annotations

from typing import Any

_running: dict[int, list[Any]] = {}


def begin() -> list[Any]:
    """A launch is about to read its inputs; the result goes to `end`."""
    kept: list[Any] = []
    _running[id(kept)] = kept
    return kept


def end(kept: list[Any]) -> None:
    """The launch that got `kept` has ended."""
    del _running[id(kept)]


def keep(value: object) -> None:
    """The value was replaced; launches that run may still read its memory."""
    if _running:
        for kept in tuple(_running.values()):
            kept.append(value)
