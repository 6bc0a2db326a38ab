"""Names in generated C++: the author's, made safe.

`identifier` turns any Python name into a C++ identifier that is neither a keyword nor reserved; `Scope` keeps identifiers apart that
must not meet. Same names in, same names out.
"""

from __future__ import annotations

from collections.abc import Iterable

_KEYWORDS = (
    "alignas alignof and and_eq asm auto bitand bitor bool break case catch char char8_t char16_t char32_t class compl concept const "
    "consteval constexpr constinit const_cast continue co_await co_return co_yield decltype default delete do double dynamic_cast "
    "else enum explicit export extern false float for friend goto if inline int long mutable namespace new noexcept not not_eq "
    "nullptr operator or or_eq private protected public register reinterpret_cast requires return short signed sizeof static "
    "static_assert static_cast struct switch template this thread_local throw true try typedef typeid typename union unsigned using "
    "virtual void volatile wchar_t while xor xor_eq restrict"
)

_NOT_OURS = (
    "oxrt half number main linux unix i386 assert NULL NAN INFINITY errno offsetof int8_t int16_t int32_t int64_t uint8_t uint16_t "
    "uint32_t uint64_t size_t ptrdiff_t intptr_t uintptr_t INT8_MIN INT16_MIN INT32_MIN INT64_MIN INT8_MAX INT16_MAX INT32_MAX "
    "INT64_MAX UINT8_MAX UINT16_MAX UINT32_MAX UINT64_MAX INT8_C INT16_C INT32_C INT64_C UINT8_C UINT16_C UINT32_C UINT64_C "
    "oxrt_pipeline_v1"
)
"""Macros of the headers and compilers, and names that generated code uses unqualified."""

_RESERVED = frozenset([*_KEYWORDS.split(), *_NOT_OURS.split()])


def identifier(name: str) -> str:
    """A C++ identifier for a Python name: no keyword, no double underscore, no leading underscore, ASCII only."""
    text = "".join(c if c.isascii() else f"u{ord(c):x}" for c in name)
    while "__" in text:
        text = text.replace("__", "_")
    text = text.lstrip("_") or "unused"
    if text[0].isdigit():
        text = "n" + text
    is_taken = text in _RESERVED or text.startswith(("OXRT_", "Oxrt", "RTC"))
    return text + "_" if is_taken else text


class Scope:
    """Identifiers in use. `name` gives a fresh one; an inner scope also keeps clear of those of its parent."""

    def __init__(self, parent: Scope | None = None, taken: Iterable[str] = ()) -> None:
        self._parent = parent
        self._taken = set(taken)

    def is_taken(self, text: str) -> bool:
        return text in self._taken or (self._parent is not None and self._parent.is_taken(text))

    def name(self, wanted: str) -> str:
        """A fresh identifier, as close to `wanted` as can be."""
        text = candidate = identifier(wanted)
        count = 2
        if self.is_taken(candidate) and not text.endswith("_"):
            candidate = text + "_"
        while self.is_taken(candidate):
            candidate = f"{text}{'' if text.endswith('_') else '_'}{count}"
            count += 1
        self._taken.add(candidate)
        return candidate


def string_literal(text: str) -> str:
    """A C string literal with the UTF-8 bytes of `text`."""
    escapes = {0x22: '\\"', 0x5C: "\\\\", 0x0A: "\\n", 0x09: "\\t", 0x0D: "\\r", 0x3F: "\\?"}
    pieces = [escapes.get(byte) or (chr(byte) if 32 <= byte < 127 else f"\\{byte:03o}") for byte in text.encode("utf-8", "surrogatepass")]
    return '"' + "".join(pieces) + '"'
