"""Frames of compiled programs: what the C++ compiler wrote about stack usage, told apart by program.

Both compilers write lines `file:line[:column]:function<tab>bytes<tab>kind`, clang with mangled names. A program that was inlined has no
frame of its own: it is part of its caller's.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

SMALLEST_FRAME = 16


def read_frames(folder: Path) -> dict[str, int]:
    """Bytes of every function that the compiler's files in `folder` name."""
    frames: dict[str, int] = {}
    for path in sorted(folder.glob("*.su")):
        for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
            name, tab, rest = line.partition("\t")
            size = rest.split("\t", 1)[0]
            if tab and size.isdigit():
                frames[name] = max(int(size), frames.get(name, 0))
    return frames


def frames_of_programs(frames: dict[str, int], programs: Sequence[str]) -> dict[str, int]:
    """Bytes that a call of each program takes: its own functions and, counted for each, those that belong to no program."""
    owned: dict[str, list[str]] = {program: [name for name in frames if _belongs(name, program.strip("_"))] for program in programs}
    shared = sum(size for name, size in frames.items() if not any(name in names for names in owned.values()))
    return {program: max(SMALLEST_FRAME, _sum(frames, names) + shared) for program, names in owned.items()}


def _belongs(name: str, program: str) -> bool:
    variants = (program, f"run_{program}", f"{program}_lanes")
    return any(f"{len(variant)}{variant}" in name or f"::{variant}(" in name or f"::{variant}<" in name for variant in variants)


def _sum(frames: dict[str, int], names: Iterable[str]) -> int:
    return sum(frames[name] for name in names)
