"""Live functions: their source files are parsed whole, and names that the files do not explain are captured Python values.

A function is found in its file by name and line, also inside another function or in a notebook cell (`linecache` holds cells). Numbers,
enums, vectors, tuples, structs, classes, modules and functions that it captures become constants and symbols; nothing is called.
"""

from __future__ import annotations

import ast
import enum
import inspect
import linecache
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import BuiltinFunctionType, ModuleType
from typing import Any

import numpy as np

from optixc.frontend.builtin_names import SCALAR_TYPES, VECTOR_TYPES
from optixc.frontend.builtin_symbols import attribute_of, builtin_symbol, enum_symbol, python_builtin
from optixc.frontend.conversions import weak_of
from optixc.frontend.declarations import Declarations
from optixc.frontend.declare import PYTHON_MODULES, Declarer
from optixc.frontend.declare_class import declare_class
from optixc.frontend.live_constants import constant_symbol
from optixc.frontend.parse import ParsedFile, parse_text
from optixc.frontend.source_file import Diagnostics, SourceFile
from optixc.frontend.symbols import (
    FileSymbol,
    FunctionSymbol,
    OptixNamespace,
    ParamsSymbol,
    PythonName,
    SkippedName,
    StructSymbol,
    Symbol,
    ValueSymbol,
    VectorSymbol,
)
from optixc.frontend.weak import member_type
from optixc.source import Span


@dataclass(frozen=True)
class LiveFunction:
    """A live function and its symbol."""

    symbol: FunctionSymbol


def live_functions(functions: list[Callable[..., Any]], declarer: Declarer, diagnostics: Diagnostics) -> list[LiveFunction]:
    """The symbols of live functions, in order; diagnostics for those without source."""
    reader = _Reader(declarer, diagnostics)
    found = []
    for function in functions:
        symbol = reader.function(function)
        if symbol is not None:
            found.append(LiveFunction(symbol))
    return found


class _Reader:
    """Parses the files of live functions, each once."""

    def __init__(self, declarer: Declarer, diagnostics: Diagnostics) -> None:
        self.declarer = declarer
        self.diagnostics = diagnostics
        self._files: dict[str, ParsedFile | None] = {}
        self._bodies: dict[ast.AST, Declarations] = {}
        self._structs: dict[ast.ClassDef, Symbol] = {}

    def function(self, function: Any) -> FunctionSymbol | None:
        """The symbol of a live function or of what our decorators made of one."""
        plain = inspect.unwrap(getattr(function, "__wrapped__", function))
        code = getattr(plain, "__code__", None)
        name = getattr(plain, "__name__", str(function))
        if code is None:
            return self._no_source(name, "it is not a Python function")
        file = self._file(code.co_filename, plain.__module__)
        if file is None:
            return self._no_source(name, f"its file {code.co_filename} cannot be read")
        path = _find(file.tree, name, code.co_firstlineno)
        if path is None:
            return self._no_source(name, f"{code.co_filename} does not hold it (a lambda, or the file has changed)")
        scope = self._scope(file, path[:-1])
        assert isinstance(scope.live, _Captured)
        scope.live.add(plain)
        node = path[-1]
        assert isinstance(node, ast.FunctionDef)
        known = scope.lookup(name)
        symbol = known if isinstance(known, FunctionSymbol) and known.node is node else self.declarer.function_symbol(scope, node)
        return symbol if isinstance(symbol, FunctionSymbol) else self._no_source(name, "it is decorated by host code")

    def struct(self, kind: type[Any]) -> Symbol | None:
        """The symbol of a live struct class, e.g. of an earlier notebook cell or of a function that made it."""
        origin = kind.__optixc_origin__
        file = self._file(origin.file, kind.__module__)
        path = _find(file.tree, kind.__name__, origin.line) if file is not None else None
        if file is None or path is None:
            return None
        scope = self._scope(file, path[:-1])
        assert isinstance(scope.live, _Captured)
        scope.live.add_values(origin.names)
        scope.live.add_values(vars(sys.modules[kind.__module__]) if kind.__module__ in sys.modules else {})
        node = path[-1]
        assert isinstance(node, ast.ClassDef)
        if node not in self._structs:
            self._structs[node] = declare_class(scope, node, self.diagnostics)
        return self._structs[node]

    def constant(self, name: str, value: Any) -> Symbol | None:
        """A captured tuple, matrix or struct."""
        return constant_symbol(name, value, self.struct, self.declarer)

    def module(self, module: ModuleType) -> Symbol | None:
        """A module under a live name: optixc, one of Python's that declarations may use, or a file of helpers."""
        name = module.__name__
        if name == "optixc":
            return OptixNamespace()
        if name in PYTHON_MODULES:
            return PythonName(name, "")
        if name == "optixc.stdlib":
            return PythonName("optixc", "stdlib")
        path = getattr(module, "__file__", None)
        if path is None or name.split(".")[0] in sys.stdlib_module_names or not path.endswith(".py"):
            return None
        lines = linecache.getlines(path, vars(module))
        is_installed = not {"site-packages", "dist-packages"}.isdisjoint(Path(path).parts)
        if is_installed and not any(line.lstrip().startswith(("import optixc", "from optixc")) for line in lines):
            return None
        file = self._file(path, name)
        return FileSymbol(self.declarer.declare_file(file)) if file is not None else None

    def _scope(self, file: ParsedFile, outer: list[ast.AST]) -> Declarations:
        """The scope that the functions inside `outer` share; each knows what all of them captured."""
        scope = self.declarer.declare_file(file)
        for node in (None, *outer):
            if isinstance(node, ast.FunctionDef):
                inner = self._bodies.get(node)
                scope = self._bodies[node] = inner or self.declarer.declare_body(file, node.body, scope)
            if scope.live is None:
                scope.live = _Captured(self)
        return scope

    def _file(self, filename: str, module: str) -> ParsedFile | None:
        if filename not in self._files:
            linecache.checkcache(filename)
            lines = linecache.getlines(filename, vars(sys.modules[module]) if module in sys.modules else None)
            text = "".join(lines)
            folder = Path(filename).parent if Path(filename).exists() else Path.cwd()
            self._files[filename] = parse_text(text, filename, folder, self.diagnostics) if lines else None
        return self._files[filename]

    def _no_source(self, name: str, reason: str) -> FunctionSymbol | None:
        source = SourceFile(f"<function {name}>", "")
        message = f"the source of `{name}` cannot be found: {reason}"
        self.diagnostics.add(source, "OX104", Span(source.path, 1, 0, 1, 0), message, "write it with `def` in a file or notebook cell")
        return None


def _find(tree: ast.Module, name: str, first_line: int) -> list[ast.AST] | None:
    """The way from the module to the function or class of this name whose decorators or `def` begin in this line."""
    pending: list[tuple[ast.AST, list[ast.AST]]] = [(tree, [])]
    while pending:
        node, path = pending.pop()
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            path = [*path, node]
            begin = min([node.lineno, *(decorator.lineno for decorator in node.decorator_list)])
            if node.name == name and begin <= first_line <= node.lineno:
                return path
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.stmt):
                pending.append((child, path))
    return None


class _Captured:
    """The globals and closures of live functions as symbols."""

    def __init__(self, reader: _Reader) -> None:
        self._reader = reader
        self._values: dict[str, Any] = {}
        self._functions: list[Any] = []

    def add(self, function: Any) -> None:
        """Know what one more function captured, and the functions that it captured."""
        if any(known is function for known in self._functions):
            return
        self._functions.append(function)
        self.add_values(function.__globals__)
        for name, cell in zip(function.__code__.co_freevars, function.__closure__ or (), strict=True):
            try:
                value = cell.cell_contents
            except ValueError:
                continue
            self._values[name] = value
            inner = inspect.unwrap(getattr(value, "__wrapped__", value)) if callable(value) else None
            if inspect.isfunction(inner):
                self.add(inner)

    def add_values(self, values: Mapping[str, Any]) -> None:
        """Know these names as well, unless they are known already."""
        for name, value in values.items():
            self._values.setdefault(name, value)

    def __call__(self, name: str) -> Symbol | None:
        """What a captured name means, None where there is none; a `SkippedName` says why a value means nothing to shaders."""
        if name not in self._values:
            return None
        value = self._values[name]
        found = self._symbol(value) or self._reader.constant(name, value)
        if found is not None or python_builtin(name) is not None:
            return found
        if isinstance(value, ModuleType):
            return SkippedName(name, f"the module `{value.__name__}`, which is host code", None)
        return SkippedName(name, f"a Python value of type {type(value).__name__}", None)

    def _symbol(self, value: Any) -> Symbol | None:
        match value:
            case ModuleType():
                return self._reader.module(value)
            case BuiltinFunctionType(__module__="math", __name__=name):
                return attribute_of(PythonName("math", ""), name)
            case enum.IntFlag():
                return ValueSymbol(member_type(True, enum_symbol(type(value)).members), int(value))
            case bool() | int() | float():
                return ValueSymbol(weak_of(value), int(value) if isinstance(value, enum.IntEnum) else value)
            case np.generic() if value.dtype.name in SCALAR_TYPES:
                return ValueSymbol(SCALAR_TYPES[value.dtype.name], value.item())
            case type() if issubclass(value, enum.IntEnum | enum.IntFlag):
                return enum_symbol(value)
        shown = type(value).__name__
        if shown in VECTOR_TYPES and type(value).__module__.startswith("optixc"):
            components: Any = value
            return VectorSymbol(VECTOR_TYPES[shown], tuple(x.item() if hasattr(x, "item") else x for x in components))
        known = getattr(value, "__name__", "")
        if known and (getattr(value, "__module__", None) or "").startswith("optixc") and builtin_symbol(known) is not None:
            return builtin_symbol(known)
        if isinstance(value, type) and hasattr(value, "__optixc_kind__"):
            return self._reader.struct(value)
        parameters = getattr(value, "__dict__", {}).get("__optixc_params__")
        if parameters is not None:
            struct = self._reader.struct(parameters)
            return ParamsSymbol(struct.type, struct.span) if isinstance(struct, StructSymbol) else None
        is_ours = type(value).__module__.startswith("optixc") and hasattr(value, "__wrapped__")
        if is_ours or (inspect.isfunction(value) and not hasattr(value, "__wrapped__")):
            return self._reader.function(value)
        # What host decorators made of a function is host code.
        return None
