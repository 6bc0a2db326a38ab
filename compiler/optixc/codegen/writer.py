"""Lines of C++: indentation, blocks, and `#line` directives that map them to the shader's file.

A line written with a span belongs to that line of the shader; `#line` is written only where the compiler would count otherwise, so
that code that runs parallel to its source needs few of them. `leave_source` maps what follows back to the generated file.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from optixc.codegen.names import string_literal
from optixc.source import Span

FILE_NAME = "pipeline.cpp"
MAX_LINE = 140
_INDENT = "    "


class Writer:
    """Collects lines; `text()` gives all of them."""

    def __init__(self, file_name: str = FILE_NAME) -> None:
        self._file_name = file_name
        self._lines: list[str] = []
        self._depth = 0
        self._path: str | None = None
        self._next_line = 0
        self._has_left = False

    def text(self) -> str:
        return "\n".join(self._lines) + "\n"

    def line(self, text: str = "", span: Span | None = None) -> None:
        """Writes one line (broken at commas if it is too long) that stands for `span`."""
        if span is not None:
            self._go_to(span)
        elif text and self._has_left:
            self._return_to_generated_file()
        for piece in _broken(_INDENT * self._depth + text if text else ""):
            self._put(piece)

    def leave_source(self) -> None:
        """What follows is the generated file's own, until a line has a span again."""
        self._has_left = self._path is not None

    @contextmanager
    def block(self, head: str, span: Span | None = None, tail: str = "}") -> Iterator[None]:
        """`head {`, the lines written inside, and `tail`."""
        self.line(f"{head} {{" if head else "{", span)
        with self.indented():
            yield
        self.line(tail)

    @contextmanager
    def indented(self) -> Iterator[None]:
        self._depth += 1
        yield
        self._depth -= 1

    def _go_to(self, span: Span) -> None:
        self._has_left = False
        if self._path != span.path or self._next_line != span.line:
            self._lines.append(f"#line {span.line} {string_literal(span.path)}")
            self._path, self._next_line = span.path, span.line

    def _return_to_generated_file(self) -> None:
        self._has_left = False
        self._path = None
        self._lines.append(f"#line {len(self._lines) + 2} {string_literal(self._file_name)}")

    def _put(self, text: str) -> None:
        self._lines.append(text)
        self._next_line += 1


def _broken(text: str) -> list[str]:
    """The line as it is, or cut after commas into lines of at most MAX_LINE, the rest indented by two steps."""
    if len(text) <= MAX_LINE or text.lstrip().startswith("//"):
        return [text]
    indent = text[: len(text) - len(text.lstrip())] + 2 * _INDENT
    pieces: list[str] = []
    rest = text
    while len(rest) > MAX_LINE:
        cut = _last_break(rest, MAX_LINE, len(indent) + 1)
        if cut is None:
            break
        pieces.append(rest[:cut])
        rest = indent + rest[cut:].lstrip()
    return [*pieces, rest]


def _last_break(text: str, limit: int, least: int) -> int | None:
    """Where to cut: behind the last comma outside of string literals that fits, else behind the first one at all."""
    is_string = is_escaped = False
    best = None
    for position, character in enumerate(text):
        if position >= limit and best is not None:
            break
        if is_escaped:
            is_escaped = False
        elif character == "\\":
            is_escaped = True
        elif character == '"':
            is_string = not is_string
        elif character == "," and not is_string and position >= least and position + 1 < len(text):
            best = position + 1
    return best
