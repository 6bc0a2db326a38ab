"""Writes what follows from tables of the compiler: stubs for type checkers, tables of the language reference, the page of the shader
library.

`python docs/generate.py` writes the files, `--check` only says which are not up to date.
"""

from __future__ import annotations

import sys
from pathlib import Path

from device_stub import device_functions_stub, vector_types_stub
from stdlib_page import stdlib_page
from tables import device_functions_page, errors_page

_DOCS = Path(__file__).resolve().parent
_PACKAGE = _DOCS.parent / "compiler" / "optixc"


def generated() -> dict[Path, str]:
    """Path and text of every generated file."""
    return {
        _PACKAGE / "device_functions.pyi": device_functions_stub(),
        _PACKAGE / "host" / "vector_types.pyi": vector_types_stub(),
        _DOCS / "language" / "device-functions.md": device_functions_page(),
        _DOCS / "language" / "errors.md": errors_page(),
        _DOCS / "language" / "stdlib.md": stdlib_page(),
    }


def main() -> int:
    stale = [path for path, text in generated().items() if not path.is_file() or path.read_text() != text]
    for path in stale:
        print(f"{path.relative_to(_DOCS.parent)} {'is not up to date' if '--check' in sys.argv else 'written'}")
        if "--check" not in sys.argv:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(generated()[path])
    return 1 if stale and "--check" in sys.argv else 0


if __name__ == "__main__":
    sys.exit(main())
