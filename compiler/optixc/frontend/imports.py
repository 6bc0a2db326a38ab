"""Finding helper files: the importing file's folder, then the include folders, then `optixc.stdlib`; by path, nothing is executed."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from optixc.frontend.parse import ParsedFile, parse_path
from optixc.frontend.source_file import Diagnostics

STDLIB = Path(__file__).resolve().parent.parent / "stdlib"


class FileImports:
    """Reads each helper file once.

    `dependencies` lists the absolute paths of all files that were read, in order; `absent` those that were looked for and would have
    been taken instead.
    """

    def __init__(self, diagnostics: Diagnostics, include_dirs: tuple[Path, ...]) -> None:
        self.dependencies: list[str] = []
        self.absent: dict[str, None] = {}
        self._diagnostics = diagnostics
        self._include_dirs = include_dirs
        self._files: dict[Path, ParsedFile | None] = {}

    def add(self, path: Path, file: ParsedFile | None) -> None:
        """Make a file known that was read otherwise, so that files that import each other are read once."""
        self._files[path.resolve()] = file

    def find(self, importer: ParsedFile, module: str, level: int) -> ParsedFile | None:
        """The file that `import module` (or `from .module`, level 1) means; None where there is none or it has errors."""
        for candidate in self._candidates(importer, module, level):
            resolved = candidate.resolve()
            if resolved in self._files:
                return self._files[resolved]
            if candidate.is_file():
                self.dependencies.append(_spelled(candidate))
                self._files[resolved] = None
                self._files[resolved] = parse_path(candidate, self._diagnostics)
                return self._files[resolved]
            self.absent[str(candidate.absolute())] = None
        return None

    def why_not(self, importer: ParsedFile, module: str) -> str:
        """Why a module is not available, as the end of a sentence."""
        if module.lstrip(".").split(".")[0] in sys.stdlib_module_names:
            return "which is host code"
        folders = [str(importer.directory) or ".", *(str(folder) for folder in self._include_dirs)]
        return f"which is no shader file in {', '.join(folders)} or optixc.stdlib"

    def _candidates(self, importer: ParsedFile, module: str, level: int) -> list[Path]:
        parts = [part for part in module.split(".") if part]
        if level:
            return [path for folder in _own_folders(importer) for path in _paths(_above(folder, level - 1), parts)]
        if not parts:
            return []
        if parts[:2] == ["optixc", "stdlib"]:
            return _paths(STDLIB, parts[2:]) if parts[2:] else []
        if parts[0] == "optixc":
            return []
        found = [path for folder in (*_own_folders(importer), *self._include_dirs) for path in _paths(folder, parts)]
        if parts[0] not in sys.stdlib_module_names:
            found += _paths(STDLIB, parts)
        return found


def _spelled(path: Path) -> str:
    """The absolute path, without `..` where that names the same file: it must not depend on the folder that a command ran in."""
    plain = os.path.normpath(path.absolute())
    return plain if os.path.realpath(plain) == os.path.realpath(path) else str(path.absolute())


def _own_folders(importer: ParsedFile) -> list[Path]:
    """The folder of the importing file, and of the file that it is a link to."""
    path = Path(importer.source.path)
    return [importer.directory, path.resolve().parent] if path.is_symlink() else [importer.directory]


def _above(folder: Path, levels: int) -> Path:
    """The folder so many levels up; a relative one may lead out of the current folder."""
    for _ in range(levels):
        folder = folder.parent if folder.name not in ("", "..") else folder / ".."
    return folder


def _paths(folder: Path, parts: list[str]) -> list[Path]:
    """The files that a module's name may mean; no name means the package that the folder is."""
    place = folder.joinpath(*parts)
    return [place.with_suffix(".py"), place / "__init__.py"] if parts else [folder / "__init__.py"]
