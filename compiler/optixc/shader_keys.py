"""Keys of shader files for the cache: a file's text and place, the helpers that it imports, and what else decides the result."""

from __future__ import annotations

import os
from collections.abc import Sequence
from functools import cache
from pathlib import Path

from optixc.errors import FileIoError
from optixc.signed_json import digest
from optixc.version import __version__


def places(path: Path, include_dirs: Sequence[Path]) -> list[Path]:
    """The file and the folders, whatever the current folder will be."""
    return [path.absolute(), *(folder.absolute() for folder in include_dirs)]


def file_key(path: Path, include_dirs: Sequence[Path]) -> str:
    """The key of a file's own text, and of where its imports are looked for."""
    return digest("file", compiler_stamp(), *map(str, places(path, include_dirs)), _read(path))


def dependencies_key(key: str, dependencies: Sequence[str]) -> str | None:
    """The key of a file with the helpers it imports; None if one cannot be read any more."""
    try:
        return digest(key, *(part for path in dependencies for part in (path, Path(path).read_bytes())))
    except OSError:
        return None


@cache
def compiler_stamp() -> str:
    """Changes with every change of this package's own files: version, names, sizes and times."""
    root = os.path.dirname(__file__)
    found = [__version__]
    for folder in ("", "frontend", "ir", "passes", "codegen"):
        with os.scandir(os.path.join(root, folder)) as entries:
            for entry in sorted(entries, key=lambda entry: entry.name):
                if entry.name.endswith(".py"):
                    status = entry.stat()
                    found.append(f"{folder}/{entry.name}:{status.st_size}:{status.st_mtime_ns}")
    return digest("\n".join(found))


@cache
def headers_digest(include: Path) -> str:
    """Changes with the headers that generated C++ includes."""
    return digest(*(path.read_bytes() for path in sorted((include / "oxrt").glob("*.h"))))


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise FileIoError(f"{path} cannot be read: {error.strerror}") from error
