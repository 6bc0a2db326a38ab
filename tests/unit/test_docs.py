"""What the README and the pages under docs say of this project is there: files, links, and the errors that they show."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from optixc.diagnostics import CompileError
from optixc.frontend.compile import compile_file

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
FOLDERS = [
    ROOT / folder
    for folder in (
        "",
        "compiler/optixc",
        "compiler/optixc/codegen",
        "compiler/optixc/frontend",
        "runtime_cpp/include",
        "runtime_cpp/include/oxrt",
        "runtime_cpp/src",
    )
]
SHADER = """import optixc as ox
from optixc import float3

@ox.payload
class Radiance:
    color: float3

@ox.program
def __closesthit__surface(ray: Radiance):
    if ox.get_primitive_index() == 0:
        ray.colour = float3(1.0, 0.0, 0.0)
    ox.ignore_intersection()
"""


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_links_lead_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\(([^)#\s]+)[^)]*\)", page.read_text()):
        if "://" not in target:
            assert (page.parent / target).exists(), target


def test_files_that_the_page_on_the_compiler_names() -> None:
    text = (ROOT / "docs" / "how_it_works.md").read_text()
    named = re.findall(r"`([a-z_0-9/]+(?:\*)?\.(?:py|h|cpp))`", text)
    assert len(named) > 20
    for name in named:
        assert any(list(folder.glob(name)) for folder in FOLDERS), name


def test_the_errors_that_the_readme_shows(tmp_path: Path) -> None:
    path = tmp_path / "shader.py"
    path.write_text(SHADER)
    with pytest.raises(CompileError) as caught:
        compile_file(str(path))
    shown = (ROOT / "README.md").read_text().replace("\n    ", "\n")
    assert str(caught.value).replace(f"{tmp_path}/", "") in shown
