"""The packages, from the tree to the registry: `python -m packages COMMAND`; docs/packages.md says what each is for."""

from __future__ import annotations

from pathlib import Path

import click

from hypcheck.version import VERSION
from packages import archives, checks, python, sbom, trials, version

MADE = (*python.KINDS, *sorted(archives.LANGUAGES))
DIST = click.option(
    "--out", "dist", type=click.Path(file_okay=False, path_type=Path), default=Path("dist"), show_default=True
)


@click.group()
def main() -> None:
    """Build the packages, check them, try each as a stranger does, and raise their version."""


@main.command()
@click.argument("names", nargs=-1, type=click.Choice(MADE))
@DIST
def build(names: tuple[str, ...], dist: Path) -> None:
    """Build these packages, or all, each with a document of what it is made of."""
    dist.mkdir(parents=True, exist_ok=True)
    for name in names or MADE:
        for archive in (python.build if name in python.KINDS else archives.build)(name, dist):
            sbom.write(archive)
            click.echo(archive)


@main.command()
@DIST
def describe(dist: Path) -> None:
    """Write beside each archive what it is made of; `build` does it for those that it builds."""
    for archive in checks.archives(dist):
        click.echo(sbom.write(archive))


@main.command()
@DIST
def check(dist: Path) -> None:
    """Check versions, sizes, licences, documents, and what package indexes ask for."""
    wrong = checks.faults(dist)
    if wrong:
        raise click.ClickException("\n".join(wrong))
    click.echo(f"{len(checks.archives(dist))} archives of version {VERSION} may be published")


@main.command("try")
@click.argument("names", nargs=-1, type=click.Choice(sorted(trials.TRIALS)))
@DIST
def try_(names: tuple[str, ...], dist: Path) -> None:
    """Install from the archives in fresh environments, with one answer and one gate each."""
    for name in names or trials.TRIALS:
        click.echo(f"\n# {name}")
        for text in trials.tried(name, dist):
            click.echo(text)


@main.command("version")
@click.argument("new", required=False)
def version_(new: str | None) -> None:
    """Print the version, or raise it to NEW in all files that say it."""
    if new is None:
        click.echo(VERSION)
        return
    version.raise_to(archives.ROOT, new)
    click.echo(f"all files say {new}; next: CHANGELOG.md, make goldens, make reference, make release")


if __name__ == "__main__":
    main()
