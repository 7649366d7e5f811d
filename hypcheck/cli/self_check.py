"""A run of `hypcheck verify` without SPEC: hypcheck itself is derived, proved, cross-checked, judged and timed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

from hypcheck.cli.options import names_in
from hypcheck.cli.recording import perform, recording
from hypcheck.errors import Exit, InputError, RunOutcome


@dataclass(frozen=True, kw_only=True)
class SelfCheckOptions:
    """The options of this run, by the names that they have on the command line."""

    out: Path
    families: str | None
    count: int
    seed: int
    tolerance: float
    oracles: str
    judged: int
    roots: int
    meshes: int
    workers: int | None


def self_check(options: SelfCheckOptions, title: str, settings: Mapping[str, Any] | None) -> Exit:
    """Run it and write the reports. Raises InputError where an option is wrong."""
    from hypcheck.processes import usable_processors
    from hypcheck.verify import run
    from hypcheck.verify.plan import Plan

    plan = Plan(
        families=names_in(options.families),
        oracles=_oracles(options.oracles),
        count=max(1, options.count),
        judged=options.judged,
        roots=options.roots,
        meshes=options.meshes,
        seed=options.seed,
        workers=options.workers or usable_processors(),
        tolerance=Fraction(options.tolerance),
    )
    outcome = RunOutcome()
    with recording(options.out, run.options(plan), title, {"settings": settings}) as running:
        perform(run.stages(plan, running.recorder, outcome))
        running.exit_code = outcome.exit_code
    return outcome.exit_code


def _oracles(text: str) -> tuple[str, ...]:
    from hypcheck.verify.opinions import ORACLES

    names = names_in(text)
    unknown = [name for name in names if name not in ORACLES]
    if unknown or not names:
        raise InputError(f"--oracles: {unknown[0] if unknown else text!r} is no oracle; there are {', '.join(ORACLES)}")
    return names
