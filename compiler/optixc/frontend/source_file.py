"""One source file: its text, its places, and the list of diagnostics that all stages of one compilation add to."""

from __future__ import annotations

import ast
from dataclasses import dataclass, field

from optixc.diagnostics import ChainLink, Diagnostic
from optixc.source import Span


@dataclass(eq=False)
class SourceFile:
    """A file's path as it is shown, and its text. `lines` keeps no line ends."""

    path: str
    text: str
    lines: list[str] = field(init=False)

    def __post_init__(self) -> None:
        self.lines = self.text.split("\n")
        self._is_ascii = self.text.isascii()

    def line(self, number: int) -> str:
        """Line `number`, counted from 1; empty past the end."""
        return self.lines[number - 1] if 0 < number <= len(self.lines) else ""

    def span(self, node: ast.AST) -> Span:
        """The place of a node; `ast` counts bytes of UTF-8, spans count characters."""
        line: int = getattr(node, "lineno", 1)
        end_line: int = getattr(node, "end_lineno", None) or line
        column = self._column(line, getattr(node, "col_offset", 0))
        end_column = self._column(end_line, getattr(node, "end_col_offset", None) or 0)
        return Span(self.path, line, column, end_line, end_column)

    def header_span(self, node: ast.stmt) -> Span:
        """The first line of a compound statement: its keyword to the end of that line."""
        span = self.span(node)
        return Span(self.path, span.line, span.column, span.line, len(self.line(span.line).rstrip()))

    def _column(self, line: int, byte_offset: int) -> int:
        if self._is_ascii:
            return byte_offset
        text = self.line(line)
        return len(text.encode("utf-8")[:byte_offset].decode("utf-8", "ignore"))


@dataclass(eq=False)
class Diagnostics:
    """Collects the errors of one compilation; the same error at the same place is kept once."""

    found: list[Diagnostic] = field(default_factory=list)
    _seen: set[tuple[str, Span, str]] = field(default_factory=set)

    def add(
        self, source: SourceFile, code: str, place: ast.AST | Span, message: str, note: str = "", chain: tuple[ChainLink, ...] = ()
    ) -> None:
        """Record an error at a node or span of `source`."""
        span = place if isinstance(place, Span) else source.span(place)
        key = (code, span, message)
        if key not in self._seen:
            self._seen.add(key)
            self.found.append(Diagnostic(code, span, message, source.line(span.line), note, chain))

    def in_order(self) -> list[Diagnostic]:
        """All errors, by file and place."""
        return sorted(self.found, key=lambda diagnostic: (diagnostic.span.path, diagnostic.span.line, diagnostic.span.column))
