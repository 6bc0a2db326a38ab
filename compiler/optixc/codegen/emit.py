"""Which emitter writes a pipeline's C++: over lanes where they are asked for and the pipeline uses nothing that has no form there."""

from __future__ import annotations

from optixc.codegen import cpp_pipeline
from optixc.codegen.cpp_spmd_pipeline import SpmdFile, spmd_obstacle
from optixc.ir.nodes import Pipeline
from optixc.passes.features import Features


def emit(pipeline: Pipeline, features: Features) -> str:
    """The text of pipeline.cpp."""
    if emitted_lanes(pipeline) == 1:
        return cpp_pipeline.emit(pipeline, features)
    return SpmdFile(pipeline, features).text()


def emitted_lanes(pipeline: Pipeline) -> int:
    """Lanes of the emitted kernels: what the options ask for, or 1."""
    return 1 if pipeline.options.lanes > 1 and spmd_obstacle(pipeline) is not None else pipeline.options.lanes
