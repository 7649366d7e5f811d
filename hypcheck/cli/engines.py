"""`hypcheck engines`: collision engines installed apart, and the record of what they get wrong."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from hypcheck.cli.commands import CommandGroup
from hypcheck.cli.options import OutputPath
from hypcheck.errors import InputError

if TYPE_CHECKING:
    from hypcheck.engines.table import Engine

_CACHE = click.option(
    "--cache", type=click.Path(path_type=Path), help="Where engines are installed.  [default: the user's cache]"
)


@click.group(cls=CommandGroup, short_help="Install collision engines apart, and measure what they get wrong.")
def engines() -> None:
    """Install collision engines apart, each pinned by version, and measure what they get wrong near contact.

    Each engine has an environment of its own in the user's cache (XDG_CACHE_HOME; HYPCHECK_ENGINES names another
    folder).
    """


def _folder(cache: Path | None) -> Path:
    from hypcheck.engines.install import cache_folder

    return cache or cache_folder()


def _installed(names: tuple[str, ...], cache: Path | None) -> list[Engine]:
    """The engines of these names, or all that are installed. Raises InputError where one is not, or none is."""
    from hypcheck.engines.install import is_installed
    from hypcheck.engines.table import engines_of

    found = [engine for engine in engines_of(names) if names or is_installed(engine, _folder(cache))]
    missing = [engine.name for engine in found if not is_installed(engine, _folder(cache))]
    if missing or not found:
        what = f"{missing[0]} is not installed" if missing else "no engine is installed"
        raise InputError(f"{what}; type: hypcheck engines install {missing[0] if missing else 'NAME'}")
    return found


@engines.command("list", short_help="Show the engines, their versions, and which are installed.")
@_CACHE
def list_(cache: Path | None) -> None:
    """Show each engine: its name and version, what stands for a spheroid, and whether it is installed."""
    from hypcheck.engines.install import is_installed, missing_tool
    from hypcheck.engines.table import ENGINES

    folder = _folder(cache)
    for engine in ENGINES.values():
        state = "installed" if is_installed(engine, folder) else missing_tool(engine) or "not installed"
        click.echo(f"{engine.name:<14} {engine.version:<10} {engine.body:<12} {state}")


@engines.command(short_help="Install engines, each in an environment of its own.")
@click.argument("names", nargs=-1, required=True, metavar="NAME...")
@_CACHE
def install(names: tuple[str, ...], cache: Path | None) -> None:
    """Install these engines at their pinned versions with pip, npm or cargo.

    The environment of hypcheck stays as it is. A program that is missing, such as node or cargo, is named and not
    installed.
    """
    from hypcheck.engines.install import install as install_one
    from hypcheck.engines.table import engines_of

    for engine in engines_of(names):
        install_one(engine, _folder(cache))
        click.echo(f"installed {engine.name} {engine.version}")


@engines.command(short_help="Measure installed engines near contact, and write the record.")
@click.argument("names", nargs=-1, metavar="[NAME]...")
@click.option("--out", type=OutputPath(), default=Path("reports/engines"), show_default=True)
@_CACHE
def verify(names: tuple[str, ...], out: Path, cache: Path | None) -> None:
    """Ask engines about rows at certified distances from contact; all that are installed, without a NAME.

    Writes NAME.json for each engine into --out.
    """
    from hypcheck.engines.run import record_of, write_record

    for engine in _installed(names, cache):
        record = record_of(engine, _folder(cache), lambda text: click.echo(text, err=True))
        write_record(out, record)
        click.echo(f"measured {engine.name} {engine.version}")
