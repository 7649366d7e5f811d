"""`hypcheck bench`: methods compared by error and run time, and their speed compared with an earlier run."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hypcheck.cli import options
from hypcheck.cli.running import recording, run_stages
from hypcheck.cli.settings import in_effect
from hypcheck.errors import Exit, InputError, RunOutcome

if TYPE_CHECKING:
    from hypcheck.bench.plan import BenchPlan

METHODS = options.Names(options.bench_methods, many=True)
WORKLOADS = options.Names(options.workloads, many=True)


@click.command(short_help="Compare methods by error and run time, and their speed with an earlier run.")
@click.argument("specs", nargs=-1, metavar="[SPEC]...", type=options.SPEC)
@click.option("--out", type=options.OutputPath(), default=Path("reports/bench"), show_default=True)
@click.option(
    "--quick", is_flag=True, help="Half a minute instead of five: fewer rows, rounds and meshes; no scenes, no forest."
)
@click.option("--methods", type=METHODS, help="Names and globs, separated by commas.  [default: all]")
@click.option("--workloads", type=WORKLOADS, help="Names and globs, separated by commas.  [default: all]")
@options.SEED
@click.option(
    "--processes", type=options.IntegerOption(1), help="Number of fresh processes that measure.  [default: 5; quick: 3]"
)
@click.option(
    "--rounds", type=options.IntegerOption(1), help="Number of rounds in each process.  [default: 5; quick: 3]"
)
@options.workers("Number of processes that judge answers.  [default: one a processor]")
@click.option("--baseline", type=click.Path(path_type=Path), help="An earlier record, or its folder, to compare with.")
@click.option(
    "--max-slowdown", type=options.NumberOption(1), help="Largest time allowed relative to --baseline.  [default: 1.1]"
)
@click.option("--kernel", is_flag=True, help="Measure only the fast path, against its targets.")
@click.option("--forest", is_flag=True, help="Measure only a walker's step among 10 to 10^6 trees.")
@click.option("--tilted", is_flag=True, help="Compare methods for tilted spheroids.")
@click.option(
    "--question",
    type=click.Choice(["position", "passage"]),
    default="position",
    show_default=True,
    help="passage: compare methods for the sweep between two positions.",
)
@click.option(
    "--scene",
    multiple=True,
    type=options.SCENE,
    metavar="SCENE",
    help="Measure only what a kernel for this scene saves; may be repeated. If its mover is tilted: methods on its "
    "rows.",
)
@options.ISOLATE
@options.PASS_ENV
@options.SEE
@click.pass_context
def bench(context: click.Context, /, specs: tuple[str, ...], **values: Any) -> None:  # noqa: ANN401  click's options
    """Compare methods by error and by run time, on the same rows.

    Every method is judged by the distance of its wrong answers from a right answer, then timed in fresh processes, in
    rounds of all methods. A SPEC (builtin:NAME, python:…, library:path.so, command:…) is measured too.

    With --question passage each row is a sweep, and missed and false contacts are shown over the time of a sweep. With
    --tilted the spheroids are tilted, only methods for tilted spheroids take part, the workloads differ, and ratios of
    positions are to another reference. The same holds for a scene whose mover is tilted; the kernel that `hypcheck
    emit` writes for it can be a SPEC.

    With --baseline, times relative to the reference method are compared with those of an earlier record, of this
    machine or another; with --kernel, times of the fast path with its targets. Without them no time fails the run.

    Ends with 0 if nothing failed, 1 if a method that promises to be exact was wrong, or a method answered differently
    while it was timed, 3 if one is slower than allowed, 4 if the machine was too noisy to decide, 5 if a SPEC could not
    start.
    """
    from dataclasses import replace
    from tempfile import TemporaryDirectory

    from hypcheck.bench import run
    from hypcheck.record.writer import Provenance
    from hypcheck.report.write import import_all
    from hypcheck.runs.fingerprint import FileSnapshot, fingerprints

    plan = _plan_of(specs, values)
    bounds = options.isolated(plan.limits, values["isolate"], values["pass_env"], values["see"], values["out"])
    plan, isolation = replace(plan, limits=bounds), options.isolation_of(specs, bounds)
    _refuse_replacing(values["baseline"], values["out"])
    outcome = RunOutcome()
    files = fingerprints(specs) if specs else None
    import_all()
    unchanged = FileSnapshot(files) if files is not None else None

    title = f"measuring {', '.join(specs)} beside our own methods" if specs else "measuring our own methods"
    title += options.seen_text(bounds)
    settings = in_effect(context, unused=("question",))  # it chooses methods, and replaces no declaration
    provenance = Provenance(files, unchanged.program if unchanged else None, settings, isolation)
    with (
        TemporaryDirectory(prefix="hypcheck-bench-") as folder,
        recording(values["out"], plan.options, title, provenance) as running,
    ):
        run_stages(run.stages(replace(plan, folder=Path(folder)), running.recorder, outcome))
        if unchanged is not None and unchanged.record_changes(running.recorder):
            outcome.codes.add(Exit.WRONG)
        running.exit_code = outcome.exit_code
    if outcome.exit_code == Exit.INCONCLUSIVE:
        click.echo(
            "hypcheck: the machine was too noisy to tell: end other programs, switch frequency scaling off, or take "
            f"more samples with --processes {2 * plan.processes}",
            err=True,
        )
    context.exit(outcome.exit_code)


def _plan_of(specs: tuple[str, ...], values: Mapping[str, Any]) -> BenchPlan:
    """Return the plan of a benchmark. Raises InputError about a wrong option."""
    from hypcheck.bench.plan import FULL, MAX_SLOWDOWN, QUICK, BenchPlan
    from hypcheck.processes import usable_processors

    quick = values["quick"]
    if values["max_slowdown"] is not None and values["baseline"] is None:
        raise InputError("--max-slowdown compares a run with an earlier one; name the earlier one with --baseline")
    return BenchPlan(
        specs=specs,
        methods=options.names_in(values["methods"]),
        workloads=options.names_in(values["workloads"]),
        quick=quick,
        amounts=QUICK if quick else FULL,
        processes=values["processes"] or (3 if quick else 5),
        rounds=values["rounds"] or (3 if quick else 5),
        workers=values["workers"] or usable_processors(),
        max_slowdown=values["max_slowdown"] or MAX_SLOWDOWN,
        scenes=values["scene"],
        **{name: values[name] for name in ("seed", "baseline", "kernel", "forest", "tilted", "question")},
    )


def _refuse_replacing(baseline: Path | None, out: Path) -> None:
    """Raise InputError if the run would replace its own baseline, so that the next run would find nothing slower."""
    from hypcheck.record.reader import file_of
    from hypcheck.tables.streams import same_file

    if baseline is not None and same_file(str(file_of(baseline)), str(file_of(out))):
        raise InputError(f"--out {out} would replace --baseline {baseline}; name another folder for --out")
