"""The shader binding table: records laid out as the runtime reads them, packed once a pipeline, changed records again before a launch."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from typing import Any

import numpy as np

from optixc.enums_program import ProgramGroupKind
from optixc.errors import InvalidValueError
from optixc.host import library
from optixc.host.groups import ProgramGroup, Record

HEADER_SIZE = 32
ALIGNMENT = 16


class ShaderBindingTable:
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
        self._lock = threading.Lock()
        self._changed: set[Record] = set()
        self._packed: dict[int, _PackedTable] = {}
        for record in dict.fromkeys(self._records()):
            record.watch(self)

    def record_changed(self, record: Record) -> None:
        """A record's data changed; it is packed again before the next launch."""
        with self._lock:
            self._changed.add(record)

    def c_table(self, pipeline: Any) -> Any:
        """The runtime's view of this table for a pipeline, up to date."""
        if self._changed:
            self._refresh()
        packed = self._packed.get(pipeline.uid)
        if packed is None:
            packed = self._packed[pipeline.uid] = _PackedTable(self, pipeline)
        return packed.c_table

    def forget(self, uid: int) -> None:
        """Drops what was packed for a pipeline that is gone."""
        self._packed.pop(uid, None)

    def _refresh(self) -> None:
        with self._lock:
            changed, self._changed = self._changed, set()
        for uid, packed in list(self._packed.items()):
            if not all(packed.rewrite(record) for record in changed):
                del self._packed[uid]

    def _records(self) -> list[Record]:
        sections = (self.raygen, self.exception, *self.miss, *self.hitgroup, *self.callables)
        return [record for record in sections if record is not None]


class _PackedTable:
    """The bytes of a table for one pipeline."""

    def __init__(self, sbt: ShaderBindingTable, pipeline: Any) -> None:
        self._pipeline = pipeline
        self._headers: dict[tuple[int, int], bytes] = {}
        self._places: dict[Record, list[tuple[memoryview, int]]] = {}
        self._memory: list[Any] = []
        ffi = library.ffi()
        table = self.c_table = ffi.new("OxrtShaderBindingTable*")
        table.raygenRecord, _ = self._section([sbt.raygen])
        if sbt.exception is not None:
            table.exceptionRecord, _ = self._section([sbt.exception])
        table.missRecords, table.missStride = self._section(sbt.miss)
        table.missCount = len(sbt.miss)
        table.hitgroupRecords, table.hitgroupStride = self._section(sbt.hitgroup)
        table.hitgroupCount = len(sbt.hitgroup)
        table.callableRecords, table.callableStride = self._section(sbt.callables)
        table.callableCount = len(sbt.callables)

    def rewrite(self, record: Record) -> bool:
        """Writes a record's new data; False if it grew or shrank, so that the table must be laid out anew."""
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
        largest = max(len(record.packed()) if record is not None else 0 for record in records)
        stride = -(-(HEADER_SIZE + largest) // ALIGNMENT) * ALIGNMENT
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
