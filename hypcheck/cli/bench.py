"""`hypcheck bench`: options into a plan, the run under a progress bar, the reports, the exit code."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hypcheck.cli.options import LARGEST_SEED, MOST_PROCESSES, IntegerOption, NumberOption, OutputPath, names_in
from hypcheck.cli.recording import recording, run_stages
from hypcheck.cli.settings import in_effect
from hypcheck.errors import Exit, InputError, RunOutcome

if TYPE_CHECKING:
    pass


@click.command(short_help="Compare methods by error and run time, and hold their speed to an earlier run.")
@click.argument("specs", nargs=-1, metavar="[SPEC]...")
@click.option("--out", type=OutputPath(), default=Path("reports/bench"), show_default=True)
@click.option(
    "--quick", is_flag=True, help="Half a minute instead of five: fewer rows, rounds and meshes; no scenes, no forest."
)
@click.option("--methods", help="Names and globs, separated by commas.  [default: all]")
@click.option("--workloads", help="Names and globs, separated by commas.  [default: all]")
@click.option("--seed", type=IntegerOption(0, LARGEST_SEED), default=1, show_default=True)
@click.option("--processes", type=IntegerOption(1), help="Fresh processes that measure.  [default: 5; quick: 3]")
@click.option("--rounds", type=IntegerOption(1), help="Rounds in each process.  [default: 5; quick: 3]")
@click.option(
    "--workers", type=IntegerOption(1, MOST_PROCESSES), help="Processes that judge.  [default: one a processor]"
)
@click.option("--baseline", type=click.Path(path_type=Path), help="An earlier record, or its folder, to be held to.")
@click.option("--max-slowdown", type=NumberOption(1), help="What --baseline allows.  [default: 1.1]")
@click.option("--kernel", is_flag=True, help="Measure the fast path against its targets, and nothing else.")
@click.option("--forest", is_flag=True, help="Measure a walker's step among 10 to 10^6 trees, and nothing else.")
@click.option(
    "--scene", multiple=True, metavar="SCENE", help="Measure what this scene saves, and nothing else; any number."
)
@click.pass_context
def bench(context: click.Context, /, specs: tuple[str, ...], **options: Any) -> None:  # noqa: ANN401  click's options
    """Compare methods by error and by run time, on the same rows.

    Every method is judged by the flip distance of the rows it gets wrong, then timed in fresh processes, in rounds that
    take all methods in turn. A SPEC (builtin:NAME, python:…, library:path.so, command:…) is measured beside them.

    With --baseline, times relative to the reference method are held to those of an earlier record, of this machine or
    another. That and --kernel are the gates of speed, and without one no time fails the run: 3 when one is slower than
    the gate allows, 4 when the machine was too noisy to tell. Ends with 1 when a method that promises to be exact
    erred, or one answered otherwise while it was timed, 5 when a SPEC could not be started, else with 0.
    """
    from dataclasses import replace
    from tempfile import TemporaryDirectory

    from hypcheck.bench import run
    from hypcheck.bench.plan import FULL, MAX_SLOWDOWN, QUICK, BenchPlan
    from hypcheck.processes import usable_processors
    from hypcheck.record.writer import Provenance
    from hypcheck.report.write import import_all
    from hypcheck.runs.fingerprint import FileSnapshot, fingerprints

    quick = options["quick"]
    if options["max_slowdown"] is not None and options["baseline"] is None:
        raise InputError("--max-slowdown holds a run to an earlier one; name that one with --baseline")
    plan = BenchPlan(
        specs=specs,
        methods=names_in(options["methods"]),
        workloads=names_in(options["workloads"]),
        quick=quick,
        amounts=QUICK if quick else FULL,
        seed=options["seed"],
        processes=options["processes"] or (3 if quick else 5),
        rounds=options["rounds"] or (3 if quick else 5),
        workers=options["workers"] or usable_processors(),
        baseline=options["baseline"],
        max_slowdown=options["max_slowdown"] or MAX_SLOWDOWN,
        kernel=options["kernel"],
        forest=options["forest"],
        scenes=options["scene"],
    )
    _refuse_replacing(options["baseline"], options["out"])
    outcome = RunOutcome()
    files = fingerprints(specs) if specs else None
    import_all()
    unchanged = FileSnapshot(files) if files is not None else None

    title = f"measuring {', '.join(specs)} beside our own methods" if specs else "measuring our own methods"
    provenance = Provenance(files, unchanged.program if unchanged else None, in_effect(context))
    with (
        TemporaryDirectory(prefix="hypcheck-bench-") as folder,
        recording(options["out"], plan.options, title, provenance) as running,
    ):
        run_stages(run.stages(replace(plan, folder=Path(folder)), running.recorder, outcome))
        if unchanged is not None:
            outcome.because[Exit.WRONG].extend(unchanged.record_changes(running.recorder))
        running.exit_code = outcome.exit_code
    if outcome.exit_code == Exit.INCONCLUSIVE:
        click.echo(f"hypcheck: {_what_to_do(plan.processes)}", err=True)
    context.exit(outcome.exit_code)


def _refuse_replacing(baseline: Path | None, out: Path) -> None:
    """A run found slower would be the baseline of the next, which would find nothing."""
    from hypcheck.record.reader import file_of
    from hypcheck.tables.streams import same_file

    if baseline is not None and same_file(str(file_of(baseline)), str(file_of(out))):
        raise InputError(f"--baseline {baseline} is what --out {out} would replace; name another folder for --out")


def _what_to_do(processes: int) -> str:
    return (
        "the machine was too noisy to tell: end what else runs on it, switch frequency scaling off, or take more "
        f"samples with --processes {2 * processes}"
    )
