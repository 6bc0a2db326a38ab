"""Runs the rewritten programs of a pipeline: rays, records, payloads, callables and exceptions, over the runtime's own traversal.

A trace goes to the runtime, which calls back for every program that the ray reaches; what those do is Python again. An error in a
program stops the traversal and comes out of the trace that led to it.
"""

from __future__ import annotations

import struct
import sys
from collections.abc import Callable
from typing import Any

from optixc.errors import LaunchFailureError
from optixc.frontend.checked import FunctionInstance
from optixc.host import library
from optixc.interpret import native, values
from optixc.interpret.frames import EndProgram, Frame, Thrown, fill, registers, update, word_types
from optixc.interpret.hit_objects import maker
from optixc.interpret.rewrite import Functions
from optixc.ir import types as t
from optixc.ir.intrinsics import Intrinsic
from optixc.ir.nodes import ParameterRole

HEADER_SIZE = 32
NO_PROGRAM = -1
STACK_OVERFLOW_CODE, TRACE_DEPTH_CODE = -1, -2
FLAG_STACK_OVERFLOW, FLAG_TRACE_DEPTH, FLAG_USER = 1, 2, 4
_RAY_FIELDS = ("tmin", "tmax", "time", "visibilityMask", "rayFlags", "sbtOffset", "sbtStride", "missIndex")


class Machine:
    """The programs of one pipeline. `params` is one object for all launches; its fields are set anew for each."""

    def __init__(
        self,
        programs: dict[int, FunctionInstance],
        params: t.Struct | None,
        max_trace_depth: int,
        exception_flags: int = 0,
        uses_motion: bool = False,
        uses_micromaps: bool = False,
    ) -> None:
        self.params = values.zero(params) if params is not None else None
        self._programs = programs
        self._max_trace_depth = max_trace_depth
        self._flags = exception_flags
        self.uses_motion = int(uses_motion)
        self.uses_micromaps = int(uses_micromaps)
        self._functions = Functions(self)
        self.helper = self._functions.helper
        self._frames: list[Frame] = []
        self._payload_types: list[t.Struct | None] = []
        self._error: BaseException | None = None
        self._interpreter: Any = None
        self._table: Any = None
        ffi = library.ffi()
        self._lib = library.lib()
        self._callback = ffi.callback("OxrtProgramCallback", self._reached)

    # ---- one launch index ---------------------------------------------------------------------------------------------------------

    def load_params(self, address: int) -> None:
        """Take over the launch parameters of the next launch."""
        if self.params is not None:
            fresh = values.load(self.params.TYPE, address)
            for field in self.params.TYPE.fields:
                setattr(self.params, field.name, getattr(fresh, field.name))

    def run(self, interpreter: Any, table: Any) -> None:
        """Run the ray generation program for the index that the interpreter is set to, or the exception program after a throw."""
        self._interpreter, self._table = interpreter, table
        self._frames, self._payload_types, self._error, self._is_thrown = [], [], None, False
        try:
            self._start(table.raygenRecord, 0)
        except Thrown:
            self._lib.oxrtInterpreterClear(interpreter)
            self._frames, self._is_thrown = [], False
            if table.exceptionRecord:
                self._start(table.exceptionRecord, 0)

    @property
    def callback(self) -> Any:
        """What the runtime calls for every program that a ray reaches."""
        return self._callback

    def _start(self, record: Any, slot: int) -> None:
        address = int(library.ffi().cast("uintptr_t", record))
        instance = self._programs[program_of(address, slot)]
        self._run(instance, Frame(record=address), self._arguments(instance, Frame(record=address)))

    # ---- programs -----------------------------------------------------------------------------------------------------------------

    def _run(self, instance: FunctionInstance, frame: Frame, arguments: list[Any]) -> Any:
        self._check_stack(0)
        self._frames.append(frame)
        try:
            return self._functions.run(instance, arguments)
        except EndProgram:
            return None
        finally:
            self._frames.remove(frame)
            if frame.hit_object is not None:
                self._lib.oxrtInterpreterFreeHitObject(self._interpreter, frame.hit_object)

    def _arguments(self, instance: FunctionInstance, frame: Frame, given: tuple[Any, ...] = ()) -> list[Any]:
        """The entry parameters by their roles; `given` are the ordinary ones of a callable."""
        if given and len(given) == len(instance.parameters):
            # The call passes the struct that stands for the record otherwise.
            return [values.copy(value) for value in given]
        rest = iter(given)
        arguments: list[Any] = []
        for parameter in instance.parameters:
            type_ = parameter.local.type
            match parameter.role:
                case ParameterRole.PAYLOAD:
                    frame.payload = values.from_words(type_, list(frame.words))
                    arguments.append(frame.payload)
                case ParameterRole.RECORD:
                    arguments.append(values.load(type_, frame.record + HEADER_SIZE))
                case ParameterRole.ATTRIBUTES:
                    words = [native.bind(f"get_attribute_{index}", (), t.UINT32)(frame.ray) for index in range(8)]
                    arguments.append(values.from_words(type_, words))
                case ParameterRole.VALUE:
                    arguments.append(values.copy(next(rest)))
        return arguments

    def _reached(self, _data: Any, ray: Any, _kind: int, program: int, record: Any) -> None:
        """The runtime's callback: a ray reached a program."""
        if self._error is not None:
            return
        instance = self._programs[program]
        if not self._takes_payload(instance):
            return
        frame = Frame(ray, int(library.ffi().cast("uintptr_t", record)), self._words)
        try:
            self._run(instance, frame, self._arguments(instance, frame))
        except Thrown:
            pass
        except BaseException as error:
            # It continues where the ray was traced.
            self._error = error
            self._lib.oxrtInterpreterThrow(self._interpreter, 0, library.ffi().NULL, 0)
        finally:
            frame.write_words()

    def _takes_payload(self, instance: FunctionInstance) -> bool:
        """Whether the program's payload class fits the trace's: the same words, or none."""
        wanted = next((one.local.type for one in instance.parameters if one.role is ParameterRole.PAYLOAD), None)
        carried = self._payload_types[-1]
        return wanted is None or (carried is not None and word_types(wanted) == word_types(carried))

    # ---- rays -----------------------------------------------------------------------------------------------------------------------

    def trace(self, name: str, ray: tuple[Any, ...], type_: t.Struct | None, payload: Any) -> None:
        """trace, traverse or invoke with a payload struct, which changes in place."""
        words = registers()
        if type_ is not None:
            fill(words, values.to_words(type_, payload))
        self._trace(name, ray, type_, words)
        if type_ is not None:
            update(payload, words)

    def trace_words(self, name: str, ray: tuple[Any, ...], types: tuple[t.Type, ...], given: tuple[Any, ...]) -> tuple[Any, ...]:
        """The tuple form of a payload."""
        type_ = t.Struct("PayloadWords", t.StructKind.PAYLOAD, tuple(t.StructField(f"w{i}", item) for i, item in enumerate(types)))
        payload = values.struct_class(type_)(*given)
        self.trace(name, ray, type_, payload)
        return tuple(getattr(payload, field.name) for field in type_.fields)

    def _trace(self, name: str, ray: tuple[Any, ...], type_: t.Struct | None, words: Any) -> None:
        if name == "invoke" and native.bind("hit_object_is_nop", (), t.BOOL)(self.hit_object_state()):
            return
        if name != "traverse" and len(self._payload_types) >= self._max_trace_depth:
            self._too_deep()
        if self._flags & FLAG_TRACE_DEPTH and ray and self._lib.oxrtInterpreterIsTooDeep(self._interpreter, ray[0]):
            self._throw(TRACE_DEPTH_CODE, [])
        self._check_stack(ray[0] if ray else 0)
        frame = self._frames[-1]
        self._payload_types.append(type_)
        outer, self._words = getattr(self, "_words", None), words
        try:
            match name:
                case "trace":
                    self._lib.oxrtInterpreterTrace(self._interpreter, self._ray_arguments(ray), words)
                    if frame.hit_object is not None:
                        native.bind("make_nop_hit_object", (), t.VOID)(frame.hit_object)
                case "traverse":
                    self._lib.oxrtInterpreterTraverse(self._interpreter, self.hit_object_state(), self._ray_arguments(ray), words)
                case _:
                    self._lib.oxrtInterpreterInvoke(self._interpreter, self.hit_object_state(), words)
        finally:
            self._payload_types.pop()
            self._words = outer
        self._raise_pending()

    def _ray_arguments(self, ray: tuple[Any, ...]) -> Any:
        """The runtime's form of trace()'s arguments: handle, origin, direction, tmin ..."""
        arguments = library.ffi().new("OxrtRayArguments*")
        arguments.handle = ray[0]
        arguments.origin = tuple(ray[1])
        arguments.direction = tuple(ray[2])
        for name, value in zip(_RAY_FIELDS, ray[3:], strict=True):
            setattr(arguments, name, value)
        return arguments

    def _too_deep(self) -> None:
        if self._flags & FLAG_TRACE_DEPTH:
            self._throw(TRACE_DEPTH_CODE, [])
        raise LaunchFailureError(
            f"traces nest deeper than max_trace_depth = {self._max_trace_depth}; make the pipeline with a larger one"
        )

    def _check_stack(self, handle: int) -> None:
        """Threads of Python may have small stacks, and a trace calls back through C."""
        if self._lib.oxrtInterpreterHasStack(self._interpreter, handle):
            return
        if self._flags & FLAG_STACK_OVERFLOW:
            self._throw(STACK_OVERFLOW_CODE, [])
        raise LaunchFailureError(
            "the programs need more stack than this thread has; interpret in a thread with a larger one (threading.stack_size) (code -1)"
        )

    def _raise_pending(self) -> None:
        """After the runtime returned: what a program behind it raised goes on here."""
        error, self._error = self._error, None
        if error is not None:
            self._lib.oxrtInterpreterClear(self._interpreter)
            raise error
        if self._is_thrown:
            raise Thrown

    def report(self, types: tuple[t.Type, ...], distance: float, kind: int, *attributes: Any) -> bool:
        """report_intersection: an attributes struct, or words."""
        frame = self._frames[-1]
        words = [word for type_, value in zip(types[2:], attributes, strict=True) for word in values.to_words(type_, value)]
        frame.write_words()
        ffi = library.ffi()
        result = self._lib.oxrtInterpreterReport(frame.ray, distance, kind, ffi.new("uint32_t[]", words or [0]), len(words))
        frame.read_words()
        if self._error is not None or self._is_thrown or result == 2:
            raise EndProgram
        return bool(result)

    # ---- state of the running program ------------------------------------------------------------------------------------------------

    def ray_state(self) -> Any:
        """The ray in flight."""
        return self._frames[-1].ray

    def thread_state(self) -> Any:
        """The thread."""
        return self._lib.oxrtInterpreterThread(self._interpreter)

    def hit_object_state(self) -> Any:
        """The outgoing hit object of the running program; a nop at first."""
        frame = self._frames[-1]
        if frame.hit_object is None:
            frame.hit_object = self._lib.oxrtInterpreterNewHitObject(self._interpreter)
        return frame.hit_object

    def record(self, type_: t.Struct) -> Any:
        """get_sbt_data: the data of the record of the running program."""
        return values.load(type_, self._frames[-1].record + HEADER_SIZE)

    def hit_object_record(self, type_: t.Struct) -> Any:
        """The data of the record that invoke would use, zero for a nop."""
        state = self.hit_object_state()
        index = native.bind("hit_object_get_sbt_record_index", (), t.UINT32)(state)
        for test, section, stride, count in (
            ("hit_object_is_hit", self._table.hitgroupRecords, self._table.hitgroupStride, self._table.hitgroupCount),
            ("hit_object_is_miss", self._table.missRecords, self._table.missStride, self._table.missCount),
        ):
            if native.bind(test, (), t.BOOL)(state) and index < count:
                return values.load(type_, int(library.ffi().cast("uintptr_t", section)) + index * stride + HEADER_SIZE)
        return values.zero(type_)

    def payload_word(self, index: int) -> int:
        """get_payload_i."""
        frame = self._frames[-1]
        frame.write_words()
        return int(frame.words[index])

    def effect(self, row: Intrinsic) -> Callable[..., Any]:
        """A device function that does something, other than the forms that have rules of their own."""
        if row.name.startswith("set_payload_") and row.name != "set_payload_types":
            index = int(row.name.removeprefix("set_payload_"))
            return lambda word: self._set_payload_word(index, word)
        match row.name:
            case "ignore_intersection" | "terminate_ray":
                leave = self._lib.oxrtInterpreterIgnore if row.name == "ignore_intersection" else self._lib.oxrtInterpreterTerminate
                return lambda: self._leave_candidate(leave)
            case "set_payload_types" | "reorder":
                return lambda *_: None
        bound = maker(row, bool(self.uses_motion))
        return lambda *arguments: bound(self.hit_object_state(), *arguments)

    def _set_payload_word(self, index: int, word: int) -> None:
        frame = self._frames[-1]
        frame.write_words()
        frame.words[index] = word
        frame.read_words()

    def _leave_candidate(self, leave: Callable[[Any], None]) -> None:
        leave(self._frames[-1].ray)
        raise EndProgram

    # ---- callables, exceptions, print ------------------------------------------------------------------------------------------------

    def call_callable(self, is_direct: bool, result: t.Type, index: int, *arguments: Any) -> Any:
        """direct_call and continuation_call; a record without such a program gives zero."""
        record = self._lib.oxrtInterpreterCallableRecord(self._interpreter, index)
        address = int(library.ffi().cast("uintptr_t", record))
        number = program_of(address, 0 if is_direct else 1) if address else NO_PROGRAM
        if number == NO_PROGRAM:
            return values.zero(result)
        instance = self._programs[number]
        frame = Frame(record=address)
        return self._run(instance, frame, self._arguments(instance, frame, arguments))

    def throw(self, types: tuple[t.Type, ...], code: int, *details: Any) -> None:
        """throw_exception; without the USER exception flag it does nothing, as in OptiX."""
        if self._flags & FLAG_USER:
            self._throw(code, [word for type_, value in zip(types[1:], details, strict=True) for word in values.to_words(type_, value)])

    def _throw(self, code: int, details: list[int]) -> None:
        self._is_thrown = True
        self._lib.oxrtInterpreterThrow(self._interpreter, code, library.ffi().new("uint32_t[]", details or [0]), len(details))
        raise Thrown

    _is_thrown = False
    _words: Any = None

    def print(self, text: str) -> None:
        """print(): one line at once."""
        sys.stdout.write(text)


def program_of(record: int, slot: int) -> int:
    """The program number in a slot of a record header."""
    number: int = struct.unpack("<3i", bytes(library.ffi().buffer(library.ffi().cast("char*", record), 12)))[slot]
    return number
