"""Rounds of verify against flaky implementations in one process, which is measured after each."""

from __future__ import annotations

import contextlib
import io
import json
import os
import shutil
import sys
import tempfile
import time
import uuid
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from hypcheck.cli.main import main
from hypcheck.record import read
from hypcheck.record.lines import GroupLine, NotStartedLine
from tests.tools.soak.measuring import Sample, faults, sample

HERE = Path(__file__).parent
LIMITS = ["--timeout", "0.5", "--startup-timeout", "60", "--memory", "300M", "--isolate", "off"]
"""Not isolated: a namespace would end what an implementation leaves, and hypcheck itself must."""

LONG = ["--families", "ring,axis", "--count", "40", "--restarts", "40"]
SHORT = ["--families", "axis", "--count", "0", "--restarts", "2"]
"""What a round asks, and how many faults it lives through."""

ENDINGS = (0, 1, 5)
"""How verify may end: nothing failed, something did, it did not start."""


@dataclass
class Course:
    """What happened: exit codes, statuses, why one did not start, samples after each round, and what may not be."""

    rounds: int = 0
    codes: Counter[int] = field(default_factory=Counter)
    statuses: Counter[str] = field(default_factory=Counter)
    not_started: list[str] = field(default_factory=list)
    samples: list[Sample] = field(default_factory=list)
    troubles: list[str] = field(default_factory=list)

    @property
    def faults(self) -> list[str]:
        """Everything that failed the run."""
        return self.troubles + faults(self.samples)


def run(
    seconds: float,
    seed: int,
    least: int = 8,
    size: list[str] = LONG,
    after: Callable[[Course], object] = lambda _: None,
) -> Course:
    """Rounds until the seconds are over, but at least so many; `after` is called behind each, before it is measured."""
    course, until = Course(), time.monotonic() + seconds
    with _workplace(seed) as (folder, mark):
        out = folder / "out"
        while course.rounds < least or time.monotonic() < until:
            _round(course, folder, out, seed + course.rounds, size)
            course.rounds += 1
            after(course)
            course.samples.append(_settled(mark, [folder / "temporary"]))
    return course


def _round(course: Course, folder: Path, out: Path, seed: int, size: list[str]) -> None:
    specs = [  # the function first: what multiprocessing starts for ever is there before anything is compared
        f"python:{HERE / 'flaky_function.py'}:classify",
        "command:" + json.dumps([sys.executable, str(HERE / "flaky_command.py"), str(seed), str(folder)]),
        "command:" + json.dumps([sys.executable, str(HERE / "flaky_command.py"), str(seed), str(folder), "binary"]),
    ]
    os.environ["HYPCHECK_SOAK_SEED"] = str(seed)
    workers = ["--workers", "2"] if course.rounds % 3 == 0 else []
    words = ["--no-settings", "verify", specs[course.rounds % 3], *size]
    said = io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        code = main([*words, "--seed", str(seed), *workers, *LIMITS, "--out", str(out)])
    course.codes[code] += 1
    if code not in ENDINGS or "Traceback" in said.getvalue():
        course.troubles.append(f"round {course.rounds} ended with {code}: {said.getvalue()[-500:]!r}")
        return
    record = read(out / "record.jsonl")
    course.not_started += [line.trouble for line in record.of(NotStartedLine)]
    for group in record.of(GroupLine):
        course.statuses += Counter(group.counts)
    left = [path.name for path in out.iterdir() if path.name.startswith(".") or path.name.endswith(".part")]
    if left or record.footer is None:
        course.troubles.append(f"round {course.rounds} left {left or 'a record without an end'}")


@contextlib.contextmanager
def _workplace(seed: int) -> Iterator[tuple[Path, str]]:
    """A folder with one for temporary files in it, and a mark that every process we start inherits."""
    folder, mark = Path(tempfile.mkdtemp(prefix="hypcheck-soak-")), uuid.uuid4().hex
    (folder / "temporary").mkdir()
    before, tempfile.tempdir = dict(os.environ), None
    os.environ |= {
        "HYPCHECK_SOAK_MARK": mark,
        "HYPCHECK_SOAK_FOLDER": str(folder),
        "HYPCHECK_SOAK_SEED": str(seed),
        "TMPDIR": str(folder / "temporary"),
    }
    try:
        yield folder, mark
    finally:
        os.environ.clear()
        os.environ |= before
        tempfile.tempdir = None
        shutil.rmtree(folder, ignore_errors=True)


def _settled(mark: str, folders: list[Path], patience: float = 5.0) -> Sample:
    """A sample, once what was killed has gone."""
    until = time.monotonic() + patience
    while (found := sample(mark, folders)).strays and time.monotonic() < until:
        time.sleep(0.05)
    return found
