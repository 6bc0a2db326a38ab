"""Which values all lanes of a packet share, and where control flow diverges.

A function is analysed once for each combination of uniform and varying parameters that it is called with (a `Clone`). A value is
varying if it depends on the launch index, the ray or the hit, on memory at a varying place, or on which lanes ran an assignment; a
local whose uses all lie inside a divergent region may still be uniform there, since the lanes that run see one value. Result: sound
(what is called uniform is), by a fixed point that starts from "uniform".
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from optixc.ir.intrinsic_rows import INTRINSICS
from optixc.ir.intrinsics import Effect, State
from optixc.ir.nodes import (
    Assign,
    Break,
    CallCallable,
    CallHelper,
    CallIntrinsic,
    ComponentRef,
    Continue,
    Expr,
    FieldRef,
    ForRange,
    Function,
    HelperCall,
    If,
    IndexRef,
    IntrinsicCall,
    LocalRef,
    ParameterRole,
    Return,
    Stmt,
    Trace,
    While,
    is_reference_type,
)
from optixc.ir.programs import ProgramKind
from optixc.ir.walk import Body, blocks, operands, place_root, statements
from optixc.passes.regions import Region, homes, is_read_behind

_VARYING_OF_THREAD = frozenset({"get_launch_index", "get_exception_code", *(f"get_exception_detail_{i}" for i in range(8))})
_REPORT = "report_intersection"
COMMON_IN_INTERSECTION = frozenset(
    """get_primitive_index get_sbt_gas_index get_instance_id get_instance_index get_gas_traversable_handle get_cluster_id
    get_transform_list_size get_transform_list_handle""".split()
)
"""What all lanes share while an intersection program runs: it runs for one primitive at a time."""

_VARYING_STATES = frozenset({State.RAY, State.HIT_OBJECT})


Key = tuple[str, tuple[bool, ...], bool]


@dataclass
class Clone:
    """A function with known parameters.

    `in_intersection`: it is, or serves, an intersection program. `varying`: names of varying locals and parameters. `divergent`: ids
    of the if statements whose condition varies, and of the loops that lanes leave or continue at different times. `exits`: ids of the
    statements that a lane may leave by break, continue or return while others stay.
    """

    function: Function
    parameters: tuple[bool, ...]
    in_intersection: bool
    varying: set[str] = field(default_factory=set)
    divergent: set[int] = field(default_factory=set)
    exits: set[int] = field(default_factory=set)
    returns_apart: bool = False
    result_varies: bool = False

    @property
    def key(self) -> Key:
        return (self.function.name, self.parameters, self.in_intersection)

    def parameters_after(self) -> tuple[bool, ...]:
        """Which parameters vary once the function ran: those by reference may have become varying."""
        return tuple(parameter.local.name in self.varying for parameter in self.function.parameters)


class UniformityAnalysis:
    """Clones of the functions of one pipeline, made when asked for."""

    def __init__(self, helpers: Mapping[str, Function], may_throw: bool) -> None:
        self._helpers = helpers
        self._may_throw = may_throw
        self._leaving: dict[str, bool] = {}
        self._clones: dict[Key, Clone] = {}
        self._unfinished: set[Key] = set()

    def program(self, function: Function) -> Clone:
        """A program: what it gets of rays and hits varies, except for the record of a launch or of an intersection."""
        has_one_record = function.kind in (ProgramKind.RAYGEN, ProgramKind.EXCEPTION, ProgramKind.INTERSECTION)
        varying = tuple(not (has_one_record and p.role is ParameterRole.RECORD) for p in function.parameters)
        return self._clone(function, varying, function.kind is ProgramKind.INTERSECTION)

    def helper(self, name: str, arguments: tuple[bool, ...], in_intersection: bool) -> Clone:
        """The clone of a helper for arguments that vary or not, where parameters by reference that become varying are so from the
        beginning."""
        function = self._helpers[name]
        while True:
            clone = self._clone(function, arguments, in_intersection)
            after = tuple(
                before or (late and is_reference_type(parameter.local.type))
                for before, late, parameter in zip(arguments, clone.parameters_after(), function.parameters, strict=True)
            )
            if after == arguments:
                return clone
            arguments = after

    def leaves(self, statement: Stmt) -> bool:
        """Whether lanes may leave the program in a call: by ending it, or by an exception."""
        match statement:
            case Trace() | CallCallable():
                return self._may_throw
            case CallIntrinsic(name=name):
                if INTRINSICS[name].effect is Effect.ENDS_LAUNCH_INDEX:
                    return self._may_throw
                return INTRINSICS[name].effect is Effect.ENDS_PROGRAM or name == _REPORT
            case CallHelper(function=function):
                return self._helper_leaves(function)
            case _:
                return False

    def _helper_leaves(self, name: str) -> bool:
        if name not in self._leaving:
            self._leaving[name] = False
            self._leaving[name] = any(self.leaves(statement) for statement in statements(self._helpers[name].body))
        return self._leaving[name]

    def varies(self, expression: Expr, clone: Clone) -> bool:
        """Whether lanes may have different values of an expression of the clone's function."""
        return varies(expression, clone, self)

    def _clone(self, function: Function, parameters: tuple[bool, ...], in_intersection: bool) -> Clone:
        key = (function.name, parameters, in_intersection)
        if key in self._unfinished:
            # what reaches itself again while it is analysed is taken as varying altogether
            found = self._clones[key]
            found.result_varies = True
            found.varying |= {p.local.name for p in function.parameters if is_reference_type(p.local.type)}
            return found
        if key in self._clones:
            return self._clones[key]
        clone = Clone(function, parameters, in_intersection)
        clone.varying = {p.local.name for p, varies in zip(function.parameters, parameters, strict=True) if varies}
        self._clones[key] = clone
        self._unfinished.add(key)
        analysis = _FunctionAnalysis(clone, self)
        while analysis.run():
            pass
        self._unfinished.remove(key)
        return clone


class _FunctionAnalysis:
    """One pass after the other over one function, until nothing new becomes varying."""

    def __init__(self, clone: Clone, analysis: UniformityAnalysis) -> None:
        self._clone = clone
        self._analysis = analysis
        self._homes = homes(clone.function)
        self._kept: dict[int, bool] = {}
        self._changed = False

    def run(self) -> bool:
        """Whether this pass found anything new."""
        self._changed = False
        self._body(self._clone.function.body, ())
        return self._changed

    # ---- statements ----------------------------------------------------------------------------------------------------------

    def _body(self, body: Body, path: Region) -> None:
        for statement in body:
            self._statement(statement, path)

    def _statement(self, statement: Stmt, path: Region) -> None:
        match statement:
            case Assign(target=target, value=value):
                self._store(target, self.varies(value) or self._names_items(target), path)
            case If(condition=condition):
                if self.varies(condition):
                    self._diverges(statement)
            case While(condition=condition):
                if self.varies(condition):
                    self._diverges(statement)
            case ForRange(start=start, stop=stop, step=step):
                bounds_vary = any(self.varies(bound) for bound in (start, stop, step))
                if bounds_vary:
                    self._diverges(statement)
                # Lanes that leave at different turns have different last values, which matters only to those who look.
                self._assigned(statement.target.name, bounds_vary, (*path, statement) if self._is_kept(statement, path) else path)
            case Break() | Continue():
                self._leaves_loop(path)
            case Return(value=value):
                self._returns(value, path)
            case CallHelper():
                self._call(statement, path)
            case CallIntrinsic(name=name, target=target) if INTRINSICS[name].effect is Effect.READS:
                if target is not None:
                    self._assigned(target.name, any(self.varies(one) for one in statement.arguments), path)
            case CallIntrinsic(target=target) | CallCallable(target=target):
                if target is not None:
                    self._assigned(target.name, True, path)
                if isinstance(statement, CallCallable):
                    for argument in statement.arguments:
                        if is_reference_type(argument.type):
                            self._store(argument, True, path)
            case Trace(payload=payload):
                if payload is not None:
                    self._store(payload, True, path)
            case _:
                pass
        if self._analysis.leaves(statement):
            self._clone.exits.add(id(statement))
            self._return_apart(path)
        for block in blocks(statement):
            self._body(block, (*path, statement))

    def _is_kept(self, loop: ForRange, path: Region) -> bool:
        """Whether anybody reads the loop's variable behind the loop."""
        if id(loop) not in self._kept:
            self._kept[id(loop)] = is_read_behind(self._clone.function.body, path, loop, loop.target.name)
        return self._kept[id(loop)]

    def _store(self, place: Expr, varies: bool, path: Region) -> None:
        root = place_root(place)
        if root is not None:
            self._assigned(root.name, varies, path)

    def _names_items(self, place: Expr) -> bool:
        """Whether lanes name different items of a local on the way to a place."""
        while isinstance(place, FieldRef | ComponentRef | IndexRef):
            if isinstance(place, IndexRef) and self.varies(place.index):
                return True
            place = place.base
        return False

    def _assigned(self, name: str, varies: bool, path: Region) -> None:
        home = self._homes.get(name, ())
        apart = any(id(owner) in self._clone.divergent for owner in path[len(home) :])
        if (varies or apart) and name not in self._clone.varying:
            self._clone.varying.add(name)
            self._changed = True

    def _diverges(self, statement: Stmt) -> None:
        if id(statement) not in self._clone.divergent:
            self._clone.divergent.add(id(statement))
            self._changed = True

    def _leaves_loop(self, path: Region) -> None:
        """A break or continue that not all lanes take makes the loop divergent."""
        position = max(i for i, owner in enumerate(path) if isinstance(owner, While | ForRange))
        if any(id(owner) in self._clone.divergent for owner in path[position + 1 :]):
            self._diverges(path[position])
            self._mark_exits(path[position:])

    def _returns(self, value: Expr | None, path: Region) -> None:
        apart = any(id(owner) in self._clone.divergent for owner in path)
        if apart:
            self._return_apart(path)
        if (apart or (value is not None and self.varies(value))) and not self._clone.result_varies:
            self._clone.result_varies = True
            self._changed = True

    def _return_apart(self, path: Region) -> None:
        """Some lanes leave the function here and others stay."""
        for owner in path:
            if isinstance(owner, While | ForRange):
                self._diverges(owner)
        self._mark_exits(path)
        if not (self._clone.returns_apart and self._clone.result_varies):
            self._clone.returns_apart = self._clone.result_varies = True
            self._changed = True

    def _mark_exits(self, owners: Region) -> None:
        self._clone.exits.update(id(owner) for owner in owners)

    def _call(self, statement: CallHelper, path: Region) -> None:
        varying = tuple(self.varies(argument) for argument in statement.arguments)
        callee = self._analysis.helper(statement.function, varying, self._clone.in_intersection)
        # Lanes that name different items make the call item after item: whatever it changes has lanes of its own.
        written = [
            is_reference_type(argument.type) and parameter.written
            for parameter, argument in zip(callee.function.parameters, statement.arguments, strict=True)
        ]
        apart = any(self._names_items(argument) for argument, changes in zip(statement.arguments, written, strict=True) if changes)
        for argument, changes, varies in zip(statement.arguments, written, callee.parameters, strict=True):
            if changes:
                self._store(argument, varies or apart, path)
        if statement.target is not None:
            self._assigned(statement.target.name, callee.result_varies or apart, path)

    # ---- expressions ---------------------------------------------------------------------------------------------------------

    def varies(self, expression: Expr) -> bool:
        return varies(expression, self._clone, self._analysis)


def varies(expression: Expr, clone: Clone, analysis: UniformityAnalysis) -> bool:
    """Whether lanes may have different values of an expression of the clone's function."""
    match expression:
        case LocalRef(local=local):
            return local.name in clone.varying
        case IntrinsicCall(name=name):
            is_common = clone.in_intersection and name in COMMON_IN_INTERSECTION
            if not is_common and (INTRINSICS[name].state in _VARYING_STATES or name in _VARYING_OF_THREAD):
                return True
        case HelperCall(function=function, arguments=arguments):
            varying = tuple(varies(argument, clone, analysis) for argument in arguments)
            return analysis.helper(function, varying, clone.in_intersection).result_varies
        case _:
            pass
    return any(varies(operand, clone, analysis) for operand in operands(expression))
