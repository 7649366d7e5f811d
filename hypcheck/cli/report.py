"""`hypcheck report`: a record into any of its reports, on the screen, into a file or into a folder."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from hypcheck.cli.options import Place
from hypcheck.cli.progress import in_lines
from hypcheck.errors import InputError
from hypcheck.report.write import REPORTS, kept, write_reports
from hypcheck.tables.streams import same_file, writing
from hypcheck.visible import printable, visible

if TYPE_CHECKING:
    from hypcheck.record import Record

_HELP = f"""Make reports of RECORD, a record.jsonl or the folder of a run, from nothing but what the record has.

Without options the summary is printed. With --out FOLDER every report of a run is written there; with --out FILE the
one that its name says. --format chooses ({", ".join(REPORTS)}); one of them without --out goes to standard output.

\b
hypcheck report reports/latest
hypcheck report reports/latest --format html --out report.html
hypcheck report new/record.jsonl --against old/record.jsonl --format markdown

With --against, terminal, markdown and html show what changed: statuses, the worst errors, and ratios of times within
each run, never times of two machines.
"""


@click.command(help=_HELP, short_help="Make any report of a record, and show what changed against another.")
@click.argument("record", type=click.Path(path_type=Path))
@click.option("--format", "formats", multiple=True, type=click.Choice(list(REPORTS)), help="May be given repeatedly.")
@click.option("--out", type=Place(), help="A file, or a folder.")
@click.option("--against", type=click.Path(path_type=Path), help="An earlier record, or the folder of its run.")
def report(record: Path, formats: tuple[str, ...], out: Path | None, against: Path | None) -> None:
    """Make reports of a record."""
    wanted = tuple(dict.fromkeys(formats))
    _refuse_silence(wanted, against)
    target = None if out is None else _file_format(out, wanted)
    if out is None and len(wanted) > 1:
        raise InputError(f"{len(wanted)} formats need a folder: --out FOLDER")
    found, other = _read(record, record), None if against is None else _read(against, record)
    if out is None:
        _print(found, wanted[0] if wanted else "terminal", other)
    elif target is None:
        _into_folder(found, out, wanted or kept(), other)
    else:
        if any(same_file(str(out), str(each)) for each in (record, against) if each is not None):
            raise InputError(f"--out {out} is a record that is being read; name another file")
        _into_file(found, record, out, target, other)


def _refuse_silence(wanted: Sequence[str], against: Path | None) -> None:
    """A comparison that none of the formats shows would be lost without a word."""
    comparing = [name for name, each in REPORTS.items() if each.compares]
    if against is not None and wanted and not set(wanted) & set(comparing):
        raise InputError(f"--against is shown by {', '.join(comparing)} alone, not by {', '.join(wanted)}")


def _file_format(out: Path, wanted: Sequence[str]) -> str | None:
    """The format of the one file that --out names; None where it names a folder."""
    if out.is_dir() or not out.suffix or len(wanted) > 1:
        return None
    if wanted:
        return wanted[0]
    fitting = [name for name, each in REPORTS.items() if Path(each.file).suffix == out.suffix]
    usual = [name for name in fitting if name in kept()]
    named = [name for name in fitting if REPORTS[name].file == out.name] or usual
    if len(named or fitting) != 1:
        raise InputError(f"--out {out}: its name does not tell which report it is; say --format {', '.join(REPORTS)}")
    return (named or fitting)[0]


def _read(path: Path, subject: Path) -> Record:
    from hypcheck.record.reader import file_and_newer, notes, read

    _, newer = file_and_newer(path)
    record = read(path)
    if path is subject:
        older = [f"this is an older run: {visible(newer)}"] if newer else []
        for note in [*older, *notes(record)]:
            click.echo(f"hypcheck: note: {printable(note)}", err=True)
    return record


def _print(record: Record, name: str, against: Record | None) -> None:
    from hypcheck.report.terminal import summary_lines
    from hypcheck.report.write import Around

    if name == "terminal":
        for line in summary_lines(record, (), against=against, **in_lines()):
            click.echo(line)
        return
    content = REPORTS[name].render(record, Around(against=against))
    with writing("-") as file:
        file.write(content)


def _into_file(record: Record, source: Path, out: Path, name: str, against: Record | None) -> None:
    from hypcheck.report.write import Around

    content = REPORTS[name].render(record, Around(_beside(source, out), against))
    with writing(str(out)) as file:
        file.write(content)
    click.echo(f"{name}: {printable(out)}")


def _beside(source: Path, out: Path) -> list[str]:
    """The pictures of the same run: those in the record's own folder, where the report goes there too."""
    folder = source if source.is_dir() else source.parent
    if folder.resolve() != out.parent.resolve():
        return []
    return [each.file for each in REPORTS.values() if (folder / each.file).is_file()]


def _into_folder(record: Record, out: Path, wanted: Sequence[str], against: Record | None) -> None:
    for each in write_reports(record, out, wanted, against):
        click.echo(printable(each.path if each.skipped is None else f"no {each.path.name}: {each.skipped}"))
