"""Arguments that are passed by reference: as places where they are places, as values where they are new."""

from __future__ import annotations

import ast

from optixc.frontend.checked import ConstantUse, ElementUse, FieldUse, IndexUse, LocalUse, ParamsUse
from optixc.frontend.lower_block import Block, FunctionLowering, is_stable
from optixc.ir.nodes import ElementRef, Expr, FieldRef, IndexRef, LocalRef, ParamsRef


def lower_place_of(low: FunctionLowering, node: ast.expr, block: Block) -> Expr:
    """A struct or fixed array by reference; indices on the way are evaluated now."""
    use = low.info(node).use
    match node, use:
        case _, LocalUse(local=local):
            return LocalRef(local)
        case _, ParamsUse(struct=struct):
            return ParamsRef(struct)
        case _, ConstantUse():
            return low.expression(low, node, block)
        case ast.Attribute(value=base), FieldUse(name=name, stored=stored):
            return FieldRef(lower_place_of(low, base, block), name, stored)
        case ast.Subscript(value=base), IndexUse(index=index, stored=stored):
            inner = lower_place_of(low, base, block)
            return IndexRef(inner, _now(low, index, block), stored)
        case ast.Subscript(value=base), ElementUse(indices=indices, stored=stored):
            array = low.expression(low, base, block)
            return ElementRef(array, tuple(_now(low, index, block) for index in indices), stored, low.span(node))
    return low.expression(low, node, block)


def _now(low: FunctionLowering, node: ast.expr, block: Block) -> Expr:
    value = low.expression(low, node, block)
    return value if is_stable(value) else low.keep(value, block, low.span(node), "index")
