"""The results of a hunt and of a minimisation as text at a terminal."""

from __future__ import annotations

import math
import shlex
from collections.abc import Iterator, Sequence

import numpy as np

from hypcheck.messages import counted
from hypcheck.runs.hunt import FindingCluster, Hunt, HuntFinding, HuntTarget
from hypcheck.runs.judge import Status
from hypcheck.runs.judges import first_contact, judge_of
from hypcheck.runs.minimise import Minimised
from hypcheck.tables.numbers import hex_of


def hunt_lines(run: Hunt, most: int) -> Iterator[str]:
    """The report of a hunt: at most `most` kinds of wrong answers in full, the worst first."""
    found = run.findings.worst_first()
    beyond = sum(cluster.beyond for cluster in found)
    tolerated = sum(cluster.tolerated for cluster in run.findings.clusters.values())
    tolerance = float(run.target.criterion.tolerance)
    wrong, abstained = run.counts[Status.WRONG.value], run.counts[Status.ABSTAINED.value]
    yield f"{_name(run.target)}: {counted(run.asked, 'row')} asked in {run.seconds:.1f} s, seed {run.plan.seed}"
    judged = f"; of those that were judged, {beyond:,} by more than {tolerance:g} u and {tolerated:,} by less"
    if run.answered:
        yield f"{_answers(wrong)} wrong{judged if wrong else ''}"
    else:
        yield "no row was answered, so no answer was judged"
    if abstained:
        yield f'{_answers(abstained)} "cannot say"'
    if found:
        yield f"kinds of wrong answers: {len(found)}, the worst first"
    for number, cluster in enumerate(found[:most], start=1):
        yield ""
        yield from _cluster(number, cluster, run.target)
    if len(found) > most:
        yield ""
        more = counted(len(found) - most, "more kind")
        yield f"and {more}, the worst of them {_u(found[most].worst)}; --show shows more"
    yield from _unanswered(run)


def minimised_lines(run: Minimised) -> Iterator[str]:
    """The report of a minimisation."""
    steps = len(run.steps) - 1
    yield f"{_name(run.target)}: {counted(steps, 'step')}, {counted(run.asked, 'row')} asked"
    yield _titled("given", f"{decimals(run.first.case.row)}, {_u(run.first)}")
    yield _titled("where", run.last.place.words)
    yield from _finding(run.last, run.target)


def _answers(number: int) -> str:
    return f"{counted(number, 'answer')} {'was' if number == 1 else 'were'}"


def _cluster(number: int, cluster: FindingCluster, target: HuntTarget) -> Iterator[str]:
    worst = cluster.worst
    yield f"{number}. {worst.case.mistake.value}, {_u(worst)}, {worst.place.words}"
    yield from _finding(worst, target)
    tolerated = f", and {cluster.tolerated:,} within tolerance" if cluster.tolerated else ""
    times = "once" if cluster.beyond == 1 else f"{cluster.beyond:,} times"
    yield _titled("found", f"{times}{tolerated}; the worst from {worst.source}")
    yield _titled("simplify", _command(target, "minimise", target.spec, decimals(worst.case.row)))


def _finding(finding: HuntFinding, target: HuntTarget) -> Iterator[str]:
    case = finding.case
    asked = judge_of(target.criterion.question)
    answer = asked.in_words(case.answer)
    yield _titled("row", _row(case.row, target))
    yield _titled("hex", ",".join(map(hex_of, case.row)))
    yield _titled(
        "truth",
        f"{asked.truth_in_words(case.truth)}; answered: {answer} ({case.mistake.value}, wrong by {_u(finding)})",
    )
    if case.time is not None:
        lower, upper = first_contact(case.row)
        yield _titled("time", f"answered: {case.time!r}; first contact between {lower!r} and {upper!r}")
    yield _titled("replay", _command(target, "replay", decimals(case.row), target.spec))


def _unanswered(run: Hunt) -> Iterator[str]:
    for status, fault in run.unanswered.items():
        yield ""
        yield f"{status.value}: {counted(run.counts[status.value], 'row')}; the first: {fault.reason}"
        if status is not Status.NOT_RUN:
            yield _titled("row", _row(fault.row, run.target))


def _command(target: HuntTarget, *words: str) -> str:
    """A command about the target, with the options with which it was opened."""
    given = [
        part for name, value in target.options if words[0] != "replay" or name != "--regimes" for part in (name, value)
    ]
    return shlex.join(("hypcheck", *words, *given))


def decimals(row: Sequence[float]) -> str:
    """A row as the command line reads it back."""
    return ",".join(repr(value).removesuffix(".0") for value in np.add(row, 0.0).tolist())


def _row(row: Sequence[float], target: HuntTarget) -> str:
    return f"{decimals(row)}  ({', '.join(target.layout.columns(len(row)))})"


def _u(finding: HuntFinding) -> str:
    """How wrong an answer is: in units u, a time in spheroid radii of the way."""
    if finding.case.time is not None:
        return f"{finding.error:.3g} spheroid radii"
    if finding.error_u == math.inf:
        return "inf u (no change of the inputs makes it right)" if finding.error == math.inf else "inf u"
    return f"{finding.error_u:.3g} u"


def _name(target: HuntTarget) -> str:
    name = target.implementation.description.name
    return f"{name} ({target.criterion.question}, {target.criterion.precision})"


def _titled(title: str, line: str) -> str:
    return f"   {title:9} {line}"
