"""Where the parts of this installation lie: headers, liboxrt, and the Embree that it shares with the embreex package."""

from __future__ import annotations

import importlib.machinery
import importlib.resources
import os
from pathlib import Path

from optixc.errors import LibraryNotFoundError

_SOURCE_TREE = Path(__file__).resolve().parents[2]


def include_folder() -> Path:
    """The folder to compile against: it holds `oxrt/oxrt.h`."""
    for folder in (_resource("include"), _SOURCE_TREE / "runtime_cpp" / "include"):
        if (folder / "oxrt" / "oxrt.h").is_file():
            return folder
    raise LibraryNotFoundError("the headers of optixc are missing from its installation; install it again with pip")


def library_path() -> Path:
    """The liboxrt of this installation."""
    path = _resource("lib") / "liboxrt.so"
    if path.is_file():
        return path
    raise LibraryNotFoundError(f"{path} is missing: this is a source tree without its compiled part; install it with `pip install .`")


def cmake_folder() -> Path:
    """The folder of OptixcConfig.cmake, for CMAKE_PREFIX_PATH or optixc_DIR."""
    return _resource("cmake")


def embree_path() -> str | None:
    """The libembree4 of the embreex package; None if OXRT_EMBREE names another or there is none (then the system's is taken)."""
    if os.environ.get("OXRT_EMBREE"):
        return None
    spec = importlib.machinery.PathFinder.find_spec("embreex")
    if spec is None or not spec.submodule_search_locations:
        return None
    package = Path(next(iter(spec.submodule_search_locations)))
    for folder in (package.with_name("embreex.libs"), package):
        for candidate in sorted(folder.glob("libembree4*.so*")):
            return str(candidate)
    return None


def _resource(name: str) -> Path:
    return Path(str(importlib.resources.files("optixc").joinpath(name)))
