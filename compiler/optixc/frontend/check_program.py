"""What programs may have as parameters, and what each kind of program may do, through all helpers that it calls."""

from __future__ import annotations

from optixc.diagnostics import ChainLink
from optixc.frontend.annotations import resolve_value_type
from optixc.frontend.checked import FunctionInstance, InstanceParameter, PayloadAccess, Requirement
from optixc.frontend.context import Context
from optixc.frontend.source_file import Diagnostics
from optixc.frontend.symbols import FunctionSymbol
from optixc.ir import types as t
from optixc.ir.layout import payload_words
from optixc.ir.nodes import Local, ParameterRole
from optixc.ir.programs import ALL_PROGRAMS, NOT_INLINED_PREFIX, ProgramKind, is_inlined

_CALLABLES = (ProgramKind.DIRECT_CALLABLE, ProgramKind.CONTINUATION_CALLABLE)
_WITH_PAYLOAD = (ProgramKind.MISS, ProgramKind.CLOSESTHIT, ProgramKind.ANYHIT, ProgramKind.INTERSECTION)
_WITH_ATTRIBUTES = (ProgramKind.CLOSESTHIT, ProgramKind.ANYHIT)
_STAGE_SHIFT = {ProgramKind.CLOSESTHIT: 2, ProgramKind.MISS: 4, ProgramKind.ANYHIT: 6, ProgramKind.INTERSECTION: 8}
_READ, _WRITE = 1, 2
SBT_DATA = "get_sbt_data()"
MAX_PAYLOAD_CLASSES = 8


def program_parameters(c: Context, symbol: FunctionSymbol) -> list[InstanceParameter]:
    """The parameters of a program, recognised by type."""
    kind = symbol.kind
    assert kind is not None
    arguments = symbol.node.args
    if not check_parameter_names(c, symbol):
        return []
    if arguments.vararg or arguments.kwarg or arguments.kwonlyargs or arguments.defaults:
        place = arguments.vararg or arguments.kwarg or (arguments.kwonlyargs or arguments.defaults)[0]
        c.error("OX404", place, "a program takes plain parameters only", "no `*`, no `**`, no defaults")
        return []
    found: list[InstanceParameter] = []
    for argument in (*arguments.posonlyargs, *arguments.args):
        if argument.annotation is None:
            message = f"parameter `{argument.arg}` of a program needs a type"
            c.error("OX315", argument, message, "an `@ox.payload`, `@ox.attributes` or `@ox.struct` class")
            c.poisoned.add(argument.arg)
            continue
        type_ = resolve_value_type(symbol.scope, argument.annotation, c.diagnostics, "a parameter")
        if type_ is None:
            c.poisoned.add(argument.arg)
            continue
        role = _role(kind, type_)
        is_second = any(parameter.role is role for parameter in found)
        is_free = role is ParameterRole.VALUE or (role is ParameterRole.RECORD and kind in _CALLABLES)
        if role is None or (is_second and not is_free):
            what = f"a second {role.value}" if role is not None else f"a parameter of type {type_}"
            c.error("OX315", argument, f"{_a(kind.value)} program does not take {what}", _expectation(kind))
            c.poisoned.add(argument.arg)
            continue
        by_reference = role in (ParameterRole.PAYLOAD, ParameterRole.RECORD) or isinstance(type_, t.Struct | t.FixedArray)
        by_reference = by_reference and role is not ParameterRole.ATTRIBUTES
        found.append(InstanceParameter(Local(argument.arg, type_, by_reference=by_reference), role))
    return _one_record(found) if kind in _CALLABLES else found


def _one_record(parameters: list[InstanceParameter]) -> list[InstanceParameter]:
    """A callable's structs may be arguments too: only the last is taken for the record's data, until its calls are known."""
    last = next((p for p in reversed(parameters) if p.role is ParameterRole.RECORD), None)
    for parameter in parameters:
        if parameter.role is ParameterRole.RECORD and parameter is not last:
            parameter.role = ParameterRole.VALUE
    return parameters


def check_parameter_names(c: Context, symbol: FunctionSymbol) -> bool:
    """Two parameters of one name pass CPython's parser, so they are found here."""
    seen: set[str] = set()
    arguments = symbol.node.args
    for argument in (*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs):
        if argument.arg in seen:
            c.error("OX404", argument, f"two parameters are called `{argument.arg}`", "give one another name")
            return False
        seen.add(argument.arg)
    return True


def _role(kind: ProgramKind, type_: t.Type) -> ParameterRole | None:
    if isinstance(type_, t.Struct):
        if type_.kind is t.StructKind.PAYLOAD:
            return ParameterRole.PAYLOAD if kind in _WITH_PAYLOAD else None
        if type_.kind is t.StructKind.ATTRIBUTES:
            return ParameterRole.ATTRIBUTES if kind in _WITH_ATTRIBUTES else None
        return ParameterRole.RECORD
    return ParameterRole.VALUE if kind in _CALLABLES and not isinstance(type_, t.Void) else None


def _expectation(kind: ProgramKind) -> str:
    words = ["one `@ox.struct` class (the data of its SBT record)"]
    if kind in _WITH_PAYLOAD:
        words.insert(0, "one `@ox.payload` class")
    if kind in _WITH_ATTRIBUTES:
        words.insert(1, "one `@ox.attributes` class")
    if kind in _CALLABLES:
        words.append("values, structs too")
    return "it takes " + ", ".join(words)


def check_payload_classes(diagnostics: Diagnostics, programs: list[FunctionInstance]) -> None:
    """A module has at most eight payload types (OptiX guide, chapter 14)."""
    seen: dict[t.Type, None] = {}
    for program in programs:
        for parameter in program.parameters:
            if parameter.role is ParameterRole.PAYLOAD and parameter.local.type not in seen:
                seen[parameter.local.type] = None
                if len(seen) == MAX_PAYLOAD_CLASSES + 1:
                    assert program.symbol is not None
                    message = f"the programs of a module take at most {MAX_PAYLOAD_CLASSES} payload classes, this is one more"
                    diagnostics.add(program.source, "OX207", program.symbol.span, message, "move programs to another file")


def check_requirements(diagnostics: Diagnostics, program: FunctionInstance) -> None:
    """Report what this program does, itself or through helpers, that its kind may not do."""
    assert program.kind is not None
    payload = next((p.local for p in program.parameters if p.role is ParameterRole.PAYLOAD), None)
    seen: set[tuple[FunctionInstance, bool]] = set()
    pending: list[tuple[FunctionInstance, tuple[ChainLink, ...], FunctionInstance | None]] = [(program, (), None)]
    while pending:
        function, chain, outer = pending.pop()
        if function.symbol is not None and not is_inlined(function.symbol.name):
            outer = outer or function
        if (function, outer is None) in seen:
            continue
        seen.add((function, outer is None))
        for requirement in function.requirements:
            if program.kind not in requirement.allowed:
                _report(diagnostics, program, function, requirement, chain)
            elif outer is not None and (ProgramKind.DIRECT_CALLABLE not in requirement.allowed or requirement.what == SBT_DATA):
                _report_not_inlined(diagnostics, outer, function, requirement, chain)
            elif payload is not None and isinstance(payload.type, t.Struct):
                _check_word(diagnostics, program, payload.type, function, requirement, chain)
        for call in function.calls:
            if program.kind is ProgramKind.EXCEPTION and call.instance.symbol is not None and not is_inlined(call.instance.symbol.name):
                message = f"an exception program cannot call `{call.instance.name}`, which is not inlined"
                diagnostics.add(function.source, "OX304", call.span, message, "call a helper without the prefix", chain)
            pending.append((call.instance, (ChainLink(call.span, f"called from `{function.name}`"), *chain), outer))
        _check_recursion(diagnostics, function)
    if payload is not None:
        _check_semantics(diagnostics, program, payload)


def _report(
    diagnostics: Diagnostics, program: FunctionInstance, function: FunctionInstance, requirement: Requirement, chain: tuple[ChainLink, ...]
) -> None:
    assert program.kind is not None
    message = f"{requirement.what} is only allowed in {_kinds_text(requirement.allowed)}"
    note = f"this is {program.kind.value} program `{program.name}`"
    if function is not program:
        note = f"this helper is reached from {program.kind.value} program `{program.name}`"
    diagnostics.add(function.source, requirement.code, requirement.span, message, note, chain)


def _report_not_inlined(
    diagnostics: Diagnostics, outer: FunctionInstance, function: FunctionInstance, requirement: Requirement, chain: tuple[ChainLink, ...]
) -> None:
    message = f"{requirement.what} is not allowed in `{outer.name}`, which is not inlined"
    note = f"`{NOT_INLINED_PREFIX}` functions may do what direct callables do, without SBT data; pass it as an argument"
    diagnostics.add(function.source, requirement.code, requirement.span, message, note, chain)


def _kinds_text(allowed: frozenset[ProgramKind]) -> str:
    """ "an anyhit program", "anyhit and closesthit programs"."""
    names = [kind.value for kind in ProgramKind if kind in allowed]
    if len(names) > len(ALL_PROGRAMS) // 2 + 1:
        missing = [kind.value for kind in ProgramKind if kind not in allowed]
        return f"programs other than {' and '.join(missing)}"
    if len(names) == 1:
        return f"{_a(names[0])} program"
    return f"{', '.join(names[:-1])} and {names[-1]} programs"


def _a(word: str) -> str:
    return f"{'an' if word[0] in 'aeiou' else 'a'} {word}"


def _check_recursion(diagnostics: Diagnostics, function: FunctionInstance) -> None:
    """Functions that reach a device function are inlined, so they cannot call themselves (OptiX guide, section 13)."""
    if not function.is_recursive:
        return
    assert function.symbol is not None
    pending, seen = [function], set()
    while pending:
        inner = pending.pop()
        if inner in seen:
            continue
        seen.add(inner)
        if inner.requirements:
            what = inner.requirements[0].what
            message = f"`{function.name}` calls itself and uses the device function {what}"
            diagnostics.add(function.source, "OX309", function.symbol.span, message, "such helpers cannot recurse; write a loop")
            return
        pending.extend(call.instance for call in inner.calls)


def _check_semantics(diagnostics: Diagnostics, program: FunctionInstance, payload: Local) -> None:
    """Compare reads and writes of the payload, through helpers too, with its payload_word() semantics."""
    assert isinstance(payload.type, t.Struct) and program.kind is not None
    if all(field.semantics is None for field in payload.type.fields):
        return
    seen: set[tuple[FunctionInstance, str]] = set()
    pending: list[tuple[FunctionInstance, str, tuple[ChainLink, ...]]] = [(program, payload.name, ())]
    while pending:
        function, name, chain = pending.pop()
        if (function, name) in seen:
            continue
        seen.add((function, name))
        for access in function.payload_accesses.get(name, []):
            _check_access(diagnostics, program, payload.type, function, access, chain)
        for call in function.calls:
            link = ChainLink(call.span, f"called from `{function.name}`")
            pending.extend((call.instance, inner, (link, *chain)) for outer, inner in call.payloads if outer == name)


def _check_access(
    diagnostics: Diagnostics,
    program: FunctionInstance,
    struct: t.Struct,
    function: FunctionInstance,
    access: PayloadAccess,
    chain: tuple[ChainLink, ...],
) -> None:
    field = struct.field(access.field)
    if field is None or field.semantics is None or program.kind is None:
        return
    bits = field.semantics >> _STAGE_SHIFT[program.kind]
    if bits & (_WRITE if access.is_write else _READ):
        return
    verb = "write" if access.is_write else "read"
    letter = "w" if access.is_write else "r"
    stage = {ProgramKind.CLOSESTHIT: "ch", ProgramKind.MISS: "ms", ProgramKind.ANYHIT: "ah", ProgramKind.INTERSECTION: "is_"}[program.kind]
    message = f"{_a(program.kind.value)} program may not {verb} `{struct}.{field.name}`"
    note = f'its payload_word() needs {stage}="{letter}" for `{program.name}`'
    diagnostics.add(function.source, "OX317", access.span, message, note, chain)


def _check_word(
    diagnostics: Diagnostics,
    program: FunctionInstance,
    struct: t.Struct,
    function: FunctionInstance,
    requirement: Requirement,
    chain: tuple[ChainLink, ...],
) -> None:
    """get_payload_i and set_payload_i address the same words: they must exist and obey the same semantics."""
    name, _, index = requirement.what.removesuffix("()").rpartition("_")
    if name not in ("get_payload", "set_payload") or not index.isdigit():
        return
    first = 0
    for field in struct.fields:
        if isinstance(field.type, t.Void):
            return
        words = payload_words(field.type)
        if first <= int(index) < first + words:
            access = PayloadAccess(field.name, name == "set_payload", requirement.span)
            _check_access(diagnostics, program, struct, function, access, chain)
            return
        first += words
    message = f"the payload `{struct}` has {first} words, so there is no word {index}"
    diagnostics.add(function.source, "OX317", requirement.span, message, f"expected 0 to {first - 1}", chain)
