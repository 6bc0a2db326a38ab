"""From `Checked` to IR: types are known, so this only rewrites; after it no error of the author is possible.

Expressions become pure: a call that can write is hoisted into a statement before its use, and what stood to its left is kept in a
temporary where the call could change it, so that Python's left-to-right order holds. `and`, `or` and conditional expressions with such
calls become `if`.
"""

from __future__ import annotations

import ast

from optixc.frontend.checked import Checked, FunctionInstance, SbtDataUse
from optixc.frontend.lower_block import Block, FunctionLowering
from optixc.frontend.lower_expr import lower_expression
from optixc.frontend.lower_stmt import lower_body
from optixc.ir import types as t
from optixc.ir.nodes import Function, Local, Module, Parameter, ParameterRole
from optixc.ir.programs import CALLABLES


def lower(checked: Checked) -> Module:
    """The module of a checked compilation."""
    made: dict[str, t.Struct] = {}
    needs = RecordNeeds()
    helpers = tuple(_lower_function(instance, made, needs) for instance in checked.helpers)
    programs = tuple(_lower_function(instance, made, needs) for instance in checked.programs)
    used = _Structs()
    for struct in (*checked.structs, *((checked.params,) if checked.params else ()), *made.values()):
        used.add(struct)
    for function in (*helpers, *programs):
        for local in (*(parameter.local for parameter in function.parameters), *function.locals):
            used.add(local.type)
        used.add(function.result)
    return Module(checked.name, checked.path, tuple(used.structs), checked.params, helpers, programs)


class _Structs:
    """All struct types that a module mentions, each after those that it contains."""

    def __init__(self) -> None:
        self.structs: dict[t.Struct, None] = {}

    def add(self, type_: t.Type) -> None:
        match type_:
            case t.Struct(fields=fields):
                if type_ not in self.structs:
                    for field in fields:
                        self.add(field.type)
                    self.structs[type_] = None
            case t.FixedArray(element=element) | t.Array(element=element):
                self.add(element)
            case t.Tuple(items=items):
                for item in items:
                    self.add(item)


def _lower_function(instance: FunctionInstance, made: dict[str, t.Struct], needs: RecordNeeds) -> Function:
    symbol = instance.symbol
    assert symbol is not None
    lowering = FunctionLowering(instance, made, lower_expression, needs.of)
    hidden = _hidden_records(lowering, needs)
    block = Block()
    lower_body(lowering, symbol.node.body, block)
    parameters = [Parameter(p.local, p.role, p.written) for p in instance.parameters]
    role = ParameterRole.VALUE if instance.kind is None else ParameterRole.RECORD
    parameters += [Parameter(local, role, hidden=True) for local in hidden]
    return Function(
        name=instance.name,
        source_name=symbol.name,
        kind=instance.kind,
        parameters=tuple(parameters),
        result=instance.result,
        locals=tuple(dict.fromkeys((*instance.all_locals(), *lowering.temporaries))),
        body=tuple(block.statements),
        span=instance.source.header_span(symbol.node),
        doc=ast.get_docstring(symbol.node) or "",
    )


def _hidden_records(lowering: FunctionLowering, needs: RecordNeeds) -> list[Local]:
    """Parameters for the record data that get_sbt_data() asks for; a program's own record parameter serves where types agree."""
    instance = lowering.instance
    hidden = []
    for struct in needs.of(instance):
        # A callable's struct parameter may turn out to be an argument when the pipeline is linked.
        candidates = [] if instance.kind in CALLABLES else instance.parameters
        own = next((p.local for p in candidates if p.role is ParameterRole.RECORD and p.local.type == struct), None)
        if own is None:
            own = Local(lowering.unique_name("record"), struct, by_reference=True)
            hidden.append(own)
        lowering.records[struct] = own
    return hidden


class RecordNeeds:
    """Which record structs a function reads through get_sbt_data(), itself or through helpers, in order of first use."""

    def __init__(self) -> None:
        self._known: dict[FunctionInstance, tuple[t.Struct, ...]] = {}

    def of(self, instance: FunctionInstance) -> tuple[t.Struct, ...]:
        """The structs; a helper that recurses has none, because such helpers use no device functions."""
        known = self._known.get(instance)
        if known is None:
            self._known[instance] = ()
            found: dict[t.Struct, None] = {}
            for info in instance.info.values():
                if isinstance(info.use, SbtDataUse) and info.use.row is None:
                    found[info.use.struct] = None
            for call in instance.calls:
                found.update(dict.fromkeys(self.of(call.instance)))
            known = self._known[instance] = tuple(found)
        return known
