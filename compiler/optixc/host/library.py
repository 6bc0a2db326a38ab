"""liboxrt through cffi: the one header declares everything, the shared object comes with the package, errors become exceptions.

The library is opened when it is first needed.
"""

from __future__ import annotations

import os
import re
from functools import cache
from typing import Any

import cffi

from optixc.errors import InvalidDeviceContextError, LibraryNotFoundError, from_code
from optixc.installation import include_folder, library_path


def header_declarations(text: str) -> str:
    """What cffi reads of a header: no comments, no C++ blocks, no preprocessor lines, no export word."""
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
    text = re.sub(r"#ifdef __cplusplus.*?#endif", "", text, flags=re.DOTALL)
    return "\n".join(line for line in text.splitlines() if not line.lstrip().startswith("#")).replace("OXRT_API ", "")


@cache
def ffi() -> Any:
    """The declarations of oxrt.h and interpret.h."""
    made = cffi.FFI()
    for header in ("oxrt.h", "interpret.h"):
        made.cdef(header_declarations((include_folder() / "oxrt" / header).read_text(encoding="ascii")))
    return made


@cache
def lib() -> Any:
    """The opened liboxrt; its functions are attributes.

    All of them are looked up here. cffi does that under a lock that it also holds while it reads a declaration, and a destructor that the
    garbage collector runs at such a moment would wait for its own thread.
    """
    path = library_path()
    try:
        opened = ffi().dlopen(str(path))
    except OSError as error:
        raise LibraryNotFoundError(f"{path} cannot be loaded: {error}") from error
    for name in list(dir(opened)):
        getattr(opened, name)
    return opened


def check(result: int) -> None:
    """Raises the exception of a result code, with the runtime's sentence, unless it is success."""
    if result:
        raise from_code(result)(last_message())


def last_message() -> str:
    """The runtime's sentence about the last failure on this thread."""
    text: bytes = ffi().string(lib().oxrtGetLastErrorMessage())
    return text.decode("utf-8", "replace")


class _Process:
    """Counts forks: an object made before a fork knows a smaller number than the child."""

    generation = 0

    @classmethod
    def forked(cls) -> None:
        cls.generation += 1


os.register_at_fork(after_in_child=_Process.forked)


def process_generation() -> int:
    """A number that changes in a child of fork()."""
    return _Process.generation


def check_process(generation: int) -> None:
    """Raises if the calling process is a fork of the one in which an object was made."""
    if generation != _Process.generation:
        raise InvalidDeviceContextError(
            "this context was made before fork(): its threads and acceleration structures are not in this process. "
            "Make the DeviceContext in the child, or start workers with the spawn method"
        )
