"""The C header of a compiled pipeline for its users: structs of launch parameters and SBT records, names of programs.

Every member has the type or layout that the shader sees, so that a C or C++ program fills the structs and passes their bytes. Vectors
and matrices are arrays of their scalar; arrays are a pointer and a shape. In C++ the structs are in a namespace of the pipeline, which is
open: one source file may include the headers of several pipelines, each with its `Params`.
"""

from __future__ import annotations

import re
from typing import assert_never

from optixc.codegen.cpp_pipeline import record_structs
from optixc.codegen.cpp_types import field_names, structs_within
from optixc.codegen.names import Scope, identifier, string_literal
from optixc.ir.layout import size_of
from optixc.ir.nodes import Pipeline
from optixc.ir.types import (
    Array,
    CoopVec,
    FixedArray,
    Matrix,
    Scalar,
    ScalarKind,
    Struct,
    Texture,
    Traversable,
    Tuple,
    Type,
    Vector,
    Void,
)


def emit_header(pipeline: Pipeline, name: str = "shaders") -> str:
    """The text of the header; `name` is the file's, for its guard and the prefix of its constants."""
    plain = identifier(re.sub(r"\W", "_", name))
    prefix = plain.upper()
    lines = [
        f"/* Structs and program names of the pipeline {name}, made by optixc. */",
        f"#ifndef {prefix}_H",
        f"#define {prefix}_H",
        "",
        "#include <stdbool.h>",
        "#include <stdint.h>",
        "",
    ]
    structs = _structs(pipeline)
    names = _struct_names(structs)
    if structs:
        lines += ["#ifdef __cplusplus", f"namespace optixc {{ namespace {plain} {{", "#endif", ""]
    for struct in structs:
        lines += _definition(struct, names)
    if structs:
        lines += ["#ifdef __cplusplus", "} }", f"using namespace optixc::{plain};", "#endif", ""]
    if pipeline.params is not None:
        lines += [f"enum {{ {prefix}_PARAMS_SIZE = {size_of(pipeline.params)} }};", ""]
    scope = Scope()
    for program in pipeline.programs:
        constant = scope.name(f"{prefix}_{identifier(program.name).upper()}")
        lines.append(f"#define {constant} {string_literal(program.name)}")
    return "\n".join([*lines, "", "#endif", ""])


def _structs(pipeline: Pipeline) -> list[Struct]:
    roots = [*((pipeline.params,) if pipeline.params is not None else ()), *record_structs(pipeline)]
    return list(dict.fromkeys(struct for root in roots for struct in structs_within(root)))


def _struct_names(structs: list[Struct]) -> dict[Struct, str]:
    scope = Scope()
    return {struct: scope.name(struct.name) for struct in structs}


def _definition(struct: Struct, names: dict[Struct, str]) -> list[str]:
    members = field_names(struct)
    fields = [f"    {_declaration(field.type, members[field.name], names)};" for field in struct.fields]
    return [f"typedef struct {names[struct]} {{", *fields, f"}} {names[struct]}; /* {size_of(struct)} bytes */", ""]


def _declaration(type_: Type, name: str, names: dict[Struct, str]) -> str:
    """A member's declaration."""
    match type_:
        case Scalar():
            return f"{_scalar(type_)} {name}"
        case Vector():
            return f"{_scalar(type_.element)} {name}[{type_.size}]"
        case Matrix():
            return f"float {name}[{type_.rows}][{type_.columns}]"
        case Struct():
            return f"{names[type_]} {name}"
        case FixedArray():
            return _declaration(type_.element, f"{name}[{type_.size}]", names)
        case Array():
            shape = f"uint64_t shape[{type_.rank}];"
            return f"struct {{ {_pointer(type_.element, names)}; {shape} }} {name}"
        case Traversable() | Texture():
            return f"uint64_t {name}"
        case CoopVec() | Tuple() | Void():
            raise AssertionError(f"{type_} has no place in memory")
    assert_never(type_)


def _pointer(element: Type, names: dict[Struct, str]) -> str:
    """The data member of an array."""
    match element:
        case Vector():
            return f"{_scalar(element.element)} (*data)[{element.size}]"
        case Matrix():
            return f"float (*data)[{element.rows}][{element.columns}]"
        case _:
            return _declaration(element, "*data", names)


def _scalar(scalar: Scalar) -> str:
    match scalar.kind:
        case ScalarKind.BOOL:
            return "bool"
        case ScalarKind.FLOAT:
            return {16: "uint16_t", 32: "float", 64: "double"}[scalar.bits]
        case ScalarKind.INT:
            return f"int{scalar.bits}_t"
        case ScalarKind.UINT:
            return f"uint{scalar.bits}_t"
    assert_never(scalar.kind)
