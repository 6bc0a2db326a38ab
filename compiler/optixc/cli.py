"""The command `optixc`: compiles shader files ahead of time, prints what each stage made of them, tells what is installed.

Exit codes: 0 fine, 1 the shader has errors (all printed on standard error), 2 wrong usage, 3 the tool chain is missing or failed.
"""

from __future__ import annotations

import argparse
import ast
import io
import json
import os
import sys
from collections.abc import Sequence
from pathlib import Path

from optixc import driver, installation, toolchain
from optixc.api import DeviceContext
from optixc.cache import Cache, default_folder, max_size
from optixc.codegen.header import emit_header
from optixc.diagnostics import CompileError
from optixc.errors import FileIoError, InvalidValueError, OptixError
from optixc.frontend.compile import parse_tree
from optixc.frontend.print_types import print_types
from optixc.ir import layout, nodes
from optixc.ir.text import print_module
from optixc.ir.types import Struct, StructKind
from optixc.options import MAX_TRACE_DEPTH, TARGETS, BoundValue, CompileOptions
from optixc.passes.live_notes import live_notes
from optixc.passes.pipeline import LinkError, link
from optixc.version import __version__

EXIT_SHADER, EXIT_USAGE, EXIT_TOOLCHAIN = 1, 2, 3
EXIT_INTERRUPTED = 130  # as shells say it: 128 and the number of SIGINT
EMIT_FORMS = ("ast", "types", "ir", "cpp", "asm", "header")
_BEFORE_PASSES = ("ast", "types")


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command and gives its exit code."""
    parser = _parser()
    chosen = parser.parse_args(arguments)
    if isinstance(sys.stdout, io.TextIOWrapper):
        # What is printed holds names and texts of the shader, which a terminal's encoding may lack.
        sys.stdout.reconfigure(encoding="utf-8", errors="surrogateescape")
    try:
        if chosen.print_config:
            print(_configuration())
        elif chosen.shader is None:
            parser.error("name a shader file (or --version, --print-config)")
        else:
            _compile(chosen)
        sys.stdout.flush()
        return 0
    except CompileError as error:
        print(error, file=sys.stderr)
        return EXIT_SHADER
    except toolchain.ToolchainError as error:
        print(f"optixc: {error}", file=sys.stderr)
        return EXIT_TOOLCHAIN
    except OptixError as error:
        print(f"optixc: {error}", file=sys.stderr)
        return EXIT_USAGE
    except BrokenPipeError:
        # Whoever reads the output (`| head`) has seen enough; what is left must not fail when Python flushes it.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except OSError as error:
        # Only standard output is written without a name; a flush at the end of the process would fail once more.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        is_folder_gone = isinstance(error, FileNotFoundError)
        reason = "the current folder is gone" if is_folder_gone else f"standard output cannot be written: {error.strerror}"
        print(f"optixc: {reason}", file=sys.stderr)
        return EXIT_USAGE
    except KeyboardInterrupt:
        return EXIT_INTERRUPTED


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="optixc", description="Compiles shader programs in restricted Python to a shared object.")
    parser.add_argument("shader", nargs="?", type=Path, help="the shader file; it is parsed, never run")
    parser.add_argument(
        "-o",
        dest="output",
        metavar="STEM",
        help="write STEM.so, STEM.h and STEM.json (default: the shader's name); FOLDER/ keeps the shader's name, an ending .so may stay",
    )
    parser.add_argument("--emit", choices=EMIT_FORMS, help="print this form on standard output and write nothing")
    parser.add_argument(
        "--print-after", metavar="PASS", help=f"print the IR after this pass on standard output: {', '.join(driver.pass_names())}"
    )
    parser.add_argument("--bind", action="append", default=[], metavar="NAME=VALUE", help="make a launch parameter a constant")
    parser.add_argument(
        "-I", dest="include_dirs", action="append", default=[], type=Path, metavar="DIR", help="look for helper files here too"
    )
    parser.add_argument("--simd", choices=("auto", "1", "8", "16"), default="auto", help="lanes of a packet (default: auto)")
    parser.add_argument(
        "--target", choices=TARGETS, default="native", help="instruction set (default: this machine's); x86-64 takes kernels for each level"
    )
    parser.add_argument(
        "--math",
        choices=("precise", "fast"),
        default="precise",
        help="fast takes denormals as zero and fuses multiplications with additions (default: precise)",
    )
    parser.add_argument(
        "--max-trace-depth", type=int, default=1, metavar="N", help=f"nesting of traces, 0 to {MAX_TRACE_DEPTH} (default: 1)"
    )
    parser.add_argument("--debug", action="store_true", help="assertions, line information, no optimisation")
    parser.add_argument("--trap-nan", action="store_true", help="with --debug: the first float that becomes NaN ends the launch")
    parser.add_argument("--no-bounds-checks", action="store_true", help="let array indices out of range reach other memory")
    parser.add_argument(
        "-O", dest="optimization", type=int, choices=(0, 1, 2, 3), default=3, help="optimisation of the C++ compiler (default: 3)"
    )
    parser.add_argument("--depfile", type=Path, metavar="FILE", help="write the files that the output depends on, in make's form")
    parser.add_argument("--version", action="version", version=f"optixc {__version__}")
    parser.add_argument("--print-config", action="store_true", help="compilers, Embree, include folder, cache")
    return parser


def _compile(chosen: argparse.Namespace) -> None:
    if not chosen.shader.is_file():
        raise FileIoError(f"{chosen.shader} is not a file")
    if chosen.print_after is not None and chosen.emit in _BEFORE_PASSES:
        raise InvalidValueError(f"--print-after prints IR, which --emit {chosen.emit} does not make; leave one of them out")
    if chosen.emit == "ast":
        print(ast.dump(parse_tree(chosen.shader), indent=2))
        return
    options = CompileOptions(
        max_trace_depth=chosen.max_trace_depth,
        simd="auto" if chosen.simd == "auto" else int(chosen.simd),
        math=chosen.math,
        debug=chosen.debug,
        trap_nan=chosen.trap_nan,
        checks_bounds=not chosen.no_bounds_checks,
        target=chosen.target,
        optimization=chosen.optimization,
        bound_values=dict(_bound_value(text) for text in chosen.bind),
    )
    store = Cache(None, lambda text: print(f"optixc: warning: {text}", file=sys.stderr))
    unit = driver.open_file(chosen.shader, chosen.include_dirs, store)
    names = [program["name"] for program in unit.programs]
    if chosen.emit is not None or chosen.print_after is not None:
        _emit(chosen, unit, names, options, store)
    else:
        _write(chosen, unit, names, options, store)


def _emit(chosen: argparse.Namespace, unit: driver.Unit, names: list[str], options: CompileOptions, store: Cache) -> None:
    result = unit.result
    if chosen.print_after is not None and chosen.print_after not in driver.pass_names():
        raise InvalidValueError(f"--print-after takes one of {', '.join(driver.pass_names())}, not {chosen.print_after!r}")
    options = driver.variants(options)[-1]
    if chosen.emit == "types":
        print(print_types(result.checked))
        return
    if chosen.emit == "ir" and chosen.print_after is None:
        print(_print_ir(result.module, options))
        return
    emitted = driver.emit([result.module], names, options, lambda name, pipeline: _print_pass(chosen.print_after, name, pipeline))
    if chosen.emit == "asm":
        print(toolchain.compile_assembly(emitted.text, toolchain.find_compiler(store.memory), driver.recipe(options)))
    elif chosen.emit == "header":
        print(emit_header(emitted.pipeline, chosen.shader.stem))
    elif chosen.emit == "cpp":
        print(emitted.text)
    elif chosen.emit == "ir":
        print(print_module(emitted.pipeline, live_notes(emitted.pipeline)))


def _print_ir(module: nodes.Module, options: CompileOptions) -> str:
    """The module as text, with what is live at traces and programs if its programs are a pipeline of their own."""
    try:
        linked = link([module], [program.name for program in module.programs], driver.pipeline_options(options, module.params))
    except LinkError:
        return print_module(module)
    return print_module(module, live_notes(linked))


def _print_pass(wanted: str | None, name: str, pipeline: nodes.Pipeline) -> None:
    if name == wanted:
        print(print_module(pipeline, live_notes(pipeline)))


def _write(chosen: argparse.Namespace, unit: driver.Unit, names: list[str], options: CompileOptions, store: Cache) -> None:
    stem = _stem(chosen)
    # Whether the cache holds the result must not decide how the command ends.
    toolchain.find_compiler(store.memory)
    built = driver.build([unit], names, options, store)
    emitted = driver.emit([unit.result.module], names, driver.variants(options)[-1])
    outputs = [stem.with_name(stem.name + suffix) for suffix in (".so", ".h", ".json")]
    try:
        stem.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileIoError(f"{stem.parent} cannot be made: {error.strerror}") from error
    _put(outputs[0], Path(built.library).read_bytes())
    _put(outputs[1], emit_header(emitted.pipeline, stem.name).encode(errors="surrogateescape"))
    _put(outputs[2], (json.dumps(_manifest(unit, emitted.pipeline, built), indent=2) + "\n").encode())
    if chosen.depfile is not None:
        files = [str(chosen.shader), *unit.result.dependencies]
        line = f"{' '.join(map(_make_word, map(str, outputs)))}: {' '.join(map(_make_word, dict.fromkeys(files)))}\n"
        _put(chosen.depfile, os.fsencode(line))
    if outputs[0].with_suffix(".py").exists():
        print(
            f"optixc: warning: {outputs[0]} lies beside {outputs[0].with_suffix('.py').name}: Python's `import {stem.name}` would take it "
            "for an extension module; give -o another folder or name",
            file=sys.stderr,
        )


def _put(path: Path, content: bytes) -> None:
    """Writes a file whole or not at all: half of one would look finished to a build system, and a process may have the old one mapped."""
    target = path.resolve()
    fresh = target.parent / f".{target.name}.{os.getpid()}"
    try:
        if target.exists() and not target.is_file():
            target.write_bytes(content)
            return
        fresh.write_bytes(content)
        fresh.replace(target)
    except OSError as error:
        fresh.unlink(missing_ok=True)
        raise FileIoError(f"{path} cannot be written: {error.strerror}") from error


def _stem(chosen: argparse.Namespace) -> Path:
    """What the outputs are named after, without a suffix."""
    shader: Path = chosen.shader
    output: str | None = chosen.output
    if output is None or output.endswith("/"):
        return Path(output or "") / shader.stem
    stem = Path(output.removesuffix(".so"))
    if not stem.name or stem.name == "..":
        raise InvalidValueError(f"-o takes the path of the outputs without their suffix, not {output!r}")
    return stem


def _manifest(unit: driver.Unit, pipeline: nodes.Pipeline, built: driver.Built) -> dict[str, object]:
    return {
        "optixc": __version__,
        "params": built.params,
        "programs": unit.programs,
        "structs": {
            struct.name: {"size": layout.size_of(struct), "layout": layout.describe(struct)} for struct in _memory_structs(pipeline)
        },
        "max_trace_depth": pipeline.options.max_trace_depth,
        "lanes": pipeline.options.lanes,
        "compiler": built.report["compiler"],
        "features": built.report["features"],
        "dependencies": list(unit.result.dependencies),
    }


def _memory_structs(pipeline: nodes.Pipeline) -> list[Struct]:
    return [struct for struct in pipeline.structs if struct.kind is StructKind.PLAIN]


def _bound_value(text: str) -> tuple[str, BoundValue]:
    name, separator, value = text.partition("=")
    if not separator or not name.isidentifier():
        raise InvalidValueError(f"--bind takes NAME=VALUE, not {text!r}")
    try:
        parsed = ast.literal_eval(value)
    except (ValueError, SyntaxError) as error:
        raise InvalidValueError(f"--bind {name}: {value!r} is not a number, a bool or a tuple of them") from error
    bound: BoundValue = parsed
    return name, bound


def _make_word(path: str) -> str:
    return path.replace("\\", "\\\\").replace(" ", "\\ ").replace("#", "\\#").replace("$", "$$")


def _configuration() -> str:
    """What is installed, a line each; what is missing says so instead of failing."""
    lines = [f"optixc {__version__}"]
    try:
        # The one that is used comes first.
        found = dict.fromkeys([toolchain.find_compiler(), *toolchain.installed_compilers()])
        lines += [f"compiler: {one}" for one in found]
    except toolchain.ToolchainError as error:
        lines.append(f"compiler: {error}")
    lines.append(f"processor lanes: {toolchain.processor_lanes()}")
    for name, ask in (("include folder", installation.include_folder), ("library", installation.library_path)):
        try:
            lines.append(f"{name}: {ask()}")
        except OptixError as error:
            lines.append(f"{name}: {error}")
    lines += _embree_lines()
    lines.append(f"cmake package: {installation.cmake_folder()}")
    lines.append(f"cache: {default_folder()}, at most {max_size()} bytes" if max_size() else "cache: off (OPTIXC_CACHE_MAXSIZE=0)")
    return "\n".join(lines)


def _embree_lines() -> list[str]:
    path = installation.embree_path()
    try:
        info = DeviceContext().info()
    except OptixError as error:
        return [f"embree: {path or 'not found'}: {error}"]
    return [
        f"embree: {info['embree_version']} ({info['embree_path']})",
        f"embree instance levels: {info['embree_max_instance_levels']}, back-face culling: {info['embree_backface_culling']}",
        f"threads: {info['threads']}",
    ]


if __name__ == "__main__":
    sys.exit(main())
