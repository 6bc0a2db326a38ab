"""From text to `ast`: files, and the files of live functions.

Takes a path or text and gives a `ParsedFile`; never runs it. Everything that CPython's parser may refuse (syntax, encoding, nesting
beyond its or our stack, files beyond a million lines) becomes a diagnostic. It knows nothing of names and types.
"""

from __future__ import annotations

import ast
import gc
import io
import re
import sys
import tokenize
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from optixc.frontend.source_file import Diagnostics, SourceFile
from optixc.source import Span

MAX_LINES = 200_000
MAX_DEPTH = 180
_STACK_FOR_PARSER = 20_000
_STACK_FOR_US = 6_000


@dataclass(eq=False)
class ParsedFile:
    """A file's tree. `directory` is where its imports are looked up first."""

    source: SourceFile
    tree: ast.Module
    directory: Path
    module_name: str
    dependencies: list[str] = field(default_factory=list)


@contextmanager
def deep_recursion(limit: int = _STACK_FOR_US) -> Iterator[None]:
    """Allow trees of MAX_DEPTH to be visited by recursive functions, whatever the caller's stack."""
    before = sys.getrecursionlimit()
    sys.setrecursionlimit(max(before, limit))
    try:
        yield
    finally:
        sys.setrecursionlimit(before)


@contextmanager
def without_collection() -> Iterator[None]:
    """Pause the garbage collector: its passes over all trees so far would make long files cost more than their length."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()


def read_text(path: Path, shown: str, diagnostics: Diagnostics) -> str | None:
    """The text of a file with its encoding cookie and BOM obeyed, or None after a diagnostic."""
    empty = SourceFile(shown, "")
    try:
        data = path.read_bytes()
    except OSError as error:
        reason = error.strerror or str(error)
        diagnostics.add(empty, "OX102", Span(shown, 1, 0, 1, 0), f"cannot read the shader file: {reason}")
        return None
    if data.count(b"\n") > MAX_LINES:
        message = f"the file has {data.count(bytes([10]))} lines, at most {MAX_LINES} are compiled; split it into several files"
        diagnostics.add(empty, "OX105", Span(shown, 1, 0, 1, 0), message)
        return None
    try:
        encoding, _ = tokenize.detect_encoding(io.BytesIO(data).readline)
        text = data.decode(encoding)
    except (SyntaxError, UnicodeDecodeError, LookupError) as error:
        diagnostics.add(empty, "OX101", Span(shown, 1, 0, 1, 0), f"the file's text cannot be decoded: {error}", "save it as UTF-8")
        return None
    return text.replace("\r\n", "\n").replace("\r", "\n")


def parse_text(text: str, shown: str, directory: Path, diagnostics: Diagnostics) -> ParsedFile | None:
    """Parse a text; None after a diagnostic."""
    text = text.removeprefix("\ufeff")
    source = SourceFile(shown, text)
    try:
        with deep_recursion(_STACK_FOR_PARSER), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            tree = ast.parse(text, filename=shown)
    except SyntaxError as error:
        _report_syntax_error(source, error, diagnostics)
        return None
    except ValueError as error:
        diagnostics.add(source, "OX101", Span(shown, 1, 0, 1, 0), f"the file is not valid Python: {error}")
        return None
    except (RecursionError, MemoryError):
        line = max(range(len(source.lines)), key=lambda number: len(source.lines[number])) + 1
        message = "the file is nested too deeply for Python's parser"
        diagnostics.add(source, "OX103", Span(shown, line, 0, line, len(source.line(line))), message, "split it into several statements")
        return None
    if not _check_depth(source, tree, diagnostics):
        return None
    return ParsedFile(source, tree, directory, Path(shown).stem or "shader")


def parse_path(path: Path, diagnostics: Diagnostics) -> ParsedFile | None:
    """Read and parse a file; None after a diagnostic."""
    text = read_text(path, str(path), diagnostics)
    return None if text is None else parse_text(text, str(path), path.parent, diagnostics)


def _report_syntax_error(source: SourceFile, error: SyntaxError, diagnostics: Diagnostics) -> None:
    line = min(error.lineno or 1, max(len(source.lines), 1))
    column = max((error.offset or 1) - 1, 0)
    end_column = (error.end_offset or 0) - 1 if error.end_lineno == error.lineno else column + 1
    span = Span(source.path, line, column, line, max(end_column, column + 1))
    if "integer string conversion" in (error.msg or ""):
        digits = re.search(r"\d{4300,}", source.line(line))
        if digits is not None:
            span = Span(source.path, line, digits.start(), line, digits.end())
        diagnostics.add(source, "OX313", span, "this integer has more than 64 bits", "no type of shaders holds it")
    elif "nested" in (error.msg or ""):
        diagnostics.add(source, "OX103", span, f"the file is nested too deeply: {error.msg}", "split it into several statements")
    else:
        diagnostics.add(source, "OX101", span, f"the file is not valid Python: {error.msg}")


def _chain_length(node: ast.AST) -> int:
    """How much deeper than the text a chain becomes in compiled form: `a and b and c`, `a < b < c`, the cases of a match."""
    match node:
        case ast.BoolOp(values=values):
            return len(values) - 2
        case ast.Compare(ops=ops):
            return len(ops) - 1
        case ast.Match(cases=cases):
            return len(cases)
    return 0


def _check_depth(source: SourceFile, tree: ast.Module, diagnostics: Diagnostics) -> bool:
    """Refuse what our recursive visitors and the passes after them would not stand; walks without recursion."""
    fine = True
    for statement in tree.body:
        # Operators have no place of their own: theirs is that of what they stand in.
        pending: list[tuple[ast.AST, int, ast.AST]] = [(statement, 0, statement)]
        while pending:
            node, depth, place = pending.pop()
            place = node if hasattr(node, "lineno") else place
            if depth > MAX_DEPTH:
                message = f"this is nested (or chained) more than {MAX_DEPTH} deep"
                diagnostics.add(source, "OX103", place, message, "split it into several statements")
                fine = False
                break
            step = 1 + _chain_length(node)
            for child in ast.iter_child_nodes(node):
                pending.append((child, depth + step, place))
    return fine
