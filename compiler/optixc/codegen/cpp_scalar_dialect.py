"""How expressions of one function read in scalar C++: every value is one number, vector or struct."""

from __future__ import annotations

from optixc.codegen.cpp_coop_vec import callee
from optixc.codegen.cpp_expr import AND, CHOICE, OR, PRIMARY, Code, within
from optixc.codegen.cpp_signatures import FunctionNames, Signatures
from optixc.codegen.cpp_types import TypeNames
from optixc.codegen.needs import HIT_OBJECT_DATA, Options
from optixc.ir.intrinsic_rows import INTRINSICS
from optixc.ir.intrinsic_rows_coop_vec import COOP_VEC_NAMES
from optixc.ir.intrinsics import State
from optixc.ir.nodes import ElementRef, Expr, HelperCall, IndexRef, IntrinsicCall, Literal, Local, Logical, Select
from optixc.ir.types import Struct, Type


class ScalarDialect:
    """Answers what `Expressions` asks, for one function."""

    def __init__(self, types: TypeNames, signatures: Signatures, names: FunctionNames, options: Options) -> None:
        self._types = types
        self._signatures = signatures
        self._names = names
        self._options = options

    def local(self, local: Local) -> str:
        return self._names.locals[local.name]

    def params(self) -> str:
        return self._names.params

    def type_name(self, type_: Type, like: Expr) -> str:
        return self._types.name(type_)

    def element(self, node: ElementRef, array: Code, indices: tuple[Code, ...]) -> Code:
        places = ", ".join(index.text for index in indices)
        if self._options.checks_elements:
            return Code(f"oxrt::checked({self._names.thread}).load({array.text}, {places})")
        return Code(f"{within(array, PRIMARY)}.at({places})")

    def index(self, node: IndexRef, base: Code, index: Code) -> Code:
        if self._options.is_checked and not isinstance(node.index, Literal):
            return Code(f"oxrt::checked({self._names.thread}).item({base.text}, {index.text})")
        return Code(f"{within(base, PRIMARY)}[{index.text}]")

    def logical(self, node: Logical, left: Code, right: Code) -> Code:
        if node.is_and:
            return Code(f"{within(left, AND)} && {within(right, AND + 1)}", AND)
        sides = (f"({side.text})" if side.precedence == AND else within(side, OR) for side in (left, right))
        return Code(" || ".join(sides), OR)

    def select(self, node: Select, condition: Code, if_true: Code, if_false: Code) -> Code:
        return Code(f"{within(condition, CHOICE + 1)} ? {within(if_true, CHOICE + 1)} : {within(if_false, CHOICE)}", CHOICE)

    def intrinsic(self, node: IntrinsicCall, arguments: tuple[str, ...]) -> Code:
        row = INTRINSICS[node.name]
        hidden = {
            State.NONE: [],
            State.THREAD: [self._names.thread],
            State.RAY: [self._names.trace],
            State.HIT_OBJECT: [self._names.hit_object],
        }[row.state]
        template = f"<{self._types.name(node.type)}>" if node.name == HIT_OBJECT_DATA else ""
        name = callee(node) if node.name in COOP_VEC_NAMES else row.cpp
        return Code(f"{name}{template}({', '.join([*hidden, *arguments])})")

    def carries(self, struct: Struct, field: str) -> bool:
        return self._types.carries(struct, field)

    def helper(self, node: HelperCall, arguments: tuple[str, ...]) -> Code:
        hidden = self._signatures.hidden_arguments(node.function, self._names)
        return Code(f"{self._signatures.callee(node.function)}({', '.join([*hidden, *arguments])})")
