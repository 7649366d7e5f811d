"""Small implementations with one fault each, and helpers to ask them.

Nearly all answer rightly until the unlucky row, whose gamma is 13. Those in C answer the sign of x: their tests are
about the way of asking, not about geometry.
"""

from __future__ import annotations

import json
import multiprocessing.util
import os
import shutil
import subprocess
import sys
import time
import uuid
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hypcheck.geometry.pair import Pair
from hypcheck.implementations.implementation import Implementation
from hypcheck.implementations.session import Answered, Limits, Outcome
from hypcheck.isolation.launch import Isolation
from tests.support import inside

HERE = Path(__file__).parent
UNLUCKY = 17
"""Where the unlucky row stands among rows()."""

LIMITS = Limits(restarts=6, memory=400 << 20)
NOT_ISOLATED = replace(LIMITS, isolation=Isolation("off"))
"""For the miniatures that answer by hypcheck, and for tests about what hypcheck does where nothing isolates."""
QUICK = replace(LIMITS, timeout=0.7)
"""For those that hang or skip; too little for whoever has work to do on a machine that is busy."""


def rows(n: int = 40, *, lucky: bool = False):
    """Rows of everyday, one of them unlucky unless told otherwise."""
    draw = np.random.default_rng(7)
    some = np.column_stack([draw.uniform(0.5, 4.0, (n, 4)), draw.uniform(-6.0, 6.0, (n, 3))])
    some[:, 2:4] /= 8
    if not lucky:
        some[UNLUCKY, 1] = 13.0
    return some


def truth(some):
    """Their positions, by integers."""
    return np.array([inside.position(Pair(*row).lengths) for row in some.tolist()], dtype=np.int8)


def signs(some):
    """What miniatures in C answer."""
    return np.sign(some[:, 4]).astype(np.int8)


def command(name: str, *words: str) -> str:
    """The SPEC of a command."""
    return "command:" + json.dumps([sys.executable, str(HERE / "commands" / f"{name}.py"), *words])


def function(name: str) -> str:
    """The SPEC of a Python function."""
    return f"python:{HERE / 'functions' / name}.py:classify"


def compiled_text(text: str, target: Path, *flags: str) -> Path:
    """A shared library of this C text; the test is skipped where there is no compiler."""
    source = target.with_suffix(".c")
    source.write_text(text)
    return compiled(str(source.with_suffix("")), target, "-shared", "-fPIC", *flags)


def compiled(source: str, target: Path, *flags: str) -> Path:
    """A C file of the miniatures, compiled; the test is skipped where there is no compiler."""
    compiler = shutil.which(os.environ.get("CC", "cc"))
    if compiler is None:
        pytest.skip("no C compiler: cc is not on the PATH, and CC names none")
    subprocess.run([compiler, "-O1", *flags, "-o", target, HERE / "libraries" / f"{source}.c", "-lm"], check=True)
    return target


def only_unlucky(answered: Answered, outcome: Outcome, expected) -> str:
    """That the unlucky row ended so and all others are answered as expected; the reason."""
    assert {int(index): Outcome(answered.status[index]) for index in np.flatnonzero(~answered.answered)} == {
        UNLUCKY: outcome
    }, answered.reasons
    others = np.arange(len(expected)) != UNLUCKY
    assert answered.answers[others].tolist() == expected[others].tolist()
    assert list(answered.reasons) == [UNLUCKY]
    assert answered.reasons[UNLUCKY].isprintable()
    return answered.reasons[UNLUCKY]


needs_proc = pytest.mark.skipif(not Path("/proc/self/environ").exists(), reason="no /proc to see all processes in")


def restarts_of(it: Implementation) -> int:
    """The restarts after faults so far."""
    return it._limits.restarts - it.allowance.restarts


def stderr_of(it: Implementation) -> tuple[str, ...]:
    """The last lines that it wrote on standard error since the last question."""
    return it._supervisor.session()._process.stderr


def living(token: str) -> list[str]:
    """The command lines of all processes that inherited the token, and of our own zombies."""
    return [shown for folder in Path("/proc").glob("[0-9]*") if (shown := _living(folder, token.encode()))]


def _living(folder: Path, token: bytes) -> str:
    try:
        environment = folder.joinpath("environ").read_bytes()
        state, parent = folder.joinpath("stat").read_text(errors="replace").rpartition(")")[2].split()[:2]
        if folder.name != str(os.getpid()) and token in environment:
            return folder.joinpath("cmdline").read_text().replace("\0", " ") or f"process {folder.name}"
    except OSError:  # it ended meanwhile
        return ""
    return f"zombie {folder.name}" if state == "Z" and parent == str(os.getpid()) else ""


def all_gone(token: str, seconds: float = 3.0) -> list[str]:
    """What is still alive after some seconds at most."""
    until = time.monotonic() + seconds
    while (left := living(token)) and time.monotonic() < until:
        time.sleep(0.02)
    return left


@pytest.fixture(autouse=True)
def token(monkeypatch):
    """Marks every process that a test starts, and asserts that none outlives it; most tests start none."""
    mark, started = uuid.uuid4().hex, []

    def noted(start):
        def starting(*words, **options):
            started.append(start)
            return start(*words, **options)

        return starting

    monkeypatch.setenv(f"HYPCHECK_{mark}", "1")
    for owner, name in ((subprocess.Popen, "__init__"), (multiprocessing.util, "spawnv_passfds")):
        monkeypatch.setattr(owner, name, noted(getattr(owner, name)))
    yield mark
    assert not started or all_gone(mark) == []
