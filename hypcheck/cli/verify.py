"""`hypcheck verify`: options into a plan, the run under a progress bar, the reports, the exit code."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

import click

from hypcheck.errors import InputError

if TYPE_CHECKING:
    from hypcheck.record import Record
    from hypcheck.verify.plan import Plan
    from hypcheck.verify.run import Outcome, Stage


@click.command(short_help="Derive, prove, cross-check four oracles, judge and time; write the reports.")
@click.option("--out", type=click.Path(path_type=Path), default=Path("reports/latest"), show_default=True)
@click.option("--families", help="Names and globs, separated by commas.  [default: all but the extreme ones]")
@click.option("--oracles", default="exact,nearest,roots,mesh", show_default=True, help="Which oracles to ask.")
@click.option("--count", type=click.IntRange(1), default=400, show_default=True, help="Rows of each family.")
@click.option("--judged", type=click.IntRange(1), default=400, show_default=True, help="Of these, asked of methods.")
@click.option(
    "--roots", type=click.IntRange(1), default=1500, show_default=True, help="Rows in all for the roots oracle."
)
@click.option(
    "--meshes", type=click.IntRange(1), default=2000, show_default=True, help="Rows in all for the mesh oracle."
)
@click.option("--seed", type=click.IntRange(0, 2**63 - 1), default=1, show_default=True)
@click.option("--workers", type=click.IntRange(1), help="Processes for the oracles.  [default: one a processor]")
@click.option("--tolerance", type=click.FloatRange(0), default=8.0, show_default=True, help="In units u.")
@click.pass_context
def verify(
    context: click.Context,
    out: Path,
    families: str | None,
    oracles: str,
    count: int,
    judged: int,
    roots: int,
    meshes: int,
    seed: int,
    workers: int | None,
    tolerance: float,
) -> None:
    """Derive the coefficients, prove the formulas, cross-check four oracles, judge every method, time the fast path.

    Reports are written to --out: record.jsonl, summary.json, report.md, junit.xml and a picture.

    Ends with 0 when the oracles agree and the fast path is exact, 6 when oracles disagree, 1 when an exact method
    erred or the mathematical findings are not the known ones.
    """
    from hypcheck.report.terminal import summary_lines
    from hypcheck.report.write import write_reports
    from hypcheck.verify.plan import Plan
    from hypcheck.verify.run import Outcome, default_workers

    plan = Plan(
        families=_names(families or ""),
        oracles=_oracles(oracles),
        count=count,
        judged=judged,
        roots=roots,
        meshes=meshes,
        seed=seed,
        workers=workers or default_workers(),
        tolerance=Fraction(tolerance),
    )
    outcome = Outcome()
    record = _recorded(plan, outcome, out)
    for line in summary_lines(record, write_reports(record, out), colour=sys.stdout.isatty()):
        click.echo(line)
    context.exit(outcome.exit_code)


def _recorded(plan: Plan, outcome: Outcome, out: Path) -> Record:
    """Run the plan and keep its record in `out`; of an interrupted run what was finished is kept, and reported."""
    from hypcheck.record import Recorder, read
    from hypcheck.report.write import write_reports
    from hypcheck.verify.run import options, stages

    growing, path = out / "record.jsonl.part", out / "record.jsonl"
    try:
        out.mkdir(parents=True, exist_ok=True)
        stream = growing.open("w", encoding="utf-8", errors="backslashreplace")
    except OSError as error:
        raise InputError(f"--out {out}: cannot be written: {error.strerror}") from None
    with stream:
        recorder = Recorder(stream, options(plan))
        try:
            _run(stages(plan, recorder, outcome))
            record = recorder.close(outcome.exit_code)
        except InputError:
            growing.unlink()
            raise
        except BaseException:
            growing.replace(path)
            write_reports(read(path), out)
            raise
    growing.replace(path)
    return record


def _run(parts: Sequence[Stage]) -> None:
    """Every part in turn, under a progress bar where a person is watching."""
    if not sys.stderr.isatty():
        for part in parts:
            part.run(lambda _: None)
        return
    with click.progressbar(length=sum(part.steps for part in parts), file=sys.stderr, show_pos=False) as bar:
        for part in parts:
            bar.label = f"{part.title:28}"
            part.run(bar.update)


def _names(text: str) -> tuple[str, ...]:
    return tuple(name.strip() for name in text.split(",") if name.strip())


def _oracles(text: str) -> tuple[str, ...]:
    from hypcheck.verify.opinions import ORACLES

    names = _names(text)
    unknown = [name for name in names if name not in ORACLES]
    if unknown or not names:
        raise InputError(f"--oracles: {unknown[0] if unknown else text!r} is no oracle; there are {', '.join(ORACLES)}")
    return names
