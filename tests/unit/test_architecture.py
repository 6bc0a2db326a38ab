"""The arrows of the design: who may import whom, no imports inside functions, no files that say nothing, no file too long."""

from __future__ import annotations

import ast
from pathlib import Path

import optixc

ROOT = Path(optixc.__file__).parent
LAYERS = {
    "source": set(),
    "version": set(),
    "enums": set(),
    "errors": {"enums"},
    "coop_vec_layout": {"enums"},
    "float8": {"enums"},
    "installation": {"errors"},
    "options": {"enums", "errors"},
    "signed_json": set(),
    "shader_keys": {"errors", "signed_json", "version"},
    "cache": {"errors", "signed_json"},
    "stack_usage": set(),
    "toolchain": {"enums", "errors", "signed_json", "stack_usage"},
    "diagnostics": {"source", "errors", "enums"},
    "ir": {"source", "enums"},
    "frontend": {"ir", "source", "diagnostics", "errors", "enums", "coop_vec_layout"},
    "passes": {"ir", "source"},
    "codegen": {"ir", "source", "passes", "version", "enums"},
    "host": {"errors", "enums", "installation", "coop_vec_layout", "float8"},
    "interpret": {"ir", "host", "frontend", "source", "errors", "enums", "coop_vec_layout", "float8"},
    "driver": {
        "frontend",
        "passes",
        "codegen",
        "ir",
        "source",
        "cache",
        "shader_keys",
        "signed_json",
        "toolchain",
        "stack_usage",
        "options",
        "errors",
        "enums",
        "installation",
        "version",
    },
}
NO_NAMES = {"utils", "common", "helpers", "base", "manager", "misc"}


def layer(module: str) -> str:
    """The layer of `optixc.x.y`; enumerations in several files are one layer."""
    name = module.split(".")[1]
    return "enums" if name.startswith("enums") else name


def sources() -> list[Path]:
    return [path for path in sorted(ROOT.rglob("*.py")) if "stdlib" not in path.parts]


def imports(path: Path) -> list[str]:
    found = []
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            found += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            found += [f"{node.module}.{alias.name}" if node.module == "optixc" else node.module for alias in node.names]
    return sorted({name for name in found if name.startswith("optixc.")})


def test_arrows_go_down() -> None:
    wrong = []
    for path in sources():
        own = layer(".".join(["optixc", *path.relative_to(ROOT).with_suffix("").parts]))
        if own not in LAYERS:
            continue
        wrong += [f"{path.relative_to(ROOT)} imports {name}" for name in imports(path) if layer(name) not in LAYERS[own] | {own}]
    assert wrong == []


def test_only_the_top_is_free_to_import_anything() -> None:
    names = {layer(".".join(["optixc", *path.relative_to(ROOT).with_suffix("").parts])) for path in sources()}
    assert names - set(LAYERS) <= {"__init__", "api", "api_programs", "cli"}


def test_no_imports_inside_functions() -> None:
    wrong = []
    for path in sources():
        for function in ast.walk(ast.parse(path.read_text())):
            if isinstance(function, ast.FunctionDef):
                inner = [node for node in ast.walk(function) if isinstance(node, ast.Import | ast.ImportFrom)]
                wrong += [f"{path.relative_to(ROOT)}:{node.lineno}" for node in inner]
    assert wrong == []


def test_sizes_and_names() -> None:
    long_files = [str(path.relative_to(ROOT)) for path in sources() if len(path.read_text().splitlines()) > 450]
    long_functions = [
        f"{path.relative_to(ROOT)}:{node.lineno} {node.name}"
        for path in sources()
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.FunctionDef) and (node.end_lineno or 0) - node.lineno >= 60
    ]
    assert long_files == []
    assert long_functions == []
    assert [path for path in sources() if path.stem in NO_NAMES] == []
    assert [path for path in sources() if path.stat().st_size and not ast.get_docstring(ast.parse(path.read_text()))] == []
