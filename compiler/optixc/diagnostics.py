"""What the compiler tells an author: a code, a place, what is wrong and what was expected.

A diagnostic prints as one headline, the guilty line and a caret line with the expectation, at most 15 lines with its call chain.
The table CODES is the only list of codes; the manual's table is made from it. This module finds no errors itself.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from optixc.enums_program import Result
from optixc.errors import OptixError
from optixc.source import Span

CODES: dict[str, str] = {
    "OX101": "the file is not valid Python",
    "OX102": "the file cannot be read",
    "OX103": "an expression or statement is nested too deeply",
    "OX104": "a function has no source that can be read",
    "OX105": "the file is too long",
    "OX201": "a type is expected",
    "OX202": "a struct, payload or attributes class is malformed",
    "OX203": "a name is defined twice",
    "OX204": "a program's name has no known prefix",
    "OX205": "the launch parameters are malformed",
    "OX206": "an imported file or name is not found",
    "OX207": "a payload or attributes class has too many words",
    "OX208": "an enum is malformed",
    "OX209": "a file has no programs",
    "OX210": "a decorator is not known here",
    "OX301": "a name is not defined",
    "OX302": "a value has the wrong type",
    "OX303": "an operator does not take these types",
    "OX304": "a device function is called in a program of the wrong kind",
    "OX305": "a call's arguments do not fit",
    "OX306": "a name may be used before it is bound",
    "OX307": "something read-only is written",
    "OX308": "a second name is bound to one struct or fixed array",
    "OX309": "a recursion is not possible",
    "OX310": "a name is defined in a way that shaders cannot use",
    "OX311": "an attribute or component does not exist",
    "OX312": "an index does not fit",
    "OX313": "a constant is out of range",
    "OX314": "a constant is divided by zero",
    "OX315": "a program's parameters do not fit its kind",
    "OX316": "the return statements do not fit",
    "OX317": "a payload word is used against its semantics",
    "OX318": "a payload does not fit",
    "OX319": "a value is not callable",
    "OX320": "a name changes its type",
    "OX321": "a result is used where there is none",
    "OX322": "the types, layouts or offsets of cooperative vectors do not fit",
    "OX401": "a statement is not part of restricted Python",
    "OX402": "an expression is not part of restricted Python",
    "OX403": "text is not a value in shaders",
    "OX404": "a parameter form is not part of restricted Python",
    "OX405": "an operator is not part of restricted Python",
    "OX406": "a built-in function of Python is not part of restricted Python",
    "OX407": "a pattern is not part of restricted Python",
}

_MAX_LINES = 15
_MAX_CHAIN = 8
_MAX_WIDTH = 160


@dataclass(frozen=True)
class ChainLink:
    """One step of a call chain: the place of the call and in which function it stands."""

    span: Span
    text: str


@dataclass(frozen=True)
class Diagnostic:
    """One error. `source` is the text of the line that the span begins in, `note` stands after the caret."""

    code: str
    span: Span
    message: str
    source: str
    note: str = ""
    chain: tuple[ChainLink, ...] = ()

    def __str__(self) -> str:
        lines = [f"{self.span}: error[{self.code}]: {self.message}"]
        if self.source.strip():
            lines += self._excerpt()
        for link in self.chain[:_MAX_CHAIN]:
            lines.append(f"      = {link.text} at {link.span}")
        if len(self.chain) > _MAX_CHAIN:
            lines.append(f"      = and {len(self.chain) - _MAX_CHAIN} calls more")
        return "\n".join(lines[:_MAX_LINES])

    def _excerpt(self) -> list[str]:
        """The guilty line and its carets, clipped to a window around the place where the line is long."""
        text = self.source.rstrip("\r\n").replace("\t", " ")
        begin = self.span.column
        end = self.span.end_column if self.span.end_line == self.span.line else len(text)
        end = max(begin + 1, min(end, max(len(text), begin + 1)))
        if len(text) > _MAX_WIDTH:
            left = max(0, begin - 40)
            text = ("..." if left else "") + text[left : left + _MAX_WIDTH]
            shift = left - (3 if left else 0)
            begin, end = begin - shift, min(end - shift, len(text))
        carets = " " * begin + "^" * max(1, end - begin)
        return [f"{self.span.line:5d} | {text}", f"      | {carets} {self.note}".rstrip()]


class CompileError(OptixError):
    """A shader has errors; `diagnostics` holds all that were found, in the order of their places."""

    code = Result.ERROR_INVALID_INPUT

    def __init__(self, diagnostics: Iterable[Diagnostic]) -> None:
        self.diagnostics = tuple(diagnostics)
        super().__init__("\n".join(str(diagnostic) for diagnostic in self.diagnostics))
