"""`hypcheck explain`: the causes of wrong answers, by the ids that records and reports have."""

from __future__ import annotations

import click

from hypcheck.cli import completing
from hypcheck.messages import printable

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
@click.argument("name", metavar="[ID]", required=False, type=completing.Names(completing.causes))
@click.option("--format", "form", type=click.Choice(["text", "json"]), default="text", show_default=True)
def explain(name: str | None, form: str) -> None:
    """Explain, and print the result."""
    from hypcheck.runs import explain as known

    if name is None:
        causes = [known.brief(each) for each in known.BY_ID.values()]
        lines = [known.as_json(causes)] if form == "json" else known.listed()
    else:
        cause = known.cause_with_id(name)
        lines = [known.as_json(known.explained(cause))] if form == "json" else known.explained_lines(cause)
    for line in lines:
        for part in line.split("\n"):
            click.echo(printable(part))
