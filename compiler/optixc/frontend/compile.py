"""The front end in one call: a file or live functions in, a verified IR module out, or one error with everything that is wrong."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from optixc.diagnostics import CompileError
from optixc.frontend.check import Checker
from optixc.frontend.check_program import check_payload_classes
from optixc.frontend.checked import Checked, FunctionInstance
from optixc.frontend.declarations import Declarations
from optixc.frontend.declare import Declarer, structs_of
from optixc.frontend.live import LiveFunction, live_functions
from optixc.frontend.lower import lower
from optixc.frontend.parse import ParsedFile, deep_recursion, parse_path, parse_text, without_collection
from optixc.frontend.source_file import Diagnostics, SourceFile
from optixc.frontend.symbols import FunctionSymbol, ParamsSymbol, Symbol
from optixc.ir import types as t
from optixc.ir.nodes import Module
from optixc.source import Span


@dataclass(frozen=True)
class FrontendResult:
    """The module, what the interpreter needs, every file that was read besides the first, and those that would have been but are not."""

    module: Module
    checked: Checked
    dependencies: tuple[str, ...]
    absent: tuple[str, ...]


def compile_file(path: str | Path, include_dirs: Sequence[str | Path] = ()) -> FrontendResult:
    """Compile a shader file. Raises CompileError with every error of the file and of what it imports."""
    diagnostics = Diagnostics()
    with without_collection():
        return _compile_scope(parse_path(Path(path), diagnostics), diagnostics, include_dirs)


def parse_tree(path: str | Path) -> ast.Module:
    """The file's tree alone. Raises CompileError if it is not valid Python."""
    diagnostics = Diagnostics()
    file = parse_path(Path(path), diagnostics)
    if file is None:
        raise CompileError(diagnostics.in_order())
    return file.tree


def compile_text(text: str, path: str, include_dirs: Sequence[str | Path] = ()) -> FrontendResult:
    """Compile text as if it stood in a file; `path` is what messages show and where imports are looked up."""
    diagnostics = Diagnostics()
    with without_collection():
        return _compile_scope(parse_text(text, path, Path(path).parent, diagnostics), diagnostics, include_dirs)


def _compile_scope(file: ParsedFile | None, diagnostics: Diagnostics, include_dirs: Sequence[str | Path]) -> FrontendResult:
    if file is None:
        raise CompileError(diagnostics.in_order())
    declarer = Declarer(diagnostics, tuple(Path(folder) for folder in include_dirs))
    declarer.files.add(Path(file.source.path), file)
    with deep_recursion():
        scope = declarer.declare_file(file)
        declarer.check_definitions(scope)
        symbols = [scope.lookup(name) for name in scope.definitions]
        functions = [s for s in symbols if isinstance(s, FunctionSymbol) and s.scope is scope]
        programs = [function for function in functions if function.kind is not None]
        helpers = [function for function in functions if function.kind is None and function.decorator == "device"]
        if not programs and not diagnostics.found:
            span = Span(file.source.path, 1, 0, 1, 0)
            diagnostics.add(file.source, "OX209", span, "the file has no programs", "a program's name begins with `__raygen__` or the like")
        return _compile(file.module_name, file.source, scope, programs, helpers, diagnostics, declarer)


def compile_functions(functions: Iterable[Callable[..., Any]]) -> FrontendResult:
    """Compile live functions; captured numbers become constants. Raises CompileError."""
    diagnostics = Diagnostics()
    declarer = Declarer(diagnostics, ())
    with without_collection(), deep_recursion():
        found: list[LiveFunction] = live_functions(list(functions), declarer, diagnostics)
        if diagnostics.found or not found:
            raise CompileError(diagnostics.in_order())
        programs = [function.symbol for function in found if function.symbol.kind is not None]
        helpers = [function.symbol for function in found if function.symbol.kind is None]
        scope = found[0].symbol.scope
        if not programs:
            place = helpers[0]
            diagnostics.add(scope.file.source, "OX209", place.span, "none of the functions is a program", "e.g. `def __raygen__name():`")
        return _compile(scope.file.module_name, scope.file.source, scope, programs, helpers, diagnostics, declarer)


def check_helper(function: Callable[..., Any], types: Sequence[t.Type | None]) -> FunctionInstance:
    """A helper checked for a call from Python: annotated parameters have their annotation, the others the types given.

    Raises CompileError with every error of the helper and of what it calls.
    """
    diagnostics = Diagnostics()
    declarer = Declarer(diagnostics, ())
    with without_collection(), deep_recursion():
        found = live_functions([function], declarer, diagnostics)
        instance = None
        if found and not diagnostics.found:
            symbol = found[0].symbol
            instance = Checker(diagnostics, _params_of(symbol.scope)).instance_of(symbol, types)
    if instance is None or diagnostics.found:
        raise CompileError(diagnostics.in_order())
    return instance


def _compile(
    name: str,
    source: SourceFile,
    scope: Declarations,
    programs: list[FunctionSymbol],
    helpers: list[FunctionSymbol],
    diagnostics: Diagnostics,
    declarer: Declarer,
) -> FrontendResult:
    checker = Checker(diagnostics, _params_of(scope))
    instances = [checker.check_program(symbol) for symbol in programs]
    for symbol in helpers:
        checker.check_unused_helper(symbol)
    check_payload_classes(diagnostics, instances)
    if diagnostics.found:
        raise CompileError(diagnostics.in_order())
    dependencies = tuple(declarer.files.dependencies)
    structs = tuple(symbol.type for symbol in structs_of(scope))
    checked = Checked(name, source.path, structs, checker.params, instances, _reached(instances), dependencies)
    return FrontendResult(lower(checked), checked, dependencies, tuple(declarer.files.absent))


def _params_of(scope: Declarations) -> t.Struct | None:
    """The launch parameters of a scope or of one around it."""
    layer: Declarations | None = scope
    while layer is not None:
        symbols: list[Symbol | None] = [layer.lookup(name) for name in layer.definitions]
        for symbol in symbols:
            if isinstance(symbol, ParamsSymbol):
                return symbol.struct
        layer = layer.parent
    return None


def _reached(programs: list[FunctionInstance]) -> list[FunctionInstance]:
    """Helper instances that programs reach, each after those that it calls (recursion aside)."""
    order: dict[FunctionInstance, None] = {}
    visited: set[FunctionInstance] = set()

    def visit(function: FunctionInstance) -> None:
        if function in visited:
            return
        visited.add(function)
        for call in function.calls:
            visit(call.instance)
        if function.kind is None:
            order[function] = None

    for program in programs:
        visit(program)
    return list(order)
