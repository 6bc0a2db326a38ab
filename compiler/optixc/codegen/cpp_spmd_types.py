"""C++ types of values that differ between lanes, and the wide forms of the author's structs."""

from __future__ import annotations

from optixc.codegen.cpp_types import TypeNames, is_wrapped
from optixc.codegen.names import Scope
from optixc.codegen.writer import Writer
from optixc.ir.types import Scalar, Struct, StructKind, Type, Vector, Void


class WideTypes:
    """Names of the types of one generated file, uniform and varying. `lanes` is 8 or 16."""

    def __init__(self, types: TypeNames, structs: list[Struct], lanes: int, scope: Scope) -> None:
        self.types = types
        self.lanes = lanes
        self._structs = structs
        self._wide_names = {struct: scope.name(f"{types.struct(struct)}Wide") for struct in structs}

    def name(self, type_: Type, varies: bool) -> str:
        """The C++ type of a value; `Wide<T>` where it may differ between lanes."""
        text = self.types.name(type_)
        return text if not varies or isinstance(type_, Void) else f"Wide<{text}>"

    def widened(self, text: str, type_: Type) -> str:
        """A uniform value as a varying one."""
        if isinstance(type_, Scalar | Vector):
            return f"{self.name(type_, True)}({text})"
        return f"oxrt::spread<{self.lanes}>({text})"

    def aliases(self, writer: Writer) -> None:
        """The names that all other generated code uses."""
        writer.line(f"enum {{ LANES = {self.lanes} }};")
        writer.line("template <class T> using Wide = oxrt::Wide<T, LANES>;")
        writer.line("using Mask = oxrt::Lanes<bool, LANES>;")
        writer.line("using Lanes = oxrt::LanesThread<LANES>;")
        writer.line("using Rays = oxrt::RayLanes<LANES>;")
        writer.line()

    def declarations(self, writer: Writer) -> None:
        """Names the wide structs; written inside of the anonymous namespace, which it leaves and enters again."""
        for struct in self._structs:
            writer.line(f"struct {self._wide(struct)};")
        writer.line("}  // namespace")
        for struct in self._structs:
            name = self.types.struct(struct)
            writer.line(f"template <> struct oxrt::WideType<{name}, {self.lanes}> {{ using Type = {self._wide(struct)}; }};")
        writer.line("namespace {")
        writer.line()

    def definitions(self, writer: Writer) -> None:
        """The wide structs, each after those that it contains."""
        for struct in self._structs:
            members = self.types.members(struct)
            with writer.block(f"struct {self._wide(struct)}", tail="};"):
                writer.line("using IsWideStruct = void;")
                if struct.kind is StructKind.ATTRIBUTES:
                    wrapped = any(is_wrapped(struct, field.type) for field in struct.fields)
                    writer.line(f"static constexpr bool hasWrappedFields = {'true' if wrapped else 'false'};")
                for field, name in members:
                    writer.line(f"{self.name(field.type, True)} {name};")
                function, structs = ("f", " s") if members else ("", "")
                calls = " ".join(f"f(s.{name}...);" for _, name in members)
                head = f"static OXRT_INLINE void each(const F& {function}, S&...{structs})"
                writer.line(f"template <class F, class... S> {head} {{ {calls} }}")
            writer.line()

    def _wide(self, struct: Struct) -> str:
        return self._wide_names[struct]
