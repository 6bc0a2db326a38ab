"""Places inside of fixed arrays, vectors and matrices by an index that differs between lanes: one item after the other, each with the
lanes that name it."""

from __future__ import annotations

from collections.abc import Collection

from optixc.codegen.cpp_expr import part_of
from optixc.codegen.cpp_spmd_expr import LaneExpressions
from optixc.ir.nodes import ComponentRef, ElementRef, Expr, FieldRef, IndexRef, Literal
from optixc.ir.types import FixedArray
from optixc.ir.walk import place_origin


class ItemLoops:
    """The loops around what is done with places; `mask` are the lanes for which it is done inside of them."""

    def __init__(self, expressions: LaneExpressions, taken: Collection[str], value: str, checked: str) -> None:
        """`value` is taken before the loops, "" for none; `checked` is a form of a mask that checks its lanes' indices, "" for none."""
        self.mask = expressions.lanes.mask
        self._checked = checked
        self._expressions = expressions
        self._taken = taken
        self._value = value
        self._heads: list[str] = []

    def place(self, place: Expr) -> str:
        """The text of a place; each index that varies opens one more loop."""
        match place:
            case FieldRef(base=base) | ComponentRef(base=base, components=(_,)):
                return part_of(place, self.place(base))
            case IndexRef(base=base, index=index):
                inner, position = self.place(base), self._expressions.text(index)
                if self._expressions.lanes.varies(index):
                    return self._item(inner, position, bool(self._checked))
                if self._checked and isinstance(base.type, FixedArray) and not isinstance(index, Literal):
                    return f"{self._checked.format(self.mask)}.itemPlace({inner}, {position})"
                return f"{inner}[{position}]"
            case _:
                return self._expressions.place(place)

    def around(self, statement: str) -> str:
        """The loops with a statement in them."""
        return " ".join([*self._heads, statement, *("});" for _ in self._heads)])

    def _item(self, base: str, index: str, is_checked: bool) -> str:
        item, own = self._name("item"), self._name("own")
        captures = f"&, value = {self._value}" if self._value and not self._heads else "&"
        mask = f"{self._checked.format(self.mask)}.insideItems({base}, {index})" if is_checked else self.mask
        self._heads.append(f"oxrt::eachItem({mask}, {base}, {index}, [{captures}](auto& {item}, Mask {own}) {{")
        self.mask = own
        return item

    def _name(self, stem: str) -> str:
        name = stem if not self._heads else f"{stem}_{len(self._heads) + 1}"
        while name in self._taken:
            name += "_"
        return name


def has_varying_index(expressions: LaneExpressions, place: Expr) -> bool:
    """Whether lanes name different items on the way to a place of a local."""
    node = place
    while isinstance(node, FieldRef | ComponentRef | IndexRef):
        if isinstance(node, IndexRef) and expressions.lanes.varies(node.index):
            return not isinstance(place_origin(node), ElementRef)
        node = node.base
    return False
