"""Which local each name means at a point of a function, and whether every way to that point binds it.

An environment is a layer of changes over the one at the last fork, so that forking and joining cost only what changed in between.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from optixc.ir.nodes import Local
from optixc.ir.types import Void
from optixc.source import Span


@dataclass(frozen=True)
class Bound:
    """The name means `local`; `span` is where it was bound last. A local of type void stands for a value that had an error."""

    local: Local
    span: Span


@dataclass(frozen=True)
class Partial:
    """The name is bound on some ways only; `reason` says which, `span` is one place that binds it."""

    reason: str
    span: Span


@dataclass(frozen=True)
class Conflict:
    """The name has different types on different ways."""

    reason: str
    span: Span


Binding = Bound | Partial | Conflict


@dataclass(eq=False)
class Environment:
    """A layer of bindings."""

    parent: Environment | None = None
    changes: dict[str, Binding] = field(default_factory=dict)

    def get(self, name: str) -> Binding | None:
        """What the name means now; None where nothing bound it."""
        layer: Environment | None = self
        while layer is not None:
            found = layer.changes.get(name)
            if found is not None:
                return found
            layer = layer.parent
        return None

    def bind(self, name: str, binding: Binding) -> None:
        """Bind a name from here on."""
        self.changes[name] = binding

    def fork(self) -> Environment:
        """A layer of its own for one way on."""
        return Environment(self)

    def changes_since(self, base: Environment) -> dict[str, Binding]:
        """What was bound since `base` was forked."""
        layers = []
        layer: Environment | None = self
        while layer is not None and layer is not base:
            layers.append(layer.changes)
            layer = layer.parent
        merged: dict[str, Binding] = {}
        for changes in reversed(layers):
            merged.update(changes)
        return merged


@dataclass(frozen=True)
class Way:
    """One way to a joining point: what it bound since the fork, and its name in messages ("the branch in line 7")."""

    changes: dict[str, Binding]
    description: str


def join(base: Environment, ways: Sequence[Way]) -> None:
    """Bind in `base` what holds after the ways meet; `base` is the environment at their fork."""
    names = dict.fromkeys(name for way in ways for name in way.changes)
    for name in names:
        before = base.get(name)
        base.bind(name, _joined(name, [(way, way.changes.get(name, before)) for way in ways]))


def _joined(name: str, bindings: list[tuple[Way, Binding | None]]) -> Binding:
    for _, binding in bindings:
        if isinstance(binding, Bound) and isinstance(binding.local.type, Void):
            return binding
    first: tuple[Way, Bound] | None = None
    missing: Way | None = None
    for way, binding in bindings:
        if isinstance(binding, Partial | Conflict):
            return binding
        if binding is None:
            missing = missing or way
        elif first is None:
            first = (way, binding)
        elif binding.local != first[1].local:
            reason = f"it is {first[1].local.type} {_when(first[0])} and {binding.local.type} {_when(way)}"
            return Conflict(reason, binding.span)
    assert first is not None
    if missing is None:
        return next(binding for _, binding in reversed(bindings) if isinstance(binding, Bound))
    return Partial(f"it is bound {_when(first[0])}, but not {_when(missing)}", first[1].span)


def _when(way: Way) -> str:
    return way.description
