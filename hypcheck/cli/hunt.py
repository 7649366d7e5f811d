"""`hypcheck hunt`: options into a plan, the hunt under a progress bar, what it found, the exit code."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hypcheck.cli.options import Command, Number, Place, limits_of, with_limits
from hypcheck.cli.progress import is_terminal
from hypcheck.cli.settings import announce_file
from hypcheck.cli.whole import LARGEST_SEED, Whole
from hypcheck.errors import Exit, NothingJudgedError, first_that_applies
from hypcheck.visible import counted, printable

if TYPE_CHECKING:
    from hypcheck.hunt.hunting import Hunt, Target
    from hypcheck.hunt.search import Progress

SUBJECT = (
    click.option("--question", metavar="WHAT", help="position, exterior, interior or contact.  [default: as declared]"),
    click.option("--precision", metavar="FORMAT", help="The precision u is taken from.  [default: as declared]"),
    click.option("--domain", metavar="JSON", help="Where it is asked, in place of what it declares."),
    click.option("--regimes", metavar="NAMES", help="any, or a>=1 or c2>=a or both.  [default: as declared]"),
    click.option("--tolerance", type=Number(0), default=8.0, show_default=True, help="In units u."),
    with_limits,
)
"""How an implementation is opened and judged: options that every command that asks one alone has."""


def about_one_implementation(command: Command) -> Command:
    """The command with the options of SUBJECT, for `opened`."""
    for option in reversed(SUBJECT):
        command = option(command)
    return command


@contextmanager
def opened(
    spec: str,
    *,
    question: str | None,
    precision: str | None,
    domain: str | None,
    regimes: str | None,
    tolerance: float,
    **limits: Any,  # noqa: ANN401 - of with_limits
) -> Iterator[Target]:
    """The implementation that SPEC names, running, and what the options say of it. Raises InputError, StartError."""
    from hypcheck.hunt.hunting import target_of
    from hypcheck.judge import DEFAULT_TOLERANCE
    from hypcheck.methods.description import parse_domain
    from hypcheck.methods.opening import open_implementation

    said = {"question": question, "precision": precision, "domain": domain, "regimes": regimes}
    options = [(f"--{name}", value) for name, value in said.items() if value is not None]
    if tolerance != DEFAULT_TOLERANCE:
        options.append(("--tolerance", repr(tolerance)))
    claimed = None if domain is None else parse_domain(domain)
    announce_file()
    with open_implementation(
        spec, limits_of(**limits), precision=precision, question=question, domain=claimed
    ) as implementation:
        yield target_of(
            spec,
            implementation,
            regimes=_regimes(regimes),
            tolerance=Fraction(tolerance),
            options=tuple(options),
        )


_HELP = """\
Look for answers of SPEC that are wrong by much: thin sets of rows first, then ever worse ones next to these.

\b
hypcheck hunt library:./libcollide.so --budget 300 --out our-cases.json
hypcheck hunt builtin:table-2-float64 --queries 200000

Ends with 0 when nothing wrong beyond tolerance was found (which proves nothing), 1 when something was.
"""


@click.command(help=_HELP, short_help="Look for wrong answers of an implementation, the worst first.")
@click.argument("spec")
@click.option("--budget", type=Number(0, excluded=True), help="Seconds.  [default: 60, or none with --queries]")
@click.option("--queries", type=Whole(1), help="Rows asked at most; with no --budget the same is found again.")
@click.option("--seed", type=Whole(0, LARGEST_SEED), default=1, show_default=True)
@click.option("--show", type=Whole(0), default=10, show_default=True, help="Kinds of wrong answers in full.")
@click.option("--out", type=Place(), metavar="FILE", help="A vector file to which the worst row of each kind is added.")
@about_one_implementation
@click.pass_context
def hunt(
    context: click.Context,
    /,
    spec: str,
    budget: float | None,
    queries: int | None,
    seed: int,
    show: int,
    out: Path | None,
    **subject: Any,  # noqa: ANN401 - the options of SUBJECT
) -> None:
    """Hunt for the budget, and tell what was found; interrupted, what was found until then."""
    from hypcheck.hunt.hunting import Hunt, Plan

    if out is not None:
        from hypcheck.hunt.keep import require_keepable

        require_keepable(str(out))
    plan = Plan(60.0 if budget is None and queries is None else budget, queries, seed)
    with opened(spec, **subject) as target:
        run = Hunt(target, plan)
        try:
            _pursue(run)
        finally:
            _tell(run, show, out)
    context.exit(_exit_code(run))


def _pursue(run: Hunt) -> None:
    """Hunt, under a progress bar where a person is watching."""
    from hypcheck.hunt.search import hunt as pursue

    if not is_terminal(sys.stderr):
        pursue(run)
        return
    with click.progressbar(length=1000, label="hunt", file=sys.stderr, show_pos=False, show_eta=False) as bar:
        pursue(run, _shown(bar))


def _shown(bar: Any) -> Progress:  # noqa: ANN401 - click has no public name for its bars
    def show(run: Hunt) -> None:
        kinds = len(run.findings.worst_first())
        bar.label = f"{run.asked:>11,} rows, {kinds:>3} kinds of wrong answers"
        bar.update(int(1000 * run.spent) - bar.pos)

    return show


def _tell(run: Hunt, show: int, out: Path | None) -> None:
    from hypcheck.hunt.text import hunt_lines

    for line in hunt_lines(run, show):
        click.echo(printable(line))
    found = run.findings.worst_first()
    if out is not None and found:
        from hypcheck.hunt.keep import keep

        made_by = f"hypcheck hunt {shlex.quote(run.target.spec)} --seed {run.plan.seed}"
        added = keep(str(out), [cluster.worst.case.row for cluster in found], made_by)
        click.echo(
            f"\n{printable(out)}: {counted(added, 'row')} added"
            f"{'' if added == len(found) else ', the others were there'}"
        )


def _exit_code(run: Hunt) -> Exit:
    """Raises NothingJudgedError where no row was answered, for a reason that is no fault of the implementation."""
    from hypcheck.judge import Status

    broken = not run.answered and set(run.faults) - {Status.NOT_RUN} == {Status.PROTOCOL}
    if run.answered == run.counts[Status.ABSTAINED.value] and not run.faults:
        raise NothingJudgedError("no row was answered: the domain leaves nothing to ask, or every answer was abstained")
    wrong = bool(run.findings.worst_first() or run.faults)
    return first_that_applies([Exit.NOT_STARTED] * broken + [Exit.WRONG] * wrong)


def _regimes(text: str | None) -> tuple[str, ...] | None:
    if text is None:
        return None
    return () if text == "any" else tuple(name.strip() for name in text.split(","))
