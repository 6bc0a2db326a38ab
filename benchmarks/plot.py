"""A picture of the speed-ups; needs matplotlib, which only the extra `bench` installs."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import Any

from benchmarks.report import Results

HAS_MATPLOTLIB = importlib.util.find_spec("matplotlib") is not None
if HAS_MATPLOTLIB:
    from matplotlib.figure import Figure


def draw(results: Results, path: Path) -> bool:
    """Bars of ours and the best packet kernel over the best scalar kernel, and the targets; False without matplotlib."""
    if not HAS_MATPLOTLIB:
        return False
    threads = min(row.threads for row in results.rows)
    rows = [row for row in results.rows if row.threads == threads]
    figure: Any = Figure(figsize=(1.2 + 1.1 * len(rows), 4.8), layout="constrained")
    axes = figure.add_subplot()
    series: dict[str, list[float]] = {"hand-written packets": []}
    series |= {entry.name: [] for row in rows for entry in row.entries if entry.name.startswith("ours")}
    for row in rows:
        for name, values in series.items():
            entry = row.entry(row.best_packet if name == "hand-written packets" else name)
            values.append(entry.over_scalar if entry else 0.0)
    width = 0.8 / len(series)
    for number, (name, values) in enumerate(series.items()):
        axes.bar([i + (number + 0.5) * width - 0.4 for i in range(len(rows))], values, width, label=name)
    places = range(len(rows))
    axes.hlines([row.must for row in rows], [i - 0.42 for i in places], [i + 0.42 for i in places], colors="black", label="target")
    axes.axhline(1.0, color="gray", linewidth=0.8)
    axes.set_xticks(range(len(rows)), [f"{row.workload}\n{row.scene}" for row in rows], fontsize=8)
    axes.set_ylabel(f"speed over the best scalar kernel, {threads} thread{'s' if threads > 1 else ''}")
    axes.legend(fontsize=8)
    figure.savefig(path, dpi=120)
    return True
