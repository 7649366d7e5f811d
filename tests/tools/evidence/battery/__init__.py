"""A file of questions with their right answers, and a program in C that asks the header all of them."""

from __future__ import annotations

import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

from tests.tools.evidence.parts import ROOT, Unavailable

DRIVER = Path(__file__).with_name("driver.c")
CORE = ROOT / "hypcheck" / "kernel" / "core"
SECONDS = 60
OPTIONS = ("-std=gnu99", "-O2", "-Werror=incompatible-pointer-types", "-ffp-contract=off", "-DHYPCHECK_PLAIN")
"""Of the compiler: the same arithmetic on every machine."""


@dataclass(frozen=True)
class Outcome:
    """How a run of the driver ended: `what` is "right", "wrong", "crash" or "endless"; `says` is what it printed."""

    what: str
    says: str


def built(folder: Path, header: Path | None = None, *options: str) -> Path:
    """The driver, compiled with the header in the folder `header`, or hypcheck's. Raises Unavailable without cc."""
    compiler = shutil.which("cc")
    if compiler is None:
        raise Unavailable("there is no C compiler, cc")
    program = folder / "driver"
    command = [compiler, *OPTIONS, *options, f"-I{header or CORE}", DRIVER, "-lm", "-o", program]
    subprocess.run(command, check=True)
    return program


def asked(program: Path, questions: Path, mutant: int = 0, seconds: float = SECONDS) -> Outcome:
    """What the driver finds with a mutant; 0 is the header as it is."""
    try:
        done = subprocess.run(
            [program, questions, str(mutant)], capture_output=True, text=True, timeout=seconds, check=False
        )
    except subprocess.TimeoutExpired:
        return Outcome("endless", "")
    kinds = {0: "right", 1: "wrong"}
    return Outcome(kinds.get(done.returncode, "crash"), done.stdout.strip())
