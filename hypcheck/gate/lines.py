"""What a run came to, as lines of the record, and what it means for the exit code."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import Any

from hypcheck import groups
from hypcheck.casebook.frozen import refusals
from hypcheck.gate.again import as_they_are
from hypcheck.gate.known_failures import no_longer_failing
from hypcheck.gate.plan import GatePlan
from hypcheck.gate.results import Result, merged
from hypcheck.gate.rules import Rules
from hypcheck.gate.schedule import State
from hypcheck.groups import Tally
from hypcheck.judge import Status
from hypcheck.methods.description import Description
from hypcheck.record import Recorder

FATAL = (Status.ERROR, Status.CRASH, Status.TIMEOUT, Status.PROTOCOL, Status.NONDETERMINISTIC, Status.NOT_RUN)


@dataclass
class GateOutcome:
    """What decides how the run ends: reasons for the exit codes 5 and 1, and how many cases were judged at all."""

    not_started: list[str] = field(default_factory=list)
    failed: list[str] = field(default_factory=list)
    judged: int = 0

    def copy(self) -> GateOutcome:
        """As it is now, whatever is added to it later."""
        return GateOutcome(list(self.not_started), list(self.failed), self.judged)

    @property
    def exit_code(self) -> int:
        """5 where an implementation could not be started or broke the protocol throughout, 1 where one failed."""
        if self.not_started:
            return 5
        return 1 if self.failed else 0


@dataclass(frozen=True)
class Lines:
    """Makes the lines about one implementation, which was opened by `spec` and judged by the rules."""

    plan: GatePlan
    spec: str
    declared: Description
    used: Description
    rules: Rules

    def add(self, state: State, recorder: Recorder, outcome: GateOutcome, *, finished: bool) -> None:
        """Record the state; where the run is not finished, open cases are judged as they were answered."""
        total = merged([replace(state.total, open=()), as_they_are(state.total.open, self.rules)])
        found = [self._group(family, tally) for family, tally in total.tallies.items()]
        for line in found:
            told = {"method": self.used.name, "spec": self.spec, "title": self.used.name, "exact": False}
            recorder.add("group", **told, **line)
        if finished:
            for sentence in no_longer_failing(self.rules.known, total.excusing, {*total.tallies, *total.named}):
                recorder.add("drift", sentence=f"{self.used.name}: {sentence}")
                outcome.failed.append(sentence)
        outcome.judged += sum(line["asked"] for line in found)
        for line in found:
            outcome.failed += [f"{self.used.name} on {line['family']}: {status}" for status in line["failing"]]
        self._conclude(state, total, found, recorder, outcome)

    def _group(self, family: str, tally: Tally) -> dict[str, Any]:
        wrong_fails = self.plan.fail_on == "wrong" or tally.dangerous > 0 or family == refusals.NAME
        grave = (Status.WRONG, *FATAL) if wrong_fails else FATAL
        failing = [status.value for status in grave if tally.counts.get(status.value)]
        fields = groups.line(tally, family, self.rules.criterion)
        return {**fields, "faults": groups.fault_lines(tally), "failing": failing}

    def _conclude(
        self, state: State, total: Result, found: Sequence[dict[str, Any]], recorder: Recorder, outcome: GateOutcome
    ) -> None:
        """The line about the implementation as a whole."""
        throughout = total.broke_protocol_throughout
        troubles = list(self._troubles(total, found))
        if throughout:
            outcome.not_started.append(f"{self.spec} broke the protocol throughout")
        outcome.failed += troubles
        recorder.add(
            "implementation",
            spec=self.spec,
            name=self.used.name,
            started=True,
            declared=asdict(self.declared),
            used=asdict(self.used),
            restarts=self.plan.limits.restarts - state.left.restarts,
            again=asdict(total.again),
            broke_protocol_throughout=throughout,
            troubles=troubles,
        )

    def _troubles(self, total: Result, found: Sequence[dict[str, Any]]) -> Iterator[str]:
        """What fails an implementation as a whole and no family of its own."""
        abstained = sum(line["counts"].get(Status.ABSTAINED.value, 0) for line in found)
        if abstained > self.plan.max_abstained:
            allowed = f"at most {self.plan.max_abstained} are allowed"
            yield f"{self.used.name} abstained from {abstained} cases; {allowed}"
        if self.plan.deterministic and total.again.within:
            changed = f"changed {total.again.within} answers within the tolerance"
            yield f"{self.used.name} {changed} when asked again"
