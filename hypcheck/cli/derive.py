"""`hypcheck derive`: the derivation, the propositions, the ledger of the paper's claims and the costs."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import click

from hypcheck.errors import Exit, InputError
from hypcheck.paper.derive.asking import FORMATS, PARTS

_HELP = """Show the derivation step by step, the proofs of the propositions, and what became of the paper's claims.

Everything that is shown is derived by sympy while it is printed: formulas are held against what follows from the two
surfaces, counterexamples are searched for among small rational pairs and proved by certificates.

\b
hypcheck derive
hypcheck derive --only ledger
hypcheck derive --claim "Proposition 3"
hypcheck derive --format latex --output derivation.tex
hypcheck derive --format erratum --output erratum.tex

Ends with 0 when all that was shown holds, with 6 when our derivation disagrees with what it is said to show.
"""


@click.command(help=_HELP, short_help="Show the derivation and the ledger of the paper's claims, checked.")
@click.option("--format", "form", type=click.Choice(tuple(FORMATS)), default="text", show_default=True)
@click.option("--only", multiple=True, type=click.Choice(tuple(PARTS)), help="A part; several may be given.")
@click.option("--claim", metavar="NUMBER", help="One claim in full: 12, A.2b, 'Remark 4', 'Table 2', 'Proposition 5'.")
@click.option("--output", default="-", show_default=True, metavar="FILE", help="Where it goes, whole or not at all.")
@click.pass_context
def derive(context: click.Context, /, form: str, only: tuple[str, ...], claim: str | None, output: str) -> None:
    """Derive, and tell what came of it."""
    if claim is not None and only:
        raise InputError("--claim shows one claim and --only parts of all; use one of them")
    if form == "erratum" and (claim is not None or only):
        raise InputError("--format erratum writes one whole note; it takes neither --claim nor --only")
    from hypcheck.paper.derive.asking import writer
    from hypcheck.paper.derive.choosing import Chosen

    chosen = Chosen(() if claim is not None else only or tuple(PARTS), claim)
    _write(writer(form)(chosen), output)
    if form == "erratum" and output != "-":
        from hypcheck.paper.derive.erratum import compile_note

        click.echo(compile_note(Path(output)), err=True)
    failing = chosen.failing
    if failing:
        click.echo(f"hypcheck: our derivation disagrees with what it is said to show: {', '.join(failing)}", err=True)
    context.exit(Exit.ORACLES_DISAGREE if failing else Exit.HELD)


def _write(lines: Iterable[str], output: str) -> None:
    """Lines to standard output as they come, or to a file that appears when it is complete."""
    if output == "-":
        for line in lines:
            click.echo(line)
        return
    from hypcheck.tables.streams import writing

    with writing(output) as file:
        for line in lines:
            file.write(f"{line}\n".encode())
