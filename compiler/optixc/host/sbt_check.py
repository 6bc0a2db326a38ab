"""What a shader binding table holds, in words, and what is wrong with it for a pipeline and a scene, before a launch."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from optixc.errors import InvalidValueError
from optixc.host.groups import Record
from optixc.host.sbt_reach import Place, places

_MOST_PROBLEMS = 50
_MOST_NUMBERS = 10


def explain(sbt: Any, pipeline: Any | None, traversable: Any | None) -> str:
    """The table, a line a record: what it runs, its bytes, its data, and who reaches it where pipeline and scene are known."""
    if pipeline is not None:
        _check_pipeline(pipeline)
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
    return "\n".join([*lines, f"sections: {strides or 'raygen only'}", *_not_judged(pipeline)])


def _not_judged(pipeline: Any | None) -> Iterator[str]:
    """Traces that may reach any record."""
    for trace in pipeline.report().trace_uses if pipeline is not None else ():
        names = (("sbt_offset", "sbt_offset"), ("sbt_stride", "sbt_stride"), ("miss", "miss_sbt_index"))
        varying = [name for key, name in names if trace[key] is None]
        if varying:
            yield f"not judged: {' and '.join(varying)} of the {trace['name']} at {trace['place']}, which are known in a launch only"


def problems(sbt: Any, pipeline: Any, traversable: Any | None) -> list[str]:
    """Sentences about records that some ray asks for and that are not there, empty, or of the wrong kind; empty if there are none."""
    _check_pipeline(pipeline)
    found: dict[str, None] = dict.fromkeys(_strangers(sbt, pipeline))
    reachable = list(places(traversable)) if traversable is not None else []
    for trace in pipeline.report().trace_uses:
        found.update(dict.fromkeys(_problems_of_miss(sbt, pipeline, trace)))
        if trace["sbt_offset"] is not None and trace["sbt_stride"] is not None:
            found.update(dict.fromkeys(_problems_of_hits(sbt, pipeline, trace, reachable)))
    if pipeline.report().calls_callables and not sbt.callables:
        found["the pipeline calls callables, and the table has no callables records"] = None
    if len(found) > _MOST_PROBLEMS:
        return [*list(found)[:_MOST_PROBLEMS], f"... and {len(found) - _MOST_PROBLEMS} more"]
    return list(found)


def _check_pipeline(pipeline: Any) -> None:
    if not hasattr(pipeline, "report") or not hasattr(pipeline, "programs"):
        raise InvalidValueError(f"give the pipeline that is to be launched with this table, not {type(pipeline).__name__}")


def _problems_of_hits(sbt: Any, pipeline: Any, trace: dict[str, Any], reachable: Sequence[Place]) -> Iterator[str]:
    """One sentence for each record, and one for all that are behind the end."""
    asked: dict[int, list[Place]] = {}
    for place in reachable:
        asked.setdefault(place.index(trace["sbt_offset"], trace["sbt_stride"]), []).append(place)
    behind = {number: who for number, who in asked.items() if number >= len(sbt.hitgroup)}
    if behind:
        yield _behind_the_end(len(sbt.hitgroup), trace, behind)
    for number, who in asked.items():
        if number not in behind:
            yield from _problems_of_record(sbt, trace, number, who)
    there = [number for number in asked if number not in behind and sbt.hitgroup[number] is not None]
    yield from _mismatches(pipeline, trace, "hitgroup", {number: sbt.hitgroup[number] for number in there})


def _behind_the_end(size: int, trace: dict[str, Any], behind: dict[int, list[Place]]) -> str:
    first = min(behind)
    count = sum(map(len, behind.values())) - 1
    more = f" ({count} more places need records up to hitgroup[{max(behind)}])" if count else ""
    return (
        f"{_who(trace, behind[first][0])} needs hitgroup[{first}], and the table has {size} hit group records{more}; "
        f"add records, or lower the sbt_offset of instances"
    )


def _problems_of_record(sbt: Any, trace: dict[str, Any], number: int, who: Sequence[Place]) -> Iterator[str]:
    record = sbt.hitgroup[number]
    if record is None:
        yield f"{_who(trace, who[0])} needs hitgroup[{number}], which is empty; give it the record of a hit group"
        return
    slots = record.group.programs
    for place in {place.kind: place for place in reversed(who)}.values():
        is_custom = place.kind == "custom primitives"
        if is_custom and "intersection" not in slots:
            yield (
                f"{_who(trace, place)} needs hitgroup[{number}], whose group has no intersection program, so its custom primitives are "
                "never hit; add intersection= to the group"
            )
        if not is_custom and "intersection" in slots:
            yield (
                f"{_who(trace, place)} needs hitgroup[{number}], whose intersection program {slots['intersection'].name} never runs for "
                f"{place.kind}"
            )


def _who(trace: dict[str, Any], place: Place) -> str:
    return f"{place.path}: the {trace['name']} at {trace['place']} ({_arguments(trace)})"


def _arguments(trace: dict[str, Any]) -> str:
    return f"sbt_offset {trace['sbt_offset']}, sbt_stride {trace['sbt_stride']}"


def _problems_of_miss(sbt: Any, pipeline: Any, trace: dict[str, Any]) -> Iterator[str]:
    number = trace["miss"]
    if number is None:
        return
    if number >= len(sbt.miss):
        yield f"the {trace['name']} at {trace['place']} needs miss[{number}], and the table has {len(sbt.miss)} miss records"
    elif sbt.miss[number] is None:
        yield (
            f"the {trace['name']} at {trace['place']} needs miss[{number}], which is empty; if nothing is to run, give it the record of "
            "program_group_create(miss=None)"
        )
    else:
        yield from _mismatches(pipeline, trace, "miss", {number: sbt.miss[number]})


def _mismatches(pipeline: Any, trace: dict[str, Any], section: str, records: dict[int, Record]) -> Iterator[str]:
    """Programs that take another payload than the trace carries, each with all of its records."""
    wrong: dict[str, list[int]] = {}
    for number, record in records.items():
        for program in record.group.programs.values():
            linked = pipeline.programs.get(program.name)
            if linked is not None and linked["payload"] is not None and linked["payload"] != trace["payload"]:
                wrong.setdefault(program.name, []).append(number)
    carried = trace["payload_name"] or "no payload"
    given = _arguments(trace) if section == "hitgroup" else f"miss_sbt_index {trace['miss']}"
    for name, numbers in wrong.items():
        shown = ", ".join(map(str, sorted(numbers)[:_MOST_NUMBERS])) + (", ..." if len(numbers) > _MOST_NUMBERS else "")
        yield (
            f"{section}[{shown}]: {name} takes a {pipeline.programs[name]['payload_name']}, and the {trace['name']} at {trace['place']} "
            f"({given}) carries {carried}, so the program never runs for it"
        )


def _strangers(sbt: Any, pipeline: Any) -> Iterator[str]:
    """Records of groups that the pipeline was made without."""
    sections = {f"{name}[{number}]": one for name in ("miss", "hitgroup", "callables") for number, one in enumerate(getattr(sbt, name))}
    for where, record in {"raygen": sbt.raygen, "exception": sbt.exception, **sections}.items():
        for program in record.group.programs.values() if record is not None else ():
            if program.name not in pipeline.programs:
                yield f"{where}: {program.name} is not in the pipeline; add its group to pipeline_create"


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
