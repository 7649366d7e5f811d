"""`hypcheck verify`: with SPEC a conformance run of implementations, without it a self-check of hypcheck.

A run of `hypcheck verify SPEC`: implementations are gated against the frozen vectors and exact decisions.

A run of `hypcheck verify` without SPEC: hypcheck itself is derived, proved, cross-checked, judged and timed.

`hypcheck verify`: which of its two runs is meant, and the options that this run has: its parameters.
"""

from __future__ import annotations

import os
from collections.abc import Collection
from dataclasses import asdict, dataclass, fields
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from hypcheck.cli.options import (
    LARGEST_SEED,
    MOST_PROCESSES,
    IntegerOption,
    NumberOption,
    OutputPath,
    limits_of,
    names_in,
    with_limits,
)
from hypcheck.cli.progress import watched
from hypcheck.cli.recording import folder_of, label, recording, resumed, run_stages
from hypcheck.cli.settings import FILE, ProjectSettings, in_effect
from hypcheck.errors import Exit, InputError, RunOutcome
from hypcheck.messages import escaped, printable

if TYPE_CHECKING:
    from hypcheck.record.lines import SettingsPart
    from hypcheck.runs.plan import ConformancePlan


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

    def plan(self) -> ConformancePlan:
        """The plan of the run. Raises InputError where an option is wrong."""
        from hypcheck.implementations.description import parse_domain
        from hypcheck.runs.plan import ConformancePlan

        to_make = self.update and self.known_failures is not None and not self.known_failures.exists()
        plan = ConformancePlan(
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


def conformance(options: ConformanceOptions, title: str, settings: SettingsPart | None) -> int:
    """Run it, begun anew or gone on with, write the reports, and give the exit code.

    Raises InputError where an option is wrong.
    """
    from hypcheck.record.writer import Provenance
    from hypcheck.report.write import import_all
    from hypcheck.runs import conformance as run
    from hypcheck.runs.fingerprint import FileSnapshot, fingerprints
    from hypcheck.runs.known_failures import update
    from hypcheck.runs.plan import planned_size
    from hypcheck.runs.resume import ResumedRun

    plan, out = options.plan(), options.out
    shown = {**asdict(plan), "tolerance": options.tolerance, "known_failures": str(plan.known_failures or "")}
    cases, files = planned_size(plan), fingerprints(plan.specs, plan.known_failures)
    import_all()
    unchanged = FileSnapshot(files)
    begun = ResumedRun() if options.resume is None else resumed(options.resume, out, plan, shown, files, cases)
    if isinstance(begun, int):
        return begun
    outcome, provenance = RunOutcome(), Provenance(files, unchanged.program, settings)
    with recording(out, shown, title, provenance, begun.carried) as running:
        with watched(cases * len(plan.specs), label("gate"), "cases", begun.done(cases)) as pace:
            run.run_conformance(plan, running.recorder, outcome, pace.advance, begun.state)
        changed = unchanged.record_changes(running.recorder)
        running.exit_code = Exit.WRONG if changed and not outcome.exit_code else outcome.exit_code
    if options.update and options.known_failures is not None and running.record is not None and not changed:
        click.echo(printable(update(options.known_failures, running.record)))
    return running.exit_code


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


def self_check(options: SelfCheckOptions, title: str, settings: SettingsPart | None) -> Exit:
    """Run it and write the reports. Raises InputError where an option is wrong."""
    from hypcheck.processes import usable_processors
    from hypcheck.record.writer import Provenance
    from hypcheck.runs import self_check as run
    from hypcheck.runs.findings import SelfCheckPlan

    plan = SelfCheckPlan(
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
    with recording(options.out, run.options(plan), title, Provenance(settings=settings)) as running:
        run_stages(run.stages(plan, running.recorder, outcome))
        running.exit_code = outcome.exit_code
    return outcome.exit_code


def _oracles(text: str) -> tuple[str, ...]:
    from hypcheck.runs.oracles import ORACLES

    names = names_in(text)
    unknown = [name for name in names if name not in ORACLES]
    if unknown or not names:
        raise InputError(f"--oracles: {unknown[0] if unknown else text!r} is no oracle; there are {', '.join(ORACLES)}")
    return names


_COUNT = IntegerOption(1)


@click.command(short_help="Derive, prove, cross-check, judge and time; or gate the implementations that SPEC names.")
@click.argument("specs", nargs=-1, metavar="[SPEC]...")
@click.option("--out", type=OutputPath(), default=Path("reports/latest"), show_default=True, help="For the reports.")
@click.option(
    "--families", help="Names and globs, separated by commas; '*' is all.  [default: all but the extreme ones]"
)
@click.option("--count", type=IntegerOption(0), default=400, show_default=True, help="Generated rows of each family.")
@click.option(
    "--seed", type=IntegerOption(0, LARGEST_SEED), default=1, show_default=True, help="Of the generated rows."
)
@click.option(
    "--tolerance", type=NumberOption(0), default=8.0, show_default=True, help="Backward error that passes, in u."
)
@click.option("--oracles", default="exact,nearest,roots,mesh", show_default=True, help="Which oracles to ask.")
@click.option("--judged", type=_COUNT, default=400, show_default=True, help="Rows of a family asked of our methods.")
@click.option("--roots", type=_COUNT, default=1500, show_default=True, help="Rows in all for the roots oracle.")
@click.option("--meshes", type=_COUNT, default=2000, show_default=True, help="Rows in all for the mesh oracle.")
@click.option(
    "--workers",
    type=IntegerOption(1, MOST_PROCESSES),
    help="Processes.  [default: one a processor; with SPEC, of large runs]",
)
@click.option("--precision", help="With SPEC: stands for the precision it declares.")
@click.option("--question", help="With SPEC: stands for the question it declares.")
@click.option("--domain", help="With SPEC: stands for the domain it declares, in JSON.")
@click.option("--max-abstained", type=IntegerOption(0), default=0, show_default=True, help="Cases it may not answer.")
@click.option(
    "--fail-on",
    type=click.Choice(["wrong", "false-clear"]),
    default="wrong",
    show_default=True,
    help="Any wrong answer beyond --tolerance, or only those that say clear in contact.",
)
@click.option("--deterministic", is_flag=True, help="Fail too when an answer changes within the tolerance.")
@click.option("--known-failures", type=click.Path(path_type=Path), help="A TOML file of failures that are known.")
@click.option("--update", is_flag=True, help="Rewrite --known-failures from this run.")
@click.option("--self", "of_ourselves", is_flag=True, help="Verify hypcheck itself, whatever hypcheck.toml names.")
@with_limits
@click.option("--resume", type=click.Path(path_type=Path), help="The record of an interrupted run, to go on with it.")
@click.option("--cluster", metavar="ADDRESS", help="With SPEC: a dask.distributed scheduler; local:N starts one here.")
@click.pass_context
def verify(context: click.Context, /, specs: tuple[str, ...], **options: Any) -> None:  # noqa: ANN401  click's options
    """Verify hypcheck itself, or gate the implementations that SPEC names.

    Without SPEC: derive the coefficients, prove the formulas, cross-check four oracles, judge every method, time the
    fast path. Ends with 0 when the oracles agree and the fast path is exact, 6 when oracles disagree, 1 when an exact
    method erred or the mathematical findings are not the known ones. Where the environment variable CI is set, --self
    must be given for that: a step that was to gate an implementation, and finds none, ends with 2.

    With SPEC (builtin:NAME, python:package.module:function, python:file.py:function, library:path.so, command:…):
    ask it the frozen vectors and generated rows, judge every answer, ask some again. Ends with 0 when no answer is
    wrong by more than --tolerance units, 1 when one is or a case ended without an answer, 5 when it cannot be started.

    A run with SPEC that was interrupted or killed goes on with --resume RECORD (or the folder of its run, which --out
    then is unless it is given) and the same options. A run without SPEC keeps what it finished, and begins anew.

    Reports are written to --out: record.jsonl, report.html, report.md, summary.json, junit.xml, measurements.csv and
    pictures. Options that are not given are those of hypcheck.toml in the working directory, if it is there, and so are
    the SPECs. Each option that weakens the gate is told at the start and in every report.
    """
    chosen = _chosen(context, specs, of_ourselves=options.pop("of_ourselves"))
    unused = options.keys() - {each.name for each in fields(ConformanceOptions if chosen else SelfCheckOptions)}
    _refuse_others(context, unused, chosen=chosen, given=specs)
    if options["resume"] and context.get_parameter_source("out") is not ParameterSource.COMMANDLINE:
        options["out"] = folder_of(options["resume"])
    settings = in_effect(context, unused)
    used = {name: value for name, value in options.items() if name not in unused}
    if chosen:
        title = f"verifying {', '.join(chosen)}{'' if specs else f', named by {FILE}'}"
        context.exit(conformance(ConformanceOptions(specs=chosen, **used), title, settings))
    title = "verifying hypcheck itself, no implementation"
    context.exit(self_check(SelfCheckOptions(**used), title, settings))


def _chosen(context: click.Context, specs: tuple[str, ...], *, of_ourselves: bool) -> tuple[str, ...]:
    """The SPECs to gate; none where hypcheck itself is verified. Raises InputError where nobody chose that."""
    if of_ourselves:
        if specs:
            raise InputError(f"--self verifies hypcheck itself and takes no SPEC; {escaped(specs[0])} is one")
        return ()
    settings = context.find_object(ProjectSettings)
    chosen = specs or (settings.specs if settings is not None else ())
    if not chosen and os.environ.get("CI", "").lower() not in ("", "0", "false"):
        raise InputError(
            f"no implementation is named, as SPEC or by specs in {FILE} here, so this step of CI would gate nothing; "
            "name one, or verify hypcheck itself with: hypcheck verify --self"
        )
    return chosen


def _refuse_others(
    context: click.Context, unused: Collection[str], *, chosen: tuple[str, ...], given: tuple[str, ...]
) -> None:
    """Raise InputError where an option was typed that the run does not have."""
    for option in context.command.params:
        if option.name in unused and context.get_parameter_source(option.name) is ParameterSource.COMMANDLINE:
            hint = f"; {FILE} names one, and --self leaves it aside" if chosen != given else ""
            raise InputError(f"{option.opts[0]} is for a run {'without' if chosen else 'with'} SPEC{hint}")
