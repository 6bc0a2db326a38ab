"""Links modules into a pipeline: the chosen programs, the helpers that they reach, one set of unique names."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from optixc.ir.nodes import (
    CallHelper,
    Expr,
    Function,
    HelperCall,
    Module,
    Pipeline,
    PipelineOptions,
    Stmt,
)
from optixc.ir.types import Struct
from optixc.ir.walk import called_helpers, map_blocks, map_operands, rewrite
from optixc.passes.callables import CallableError, resolve_callables


class LinkError(Exception):
    """The programs cannot become one pipeline; the message says which names and modules are in the way."""


def link(modules: Sequence[Module], program_names: Iterable[str], options: PipelineOptions) -> Pipeline:
    """The pipeline of the programs with these full names; the order of its programs is that of the names, repeats dropped."""
    names = list(dict.fromkeys(program_names))
    homes = _homes(modules, names)
    params = _launch_params(modules)
    programs: list[Function] = []
    helpers: dict[str, Function] = {}
    for position, module in enumerate(modules):
        chosen = [program for program in module.programs if homes.get(program.name) == position]
        renamed = _take_helpers(module, chosen, helpers)
        programs.extend(_rename_calls(program, renamed) for program in chosen)
    programs.sort(key=lambda program: names.index(program.name))
    structs = tuple(dict.fromkeys(struct for module in modules for struct in module.structs))
    linked = Pipeline(structs, params, tuple(helpers.values()), tuple(programs), options)
    try:
        return resolve_callables(linked)
    except CallableError as error:
        raise LinkError(str(error)) from error


def _homes(modules: Sequence[Module], names: list[str]) -> dict[str, int]:
    """For every name the module that defines it."""
    homes: dict[str, int] = {}
    for name in names:
        found = [i for i, module in enumerate(modules) if any(program.name == name for program in module.programs)]
        if not found:
            known = ", ".join(program.name for module in modules for program in module.programs) or "none"
            raise LinkError(f"no module defines the program {name}; programs there are: {known}")
        different = {next(p for p in modules[i].programs if p.name == name) for i in found}
        if len(different) > 1:
            paths = " and ".join(modules[i].path for i in found)
            raise LinkError(f"the program {name} is defined more than once: in {paths}")
        homes[name] = found[0]
    return homes


def _launch_params(modules: Sequence[Module]) -> Struct | None:
    """The one struct of launch parameters that all modules have which have any."""
    found = [module for module in modules if module.params is not None]
    for module in found[1:]:
        if module.params != found[0].params:
            first, second = f"{found[0].params} in {found[0].path}", f"{module.params} in {module.path}"
            raise LinkError(f"the modules of a pipeline share one struct of launch parameters, but there are two: {first} and {second}")
    return found[0].params if found else None


def _take_helpers(module: Module, programs: list[Function], taken: dict[str, Function]) -> dict[str, str]:
    """Adds the helpers that the programs reach to `taken`; gives the new names of those whose name another helper has."""
    by_name = {helper.name: helper for helper in module.helpers}
    reached: dict[str, None] = {}
    stack = [name for program in reversed(programs) for name in reversed(list(called_helpers(program.body)))]
    while stack:
        name = stack.pop()
        if name not in reached:
            reached[name] = None
            stack.extend(reversed(list(called_helpers(by_name[name].body))))
    renamed: dict[str, str] = {}
    for name in reached:
        fresh, count = name, 2
        while fresh in taken and taken[fresh] != by_name[name]:
            fresh, count = f"{name}_{count}", count + 1
        if fresh != name:
            renamed[name] = fresh
    for helper in module.helpers:
        if helper.name in reached:
            new = _rename_calls(replace(helper, name=renamed.get(helper.name, helper.name)), renamed)
            taken.setdefault(new.name, new)
    return renamed


def _rename_calls(function: Function, renamed: dict[str, str]) -> Function:
    """The function with its calls of helpers renamed."""
    if not renamed:
        return function

    def of_expression(expression: Expr) -> Expr:
        if isinstance(expression, HelperCall) and expression.function in renamed:
            return replace(expression, function=renamed[expression.function])
        return expression

    def of_body(body: tuple[Stmt, ...]) -> tuple[Stmt, ...]:
        return tuple(of_statement(statement) for statement in body)

    def of_statement(statement: Stmt) -> Stmt:
        changed = map_blocks(map_operands(statement, lambda part: rewrite(part, of_expression)), of_body)
        if isinstance(changed, CallHelper) and changed.function in renamed:
            return replace(changed, function=renamed[changed.function])
        return changed

    return replace(function, body=of_body(function.body))
