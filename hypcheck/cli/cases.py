"""`hypcheck cases`: list, show, generate, check and freeze certified test vectors."""

from __future__ import annotations

import os
from pathlib import Path

import click

from hypcheck.cli import options
from hypcheck.cli.commands import CommandGroup
from hypcheck.errors import InputError
from hypcheck.messages import counted, printable

_FORMATS = ("json", "csv", "npy")


@click.group(cls=CommandGroup, short_help="List, show, generate and check certified test vectors.")
def cases() -> None:
    """Certified test vectors: rows, right answers, and a proof of each answer.

    The frozen ones travel with the package, a JSON file a family; their README says how to use them without hypcheck.
    """


@cases.command("list", short_help="List the families, and how many cases of each are frozen.")
def list_() -> None:
    """List the families, and how many cases of each are frozen."""
    from hypcheck.vectors.showing import list_lines

    for line in list_lines():
        click.echo(printable(line))


@cases.command(short_help="Show a family, or a case with its proof.")
@click.argument("name", metavar="ID|FAMILY", type=options.Names(options.families_and_cases))
@click.option("--json", "as_json", is_flag=True, help="Print the JSON of the vector file.")
def show(name: str, as_json: bool) -> None:
    """Show a family, a frozen case (ring-0007) or a generated one (ring/1/42/7)."""
    from hypcheck.vectors.showing import show as lines_of

    for line in lines_of(name, as_json=as_json):
        click.echo(printable(line))


@cases.command(short_help="Make rows of a family, as many as you like.")
@click.argument("family", metavar="FAMILY", type=options.Names(options.families))
@options.SEED
@click.option("--count", type=options.IntegerOption(1), default=100, show_default=True, help="Number of rows.")
@click.option(
    "--format", "format_name", type=click.Choice(_FORMATS), help="By default the ending of --output, or json."
)
@click.option("--output", "target", metavar="FILE", default="-", help="By default standard output.")
def generate(family: str, seed: int, count: int, format_name: str | None, target: str) -> None:
    """Make rows of a family: the same bytes on every machine, and more rows begin with those of fewer.

    FAMILY is one that `cases list` shows, or one for given sizes, such as razor@2.0,17.8,0.25,0.15,z=-17.8:17.8.

    As json they are a vector file, every row labelled and proved; csv has ids and rows, npy rows alone, float64 (n, 7).
    """
    from hypcheck.vectors.showing import generate as write

    write(family, seed, count, format_name or _format_of(target), target)


@cases.command(short_help="Prove every label of the frozen files, or of yours.")
@click.argument("files", nargs=-1, metavar="[FILE]...")
@click.option(
    "--checker",
    type=click.Choice(("python", "coq")),
    default="python",
    show_default=True,
    help="coq: position, tangency and first contact, beside ends the position, by the checker of `make prove`.",
)
@click.pass_context
def check(context: click.Context, files: tuple[str, ...], checker: str) -> None:
    """Prove every label of every vector from its certificate, and compute the rest again.

    Flags, and the description of a family that hypcheck knows, must be those that hypcheck has.

    Ends with 0 if all is right, 1 if a label or a head is wrong, 2 if a file does not have the form of its schema.
    """
    from hypcheck.errors import Exit
    from hypcheck.proofs.build import frozen_files, run_checker
    from hypcheck.vectors.checking import examine, shipped_files

    if checker == "coq":
        context.exit(run_checker(list(files) or frozen_files()))
    checked, faulty, heads = 0, 0, 0
    for report in examine(files or shipped_files()):
        for wrong in report.head:
            click.echo(printable(f"{report.path}, line {wrong.line}: {wrong.sentence}"))
        for fault in report.faults:
            click.echo(printable(f"{report.path}, line {fault.line}, case {fault.case}: {fault.sentence}"))
        checked += report.count
        faulty += len({fault.case for fault in report.faults})
        heads += bool(report.head)
    at_heads = f"; {counted(heads, 'file')} with a wrong head" if heads else ""
    click.echo(f"{counted(checked, 'case')} checked, {faulty or 'none'} with a wrong label{at_heads}")
    context.exit(Exit.WRONG if faulty or heads else Exit.HELD)


@cases.command(short_help="Make the frozen files again, keeping every id.")
@click.argument("names", nargs=-1, metavar="[FAMILY]...", type=options.Names(options.frozen_families))
@click.option("--into", type=click.Path(path_type=Path), default=Path("cases"), show_default=True, metavar="FOLDER")
def freeze(names: tuple[str, ...], into: Path) -> None:
    """Make the frozen files again: existing cases keep ids and rows, new ones follow.

    All files take some minutes, most of it the search for the worst cancellation and the flips of tilted spheroids.
    """
    from hypcheck.vectors.freezing import freeze as write
    from hypcheck.vectors.frozen import ALL_NAMES

    write(names or ALL_NAMES, into, lambda name: click.echo(printable(into / f"{name}.json")))


def _format_of(target: str) -> str:
    """Return the format that the ending of a file name means. Raises InputError if it means none."""
    end = os.path.splitext(target)[1].lower().removeprefix(".")
    if target == "-":
        return _FORMATS[0]
    if end not in _FORMATS:
        raise InputError(
            f"--output {target}: its name must end in .json, .csv or .npy, or --format must name one of them"
        )
    return end
