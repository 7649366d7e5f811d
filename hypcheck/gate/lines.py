"""What a run came to, as lines of the record, and what it means for the exit code."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace

from msgspec import UNSET

from hypcheck import tally
from hypcheck.casebook.frozen import refusals
from hypcheck.errors import Exit, NothingJudgedError, RunOutcome
from hypcheck.gate.conformance import Rules
from hypcheck.gate.known_failures import no_longer_failing
from hypcheck.gate.plan import GatePlan
from hypcheck.gate.results import Result, merged
from hypcheck.gate.retest import as_they_are
from hypcheck.gate.schedule import State
from hypcheck.judge import UNANSWERED, Status
from hypcheck.methods.description import Description
from hypcheck.record import Line, Recorder, lines
from hypcheck.record.fields import decoded
from hypcheck.record.lines import Drift, Group, Implementation, NotStarted
from hypcheck.tally import Tally


def as_recorded(description: Description) -> lines.Description:
    """What an implementation says of itself, as the record has it."""
    return decoded(asdict(description), lines.Description)


def outcome_of(recorded: Iterable[Line], outcome: RunOutcome) -> None:
    """Add the reasons that the lines of a run tell, which are all that there are.

    Raises NothingJudgedError where not one case was judged, which proves nothing.
    """
    judged = 0
    not_started, failed = outcome.because[Exit.NOT_STARTED], outcome.because[Exit.WRONG]
    for line in recorded:
        if isinstance(line, Group):
            judged += line.asked
            failed += [f"{line.method} on {line.family}: {status}" for status in line.failing or ()]
        elif isinstance(line, Drift):
            failed.append(line.sentence)
        elif isinstance(line, NotStarted):
            not_started.append(line.trouble)
        elif isinstance(line, Implementation):
            if line.broke_protocol_throughout:
                not_started.append(f"{line.spec} broke the protocol throughout")
            failed += line.troubles
    if not judged and not not_started:
        raise NothingJudgedError(
            "no case was judged: every one lies outside the domain, or cannot be written in the declared precision"
        )


@dataclass(frozen=True)
class Lines:
    """Makes the lines about one implementation, which was opened by `spec` and judged by the rules."""

    plan: GatePlan
    spec: str
    declared: Description
    used: Description
    rules: Rules

    def add(self, state: State, recorder: Recorder, *, finished: bool) -> None:
        """Record the state; where the run is not finished, open cases are judged as they were answered."""
        total = merged([replace(state.total, open=()), as_they_are(state.total.open, self.rules)])
        found = [self._group(family, tallied) for family, tallied in total.tallies.items()]
        for line in found:
            recorder.add(line)
        if finished:
            for sentence in no_longer_failing(self.rules.known, total.excusing, {*total.tallies, *total.named}):
                recorder.add(Drift(sentence=f"{self.used.name}: {sentence}"))
        self._conclude(state, total, found, recorder, finished=finished)

    def _group(self, family: str, tallied: Tally) -> Group:
        wrong_fails = self.plan.fail_on == "wrong" or tallied.dangerous > 0 or family == refusals.NAME
        grave = (Status.WRONG, *UNANSWERED) if wrong_fails else UNANSWERED
        failing = [status.value for status in grave if tallied.counts.get(status.value)]
        name = self.used.name
        return tally.line(
            tallied, family, self.rules.criterion, method=name, title=name, spec=self.spec, failing=failing
        )

    def _conclude(
        self, state: State, total: Result, found: Sequence[Group], recorder: Recorder, *, finished: bool
    ) -> None:
        """The line about the implementation as a whole."""
        recorder.add(
            Implementation(
                spec=self.spec,
                name=self.used.name,
                declared=as_recorded(self.declared),
                used=as_recorded(self.used),
                restarts=self.plan.limits.restarts - state.left.restarts,
                again=total.again,
                broke_protocol_throughout=total.broke_protocol_throughout,
                troubles=list(self._troubles(total, found)),
                finished=UNSET if finished else False,
            )
        )

    def _troubles(self, total: Result, found: Sequence[Group]) -> Iterator[str]:
        """What fails an implementation as a whole and no family of its own."""
        abstained = sum(line.counts.get(Status.ABSTAINED.value, 0) for line in found)
        if abstained > self.plan.max_abstained:
            allowed = f"at most {self.plan.max_abstained} are allowed"
            yield f"{self.used.name} abstained from {abstained} cases; {allowed}"
        if self.plan.deterministic and total.again.within:
            changed = f"changed {total.again.within} answers within the tolerance"
            yield f"{self.used.name} {changed} when asked again"
