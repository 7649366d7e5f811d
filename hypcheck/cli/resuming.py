"""`--resume`: what the record of an interrupted run has to go on with, or that there is nothing left to do."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hypcheck.cli.recording import report
from hypcheck.errors import InputError
from hypcheck.tables.route import STREAM
from hypcheck.tables.streams import same_file
from hypcheck.visible import visible

if TYPE_CHECKING:
    from hypcheck.gate.plan import GatePlan
    from hypcheck.gate.resume import Resumed
    from hypcheck.record import Record


def folder_of(path: Path) -> Path:
    """Where a run goes on whose record or folder this is."""
    return path if path.is_dir() else path.parent


def resumed(
    path: Path, out: Path, plan: GatePlan, options: Mapping[str, Any], files: Mapping[str, str], cases: int
) -> Resumed | int:
    """What the plan's run goes on with; of a finished run the code it ended with, which is told. Nothing is changed.

    `path` is a record, or the folder of a run. Raises InputError where the record cannot be read, is being written, or
    is not one of just this run, saying what differs.
    """
    from hypcheck.gate.resume import require_same_run, resume
    from hypcheck.record.owning import owning
    from hypcheck.record.reader import GROWING, interrupted_in, read

    if str(path) == STREAM:
        raise InputError(f"--resume {STREAM} is no file; name a record, or the folder of a run")
    file = interrupted_in(path)
    if file.name == GROWING:
        with owning(file.parent):
            record = read(file)
    else:
        record = read(file)
    require_same_run(record, file, plan, options, files)
    if record.footer is None:
        return resume(record, file, plan, cases)
    code = record.footer.exit_code
    click.echo(f"{visible(file)} is the record of a finished run, which ended with {code}")
    _make_reports(record, file, out)
    return code


def _make_reports(record: Record, file: Path, out: Path) -> None:
    """Make the reports of a finished record in `out` that its run had no time, or no room, for."""
    from hypcheck.record.reader import FILE, GROWING, read
    from hypcheck.report.write import files_of

    path = out / FILE
    if same_file(str(file), str(out / GROWING)):
        file.replace(path)
    elif not same_file(str(file), str(path)) or all(map(_is_behind(path), (out / name for name in files_of(record)))):
        return
    report(read(path), out)


def _is_behind(record: Path) -> Callable[[Path], bool]:
    """Whether a report was written after the record."""
    return lambda file: file.is_file() and file.stat().st_mtime_ns >= record.stat().st_mtime_ns
