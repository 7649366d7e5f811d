"""What hypcheck.h costs on a processor: bytes of code, symbols that it asks of others, bytes of stack."""

from __future__ import annotations

import re
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tests.support.inside import generate
from tests.tools.processors.builds import HEADER_FOLDER, Build, run
from tests.tools.processors.jobs import stack_used

OF_THE_LIBRARY = ("memcpy", "memmove", "memset", "memcmp", "strcmp")
"""What the header may ask of a C library. What begins with two underlines is the compiler's own."""

PARTS = {
    "one row": ("hypcheck_position",),
    "rows and scenes": ("hypcheck_classify", "hypcheck_classify_scene"),
    "all": (),
}
"""What a program may use of the header, and the functions that keep it; none for all."""

UPRIGHT = ("hypcheck_ask", "hypcheck_ask_scene", "hypcheck_position", "hypcheck_classify", "hypcheck_classify_scene")
LEANING = (
    "hypcheck_ask_tilted",
    "hypcheck_ask_tilted_scene",
    "hypcheck_classify_tilted",
    "hypcheck_classify_tilted_scene",
    "hypcheck_prepare",
    "hypcheck_ask_prepared",
    "hypcheck_classify_columns",
    "hypcheck_passage_columns",
)


@dataclass(frozen=True)
class Cost:
    """What the header costs where stack is counted for upright and for leaning rows.

    `sizes` are bytes of code and constants by PARTS at -Os; `symbols` are those that the object asks of others; `used`
    are bytes of stack that were used, and `bounds`, where the compiler counts frames, those that any call can use.
    """

    sizes: dict[str, int]
    symbols: tuple[str, ...]
    used: tuple[int, int]
    bounds: tuple[int, int] | None

    @property
    def foreign(self) -> list[str]:
        """Symbols of neither the compiler nor the functions on memory: the header promises that there are none."""
        return [name for name in self.symbols if name not in OF_THE_LIBRARY and not name.startswith("_")]

    @property
    def too_deep(self) -> list[str]:
        """Where the stack is longer than the header says, or than the compiler counted."""
        found = []
        for place, name, said in zip((0, 1), ("upright", "leaning"), stated(), strict=True):
            most = max(self.used[place], self.bounds[place] if self.bounds else 0)
            if most > said:
                found.append(f"{name} rows take {most} bytes of stack; hypcheck.h says {said}")
        return found


def stated() -> tuple[int, int]:
    """The bytes of stack that the header says are enough, for upright rows and for leaning ones."""
    return 1024 * generate.kilobytes(), 1024 * generate.tilted_kilobytes()


def cost(build: Build, program: Path, rows: np.ndarray, leaning: np.ndarray, folder: Path) -> Cost:
    """What the build costs; rows (n, 7) and (n, 10) are those for which the stack is painted."""
    graph = folder / f"{build.name}-graph.o"
    source = folder / "header.c"
    source.write_text('#define HYPCHECK_IMPLEMENTATION\n#include "hypcheck.h"\n', encoding="utf-8")
    flags = [flag for flag in build.flags if flag != "-DBARE"]
    command = (build.compiler, *flags, f"-I{HEADER_FOLDER}", "-c", source, "-o", graph)
    run((*command, "-fcallgraph-info=su") if build.counts_stack else command, folder)
    bounds = None
    if build.counts_stack:
        frames = call_graph(graph.with_suffix(".ci").read_text(encoding="utf-8"))
        bounds = (deepest(frames, UPRIGHT), deepest(frames, LEANING))
    used = (stack_used(build, program, rows, folder), stack_used(build, program, leaning, folder))
    found = sizes(build, flags, source, folder)
    return Cost(found, symbols(build, graph, folder), used, bounds)


def symbols(build: Build, built: Path, folder: Path) -> tuple[str, ...]:
    """What the object asks of others; of WebAssembly, what the linked module imports."""
    if build.compiler == "clang":
        linked = folder / f"{build.name}-linked"
        return tuple(sorted(run(("node", "-e", _IMPORTS, linked), folder).split()))
    listed = run((build.tool("nm"), "-u", built), folder)
    return tuple(sorted(set(re.findall(r"U (\S+)", listed)) - {"_GLOBAL_OFFSET_TABLE_"}))


_IMPORTS = """
const module = new WebAssembly.Module(require("fs").readFileSync(process.argv[1]));
for (const each of WebAssembly.Module.imports(module)) console.log(each.name);
"""


def sizes(build: Build, flags: list[str], source: Path, folder: Path) -> dict[str, int]:
    """Bytes of code and constants by PARTS, at -Os, what is not used left out by the linker."""
    small = [flag for flag in flags if flag != "-O2"]
    target = folder / f"{build.name}-small.o"
    run((build.compiler, *small, *_SMALL, f"-I{HEADER_FOLDER}", "-c", source, "-o", target), folder)
    found = {}
    for name, kept in PARTS.items():
        linked = folder / f"{build.name}-linked"
        run(_linking(build, kept, target, linked), folder)
        found[name] = _bytes(build, linked, folder)
    return found


_SMALL = (
    "-Os",
    "-DHYPCHECK_PLAIN",
    "-ffunction-sections",
    "-fdata-sections",
    "-fno-asynchronous-unwind-tables",
    "-fno-pie",
)
_EVERY = (
    *UPRIGHT,
    *LEANING,
    "hypcheck_clearance",
    "hypcheck_passage",
    "hypcheck_use_level",
)


def _linking(build: Build, kept: tuple[str, ...], source: Path, target: Path) -> tuple[str | Path, ...]:
    names = kept or _EVERY
    if build.compiler == "clang":
        exports = tuple(f"--export={name}" for name in names)
        return ("wasm-ld", "--no-entry", "--gc-sections", "--allow-undefined", *exports, source, "-o", target)
    return (build.tool("ld"), "-r", "--gc-sections", *(f"--undefined={name}" for name in names), source, "-o", target)


def _bytes(build: Build, linked: Path, folder: Path) -> int:
    if build.compiler == "clang":
        return linked.stat().st_size
    last = run((build.tool("size"), linked), folder).splitlines()[-1].split()
    return int(last[0]) + int(last[1])


@dataclass(frozen=True)
class Frames:
    """The functions of an object: bytes of each one's frame, and what each calls."""

    sizes: dict[str, int]
    calls: dict[str, set[str]]


def call_graph(text: str) -> Frames:
    """What -fcallgraph-info=su wrote. A call by pointer may lead to any function of a level.

    Raises ValueError where the size of a frame is not known before the program runs.
    """
    found: dict[str, int] = {}
    calls: dict[str, set[str]] = defaultdict(set)
    for name, label in re.findall(r'node: \{ title: "([^"]+)" label: "([^"]*)"', text):
        frame = re.search(r"(\d+) bytes \(([\w,]+)", label)
        if frame and frame[2] not in ("static", "dynamic,bounded"):
            raise ValueError(f"the frame of {name} is {frame[2]}")
        found[_plain(name)] = int(frame[1]) if frame else 0
    for caller, called in re.findall(r'sourcename: "([^"]+)" targetname: "([^"]+)"', text):
        calls[_plain(caller)].add(_plain(called))
    by_pointer = {name for name in found if re.search(r"_(plain|sse2|avx2|avx512|neon)$", name)}
    calls["__indirect_call"] = by_pointer
    return Frames(found, dict(calls))


def _plain(title: str) -> str:
    return title.rpartition(":")[2]


def deepest(frames: Frames, roots: tuple[str, ...]) -> int:
    """The most bytes that a call of one of these functions can take; a ValueError where a function calls itself."""
    known: dict[str, int] = {}

    def depth(name: str, above: tuple[str, ...]) -> int:
        if name in above:
            raise ValueError(f"{name} calls itself")
        if name not in known:
            below = (depth(called, (*above, name)) for called in frames.calls.get(name, ()))
            known[name] = frames.sizes.get(name, 0) + max(below, default=0)
        return known[name]

    return max(depth(root, ()) for root in roots if root in frames.sizes)
