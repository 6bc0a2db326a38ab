"""Small damages to a shader file, as a slip of the keyboard or of thought would do them: to its text, and to its statements."""

from __future__ import annotations

import ast
import copy
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
        text = random.choice((_token, _token, _token, _lines, _lines, _characters, _tree, _tree, _tree))(random, text)
    return text


def _tokens(text: str) -> list[tokenize.TokenInfo]:
    try:
        return [token for token in tokenize.generate_tokens(io.StringIO(text).readline) if token.string.strip()]
    except (tokenize.TokenError, SyntaxError, SystemError):  # Python 3.12 has a SystemError for null characters
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


_TYPES = """int float bool int8 uint8 int16 ox.uint32 ox.int64 ox.uint64 ox.float16 ox.float64 ox.float2 ox.float3 ox.float4 ox.int3
ox.uint2 ox.uchar4 ox.half3 ox.double2 ox.float3x3 ox.float3x4 ox.Traversable ox.Texture ox.Array[float] ox.Array2[ox.float4]
ox.FixedArray[float,4] ox.FixedArray[ox.float3,2] ox.FixedArray[ox.FixedArray[int,2],3] tuple[int,float] str None""".split()
_DECORATORS = ("ox.program", "ox.device", "ox.struct", "ox.payload", "ox.attributes", "property", "staticmethod")
_PREFIXES = """__raygen__ __miss__ __closesthit__ __anyhit__ __intersection__ __exception__ __direct_callable__ __continuation_callable__
__shader__ helper_""".split()
_STATEMENTS = (
    "match {0}:\n    case 1 | 2:\n        pass\n    case _ if {0} == {1}:\n        {2}",
    "while {0}:\n    {2}\n    break",
    "for again in range(3):\n    {2}\n    if {0}:\n        continue",
    "if {0}:\n    {2}\nelse:\n    {3}",
    "try:\n    {2}\nfinally:\n    {3}",
    "{0}, {1} = {1}, {0}",
    "assert {0} == {1}",
    "print(f'{{{0}}} and {{{1}}}', {1})",
    "return {0}",
    "with {0}:\n    {2}",
    "def inner():\n    {2}",
    "{0}: float = {1}",
    "{0} <<= {1}",
)


def _tree(random: Random, text: str) -> str:
    """A change that keeps the text Python: statements change places or are wrapped, types, decorators and names become others."""
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError, RecursionError):
        return _token(random, text)
    random.choice((_swap_statements, _wrap_statement, _other_type, _other_decorator, _rename, _other_expression))(random, tree)
    try:
        return ast.unparse(ast.fix_missing_locations(tree)) + "\n"
    except (ValueError, RecursionError):
        return text


def _blocks(tree: ast.Module) -> list[list[ast.stmt]]:
    return [getattr(node, name) for node in ast.walk(tree) for name in ("body", "orelse") if isinstance(getattr(node, name, None), list)]


def _swap_statements(random: Random, tree: ast.Module) -> None:
    """Two statements, of one block or of two, change places."""
    blocks = [block for block in _blocks(tree) if block]
    first, second = random.choice(blocks), random.choice(blocks)
    i, j = random.randrange(len(first)), random.randrange(len(second))
    kept = first[i]
    first[i], second[j] = copy.deepcopy(second[j]), copy.deepcopy(kept)


def _wrap_statement(random: Random, tree: ast.Module) -> None:
    """A statement gets another around it, made of the function's own names."""
    functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    if not functions:
        return
    function = random.choice(functions)
    names = [node.id for node in ast.walk(function) if isinstance(node, ast.Name)] or ["x"]
    blocks = [block for node in ast.walk(function) for block in [getattr(node, "body", None)] if isinstance(block, list) and block]
    block = random.choice(blocks)
    place = random.randrange(len(block))
    inner, other = (ast.unparse(block[random.randrange(len(block))]).replace("\n", "\n    ") for _ in range(2))
    filled = random.choice(_STATEMENTS).format(random.choice(names), random.choice(names), inner, other)
    try:
        block[place : place + random.randrange(2)] = ast.parse(filled).body
    except SyntaxError:
        return


def _other_type(random: Random, tree: ast.Module) -> None:
    """The annotation of a field, parameter, result or local says another type."""
    places: list[tuple[ast.AST, str]] = [(node, "annotation") for node in ast.walk(tree) if isinstance(node, ast.AnnAssign | ast.arg)]
    places += [(node, "returns") for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    known = [getattr(node, name) for node, name in places if getattr(node, name) is not None]
    if not places:
        return
    node, name = random.choice(places)
    setattr(node, name, copy.deepcopy(random.choice(known)) if known and random.random() < 0.4 else _expression(random.choice(_TYPES)))


def _other_decorator(random: Random, tree: ast.Module) -> None:
    """A function or class gets another decorator, one more or none."""
    decorated = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef | ast.ClassDef)]
    if decorated:
        node = random.choice(decorated)
        new = _expression(random.choice(_DECORATORS))
        node.decorator_list = random.choice(([], [new], [new], [*node.decorator_list, new]))


def _rename(random: Random, tree: ast.Module) -> None:
    """A program becomes one of another kind, or a name is that of another thing wherever it stands."""
    functions = [node for node in tree.body if isinstance(node, ast.FunctionDef)]
    if functions and random.random() < 0.5:
        function = random.choice(functions)
        function.name = random.choice(_PREFIXES) + function.name.rsplit("__", 1)[-1]
        return
    names = sorted({node.id for node in ast.walk(tree) if isinstance(node, ast.Name)})
    if len(names) > 1:
        old, new = random.sample(names, 2)
        for node in ast.walk(tree):
            if isinstance(node, ast.Name) and node.id == old and random.random() < 0.7:
                node.id = new


def _other_expression(random: Random, tree: ast.Module) -> None:
    """An expression stands where another was, or an argument is left out, doubled or named."""
    nodes = [node for node in ast.walk(tree) if isinstance(node, ast.Call | ast.BinOp | ast.Assign | ast.Return | ast.If | ast.Compare)]
    found = [node for node in ast.walk(tree) if isinstance(node, ast.expr) and isinstance(getattr(node, "ctx", ast.Load()), ast.Load)]
    if not nodes or not found:
        return
    node, new = random.choice(nodes), copy.deepcopy(random.choice(found))
    match node:
        case ast.Call(args=args) if args:
            place = random.randrange(len(args))
            args[place : place + random.randrange(2)] = random.choice(([], [new], [new, new], [ast.Starred(new, ast.Load())]))
        case ast.BinOp():
            node.right = new
        case ast.Assign() | ast.Return():
            node.value = new
        case ast.If():
            node.test = new
        case ast.Compare():
            node.comparators[-1] = new


def _expression(text: str) -> ast.expr:
    return ast.parse(text, mode="eval").body
