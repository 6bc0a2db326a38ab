"""Names and parameter lists of the C++ functions of a pipeline, shared by both emitters.

Hidden arguments come first: `trace` (the ray in flight) where the function or a callee asks for it, else `thread`; then the author's
parameters in the author's order.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from optixc.codegen.cpp_types import TypeNames
from optixc.codegen.helper_calls import small_candidate_functions
from optixc.codegen.names import Scope
from optixc.codegen.needs import Needs
from optixc.codegen.program_classes import ProgramClass
from optixc.ir.nodes import CallCallable, Function, LocalRef, Parameter, ParameterRole, Pipeline, is_reference_type
from optixc.ir.programs import is_inlined
from optixc.ir.types import Struct
from optixc.ir.walk import expressions, statements
from optixc.passes.callables import CallableSignature, signature_of_call, signatures_called
from optixc.passes.uses import assigned_local


@dataclass(frozen=True)
class FunctionNames:
    """Names inside one C++ function: of locals and parameters by the author's name, and of the hidden ones."""

    locals: dict[str, str]
    thread: str
    trace: str
    params: str
    hit_object: str


class Signatures:
    """The functions of one pipeline as C++ declares and calls them."""

    def __init__(
        self, pipeline: Pipeline, types: TypeNames, scope: Scope, needs: dict[str, Needs], classes: dict[Struct | None, ProgramClass]
    ) -> None:
        self._scope = scope
        self._types = types
        self._needs = needs
        self._inlined = small_candidate_functions(pipeline)
        self._functions = {function.name: scope.name(_base_name(function)) for function in (*pipeline.programs, *pipeline.helpers)}
        self._classes = {
            payload: scope.name(f"{types.struct(payload)}Programs" if payload is not None else "NoPayloadPrograms") for payload in classes
        }

        self._dispatchers = {
            signature: scope.name("directCall" if signature.is_direct else "continuationCall") for signature in signatures_called(pipeline)
        }

    def dispatcher(self, call: CallCallable) -> str:
        """The function that runs the callable of a record for this call."""
        return self._dispatchers[signature_of_call(call)]

    def dispatcher_of(self, signature: CallableSignature) -> str:
        return self._dispatchers[signature]

    def function(self, name: str) -> str:
        """The C++ name of a program or helper."""
        return self._functions[name]

    def program_class(self, payload: Struct | None) -> str:
        """The C++ struct of the programs that a trace with this payload can run."""
        return self._classes[payload]

    def needs(self, name: str) -> Needs:
        return self._needs[name]

    def inner_names(self, function: Function) -> FunctionNames:
        """Names for the inside of a function, clear of everything global. The author's names go first."""
        scope = Scope(self._scope)
        locals_ = {local.name: scope.name(local.name) for local in (*(p.local for p in function.parameters), *function.locals)}
        return FunctionNames(
            locals=locals_,
            thread=scope.name("thread"),
            trace=scope.name("trace"),
            params=scope.name("params"),
            hit_object=scope.name("hitObject"),
        )

    def hidden_parameters(self, function: Function, names: FunctionNames) -> list[str]:
        """Declarations of the hidden parameters. A program's hit object is its own, a helper's that of its caller."""
        needs = self._needs[function.name]
        hidden = [f"oxrt::Ray& {names.trace}"] if needs.ray else [f"OxrtThread& {names.thread}"] if needs.thread else []
        if needs.hit_object and function.kind is None:
            hidden.append(f"oxrt::HitObject& {names.hit_object}")
        return hidden

    def hidden_arguments(self, callee: str, names: FunctionNames) -> list[str]:
        """What a caller with these names passes to a helper for them."""
        needs = self._needs[callee]
        hidden = [names.trace] if needs.ray else [names.thread] if needs.thread else []
        return [*hidden, names.hit_object] if needs.hit_object else hidden

    def parameter(self, parameter: Parameter, names: FunctionNames, is_used: bool) -> str:
        """The declaration of one of the author's parameters; an unused one has no name."""
        name = f" {names.locals[parameter.local.name]}" if is_used else ""
        return f"{self.parameter_type(parameter)}{name}"

    def parameter_type(self, parameter: Parameter) -> str:
        """The C++ type of a parameter: structs and fixed arrays by reference, as in Python."""
        text = self._types.name(parameter.local.type)
        match parameter.role:
            case ParameterRole.PAYLOAD:
                return f"{text}&"
            case ParameterRole.ATTRIBUTES | ParameterRole.RECORD:
                return f"const {text}&"
            case ParameterRole.VALUE:
                if parameter.local.by_reference or is_reference_type(parameter.local.type):
                    return f"{text}&" if parameter.written else f"const {text}&"
                return text

    def head(self, function: Function, names: FunctionNames) -> str:
        """The function's head without its block."""
        used = used_parameters(function)
        hidden = self.hidden_parameters(function, names)
        parameters = [self.parameter(p, names, p.local.name in used) for p in function.parameters]
        template = head_prefix(function, self._needs[function.name])
        inline = "OXRT_INLINE " if function.name in self._inlined and is_inlined(function.source_name) else ""
        result = self._types.name(function.result)
        return f"{template}{inline}{result} {self.function(function.name)}({', '.join(hidden + parameters)})"

    def inlines(self, functions: Sequence[Function]) -> bool:
        """Whether calls of all of these are inlined whatever the C++ compiler thinks."""
        return all(function.name in self._inlined and is_inlined(function.source_name) for function in functions)

    def callee(self, name: str) -> str:
        """The function as a call names it, inside of a function that has its programs as a template argument."""
        return f"{self.function(name)}<Programs>" if self._needs[name].programs else self.function(name)


def head_prefix(function: Function, needs: Needs) -> str:
    """What stands before the result's type: the programs that a trace inside runs, and that the function is not to be inlined."""
    template = "template <class Programs> " if needs.programs else ""
    return template + ("" if is_inlined(function.source_name) else "__attribute__((noinline)) ")


def used_parameters(function: Function) -> set[str]:
    """Names of the parameters that the body mentions."""
    mentioned = {expression.local.name for expression in expressions(function.body) if isinstance(expression, LocalRef)}
    targets = (assigned_local(statement) for statement in statements(function.body))
    return mentioned | {target.name for target in targets if target is not None}


def _base_name(function: Function) -> str:
    """What the C++ function is called if nothing else is called so: `closesthit_matte`, or the helper's own name."""
    return function.name.strip("_") if function.kind is not None else function.source_name
