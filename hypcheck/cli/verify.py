"""`hypcheck verify`: which of its two runs is meant, and the options that this run has: its parameters."""

from __future__ import annotations

import os
from collections.abc import Collection
from dataclasses import fields
from pathlib import Path
from typing import Any

import click
from click.core import ParameterSource

from hypcheck.cli.conformance import ConformanceOptions, conformance
from hypcheck.cli.options import Number, Place, with_limits
from hypcheck.cli.resuming import folder_of
from hypcheck.cli.self_check import SelfCheckOptions, self_check
from hypcheck.cli.settings import FILE, Settings, in_effect
from hypcheck.cli.whole import LARGEST_SEED, MOST_PROCESSES, Whole
from hypcheck.errors import InputError
from hypcheck.visible import visible

_COUNT = Whole(1)


@click.command(short_help="Derive, prove, cross-check, judge and time; or gate the implementations that SPEC names.")
@click.argument("specs", nargs=-1, metavar="[SPEC]...")
@click.option("--out", type=Place(), default=Path("reports/latest"), show_default=True, help="For the reports.")
@click.option(
    "--families", help="Names and globs, separated by commas; '*' is all.  [default: all but the extreme ones]"
)
@click.option("--count", type=Whole(0), default=400, show_default=True, help="Generated rows of each family.")
@click.option("--seed", type=Whole(0, LARGEST_SEED), default=1, show_default=True, help="Of the generated rows.")
@click.option("--tolerance", type=Number(0), default=8.0, show_default=True, help="Backward error that passes, in u.")
@click.option("--oracles", default="exact,nearest,roots,mesh", show_default=True, help="Which oracles to ask.")
@click.option("--judged", type=_COUNT, default=400, show_default=True, help="Rows of a family asked of our methods.")
@click.option("--roots", type=_COUNT, default=1500, show_default=True, help="Rows in all for the roots oracle.")
@click.option("--meshes", type=_COUNT, default=2000, show_default=True, help="Rows in all for the mesh oracle.")
@click.option(
    "--workers", type=Whole(1, MOST_PROCESSES), help="Processes.  [default: one a processor; with SPEC, of large runs]"
)
@click.option("--precision", help="With SPEC: stands for the precision it declares.")
@click.option("--question", help="With SPEC: stands for the question it declares.")
@click.option("--domain", help="With SPEC: stands for the domain it declares, in JSON.")
@click.option("--max-abstained", type=Whole(0), default=0, show_default=True, help="Cases it may not answer.")
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
            raise InputError(f"--self verifies hypcheck itself and takes no SPEC; {visible(specs[0])} is one")
        return ()
    settings = context.find_object(Settings)
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
