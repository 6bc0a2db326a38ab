"""Every block of Python in the README and on the pages under docs: shaders are compiled, host programs run, as they stand there.

A block that is a part of something has a beginning here (`BEFORE`); one without beginning must be whole.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import optixc as ox

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")), *sorted((ROOT / "examples").rglob("*.md"))]
BLOCKS = [
    (page, number, text)
    for page in PAGES
    for number, text in enumerate(re.findall(r"^```python\n(.*?)^```$", page.read_text(), re.MULTILINE | re.DOTALL))
]
BEFORE = {
    ("values.md", 0): "import optixc as ox\n\n@ox.struct\nclass Generator:\n    seed: ox.uint32\n",
    ("cooperative-vectors.md", 0): """import optixc as ox

@ox.struct
class Params:
    network: ox.Array[ox.uint8]

params = ox.launch_params(Params)
""",
    ("cooperative-vectors.md", 1): "weights = np.zeros(2048, np.uint8)\n",
}
PROGRAM = "\n\n@ox.program\ndef __raygen__of_the_page():\n    pass\n"


def test_there_are_blocks() -> None:
    assert len(BLOCKS) >= 5
    assert [key for key in BEFORE if not any((page.name, number) == key for page, number, _ in BLOCKS)] == []


@pytest.mark.parametrize(("page", "number", "text"), BLOCKS, ids=[f"{page.stem}-{number}" for page, number, _ in BLOCKS])
def test_block(page: Path, number: int, text: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = BEFORE.get((page.name, number), "") + text
    monkeypatch.chdir(tmp_path)
    context = ox.DeviceContext(threads=1)
    if re.search(r"^@ox\.", text, re.MULTILINE):
        (tmp_path / "shader.py").write_text(text + ("" if "def __raygen__" in text else PROGRAM))
        module = context.module_create(tmp_path / "shader.py")
        groups = [_group(context, module, name) for name in re.findall(r"def (__\w+?__\w+)\(", (tmp_path / "shader.py").read_text())]
        for lanes in (1, 16):
            context.pipeline_create(groups, simd=lanes)
        return
    if "import shader" in text:
        # The shader that the page shows before its host program.
        (tmp_path / "shader.py").write_text(next(other for where, at, other in BLOCKS if where == page and at == number - 1))
    monkeypatch.delitem(sys.modules, "shader", raising=False)
    monkeypatch.syspath_prepend(str(tmp_path))
    names: dict[str, Any] = {"ox": ox, "np": np, "ctx": context}
    exec(compile(text, f"{page.name}, block {number}", "exec"), names)
    sys.modules.pop("shader", None)
    if "triangle.png" in text:
        image = ox.read_image(tmp_path / "triangle.png")
        assert image[256, 256, :3].min() > 0.1 and image[5, 5, :3].max() == 0.0


def _group(context: ox.DeviceContext, module: ox.Module, name: str) -> ox.ProgramGroup:
    kind = name.split("__")[1]
    return context.program_group_create(**{kind: module[name]})
