"""A run as test suites: a suite for each subject, a case for each thing that could have gone wrong in it.

What fails the run is a failure; a run that stopped before its end is an error. What the paper's own formulas get wrong
is expected, so it is a passed case whose output says what was found (docs/record.md, "junit.xml").
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import replace

from hypcheck.record import Record
from hypcheck.record.lines import Equation, Finding, Group, Oracle, Proof
from hypcheck.report.benchmark_suites import benchmark_suites
from hypcheck.report.claims import claims
from hypcheck.report.digest import (
    Implementation,
    explanation,
    implementations,
    in_order,
    oracle_totals,
    under_test,
    worst_case,
)
from hypcheck.report.failure import Failure
from hypcheck.report.replays import Replays
from hypcheck.report.suite import Case, Suite, Trouble, details, total
from hypcheck.report.text import classify_command, counted, figure, from_hex
from hypcheck.report.verdict import UNFINISHED, failures, verdict

_EVER = 1e15
"""Milliseconds that no run takes; what a record says beyond it is no time."""


def suites(record: Record) -> Iterator[Suite]:
    """The suites of a record, some of them empty."""
    failed = failures(record)
    others = list(_others(record, failed))
    yield Suite("run", (replace(_ended(record, failed), milliseconds=_rest(record, others)),))
    yield from others


def _rest(record: Record, others: Iterable[Suite]) -> int | None:
    """The time of the run that no other case accounts for; None where the run has no end, or no time."""
    seconds = None if record.footer is None else record.footer.seconds
    if seconds is None:
        return None
    whole: int = round(min(1000 * seconds, _EVER))
    return max(0, whole - (total(suite.milliseconds for suite in others) or 0))


def _others(record: Record, failed: list[Failure]) -> Iterator[Suite]:
    """The suites behind that of the run itself."""
    yield Suite("proofs", tuple(_named_apart(_proof(line) for line in record.of(Proof))))
    yield Suite("equations", tuple(_named_apart(_equation(line) for line in record.of(Equation))))
    for oracle in oracle_totals(record):
        lines = [line for line in record.of(Oracle) if line.oracle == oracle.name]
        if oracle.unavailable is not None:
            trouble = Trouble("skipped", "unavailable", f"not available: {oracle.unavailable}")
            yield Suite(f"oracles.{oracle.name}", (Case("available", trouble),))
        else:
            yield Suite(f"oracles.{oracle.name}", tuple(_oracle(line, failed) for line in lines))
    yield Suite("findings", tuple(_findings(record, failed)))
    replays = Replays.of(record)
    for implementation in implementations(record):
        cases = tuple(_group(implementation, group, failed, replays) for group in implementation.groups)
        yield Suite(f"implementations.{implementation.name}", cases)
    yield Suite("implementations", tuple(_as_wholes(record, failed)))
    yield from benchmark_suites(record, failed)


def _ended(record: Record, failed: list[Failure]) -> Case:
    """The end of the run: an error where it was not reached, or where the exit code is not that of the record's lines.

    That some other case failed is not repeated here.
    """
    ended = verdict(record)
    unfinished = record.footer is None or record.footer.exit_code in UNFINISHED
    unexplained = not ended.passed and not failed
    contradictory = bool(failed) and record.footer is not None and record.footer.exit_code == 0
    if unfinished or unexplained or contradictory:
        return Case("ended", Trouble("error", "unfinished" if unfinished else "unexplained", ended.sentence))
    return Case("ended", output=(ended.sentence,))


def _proof(line: Proof) -> Case:
    name = f"{line.formula}: {line.quantity}"
    if line.holds:
        return Case(name, output=(line.statement,))
    return Case(name, Trouble("failure", "unproved", f"not proved: {line.statement}"))


def _equation(line: Equation) -> Case:
    output = [f"{line.verdict}: {line.finding}", f"printed: {line.statement}"]
    if not line.holds:
        output.append(f"derived: {line.correction}")
    return Case(f"({line.number})", output=tuple(output))


def _named_apart(cases: Iterable[Case]) -> Iterator[Case]:
    """The cases under names of their own: parsers merge those that are called alike."""
    seen: Counter[str] = Counter()
    for case in cases:
        seen[case.name] += 1
        number = seen[case.name]
        yield case if number == 1 else replace(case, name=f"{case.name} ({number})")


def _oracle(line: Oracle, failed: list[Failure]) -> Case:
    stages = ", ".join(f"{stage} {number:,}" for stage, number in line.stages.items())
    output = (f"{counted(line.asked, 'case')}, {line.undecided:,} undecided: {stages}",)
    milliseconds = round(min(1000 * line.seconds, _EVER))
    place = ("oracle", line.oracle, line.family)
    mine = [each for each in failed if (each.subject, each.name, each.group) == place]
    if mine:
        message = f"{counted(line.disagreeing, 'disagreement')} in {counted(line.asked, 'case')}"
        trouble = Trouble("failure", "disagreement", f"{message}; first: {mine[0].message}", tuple(details(mine)))
        return Case(line.family, trouble, output, milliseconds)
    if line.undecided == line.asked:
        return Case(line.family, Trouble("skipped", "undecided", "no case could be decided"), output, milliseconds)
    return Case(line.family, None, output, milliseconds)


def _findings(record: Record, failed: list[Failure]) -> Iterator[Case]:
    """A case for each mathematical finding, and one that says whether they are the known ones."""
    yield from _named_apart(map(_finding, record.of(Finding)))
    drifted = [each for each in failed if each.subject == "findings"]
    if drifted:
        message = "; ".join(each.message for each in drifted)
        yield Case("known findings", Trouble("failure", "drift", message, tuple(details(drifted))))
    elif record.of(Finding):
        yield Case("known findings", output=("the findings are the known ones",))


def _finding(line: Finding) -> Case:
    where = "inside" if line.inside else "outside"
    return Case(
        f"{line.formula} on {line.family}",
        output=(
            f"wrong in exact arithmetic, {where} its stated regimes: {line.wrong:,} of {line.asked:,}",
            explanation(line),
            f"first case: {line.first_case}",
            f"replay: {classify_command(from_hex(line.first_row))}",
        ),
    )


def _as_wholes(record: Record, failed: list[Failure]) -> Iterator[Case]:
    """A case for each gated implementation: that it was started, and did nothing that no family of its own shows."""
    for tested in under_test(record):
        families = {group.family for group in tested.groups}
        mine = [each for each in failed if each.name == tested.name and each.group not in families]
        if mine:
            message = "; ".join(each.message for each in mine)
            yield Case(tested.name, Trouble("failure", mine[0].kind, message))
        else:
            yield Case(tested.name, output=tuple(claims(tested.line)))


def _group(implementation: Implementation, group: Group, failed: list[Failure], replays: Replays) -> Case:
    """A family: it fails where any status in which its cases ended fails the run; the output has all of them."""
    counts, output = in_order(Counter(group.counts)), []
    cases = sum(counts.values())
    for status, number in counts.items():
        output.append(f"{status}: {number:,} of {counted(cases, 'case')}")
        worst = worst_case([case for case in group.worst if case.status == status])
        if worst is not None:
            numbered = f" ({replays.place(worst)})" if implementation.gated else ""
            error = figure(float(worst.backward_error_u))
            output.append(f"worst backward error: {error} u, case {worst.case}{numbered}")
            output.append(f"replay: {replays.command(group, worst)}")
    place = ("implementation", implementation.name, group.family)
    mine = [each for each in failed if (each.subject, each.name, each.group) == place and each.kind in counts]
    if mine:
        message = "; ".join(each.message for each in mine)
        trouble = Trouble("failure", mine[0].kind, message, tuple(details(mine)))
        return Case(group.family, trouble, tuple(output))
    if set(counts) == {"skipped"}:
        message = f"all {counted(cases, 'case')} lie outside the method's domain or are no numbers of its format"
        return Case(group.family, Trouble("skipped", "skipped", message))
    return Case(group.family, None, tuple(output))
