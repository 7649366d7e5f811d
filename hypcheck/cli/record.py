"""`hypcheck report` and `hypcheck record`: reports made from a record; a record checked, and repaired."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from hypcheck.cli.commands import CommandGroup
from hypcheck.cli.options import OutputPath
from hypcheck.cli.running import summary_options
from hypcheck.errors import Exit, InputError
from hypcheck.messages import counted, escaped, printable
from hypcheck.report import REPORTS, kept_formats
from hypcheck.tables import STREAM
from hypcheck.tables.streams import replace_output, same_file

if TYPE_CHECKING:
    from hypcheck.record import Record
    from hypcheck.record.integrity import FileCondition


_HELP = f"""Make reports of RECORD, a record.jsonl or the folder of a run.

Without options the summary is printed. With --out FOLDER every report of a run is written there; with --out FILE the
one that its name says. --format chooses ({", ".join(REPORTS)}); without --out, one of them goes to standard output.

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
@click.option("--out", type=OutputPath(), help="A file, or a folder.")
@click.option("--against", type=click.Path(path_type=Path), help="An earlier record, or the folder of its run.")
def report(record: Path, formats: tuple[str, ...], out: Path | None, against: Path | None) -> None:
    """Make reports of a record."""
    wanted = tuple(dict.fromkeys(formats))
    _require_comparing(wanted, against)
    target = None if out is None else _file_format(out, wanted)
    if out is None and len(wanted) > 1:
        raise InputError(f"{len(wanted)} formats need a folder: --out FOLDER")
    from hypcheck.record.reader import file_and_newer

    shown, other = _read(record, record), None if against is None else _read(against, record)
    if out is None:
        _print(shown, wanted[0] if wanted else "terminal", other)
    elif target is None:
        _into_folder(shown, out, wanted or kept_formats(), other)
    else:
        if any(
            same_file(str(out), str(file_and_newer(other_record)[0]))
            for other_record in (record, against)
            if other_record is not None
        ):
            raise InputError(f"--out {out} is a record that is being read; name another file")
        _into_file(shown, record, out, target, other)


def _require_comparing(wanted: Sequence[str], against: Path | None) -> None:
    """Raise InputError if none of the wanted formats shows the comparison."""
    comparing = [name for name, report in REPORTS.items() if report.compares]
    if against is not None and wanted and not set(wanted) & set(comparing):
        raise InputError(f"--against is shown only by {', '.join(comparing)}, not by {', '.join(wanted)}")


def _file_format(out: Path, wanted: Sequence[str]) -> str | None:
    """Return the format of the file that --out names; None if it names a folder."""
    if out.is_dir() or not out.suffix or len(wanted) > 1:
        return None
    if wanted:
        return wanted[0]
    named = [name for name, report in REPORTS.items() if report.file == out.name]
    alike = [name for name, report in REPORTS.items() if report.by_suffix and Path(report.file).suffix == out.suffix]
    usual = [name for name in alike if name in kept_formats()]
    names = named or usual or alike
    if len(names) != 1:
        raise InputError(f"--out {out}: its name does not say which report it is; use --format {', '.join(REPORTS)}")
    return names[0]


def _read(path: Path, subject: Path) -> Record:
    """Read a record; for the record that reports are made of, print notes about its run."""
    from hypcheck.record.reader import file_and_newer, notes, read

    _, newer = file_and_newer(path)
    record = read(path)
    if path is subject:
        older = [f"this is an older run: {escaped(newer)}"] if newer else []
        for note in [*older, *notes(record)]:
            click.echo(f"hypcheck: note: {printable(note)}", err=True)
    return record


def _print(record: Record, name: str, against: Record | None) -> None:
    """Write one report to standard output."""
    from hypcheck.report.drawings import ReportContext
    from hypcheck.report.terminal import summary_lines
    from hypcheck.report.write import render

    if name == "terminal":
        for line in summary_lines(record, (), against=against, **summary_options()):
            click.echo(line)
        return
    content = render(name, record, ReportContext(against=against))
    with replace_output("-") as file:
        file.write(content)


def _into_file(record: Record, source: Path, out: Path, name: str, against: Record | None) -> None:
    """Write one report to a file."""
    from hypcheck.report.drawings import ReportContext
    from hypcheck.report.write import render

    content = render(name, record, ReportContext(_beside(source, out), against))
    with replace_output(str(out)) as file:
        file.write(content)
    click.echo(f"{name}: {printable(out)}")


def _beside(source: Path, out: Path) -> list[str]:
    """Return the pictures of the same run: those in the record's folder, if the report goes there too."""
    folder = source if source.is_dir() else source.parent
    if folder.resolve() != out.parent.resolve():
        return []
    return [report.file for report in REPORTS.values() if (folder / report.file).is_file()]


def _into_folder(record: Record, out: Path, wanted: Sequence[str], against: Record | None) -> None:
    """Write reports to a folder, and print their paths."""
    from hypcheck.report.write import write_reports

    for written in write_reports(record, out, wanted, against):
        click.echo(printable(written.path if written.skipped is None else f"no {written.path.name}: {written.skipped}"))


@click.group("record", cls=CommandGroup, short_help="Check a record's checksums, and repair a damaged record.")
def record_() -> None:
    """Check and repair a record.jsonl, whose every line has a checksum."""


@record_.command(short_help="Check whether a record is as it was written.")
@click.argument("record", type=click.Path(path_type=Path))
@click.pass_context
def check(context: click.Context, /, record: Path) -> None:
    """Check whether RECORD is as it was written, and show where it is not.

    RECORD is a record.jsonl, the folder of a run, or - for standard input.

    Ends with 0 if it is complete, 1 if it is cut off (its run was interrupted, and the finished part is good) or if a
    newer run in its folder has not finished, 2 if it is damaged.
    """
    from hypcheck.record.integrity import check as condition_of
    from hypcheck.record.reader import file_and_newer

    file, newer = file_and_newer(record)
    condition = condition_of(file)
    sums = (
        "with their checksums"
        if condition.sealed
        else f"without checksums, which schema {condition.schema} does not have"
    )
    click.echo(f"{escaped(file)}: {_kept(condition)}, {sums}; {_ending(condition)}")
    if newer:
        click.echo(f"this is an older run: {escaped(newer)}")
    context.exit(Exit.HELD if condition.complete and not newer else Exit.WRONG)


@record_.command(short_help="Keep everything up to the last good line.")
@click.argument("record", type=click.Path(path_type=Path))
@click.option(
    "--out",
    type=OutputPath(stream=True),
    required=True,
    help="The file to write; - is standard output.",
)
def repair(record: Path, out: Path) -> None:
    """Copy RECORD up to its last good line to another file, and report what is lost.

    A result without a footer is read as truncated: reports can be made of it, but it counts as no pass.
    """
    from hypcheck.record.integrity import repair as repaired
    from hypcheck.record.reader import file_of

    condition = repaired(file_of(record), out)
    beside = str(out) == STREAM
    click.echo(f"{escaped(out)}: {_kept(condition)}; {_ending(condition)}", err=beside)
    if condition.why:
        click.echo(f"lost: {escaped(condition.why)}", err=beside)


def _kept(condition: FileCondition) -> str:
    """Return the words about the good lines of a record."""
    return f"{counted(condition.lines, 'good line')}, {counted(condition.size, 'byte')}"


def _ending(condition: FileCondition) -> str:
    """Return the words about how a record ends: complete, cut off, or damaged."""
    if condition.complete and not condition.lost_bytes:
        return f"it is complete, of a run that ended with {escaped(condition.exit_code, 40)}"
    if not condition.lost_bytes:
        return "it has no footer, so it is cut off, or its run was interrupted"
    verb = "is" if condition.lost_bytes == 1 else "are"
    lost = f"{counted(condition.lost_bytes, 'byte')} ({counted(condition.lost_lines, 'line')})"
    return f"{lost} from byte {condition.size} on {verb} lost"
