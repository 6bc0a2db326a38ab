"""Checking a whole file: its programs, the helpers that they reach, and what each kind of program may do.

`check` takes the scope and gives `Checked`. All errors of all functions go to the diagnostics; after a compilation without any,
lowering cannot fail.
"""

from __future__ import annotations

import ast
from collections.abc import Sequence

from optixc.diagnostics import ChainLink
from optixc.frontend.annotations import resolve_value_type
from optixc.frontend.check_expr import check_expression
from optixc.frontend.check_payload_flow import check_payload_flow
from optixc.frontend.check_program import check_parameter_names, check_requirements, program_parameters
from optixc.frontend.check_returns import check_returns
from optixc.frontend.check_stmt import check_block
from optixc.frontend.checked import ConstantUse, ExprInfo, FunctionInstance, InstanceParameter
from optixc.frontend.context import Context, Hooks, describe, remedy
from optixc.frontend.conversions import can_convert
from optixc.frontend.declarations import Declarations
from optixc.frontend.environment import Bound
from optixc.frontend.source_file import Diagnostics
from optixc.frontend.symbols import ConstantSymbol, FunctionSymbol
from optixc.frontend.weak import INVALID
from optixc.ir import types as t
from optixc.ir.nodes import Local, is_reference_type

_HOST_CODE = frozenset({"OX206", "OX301", "OX304", "OX310", "OX319", "OX402", "OX403", "OX405", "OX406"})
"""Errors in a module-level expression that tell that it is not meant for shaders: they are told where a program uses the name."""


MAX_CALL_DEPTH = 100


class Checker:
    """Checks programs and instantiates helpers on demand."""

    def __init__(self, diagnostics: Diagnostics, params: t.Struct | None = None) -> None:
        self.diagnostics = diagnostics
        self.helpers: list[FunctionInstance] = []
        self._hooks = Hooks(check_expression, self._helper, self._constant, self.host_constant, self._use_params, self._expression_of)
        self._instances: dict[tuple[FunctionSymbol, tuple[t.Type, ...]], FunctionInstance] = {}
        self._constants: dict[ast.expr, FunctionInstance] = {}
        self._host_constants: dict[ast.expr, str] = {}
        self._in_progress: set[ast.expr] = set()
        self._names: set[str] = set()
        self._depth = 0
        self.params = params
        self._failed: set[FunctionInstance] = set()

    def check_program(self, symbol: FunctionSymbol) -> FunctionInstance:
        """Check one program with everything that it calls."""
        instance = FunctionInstance(symbol, symbol.name, symbol.scope.file.source, symbol.kind)
        self._names.add(symbol.name)
        context = Context(symbol.scope, instance, self.diagnostics, self._hooks)
        instance.parameters = program_parameters(context, symbol)
        declared = self._declared_result(context, symbol)
        self._check_body(context, symbol, declared)
        check_requirements(self.diagnostics, instance)
        return instance

    def check_unused_helper(self, symbol: FunctionSymbol) -> None:
        """Check a helper that no program reached, if its parameters say their types, so that its errors are told."""
        arguments = symbol.node.args
        annotations = [argument.annotation for argument in (*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs)]
        if any(key[0] is symbol for key in self._instances) or any(annotation is None for annotation in annotations):
            return
        kept = len(self.helpers)
        instance = FunctionInstance(symbol, symbol.name, symbol.scope.file.source, None)
        context = Context(symbol.scope, instance, self.diagnostics, self._hooks)
        types = self._parameter_types(context, symbol, [None] * len(annotations))
        if types is not None:
            self._instantiate(context, symbol, types, (), instance)
            self._instances[(symbol, tuple(types))] = instance
        del self.helpers[kept:]

    def instance_of(self, symbol: FunctionSymbol, types: Sequence[t.Type | None]) -> FunctionInstance | None:
        """The instance of a helper that Python itself calls; None after a diagnostic."""
        instance = FunctionInstance(symbol, symbol.name, symbol.scope.file.source, None)
        context = Context(symbol.scope, instance, self.diagnostics, self._hooks)
        resolved = self._parameter_types(context, symbol, types)
        if resolved is None:
            return None
        self._instances[(symbol, tuple(resolved))] = instance
        self._instantiate(context, symbol, resolved, (), instance)
        return instance

    def _helper(self, c: Context, symbol: FunctionSymbol, types: list[t.Type | None], node: ast.expr) -> FunctionInstance | None:
        """The instance for argument types; checked at the first call of that kind."""
        scratch = FunctionInstance(symbol, symbol.name, symbol.scope.file.source, None)
        helper_context = Context(symbol.scope, scratch, self.diagnostics, self._hooks)
        resolved = self._parameter_types(helper_context, symbol, types)
        if resolved is None:
            return None
        key = (symbol, tuple(resolved))
        instance = self._instances.get(key)
        if instance is not None:
            if not instance.is_complete:
                return self._recursive(c, symbol, instance, node)
            return instance if instance not in self._failed else None
        if self._depth >= MAX_CALL_DEPTH:
            c.error("OX103", node, f"helpers call each other more than {MAX_CALL_DEPTH} deep", "write a loop")
            return None
        generic = any(argument.annotation is None for argument in (*symbol.node.args.args, *symbol.node.args.kwonlyargs))
        caller = c.instance.symbol
        where = f"called from `{caller.name}`" if caller is not None else "called"
        chain = (ChainLink(c.span(node), where), *c.chain) if generic else ()
        self._instances[key] = scratch
        found = len(self.diagnostics.found)
        scratch.name = self._unique_name(symbol.name)
        self._depth += 1
        self._instantiate(helper_context, symbol, resolved, chain, scratch)
        self._depth -= 1
        if len(self.diagnostics.found) > found:
            self._failed.add(scratch)
            return None
        return scratch

    def _instantiate(
        self, c: Context, symbol: FunctionSymbol, types: list[t.Type], chain: tuple[ChainLink, ...], instance: FunctionInstance
    ) -> None:
        c.chain = chain
        arguments = symbol.node.args
        names = [argument.arg for argument in (*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs)]
        for name, type_ in zip(names, types, strict=True):
            instance.parameters.append(InstanceParameter(Local(name, type_, by_reference=is_reference_type(type_))))
        self._check_body(c, symbol, self._declared_result(c, symbol))
        self.helpers.append(instance)

    def _recursive(self, c: Context, symbol: FunctionSymbol, instance: FunctionInstance, node: ast.expr) -> FunctionInstance | None:
        if symbol.node.returns is None:
            message = f"`{symbol.name}` calls itself, so its result needs a type"
            c.error("OX309", node, message, f"write `def {symbol.name}(...) -> float:` or the like, `-> None` without result")
            return None
        # What it writes is not known yet: assume everything.
        instance.is_recursive = True
        instance.writes = True
        for parameter in instance.parameters:
            parameter.written = parameter.written or parameter.local.by_reference
        return instance

    def _parameter_types(self, c: Context, symbol: FunctionSymbol, types: Sequence[t.Type | None]) -> list[t.Type] | None:
        """Annotated parameters have their annotation, the others the argument's type; None after a diagnostic."""
        arguments = symbol.node.args
        if not check_parameter_names(c, symbol):
            return None
        for star, text in ((arguments.vararg, "*"), (arguments.kwarg, "**")):
            if star is not None:
                c.error("OX404", star, f"`{text}{star.arg}` is not part of restricted Python", "name the parameters one by one")
                return None
        resolved: list[t.Type] = []
        for argument, given in zip((*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs), types, strict=True):
            type_ = given
            if argument.annotation is not None:
                type_ = resolve_value_type(symbol.scope, argument.annotation, self.diagnostics, "a parameter")
                if isinstance(type_, t.Void):
                    c.error("OX201", argument.annotation, "a parameter cannot be None", "")
                    type_ = None
            if type_ is None:
                return None
            resolved.append(type_)
        return resolved

    def _declared_result(self, c: Context, symbol: FunctionSymbol) -> t.Type | None:
        if symbol.node.returns is None:
            return None
        return resolve_value_type(symbol.scope, symbol.node.returns, self.diagnostics, "a result")

    def _check_body(self, c: Context, symbol: FunctionSymbol, declared: t.Type | None) -> None:
        span = symbol.span
        for parameter in c.instance.parameters:
            c.environment.bind(parameter.local.name, Bound(parameter.local, span))
        if declared is not None:
            c.instance.result = declared
        falls_through = check_block(c, symbol.node.body)
        check_returns(c, symbol, declared, falls_through)
        check_payload_flow(c, symbol.node.body)
        c.instance.is_complete = True

    def _constant(self, c: Context, symbol: ConstantSymbol) -> ConstantUse | None:
        """A module constant, checked once in a body of its own; None where it is host code."""
        body = self._constants.get(symbol.node)
        if symbol.node in self._in_progress:
            self._host_constants[symbol.node] = "it is defined in terms of itself"
        elif body is None:
            self._in_progress.add(symbol.node)
            found, self.diagnostics.found = self.diagnostics.found, []
            body = self._expression_of(symbol.scope, symbol.node)
            problems, self.diagnostics.found = self.diagnostics.found, found
            host_code = next((problem for problem in problems if problem.code in _HOST_CODE), None)
            if host_code is not None:
                self._host_constants[symbol.node] = host_code.message
            else:
                found += problems
                self._annotate_constant(symbol, body)
            self._in_progress.discard(symbol.node)
        if symbol.node in self._host_constants:
            return None
        assert body is not None
        return ConstantUse(symbol, body)

    def _annotate_constant(self, symbol: ConstantSymbol, body: FunctionInstance) -> None:
        """Convert a constant to the type that its definition states."""
        info = body.info[symbol.node]
        if symbol.annotation is None or info.type == INVALID:
            return
        type_ = resolve_value_type(symbol.scope, symbol.annotation, self.diagnostics, "a constant")
        context = Context(symbol.scope, body, self.diagnostics, self._hooks)
        if type_ is not None and not can_convert(info.type, type_):
            message = f"the constant must be {type_}, this is {describe(info.type)}"
            context.error("OX302", symbol.node, message, remedy(info.type, type_))
        elif type_ is not None:
            context.coerce(symbol.node, type_, "the constant")

    def host_constant(self, symbol: ConstantSymbol) -> str:
        """Why a module-level name is no constant of shaders."""
        return self._host_constants[symbol.node]

    def _use_params(self, c: Context, struct: t.Struct, node: ast.expr) -> None:
        """One compilation has one struct of launch parameters, also where helper files bring their own."""
        if self.params is None:
            self.params = struct
        elif self.params != struct:
            message = f"the launch parameters are {self.params} elsewhere and {struct} here"
            c.error("OX205", node, message, "all files of a module share one struct")

    def _expression_of(self, scope: Declarations, node: ast.expr) -> FunctionInstance:
        """An expression at module level: a constant or a default."""
        body = self._constants.get(node)
        if body is None:
            body = FunctionInstance(None, "", scope.file.source, None)
            self._constants[node] = body
            body.info[node] = ExprInfo(INVALID)
            context = Context(scope, body, self.diagnostics, self._hooks)
            context.check(node)
            if body.requirements or body.writes:
                context.error(
                    "OX310", node, "a constant of the module must be known without running the program", "move it into a function"
                )
                body.info[node] = ExprInfo(INVALID)
        return body

    def _unique_name(self, name: str) -> str:
        unique, number = name, 2
        while unique in self._names:
            unique, number = f"{name}_{number}", number + 1
        self._names.add(unique)
        return unique
