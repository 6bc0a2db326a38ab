"""What a shader binding table holds, in words, and what is wrong with it for a pipeline and a scene, before a launch."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from optixc.host.groups import Record
from optixc.host.sbt_reach import Place, places

_MOST_PROBLEMS = 50


def explain(sbt: Any, pipeline: Any | None, traversable: Any | None) -> str:
    """The table, a line a record: what it runs, its bytes, its data, and who reaches it where pipeline and scene are known."""
    reached = _reached(pipeline, traversable) if pipeline is not None and traversable is not None else {}
    lines = [f"raygen    {_record(sbt.raygen)}"]
    if sbt.exception is not None:
        lines.append(f"exception {_record(sbt.exception)}")
    lines += [f"miss[{number}]   {_record(one)}{_misses(pipeline, number)}" for number, one in enumerate(sbt.miss)]
    for number, one in enumerate(sbt.hitgroup):
        who = reached.get(number, ["nobody reaches it"] if reached else [])
        more = f" and {len(who) - 1} more" if len(who) > 1 else ""
        lines.append(f"hitgroup[{number}] {_record(one)}{f'  <- {who[0]}{more}' if who else ''}")
    lines += [f"callables[{number}] {_record(one)}" for number, one in enumerate(sbt.callables)]
    sections = (("miss", sbt.miss), ("hitgroup", sbt.hitgroup), ("callables", sbt.callables))
    strides = ", ".join(f"{name} {len(section)} x {sbt.stride_of(section)} bytes" for name, section in sections if section)
    return "\n".join([*lines, f"sections: {strides or 'raygen only'}"])


def problems(sbt: Any, pipeline: Any, traversable: Any | None) -> list[str]:
    """Sentences about records that some ray asks for and that are not there, empty, or of the wrong kind; empty if there are none."""
    found: dict[str, None] = {}
    for section, records in (("miss", sbt.miss), ("hitgroup", sbt.hitgroup), ("callables", sbt.callables)):
        found.update(dict.fromkeys(_strangers(pipeline, section, records)))
    for trace in pipeline.report().trace_uses:
        found.update(dict.fromkeys(_problems_of_miss(sbt, pipeline, trace)))
        if traversable is not None:
            for place in places(traversable):
                found.update(dict.fromkeys(_problems_of_hit(sbt, pipeline, trace, place)))
    if pipeline.report().calls_callables and not sbt.callables:
        found["the pipeline calls callables, and the table has no callables records"] = None
    if len(found) > _MOST_PROBLEMS:
        return [*list(found)[:_MOST_PROBLEMS], f"... and {len(found) - _MOST_PROBLEMS} more"]
    return list(found)


def _problems_of_hit(sbt: Any, pipeline: Any, trace: dict[str, Any], place: Place) -> Iterator[str]:
    if trace["sbt_offset"] is None or trace["sbt_stride"] is None:
        return
    number = place.index(trace["sbt_offset"], trace["sbt_stride"])
    who = f"{place.path}: the {trace['name']} at {trace['place']} (sbt_offset {trace['sbt_offset']}, sbt_stride {trace['sbt_stride']})"
    if number >= len(sbt.hitgroup):
        yield f"{who} needs hitgroup[{number}], and the table has {len(sbt.hitgroup)} hit group records"
        return
    record = sbt.hitgroup[number]
    if record is None:
        yield f"{who} needs hitgroup[{number}], which is empty"
        return
    slots = record.group.programs
    if place.kind == "custom primitives" and "intersection" not in slots:
        yield f"{who} needs hitgroup[{number}], whose group has no intersection program, so its custom primitives are never hit"
    if place.kind != "custom primitives" and "intersection" in slots:
        yield f"{who} needs hitgroup[{number}], whose intersection program {slots['intersection'].name} never runs for {place.kind}"
    yield from _mismatches(pipeline, record, f"hitgroup[{number}]", trace)


def _problems_of_miss(sbt: Any, pipeline: Any, trace: dict[str, Any]) -> Iterator[str]:
    number = trace["miss"]
    if number is None:
        return
    if number >= len(sbt.miss):
        yield f"the {trace['name']} at {trace['place']} needs miss[{number}], and the table has {len(sbt.miss)} miss records"
    elif sbt.miss[number] is not None:
        yield from _mismatches(pipeline, sbt.miss[number], f"miss[{number}]", trace)


def _mismatches(pipeline: Any, record: Record, name: str, trace: dict[str, Any]) -> Iterator[str]:
    """Programs that take another payload than the trace carries."""
    for program in record.group.programs.values():
        linked = pipeline.programs.get(program.name)
        if linked is not None and linked["payload"] is not None and linked["payload"] != trace["payload"]:
            carried = trace["payload_name"] or "no payload"
            yield (
                f"{name}: {program.name} takes a {linked['payload_name']}, and the {trace['name']} at {trace['place']} carries {carried}, "
                "so the program never runs for it"
            )


def _strangers(pipeline: Any, section: str, records: Sequence[Record | None]) -> Iterator[str]:
    for number, record in enumerate(records):
        for program in record.group.programs.values() if record is not None else ():
            if program.name not in pipeline.programs:
                yield f"{section}[{number}]: {program.name} is not in the pipeline; add its group to pipeline_create"


def _reached(pipeline: Any, traversable: Any) -> dict[int, list[str]]:
    found: dict[int, list[str]] = {}
    for place in places(traversable):
        for trace in pipeline.report().trace_uses:
            if trace["sbt_offset"] is not None and trace["sbt_stride"] is not None:
                number = place.index(trace["sbt_offset"], trace["sbt_stride"])
                found.setdefault(number, []).append(f"{place.path}, {trace['name']} at {trace['place']}")
    return found


def _misses(pipeline: Any | None, number: int) -> str:
    traces = pipeline.report().trace_uses if pipeline is not None else ()
    who = [f"{trace['name']} at {trace['place']}" for trace in traces if trace["miss"] == number]
    return f"  <- {', '.join(who)}" if who else ""


def _record(record: Record | None) -> str:
    if record is None:
        return "empty"
    names = ", ".join(f"{slot} {program.name}" for slot, program in record.group.programs.items())
    names = names or f"empty {record.group.kind.name} group"
    data = record.data
    return f"{names}; {len(record.packed())} bytes{f' {data!r:.60}' if data is not None else ''}"
