"""Small damages to the text of a shader file, as a slip of the keyboard or of thought would do them."""

from __future__ import annotations

import io
import keyword
import tokenize
from random import Random

_OPERATORS = "+ - * / // % ** @ & | ^ << >> < <= > >= == != and or not in is = += . , : -> ( ) [ ]".split()
_NUMBERS = "0 1 -1 2 3 0.0 0.5 1e30 1e400 255 256 2147483648 4294967296 99999999999999999999 True None 1j".split()
_WORDS = "pass break continue return if while for lambda yield global del assert match float int bool print range template int32_t".split()


def mutated(random: Random, text: str, times: int) -> str:
    """The text with some damages; it need not be Python any more."""
    for _ in range(times):
        text = random.choice((_token, _token, _token, _lines, _lines, _characters))(random, text)
    return text


def _tokens(text: str) -> list[tokenize.TokenInfo]:
    try:
        return [token for token in tokenize.generate_tokens(io.StringIO(text).readline) if token.string.strip()]
    except (tokenize.TokenError, SyntaxError):
        return []


def _token(random: Random, text: str) -> str:
    """Another name, number or operator in place of one; or none, or twice."""
    tokens = _tokens(text)
    if not tokens:
        return _lines(random, text)
    token = random.choice(tokens)
    if token.start[0] != token.end[0]:
        return text
    others = [one.string for one in tokens if one.type == token.type]
    if token.type == tokenize.NAME and random.random() < 0.3:
        others = [*keyword.kwlist, *_WORDS]
    elif token.type == tokenize.OP:
        others = _OPERATORS
    elif token.type == tokenize.NUMBER:
        others = _NUMBERS
    new = random.choice((random.choice(others), random.choice(others), random.choice(others), "", f"{token.string} {token.string}"))
    lines = text.splitlines(keepends=True)
    line = lines[token.start[0] - 1]
    lines[token.start[0] - 1] = line[: token.start[1]] + new + line[token.end[1] :]
    return "".join(lines)


def _lines(random: Random, text: str) -> str:
    """A line deleted, doubled, moved, or indented otherwise."""
    lines = text.splitlines(keepends=True)
    if not lines:
        return text
    place = random.randrange(len(lines))
    match random.randrange(5):
        case 0:
            del lines[place]
        case 1:
            lines.insert(place, lines[place])
        case 2:
            lines.insert(random.randrange(len(lines)), lines.pop(place))
        case 3:
            lines[place] = "    " + lines[place]
        case _:
            lines[place] = lines[place].removeprefix("    ")
    return "".join(lines)


def _characters(random: Random, text: str) -> str:
    """One character deleted, or one put in."""
    place = random.randrange(len(text) + 1)
    put = random.choice(("", "(", ")", " ", "\t", "\0", "é", "\\", '"', "#", "\n", "_", "9"))
    return text[:place] + put + text[place + random.randrange(2) :]
