"""A run of `hypcheck verify` without SPEC: hypcheck itself is derived, proved, cross-checked, judged and timed."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any

from hypcheck.cli.options import names_in
from hypcheck.cli.recording import perform, recording
from hypcheck.errors import Exit, InputError, RunOutcome


def self_check(
    title: str,
    settings: Mapping[str, Any] | None,
    *,
    out: Path,
    families: str | None,
    count: int,
    seed: int,
    tolerance: float,
    oracles: str,
    judged: int,
    roots: int,
    meshes: int,
    workers: int | None,
) -> Exit:
    """Run it as the options of these names say, and write the reports. Raises InputError where one is wrong."""
    from hypcheck.processes import usable_processors
    from hypcheck.verify import run
    from hypcheck.verify.plan import Plan

    plan = Plan(
        families=names_in(families),
        oracles=_oracles(oracles),
        count=max(1, count),
        judged=judged,
        roots=roots,
        meshes=meshes,
        seed=seed,
        workers=workers or usable_processors(),
        tolerance=Fraction(tolerance),
    )
    outcome = RunOutcome()
    with recording(out, run.options(plan), title, {"settings": settings}) as running:
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
