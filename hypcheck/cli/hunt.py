"""`hypcheck hunt`, `minimise`, `replay` and `explain`: find wrong answers, simplify them, show and explain them.

Hunt and minimise open an implementation with the same options; replay shows one case with the proof of the right answer
and the intermediate values of a formula. Explain describes a cause by the id that records and reports have.
"""

from __future__ import annotations

import shlex
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hypcheck.cli import options
from hypcheck.cli.running import is_terminal, watched
from hypcheck.cli.settings import print_file_settings
from hypcheck.errors import Exit, NothingJudgedError, first_that_applies
from hypcheck.geometry.pair import Pair
from hypcheck.messages import counted, printable

if TYPE_CHECKING:
    from hypcheck.implementations.implementation import Implementation
    from hypcheck.runs.hunt import Hunt, HuntTarget


about_one_implementation = options.with_options(
    options.QUESTION,
    options.PRECISION,
    options.DOMAIN,
    click.option("--regimes", metavar="NAMES", help="any, or a>=1 or c2>=a or both.  [default: as declared]"),
    options.TOLERANCE,
    options.with_limits,
)
"""A decorator that gives a command the options about how one implementation is opened and judged, for `_target`."""


@contextmanager
def _opened(
    spec: str, question: str | None, precision: str | None, domain: str | None, limits: dict[str, Any]
) -> Iterator[Implementation]:
    """Enter a block with the running implementation of `spec`, described as the options say.

    Raises InputError, StartError.
    """
    from hypcheck.implementations.description import parse_domain
    from hypcheck.implementations.implementation import open_implementation

    claimed = None if domain is None else parse_domain(domain)
    print_file_settings()
    bounds = options.limits_of(**limits)
    with open_implementation(spec, bounds, precision=precision, question=question, domain=claimed) as implementation:
        options.print_isolation(spec, bounds)
        yield implementation


@contextmanager
def _target(
    spec: str,
    *,
    question: str | None,
    precision: str | None,
    domain: str | None,
    regimes: str | None,
    tolerance: float,
    **limits: Any,  # noqa: ANN401 - those of with_limits
) -> Iterator[HuntTarget]:
    """Enter a block with the running implementation of `spec`, and how the options say that it is judged.

    Raises InputError, StartError.
    """
    from hypcheck.runs.hunt import target_of
    from hypcheck.runs.judge import DEFAULT_TOLERANCE

    claims = {"question": question, "precision": precision, "domain": domain, "regimes": regimes}
    chosen = [(f"--{name}", value) for name, value in claims.items() if value is not None]
    if tolerance != DEFAULT_TOLERANCE:
        chosen.append(("--tolerance", repr(tolerance)))
    with _opened(spec, question, precision, domain, limits) as implementation:
        yield target_of(
            spec,
            implementation,
            regimes=_regimes(regimes),
            tolerance=Fraction(tolerance),
            options=tuple(chosen),
        )


_HUNT_HELP = """\
Look for badly wrong answers of SPEC: in thin sets of rows first, then next to the worst rows found.

\b
hypcheck hunt library:./libcollide.so --budget 300 --out our-cases.json
hypcheck hunt builtin:table-2-float64 --queries 200000

Ends with 0 if no answer was wrong beyond the tolerance (which proves nothing), 1 if one was.
"""


@click.command(help=_HUNT_HELP, short_help="Look for wrong answers of an implementation, the worst first.")
@click.argument("spec", type=options.SPEC)
@click.option(
    "--budget",
    type=options.NumberOption(0, excluded=True),
    help="Time limit in seconds.  [default: 60, or none with --queries]",
)
@click.option(
    "--queries",
    type=options.IntegerOption(1),
    help="Largest number of rows to ask; without --budget, a run is reproducible.",
)
@options.SEED
@click.option(
    "--show",
    type=options.IntegerOption(0),
    default=10,
    show_default=True,
    help="Number of kinds of wrong answers to show in full.",
)
@click.option(
    "--out",
    type=options.OutputPath(),
    metavar="FILE",
    help="A vector file to which the worst row of each kind is added.",
)
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
    **subject: Any,  # noqa: ANN401 - about_one_implementation
) -> None:
    """Hunt until the budget is spent, and print the findings; after an interrupt, those until then."""
    from hypcheck.runs.hunt import Hunt, HuntPlan

    plan = HuntPlan(60.0 if budget is None and queries is None else budget, queries, seed)
    with _target(spec, **subject) as target:
        if out is not None:
            from hypcheck.vectors.freezing import require_keepable

            require_keepable(str(out), target.implementation.description.groups)
        run = Hunt(target, plan)
        try:
            _hunt_with_bar(run)
        finally:
            _print_findings(run, show, out)
    context.exit(_exit_code(run))


_STEPS = 1000
"""The number of steps of the progress bar of a hunt."""


def _hunt_with_bar(run: Hunt) -> None:
    """Hunt; on a terminal show a progress bar."""
    from hypcheck.runs.hunt_search import run_hunt

    if not is_terminal(sys.stderr):
        run_hunt(run)
        return
    with watched(_STEPS, "hunt") as pace:
        shown = 0

        def show(run: Hunt) -> None:
            nonlocal shown
            kinds = len(run.worst_first())
            pace.name(f"{run.asked:>11,} rows, {kinds:>3} kinds of wrong answers", "")
            now = int(_STEPS * run.spent)
            pace.advance(now - shown)
            shown = now

        run_hunt(run, show)


def _print_findings(run: Hunt, show: int, out: Path | None) -> None:
    """Print the findings of a hunt, and add the worst row of each kind to the vector file `out`."""
    from hypcheck.runs.hunt import hunt_lines

    for line in hunt_lines(run, show):
        click.echo(printable(line))
    clusters = run.worst_first()
    if out is not None and clusters:
        from hypcheck.geometry.pair import UPRIGHT, WITHOUT_ENDS
        from hypcheck.vectors.freezing import keep_rows

        made_by = f"hypcheck hunt {shlex.quote(run.target.spec)} --seed {run.plan.seed}"
        rows = [cluster.worst.case.row for cluster in clusters]
        used, layout = run.target.implementation.description, run.target.layout
        if used.tilt or used.heights:
            rows = [row if layout.has_axis(row) else (*row, *UPRIGHT) for row in rows]
        if used.heights:
            rows = [row if layout.has_heights(row) else (*row, *WITHOUT_ENDS) for row in rows]
        added = keep_rows(str(out), rows, made_by, used.groups)
        there = "" if added == len(rows) else ", the others were there already"
        click.echo(f"\n{printable(out)}: {counted(added, 'row')} added{there}")


def _exit_code(run: Hunt) -> Exit:
    """Return the exit code of a hunt.

    It is NOT_STARTED if no reply followed the protocol, WRONG if an answer is wrong beyond the tolerance or a row ended
    without a valid answer, else HELD. Raises NothingJudgedError if no answer was judged, though no row failed: the
    domain has no row to test, or every answer was an abstention ("cannot say").
    """
    from hypcheck.runs.judge import Status

    broken = not run.answered and set(run.unanswered) - {Status.NOT_RUN} == {Status.PROTOCOL}
    if run.answered == run.counts[Status.ABSTAINED.value] and not run.unanswered:
        raise NothingJudgedError("no row was answered: the domain leaves nothing to ask, or every answer was abstained")
    wrong = bool(run.worst_first() or run.unanswered)
    return first_that_applies([Exit.NOT_STARTED] * broken + [Exit.WRONG] * wrong)


def _regimes(text: str | None) -> tuple[str, ...] | None:
    """Return the regimes that --regimes names; none for "any"; None if the option is not given."""
    if text is None:
        return None
    return () if text == "any" else tuple(name.strip() for name in text.split(","))


_MINIMISE_HELP = """\
Show the simplest row next to CASE that SPEC answers wrongly in the same way, and prove the right answer.

CASE is a case's id (ring-0007, ring/1/42/7), a row alpha,gamma,b,d,x,y,z (of a sweep
alpha,gamma,b,d,x0,y0,z0,x1,y1,z1), or RECORD:N, as for `hypcheck replay`.

\b
hypcheck minimise builtin:table-2-float64 ring/1/0/3
hypcheck minimise library:./libcollide.so "2.1,17.8,0.25,0.15,1.31,-0.4,7"

Ends with 0 if the simplest row is shown, 2 if the answer to CASE is not wrong, 5 if SPEC cannot be started.
"""


@click.command(help=_MINIMISE_HELP, short_help="Simplify a row that an implementation answers wrongly.")
@click.argument("spec", type=options.SPEC)
@click.argument("case", type=options.CASE)
@about_one_implementation
def minimise(spec: str, case: str, **subject: Any) -> None:  # noqa: ANN401
    """Simplify, and print the result."""
    from hypcheck.answer import answer, answer_as_text, sweep_answer, sweep_as_text
    from hypcheck.runs.minimise import minimise as simplify
    from hypcheck.runs.minimise import minimised_lines
    from hypcheck.runs.replay import case_of
    from hypcheck.vectors.families import is_extreme

    start = case_of(case)
    with _target(spec, **subject) as target:
        run = simplify(replace(target, extreme=is_extreme(start.name)), start)
    for line in minimised_lines(run):
        click.echo(printable(line))
    row = run.last.case.row
    is_sweep = run.target.layout.has_end
    right = sweep_as_text(sweep_answer(row)) if is_sweep else answer_as_text(answer(Pair.from_row(row)))
    click.echo(f"\nthe right answer: {right}")


_REPLAY_HELP = """\
Show SPEC's answer to CASE, the right answer with its proof, and where the formula nearest to SPEC goes wrong.

CASE is a case's id (ring-0007, ring/1/42/7), a row alpha,gamma,b,d,x,y,z in decimals or hexadecimal floats (of a
tilted spheroid with axis_x,axis_y,axis_z behind; of a sweep alpha,gamma,b,d,x0,y0,z0,x1,y1,z1), or RECORD:N, the N-th
case that a record.jsonl (or the folder of its run) has kept, as reports number them.

\b
hypcheck replay ring-0007 builtin:table-2-float64
hypcheck replay 2,5,1,1,3,0,0 library:./libcollide.so
hypcheck replay reports/latest/record.jsonl:3 "command:./adapter --fast"

The values of a built-in formula are shown in its precision beside exact arithmetic; with --values, of another
implementation, those of the formula nearest to it. >> marks the first decision
that rounding changed, and > the number that it depends on.

Ends with 0 if the answer is right or tolerated, 1 if it is not, 5 if SPEC cannot be started.
"""


@click.command(help=_REPLAY_HELP, short_help="Show an implementation's answer to one case, and where it goes wrong.")
@click.argument("case", type=options.CASE)
@click.argument("spec", type=options.SPEC)
@click.option("--formula", metavar="NAME", help="The formula to show.  [default: its own, or one with the same answer]")
@click.option("--values", is_flag=True, help="The values of a formula that is not the implementation's own, too.")
@click.option("--json", "as_json", is_flag=True, help="One JSON object, its proof in exact numbers.")
@options.PRECISION
@options.QUESTION
@options.DOMAIN
@options.TOLERANCE
@options.with_limits
@click.pass_context
def replay(
    context: click.Context,
    /,
    case: str,
    spec: str,
    formula: str | None,
    values: bool,
    as_json: bool,
    precision: str | None,
    question: str | None,
    domain: str | None,
    tolerance: float,
    **limits: Any,  # noqa: ANN401 - those of with_limits
) -> None:
    """Replay, and print the result."""
    from hypcheck.runs.intermediates import require_formula
    from hypcheck.runs.judge import Criterion
    from hypcheck.runs.replay import case_of
    from hypcheck.runs.replay import replay as run
    from hypcheck.runs.replay_results import replay_as_json, replay_lines

    case_asked = case_of(case)
    require_formula(formula)
    with _opened(spec, question, precision, domain, limits) as implementation:
        used = implementation.description
        criterion = Criterion(used.question, used.precision, Fraction(tolerance))
        replayed = run(case_asked, implementation, criterion, formula)
    shown = values or formula is not None
    for line in [replay_as_json(replayed)] if as_json else replay_lines(replayed, _in_ledger, values=shown):
        click.echo(printable(line))
    context.exit(Exit.HELD if replayed.judgement.passes else Exit.WRONG)


def _in_ledger(number: str) -> tuple[str, str, str]:
    """Return the verdict on a claim of the paper, the claim in words, and its correction; loads sympy."""
    from hypcheck.paper.ledger.book import statement

    entry = statement(number)
    return entry.verdict, entry.statement, entry.correction


_HELP = """\
Explain a cause of wrong answers: what it is, why it is wrong, how it shows, what to do, and a row that shows it.

A run prints the ID beside the number of wrong answers, and its files have it: ring, throat, complex-pair-ignored.
Without ID, all causes are listed.

\b
hypcheck explain
hypcheck explain ring
hypcheck explain ring --format json
"""


@click.command(help=_HELP, short_help="Explain a cause of wrong answers by its id.")
@click.argument("name", metavar="[ID]", required=False, type=options.Names(options.causes))
@options.FORMAT
def explain(name: str | None, form: str) -> None:
    """Explain, and print the result."""
    from hypcheck.runs import explain as known

    if name is None:
        causes = [known.brief(cause) for cause in known.BY_ID.values()]
        lines = [known.as_json(causes)] if form == "json" else known.listed()
    else:
        cause = known.cause_with_id(name)
        lines = [known.as_json(known.explained(cause))] if form == "json" else known.explained_lines(cause)
    for line in lines:
        for part in line.split("\n"):
            click.echo(printable(part))
