"""`hypcheck engines`: collision engines in separate environments, and the record of their errors."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

import click

from hypcheck.cli import options
from hypcheck.cli.commands import CommandGroup
from hypcheck.errors import InputError
from hypcheck.messages import counted

if TYPE_CHECKING:
    from hypcheck.engines.engine import Engine


def _cache_folder() -> Path:
    from hypcheck.engines.engine import cache_folder

    return cache_folder()


_CACHE = click.option(
    "--cache",
    type=click.Path(path_type=Path),
    default=_cache_folder,
    help="Where engines are installed.  [default: the user's cache]",
)


@click.group(cls=CommandGroup, short_help="Install collision engines separately, and measure their errors.")
def engines() -> None:
    """Install collision engines in separate environments, pinned by version, and measure their errors near contact.

    Each engine has an environment of its own in the user's cache (XDG_CACHE_HOME; HYPCHECK_ENGINES names another
    folder).
    """


def _installed(names: tuple[str, ...], cache: Path) -> list[Engine]:
    """Return the engines of these names, or all installed ones.

    Raises InputError if one of them, or each, is missing.
    """
    from hypcheck.engines.engine import engines_of, is_installed

    chosen = [engine for engine in engines_of(names) if names or is_installed(engine, cache)]
    missing = [engine.name for engine in chosen if not is_installed(engine, cache)]
    if missing or not chosen:
        what = f"{missing[0]} is not installed" if missing else "no engine is installed"
        raise InputError(f"{what}; type: hypcheck engines install {missing[0] if missing else 'NAME'}")
    return chosen


def _from_here(word: str) -> str:
    """Return the word, as a relative path if it is a path below the working directory."""
    here = Path.cwd()
    return os.path.relpath(word, here) if Path(word).is_relative_to(here) else word


@engines.command("list", short_help="Show the engines, their versions, and which are installed.")
@_CACHE
def list_(cache: Path) -> None:
    """Show each engine: its name and version, the shape that it uses for a spheroid, and whether it is installed."""
    from hypcheck.engines.engine import ENGINES, is_installed, missing_tool

    click.echo(f"{'engine':<14} {'version':<10} {'body':<12} state")
    for engine in ENGINES.values():
        state = "installed" if is_installed(engine, cache) else missing_tool(engine) or "not installed"
        click.echo(f"{engine.name:<14} {engine.version:<10} {engine.body:<12} {state}")


@engines.command(short_help="Install engines, each in an environment of its own.")
@click.argument("names", nargs=-1, required=True, metavar="NAME...", type=options.ENGINE)
@_CACHE
def install(names: tuple[str, ...], cache: Path) -> None:
    """Install these engines at their pinned versions with pip, npm or cargo.

    The environment of hypcheck stays as it is. A program that is missing, such as node or cargo, is named and not
    installed.
    """
    from hypcheck.engines.engine import engines_of
    from hypcheck.engines.engine import install as install_one

    for engine in engines_of(names):
        install_one(engine, cache)
        click.echo(f"installed {engine.name} {engine.version}")


@engines.command(short_help="Measure installed engines near contact, and write the record.")
@click.argument("names", nargs=-1, metavar="[NAME]...", type=options.ENGINE)
@click.option("--out", type=options.OutputPath(), default=Path("reports/engines"), show_default=True)
@_CACHE
def verify(names: tuple[str, ...], out: Path, cache: Path) -> None:
    """Ask engines about rows at certified distances from contact; all that are installed, without a NAME.

    Writes into --out for each engine its record, a badge, and for its worst errors files that show them without
    hypcheck; and README.md, the page of all that was ever measured into --out.
    """
    from hypcheck.engines.findings import read_findings
    from hypcheck.engines.measure import record_of, write_record
    from hypcheck.engines.reduce import findings_of
    from hypcheck.engines.report import write_findings, write_page

    for engine in _installed(names, cache):
        record = record_of(engine, cache, lambda text: click.echo(text, err=True))
        write_record(out, record)
        others = [finding for finding in read_findings(out) if finding.engine != engine.name]
        findings = list(findings_of(record, cache))
        write_findings(out, [*others, *findings])
        write_page(out)
        click.echo(f"measured {engine.name} {engine.version}: {counted(len(findings), 'finding')}")


@engines.command(short_help="Compare engines by error and run time with every other method.")
@click.argument("names", nargs=-1, metavar="[NAME]...", type=options.ENGINE)
@click.option("--out", type=options.OutputPath(), default=Path("reports/engines/bench"), show_default=True)
@click.option("--triangles", type=options.IntegerOption(100, 1_000_000), default=5000, show_default=True)
@_CACHE
@click.pass_context
def bench(context: click.Context, names: tuple[str, ...], out: Path, triangles: int, cache: Path) -> None:
    """Compare engines on the rows of `hypcheck bench --quick`, on the paper's tower as a mesh of so many triangles.

    Its plot shows their errors over their run times, with those of every other method.
    """
    from hypcheck.cli.bench import bench as compare
    from hypcheck.engines.engine import command
    from hypcheck.engines.measure import spec_of
    from hypcheck.engines.placing import FAMILIES
    from hypcheck.engines.scene import surface_mesh, write_scene

    chosen, scene = _installed(names, cache), cache / "scenes" / f"body-{triangles}"
    sizes = FAMILIES["body"].sizes
    write_scene(scene, sizes, surface_mesh(sizes, triangles))
    # Paths as seen from here: the overview prints them, and is committed.
    specs = [spec_of([_from_here(word) for word in command(engine, cache, scene.absolute())]) for engine in chosen]
    with compare.make_context("bench", ["--quick", "--out", str(out), *specs], parent=context) as made:
        compare.invoke(made)
