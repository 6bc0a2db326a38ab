"""Modules as the host sees them, program groups made from their programs, and SBT records of groups."""

from __future__ import annotations

import weakref
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from optixc.enums_program import ModuleCompileState, ProgramGroupKind
from optixc.errors import InvalidOperationError, InvalidValueError, PayloadTypeResolutionFailedError
from optixc.host import in_flight, structs
from optixc.host.owned import Owned
from optixc.host.stack_sizes import StackSizes, sizes_of

_SLOT_PREFIXES = {
    "raygen": "__raygen__",
    "miss": "__miss__",
    "exception": "__exception__",
    "closesthit": "__closesthit__",
    "anyhit": "__anyhit__",
    "intersection": "__intersection__",
    "direct_callable": "__direct_callable__",
    "continuation_callable": "__continuation_callable__",
}
_KIND_SLOTS = {
    ProgramGroupKind.RAYGEN: ("raygen",),
    ProgramGroupKind.MISS: ("miss",),
    ProgramGroupKind.EXCEPTION: ("exception",),
    ProgramGroupKind.HITGROUP: ("closesthit", "anyhit", "intersection"),
    ProgramGroupKind.CALLABLES: ("direct_callable", "continuation_callable"),
}
_MAY_BE_EMPTY = (ProgramGroupKind.MISS, ProgramGroupKind.HITGROUP)


@dataclass(frozen=True, eq=False)
class Program:
    """A program of a module: what `module["__raygen__x"]` gives. `record` is the layout of its SBT data, None if it uses none."""

    module: Any
    name: str
    record: str | None
    record_name: str | None
    stack: int = 0
    payload: str | None = None
    payload_name: str | None = None

    def __repr__(self) -> str:
        return f"<Program {self.name}>"


class _NoSuchProgramError(InvalidValueError, KeyError):
    """A mapping raises KeyError, so that `name in module` and `module.get(name)` work."""

    __str__ = InvalidValueError.__str__


class Module(Owned, Mapping[str, Program]):
    """The programs of a shader file, Python module or list of functions, by name."""

    def __init__(self, unit: Any, programs: list[dict[str, Any]], bound_values: Mapping[str, Any] | None = None) -> None:
        self.unit = unit
        self.bound_values = dict(bound_values or {})
        self._is_destroyed = False
        members = ("name", "record", "record_name", "stack", "payload", "payload_name")
        self._programs = {one["name"]: Program(self, *(one[member] for member in members)) for one in programs}

    def get_compilation_state(self) -> ModuleCompileState:
        """COMPLETED; see `module_create_with_tasks`."""
        return ModuleCompileState.COMPLETED

    def destroy(self) -> None:
        """The module gives no programs any more; groups and pipelines made from it go on."""
        self._is_destroyed = True

    def __getitem__(self, name: str) -> Program:
        if self._is_destroyed:
            raise InvalidOperationError("this module was destroyed; create it again")
        found = self._programs.get(name)
        if found is None:
            raise _NoSuchProgramError(f"the module has no program {name!r}; it has {', '.join(self._programs) or 'none'}")
        return found

    def __repr__(self) -> str:
        return f"<Module {' '.join(self._programs)}{' destroyed' if self._is_destroyed else ''}>"

    def __iter__(self) -> Iterator[str]:
        return iter(self._programs)

    def __len__(self) -> int:
        return len(self._programs)


class ProgramGroup(Owned):
    """Programs that an SBT record names together; `programs` maps slots (`closesthit` ...) to programs."""

    def __init__(self, slots: dict[str, Program | None]) -> None:
        kinds = [kind for kind, members in _KIND_SLOTS.items() if any(slot in members for slot in slots)]
        if len(kinds) != 1:
            raise InvalidValueError(
                "a program group is one of raygen=, miss=, exception=, a hit group (closesthit=, anyhit=, intersection=) or callables "
                f"(direct_callable=, continuation_callable=); got {', '.join(slots) or 'nothing'}"
            )
        self.kind = kinds[0]
        for slot, program in slots.items():
            if program is None:
                continue
            if not isinstance(program, Program):
                raise InvalidValueError(f'{slot}= takes a program of a module, module["{_SLOT_PREFIXES[slot]}..."], not {program!r:.60}')
            if not program.name.startswith(_SLOT_PREFIXES[slot]):
                raise InvalidValueError(f"{slot}= takes a program whose name begins with {_SLOT_PREFIXES[slot]}, not {program.name}")
        self.programs = {slot: program for slot, program in slots.items() if program is not None}
        self._pipelines: weakref.WeakSet[Any] = weakref.WeakSet()
        if not self.programs and self.kind not in _MAY_BE_EMPTY:
            raise InvalidValueError(f"a group of kind {self.kind.name} needs a program")
        self._check_payloads()

    def _check_payloads(self) -> None:
        """No trace could run all programs of a group that take different payloads."""
        taking = [program for program in self.programs.values() if program.payload is not None]
        other = next((program for program in taking if program.payload != taking[0].payload), None)
        if other is not None:
            raise PayloadTypeResolutionFailedError(
                f"{taking[0].name} takes a {taking[0].payload_name} payload and {other.name} a {other.payload_name}: no trace runs both; "
                "give the programs of a group one payload class"
            )

    def record(self, data: Any = None) -> Record:
        """A record that runs this group, with `data`, an instance of the struct that its programs take."""
        return Record(self, data)

    def get_stack_size(self, pipeline: Any = None) -> StackSizes:
        """Bytes of the programs' frames in `pipeline`, else the largest of all pipelines with this group; before that an estimate."""
        if pipeline is not None and pipeline not in self._pipelines:
            raise InvalidValueError(f"{self!r} is not part of this pipeline; give one that was created with the group")
        pipelines = [pipeline] if pipeline is not None else list(self._pipelines)
        slots = {
            slot: max((one.frame_of(program.name) for one in pipelines), default=program.stack) for slot, program in self.programs.items()
        }
        return sizes_of(slots)

    def linked_into(self, pipeline: Any) -> None:
        """The group became part of a pipeline."""
        self._pipelines.add(pipeline)

    def check_data(self, data: Any) -> None:
        """Raises unless every program of the group can read `data`."""
        if data is not None and (structs.layout_of(data) is None or isinstance(data, type)):
            raise InvalidValueError(f"a record's data is an instance of an @ox.struct class, not {type(data).__name__}")
        # Only the calls of a pipeline tell which struct of a callable is its record's.
        if self.kind is not ProgramGroupKind.CALLABLES:
            for program in self.programs.values():
                check_layout(program.name, program.record, program.record_name, data)

    def __repr__(self) -> str:
        return f"<ProgramGroup {self.kind.name} {' '.join(program.name for program in self.programs.values())}>"


def check_layout(name: str, record: str | None, record_name: str | None, data: Any) -> None:
    """Raises unless `data` begins with the struct that the program reads; `record` is its layout, None if it reads none."""
    if record is None:
        return
    layout = structs.layout_of(data)
    if layout is None:
        raise InvalidValueError(f"{name} takes a {record_name} as its record's data; none was given")
    if not f"{layout.text};".startswith(f"{record};"):
        raise InvalidValueError(
            f"{name} takes a {record_name} ({record}) as its record's data, not a {type(data).__name__} ({layout.text})"
        )


class Record(Owned):
    """An SBT record: a group and its data. Assigning `data`, or a field of it, shows in the next launch."""

    def __init__(self, group: ProgramGroup, data: Any) -> None:
        self.group = group
        self._data: Any = None
        self._tables: list[weakref.ref[Any]] = []
        self.data = data

    @property
    def data(self) -> Any:
        return self._data

    @data.setter
    def data(self, data: Any) -> None:
        self.group.check_data(data)
        in_flight.keep(self._data)
        self._data = data
        if data is not None:
            structs.observe(data, self)
        self._tell()

    def __repr__(self) -> str:
        return f"<Record of {self.group!r}, data {self._data!r}>"

    def packed(self) -> bytearray:
        """The bytes that follow the header."""
        data: bytearray = self._data.packed() if self._data is not None else bytearray()
        return data

    def struct_changed(self, instance: Any) -> None:
        """The data changed in place."""
        if instance is self._data:
            self._tell()

    def watch(self, table: Any) -> None:
        """`table.record_changed(record)` is called from now on."""
        self._tables.append(weakref.ref(table))

    def _tell(self) -> None:
        for reference in self._tables:
            table = reference()
            if table is not None:
                table.record_changed(self)
