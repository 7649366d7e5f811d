"""A run of `hypcheck verify SPEC`: implementations are gated against the frozen vectors and exact decisions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
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


def conformance(
    title: str,
    settings: Mapping[str, Any] | None,
    *,
    specs: tuple[str, ...],
    out: Path,
    families: str | None,
    count: int,
    seed: int,
    tolerance: float,
    max_abstained: int,
    fail_on: str,
    deterministic: bool,
    known_failures: Path | None,
    update: bool,
    precision: str | None,
    question: str | None,
    domain: str | None,
    startup_timeout: float,
    timeout: float,
    restarts: int,
    memory: str,
    workers: int | None,
    cluster: str | None,
    resume: Path | None,
) -> int:
    """Run it as the options of these names say, write the reports, and give the exit code.

    Raises InputError where an option is wrong.
    """
    from hypcheck.gate.plan import GatePlan
    from hypcheck.methods.description import parse_domain

    to_make = update and known_failures is not None and not known_failures.exists()
    plan = GatePlan(
        specs=specs,
        families=names_in(families),
        count=count,
        seed=seed,
        tolerance=Fraction(tolerance),
        max_abstained=max_abstained,
        fail_on=fail_on,
        deterministic=deterministic,
        known_failures=None if to_make else known_failures,
        precision=precision,
        question=question,
        domain=None if domain is None else parse_domain(domain),
        limits=limits_of(startup_timeout, timeout, restarts, memory),
        workers=workers,
        cluster=cluster,
    )
    if update and (known_failures is None or plan.filtered):
        raise InputError(
            "--update needs --known-failures and a run of all families, or it would forget what it skipped"
        )
    shown = {**asdict(plan), "tolerance": tolerance, "known_failures": str(plan.known_failures or "")}
    return _run(plan, shown, out, resume, title, settings, updated=known_failures if update else None)


def _run(
    plan: GatePlan,
    shown: Mapping[str, Any],
    out: Path,
    resume: Path | None,
    title: str,
    settings: Mapping[str, Any] | None,
    *,
    updated: Path | None,
) -> int:
    """Run the plan, begun anew or gone on with; `updated` are the known failures to write anew from it."""
    from hypcheck.gate import run
    from hypcheck.gate.fingerprint import fingerprints
    from hypcheck.gate.known_failures import update
    from hypcheck.gate.ourselves import Unchanged
    from hypcheck.gate.plan import size
    from hypcheck.gate.resume import Resumed
    from hypcheck.report.write import import_all

    cases, files = size(plan), fingerprints(plan.specs, plan.known_failures)
    import_all()
    unchanged = Unchanged(files)
    begun = Resumed() if resume is None else resumed(resume, out, plan, shown, files, cases)
    if isinstance(begun, int):
        return begun
    outcome, optional = RunOutcome(), {"files": files, "program": unchanged.program, "settings": settings}
    with recording(out, shown, title, optional, begun.carried) as running:
        with watched(cases * len(plan.specs), label("gate"), "cases", begun.done(cases)) as pace:
            run.run(plan, running.recorder, outcome, pace.advance, begun.state)
        changed = unchanged.record_changes(running.recorder)
        running.exit_code = Exit.WRONG if changed and not outcome.exit_code else outcome.exit_code
    if updated is not None and running.record is not None and not changed:
        click.echo(printable(update(updated, running.record)))
    return running.exit_code
