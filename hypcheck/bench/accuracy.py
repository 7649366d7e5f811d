"""The answers of every method to every workload, compared with exact ones; and the memory of each method.

Errors are counted by the row's distance to the nearest other position. Memory is the growth of a separate process while
a method answers a batch.
"""

from __future__ import annotations

import ctypes
import gc
import hashlib
import math
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from contextlib import closing, suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hypcheck.bench.contenders import Contender, contenders
from hypcheck.bench.loaded import LoadedMethod
from hypcheck.bench.plan import PASSAGE, BenchPlan, chosen_names
from hypcheck.bench.workloads import WORKLOADS, Workload, workloads_of
from hypcheck.geometry.rows import SWEEPS, Floats, Positions, Rows
from hypcheck.implementations.description import QUESTIONS
from hypcheck.implementations.method import Answers
from hypcheck.implementations.session import Answered
from hypcheck.implementations.sweeps import least_distances
from hypcheck.processes import one_each, perform
from hypcheck.record.fields import Unsigned, row_fields
from hypcheck.record.measurements import AccuracyLine, MemoryLine, Mistaken
from hypcheck.runs import judge
from hypcheck.runs.judge import Criterion, Mistake, Status
from hypcheck.runs.score import Score, score
from hypcheck.runs.tally import STATUS_CODES, by_octave
from hypcheck.truth.backward_error import flip_exponents
from hypcheck.truth.passage_error import passage_of, size_error

if sys.platform != "win32":
    import resource

WORST_KEPT = 3
WORST_TRIED, FEW_TRIED = 12, 1
"""How many candidates for the worst wrong answer are measured; one about a sweep takes twenty milliseconds."""

_PIECE = 500

TOLERABLE = 1e-3
""""Reliable above" allows this share of wrong or missing answers."""


NEAREST = 2.0**-75
"""A distance that is less than that of any row except exact tangencies."""


@dataclass(frozen=True)
class WorkloadTruth:
    """A workload's judged rows (n, 7) with their exact positions, int8 (n,), and exponents of their distances, (n,)."""

    workload: Workload
    rows: Rows
    positions: Positions
    exponents: Floats


@dataclass(frozen=True)
class MethodAnswers:
    """A method's answers to one workload: to the judged rows at `places`, and hashes of the answers that are timed.

    `trouble` says why some rows have no answer, if a program failed.
    """

    method: str
    workload: str
    places: NDArray[np.intp]
    answers: Answers
    batch_print: str
    single_print: str
    trouble: str = ""


def chosen_workloads(plan: BenchPlan) -> list[Workload]:
    """Return the workloads of the plan. Raises InputError naming one that does not exist."""
    known = workloads_of(plan)
    return [known[name] for name in chosen_names(list(known), plan.workloads, "workload")]


def workload_truths(plan: BenchPlan, executor: Executor | None) -> Iterator[WorkloadTruth]:
    """Yield the truth of each workload. The distances are computed in pieces, on all processors."""
    for workload in chosen_workloads(plan):
        rows = workload.rows(plan.seed, workload.judged(plan))
        pieces = [(start, rows[start : start + _PIECE]) for start in range(0, len(rows), _PIECE)]
        exponents = np.empty(len(rows))
        truth = np.empty(len(rows), dtype=np.int8)
        examine = _examined_sweeps if workload.layout.has_end else _examined
        for (start, piece), (truths, octaves) in perform(examine, pieces, executor):
            truth[start : start + len(piece)], exponents[start : start + len(piece)] = truths, octaves
        yield WorkloadTruth(workload, rows, truth, exponents)


def _examined(piece: tuple[int, Rows]) -> tuple[Positions, Floats]:
    """Return exact positions, and the exponents of the distances to another position."""
    return judge.exact_positions(piece[1]), flip_exponents(piece[1])


def _examined_sweeps(piece: tuple[int, Rows]) -> tuple[Positions, Floats]:
    """Return exact hits of sweeps, and approximate exponents of the change of size that leads to the other answer."""
    rows = piece[1]
    off = np.abs(least_distances(rows) - 1)
    with np.errstate(divide="ignore"):
        exponents = np.floor(np.log2(off))
    grazing = [passage_of(tuple(row)).grazes for row in rows.tolist()]
    return judge.truth_of(rows, SWEEPS), np.where(grazing, -np.inf, exponents)


def method_answers(task: tuple[BenchPlan, str]) -> list[MethodAnswers]:
    """Return the answers of the method with that name, to each workload of the plan."""
    plan, name = task
    contender = contenders(plan)[name]
    with closing(contender.load()) as loaded:
        return [_answered(plan, contender, loaded, workload) for workload in chosen_workloads(plan)]


def _answered(plan: BenchPlan, contender: Contender, loaded: LoadedMethod, workload: Workload) -> MethodAnswers:
    """Return a loaded method's answers to one workload."""
    rows = _rows(workload, plan.seed, workload.judged(plan))
    places = contender.asked(rows)
    part = timed_rows(plan, contender, workload)
    return MethodAnswers(
        contender.name,
        workload.name,
        places,
        loaded.answer(rows[places]),
        answers_print(loaded.answer(part)),
        answers_print(loaded.answer(part[: contender.singles])),
        loaded.trouble,
    )


@cache
def _rows(workload: Workload, seed: int, count: int) -> Rows:
    """Return a workload's rows, generated once in a process; they must not be written to."""
    rows = workload.rows(seed, count)
    rows.flags.writeable = False
    return rows


def timed_rows(plan: BenchPlan, contender: Contender, workload: Workload) -> Rows:
    """Return the rows of a timed batch; none if the workload or the method is not timed."""
    if contender.accuracy_only or not workload.timed:
        return _rows(workload, plan.seed, 0)
    rows = _rows(workload, plan.seed, plan.amounts.timed)
    if contender.tier == "foreign":
        rows = rows[contender.domain.holds(rows, layout=workload.layout)]
    if contender.scenes is not None:
        rows = rows[(rows[:, :4] == rows[0, :4]).all(axis=1)]
    return rows[: contender.timed]


def answers_print(answers: Answers) -> str:
    """Return a hash of these answers."""
    return hashlib.sha256(np.ascontiguousarray(answers, dtype=np.int8).tobytes()).hexdigest()[:16]


def accuracy_line(
    contender: Contender, results: MethodAnswers, truth: WorkloadTruth, tried: int = WORST_TRIED
) -> AccuracyLine:
    """Return the record's line about one method and one workload; `results` holds at least one answer.

    The errors of `tried` wrong answers are computed.
    """
    places, criterion = results.places, Criterion(contender.question, contender.precision)
    scored = score(truth.rows[places], truth.positions[places], Answered.of(results.answers), criterion)
    exponents, mistakes = truth.exponents[places], scored.mistakes
    return AccuracyLine(
        method=contender.name,
        workload=results.workload,
        asked=len(places),
        wrong=len(scored.wrong),
        false_clear=mistakes[Mistake.FALSE_CLEAR],
        false_contact=mistakes[Mistake.FALSE_CONTACT],
        wrong_side=mistakes[Mistake.WRONG_SIDE],
        abstained=int(np.count_nonzero(scored.status == STATUS_CODES[Status.ABSTAINED])),
        octaves=[
            (
                int(exponent) if math.isfinite(float(exponent)) else exponent,
                sum(counts.values()),
                counts.get("wrong", 0),
            )
            for exponent, counts in by_octave(exponents, scored.status).items()
        ],
        reliable_above=Unsigned(reliable_above(exponents, scored.status != STATUS_CODES[Status.RIGHT])),
        worst=_worst(scored, exponents, results, tried),
    )


def reliable_above(exponents: Floats, wrong: NDArray[np.bool_]) -> float:
    """Return the least 2^k with at most TOLERABLE wrong rows at a distance of at least 2^(k + j), for all j ≥ 0.

    Missing answers count as wrong: otherwise a method that never answers would be reliable. The result is 0 if nothing
    is wrong, NEAREST if only exact tangencies are wrong, and inf if even the farthest rows are wrong too often or do
    not exist.
    """
    edges = np.unique(exponents[np.isfinite(exponents)])
    if not wrong.any():
        return 0.0
    if not len(edges):
        return math.inf
    if not wrong[np.isfinite(exponents)].any():
        return NEAREST
    numbers = np.array([np.count_nonzero(exponents >= edge) for edge in edges])
    errors = np.array([np.count_nonzero(wrong & (exponents >= edge)) for edge in edges])
    failing = np.flatnonzero(errors > TOLERABLE * numbers)
    if not len(failing):
        return float(2.0 ** edges[0])
    return math.inf if failing[-1] == len(edges) - 1 else float(2.0 ** (edges[failing[-1]] + 1))


def _worst(scored: Score, exponents: Floats, results: MethodAnswers, tried: int) -> list[Mistaken]:
    """Return the worst wrong answers, of `tried` rows with the greatest distance to another position."""
    places = scored.wrong[np.argsort(-exponents[scored.wrong], kind="stable")][:tried].tolist()
    question = scored.criterion.question
    cases = [
        Mistaken(
            case=f"{results.workload}/{int(results.places[index])}",
            row=fields["row"],
            end=fields["end"],
            axis=fields["axis"],
            truth=int(scored.truth[index]),
            answer=answer,
            flip_distance=Unsigned(_about_error_of(row, answer, question)),
        )
        for index in places
        for row, answer in [(scored.rows[index].tolist(), int(scored.answers[index]))]
        for fields in [row_fields(row, QUESTIONS[question].layout)]
    ]
    return sorted(cases, key=lambda case: -case.flip_distance)[:WORST_KEPT]


def _about_error_of(row: Sequence[float], answer: int, question: str) -> float:
    """Return the error of an answer: the change of the inputs that makes it right.

    For a sweep, of the spheroid's size.
    """
    if question == PASSAGE:
        return size_error(row, bool(answer)).lower
    return judge.about_error_of(row, answer, question)


MEMORY_WORKLOAD = "uniform"


def memory_lines(plan: BenchPlan, names: Sequence[str]) -> Iterator[MemoryLine]:
    """Yield a line for each of the methods, in the order in which they finish."""
    for _, line in one_each(_memory_line, [(plan, name) for name in names], plan.workers):
        yield line


def _memory_line(task: tuple[BenchPlan, str]) -> MemoryLine:
    """Return the record's line about the memory of one method, in a process of its own."""
    plan, name = task
    contender = contenders(plan)[name]
    return memory_line(contender, timed_rows(plan, contender, WORKLOADS[MEMORY_WORKLOAD]))


def memory_line(contender: Contender, rows: Rows) -> MemoryLine:
    """Return the record's line about the memory that a method needs to answer these rows, besides the rows."""
    first = contender.load()
    first.answer(rows[:1])  # this loads code, which is not to be counted
    first.close()
    loaded = contender.load()
    before = forget_peak()
    ready = loaded.batch(rows)
    if ready is not None:
        ready.answers()
    grown = peak() - before
    loaded.close()
    return MemoryLine(method=contender.name, rows=len(rows), peak_bytes=max(0, grown))


def forget_peak() -> int:
    """Reset the peak to the present resident size, if the system allows it (Linux).

    Freed memory is returned to the system first: otherwise answers that reuse it would not raise the peak.
    """
    gc.collect()
    with suppress(OSError, AttributeError, TypeError):
        ctypes.CDLL(None).malloc_trim(0)
    with suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5", encoding="ascii")
    return peak()


def peak() -> int:
    """Return the largest resident size so far, in bytes."""
    with suppress(OSError, StopIteration):
        status = Path("/proc/self/status").read_text(encoding="ascii", errors="replace").splitlines()
        words = next(line for line in status if line.startswith("VmHWM:")).split()
        return int(words[1]) * 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)
