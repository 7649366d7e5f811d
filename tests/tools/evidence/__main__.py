"""`python -m tests.tools.evidence PART... [--write]`: measures parts of the evidence.

Ends with 1 if a figure fell, and with 2 if a part could not be measured.
"""

from __future__ import annotations

import sys

import click

from tests.tools.evidence.floors import broken
from tests.tools.evidence.page import write_page
from tests.tools.evidence.parts import KEPT, PARTS, Figures, Unavailable, kept, part, text_of


@click.command()
@click.argument("names", metavar="PART...", nargs=-1, required=True, type=click.Choice(["all", *PARTS]))
@click.option("--write", is_flag=True, help="Keep the figures, and print docs/evidence.md from them.")
def main(names: tuple[str, ...], write: bool) -> None:
    """Measure the named parts, or all, and print their sections."""
    figures, fallen, missing = kept(), [], False
    for name in PARTS if "all" in names else names:
        found = _measured(name)
        if found is None:
            missing = True
            continue
        figures[name] = found
        fallen += broken(name, found)
        click.echo(f"## {part(name).TITLE}\n\n{part(name).section(found).strip()}\n")
    if write:
        KEPT.write_text(text_of(figures), encoding="utf-8")
        write_page(figures)
    for sentence in fallen:
        click.echo(sentence, err=True)
    sys.exit(1 if fallen else 2 if missing else 0)


def _measured(name: str) -> Figures | None:
    try:
        return part(name).measure()
    except Unavailable as error:
        click.echo(f"{name} is not measured here, and its figures stay: {error}", err=True)
        return None


if __name__ == "__main__":
    main()
