"""Finding helper files: the importing file's folder, then the include folders, then `optixc.stdlib`; by path, nothing is executed."""

from __future__ import annotations

import sys
from pathlib import Path

from optixc.frontend.parse import ParsedFile, parse_path
from optixc.frontend.source_file import Diagnostics

STDLIB = Path(__file__).resolve().parent.parent / "stdlib"


class FileImports:
    """Reads each helper file once; `dependencies` lists the absolute paths of all files that were read, in order."""

    def __init__(self, diagnostics: Diagnostics, include_dirs: tuple[Path, ...]) -> None:
        self.dependencies: list[str] = []
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
                self.dependencies.append(str(candidate.absolute()))
                self._files[resolved] = None
                self._files[resolved] = parse_path(candidate, self._diagnostics)
                return self._files[resolved]
        return None

    def why_not(self, importer: ParsedFile, module: str) -> str:
        """Why a module is not available, as the end of a sentence."""
        if module.lstrip(".").split(".")[0] in sys.stdlib_module_names:
            return "which is host code"
        folders = [str(importer.directory) or ".", *(str(folder) for folder in self._include_dirs)]
        return f"which is no shader file in {', '.join(folders)} or optixc.stdlib"

    def _candidates(self, importer: ParsedFile, module: str, level: int) -> list[Path]:
        parts = [part for part in module.split(".") if part]
        if not parts:
            return []
        if level:
            folder = importer.directory
            for _ in range(level - 1):
                folder = folder.parent
            return _paths(folder, parts)
        if parts[:2] == ["optixc", "stdlib"]:
            return _paths(STDLIB, parts[2:]) if parts[2:] else []
        if parts[0] == "optixc":
            return []
        found = [path for folder in (importer.directory, *self._include_dirs) for path in _paths(folder, parts)]
        if parts[0] not in sys.stdlib_module_names:
            found += _paths(STDLIB, parts)
        return found


def _paths(folder: Path, parts: list[str]) -> list[Path]:
    return [folder.joinpath(*parts).with_suffix(".py"), folder.joinpath(*parts) / "__init__.py"]
