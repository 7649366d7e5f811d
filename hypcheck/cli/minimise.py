"""`hypcheck minimise`: from a wrong answer to the simplest row that is answered wrongly in the same way."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import click

from hypcheck.cli.hunt import about_one_implementation, opened
from hypcheck.visible import printable

_HELP = """\
Show the simplest row next to CASE that SPEC answers wrongly in the same way, and prove the right answer.

CASE is a case's id (ring-0007, ring/1/42/7), a row alpha,gamma,b,d,x,y,z, or RECORD:N, as for `hypcheck replay`.

\b
hypcheck minimise builtin:table-2-float64 ring/1/0/3
hypcheck minimise library:./libcollide.so "2.1,17.8,0.25,0.15,1.31,-0.4,7"

Ends with 0 when the simplest row is shown, 2 where the answer to CASE is not wrong, 5 when SPEC cannot be started.
"""


@click.command(help=_HELP, short_help="Simplify a row that an implementation answers wrongly.")
@click.argument("spec")
@click.argument("case")
@about_one_implementation
def minimise(spec: str, case: str, **subject: Any) -> None:  # noqa: ANN401 - of SUBJECT
    """Simplify, and tell what came of it."""
    from hypcheck.casebook.families import is_extreme
    from hypcheck.classification.answer import answer
    from hypcheck.classification.text import answer_as_text
    from hypcheck.hunt.minimise import minimise as simplify
    from hypcheck.hunt.text import minimised_lines
    from hypcheck.pairs import Pair
    from hypcheck.replay.case import case_of

    given = case_of(case)
    with opened(spec, **subject) as target:
        run = simplify(replace(target, extreme=is_extreme(given.name)), Pair.from_row(given.row))
    for line in minimised_lines(run):
        click.echo(printable(line))
    click.echo(f"\nthe right answer: {answer_as_text(answer(Pair.from_row(run.last.case.row)))}")
