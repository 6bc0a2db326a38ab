"""The rows of the comparison: a workload, its scenes, the hand-written forms that compete and the numbers asked of ours."""

from __future__ import annotations

from dataclasses import dataclass

from benchmarks.scenes import IMAGE_SIZE


@dataclass(frozen=True)
class Workload:
    """`share`: one strip of 16 rows out of `share` is rendered. Targets are (must, aim) as speed-up over the best scalar kernel."""

    name: str
    title: str
    source: str
    scalar_forms: tuple[str, ...]
    packet_forms: tuple[str, ...]
    scenes: tuple[str, ...]
    share: int
    must: dict[str, float]
    aim: dict[str, float]

    @property
    def launch_size(self) -> tuple[int, int]:
        """Width and height of the launch."""
        return IMAGE_SIZE, IMAGE_SIZE // self.share

    @property
    def skip(self) -> int:
        """Rows left out after every 16."""
        return 16 * (self.share - 1)


MESHES = ("sibenik", "sponza", "dragon")


def _all(scenes: tuple[str, ...], value: float) -> dict[str, float]:
    return dict.fromkeys(scenes, value)


WORKLOADS = (
    Workload(
        "primary", "primary rays, normal shading", "primary",
        ("primary_scalar",), ("primary_coherent", "primary_packet"),
        MESHES, 1,
        {"sibenik": 4.5, "sponza": 4.5, "dragon": 2.2}, {"sibenik": 5.5, "sponza": 5.5, "dragon": 2.5},
    ),
    Workload(
        "ambient_occlusion", "ambient occlusion, 16 rays", "ambient_occlusion",
        ("ambient_occlusion_scalar", "ambient_occlusion_scalar_ng"),
        (
            *("ambient_occlusion_packet", "ambient_occlusion_packet_ng", "ambient_occlusion_coherent"),
            *("ambient_occlusion_adaptive", "ambient_occlusion_samples", "ambient_occlusion_single"),
        ),
        MESHES, 4,
        {"sibenik": 1.8, "sponza": 1.8, "dragon": 1.15}, {"sibenik": 2.2, "sponza": 2.2, "dragon": 1.3},
    ),
    Workload(
        "path", "diffuse path tracer, depth 8, next event estimation", "path",
        ("path_scalar", "path_scalar_ng"), ("path_packet", "path_packet_ng", "path_shadow", "path_adaptive", "path_single"),
        MESHES, 4,
        _all(MESHES, 1.15), _all(MESHES, 1.3),
    ),
    Workload(
        "heavy", "the same with heavy shading", "path",
        ("heavy_scalar", "heavy_scalar_ng"), ("heavy_packet", "heavy_packet_ng", "heavy_single"),
        MESHES, 8,
        _all(MESHES, 1.7), _all(MESHES, 2.0),
    ),
    Workload(
        "whitted", "Whitted, custom spheres", "whitted",
        ("whitted_scalar",),
        ("whitted_packet", "whitted_coherent", "whitted_all_coherent", "whitted_adaptive", "whitted_single", "whitted_single_shadow"),
        ("spheres",), 1,
        {"spheres": 1.3}, {"spheres": 2.0},
    ),
    Workload(
        "cutouts", "alpha cut-outs, rejecting any-hit", "cutouts",
        ("cutouts_scalar", "cutouts_scalar_ng"),
        ("cutouts_packet", "cutouts_coherent", "cutouts_plain", "cutouts_single", "cutouts_single_shadow"),
        ("leaves",), 1,
        {"leaves": 1.1}, {"leaves": 1.3},
    ),
    Workload(
        "shapes", "primary rays, round curves and spheres", "shapes",
        ("shapes_scalar",), ("shapes_coherent", "shapes_packet"),
        ("hair", "points"), 1,
        {"hair": 0.9, "points": 0.95}, {"hair": 1.0, "points": 1.0},
    ),
)  # fmt: skip


def rows(only: list[str]) -> list[tuple[Workload, str]]:
    """The (workload, scene) pairs that `only` names as `workload` or `workload:scene`; all if it is empty."""
    every = [(workload, scene) for workload in WORKLOADS for scene in workload.scenes]
    if not only:
        return every
    known = {name for workload, scene in every for name in (workload.name, f"{workload.name}:{scene}")}
    for name in only:
        if name not in known:
            raise SystemExit(f"no such row: {name}; there are {', '.join(sorted(known))}")
    return [(workload, scene) for workload, scene in every if workload.name in only or f"{workload.name}:{scene}" in only]
