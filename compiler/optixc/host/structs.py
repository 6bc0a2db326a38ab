"""`@struct`, `@payload` and `@attributes`: classes of the author that have a C layout on both sides.

An instance always holds its bytes ready (`packed`), so that a launch copies and converts nothing: setting a field checks the value
and writes it. Whoever copied an instance's bytes (an outer struct, an SBT record) is told of every change.
"""

from __future__ import annotations

import inspect
import sys
import weakref
from collections.abc import Callable
from dataclasses import dataclass
from types import FrameType
from typing import Any, Protocol, TypeVar, dataclass_transform, overload

import numpy as np

from optixc.host import in_flight
from optixc.host.annotations import field_type
from optixc.host.fields import Buffer, FieldType, refuse

T = TypeVar("T")
Decorator = Callable[[type[T]], type[T]]
_READ, _WRITE = 1, 2
_SEMANTIC_SHIFTS = {"caller": 0, "ch": 2, "ms": 4, "ah": 6, "is": 8, "is_": 8}


class Observer(Protocol):
    """Somebody who copied a struct's bytes and wants to know when they change."""

    def struct_changed(self, instance: Any) -> None: ...


@dataclass(frozen=True)
class PayloadWord:
    """What `payload_word(...)` leaves in a payload class: the semantics bits of a field's words."""

    semantics: int


def payload_word(**access: str) -> Any:
    """Who reads and writes a payload field: `payload_word(caller="r", ch="w", ms="rw")`; keys caller, ch, ms, ah, is_."""
    bits = 0
    for key, letters in access.items():
        if key not in _SEMANTIC_SHIFTS:
            raise TypeError(f"payload_word takes caller, ch, ms, ah and is_, not {key!r}")
        if not isinstance(letters, str) or set(letters) - set("rw"):
            raise TypeError(f'payload_word({key}=...) takes "", "r", "w" or "rw", not {letters!r}')
        bits |= ((_READ if "r" in letters else 0) | (_WRITE if "w" in letters else 0)) << _SEMANTIC_SHIFTS[key]
    return PayloadWord(bits)


@dataclass(frozen=True)
class Field:
    """A field of a struct class."""

    name: str
    type: FieldType
    offset: int
    required: bool
    default: Any


@dataclass(frozen=True)
class Layout:
    """The fields of a struct class in memory; `text` is the form of `ir.layout.describe`."""

    fields: tuple[Field, ...]
    dtype: np.dtype[Any]
    alignment: int
    text: str


@dataclass(frozen=True)
class Origin:
    """Where a struct class was defined, and the numbers and classes that its annotations may have named if that was in a function."""

    file: str
    line: int
    names: dict[str, Any]


@dataclass(frozen=True)
class StructField:
    """A struct inside another; keeps the very instance it was given and follows its changes."""

    kind: type[Any]

    @property
    def layout(self) -> Layout:
        layout: Layout = self.kind.__optixc_layout__
        return layout

    @property
    def text(self) -> str:
        return f"{{{self.layout.text}}}"

    @property
    def dtype(self) -> np.dtype[Any]:
        return self.layout.dtype

    @property
    def alignment(self) -> int:
        return self.layout.alignment

    def default(self) -> Any:
        return self.kind(**{field.name: field.type.default() for field in self.layout.fields})

    def snapshot(self, value: Any) -> Any:
        """A copy that later changes of `value` do not reach, whatever it holds; it keeps the arrays that a copy of the bytes points to."""
        return self.kind(**{field.name: _snapshot(field.type, value.__dict__[field.name]) for field in self.layout.fields})

    def store(self, buffer: Buffer, offset: int, value: Any, where: str) -> Any:
        if isinstance(value, tuple | list):
            value = self.kind(*value)
        layout = getattr(type(value), "__optixc_layout__", None)
        if layout is None or layout.text != self.layout.text:
            raise refuse(where, f"a {self.kind.__name__}", value)
        buffer[offset : offset + self.dtype.itemsize] = value.packed()
        return value


class _Structure:
    """What struct classes inherit; fields live in the instance's dictionary, bytes in `_buffer`."""

    __optixc_layout__: Layout
    __optixc_kind__: str
    __optixc_origin__: Origin
    _buffer: bytearray
    _observers: list[weakref.ref[Any]]
    _complete_for: object
    """Who found that nothing is missing (see `array_uses`); forgotten at every change."""
    _pins: dict[str, weakref.ref[Any]]
    """numpy moves no memory of arrays that somebody refers to weakly, so that addresses in `_buffer` stay true."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        layout = self.__optixc_layout__
        name = type(self).__name__
        if len(args) > len(layout.fields):
            raise TypeError(f"{name} has {len(layout.fields)} fields, {len(args)} values were given")
        object.__setattr__(self, "_buffer", bytearray(layout.dtype.itemsize))
        object.__setattr__(self, "_observers", [])
        object.__setattr__(self, "_complete_for", None)
        object.__setattr__(self, "_pins", {})
        given = dict(zip((field.name for field in layout.fields), args, strict=False))
        for key in kwargs:
            if key in given:
                raise TypeError(f"{name} got two values for field {key!r}")
        given.update(kwargs)
        missing = [field.name for field in layout.fields if field.required and field.name not in given]
        if missing:
            raise TypeError(f"{name} needs a value for {', '.join(missing)}")
        unknown = given.keys() - {field.name for field in layout.fields}
        if unknown:
            raise TypeError(f"{name} has no field {', '.join(sorted(unknown))}; it has {', '.join(f.name for f in layout.fields)}")
        for field in layout.fields:
            # A default is one object for all instances; a struct among them may change.
            _set_field(self, field, given[field.name] if field.name in given else copy(field.default))

    def __setattr__(self, name: str, value: Any) -> None:
        field = next((field for field in self.__optixc_layout__.fields if field.name == name), None)
        if field is None:
            raise AttributeError(f"{type(self).__name__} has no field {name!r}")
        _set_field(self, field, value)
        if self._observers:
            _tell(self)

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"a field of {type(self).__name__} cannot be deleted; its bytes are part of the struct")

    def packed(self) -> bytearray:
        """The bytes of this struct, always up to date; do not write to them."""
        return self._buffer

    def struct_changed(self, instance: _Structure) -> None:
        """A struct held by a field changed: take its bytes over."""
        object.__setattr__(self, "_complete_for", None)
        for field in self.__optixc_layout__.fields:
            if self.__dict__.get(field.name) is instance:
                self._buffer[field.offset : field.offset + field.type.dtype.itemsize] = instance.packed()
        if self._observers:
            _tell(self)

    def __eq__(self, other: object) -> bool:
        return self._buffer == other._buffer if type(self) is type(other) and isinstance(other, _Structure) else NotImplemented

    __hash__ = None  # type: ignore[assignment]

    def __copy__(self) -> Any:
        return type(self)(**{field.name: self.__dict__[field.name] for field in self.__optixc_layout__.fields})

    def __reduce__(self) -> Any:
        return type(self), tuple(self.__dict__[field.name] for field in self.__optixc_layout__.fields)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray[Any, Any]:
        if dtype is not None and np.dtype(dtype) != self.__optixc_layout__.dtype:
            # numpy asks for this when a struct is assigned to an element of a structured array.
            name = type(self).__name__
            raise TypeError(f"a {name} becomes an array of {name}.dtype only; in `array[i] = x` write numpy.array(x)")
        return np.frombuffer(self._buffer, self.__optixc_layout__.dtype).copy().reshape(())

    def __repr__(self) -> str:
        inside = ", ".join(f"{field.name}={_short(self.__dict__[field.name])}" for field in self.__optixc_layout__.fields)
        return f"{type(self).__name__}({inside})"


def observe(instance: Any, observer: Observer) -> None:
    """From now on `observer.struct_changed(instance)` is called after every change; a dead observer is forgotten."""
    instance._observers.append(weakref.ref(observer))


def copy(value: T) -> T:
    """A new struct with the same field values, the only way to bind a second name to a struct in shaders; other values as they are."""
    made: T = value.__copy__() if isinstance(value, _Structure) else value
    return made


def layout_of(instance: object) -> Layout | None:
    """The layout of a struct instance or class, None for anything else."""
    return getattr(instance, "__optixc_layout__", None)


def _set_field(instance: _Structure, field: Field, value: Any) -> None:
    kept = field.type.store(instance._buffer, field.offset, value, f"{type(instance).__name__}.{field.name}")
    if isinstance(kept, _Structure):
        observe(kept, instance)
    elif isinstance(kept, np.ndarray):
        instance._pins[field.name] = weakref.ref(kept)
    values = instance.__dict__
    in_flight.keep(values.get(field.name))
    values[field.name] = kept
    values["_complete_for"] = None


def _snapshot(kind: FieldType, value: Any) -> Any:
    return kind.snapshot(value) if isinstance(kind, StructField) else value


def _tell(instance: _Structure) -> None:
    live = []
    for reference in instance._observers:
        observer = reference()
        if observer is not None:
            observer.struct_changed(instance)
            live.append(reference)
    instance._observers[:] = live


def _short(value: Any) -> str:
    return f"<array {value.dtype} {value.shape}>" if isinstance(value, np.ndarray) else repr(value)


@overload
def struct(cls: type[T]) -> type[T]: ...
@overload
def struct(cls: None = None) -> Decorator[T]: ...
@dataclass_transform()
def struct(cls: type[T] | None = None) -> type[T] | Decorator[T]:
    """A plain struct: launch parameters, SBT record data, local state."""
    return _decorate(cls, "struct", sys._getframe(1))


@overload
def payload(cls: type[T]) -> type[T]: ...
@overload
def payload(cls: None = None) -> Decorator[T]: ...
@dataclass_transform()
def payload(cls: type[T] | None = None) -> type[T] | Decorator[T]:
    """A ray payload: up to 32 words that travel in registers."""
    return _decorate(cls, "payload", sys._getframe(1))


@overload
def attributes(cls: type[T]) -> type[T]: ...
@overload
def attributes(cls: None = None) -> Decorator[T]: ...
@dataclass_transform()
def attributes(cls: type[T] | None = None) -> type[T] | Decorator[T]:
    """Intersection attributes: up to 8 words from an intersection program to hit programs."""
    return _decorate(cls, "attributes", sys._getframe(1))


def _decorate(cls: type[T] | None, kind: str, frame: FrameType) -> type[T] | Decorator[T]:
    names = dict(frame.f_locals)
    kept = {} if frame.f_locals is frame.f_globals else {name: one for name, one in names.items() if isinstance(one, int | type)}
    origin = Origin(frame.f_code.co_filename, frame.f_lineno, kept)
    if cls is None:

        def decorate(decorated: type[T]) -> type[T]:
            return _make(decorated, kind, names, origin)

        return decorate
    if not isinstance(cls, type):
        raise TypeError(f"@optixc.{kind} decorates a class, not {cls!r}")
    return _make(cls, kind, names, origin)


def _make(cls: type[T], kind: str, names: dict[str, Any], origin: Origin) -> type[T]:
    outer = next((base for base in cls.__mro__[1:] if issubclass(base, _Structure)), None)
    if outer is not None:
        raise TypeError(f"{cls.__name__}: @optixc.{kind} takes no class that inherits a struct; give it a field of type {outer.__name__}")
    layout = _layout(cls, names)
    body = {name: value for name, value in vars(cls).items() if name not in ("__dict__", "__weakref__")}
    for field in layout.fields:
        body.pop(field.name, None)
    body.update(__qualname__=cls.__qualname__, __optixc_layout__=layout, __optixc_kind__=kind, __optixc_origin__=origin)
    body.update(dtype=layout.dtype, nbytes=layout.dtype.itemsize)
    body["__match_args__"] = tuple(field.name for field in layout.fields)
    made: Any = type(cls.__name__, (_Structure, *(base for base in cls.__bases__ if base is not object)), body)
    made.__optixc_field__ = StructField(made)
    result: type[T] = made
    return result


def _layout(cls: type[Any], names: dict[str, Any]) -> Layout:
    """Evaluates the annotations (they may be text) and lays the fields out by the rules of C."""
    scope = {**vars(sys.modules[cls.__module__]), **names} if cls.__module__ in sys.modules else names
    offset, alignment = 0, 1
    fields: list[Field] = []
    for name, annotation in inspect.get_annotations(cls).items():
        resolved = eval(annotation, scope) if isinstance(annotation, str) else annotation
        try:
            type_ = field_type(resolved)
        except TypeError as error:
            raise TypeError(f"{cls.__name__}.{name}: {error}") from None
        offset = -(-offset // type_.alignment) * type_.alignment
        given = vars(cls).get(name, ...)
        required = given is ... or isinstance(given, PayloadWord)
        fields.append(Field(name, type_, offset, required, None if required else given))
        offset += type_.dtype.itemsize
        alignment = max(alignment, type_.alignment)
    size = -(-offset // alignment) * alignment
    dtype = np.dtype(
        {
            "names": [field.name for field in fields],
            "formats": [field.type.dtype for field in fields],
            "offsets": [field.offset for field in fields],
            "itemsize": size,
        }
    )
    text = ";".join(f"{field.name}:{field.type.text}@{field.offset}" for field in fields)
    return Layout(tuple(fields), dtype, alignment, text)
