"""The header under libFuzzer, with address and undefined-behaviour sanitizers, beside an oracle of its own in GMP.

`python -m tests.tools.evidence.fuzz --seconds 3600` is the long run by hand: its corpus, minimised, replaces the kept
one, and its figures are kept beside those of the short form. Runs on the same header add up.
"""

from __future__ import annotations

import argparse
import base64
import hashlib
import itertools
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from tests.tools.evidence.battery import CORE
from tests.tools.evidence.parts import KEPT, Figures, Unavailable, kept, text_of
from tests.tools.evidence.seeds import write_seeds

TITLE = "Fuzzing of the compiled kernel"

FUZZING = Path(__file__).with_name("fuzzing")
CORPUS = FUZZING / "corpus.txt"
"""Inputs in base64, one a line."""

MOST_KEPT = 190_000
"""Bytes of that file; the longest inputs are left out of it."""

SHORT = 60
CLANG = ("clang-20", "clang-19", "clang-18", "clang")
OPTIONS = [
    *("-g", "-O2", "-w", "-std=gnu99", "-frounding-math"),
    *("-fsanitize=fuzzer,address,undefined", "-fno-sanitize-recover=all"),
]


def measure() -> Figures:
    """The kept corpus and some frozen vectors, then new inputs for a minute; the long run's figures stay."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        found = fuzzed(compiled(folder), folder, SHORT)
    return {"short": found, "by hand": kept().get("fuzz", {}).get("by hand")}


def compiled(folder: Path, core: Path = CORE) -> Path:
    """The fuzzer. Raises Unavailable where clang, its runtime or GMP is missing."""
    clang = next(filter(None, map(shutil.which, CLANG)), None)
    if clang is None:
        raise Unavailable("there is no clang")
    program = folder / "fuzzer"
    command = [clang, *OPTIONS, f"-I{core}", str(FUZZING / "fuzzer.c"), "-lgmp", "-lm", "-o", str(program)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise Unavailable(f"clang cannot make the fuzzer: {done.stderr.strip().splitlines()[0]}")
    return program


def fuzzed(program: Path, folder: Path, seconds: int) -> Figures:
    """Runs the fuzzer on the kept corpus and on each 60th frozen row, then on what it makes of them."""
    corpus, seeds = folder / "corpus", folder / "seeds"
    corpus.mkdir(exist_ok=True)
    seeds.mkdir(exist_ok=True)
    write_seeds(seeds, 60)
    for number, data in enumerate(corpus_kept()):
        (seeds / f"kept-{number}").write_bytes(data)
    command = [program, "-max_len=600", f"-max_total_time={seconds}", "-timeout=600", "-print_final_stats=1"]
    done = subprocess.run([*command, corpus, seeds], cwd=folder, capture_output=True, text=True, check=False)
    return figures_of(done.stdout, done.stderr)


def figures_of(said: str, log: str) -> Figures:
    """Executions, seconds and findings of a run, from what it printed."""
    lasted = re.search(r"Done \d+ runs in (\d+) second", log)
    wrong = re.findall(r"^WRONG: .*", said, re.MULTILINE)
    errors = re.findall(r"^==\d+== ?ERROR: .*|.*runtime error: .*", log, re.MULTILINE)
    said_wrong = [*wrong, *errors] or ([] if lasted else ["it ended before its time"])
    executed = re.search(r"stat::number_of_executed_units: (\d+)", log)
    return {
        "executions": int(executed[1]) if executed else 0,
        "seconds": int(lasted[1]) if lasted else 0,
        "findings": len(said_wrong),
        "first": said_wrong[:5],
    }


def minimised(program: Path, folder: Path) -> list[str]:
    """The smallest part of the corpus and of what it began with that covers as much, as lines of the kept file."""
    least = folder / "least"
    least.mkdir(exist_ok=True)
    subprocess.run(
        [program, "-merge=1", least, folder / "corpus", folder / "seeds"], cwd=folder, capture_output=True, check=True
    )
    lines = [base64.b64encode(path.read_bytes()).decode("ascii") for path in least.iterdir()]
    lines = sorted(lines, key=lambda line: (len(line), line))
    ends = itertools.accumulate(len(line) + 1 for line in lines)
    return [line for line, end in zip(lines, ends, strict=True) if end <= MOST_KEPT]


def corpus_kept() -> list[bytes]:
    """The inputs of the kept corpus."""
    return [base64.b64decode(line) for line in CORPUS.read_text(encoding="ascii").split()]


def with_earlier(found: Figures, earlier: Figures | None, of: str) -> Figures:
    """The figures of a long run on the header `of`, with those of earlier runs on the same header added."""
    if earlier and earlier.get("header") == of:
        sums = {name: found[name] + earlier[name] for name in ("executions", "seconds", "findings")}
        found = {**found, **sums, "first": [*earlier["first"], *found["first"]][:5]}
    return {**found, "header": of}


def header(core: Path = CORE) -> str:
    """What tells the header from another: the first digits of its SHA-256."""
    return hashlib.sha256((core / "hypcheck.h").read_bytes()).hexdigest()[:16]


def section(figures: Figures) -> str:
    """What was asked, for how long, and what came of it."""
    short, long = figures["short"], figures["by hand"]
    ran = f"`make evidence` runs it for a minute: {short['executions']:,} inputs, {_found(short)}."
    if long:
        hours = long["seconds"] / 3600
        ran += f" By hand it ran for {hours:.1f} hours on one header: {long['executions']:,} inputs, {_found(long)}."
    return f"""\
libFuzzer (clang) makes inputs from the frozen vectors and from a kept corpus (`fuzzing/corpus.txt`):
rows of 7 and of 10, scenes, sweeps and clearances, for every instruction set, rounding mode and question. The header is
compiled with address and undefined-behaviour sanitizers. Its answers are compared with an oracle in the fuzzer that
shares nothing with the kernel: det(S + λH) from the two matrices in GMP's integers, its roots separated by Sturm's
sequence, and Sylvester's criterion between them. For a sweep this oracle decides seven places and the place of the hit.
For a clearance it decides the spheroids that are scaled by each of the two bounds.

{ran}

Only the frozen vectors test scenes, sweeps and clearances whose exponents differ by more than 400, because the integers
of one such row take milliseconds.
"""


def _found(figures: Figures) -> str:
    return f"{figures['findings']} findings" if figures["findings"] else "no finding"


def main() -> int:
    """The long run; keeps its corpus and figures."""
    parser = argparse.ArgumentParser(prog="python -m tests.tools.evidence.fuzz", description=__doc__)
    parser.add_argument("--seconds", type=int, default=3600)
    seconds = parser.parse_args().seconds
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        program = compiled(folder)
        found = fuzzed(program, folder, seconds)
        CORPUS.write_text("\n".join(minimised(program, folder)) + "\n", encoding="ascii")
    figures = kept()
    figures["fuzz"]["by hand"] = with_earlier(found, figures["fuzz"].get("by hand"), header())
    KEPT.write_text(text_of(figures), encoding="utf-8")
    sys.stdout.write(f"{found}\n")
    return 1 if found["findings"] else 0


if __name__ == "__main__":
    sys.exit(main())
