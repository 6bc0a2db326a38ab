"""Finding a C++ compiler and running it: C++ text in, shared object or assembly out.

A compiler is known by its real path, size and modification time, so that a look into the cache starts no process; its version is
asked once and remembered in the cache folder. This module knows nothing of shaders.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from optixc.enums_program import Result
from optixc.errors import InvalidValueError, OptixError
from optixc.signed_json import digest, signed, unsigned
from optixc.stack_usage import read_frames

MIN_CLANG = 16
MIN_GCC = 12
_GCC_WITHOUT_LIBRARY = 13
_CANDIDATES = ("clang++", *(f"clang++-{n}" for n in range(21, MIN_CLANG - 1, -1)), "g++", *(f"g++-{n}" for n in range(15, MIN_GCC - 1, -1)))
LANES_OF_TARGETS = {"x86-64": 1, "x86-64-v3": 8, "x86-64-v4": 16}
"""The levels of x86-64, each with the widest packet that it takes, the least first."""
_BASE_FLAGS = (
    "-std=c++20",
    "-ffp-contract=off",
    "-fwrapv",
    "-fno-math-errno",
    "-fno-trapping-math",
    "-fPIC",
    "-fno-exceptions",
    "-fno-rtti",
    "-fvisibility=hidden",
)
_FAST_MATH_FLAGS = ("-ffp-contract=fast", "-DOXRT_FAST_MATH")
_LOG_LINES = 30
_SYMBOL = "oxrt_pipeline_v1"
_PRECOMPILED = "headers"
_MOST_PRECOMPILED = 8
_QUIET = ("-w",)
"""Unknown pragmas and attributes of one compiler must not speak to users of the other; that generated code is clean is tested."""


class ToolchainError(OptixError):
    """No usable C++ compiler, or it refused our code; the text ends with the remedy or the compiler's first lines."""

    code = Result.ERROR_INTERNAL_COMPILER_ERROR


class NoCompilerError(ToolchainError):
    """No C++ compiler is installed, as far as PATH and OPTIXC_CXX tell."""

    def __init__(self) -> None:
        super().__init__(
            f"no C++ compiler found: install g++ {MIN_GCC} or newer (Debian: apt-get install g++) or clang++ {MIN_CLANG} or newer, "
            "or set OPTIXC_CXX to one"
        )


@dataclass(frozen=True)
class Compiler:
    """A C++ compiler on this machine; `kind` is "clang" or "gcc". `command` is what is run, `path` the real file behind it."""

    command: str
    path: str
    size: int
    mtime_ns: int
    kind: str
    version: tuple[int, ...]

    @property
    def identity(self) -> str:
        """What a cache key knows it by."""
        return f"{self.path}:{self.size}:{self.mtime_ns}"

    def __str__(self) -> str:
        return f"{self.kind} {'.'.join(map(str, self.version))} ({self.command})"


@dataclass(frozen=True)
class Build:
    """How to compile one text: instruction set, optimisation, floating point and debug information."""

    include: Path
    target: str = "native"
    optimization: int = 3
    fast_math: bool = False
    debug: bool = False

    def flags(self) -> tuple[str, ...]:
        level = 0 if self.debug else self.optimization
        return (
            *_BASE_FLAGS,
            *(_FAST_MATH_FLAGS if self.fast_math else ()),
            f"-O{level}",
            *(("-g",) if self.debug else ()),
            f"-march={native_target() if self.target == 'native' else self.target}",
            f"-I{self.include}",
        )


_WHOLE_VECTORS = {"clang": ("-mprefer-vector-width=512",), "gcc": ("-mmove-max=512", "-mstore-max=512")}
"""Lets structs of 16 lanes be copied in whole registers. Compilers copy them in halves, which the processor cannot forward to the load of
the whole that follows: Whitted's spheres gain 2.7 % (clang) and 14 % (g++), scalar code and other workloads are the same."""


def whole_vectors(kind: str, target: str = "native") -> tuple[str, ...]:
    """The flags for it of a kind of compiler, where the target has such registers."""
    return _WHOLE_VECTORS[kind] if processor_lanes(target) == 16 else ()


def _arguments(compiler: Compiler, build: Build) -> tuple[str, ...]:
    """What every run of this compiler for the build begins with."""
    return (*build.flags(), *whole_vectors(compiler.kind, build.target), *_QUIET)


def _libraries(compiler: Compiler) -> tuple[str, ...]:
    """What a shared object is linked to: libm. The linker need not read the C++ library, where the compiler can leave it out."""
    if compiler.kind == "clang":
        return ("-lm", "-nostdlib++", "-static-libgcc")
    return ("-lm", "-nostdlib++") if compiler.version >= (_GCC_WITHOUT_LIBRARY,) else ("-lm",)


def find_compiler(memory: Path | None = None) -> Compiler:
    """The compiler to use: OPTIXC_CXX, else the first clang++ of at least 16 or g++ of at least 12 on PATH.

    `memory` is a folder where versions are remembered between processes; None or an unwritable folder costs one process a start.
    """
    chosen = os.environ.get("OPTIXC_CXX", "")
    if chosen:
        path = shutil.which(chosen)
        if path is None:
            raise ToolchainError(f"OPTIXC_CXX names {chosen!r}, which is not an executable; set it to a clang++ or g++, or unset it")
        compiler = identify(path, memory)
        if compiler is None or not is_new_enough(compiler):
            raise ToolchainError(f"OPTIXC_CXX names {chosen!r}, which is not clang++ {MIN_CLANG} or newer or g++ {MIN_GCC} or newer")
        return compiler
    found = next(_usable(memory), None)
    if found is not None:
        return found
    raise NoCompilerError


def remembered_compilers(memory: Path | None) -> list[Compiler]:
    """Compilers that the folder `memory` knows from earlier processes, the last one first; they need not be there any more."""
    if memory is None:
        return []
    made = []
    for key, (kind, version) in reversed(_remembered(memory).items()):
        path, size, mtime_ns = key.rsplit(":", 2)
        made += [Compiler(path, path, int(size), int(mtime_ns), kind, tuple(version))] if kind else []
    return made


def installed_compilers(memory: Path | None = None) -> tuple[Compiler, ...]:
    """All usable compilers on PATH, the preferred one first, each real file once."""
    return tuple({compiler.path: compiler for compiler in _usable(memory)}.values())


def _usable(memory: Path | None) -> Iterator[Compiler]:
    for name in _CANDIDATES:
        path = shutil.which(name)
        compiler = identify(path, memory) if path else None
        if compiler is not None and is_new_enough(compiler):
            yield compiler


def is_new_enough(compiler: Compiler) -> bool:
    """Whether it knows the C++20 that generated code uses."""
    return compiler.version >= ((MIN_CLANG,) if compiler.kind == "clang" else (MIN_GCC,))


def identify(path: str, memory: Path | None = None) -> Compiler | None:
    """The compiler at `path`, or None if it is neither clang nor g++; runs `--version` only for a file never seen."""
    real = os.path.realpath(path)
    status = os.stat(real)
    key = f"{real}:{status.st_size}:{status.st_mtime_ns}"
    known = _remembered(memory).get(key)
    if known is None:
        known = _remembered(None).get(key) or _ask_version(path)
        _remember(memory, key, known)
    kind, version = known
    return Compiler(path, real, status.st_size, status.st_mtime_ns, kind, tuple(version)) if kind else None


def compile_shared(text: str, output: Path, compiler: Compiler, build: Build, memory: Path | None = None) -> dict[str, int]:
    """Compiles C++ text to a shared object and gives the bytes of each function's frame; `output` appears whole or not at all.

    With `debug` the text stays beside it. Precompiled headers are kept in the folder `memory`, if there is one.
    """
    with tempfile.TemporaryDirectory(prefix="optixc-", dir=output.parent) as folder:
        source = output.with_suffix(".cpp") if build.debug else Path(folder) / "pipeline.cpp"
        source.write_text(text, encoding="utf-8", errors="surrogatepass")
        made = Path(folder) / "pipeline.so"
        arguments = [*_arguments(compiler, build), "-fstack-usage", "-shared", str(source), "-o", str(made), *_libraries(compiler)]
        headers = _precompiled_headers(text, compiler, build, memory) if memory is not None else None
        try:
            _run(compiler, [*arguments, *(["-include-pch", str(headers)] if headers is not None else [])])
        except ToolchainError:
            if headers is None:
                raise
            # Another process may have dropped the file meanwhile.
            _run(compiler, arguments)
        frames = read_frames(made.parent)
        os.replace(made, output)
        return frames


def _precompiled_headers(text: str, compiler: Compiler, build: Build, memory: Path) -> Path | None:
    """The headers that the text includes, parsed once for all pipelines with these flags: clang reads them in a tenth of the time.

    None for g++, which gains nothing, and where the folder cannot be written.
    """
    includes = re.findall(r"^#include <oxrt/.*>$", text, re.MULTILINE)
    if compiler.kind != "clang" or not includes:
        return None
    # Headers that changed are others: their sizes and times are part of the name.
    stamps = [f"{path.name}:{path.stat().st_size}:{path.stat().st_mtime_ns}" for path in sorted((build.include / "oxrt").glob("*.h"))]
    folder = memory / _PRECOMPILED
    source = folder / f"{digest(compiler.identity, *build.flags(), *includes, *stamps)}.h"
    made, checksum = source.with_suffix(".pch"), source.with_suffix(".sum")
    with suppress(OSError, UnicodeDecodeError):
        # clang would believe damaged bytes.
        if checksum.read_text() == digest(made.read_bytes()):
            return made
    try:
        folder.mkdir(parents=True, exist_ok=True)
        oldest_first = sorted(folder.glob("*.pch"), key=lambda path: path.stat().st_mtime_ns)
        for old in oldest_first[: -_MOST_PRECOMPILED + 1]:
            for suffix in (".pch", ".sum", ".h"):
                old.with_suffix(suffix).unlink(missing_ok=True)
        source.write_text("\n".join(includes) + "\n")
        with tempfile.TemporaryDirectory(prefix="new-", dir=folder) as scratch:
            fresh = Path(scratch) / made.name
            # Without times: another process may write the same few lines again.
            flags = [*_arguments(compiler, build), "-fpch-instantiate-templates", "-Xclang", "-fno-pch-timestamp", "-x", "c++-header"]
            _run(compiler, [*flags, str(source), "-o", str(fresh)])
            stated = Path(scratch) / checksum.name
            stated.write_text(digest(fresh.read_bytes()))
            os.replace(fresh, made)
            os.replace(stated, checksum)
    except (OSError, ToolchainError):
        return None
    return made


def compile_variants(variants: Sequence[tuple[str, Build]], output: Path, compiler: Compiler) -> dict[str, int]:
    """As `compile_shared`, of several texts for one instruction set each, the least one first: the loader takes the last that runs."""
    with tempfile.TemporaryDirectory(prefix="optixc-", dir=output.parent) as folder:
        objects = []
        for number, (text, build) in enumerate(variants):
            source = Path(folder) / f"variant_{number}.cpp"
            source.write_text(text, encoding="utf-8", errors="surrogatepass")
            objects.append(str(source.with_suffix(".o")))
            names = [f"-D{_SYMBOL}=oxrt_variant_{number}", f"-DOXRT_ISA=isa_{re.sub('[^a-z0-9]', '_', build.target)}"]
            _run(compiler, [*_arguments(compiler, build), *names, "-fstack-usage", "-c", str(source), "-o", objects[-1]])
        joined, exports, made = (Path(folder) / name for name in ("pipeline.cpp", "exports.map", "pipeline.so"))
        joined.write_text(_joined(len(variants)), encoding="ascii")
        exports.write_text(f"{{ global: {_SYMBOL}; local: *; }};\n", encoding="ascii")
        link = ["-shared", f"-Wl,--version-script={exports}", str(joined), *objects, "-o", str(made), *_libraries(compiler)]
        _run(compiler, [*_arguments(compiler, variants[0][1]), *link])
        frames = read_frames(made.parent)
        os.replace(made, output)
        return frames


def _joined(count: int) -> str:
    """The one exported symbol for kernels of several object files."""
    names = [f"oxrt_variant_{number}" for number in range(count)]
    first = names[0]
    return f"""#include <oxrt/pipeline.h>
extern "C" const OxrtPipelineBinary {", ".join(names)};
static const OxrtPipelineVariant variants[] = {{{", ".join(f"{name}.variants[0]" for name in names)}}};
extern "C" __attribute__((visibility("default"))) const OxrtPipelineBinary {_SYMBOL} = {{
    {first}.abi, {count}, variants, {first}.paramsSize, {first}.maxTraceDepth, {first}.version}};
"""


def compile_assembly(text: str, compiler: Compiler, build: Build) -> str:
    """The assembly of C++ text, Intel syntax."""
    with tempfile.TemporaryDirectory(prefix="optixc-") as folder:
        source, made = Path(folder) / "pipeline.cpp", Path(folder) / "pipeline.s"
        source.write_text(text, encoding="utf-8", errors="surrogatepass")
        _run(compiler, [*_arguments(compiler, build), "-S", "-masm=intel", str(source), "-o", str(made)])
        return made.read_text(encoding="utf-8", errors="replace")


@cache
def processor() -> str:
    """This machine's processor as `-march=native` sees it: model and feature flags, one short text."""
    try:
        # One read gives the first processor's block; the whole file takes milliseconds on many cores.
        with open("/proc/cpuinfo", "rb", buffering=0) as file:
            block = file.read(8192).decode("ascii", "replace").split("\n\n", 1)[0]
    except OSError:
        return os.uname().machine
    wanted = ("vendor_id", "cpu family", "model\t", "stepping", "flags", "CPU part", "Features")
    return "\n".join(line for line in block.splitlines() if line.startswith(wanted)) or os.uname().machine


def native_target() -> str:
    """What "native" stands for: this machine's processor, or the lesser one that OXRT_MAX_ISA asks to work as."""
    wanted = os.environ.get("OXRT_MAX_ISA", "")
    if wanted and wanted not in LANES_OF_TARGETS:
        raise InvalidValueError(f"OXRT_MAX_ISA is {wanted!r}; set it to {', '.join(LANES_OF_TARGETS)}, or unset it")
    return wanted or "native"


def processor_lanes(target: str = "native") -> int:
    """The widest packet that the target's instruction set takes: 16 (AVX-512), 8 (AVX2) or 1."""
    target = native_target() if target == "native" else target
    if target in LANES_OF_TARGETS:
        return LANES_OF_TARGETS[target]
    words = processor().split()
    if all(word in words for word in ("avx512f", "avx512bw", "avx512dq", "avx512vl")):
        return 16
    return 8 if "avx2" in words else 1


def _run(compiler: Compiler, arguments: list[str]) -> None:
    try:
        # Compilers fail where TMPDIR names no folder; Python's choice exists.
        environment = {**os.environ, "TMPDIR": tempfile.gettempdir()}
        command = [compiler.command, *arguments]
        result = subprocess.run(command, capture_output=True, text=True, errors="replace", check=False, env=environment)
    except OSError as error:
        raise ToolchainError(f"{compiler.command} cannot be started: {error.strerror}; set OPTIXC_CXX to a working compiler") from error
    if result.returncode != 0:
        lines = result.stderr.strip().splitlines()[:_LOG_LINES]
        if result.returncode < 0:
            head = f"{compiler} was ended by signal {-result.returncode}; if memory ran out, compile with fewer lanes (simd=1)"
        else:
            head = f"{compiler} failed with exit code {result.returncode}; this is a bug of optixc unless the disk is full:"
        raise ToolchainError("\n".join([head, *lines]))


def _ask_version(path: str) -> _Version:
    try:
        output = subprocess.run([path, "--version"], capture_output=True, text=True, errors="replace", check=False, timeout=60).stdout
    except (OSError, subprocess.TimeoutExpired):
        return "", ()
    clang = re.search(r"clang version (\d+)\.(\d+)\.(\d+)", output)
    if clang:
        return "clang", tuple(map(int, clang.groups()))
    gcc = re.search(r"\b(\d+)\.(\d+)\.(\d+)\b", output.splitlines()[0]) if "Free Software Foundation" in output else None
    return ("gcc", tuple(map(int, gcc.groups()))) if gcc else ("", ())


_COMPILERS = "compilers.json"
_Version = tuple[str, tuple[int, ...]]
_versions: dict[Path | None, dict[str, _Version]] = {}
"""Known compilers by folder; under None what this process has seen."""


def _remembered(memory: Path | None) -> dict[str, _Version]:
    known = _versions.get(memory)
    if known is None:
        known = _versions[memory] = {}
        try:
            stored = unsigned(_COMPILERS, (memory / _COMPILERS).read_bytes()) if memory is not None else None
            known.update({key: (kind, tuple(version)) for key, (kind, version) in (stored or {}).items()})
        except OSError:
            known.clear()
    return known


def _remember(memory: Path | None, key: str, known: _Version) -> None:
    for place in {None, memory}:
        _remembered(place)[key] = known
    if memory is None:
        return
    try:
        memory.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=memory, prefix="new-", delete=False) as file:
            file.write(signed(_COMPILERS, _versions[memory]))
        os.replace(file.name, memory / _COMPILERS)
    except OSError:
        return
