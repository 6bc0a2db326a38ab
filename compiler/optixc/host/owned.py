"""Objects that stand for something of this process, such as a pipeline: a copy would free what the original still uses."""

from __future__ import annotations

from typing import Any, SupportsIndex


class Owned:
    """Cannot be copied or pickled; names may be bound to one object freely."""

    def __reduce_ex__(self, protocol: SupportsIndex) -> Any:
        raise TypeError(
            f"this {type(self).__name__} cannot be copied or pickled: it stands for something of this process; use the object itself, or "
            "make another one"
        )
