"""Expressions over lanes: what the scalar emitter prints, with masks where memory is read and where a choice differs between lanes.

`mask` names the lanes that run the expression. Inside of a conditional part it is narrowed; the condition is then written as a local of
its own before the statement, by `hoist`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from optixc.codegen.cpp_coop_vec import callee
from optixc.codegen.cpp_expr import AND, BIT_AND, BIT_OR, CHOICE, OR, PRIMARY, UNARY, Code, Expressions, within
from optixc.codegen.cpp_signatures import FunctionNames
from optixc.codegen.cpp_spmd_clones import Clones
from optixc.codegen.cpp_spmd_types import WideTypes
from optixc.codegen.needs import HIT_OBJECT_DATA, Options
from optixc.ir.intrinsic_rows import INTRINSICS
from optixc.ir.intrinsic_rows_coop_vec import COOP_VEC_NAMES
from optixc.ir.intrinsics import State
from optixc.ir.nodes import (
    ArrayShape,
    Construct,
    ElementRef,
    Expr,
    HelperCall,
    IndexRef,
    IntrinsicCall,
    Literal,
    Local,
    Logical,
    Select,
)
from optixc.ir.types import Scalar, ScalarKind, Struct, Tuple, Type, Vector, scalar_of
from optixc.ir.walk import subexpressions
from optixc.passes.traced_programs import PAYLOAD_GETTER
from optixc.passes.uniformity import COMMON_IN_INTERSECTION, Clone, varies

_THREAD_LANES = frozenset({"get_launch_index", "get_launch_dimensions"})
_PER_LANE = frozenset({"transpose", "determinant", "inverse", "mul_hi"})
"""Mathematics without a form for lanes."""

ATTRIBUTE_GETTER = "get_attribute_"

_HIT_LANES = frozenset(
    """get_world_ray_origin get_world_ray_direction get_object_ray_origin get_object_ray_direction get_ray_tmin
    get_ray_tmax get_ray_time get_ray_flags get_ray_visibility_mask
    get_primitive_index get_sbt_gas_index get_instance_id get_instance_index get_gas_traversable_handle get_hit_kind get_primitive_type
    is_front_face_hit is_back_face_hit is_triangle_hit is_triangle_front_face_hit is_triangle_back_face_hit get_triangle_barycentrics
    get_geometric_normal
    get_curve_parameter get_cluster_id get_transform_list_size get_object_to_world_transform_matrix get_world_to_object_transform_matrix
    get_transform_list_handle get_triangle_vertex_data transform_point_from_world_to_object_space transform_point_from_object_to_world_space
    transform_vector_from_world_to_object_space transform_vector_from_object_to_world_space transform_normal_from_world_to_object_space
    transform_normal_from_object_to_world_space""".split()
) | {f"{ATTRIBUTE_GETTER}{i}" for i in range(8)}
"""Getters of the ray and the hit that lanes_ray.h has; the others run lane by lane."""


class LaneDialect:
    """Answers what `Expressions` asks, for one clone of a function."""

    def __init__(
        self, types: WideTypes, clones: Clones, clone: Clone, names: FunctionNames, options: Options, hoist: Callable[[str, str], str]
    ) -> None:
        self.mask = "mask"
        self.is_conditional = False
        self._types = types
        self._clones = clones
        self._clone = clone
        self._names = names
        self._options = options
        self._hoist = hoist

    def varies(self, expression: Expr) -> bool:
        return varies(expression, self._clone, self._clones.analysis)

    @contextmanager
    def narrowed(self, mask: str) -> Iterator[None]:
        """Runs a conditional part under a smaller mask."""
        outer = self.mask, self.is_conditional
        self.mask, self.is_conditional = mask, True
        yield
        self.mask, self.is_conditional = outer

    @contextmanager
    def under(self, mask: str) -> Iterator[None]:
        """Runs a part under another mask that is as sure to have lanes."""
        outer, self.mask = self.mask, mask
        yield
        self.mask = outer

    def condition(self, text: str) -> str:
        """A mask written down before the statement; its name."""
        return text if text.isidentifier() else self._hoist("test", text)

    # ---- the dialect ---------------------------------------------------------------------------------------------------------

    def local(self, local: Local) -> str:
        return self._names.locals[local.name]

    def params(self) -> str:
        return self._names.params

    def type_name(self, type_: Type, like: Expr) -> str:
        return self._types.name(type_, self.varies(like))

    def element(self, node: ElementRef, array: Code, indices: tuple[Code, ...]) -> Code:
        places = ", ".join(index.text for index in indices)
        if self.varies(node):
            if self._options.checks_elements:
                return Code(f"oxrt::checked({self._names.thread}, {self.mask}).load({array.text}, {places})")
            return Code(f"oxrt::load<LANES>({self.mask}, {array.text}, {places})")
        if self._options.checks_elements:
            return Code(f"oxrt::checkedCommon({self._names.thread}, {self.mask}).load({array.text}, {places})")
        if self.is_conditional:
            return Code(f"oxrt::loadShared<LANES>({self.mask}, {array.text}, {places})")
        return Code(f"{within(array, PRIMARY)}.at({places})")

    def index(self, node: IndexRef, base: Code, index: Code) -> Code:
        if self._options.is_checked and not isinstance(node.index, Literal):
            return Code(f"oxrt::checked({self._names.thread}, {self.mask}).item({base.text}, {index.text})")
        if self.varies(node.index):
            return Code(f"oxrt::loadItem<LANES>({base.text}, {index.text})")
        return Code(f"{within(base, PRIMARY)}[{index.text}]")

    def logical(self, node: Logical, left: Code, right: Code) -> Code:
        if self.varies(node):
            symbol, precedence = ("&", BIT_AND) if node.is_and else ("|", BIT_OR)
            sides = (side.text if side.precedence in (precedence, PRIMARY, UNARY) else f"({side.text})" for side in (left, right))
            return Code(f" {symbol} ".join(sides), precedence)
        if node.is_and:
            return Code(f"{within(left, AND)} && {within(right, AND + 1)}", AND)
        sides = (f"({side.text})" if side.precedence == AND else within(side, OR) for side in (left, right))
        return Code(" || ".join(sides), OR)

    def select(self, node: Select, condition: Code, if_true: Code, if_false: Code) -> Code:
        if self.varies(node.condition):
            sides = (self.wide(part, code) for part, code in ((node.if_true, if_true), (node.if_false, if_false)))
            return Code(f"oxrt::select({condition.text}, {', '.join(sides)})")
        if self.varies(node):
            if_true, if_false = (Code(self.wide(part, code)) for part, code in ((node.if_true, if_true), (node.if_false, if_false)))
        return Code(f"{within(condition, CHOICE + 1)} ? {within(if_true, CHOICE + 1)} : {within(if_false, CHOICE)}", CHOICE)

    def wide(self, node: Expr, code: Code) -> str:
        """The text as a varying value."""
        return code.text if self.varies(node) else self._types.widened(code.text, node.type)

    def intrinsic(self, node: IntrinsicCall, arguments: tuple[str, ...]) -> Code:
        row = INTRINSICS[node.name]
        if node.name.startswith(PAYLOAD_GETTER):
            return Code(f"oxrt::payloadWord({self._names.trace}, {node.name.removeprefix(PAYLOAD_GETTER)})")
        if self._clone.in_intersection and node.name in COMMON_IN_INTERSECTION and not self.varies(node):
            return Code(f"{row.cpp}({', '.join([f'oxrt::commonHit({self._names.trace})', *arguments])})")
        if self._clone.in_intersection and node.name == "get_ray_tmax":
            return Code(f"oxrt::getRayTmax(oxrt::candidatesOf({self._names.trace}))")
        if not self.varies(node) and row.state is State.THREAD and node.name not in _THREAD_LANES:
            return Code(f"{row.cpp}({', '.join([f'*{self._names.thread}.thread', *arguments])})")
        if row.state is State.NONE and not (node.name in _PER_LANE and self.varies(node)):
            name = callee(node) if node.name in COOP_VEC_NAMES else row.cpp
            return Code(f"{name}({', '.join(arguments)})")
        if node.name in _THREAD_LANES or node.name in _HIT_LANES:
            hidden = self._names.trace if row.state is State.RAY else self._names.thread
            return Code(f"{row.cpp}({', '.join([hidden, *arguments])})")
        if row.state is State.HIT_OBJECT:
            template = f"<{self._types.types.name(node.type)}>" if node.name == HIT_OBJECT_DATA else ""
            return Code(f"{row.cpp}{template}({', '.join([self._names.hit_object, self.mask, *arguments])})")
        lanes = [f"oxrt::inLane({argument}, lane)" for argument in arguments]
        if row.state is State.RAY:
            call = f"{row.cpp}({', '.join(['one', *lanes])})"
            return Code(f"oxrt::mapHits({self._names.trace}, [&](const oxrt::Ray& one, [[maybe_unused]] int lane) {{ return {call}; }})")
        hidden_arguments = [f"{self._names.thread}.atLane(lane)"] if row.state is State.THREAD else []
        call = f"{row.cpp}({', '.join([*hidden_arguments, *lanes])})"
        return Code(f"oxrt::mapActive({self.mask}, [&]([[maybe_unused]] int lane) {{ return {call}; }})")

    def carries(self, struct: Struct, field: str) -> bool:
        return self._types.types.carries(struct, field)

    def helper(self, node: HelperCall, arguments: tuple[str, ...]) -> Code:
        return Code(self.helper_call(node.function, node.arguments, arguments))

    def callee(self, function: str, nodes: tuple[Expr, ...]) -> Clone:
        """The clone of a helper that fits the arguments."""
        return self._clones.helper(function, tuple(self.varies(argument) for argument in nodes), self._clone)

    def helper_call(self, function: str, nodes: tuple[Expr, ...], arguments: tuple[str, ...]) -> str:
        """The call of the clone of a helper that fits the arguments."""
        callee = self.callee(function, nodes)
        if self._clones.runs_once(callee):
            hidden = self._clones.scalar_arguments(callee, f"*{self._names.thread}.thread")
            return f"{self._clones.scalar_name(callee)}({', '.join([*hidden, *arguments])})"
        texts = []
        for parameter, node, text in zip(callee.function.parameters, nodes, arguments, strict=True):
            must_widen = parameter.local.name in callee.varying and not self.varies(node)
            texts.append(self._types.widened(text, node.type) if must_widen else text)
        return f"{self._clones.callee_name(callee)}({', '.join([*self._clones.hidden_arguments(callee, self._names, self.mask), *texts])})"


class LaneExpressions(Expressions):
    """Prints expressions over lanes."""

    def __init__(self, dialect: LaneDialect) -> None:
        super().__init__(dialect)
        self.lanes = dialect

    def code(self, expression: Expr) -> Code:
        match expression:
            case Select() if self.lanes.varies(expression.condition) and _needs_mask(expression.if_true, expression.if_false):
                return self._masked_select(expression)
            case Logical() if self.lanes.varies(expression.left) and _needs_mask(expression.right):
                return self._masked_logical(expression)
            case Select() | Logical() if _needs_mask(expression):
                with self.lanes.narrowed(self.lanes.mask):
                    return super().code(expression)
            case ArrayShape() if self.lanes.varies(expression):
                return Code(f"oxrt::convert<int32_t>({self.at(expression.array, PRIMARY)}.shape[{expression.axis}])")
            case Construct(type=Tuple()) if self.lanes.varies(expression):
                items = [self.wide(argument) for argument in expression.arguments]
                return Code(f"oxrt::makeTuple({', '.join(items)})")
            case _:
                return super().code(expression)

    def wide(self, expression: Expr) -> str:
        """The expression as a varying value."""
        return self.lanes.wide(expression, self.code(expression))

    def _masked_select(self, node: Select) -> Code:
        test = self.lanes.condition(self.text(node.condition))
        with self.lanes.narrowed(f"({self.lanes.mask} & {test})"):
            if_true = self.code(node.if_true)
        with self.lanes.narrowed(f"oxrt::without({self.lanes.mask}, {test})"):
            if_false = self.code(node.if_false)
        return self.lanes.select(node, Code(test), if_true, if_false)

    def _masked_logical(self, node: Logical) -> Code:
        test = self.lanes.condition(self.text(node.left))
        narrowed = f"({self.lanes.mask} & {test})" if node.is_and else f"oxrt::without({self.lanes.mask}, {test})"
        with self.lanes.narrowed(narrowed):
            right = self.code(node.right)
        return self.lanes.logical(node, Code(test), right)

    def stored(self, text: str, value: Expr, target: Type) -> str:
        """Lanes hold storage numbers widened: they are narrowed where they are written."""
        scalar = scalar_of(target)
        if scalar is not None and scalar.kind is not ScalarKind.BOOL and scalar.bits < 32 and target != value.type:
            return f"oxrt::convert<{self.lanes.type_name(scalar, Literal(0, scalar))}>({text})"
        return super().stored(text, value, target)

    def _initialisers(self, node: Construct, values: list[tuple[Type, Expr, str]]) -> list[str]:
        """Initialisers of a wide struct or array: whole values that are uniform are spread first."""
        if not self.lanes.varies(node):
            return super()._initialisers(node, values)
        parts = []
        for type_, argument, text in values:
            stays = self.lanes.varies(argument) or spreads_itself(argument, type_)
            parts.append(self.stored(text if stays else self.wide(argument), argument, type_))
        return parts


def spreads_itself(value: Expr, target: Type) -> bool:
    """Whether C++ makes a varying value of type `target` from a uniform one by itself."""
    return isinstance(value.type, Scalar) or (isinstance(value.type, Vector) and value.type == target)


def _needs_mask(*expressions: Expr) -> bool:
    return any(isinstance(part, ElementRef | HelperCall | IndexRef) for expression in expressions for part in subexpressions(expression))
