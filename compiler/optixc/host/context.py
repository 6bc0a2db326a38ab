"""The runtime's context: options, log, ownership of everything made from it."""

from __future__ import annotations

import logging
import os
import sys
import traceback
import warnings
from collections.abc import Callable
from typing import Any, Self

from optixc.enums_program import DeviceProperty
from optixc.errors import InvalidDeviceContextError, InvalidValueError
from optixc.host import library
from optixc.host.owned import Owned
from optixc.host.properties import property_value
from optixc.host.whole_numbers import WORD_LIMIT, take_whole
from optixc.installation import embree_path

_PACKAGE = os.path.dirname(os.path.dirname(__file__)) + os.sep
LogCallback = Callable[[int, str, str], None]
LOG_FATAL, LOG_ERROR, LOG_WARNING, LOG_PRINT = 1, 2, 3, 4


class OptixcWarning(UserWarning):
    """Something works, though not as well as it could; the text says what to do."""


class Context(Owned):
    """Owns a runtime context; `validation` checks launches, `threads` bounds launches and builds (None: all cores of the process).

    `log_callback(level, tag, message)` gets what the runtime and the compiler have to say, levels 1 (fatal) to 4 (print). An exception
    inside is printed to standard error and nothing else happens. Without a callback warnings become Python warnings.
    As a context manager it destroys itself at the end of the block.
    """

    def __init__(
        self,
        validation: bool = False,
        log_callback: LogCallback | None = None,
        threads: int | None = None,
        log_level: int = LOG_PRINT,
    ) -> None:
        self._handle: Any = None
        count = 0 if threads is None else take_whole(threads, 1, WORD_LIMIT - 1, "threads is None or at least 1: it")
        if log_callback is not None and not callable(log_callback):
            raise InvalidValueError(f"log_callback must be callable, not {log_callback!r}")
        if isinstance(log_level, bool) or log_level not in range(5):
            raise InvalidValueError(f"log_level must be 0 to 4, not {log_level!r}")
        self.validation = bool(validation)
        self._log: tuple[LogCallback | None, int] = (log_callback, log_level)
        self._generation = library.process_generation()
        self._create(count)

    def _create(self, threads: int) -> None:
        ffi, lib = library.ffi(), library.lib()
        self._c_callback = ffi.callback("OxrtLogCallback", self._on_log)
        embree = embree_path()
        self._embree = ffi.NULL if embree is None else ffi.new("char[]", embree.encode())
        options = ffi.new("OxrtContextOptions*")
        options.logCallback = self._c_callback
        options.logCallbackLevel = self._log[1]
        options.validation = self.validation
        options.threads = threads
        options.embreePath = self._embree
        made = ffi.new("OxrtContext*")
        library.check(lib.oxrtContextCreate(options, made))
        self._handle = made[0]

    @property
    def handle(self) -> Any:
        """The runtime's context; raises after `destroy()` and in a forked child."""
        library.check_process(self._generation)
        if self._handle is None:
            raise InvalidDeviceContextError("this context was destroyed")
        return self._handle

    @property
    def is_alive(self) -> bool:
        """Whether objects of this context may still call the runtime."""
        return self._handle is not None and self._generation == library.process_generation()

    def info(self) -> dict[str, Any]:
        """Threads, Embree's version and path, and what of Embree's properties matters here."""
        ffi = library.ffi()
        made = ffi.new("OxrtContextInfo*")
        library.check(library.lib().oxrtContextGetInfo(self.handle, made))
        version = int(made.embreeVersion)
        return {
            "threads": int(made.threads),
            "embree_version": f"{version // 10000}.{version // 100 % 100}.{version % 100}",
            "embree_path": ffi.string(made.embreePath).decode(),
            "embree_max_instance_levels": int(made.embreeMaxInstanceLevels),
            "embree_backface_culling": bool(made.embreeBackfaceCulling),
            "isa": int(made.isa),
        }

    def set_log_callback(self, log_callback: LogCallback | None, level: int = LOG_PRINT) -> None:
        """Replaces the callback and the level, both at once; None for no callback, level 0 for silence."""
        if log_callback is not None and not callable(log_callback):
            raise InvalidValueError(f"log_callback must be callable or None, not {log_callback!r}")
        if isinstance(level, bool) or level not in range(5):
            raise InvalidValueError(f"the log level must be 0 to 4, not {level!r}")
        self._log = (log_callback, level)
        library.check(library.lib().oxrtContextSetLogCallback(self.handle, self._c_callback, library.ffi().NULL, level))

    def log(self, level: int, tag: str, message: str) -> None:
        """Says something: to the callback, else warnings and errors as Python warnings."""
        callback, highest = self._log
        if level > highest:
            return
        if callback is None:
            if level <= LOG_WARNING:
                warnings.warn(message, OptixcWarning, stacklevel=_level_of_caller())
            return
        try:
            callback(level, tag, message)
        except Exception:
            print("optixc: exception in a log callback, ignored:", file=sys.stderr)
            traceback.print_exc()

    def tell(self, level: int, tag: str, message: str) -> None:
        """Says something that the caller learns in another way too: to the callback only."""
        if self._log[0] is not None:
            self.log(level, tag, message)

    def get_property(self, wanted: DeviceProperty | int) -> int:
        """The value of a device property: limits and abilities."""
        _ = self.handle
        return property_value(wanted)

    def _on_log(self, level: int, tag: Any, message: Any, data: Any) -> None:
        text = library.ffi().string(message).decode("utf-8", "replace")
        if self._log[0] is not None:
            self.log(level, library.ffi().string(tag).decode("utf-8", "replace"), text)
        elif level == LOG_WARNING:
            # Errors reach the caller as exceptions. Warnings may be turned into such, which must not cross C; logging never raises.
            logging.getLogger("optixc").warning(text)

    def destroy(self) -> None:
        """Destroys the context and everything made from it; waits for launches. Nothing happens the second time."""
        handle, self._handle = self._handle, None
        if handle is not None and self._generation == library.process_generation():
            library.check(library.lib().oxrtContextDestroy(handle))

    def __repr__(self) -> str:
        return f"<{type(self).__name__}{' with validation' if self.validation else ''}{'' if self._handle is not None else ' destroyed'}>"

    def __enter__(self) -> Self:
        _ = self.handle
        return self

    def __exit__(self, *error: object) -> None:
        self.destroy()

    def __del__(self) -> None:
        if getattr(self, "_handle", None) is not None and not sys.is_finalizing():
            self.destroy()


def _level_of_caller() -> int:
    """The stack level, as `log` gives it to `warnings.warn`, of the line outside of this package that everything began with."""
    frame, level = sys._getframe(1), 1
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_PACKAGE):
        frame, level = frame.f_back, level + 1
    return level
