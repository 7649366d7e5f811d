"""Every method's answers to every workload's rows against the exact ones, by the distance at which these flip."""

from __future__ import annotations

import hashlib
import math
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from hypcheck import judge
from hypcheck.bench.contenders import Contender, contenders
from hypcheck.bench.contenders.ways import Way
from hypcheck.bench.plan import BenchPlan, chosen
from hypcheck.bench.workloads import WORKLOADS, Workload
from hypcheck.judge import Mistake
from hypcheck.methods.method import Answers
from hypcheck.pairs import Position
from hypcheck.processes import perform
from hypcheck.record.fields import Unsigned
from hypcheck.record.measurements import Accuracy, Mistaken, Octave
from hypcheck.rows import CANNOT_SAY, Positions, Rows
from hypcheck.truth import batch

Floats = NDArray[np.float64]

WORST_KEPT = 3
_WORST_TRIED = 12
_PIECE = 500

TOLERABLE = 1e-3
"""The share of wrong or missing answers that "reliable above" allows."""


NEAREST = 2.0**-75
"""A flip distance below those of all rows but the exact tangencies."""


@dataclass(frozen=True)
class Known:
    """A workload's judged rows (n, 7) with their exact positions, int8 (n,), and flip octaves (n,)."""

    workload: Workload
    rows: Rows
    positions: Positions
    octaves: Floats


@dataclass(frozen=True)
class Answered:
    """A method's answers about one workload: to the judged rows at `places`, and prints of those that are timed.

    `trouble` says why some went without an answer, where a program was at fault.
    """

    method: str
    workload: str
    places: NDArray[np.intp]
    answers: Answers
    batch_print: str
    single_print: str
    trouble: str = ""


def chosen_workloads(plan: BenchPlan) -> list[Workload]:
    """The workloads of the plan. Raises InputError naming one that does not exist."""
    return [WORKLOADS[name] for name in chosen(list(WORKLOADS), plan.workloads, "workload")]


def known(plan: BenchPlan, executor: Executor | None) -> Iterator[Known]:
    """What is true of each workload; the flip distances are found in pieces, on all processors."""
    for workload in chosen_workloads(plan):
        rows = workload.rows(plan.seed, plan.amounts.judged)
        pieces = [(start, rows[start : start + _PIECE]) for start in range(0, len(rows), _PIECE)]
        octaves = np.empty(len(rows))
        for (start, piece), found in perform(_octaves, pieces, executor):
            octaves[start : start + len(piece)] = found
        yield Known(workload, rows, batch.positions(rows), octaves)


def _octaves(piece: tuple[int, Rows]) -> Floats:
    return judge.flip_octaves(piece[1])


def asked(plan: BenchPlan, names: Sequence[str], executor: Executor | None) -> Iterator[list[Answered]]:
    """The answers of each method, as they come."""
    for _, answered in perform(_ask, [(plan, name) for name in names], executor):
        yield answered


def _ask(task: tuple[BenchPlan, str]) -> list[Answered]:
    plan, name = task
    contender = contenders(plan)[name]
    way = contender.load()
    try:
        return [_answered(plan, contender, way, workload) for workload in chosen_workloads(plan)]
    finally:
        way.close()


def _answered(plan: BenchPlan, contender: Contender, way: Way, workload: Workload) -> Answered:
    rows = _rows(workload.name, plan.seed, plan.amounts.judged)
    places = contender.asked(rows)
    part = timed_rows(plan, contender, workload)
    return Answered(
        contender.name,
        workload.name,
        places,
        way.answer(rows[places]),
        print_of(way.answer(part)),
        print_of(way.answer(part[: contender.singles])),
        way.trouble,
    )


@cache
def _rows(workload: str, seed: int, count: int) -> Rows:
    """A workload's rows, made once a process, and not to be written to."""
    rows = WORKLOADS[workload].rows(seed, count)
    rows.flags.writeable = False
    return rows


def timed_rows(plan: BenchPlan, contender: Contender, workload: Workload) -> Rows:
    """The rows of a timed batch: none where the workload or the method is not timed."""
    if contender.accuracy_only or not workload.timed:
        return np.empty((0, 7))
    rows = _rows(workload.name, plan.seed, plan.amounts.timed)
    if contender.tier == "foreign":
        rows = rows[contender.domain.holds(rows)]
    if contender.scenes is not None:
        rows = rows[(rows[:, :4] == rows[0, :4]).all(axis=1)]
    return rows[: contender.timed]


def print_of(answers: Answers) -> str:
    """A short text that tells these answers from others."""
    return hashlib.sha256(np.ascontiguousarray(answers, dtype=np.int8).tobytes()).hexdigest()[:16]


def line(contender: Contender, answered: Answered, truth: Known) -> Accuracy:
    """The record's line about one method and one workload; `answered` holds at least one answer."""
    places, answers = answered.places, answered.answers
    positions, octaves = truth.positions[places], truth.octaves[places]
    said = answers != CANNOT_SAY
    wrong = said & (answers != judge.expected(positions, contender.question))
    mistakes = mistakes_of(positions[wrong], answers[wrong], contender.question)
    return Accuracy(
        method=contender.name,
        workload=answered.workload,
        asked=len(places),
        wrong=int(wrong.sum()),
        false_clear=mistakes[Mistake.FALSE_CLEAR],
        false_contact=mistakes[Mistake.FALSE_CONTACT],
        wrong_side=mistakes[Mistake.WRONG_SIDE],
        abstained=int((~said).sum()),
        octaves=by_octave(octaves, wrong),
        reliable_above=Unsigned(reliable_above(octaves, wrong | ~said)),
        worst=_worst(contender, answered, truth, np.flatnonzero(wrong)),
    )


def mistakes_of(positions: Positions, answers: Answers, question: str) -> Counter[Mistake]:
    """Wrong answers by what they mean."""
    found: Counter[Mistake] = Counter()
    for (position, answer), number in Counter(zip(positions.tolist(), answers.tolist(), strict=True)).items():
        found[judge.mistake_of(Position(position), answer, question)] += number
    return found


def by_octave(octaves: Floats, wrong: NDArray[np.bool_]) -> list[Octave]:
    """[exponent, asked, wrong] for each octave that occurs, from the lowest up; an exact tangency is "-inf"."""
    found, octave_of = np.unique(octaves, return_inverse=True)
    numbers = np.bincount(octave_of, minlength=len(found)).tolist()
    errors = np.bincount(octave_of[wrong], minlength=len(found)).tolist()
    return [
        (int(octave) if math.isfinite(octave) else str(octave), number, error)
        for octave, number, error in zip(found.tolist(), numbers, errors, strict=True)
    ]


def reliable_above(octaves: Floats, wrong: NDArray[np.bool_]) -> float:
    """The lowest 2^k from which on, of the rows that flip at any 2^(k + j) or farther, at most TOLERABLE are wrong.

    Missing answers are among the wrong: who never says anything would be reliable else. 0 where nothing is wrong,
    NEAREST where exact tangencies alone are, inf where even the farthest rows are wrong too often or there is no other.
    """
    edges = np.unique(octaves[np.isfinite(octaves)])
    if not wrong.any():
        return 0.0
    if not len(edges):
        return math.inf
    if not wrong[np.isfinite(octaves)].any():
        return NEAREST
    numbers = np.array([np.count_nonzero(octaves >= edge) for edge in edges])
    errors = np.array([np.count_nonzero(wrong & (octaves >= edge)) for edge in edges])
    failing = np.flatnonzero(errors > TOLERABLE * numbers)
    if not len(failing):
        return float(2.0 ** edges[0])
    return math.inf if failing[-1] == len(edges) - 1 else float(2.0 ** (edges[failing[-1]] + 1))


def _worst(contender: Contender, answered: Answered, truth: Known, wrong: NDArray[np.intp]) -> list[Mistaken]:
    """The wrong answers that are farthest from being right, of those whose rows flip farthest away."""
    octaves = truth.octaves[answered.places[wrong]]
    tried = wrong[np.argsort(-octaves, kind="stable")][:_WORST_TRIED].tolist()
    cases = []
    for index in tried:
        place, answer = int(answered.places[index]), int(answered.answers[index])
        row = truth.rows[place].tolist()
        error = judge.error_of(row, answer, contender.question)
        case = Mistaken(
            case=f"{truth.workload.name}/{place}",
            row=tuple(value.hex() for value in row),
            truth=int(truth.positions[place]),
            answer=answer,
            flip_distance=Unsigned(error),
        )
        cases.append((error, case))
    cases.sort(key=lambda each: -each[0])
    return [case for _, case in cases[:WORST_KEPT]]
