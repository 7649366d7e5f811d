"""`hypcheck record`: whether a record is as it was written, and what of it can be saved."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from hypcheck.cli.groups import Group
from hypcheck.cli.options import Place
from hypcheck.errors import Exit
from hypcheck.tables.route import STREAM
from hypcheck.visible import visible

if TYPE_CHECKING:
    from hypcheck.record.repairing import Condition


@click.group("record", cls=Group, short_help="Check a record's checksums, and save what is good of a damaged one.")
def record_() -> None:
    """Look after a record.jsonl, whose every line has a checksum."""


@record_.command(short_help="Say whether a record is as it was written.")
@click.argument("record", type=click.Path(path_type=Path))
@click.pass_context
def check(context: click.Context, /, record: Path) -> None:
    """Say whether RECORD is as it was written, and where it is not.

    RECORD is a record.jsonl, the folder of a run, or - for standard input.

    Ends with 0 when it is whole, 1 when it is cut off (its run was interrupted: what was finished is good) or when a
    newer run in its folder has not finished, 2 when it is damaged.
    """
    from hypcheck.record.reader import file_and_newer
    from hypcheck.record.repairing import check as condition_of

    file, newer = file_and_newer(record)
    found = condition_of(file)
    sums = "with their checksums" if found.sealed else f"without checksums, as schema {found.schema} has them"
    click.echo(f"{visible(file)}: {_kept(found)}, {sums}; {_ending(found)}")
    if newer:
        click.echo(f"it is of an older run: {visible(newer)}")
    context.exit(Exit.HELD if found.complete and not newer else Exit.WRONG)


@record_.command(short_help="Keep everything up to the last good line.")
@click.argument("record", type=click.Path(path_type=Path))
@click.option(
    "--out",
    type=Place(stream=True),
    required=True,
    help="Where what is good is written (- is standard output).",
)
def repair(record: Path, out: Path) -> None:
    """Write everything of RECORD up to its last good line to another file, and say what is lost.

    Without its footer the result is read as truncated: reports can be made of it, and it counts as no pass.
    """
    from hypcheck.record.reader import file_of
    from hypcheck.record.repairing import repair as repaired

    found = repaired(file_of(record), out)
    beside = str(out) == STREAM
    click.echo(f"{visible(out)}: {_kept(found)}; {_ending(found)}", err=beside)
    if found.why:
        click.echo(f"lost: {visible(found.why)}", err=beside)


def _kept(found: Condition) -> str:
    return f"{_lines(found.lines, 'good ')}, {_bytes(found.size)}"


def _ending(found: Condition) -> str:
    if found.complete and not found.lost_bytes:
        return f"it is whole, of a run that ended with {found.exit_code}"
    if not found.lost_bytes:
        return "it has no footer, so it is cut off, or its run was interrupted"
    verb = "is" if found.lost_bytes == 1 else "are"
    return f"{_bytes(found.lost_bytes)} ({_lines(found.lost_lines)}) from byte {found.size} on {verb} lost"


def _bytes(number: int) -> str:
    return f"{number} byte{'' if number == 1 else 's'}"


def _lines(count: int, kind: str = "") -> str:
    return f"{count} {kind}line{'' if count == 1 else 's'}"
