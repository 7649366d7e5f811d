"""How the run ended, in one sentence, and what failed it: no more than the record's own lines say.

A misprint in the paper or a wrong answer of one of its procedures is a finding and fails nothing. What fails a run is a
proof that does not hold, oracles that disagree, a method that promises to be exact and errs or any method that breaks
down, and findings other than the known ones.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain

from hypcheck.judge import UNANSWERED, in_words
from hypcheck.pairs import Position
from hypcheck.record import Record
from hypcheck.record.lines import Disagreement, Drift, Group, NotStarted, Oracle, Proof
from hypcheck.report import benchmark
from hypcheck.report.digest import (
    Implementation,
    OracleTotal,
    implementations,
    in_order,
    names_in,
    oracle_totals,
    subject_of,
    under_test,
    worst_error_u,
)
from hypcheck.report.failure import Failure
from hypcheck.report.measured import measured
from hypcheck.report.replays import Replays
from hypcheck.report.text import classify_command, counted, figure, from_hex, listed

MEANINGS = {
    1: "wrong answers, or findings other than the known ones",
    2: "nothing was judged",
    3: "slower than the baseline allows",
    4: "too noisy to tell",
    5: "an implementation could not be started or broke the protocol",
    6: "the oracles or a proof contradict each other",
    70: "an internal error of hypcheck",
    130: "interrupted",
    143: "terminated",
}
"""What an exit code means, for the case that no other line of the record explains it."""

UNFINISHED = (70, 130, 143)
"""The exit codes of runs that stopped before their end."""

INCONCLUSIVE = 4
"""The exit code of a run that neither passed nor failed."""

HARMLESS = ("right", "skipped")
"""How a case may end under a method that promises to be exact."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """Whether the run passed, in a bool and in a sentence; a run without its end has not."""

    passed: bool
    sentence: str


def failures(record: Record) -> list[Failure]:
    """Everything in the record that fails the run, worst first."""
    return list(
        chain(
            _oracles(record),
            _proofs(record),
            _starts(record),
            _implementations(record),
            _abstentions(record),
            _drift(record),
            benchmark.failures(record),
        )
    )


def _oracles(record: Record) -> Iterator[Failure]:
    for line in record.of(Oracle):
        yield from (_disagreement(line, case) for case in line.disagreements)
        rest = line.disagreeing - len(line.disagreements)
        if rest > 0:
            message = f"{line.oracle} on {line.family}: {counted(rest, 'further case')}, not kept in the record"
            yield Failure("oracle", line.oracle, line.family, "disagreement", message, count=rest)


def _disagreement(line: Oracle, case: Disagreement) -> Failure:
    message = f"{case.oracle}: {case.opinion}; exact decision: {case.exact}"
    replay = classify_command(from_hex(case.row))
    return Failure("oracle", line.oracle, line.family, "disagreement", message, case.case, replay=replay)


def _proofs(record: Record) -> Iterator[Failure]:
    for line in record.of(Proof):
        if not line.holds:
            message = f"{line.formula}: not proved: {line.statement}"
            yield Failure("proof", line.formula, line.quantity, "unproved", message)


def _starts(record: Record) -> Iterator[Failure]:
    """Implementations that could not be started, or broke the protocol throughout."""
    for tested in under_test(record):
        if isinstance(tested.line, NotStarted):
            yield Failure("implementation", tested.name, "start", "not-started", str(tested.line.trouble))
        elif tested.line.broke_protocol_throughout:
            message = f"{tested.name} broke the protocol throughout"
            yield Failure("implementation", tested.name, "start", "protocol", message)


def _abstentions(record: Record) -> Iterator[Failure]:
    """What fails an implementation as a whole and no family of its own: abstentions, answers that change."""
    for tested in under_test(record):
        for trouble in [] if isinstance(tested.line, NotStarted) else tested.line.troubles:
            yield Failure("implementation", tested.name, "all families", "behaviour", trouble)


def _implementations(record: Record) -> Iterator[Failure]:
    replays, names = Replays.of(record), names_in(record)
    for line in record.of(Group):
        for status, number in in_order(Counter(line.counts)).items():
            if status in (line.failing or ()) or _breaks_promise(line, status):
                yield _broken(names[subject_of(line)], line, status, number, replays)


def _breaks_promise(line: Group, status: str) -> bool:
    """Whether a status fails a method of the project itself; of a gated one the record says what fails it."""
    return status not in HARMLESS if line.exact else status in UNANSWERED


def _broken(name: str, line: Group, status: str, number: int, replays: Replays) -> Failure:
    family = line.family
    promise = " promises to be exact, but" if line.exact else ":"
    message = f"{name}{promise} {number:,} of {counted(line.asked, 'case')} ended as {status}"
    first = next((case for case in line.worst if case.status == status), None)
    fault = next((case for case in line.faults or () if case.status == status), None)
    if fault is not None:
        message += f"; {fault.case}: {fault.reason}"
    elif first is not None:
        said = in_words(first.answer, line.question)
        message += f"; {first.case} is {Position(first.truth).label}; answered: {said}"
        message += f" ({first.mistake}, wrong by {figure(float(first.backward_error_u))} u)"
    case = first if fault is None else fault
    if case is None:
        return Failure("implementation", name, family, status, message)
    place, replay = replays.place(case), replays.command(line, case)
    return Failure("implementation", name, family, status, message, case.case, place, replay)


def _drift(record: Record) -> Iterator[Failure]:
    for line in record.of(Drift):
        yield Failure("findings", "known findings", "drift", "drift", str(line.sentence))


def verdict(record: Record) -> Verdict:
    """How the run ended."""
    found = failures(record)
    if record.footer is None:
        so_far = f" What was finished has already failed: {_named(found)}." if found else ""
        return Verdict(False, f"TRUNCATED: the record has no end; the run was interrupted and is no pass.{so_far}")
    code = record.footer.exit_code
    if code == 0 and found:
        return Verdict(False, f"CONTRADICTORY: the record ends with exit code 0, but holds {_named(found)}.")
    if code == 0:
        return _held(record)
    reason = "; ".join(part for part in (MEANINGS.get(code, "") if code in UNFINISHED else "", _named(found)) if part)
    reason = reason or MEANINGS.get(code, "no line of the record says why")
    if code == INCONCLUSIVE:
        open_ = f"{counted(len(found), 'comparison')} too noisy to tell" if found else reason
        what_helps = "A quieter machine or more --processes would tell."
        return Verdict(False, f"INCONCLUSIVE, exit code {code}: {open_}. {what_helps}")
    return Verdict(False, f"FAILED with exit code {code}: {reason}.")


def _named(found: list[Failure]) -> str:
    """The failures by subject: "2 disagreements of oracles and 1 failed proof"."""
    nouns = {
        "oracle": "disagreement of oracles|disagreements of oracles",
        "proof": "failed proof|failed proofs",
        "implementation": "implementation failure|implementation failures",
        "findings": "drift from what is known|drifts from what is known",
        "measurement": "failed measurement|failed measurements",
    }
    counts = [(sum(each.count for each in found if each.subject == subject), noun) for subject, noun in nouns.items()]
    return listed([f"{number:,} {noun.split('|')[number != 1]}" for number, noun in counts if number])


def _held(record: Record) -> Verdict:
    totals = [total for total in oracle_totals(record) if total.asked]
    tested = [each for each in implementations(record) if each.asked]
    compared = [each for each in measured(record) if each.asked or each.speed]
    if (
        not totals
        and not tested
        and not compared
        and not any(isinstance(line, benchmark.ALONE) for line in record.lines)
    ):
        return Verdict(False, "NOTHING was asked and nothing was judged: this is no pass.")
    proofs = len(record.of(Proof))
    clauses = [
        *([_oracle_clause(totals)] if totals else []),
        *([f"{counted(proofs, 'proof')} {'holds' if proofs == 1 else 'hold'}"] if proofs else []),
        *(f"{each.name} right on all {counted(each.asked, 'case')}" for each in tested if each.exact),
        *(_gated_clause(each) for each in tested if each.gated),
        *benchmark.clauses(record),
    ]
    return Verdict(True, f"HELD: {'; '.join(clauses)}." if clauses else "HELD: nothing failed.")


def _gated_clause(each: Implementation) -> str:
    """What a gated implementation has shown: how its cases ended, skipped ones apart."""
    ended = ", ".join(f"{number:,} {status}" for status, number in each.statuses.items() if status != "skipped")
    return f"{each.name}: {ended}; worst backward error {figure(worst_error_u(each.worst))} u"


def _oracle_clause(totals: list[OracleTotal]) -> str:
    """What the oracles show together; of one alone no agreement is claimed."""
    undecided = sum(total.undecided for total in totals)
    doubt = f", {undecided:,} undecided" if undecided else ""
    if len(totals) == 1:
        return f"{counted(totals[0].asked, 'case')} asked of {totals[0].name} and of no other oracle{doubt}"
    return (
        f"no disagreement in the cases asked of {listed([f'{each.name} ({each.asked:,})' for each in totals])}{doubt}"
    )
