"""Passes from IR to IR over one pipeline, and their order. Each is a function from a pipeline to a pipeline that keeps its meaning."""

from __future__ import annotations

from collections.abc import Callable

from optixc.ir.nodes import Pipeline
from optixc.passes.bound_loops import bound_loops
from optixc.passes.checks import explain_assertions, trap_nans
from optixc.passes.drop_dead_words import drop_dead_words
from optixc.passes.fold_constants import fold_constants
from optixc.passes.propagate import propagate_constants
from optixc.passes.remove_unused import remove_unused
from optixc.passes.specialize import specialize

PASSES: tuple[tuple[str, Callable[[Pipeline], Pipeline]], ...] = (
    ("specialize", specialize),
    ("fold_constants", fold_constants),
    ("propagate_constants", propagate_constants),
    ("explain_assertions", explain_assertions),
    ("trap_nans", trap_nans),
    ("drop_dead_words", drop_dead_words),
    ("remove_unused", remove_unused),
    ("bound_loops", bound_loops),
)


def run(pipeline: Pipeline, print_after: Callable[[str, Pipeline], None] | None = None) -> Pipeline:
    """The pipeline after all passes; `print_after(name, pipeline)` is called behind each."""
    for name, apply in PASSES:
        pipeline = apply(pipeline)
        if print_after is not None:
            print_after(name, pipeline)
    return pipeline
