"""The names of one scope of a shader file, found without running it.

Collecting notes where each name is bound; a name's meaning is worked out when it is first asked for, so that order does not matter and
host code that no program reaches costs nothing. A nested scope (programs written inside a function) asks the scope around it; a live
scope then asks the captured Python values. This module reports only what is wrong with a definition, never what is wrong with a use.
"""

from __future__ import annotations

import ast
from collections.abc import Callable
from dataclasses import dataclass, field

from optixc.frontend.parse import ParsedFile
from optixc.frontend.symbols import ConstantSymbol, SkippedName, Symbol
from optixc.source import Span


@dataclass(frozen=True)
class Definition:
    """Where a name is bound at module level, and how: a class, function, assignment, import, or `other` statement."""

    node: ast.stmt
    form: str
    target: str = ""
    alias: ast.alias | None = None


@dataclass(eq=False)
class Declarations:
    """The names of one scope. `resolve` (from `declare`) turns a definition into a symbol."""

    file: ParsedFile
    resolve: Callable[[Declarations, str, Definition], Symbol]
    parent: Declarations | None = None
    stdlib: Callable[[str], Symbol | None] | None = None
    live: Callable[[str], Symbol | None] | None = None
    definitions: dict[str, list[Definition]] = field(default_factory=dict)
    star_imports: list[Callable[[str], Symbol | None]] = field(default_factory=list)
    _symbols: dict[str, Symbol] = field(default_factory=dict)
    _in_progress: set[str] = field(default_factory=set)
    _asked: set[str] = field(default_factory=set)

    def lookup(self, name: str) -> Symbol | None:
        """What `name` means here, or None where nothing binds it."""
        found = self._symbols.get(name)
        if found is None:
            found = self._find(name)
            if found is not None:
                self._symbols[name] = found
        return found

    def _find(self, name: str) -> Symbol | None:
        definitions = self.definitions.get(name)
        found: Symbol | None = None
        unusable: SkippedName | None = None
        if definitions:
            if name in self._in_progress:
                return SkippedName(name, "defined in terms of itself", self.span(definitions[-1].node))
            self._in_progress.add(name)
            try:
                found = self._meaning(name, definitions)
            finally:
                self._in_progress.discard(name)
        if isinstance(found, SkippedName | ConstantSymbol | None) and self.live is not None and name not in self._asked:
            # A live value is what Python would use, whatever the text of its definition; to explain one, this scope may be asked again.
            self._asked.add(name)
            try:
                live = self.live(name)
            finally:
                self._asked.discard(name)
            if isinstance(live, SkippedName):
                unusable = live
            else:
                found = live or found
        if found is not None:
            return found
        for star in self.star_imports:
            if (found := star(name)) is not None:
                return found
        return (self.parent.lookup(name) if self.parent is not None else None) or unusable

    def _meaning(self, name: str, definitions: list[Definition]) -> Symbol:
        last = definitions[-1]
        forms = {definition.form for definition in definitions}
        if len(definitions) > 1 and forms != {"import"}:
            return SkippedName(name, f"bound {len(definitions)} times", self.span(last.node))
        return self.resolve(self, name, last)

    def span(self, node: ast.AST) -> Span:
        """The place of a node of this scope's file."""
        return self.file.source.span(node)


def collect(scope: Declarations, body: list[ast.stmt]) -> None:
    """Note every name that the statements bind, without entering functions and classes."""
    for statement in body:
        _collect_statement(scope, statement)


def _collect_statement(scope: Declarations, statement: ast.stmt) -> None:
    match statement:
        case ast.FunctionDef(name=name):
            _note(scope, name, Definition(statement, "function"))
        case ast.AsyncFunctionDef(name=name):
            _note(scope, name, Definition(statement, "other", "an async function"))
        case ast.ClassDef(name=name):
            _note(scope, name, Definition(statement, "class"))
        case ast.Import(names=aliases):
            for alias in aliases:
                _note(scope, alias.asname or alias.name.split(".")[0], Definition(statement, "import", alias=alias))
        case ast.ImportFrom(names=aliases):
            for alias in aliases:
                _note(scope, alias.asname or alias.name, Definition(statement, "from", alias=alias))
        case ast.Assign(targets=[ast.Name(id=name)]) | ast.AnnAssign(target=ast.Name(id=name)):
            _note(scope, name, Definition(statement, "assign"))
        case ast.Expr():
            pass
        case _:
            text = f"bound by a statement of host code ({_STATEMENT_WORDS.get(type(statement), 'other')})"
            for name in _bound_names(statement):
                _note(scope, name, Definition(statement, "other", text))


_STATEMENT_WORDS: dict[type[ast.stmt], str] = {
    ast.If: "`if`",
    ast.For: "`for`",
    ast.While: "`while`",
    ast.With: "`with`",
    ast.Try: "`try`",
    ast.Assign: "unpacking: a constant is one name on a line of its own",
    ast.AugAssign: "augmented assignment",
    ast.Delete: "`del`",
}


def _note(scope: Declarations, name: str, definition: Definition) -> None:
    scope.definitions.setdefault(name, []).append(definition)


def _bound_names(statement: ast.stmt) -> list[str]:
    """Names that a statement binds in its scope, in order, each once."""
    names: dict[str, None] = {}
    pending: list[ast.AST] = [statement]
    while pending:
        node = pending.pop()
        match node:
            case ast.Name(id=name, ctx=ast.Store()):
                names[name] = None
            case ast.FunctionDef(name=name) | ast.ClassDef(name=name) | ast.AsyncFunctionDef(name=name):
                names[name] = None
                continue
            case ast.alias():
                names[(node.asname or node.name).split(".")[0]] = None
            case ast.Lambda():
                continue
        pending.extend(ast.iter_child_nodes(node))
    return list(names)
