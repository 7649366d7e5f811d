"""The verdict of a run in one sentence, and every failure behind it, from the lines of the record.

A misprint in the paper or a wrong answer of one of its procedures is a finding and no failure. A run fails if a proof
does not hold, oracles disagree, a method that promises to be exact errs, a method breaks down, findings differ from the
known ones, an implementation under test errs, or a benchmark misses a target.

The verdict is the first output of a failing run. Next to it is a table for each implementation under test: the number
of its answers by right answer and given answer. A bug is first visible in this table: it shows which answers are
confused.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass

from hypcheck.geometry.rows import CANNOT_SAY
from hypcheck.implementations.description import QUESTIONS
from hypcheck.implementations.domain import too_few
from hypcheck.messages import counted
from hypcheck.record import Record
from hypcheck.record.lines import DriftLine, GroupLine, ImplementationLine, NotStartedLine, OracleLine, ProofLine
from hypcheck.record.measurements import ComparisonLine, ForestLine, KernelLine, SceneLine
from hypcheck.report import messages, model
from hypcheck.report.benchmark_facts import benchmark_failures, clauses_of, failures_of
from hypcheck.report.document import Code, Column, Row, Strong, TableBlock, TableCell, number, table
from hypcheck.report.facts import Failure
from hypcheck.report.measured import by_ratio, measured_methods, reference, reference_in_words, timed_workloads
from hypcheck.runs.judge import Status, in_words, truth_in_words
from hypcheck.truth.passage_error import HIT

WITHOUT_COMPARISON = (KernelLine, ForestLine, SceneLine)
"""Types of lines that a run can have without comparing methods on rows."""


def _method_clauses(record: Record) -> Iterator[str]:
    """Yield clauses about the methods of a benchmark that were compared on rows."""
    methods = [method for method in measured_methods(record) if method.asked or method.speed]
    if not methods:
        return
    scenes, against = timed_workloads(record), reference(record)
    best = (
        next(iter(by_ratio([method for method in methods if method.never_wrong], scenes[0])), None) if scenes else None
    )
    ratio, right = None if best is None else best.ratio(scenes[0]), list[str]()
    if best is not None and ratio and against and best.name != against:
        right = [best.name]
        yield f"right on every row and {messages.pace(ratio, reference_in_words(against))}: {best.name}"
    timed = sum(bool(method.speed) for method in methods)
    workloads = {name for method in methods for name in (*method.accuracy, *(name for name, _ in method.speed))}
    compared = f"{counted(len(methods), 'method')} compared on {counted(len(workloads), 'workload')}"
    yield f"{compared}, {timed:,} of them timed"
    exact = [method.name for method in methods if method.exact and method.asked]
    if exact and exact != right:
        which = exact[0] if len(exact) == 1 else f"each of the {len(exact):,} that promise to be exact"
        yield f"{which} was right on every row"
    yield from clauses_of(record, ComparisonLine)


MEANINGS = {
    1: "wrong answers, or findings other than the known ones",
    2: "nothing was judged",
    3: "slower than the baseline allows",
    4: "too noisy to tell, undecided, or too few rows judged",
    5: "an implementation could not be started or broke the protocol",
    6: "the oracles or a proof contradict each other",
    70: "an internal error of hypcheck",
    130: "interrupted",
    143: "terminated",
}
"""The meaning of an exit code, if no other line of the record explains it."""

EXITS_UNFINISHED = (70, 130, 143)
"""The exit codes of runs that stopped before their end."""

EXIT_INCONCLUSIVE = 4
"""The exit code of a run that neither passed nor failed."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """Whether the run passed, and a sentence about its result; a run that did not reach its end has not passed."""

    passed: bool
    sentence: str


def failures(record: Record) -> list[Failure]:
    """Return everything in the record that fails the run, worst first."""
    whole = failures_of(record, ImplementationLine, NotStartedLine)
    starts = [failure for failure in whole if failure.group == "start"]
    return [
        *failures_of(record, OracleLine),
        *failures_of(record, ProofLine),
        *starts,
        *failures_of(record, GroupLine),
        *(failure for failure in whole if failure not in starts),
        *failures_of(record, DriftLine),
        *benchmark_failures(record),
    ]


def verdict(record: Record) -> Verdict:
    """Return the verdict of the run."""
    failed = failures(record)
    if record.footer is None:
        so_far = f" What was finished has already failed: {_failure_counts(failed)}." if failed else ""
        return Verdict(False, f"TRUNCATED: the record has no end; the run was interrupted and is not a pass.{so_far}")
    code = record.footer.exit_code
    if code == 0 and failed:
        return Verdict(False, f"CONTRADICTORY: the record ends with exit code 0, but holds {_failure_counts(failed)}.")
    if code == 0:
        return _passed(record)
    parts = (MEANINGS[code] if code in EXITS_UNFINISHED else "", _reasons(record, failed))
    reason = "; ".join(filter(None, parts)) or MEANINGS.get(code, "no line of the record says why")
    if code != EXIT_INCONCLUSIVE:
        return Verdict(False, f"FAILED with exit code {code}: {reason}.")
    few = [total for total in model.implementations(record) if total.gated and too_few(total.judged, total.skipped)]
    if few:
        clauses = "; ".join(_gated_clause(total, record) for total in few)
        return Verdict(False, f"INCONCLUSIVE, exit code {code}: too few rows: {clauses}. A wider domain would tell.")
    undecided = sum(line.counts.get("undecided", 0) for line in record.of(GroupLine))
    if undecided:
        between = "the tolerance lies between the two ends that are proved of the backward error"
        return Verdict(False, f"INCONCLUSIVE, exit code {code}: {counted(undecided, 'answer')} undecided: {between}.")
    noisy = f"{counted(len(failed), 'comparison')} too noisy to tell" if failed else reason
    what_helps = "A quieter machine or more --processes would tell."
    return Verdict(False, f"INCONCLUSIVE, exit code {code}: {noisy}. {what_helps}")


def ended_badly(record: Record, failed: Sequence[Failure]) -> Failure | None:
    """Return the verdict as a failure if the run stopped early, or if its lines contradict its exit code; else None."""
    ended, footer = verdict(record), record.footer
    unfinished = footer is None or footer.exit_code in EXITS_UNFINISHED
    unexplained = not ended.passed and not failed
    contradictory = bool(failed) and footer is not None and footer.exit_code == 0
    if not (unfinished or unexplained or contradictory):
        return None
    return Failure("run", "hypcheck", "ended", "unfinished" if unfinished else "unexplained", ended.sentence)


def _reasons(record: Record, failed: list[Failure]) -> str:
    """Return why the run failed: a clause for each implementation; for other subjects a number, or the only failure."""
    if len(failed) == 1 and failed[0].subject in _TELLING and failed[0].kind != Status.WRONG.value:
        return failed[0].message
    tested = [failure for failure in failed if failure.subject == "implementation"]
    starts = [failure for failure in tested if failure.group == "start"]
    others = [failure.message for failure in tested if failure.group == "all families"]
    counts = _wrong_clauses(record, {failure.name for failure in starts})
    clauses = [*(failure.message for failure in starts), *counts, *others]
    if tested and clauses:
        rest = [f"and {counted(len(clauses) - _NAMED, 'more reason')}"] if len(clauses) > _NAMED else []
        besides = _failure_counts([failure for failure in failed if failure not in tested])
        return "; ".join([*clauses[:_NAMED], *rest, *([besides] if besides else [])])
    return failed[0].message if len(failed) == 1 and failed[0].subject in _TELLING else _failure_counts(failed)


_TELLING = ("implementation", "findings", "measurement")
"""Subjects of failures whose message says in one sentence what happened."""


def _wrong_clauses(record: Record, lost: Collection[str]) -> Iterator[str]:
    """Yield for each implementation under test the numbers of its cases by status that fails the run.

    For a `lost` one, which has a clause of its own, broken protocol alone is not said again.
    """
    for total in model.implementations(record):
        ended = sum(
            (
                Counter({status: group.counts.get(status, 0) for status in group.failing or ()})
                for group in total.groups
            ),
            Counter(),
        )
        counts = [f"{number:,} {status}" for status, number in model.in_order(ended).items()]
        said_already = total.name in lost and set(+ended) == {Status.PROTOCOL.value}
        if total.gated and counts and not said_already:
            yield f"{total.name}: {', '.join(counts)} of {counted(total.asked, 'case')}"


def _failure_counts(failed: list[Failure]) -> str:
    """Count the failures by subject: "2 disagreements of oracles and 1 failed proof"."""
    nouns = {
        "oracle": ("disagreement of oracles", "disagreements of oracles"),
        "proof": ("failed proof",),
        "implementation": ("implementation failure",),
        "findings": ("drift from what is known", "drifts from what is known"),
        "measurement": ("failed measurement",),
    }
    counts = {subject: sum(failure.count for failure in failed if failure.subject == subject) for subject in nouns}
    return messages.listed([counted(number, *nouns[subject]) for subject, number in counts.items() if number])


def _passed(record: Record) -> Verdict:
    """Return the verdict of a run with exit code 0 and without failures; it has not passed if nothing was judged."""
    totals = [total for total in model.oracle_totals(record) if total.asked]
    tested = [method for method in model.implementations(record) if method.asked]
    compared = [method for method in measured_methods(record) if method.asked or method.speed]
    if not totals and not tested and not compared and not any(record.of(kind) for kind in WITHOUT_COMPARISON):
        return Verdict(False, "NOTHING was asked and nothing was judged: this is not a pass.")
    clauses = [
        *([_oracle_clause(totals)] if totals else []),
        *clauses_of(record, ProofLine),
        *(f"{method.name} right on all {counted(method.asked, 'case')}" for method in tested if method.exact),
        *(_gated_clause(method, record) for method in tested if method.gated),
        *_method_clauses(record),
        *clauses_of(record, *WITHOUT_COMPARISON),
    ]
    return Verdict(True, f"HELD: {'; '.join(clauses)}." if clauses else "HELD: nothing failed.")


def _gated_clause(total: model.ImplementationTotal, record: Record) -> str:
    """Return a clause about a gated implementation: judged cases by status, skipped cases, families left out."""
    ended = ", ".join(f"{number:,} {status}" for status, number in total.statuses.items() if status != "skipped")
    worst = f"worst backward error {messages.figure(model.worst_error_u(total.worst))} u"
    parts = [f"{total.name}: {total.judged:,} judged: {ended}", worst]
    if total.fresh is not None:
        parts.append(counted(total.fresh, "fresh row") if total.fresh else "no fresh rows")
    for what, texts in (("skipped", _skipped(total)), ("not asked", _not_asked(total, record))):
        reasons = ", ".join(texts)
        parts += [f"{what}: {reasons}"] if reasons else []
    return "; ".join(parts)


def _skipped(total: model.ImplementationTotal) -> Iterator[str]:
    """Yield the skipped rows by reason, and the families of which all rows were skipped."""
    rows = messages.rows_not_asked(total.not_asked)
    if rows:
        yield rows
    empty = [group.family for group in total.groups if group.counts and not group.asked]
    if empty:
        yield (
            f"all of {messages.listed(empty)}"
            if len(empty) <= _NAMED
            else f"all of {counted(len(empty), 'family', 'families')}"
        )


def _not_asked(total: model.ImplementationTotal, record: Record) -> Iterator[str]:
    """Yield the families that --families left out, in words; nothing if all were chosen."""
    if total.whole is not None and record.header.options.get("families"):
        families = messages.families_not_asked(total.whole)
        if families:
            yield families


_NAMED = 3
"""The most families without a tested row, and the most reasons, that a verdict names."""


def _oracle_clause(totals: list[model.OracleTotal]) -> str:
    """Return a clause about the agreement of the oracles; a single oracle shows none."""
    undecided = sum(total.undecided for total in totals)
    doubt = f", {undecided:,} undecided" if undecided else ""
    if len(totals) == 1:
        return f"{counted(totals[0].asked, 'case')} asked of {totals[0].name} and of no other oracle{doubt}"
    oracles = messages.listed([f"{total.name} ({total.asked:,})" for total in totals])
    return f"no disagreement in the cases asked of {oracles}{doubt}"


_WRONG_TIMES = ("late", "early")

_WORDS = {
    **{mistake: f"contact too {mistake}" for mistake in _WRONG_TIMES},
    str(CANNOT_SAY): "cannot say",
    "none": "no valid answer",
}
"""Titles of the columns that a table of answers has only if there is such an answer."""

AMISS = "✗"
"""The mark behind a count of answers that are not right."""


def tables_of_answers(record: Record) -> Iterator[tuple[TableBlock, str]]:
    """Yield the table of answers of each implementation under test that gave an answer that is not right.

    A sentence follows each table: it says how many of these answers pass; "" if none does. Records before 1.10.0 give
    no tables.
    """
    for total in model.implementations(record):
        counts = _with_wrong_times(total)
        if total.gated and any(
            not _right(total.question, truth, answer) for truth in counts for answer in counts[truth]
        ):
            yield _square(total, counts), _passing(total)


def _with_wrong_times(total: model.ImplementationTotal) -> dict[str, dict[str, int]]:
    """Count the rows by truth, then by answer. Hits at a wrong time are apart from the right ones."""
    counts = total.answers
    wrong = {mistake: total.mistakes[mistake] for mistake in _WRONG_TIMES if mistake in total.mistakes}
    hit = str(HIT)
    if wrong and hit in counts:
        counts[hit] = counts[hit] | {hit: counts[hit][hit] - sum(wrong.values())} | wrong
    return counts


def _square(total: model.ImplementationTotal, counts: Mapping[str, Mapping[str, int]]) -> TableBlock:
    """Make the table of an implementation's answers: truths in rows, answers in columns."""
    truths = [
        truth for truth in (("1", "0") if total.question == model.PASSAGE else ("1", "0", "-1")) if truth in counts
    ]
    usual = [str(answer) for answer in sorted(QUESTIONS[total.question].answers, reverse=True) if answer != CANNOT_SAY]
    others = [answer for answer in _WORDS if any(answer in row for row in counts.values())]
    titles = [f"answered {_WORDS.get(answer) or in_words(int(answer), total.question)}" for answer in usual]
    columns = [Column(Code(total.name)), *map(number, [*titles, *(_WORDS[answer] for answer in others)])]
    rows: list[Row] = [
        (
            f"truth {truth_in_words(int(truth), total.question)}",
            *(
                _cell(counts[truth].get(answer, 0), right=_right(total.question, truth, answer))
                for answer in [*usual, *others]
            ),
        )
        for truth in truths
    ]
    return table(f"answers of {total.name} against the truth", columns, rows)


def _passing(total: model.ImplementationTotal) -> str:
    """Return a sentence about the marked answers that do not fail the run; "" if there are none."""
    reasons = (("tolerated", "within the tolerance"), ("excused", "excused as known failures"))
    parts = [
        f"{counted(total.statuses[status], 'answer')} {words}"
        for status, words in reasons
        if total.statuses.get(status)
    ]
    return f"{AMISS} includes {messages.listed(parts)}" if parts else ""


def _cell(cases: int, *, right: bool) -> TableCell:
    """Make the cell of a count of answers; a count of answers that are not right is marked."""
    if right or not cases:
        return TableCell(f"{cases:,}", cases, "good" if right and cases else "")
    return TableCell(Strong(f"{cases:,} {AMISS}"), cases, "bad")


def _right(question: str, truth: str, answer: str) -> bool:
    """Decide whether this is the right answer to the question about a row with this truth."""
    position = QUESTIONS[question].position
    return answer == (truth if position is None else str(int(int(truth) == position)))
