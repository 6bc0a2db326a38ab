"""The C++ functions over lanes: one for each clone of a helper that some reachable function calls, and one for each program.

Helpers of which all arguments and the result are uniform, and that act on nothing, run once as scalar functions.
"""

from __future__ import annotations

from optixc.codegen.cpp_signatures import FunctionNames, Signatures, head_prefix, used_parameters
from optixc.codegen.cpp_spmd_types import WideTypes
from optixc.codegen.names import Scope
from optixc.codegen.needs import options_of
from optixc.ir.control import polls
from optixc.ir.intrinsic_rows import INTRINSICS
from optixc.ir.intrinsics import Effect, State
from optixc.ir.nodes import (
    Assign,
    CallCallable,
    CallHelper,
    CallIntrinsic,
    ElementRef,
    Expr,
    Function,
    HelperCall,
    IntrinsicCall,
    Parameter,
    ParameterRole,
    Pipeline,
    Print,
    Stmt,
    Trace,
    While,
    is_reference_type,
)
from optixc.ir.types import Scalar
from optixc.ir.walk import called_helpers, expressions, statements
from optixc.passes.uniformity import Clone, Key, UniformityAnalysis
from optixc.passes.uses import stored_local


class Clones:
    """Clones by need: asking for one with `helper` makes it part of the file."""

    def __init__(self, pipeline: Pipeline, types: WideTypes, signatures: Signatures, scope: Scope) -> None:
        self.analysis = UniformityAnalysis({helper.name: helper for helper in pipeline.helpers}, options_of(pipeline).traces_throw)
        self._helpers = {helper.name: helper for helper in pipeline.helpers}
        self._types = types
        self._signatures = signatures
        self._scope = scope
        self._names: dict[Key, str] = {}
        self._acting: dict[str, bool] = {}
        self.scalar: dict[str, Function] = {}
        """Helpers that are needed as scalar functions."""

    def helper(self, name: str, arguments: tuple[bool, ...], caller: Clone) -> Clone:
        """The clone that a caller reaches with arguments that vary or not."""
        return self.analysis.helper(name, arguments, caller.in_intersection)

    def callees(self, clone: Clone) -> list[Clone]:
        """The clones that a clone calls over lanes, in order; those that run once are noted in `scalar`."""
        found: dict[Key, Clone] = {}
        for function, arguments in self._calls(clone):
            callee = self.helper(function, arguments, clone)
            if self.runs_once(callee):
                self._need_scalar(callee.function)
            else:
                found[callee.key] = callee
        return list(found.values())

    def _calls(self, clone: Clone) -> list[tuple[str, tuple[bool, ...]]]:
        from_statements = [(s.function, s.arguments) for s in statements(clone.function.body) if isinstance(s, CallHelper)]
        from_expressions = [(e.function, e.arguments) for e in expressions(clone.function.body) if isinstance(e, HelperCall)]
        return [(name, tuple(self._varies(a, clone) for a in arguments)) for name, arguments in (*from_statements, *from_expressions)]

    def _varies(self, expression: Expr, clone: Clone) -> bool:
        return self.analysis.varies(expression, clone)

    def _need_scalar(self, function: Function) -> None:
        if function.name in self.scalar:
            return
        self.scalar[function.name] = function
        for callee in called_helpers(function.body):
            self._need_scalar(self._helpers[callee])

    # ---- functions that run once ---------------------------------------------------------------------------------------------

    def runs_once(self, clone: Clone) -> bool:
        """Whether one scalar call serves all lanes."""
        is_uniform = not any(clone.parameters_after()) and not clone.result_varies
        return is_uniform and clone.function.kind is None and not self._acts(clone.function)

    def _acts(self, function: Function) -> bool:
        """Whether the function or one that it calls does what every lane must do on its own, or asks what lanes answer differently."""
        if function.name not in self._acting:
            self._acting[function.name] = False
            self._acting[function.name] = (
                any(_statement_acts(statement) for statement in statements(function.body))
                or any(_expression_acts(expression) for expression in expressions(function.body))
                or any(self._acts(self._helpers[name]) for name in called_helpers(function.body))
            )
        return self._acting[function.name]

    def scalar_name(self, clone: Clone) -> str:
        return self._signatures.function(clone.function.name)

    def scalar_arguments(self, clone: Clone, thread: str) -> list[str]:
        return [thread] if self._signatures.needs(clone.function.name).thread else []

    # ---- functions over lanes ------------------------------------------------------------------------------------------------

    def name(self, clone: Clone) -> str:
        """The C++ name of the function over lanes."""
        if clone.key not in self._names:
            self._names[clone.key] = self._scope.name(f"{self._signatures.function(clone.function.name)}_lanes")
        return self._names[clone.key]

    def hidden_arguments(self, clone: Clone, names: FunctionNames, mask: str) -> list[str]:
        """Ray or thread, and the mask."""
        needs = self._signatures.needs(clone.function.name)
        hidden = [names.trace, mask] if needs.ray else [names.thread, mask]
        return [*hidden, names.hit_object] if needs.hit_object else hidden

    def head(self, clone: Clone, names: FunctionNames) -> str:
        """Result, name and parameters."""
        function = clone.function
        used = used_parameters(function)
        assigned = {local.name for statement in statements(function.body) if (local := stored_local(statement)) is not None}
        needs = self._signatures.needs(function.name)
        hidden = f"Rays& {names.trace}" if needs.ray else f"Lanes& {names.thread}"
        parameters = [f"[[maybe_unused]] {hidden}", "[[maybe_unused]] Mask mask"]
        if needs.hit_object and function.kind is None:
            parameters.append(f"oxrt::HitObjectLanes<LANES>& {names.hit_object}")
        for parameter in function.parameters:
            text = self._parameter(parameter, parameter.local.name in clone.varying, parameter.local.name in assigned)
            parameters.append(f"{text} {names.locals[parameter.local.name]}" if parameter.local.name in used else text)
        result = self._types.name(function.result, clone.result_varies)
        prefix = head_prefix(function, needs) + ("OXRT_INLINE " if self._signatures.inlines((function,)) else "")
        return f"{prefix}{result} {self.name(clone)}({', '.join(parameters)})"

    def callee_name(self, clone: Clone) -> str:
        """The function as a call names it, inside of a function that has its programs as a template argument."""
        return f"{self.name(clone)}<Programs>" if self._signatures.needs(clone.function.name).programs else self.name(clone)

    def _parameter(self, parameter: Parameter, is_varying: bool, is_assigned: bool) -> str:
        text = self._types.name(parameter.local.type, is_varying)
        if parameter.role is ParameterRole.PAYLOAD:
            return f"{text}&"
        if parameter.role is ParameterRole.VALUE and (parameter.local.by_reference or is_reference_type(parameter.local.type)):
            return f"{text}&" if parameter.written else f"const {text}&"
        is_small = isinstance(parameter.local.type, Scalar)
        return text if is_small or is_assigned else f"const {text}&"


def _statement_acts(statement: Stmt) -> bool:
    match statement:
        case Trace() | CallCallable() | Print():
            return True
        case CallIntrinsic(name=name):
            return INTRINSICS[name].effect not in (Effect.PURE, Effect.READS) or INTRINSICS[name].state is not State.NONE
        case While():
            return polls(statement)
        case Assign(target=target):
            node: object = target
            while node is not None and not isinstance(node, ElementRef):
                node = getattr(node, "base", None)
            return isinstance(node, ElementRef)
        case _:
            return False


def _expression_acts(expression: Expr) -> bool:
    if not isinstance(expression, IntrinsicCall):
        return False
    state = INTRINSICS[expression.name].state
    return state in (State.RAY, State.HIT_OBJECT) or (state is State.THREAD and expression.name != "get_launch_dimensions")
