"""What a foreign processor is asked, and what is wrong with its answers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from subprocess import run

import numpy as np

from hypcheck.geometry.pair import REFUSED
from hypcheck.geometry.rows import CANNOT_SAY
from hypcheck.implementations.sweeps import certified
from hypcheck.vectors.families import FAMILIES, SWEEP_FAMILIES
from hypcheck.vectors.frozen import ENDED_NAMES, NAMES, SWEEP_NAMES, TILTED_NAMES, load
from hypcheck.vectors.invalid_rows import INVALID_CONTENTS
from tests.support.inside import nearest_rows
from tests.tools.attack.places import Scene
from tests.tools.attack.strike import Batch, batches
from tests.tools.processors.builds import LEVELS, MODES, Build, BuildError

KINDS = (
    "rows",
    "leaning rows",
    "scene",
    "leaning scene",
    "one",
    "ways",
    "leaning ways",
    "clearances",
    "stack",
    "leaning stack",
    "ended rows",
)
"""What program.c calls them, in its order."""

MOST = 1 << 16
NEAR_NUMBERS = 11

Answers = np.ndarray
Wrong = Callable[[Answers, np.ndarray], np.ndarray]
"""Which answers (n,) or (n, questions) are wrong, beside numbers (n, some): a mask."""


@dataclass(frozen=True)
class Job:
    """Rows, or a scene, asked under some rounding modes; `said` is (bytes a row, doubles a row) of an answer."""

    stratum: str
    kind: str
    numbers: np.ndarray
    count: int
    wrong: Wrong
    modes: tuple[str, ...] = MODES[:1]
    said: tuple[int, int] = (1, 0)


_REFUSALS = (name for name in INVALID_CONTENTS if name != "ended-way-invalid")  # no job asks of these ways
FROZEN = (*NAMES, *TILTED_NAMES, *SWEEP_NAMES, *ENDED_NAMES, *_REFUSALS)


def frozen(names: Sequence[str] = FROZEN) -> Iterator[Job]:
    """Frozen vectors of these names: upright rows also with an axis and one by one, ways, towers that end, refusals."""
    for name in names:
        cases = load(name)
        rows, right = cases.rows, cases.positions
        if name in (*SWEEP_NAMES, "way-invalid", "tilted-way-invalid"):
            yield _ways("frozen ways", rows, right)
            continue
        if name in (*ENDED_NAMES, "ended-invalid"):
            yield Job("frozen towers that end", "ended rows", rows, len(rows), _told_or_open(right), MODES[:4])
            continue
        yield from _positions("frozen", rows, right, modes=MODES)
        if rows.shape[1] == 7:
            yield Job("frozen", "one", rows, len(rows), _unequal(right), MODES)
            upright = np.column_stack([rows, np.tile([0.0, -0.0, -3.0], (len(rows), 1))])
            yield from _positions("frozen", upright, right)


def adversarial(seed: int, rows: int) -> Iterator[Job]:
    """The attack's rows and scenes, about so many, each in one rounding mode; each eighth batch one by one too."""
    for number, batch in enumerate(batches(seed, rows)):
        if isinstance(batch.asked, Scene):
            yield _scene(batch, batch.asked, batch.modes[number % len(batch.modes)])
            continue
        mode = (batch.modes[number % len(batch.modes)],)
        yield from _positions(batch.stratum, batch.asked, batch.truth, mode)
        if batch.asked.shape[1] == 7 and number % 8 == 0:
            yield Job("one by one", "one", batch.asked, len(batch.asked), _unequal(batch.truth), mode)


def ways(seed: int, count: int) -> Iterator[Job]:
    """Ways of every family, whose hits this machine knows: its kernel's, and exact ones where that does not tell."""
    for family in SWEEP_FAMILIES.values():
        rows = family.rows(seed, max(4, count // len(SWEEP_FAMILIES)))
        yield _ways("ways", rows, certified(rows))


def clearances(seed: int, count: int, names: Sequence[str] = tuple(FAMILIES)) -> Iterator[Job]:
    """Rows of upright families, whose clearance the nearest-point oracle knows; so many if all are asked for."""
    for name in names:
        family = FAMILIES[name]
        rows = family.rows(seed, max(4, count // (len(FAMILIES) * (20 if family.extreme else 1))))
        true = nearest_rows.clearances(rows)

        def wrong(positions: Answers, found: np.ndarray, true: nearest_rows.NearestBatch = true) -> np.ndarray:
            inside = (found[:, 0] <= true.clearance) & (true.clearance <= found[:, 1])
            return ~inside | (positions != true.position) | ~(found[:, 3] <= found[:, 4])

        yield Job("clearances", "clearances", rows, len(rows), wrong, MODES[:4], (1, NEAR_NUMBERS))


def _unequal(truth: np.ndarray) -> Wrong:
    return lambda answers, _: answers != truth


def _told_or_open(truth: np.ndarray) -> Wrong:
    """An answer may be left open where there is one."""
    return lambda answers, _: (answers != truth) & ~((answers == CANNOT_SAY) & (truth != REFUSED))


def _positions(stratum: str, rows: np.ndarray, truth: np.ndarray, modes: Sequence[str] = MODES[:1]) -> Iterator[Job]:
    kind = "rows" if rows.shape[1] == 7 else "leaning rows"
    for start in range(0, len(rows), MOST):
        some = rows[start : start + MOST]
        yield Job(stratum, kind, some, len(some), _unequal(truth[start : start + MOST]), tuple(modes))


def _scene(batch: Batch, scene: Scene, mode: str) -> Job:
    """All four questions: the position, and whether it is exterior, interior, contact."""
    right = np.stack([batch.truth, batch.truth == 1, batch.truth == -1, batch.truth == 0])
    numbers = np.concatenate([scene.sizes, scene.axis or (), scene.x, scene.y, scene.z])
    kind = "scene" if scene.axis is None else "leaning scene"

    def wrong(answers: Answers, _: np.ndarray) -> np.ndarray:
        return (answers.reshape(4, -1) != right).any(axis=0)

    return Job(batch.stratum, kind, numbers, len(scene.x), wrong, (mode,), (4, 0))


def _ways(stratum: str, rows: np.ndarray, truth: np.ndarray) -> Job:
    """A hit may be left open; a time is there for a hit alone."""

    def wrong(hits: Answers, times: np.ndarray) -> np.ndarray:
        times = times[:, 0]
        told = (hits == truth) | ((hits == CANNOT_SAY) & (truth != REFUSED))
        return ~told | ~(np.isnan(times) | ((hits == 1) & (times >= 0) & (times <= 1)))

    return Job(stratum, "ways" if rows.shape[1] == 10 else "leaning ways", rows, len(rows), wrong, MODES[:4], (1, 1))


@dataclass
class Tally:
    """Answers asked and answers wrong by stratum, and rows that were answered wrong."""

    asked: Counter[str]
    wrong: Counter[str]
    rows: list[str]


def ask(build: Build, program: Path, jobs: Iterable[Job], level: str, folder: Path) -> Tally:
    """The jobs asked of a program of the build. Raises BuildError where it fails."""
    tally = Tally(Counter(), Counter(), [])
    for part in _parts(jobs):
        asked = [(job, mode) for job in part for mode in _modes(build, job)]
        said = _said(build, program, b"".join(_encoded(build, job, mode, level) for job, mode in asked), folder)
        at = 0
        for job, mode in asked:
            ends = at + job.said[0] * job.count, at + (job.said[0] + 8 * job.said[1]) * job.count
            answers = np.frombuffer(said[at : ends[0]], np.int8)
            numbers = np.frombuffer(said[ends[0] : ends[1]], f"{build.order}f8").reshape(job.count, job.said[1])
            at = ends[1]
            bad = job.wrong(answers, numbers)
            tally.asked[job.stratum] += len(bad)
            tally.wrong[job.stratum] += int(bad.sum())
            tally.rows += [f"{job.kind}, {mode}: {_shown(job, int(k))}" for k in np.flatnonzero(bad)[:3]]
        if at != len(said):
            raise BuildError(f"{build.name}: {len(said)} bytes of answers, not {at}")
    return tally


def _modes(build: Build, job: Job) -> Iterable[str]:
    """The modes of a job; to nearest for those that the program cannot set."""
    return dict.fromkeys(mode if mode in build.modes else MODES[0] for mode in job.modes)


def _parts(jobs: Iterable[Job]) -> Iterator[list[Job]]:
    """The jobs in parts of some 200,000 rows."""
    part: list[Job] = []
    for job in jobs:
        part.append(job)
        if sum(each.count for each in part) > 200_000:
            yield part
            part = []
    if part:
        yield part


def _encoded(build: Build, job: Job, mode: str, level: str) -> bytes:
    head = (KINDS.index(job.kind), MODES.index(mode), LEVELS.index(level), job.count)
    return np.array(head, f"{build.order}u4").tobytes() + job.numbers.astype(f"{build.order}f8").tobytes()


def _said(build: Build, program: Path, asked: bytes, folder: Path) -> bytes:
    """What the program answers."""
    jobs = folder / f"{build.name}.jobs"
    jobs.write_bytes(asked)
    with jobs.open("rb") as stream:
        done = run([*build.runner, str(program)], stdin=stream, capture_output=True, check=False)
    jobs.unlink()
    if done.returncode:
        raise BuildError(f"{build.name}: the program ended with {done.returncode} {done.stderr.decode()[-500:]}")
    return done.stdout


def _shown(job: Job, place: int) -> str:
    if "scene" in job.kind:
        sizes, centres = job.numbers[: -3 * job.count], job.numbers[-3 * job.count :].reshape(3, -1)
        return " ".join(float(value).hex() for value in (*sizes, *centres[:, place]))
    return " ".join(float(value).hex() for value in job.numbers[place])


def stack_used(build: Build, program: Path, rows: np.ndarray, folder: Path) -> int:
    """The most bytes of stack that the program used for these rows, of seven or ten."""
    kind = "stack" if rows.shape[1] == 7 else "leaning stack"
    job = Job(kind, kind, rows, len(rows), _unequal(np.zeros(len(rows))))
    said = _said(build, program, _encoded(build, job, MODES[0], "plain"), folder)
    return int(np.frombuffer(said[-8:], f"{build.order}f8")[0])
