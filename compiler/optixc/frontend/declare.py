"""What each module-level name of a shader file means.

`Declarer` turns definitions into symbols: imports of optixc and of helper files, our decorators, `launch_params`, constants, enums,
functions. Everything else becomes a `SkippedName`. Helper files are read when a program first reaches one of their names.
"""

from __future__ import annotations

import ast
from pathlib import Path

from optixc.frontend import builtin_names as names
from optixc.frontend.annotations import resolve_type
from optixc.frontend.builtin_symbols import attribute_of, builtin_symbol
from optixc.frontend.declarations import Declarations, Definition, collect
from optixc.frontend.declare_class import declare_class
from optixc.frontend.imports import FileImports
from optixc.frontend.parse import ParsedFile
from optixc.frontend.resolve_name import resolve_dotted
from optixc.frontend.source_file import Diagnostics
from optixc.frontend.symbols import (
    BuiltinName,
    ConstantSymbol,
    FileSymbol,
    FunctionSymbol,
    OptixNamespace,
    ParamsSymbol,
    PythonName,
    SkippedName,
    StructSymbol,
    Symbol,
)
from optixc.ir import types as t
from optixc.ir.programs import ProgramKind, program_kind

PYTHON_MODULES = frozenset({"math", "enum", "typing", "__future__"})


class Declarer:
    """Resolves the names of all files of one compilation."""

    def __init__(self, diagnostics: Diagnostics, include_dirs: tuple[Path, ...]) -> None:
        self.diagnostics = diagnostics
        self.files = FileImports(diagnostics, include_dirs)
        self._scopes: dict[ParsedFile, Declarations] = {}

    def declare_file(self, file: ParsedFile) -> Declarations:
        """The module-level scope of a file; made once."""
        scope = self._scopes.get(file)
        if scope is None:
            scope = Declarations(file, self.resolve, stdlib=lambda name: self._stdlib(file, name))
            self._scopes[file] = scope
            collect(scope, file.tree.body)
            self._note_star_imports(scope, file.tree.body)
        return scope

    def declare_body(self, file: ParsedFile, body: list[ast.stmt], parent: Declarations) -> Declarations:
        """The scope of a function body in which programs are written."""
        scope = Declarations(file, self.resolve, parent=parent, stdlib=parent.stdlib)
        collect(scope, body)
        self._note_star_imports(scope, body)
        return scope

    def check_definitions(self, scope: Declarations) -> None:
        """Resolve everything that is ours, so that mistakes in it are told even if no program uses it."""
        for name, definitions in scope.definitions.items():
            ours = [d for d in definitions if d.form in ("function", "class")]
            if len(ours) > 1:
                self._report_duplicate(scope, name, ours)
            elif definitions[-1].form != "other" and not definitions[-1].form.startswith(("import", "from")):
                scope.lookup(name)

    def _report_duplicate(self, scope: Declarations, name: str, definitions: list[Definition]) -> None:
        decorated = [d for d in definitions if isinstance(d.node, ast.FunctionDef | ast.ClassDef) and d.node.decorator_list]
        if decorated or program_kind(name) is not None:
            first, last = definitions[0].node, definitions[-1].node
            message = f"`{name}` is defined twice"
            place = scope.file.source.header_span(last)
            self.diagnostics.add(scope.file.source, "OX203", place, message, f"the first definition is in line {scope.span(first).line}")

    def _note_star_imports(self, scope: Declarations, body: list[ast.stmt]) -> None:
        for statement in body:
            if isinstance(statement, ast.ImportFrom) and any(alias.name == "*" for alias in statement.names):
                if statement.module == "optixc" and not statement.level:
                    scope.star_imports.append(builtin_symbol)
                    continue
                file = self.files.find(scope.file, statement.module or "", statement.level)
                if file is not None:
                    scope.star_imports.append(self.declare_file(file).lookup)

    def _stdlib(self, file: ParsedFile, name: str) -> Symbol | None:
        found = self.files.find(file, f"optixc.stdlib.{name}", 0)
        return FileSymbol(self.declare_file(found)) if found is not None else None

    def resolve(self, scope: Declarations, name: str, definition: Definition) -> Symbol:
        """The meaning of one definition."""
        match definition.node:
            case ast.Import() if definition.alias is not None:
                return self._import(scope, name, definition.node, definition.alias)
            case ast.ImportFrom() if definition.alias is not None:
                return self._import_from(scope, name, definition.node, definition.alias)
            case ast.FunctionDef() as node:
                return self.function_symbol(scope, node)
            case ast.ClassDef() as node:
                return declare_class(scope, node, self.diagnostics)
            case ast.Assign() | ast.AnnAssign() as node if definition.form == "assign":
                return self._assignment(scope, name, node)
        return SkippedName(name, definition.target or "bound by host code", scope.file.source.header_span(definition.node))

    def _import(self, scope: Declarations, name: str, node: ast.Import, alias: ast.alias) -> Symbol:
        if alias.name == "optixc":
            return OptixNamespace()
        if alias.name in PYTHON_MODULES:
            return PythonName(alias.name, "")
        if alias.name.startswith("optixc.") and alias.asname is None:
            return OptixNamespace()
        if alias.asname is not None or "." not in alias.name:
            file = self.files.find(scope.file, alias.name, 0)
            if file is not None:
                return FileSymbol(self.declare_file(file))
        return SkippedName(
            name, f"imported from module `{alias.name}`, {self.files.why_not(scope.file, alias.name)}", scope.span(node), "OX206"
        )

    def _import_from(self, scope: Declarations, name: str, node: ast.ImportFrom, alias: ast.alias) -> Symbol:
        module = node.module or ""
        if module == "optixc" and not node.level:
            found = attribute_of(OptixNamespace(), alias.name)
            if found is not None:
                return found
        if module in PYTHON_MODULES and not node.level:
            return attribute_of(PythonName(module, ""), alias.name) or PythonName(module, alias.name)
        file = self.files.find(scope.file, module, node.level)
        if file is not None:
            symbol = self.declare_file(file).lookup(alias.name)
            if symbol is not None:
                return symbol
        inner = self.files.find(scope.file, f"{module}.{alias.name}" if module else alias.name, node.level)
        if inner is not None:
            return FileSymbol(self.declare_file(inner))
        shown = "." * node.level + module
        if file is not None:
            return SkippedName(
                name, f"imported from `{shown}`, but {file.source.path} defines no `{alias.name}`", scope.span(node), "OX206"
            )
        if module == "optixc":
            return SkippedName(name, f"imported from optixc, which gives shaders no `{alias.name}`", scope.span(node), "OX206")
        return SkippedName(name, f"imported from module `{shown}`, {self.files.why_not(scope.file, shown)}", scope.span(node), "OX206")

    def function_symbol(self, scope: Declarations, node: ast.FunctionDef) -> Symbol:
        """The program or helper that a function definition is."""
        source = scope.file.source
        kind = program_kind(node.name)
        decorator = ""
        for expression in node.decorator_list:
            symbol = resolve_dotted(scope, expression)
            if isinstance(symbol, BuiltinName) and symbol.name in names.FUNCTION_DECORATORS:
                decorator = symbol.name
            elif kind is not None or decorator:
                message = "a program or helper takes no other decorator than `ox.program` and `ox.device`"
                self.diagnostics.add(source, "OX210", expression, message, "remove it")
            else:
                return SkippedName(node.name, "decorated by host code", source.header_span(node))
        if kind is None and decorator == "program":
            known = " ".join(kind.prefix for kind in ProgramKind)
            message = f"`{node.name}` is a program of unknown kind"
            self.diagnostics.add(source, "OX204", source.header_span(node), message, f"its name must begin with one of {known}")
        return FunctionSymbol(node.name, node, kind, decorator, source.header_span(node), scope)

    def _assignment(self, scope: Declarations, name: str, node: ast.Assign | ast.AnnAssign) -> Symbol:
        if node.value is None:
            return SkippedName(name, "declared without a value", scope.span(node))
        if isinstance(node.value, ast.Call):
            symbol = resolve_dotted(scope, node.value.func)
            if symbol == BuiltinName("launch_params"):
                return self._launch_params(scope, name, node.value)
        annotation = node.annotation if isinstance(node, ast.AnnAssign) else None
        alias = resolve_dotted(scope, node.value) if isinstance(node.value, ast.Name | ast.Attribute) else None
        if alias is not None and not isinstance(alias, ConstantSymbol):
            return alias
        if isinstance(node.value, ast.Subscript):
            # A type under a name of its own: `Table = ox.FixedArray[float, 8]`.
            base = resolve_dotted(scope, node.value.value)
            if isinstance(base, BuiltinName) and (base.name in names.ARRAY_RANKS or base.name in names.SIZED_TYPES):
                return ConstantSymbol(node.value, None, scope.span(node), scope)
        if isinstance(node.value, ast.Constant) and isinstance(node.value.value, str | bytes):
            return SkippedName(name, "text", scope.span(node))
        return ConstantSymbol(node.value, annotation, scope.span(node), scope)

    def _launch_params(self, scope: Declarations, name: str, call: ast.Call) -> Symbol:
        live = scope.live(name) if scope.live is not None else None
        if isinstance(live, ParamsSymbol):
            return ParamsSymbol(live.struct, scope.span(call))
        source = scope.file.source
        if len(call.args) != 1 or call.keywords:
            self.diagnostics.add(source, "OX205", call, "launch_params() takes one struct class", "launch_params(Params)")
            return SkippedName("params", "malformed launch parameters", scope.span(call))
        type_ = resolve_type(scope, call.args[0], self.diagnostics)
        if isinstance(type_, t.Struct) and type_.kind is t.StructKind.PLAIN:
            return ParamsSymbol(type_, scope.span(call))
        if type_ is not None:
            self.diagnostics.add(source, "OX205", call.args[0], f"launch parameters must be an `@ox.struct` class, this is {type_}")
        return SkippedName("params", "malformed launch parameters", scope.span(call))


def structs_of(scope: Declarations) -> list[StructSymbol]:
    """All struct classes that a scope defines, in order."""
    found = [scope.lookup(name) for name, definitions in scope.definitions.items() if definitions[-1].form == "class"]
    return [symbol for symbol in found if isinstance(symbol, StructSymbol)]
