"""A run of `hypcheck verify SPEC`: implementations are gated against the frozen vectors and exact decisions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hypcheck.cli.options import limits_of, names_in
from hypcheck.cli.progress import watched
from hypcheck.cli.recording import label, recording
from hypcheck.cli.resuming import resumed
from hypcheck.errors import Exit, InputError, RunOutcome
from hypcheck.visible import printable

if TYPE_CHECKING:
    from hypcheck.gate.plan import GatePlan


@dataclass(frozen=True, kw_only=True)
class ConformanceOptions:
    """The options of this run, by the names that they have on the command line."""

    specs: tuple[str, ...]
    out: Path
    families: str | None
    count: int
    seed: int
    tolerance: float
    max_abstained: int
    fail_on: str
    deterministic: bool
    known_failures: Path | None
    update: bool
    precision: str | None
    question: str | None
    domain: str | None
    startup_timeout: float
    timeout: float
    restarts: int
    memory: str
    workers: int | None
    cluster: str | None
    resume: Path | None

    def plan(self) -> GatePlan:
        """The plan of the run. Raises InputError where an option is wrong."""
        from hypcheck.gate.plan import GatePlan
        from hypcheck.methods.description import parse_domain

        to_make = self.update and self.known_failures is not None and not self.known_failures.exists()
        plan = GatePlan(
            specs=self.specs,
            families=names_in(self.families),
            count=self.count,
            seed=self.seed,
            tolerance=Fraction(self.tolerance),
            max_abstained=self.max_abstained,
            fail_on=self.fail_on,
            deterministic=self.deterministic,
            known_failures=None if to_make else self.known_failures,
            precision=self.precision,
            question=self.question,
            domain=None if self.domain is None else parse_domain(self.domain),
            limits=limits_of(self.startup_timeout, self.timeout, self.restarts, self.memory),
            workers=self.workers,
            cluster=self.cluster,
        )
        if self.update and (self.known_failures is None or plan.filtered):
            raise InputError(
                "--update needs --known-failures and a run of all families, or it would forget what it skipped"
            )
        return plan


def conformance(options: ConformanceOptions, title: str, settings: Mapping[str, Any] | None) -> int:
    """Run it, begun anew or gone on with, write the reports, and give the exit code.

    Raises InputError where an option is wrong.
    """
    from hypcheck.gate import run
    from hypcheck.gate.fingerprint import fingerprints
    from hypcheck.gate.known_failures import update
    from hypcheck.gate.ourselves import Unchanged
    from hypcheck.gate.plan import size
    from hypcheck.gate.resume import Resumed
    from hypcheck.report.write import import_all

    plan, out = options.plan(), options.out
    shown = {**asdict(plan), "tolerance": options.tolerance, "known_failures": str(plan.known_failures or "")}
    cases, files = size(plan), fingerprints(plan.specs, plan.known_failures)
    import_all()
    unchanged = Unchanged(files)
    begun = Resumed() if options.resume is None else resumed(options.resume, out, plan, shown, files, cases)
    if isinstance(begun, int):
        return begun
    outcome, optional = RunOutcome(), {"files": files, "program": unchanged.program, "settings": settings}
    with recording(out, shown, title, optional, begun.carried) as running:
        with watched(cases * len(plan.specs), label("gate"), "cases", begun.done(cases)) as pace:
            run.run(plan, running.recorder, outcome, pace.advance, begun.state)
        changed = unchanged.record_changes(running.recorder)
        running.exit_code = Exit.WRONG if changed and not outcome.exit_code else outcome.exit_code
    if options.update and options.known_failures is not None and running.record is not None and not changed:
        click.echo(printable(update(options.known_failures, running.record)))
    return running.exit_code
