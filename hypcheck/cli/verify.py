"""`hypcheck verify`: with SPEC a conformance run of implementations, without it a self-check of hypcheck."""

from __future__ import annotations

import os
import secrets
from collections.abc import Collection, Mapping
from dataclasses import asdict
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from hypcheck.cli import options
from hypcheck.cli.running import label, recording, resumed, run_stages, watched
from hypcheck.cli.settings import FILE, ProjectSettings, in_effect
from hypcheck.errors import Exit, InputError, RunOutcome
from hypcheck.messages import counted, escaped, printable

if TYPE_CHECKING:
    from hypcheck.record.lines import SettingsPart
    from hypcheck.runs.plan import ConformancePlan


_WITH_SPEC = frozenset(
    {
        *("max_abstained", "fail_on", "deterministic", "known_failures", "update", "precision", "question", "domain"),
        *(*options.LIMITS, "fresh", "cluster", "resume"),
    }
)
_WITHOUT_SPEC = frozenset({"oracles", "judged", "roots", "meshes"})
"""Options that only one of the two runs has, by the names of their parameters."""


def _plan_of(specs: tuple[str, ...], values: Mapping[str, Any]) -> ConformancePlan:
    """Return the plan of a conformance run. Raises InputError about a wrong option."""
    from hypcheck.implementations.description import parse_domain
    from hypcheck.runs.plan import ConformancePlan

    update, known_failures = values["update"], values["known_failures"]
    same = ("count", "seed", "max_abstained", "fail_on", "deterministic", "precision", "question", "workers", "cluster")
    to_be_made = update and known_failures is not None and not known_failures.exists()
    plan = ConformancePlan(
        specs=specs,
        families=options.names_in(values["families"]),
        fresh=_fresh_seed(values["fresh"], values["resume"]),
        tolerance=Fraction(values["tolerance"]),
        known_failures=None if to_be_made else known_failures,
        domain=None if values["domain"] is None else parse_domain(values["domain"]),
        limits=options.limits_of(**{name: values[name] for name in options.LIMITS}, out=values["out"]),
        **{name: values[name] for name in same},
    )
    if update and (known_failures is None or plan.filtered):
        raise InputError(
            "--update needs --known-failures and a run of all families, or it would forget failures of the others"
        )
    return plan


def _conformance(specs: tuple[str, ...], values: Mapping[str, Any], title: str, settings: SettingsPart | None) -> int:
    """Run or resume a conformance run, write its reports, and return the exit code. Raises InputError."""
    from hypcheck.implementations.implementation import require_named
    from hypcheck.record.writer import Provenance
    from hypcheck.report.write import import_all
    from hypcheck.runs import conformance as run
    from hypcheck.runs.fingerprint import FileSnapshot, fingerprints, not_hashed
    from hypcheck.runs.known_failures import update
    from hypcheck.runs.plan import planned_size
    from hypcheck.runs.resume import ResumedRun

    require_named(specs)  # before the first of them is asked
    plan, out, resume = _plan_of(specs, values), values["out"], values["resume"]
    recorded = _recorded(plan, values)
    isolation = options.isolation_of(specs, plan.limits)
    title += "" if plan.fresh is None else f"; {counted(plan.count, 'fresh row')} of each family, of seed {plan.fresh}"
    title += options.seen_text(plan.limits)
    unknown = not_hashed(plan.specs)
    title += f"; not hashed: {', '.join(unknown)}" if unknown else ""
    cases, files = planned_size(plan), fingerprints(plan.specs, plan.known_failures)
    import_all()
    unchanged = FileSnapshot(files)
    begun = ResumedRun() if resume is None else resumed(resume, out, plan, recorded, files, cases)
    if isinstance(begun, int):
        return begun
    outcome, provenance = RunOutcome(), Provenance(files, unchanged.program, settings, isolation, unknown or None)
    with recording(out, recorded, title, provenance, begun.carried) as running:
        with watched(cases * len(plan.specs), label("gate"), "cases", begun.done(cases)) as pace:
            run.run_conformance(plan, running.recorder, outcome, pace.advance, begun.state, pace.expect)
        changed = unchanged.record_changes(running.recorder)
        running.exit_code = Exit.WRONG if changed and not outcome.exit_code else outcome.exit_code
    if values["update"] and running.record is not None and not changed:
        click.echo(printable(update(values["known_failures"], running.record)))
    return running.exit_code


def _fresh_seed(text: str | None, resume: Path | None) -> int | None:
    """Return the seed of the fresh rows, or None for no fresh rows.

    It is the seed of the option, that of the resumed run, or a random one in CI.
    """
    from hypcheck.record.reader import interrupted_in, read
    from hypcheck.runs.cases import FRESH_SEEDS

    if text == "off":
        return None
    if text is not None and text != "auto":
        return int(text)
    if resume is not None:
        before = read(interrupted_in(resume)).header.options.get("fresh")
        return before if isinstance(before, int) else None
    return FRESH_SEEDS + secrets.randbelow(FRESH_SEEDS) if in_ci() or text else None


def _recorded(plan: ConformancePlan, values: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options of the plan as the record's header has them."""
    every = asdict(plan)
    del every["pace"]
    isolation = every["limits"].pop("isolation")
    every["limits"] |= {"isolate": isolation["mode"], "pass_env": isolation["variables"], "see": isolation["seen"]}
    return {**every, "tolerance": values["tolerance"], "known_failures": str(plan.known_failures or "")}


def _self_check(values: Mapping[str, Any], title: str, settings: SettingsPart | None) -> Exit:
    """Run the self-check, write its reports, and return the exit code. Raises InputError."""
    from hypcheck.processes import usable_processors
    from hypcheck.record.writer import Provenance
    from hypcheck.runs import self_check as run
    from hypcheck.runs.findings import SelfCheckPlan

    plan = SelfCheckPlan(
        families=options.names_in(values["families"]),
        oracles=_oracles(values["oracles"]),
        count=max(1, values["count"]),
        judged=values["judged"],
        roots=values["roots"],
        meshes=values["meshes"],
        seed=values["seed"],
        workers=values["workers"] or usable_processors(),
        tolerance=Fraction(values["tolerance"]),
    )
    outcome = RunOutcome()
    with recording(values["out"], run.options(plan), title, Provenance(settings=settings)) as running:
        run_stages(run.SelfCheck(plan, running.recorder, outcome).stages())
        running.exit_code = outcome.exit_code
    return outcome.exit_code


def _oracles(text: str) -> tuple[str, ...]:
    """Return the names of oracles in a text. Raises InputError if one is not known, or there is none."""
    from hypcheck.runs.oracles import ORACLES

    names = options.names_in(text)
    unknown = [name for name in names if name not in ORACLES]
    if unknown or not names:
        raise InputError(
            f"--oracles: {unknown[0] if unknown else text!r} is not an oracle; there are {', '.join(ORACLES)}"
        )
    return names


_COUNT = options.IntegerOption(1)

_THOROUGH = 10
"""The factor by which --thorough multiplies the number of generated rows."""


@click.command(short_help="Test the implementations that SPEC names; without SPEC, hypcheck itself.")
@click.argument("specs", nargs=-1, metavar="[SPEC]...", type=options.SPEC)
@click.option(
    "--out",
    type=options.OutputPath(),
    default=Path("reports/latest"),
    show_default=True,
    help="The folder of the reports.",
)
@click.option(
    "--families",
    type=options.FAMILIES,
    help="Names and globs, separated by commas; '*' is all.  [default: all but the extreme ones]",
)
@click.option(
    "--count",
    type=options.IntegerOption(0),
    default=400,
    show_default=True,
    help="Number of generated rows of each family.",
)
@click.option("--thorough", is_flag=True, help="Ten times as many generated rows, for narrower faults.")
@options.SEED
@options.TOLERANCE
@click.option("--oracles", default="exact,nearest,roots,heights,mesh", show_default=True, help="The oracles to ask.")
@click.option(
    "--judged",
    type=_COUNT,
    default=400,
    show_default=True,
    help="Number of rows of each family for the built-in methods.",
)
@click.option(
    "--roots",
    type=_COUNT,
    default=22_000,
    show_default=True,
    help="Total number of rows for the roots oracle; a tilted one counts for ten.",
)
@click.option(
    "--meshes", type=_COUNT, default=2000, show_default=True, help="Total number of rows for the mesh oracle."
)
@options.workers("Number of processes.  [default: one a processor; with SPEC, of large runs]")
@options.PRECISION
@options.QUESTION
@options.DOMAIN
@click.option(
    "--max-abstained",
    type=options.IntegerOption(0),
    default=0,
    show_default=True,
    help="Number of cases that it may answer with cannot say.",
)
@click.option(
    "--fail-on",
    type=click.Choice(["wrong", "false-clear"]),
    default="wrong",
    show_default=True,
    help="Any wrong answer beyond --tolerance, or only one that says clear at a contact.",
)
@click.option("--deterministic", is_flag=True, help="Also fail if an answer changes within the tolerance.")
@click.option("--known-failures", type=click.Path(path_type=Path), help="A TOML file of failures that are known.")
@click.option("--update", is_flag=True, help="Rewrite --known-failures from this run.")
@click.option("--self", "self_check", is_flag=True, help="Verify hypcheck itself, even if hypcheck.toml names SPECs.")
@click.option(
    "--fresh",
    type=options.FreshOption(),
    metavar="SEED",
    help="With SPEC: as many further rows, of this seed; auto draws one, off asks none.  [default: auto if CI is set]",
)
@options.with_limits
@click.option("--resume", type=click.Path(path_type=Path), help="The record of an interrupted run, to continue it.")
@click.option("--cluster", metavar="ADDRESS", help="With SPEC: a dask.distributed scheduler; local:N starts one here.")
@click.pass_context
def verify(context: click.Context, /, specs: tuple[str, ...], **values: Any) -> None:  # noqa: ANN401  click's options
    """Verify hypcheck itself, or gate the implementations that SPEC names.

    Without SPEC: derive the coefficients, prove the formulas, cross-check five oracles, judge every method, time the
    fast path. Ends with 0 if the oracles agree and the fast path is exact, 6 if oracles disagree, 1 if an exact method
    erred or the mathematical findings are not the known ones. If the environment variable CI is set, this needs --self:
    a CI step that should gate an implementation, and names none, ends with 2.

    With SPEC (builtin:NAME, python:package.module:function, python:file.py:function, library:path.so, command:…):
    ask it the frozen vectors and generated rows, judge every answer, ask some again. Ends with 0 if no answer is wrong
    by more than --tolerance units, 1 if one is or a case ended without an answer, 5 if it cannot be started.

    A run with SPEC that was interrupted or killed continues with --resume RECORD (or the folder of its run, which is
    then the default of --out) and the same options. A run without SPEC keeps what it finished, and starts again.

    Reports are written to --out: record.jsonl, report.html, report.md, summary.json, junit.xml, results.sarif,
    gl-code-quality-report.json, badge.json, measurements.csv and pictures. Options and SPECs that are not given are
    read from hypcheck.toml in the working directory, if it exists. Each option that weakens the gate is shown in the
    summary and in every report.
    """
    chosen = _chosen_specs(context, specs, self_check=values.pop("self_check"))
    unused = _WITHOUT_SPEC if chosen else _WITH_SPEC
    _refuse_unused(context, unused, chosen=chosen, named_in_file=specs)
    resume = values["resume"]
    if resume and context.get_parameter_source("out") is not ParameterSource.COMMANDLINE:
        values["out"] = resume if resume.is_dir() else resume.parent
    settings = in_effect(context, unused)
    if values.pop("thorough"):
        values["count"] = min(_THOROUGH * values["count"], options.LARGEST_COUNT)
    if chosen:
        title = f"verifying {', '.join(chosen)}{'' if specs else f', named by {FILE}'}"
        context.exit(_conformance(chosen, values, title, settings))
    context.exit(_self_check(values, "verifying hypcheck itself, no implementation", settings))


def in_ci() -> bool:
    """Return whether this process runs in continuous integration, by the environment variable CI."""
    return os.environ.get("CI", "").lower() not in ("", "0", "false")


def _chosen_specs(context: click.Context, specs: tuple[str, ...], *, self_check: bool) -> tuple[str, ...]:
    """Return the SPECs to gate; none if hypcheck itself is verified. Raises InputError in CI if nothing is named."""
    if self_check:
        if specs:
            raise InputError(f"--self verifies hypcheck itself and takes no SPEC; {escaped(specs[0])} is one")
        return ()
    settings = context.find_object(ProjectSettings)
    chosen = specs or (settings.specs if settings is not None else ())
    if not chosen and in_ci():
        raise InputError(
            f"no implementation is named, as SPEC or by specs in {FILE} here, so this step of CI would gate nothing; "
            "name one, or verify hypcheck itself with: hypcheck verify --self"
        )
    return chosen


def _refuse_unused(
    context: click.Context, unused: Collection[str], *, chosen: tuple[str, ...], named_in_file: tuple[str, ...]
) -> None:
    """Raise InputError about an option on the command line that the run does not have."""
    for option in context.command.params:
        if option.name in unused and context.get_parameter_source(option.name) is ParameterSource.COMMANDLINE:
            hint = f"; {FILE} names one; --self ignores it" if chosen != named_in_file else ""
            raise InputError(f"{option.opts[0]} is for a run {'without' if chosen else 'with'} SPEC{hint}")
