"""The shader binding table: records laid out as the runtime reads them, packed once a pipeline, changed records again before a launch."""


from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from optixc.enums_program import ProgramGroupKind
from optixc.errors import InvalidValueError
from optixc.host import library, sbt_check
from optixc.host.groups import ProgramGroup, Record
from optixc.host.owned import Owned

HEADER_SIZE = 32
ALIGNMENT = 16


class ShaderBindingTable(Owned):
    """Raygen and exception record, lists of miss, hit group and callables records; None in a list is an empty record.

    Records, and so their data and arrays, live as long as the table.
    """

    def __init__(
        self,
        raygen: Record,
        miss: Sequence[Record | None] = (),
        hitgroup: Sequence[Record | None] = (),
        callables: Sequence[Record | None] = (),
        exception: Record | None = None,
    ) -> None:
        self.raygen = _take(raygen, ProgramGroupKind.RAYGEN, "raygen")
        self.exception = None if exception is None else _take(exception, ProgramGroupKind.EXCEPTION, "exception")
        self.miss = _take_all(miss, ProgramGroupKind.MISS, "miss")
        self.hitgroup = _take_all(hitgroup, ProgramGroupKind.HITGROUP, "hitgroup")
        self.callables = _take_all(callables, ProgramGroupKind.CALLABLES, "callables")
        self._ray_types: tuple[str, ...] = ()
        self._material_count: int | None = None
        self._packed: dict[int, _PackedTable] = {}
        for record in dict.fromkeys(self._records()):
            record.watch(self)

    @classmethod
    def from_materials(
        cls,
        raygen: Record,
        ray_types: Mapping[str, Record | None],
        materials: Sequence[Mapping[str, Record | None]],
        callables: Sequence[Record | None] = (),
        exception: Record | None = None,
    ) -> ShaderBindingTable:
        """A table laid out so that nobody has to count: `ray_types` names each ray type and gives its miss record, every material gives
        a hit group record (or None) a ray type.

        Trace ray type t with `sbt_offset=table.ray_type(t)`, `sbt_stride=table.stride`, `miss_sbt_index=table.ray_type(t)`; an instance
        of material m, or the m-th build input or SBT record of a single GAS, has `sbt_offset=table.instance_offset(m)`.
        """
        if not isinstance(ray_types, Mapping) or not ray_types:
            raise InvalidValueError("ray_types takes a dict of ray type names and their miss records, at least one")
        names = tuple(ray_types)
        if not isinstance(materials, Sequence):
            raise InvalidValueError(f"materials takes a list with a dict of records for each material, not {type(materials).__name__}")
        for number, material in enumerate(materials):
            if not isinstance(material, Mapping):
                raise InvalidValueError(f"materials[{number}] takes a dict of ray type names and records, not {type(material).__name__}")
            unknown = [name for name in material if name not in ray_types]
            if unknown:
                raise InvalidValueError(f"materials[{number}] has a record for {unknown[0]!r}, which is no ray type; there are {names}")
        hitgroup = [material.get(name) for material in materials for name in names]
        made = cls(raygen, list(ray_types.values()), hitgroup, callables, exception)
        made._ray_types, made._material_count = names, len(materials)
        return made

    def __repr__(self) -> str:
        counts = f"{len(self.miss)} miss, {len(self.hitgroup)} hitgroup, {len(self.callables)} callables"
        return f"<ShaderBindingTable {self.raygen.group!r}, {counts}{', exception' if self.exception is not None else ''}>"

    @property
    def stride(self) -> int:
        """The sbt_stride of traces: the number of ray types."""
        return len(self._ray_types)

    def ray_type(self, name: str) -> int:
        """The sbt_offset and miss_sbt_index of a ray type."""
        if name not in self._ray_types:
            raise InvalidValueError(f"this table has no ray type {name!r}; it has {self._ray_types or 'none: it was laid out by hand'}")
        return self._ray_types.index(name)

    def instance_offset(self, material: int) -> int:
        """The sbt_offset of instances of a material."""
        is_number = isinstance(material, int) and not isinstance(material, bool)
        if not is_number or material < 0 or (self._material_count is not None and material >= self._material_count):
            known = f"0 to {self._material_count - 1}" if self._material_count else "a number of at least 0"
            raise InvalidValueError(f"material is {known}, not {material!r}")
        return material * max(1, self.stride)

    def explain(self, pipeline: Any = None, traversable: Any = None) -> str:
        """Prints the table and gives its text: what each record runs, its bytes, and with a pipeline and a scene who reaches it."""
        text = sbt_check.explain(self, pipeline, traversable)
        print(text)
        return text

    def check(self, pipeline: Any, traversable: Any = None) -> list[str]:
        """What is wrong for the traces of this pipeline in this scene: records out of range, empty, of the wrong kind, with another
        payload. One sentence each, an empty list if all is well. Traces whose SBT arguments are not constant are not judged."""
        return sbt_check.problems(self, pipeline, traversable)

    @staticmethod
    def stride_of(section: Sequence[Record | None]) -> int:
        """Bytes from one record of a section to the next."""
        largest = max((len(record.packed()) for record in section if record is not None), default=0)
        return -(-(HEADER_SIZE + largest) // ALIGNMENT) * ALIGNMENT

    def record_changed(self, record: Record) -> None:
        """A record's data changed; it is packed again before the next launch of each pipeline."""
        for packed in tuple(self._packed.values()):
            packed.changed.append(record)

    def c_table(self, pipeline: Any) -> Any:
        """The runtime's view of this table for a pipeline, up to date; the pipeline must not be launched by another thread meanwhile."""
        packed = self._packed.get(pipeline.uid)
        if packed is None or (packed.changed and not packed.refresh()):
            # The table is told of changes from before the records are read.
            packed = self._packed[pipeline.uid] = _PackedTable(pipeline)
            try:
                packed.lay_out(self)
            except BaseException:
                self.forget(pipeline.uid)
                raise
        return packed.c_table

    def forget(self, uid: int) -> None:
        """Drops what was packed for a pipeline that is gone."""
        self._packed.pop(uid, None)

    def _records(self) -> list[Record]:
        sections = (self.raygen, self.exception, *self.miss, *self.hitgroup, *self.callables)
        return [record for record in sections if record is not None]


class _PackedTable:
    """The bytes of a table for one pipeline."""

    def __init__(self, pipeline: Any) -> None:
        self._pipeline = pipeline
        self._headers: dict[tuple[int, int], bytes] = {}
        self._places: dict[Record, list[tuple[memoryview, int]]] = {}
        self._memory: list[Any] = []
        self.changed: list[Record] = []
        self.c_table = library.ffi().new("OxrtShaderBindingTable*")

    def lay_out(self, sbt: ShaderBindingTable) -> None:
        """Writes all records; raises for one that this pipeline cannot run."""
        table = self.c_table
        table.raygenRecord, _ = self._section([sbt.raygen])
        if sbt.exception is not None:
            table.exceptionRecord, _ = self._section([sbt.exception])
        table.missRecords, table.missStride = self._section(sbt.miss)
        table.missCount = len(sbt.miss)
        table.hitgroupRecords, table.hitgroupStride = self._section(sbt.hitgroup)
        table.hitgroupCount = len(sbt.hitgroup)
        table.callableRecords, table.callableStride = self._section(sbt.callables)
        table.callableCount = len(sbt.callables)

    def refresh(self) -> bool:
        """Writes the data of the records that changed; False if one grew or shrank, so that the table must be laid out anew."""
        while self.changed:
            record = self.changed[-1]
            if not self._rewrite(record):
                return False
            self.changed.remove(record)
        return True

    def _rewrite(self, record: Record) -> bool:
        self._pipeline.check_record(record)
        data = record.packed()
        for section, offset in self._places.get(record, ()):
            place = section[offset + HEADER_SIZE :][: len(data)]
            if self._header(record.group, len(data)) != bytes(section[offset : offset + HEADER_SIZE]):
                return False
            place[:] = data
        return True

    def _section(self, records: Sequence[Record | None]) -> tuple[Any, int]:
        ffi = library.ffi()
        if not records:
            return ffi.NULL, 0
        stride = ShaderBindingTable.stride_of(records)
        memory = np.zeros(stride * len(records) + ALIGNMENT, np.uint8)
        start = -memory.ctypes.data % ALIGNMENT
        self._memory.append(memory)
        section = memory[start : start + stride * len(records)].data
        for number, record in enumerate(records):
            if record is None:
                continue
            self._pipeline.check_record(record)
            offset, data = number * stride, record.packed()
            section[offset : offset + HEADER_SIZE] = self._header(record.group, len(data))
            section[offset + HEADER_SIZE : offset + HEADER_SIZE + len(data)] = data
            self._places.setdefault(record, []).append((section, offset))
        return ffi.cast("void*", memory.ctypes.data + start), stride

    def _header(self, group: ProgramGroup, data_size: int) -> bytes:
        key = (id(group), data_size)
        known = self._headers.get(key)
        if known is None:
            known = self._headers[key] = self._pipeline.pack_header(group, data_size)
        return known


def _take(record: Any, kind: ProgramGroupKind, where: str) -> Record:
    if not isinstance(record, Record):
        raise InvalidValueError(f"{where} takes a record, group.record(data), not {type(record).__name__}")
    if record.group.kind is not kind:
        raise InvalidValueError(f"{where} takes a record of a {kind.name} group, not of a {record.group.kind.name} group")
    return record


def _take_all(records: Any, kind: ProgramGroupKind, where: str) -> tuple[Record | None, ...]:
    if isinstance(records, Record) or not isinstance(records, Sequence):
        raise InvalidValueError(f"{where} takes a list of records, not {type(records).__name__}")
    return tuple(None if one is None else _take(one, kind, f"{where}[{number}]") for number, one in enumerate(records))
