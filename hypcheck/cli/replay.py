"""`hypcheck replay`: one case asked of one implementation, with the truth, its proof and the formula's values."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import click

from hypcheck.cli.options import Number, limits_of, with_limits
from hypcheck.cli.settings import announce_file
from hypcheck.errors import Exit
from hypcheck.visible import printable

_HELP = """\
Show what SPEC answers to CASE, what is true and why, and where the formula goes wrong that is nearest to it.

CASE is a case's id (ring-0007, ring/1/42/7), a row alpha,gamma,b,d,x,y,z in decimals or hexadecimal floats, or
RECORD:N, the N-th case that a record.jsonl (or the folder of its run) has kept, as reports number them.

\b
hypcheck replay ring-0007 builtin:table-2-float64
hypcheck replay 2,5,1,1,3,0,0 library:./libcollide.so
hypcheck replay reports/latest/record.jsonl:3 "command:./adapter --fast"

The values of a formula are those of a straight-line program, in the implementation's precision beside exact arithmetic.
>> marks the first decision that rounding turned, and > the number it was taken from.

Ends with 0 when the answer is right or tolerated, 1 when it is not, 5 when SPEC cannot be started.
"""


@click.command(help=_HELP, short_help="Show an implementation's answer to one case, and where it goes wrong.")
@click.argument("case")
@click.argument("spec")
@click.option("--formula", metavar="NAME", help="Whose values to show.  [default: its own, or one that answers alike]")
@click.option("--json", "as_json", is_flag=True, help="One JSON object, its proof in exact numbers.")
@click.option("--precision", metavar="FORMAT", help="The precision u is taken from.  [default: as declared]")
@click.option("--question", metavar="WHAT", help="position, exterior, interior or contact.  [default: as declared]")
@click.option("--domain", metavar="JSON", help="Where it claims to be right, in place of what it declares.")
@click.option("--tolerance", type=Number(0), default=8.0, show_default=True, help="In units u.")
@with_limits
@click.pass_context
def replay(
    context: click.Context,
    /,
    case: str,
    spec: str,
    formula: str | None,
    as_json: bool,
    precision: str | None,
    question: str | None,
    domain: str | None,
    tolerance: float,
    **limits: Any,  # noqa: ANN401 - of with_limits
) -> None:
    """Replay, and tell what came of it."""
    from hypcheck.judge import Criterion
    from hypcheck.methods.description import parse_domain
    from hypcheck.methods.opening import open_implementation
    from hypcheck.replay.as_json import replay_as_json
    from hypcheck.replay.case import case_of
    from hypcheck.replay.choosing import require_formula
    from hypcheck.replay.run import replay as run
    from hypcheck.replay.text import replay_lines

    asked = case_of(case)
    require_formula(formula)
    claimed = None if domain is None else parse_domain(domain)
    announce_file()
    with open_implementation(
        spec, limits_of(**limits), precision=precision, question=question, domain=claimed
    ) as implementation:
        used = implementation.description
        done = run(asked, implementation, Criterion(used.question, used.precision, Fraction(tolerance)), formula)
    for line in [replay_as_json(done)] if as_json else replay_lines(done):
        click.echo(printable(line))
    context.exit(Exit.HELD if done.judgement.passes else Exit.WRONG)
