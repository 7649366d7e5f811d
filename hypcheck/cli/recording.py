"""Running stages under a progress bar, with a record that keeps what was finished, and reports at the end."""

from __future__ import annotations

import os
import shlex
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from hypcheck.cli.progress import in_lines, watched
from hypcheck.cli.settings import announce
from hypcheck.errors import HypcheckError, InputError, NothingJudgedError, system_reason
from hypcheck.visible import printable, visible

if TYPE_CHECKING:
    from hypcheck.record import Line, Record, Recorder


class Part(NamedTuple):
    """A part of a run: its title for the progress bar, how many steps it has, and what does them.

    `unit` is what its steps are, where many of them pass in a second. Of a run that is gone on with, some are `done`.
    """

    title: str
    steps: int
    run: Callable[[Callable[[int], object]], None]
    unit: str = ""
    done: int = 0


def record_and_report(
    out: Path,
    options: Mapping[str, Any],
    parts: Callable[[Recorder], Sequence[Part]],
    exit_code: Callable[[], int],
    title: str = "",
    optional: Mapping[str, Any] | None = None,
    carried: Sequence[Line] = (),
) -> Record:
    """Run the parts, keep their record in `out` with reports beside it, and print the summary.

    An interrupted run leaves what it finished, reported as truncated, on GitHub too. `optional` are the fields of the
    header that not every run has, of which None is left out. When the run begins, its `title` is told, if it has one,
    and its settings; reports of an earlier run are removed, and its record stays until the new one takes its place.
    `carried` are lines of a run that is gone on with, whose record may be the one in `out`. Raises InputError where
    `out` cannot be written, or another run is writing there.
    """
    from hypcheck.record import Recorder
    from hypcheck.record.growing import Growing
    from hypcheck.record.owning import owning
    from hypcheck.record.reader import FILE, GROWING
    from hypcheck.report.write import remove_reports

    growing = out / GROWING
    known = {name: value for name, value in (optional or {}).items() if value is not None}
    with ExitStack() as stack:
        try:
            out.mkdir(parents=True, exist_ok=True)
            _require_no_folder(out / FILE, growing)
            stack.enter_context(owning(out))
            recorder = Recorder(stack.enter_context(Growing(growing)), options, known, carried)
        except OSError as error:
            raise InputError(f"--out {out} cannot be written: {system_reason(error)}") from None
        try:
            remove_reports(out)
            todo = parts(recorder)
            if title:
                _say(title)
            announce(known.get("settings"))
            _run(todo)
            record = recorder.close(exit_code())
        except BaseException as error:
            if isinstance(error, OSError):
                _require_folder(out, error)
            _ended_early(error, growing, recorder)
            raise
        _settle(recorder, growing, out / FILE)
        try:
            report(record, out)
        except BaseException:
            place = shlex.quote(str(out))
            _say(
                f"the record in {visible(out / FILE)} is whole; hypcheck report {place} --out {place} makes its reports"
            )
            raise
    return record


def _require_no_folder(*files: Path) -> None:
    for file in files:
        if file.is_dir():
            raise InputError(f"--out {file.parent} cannot be written: {file.name} in it is a folder")


def _require_folder(out: Path, error: OSError) -> None:
    """Raise InputError where a run that an error of the system ended has lost the folder that it writes to."""
    if not out.is_dir():
        raise InputError(f"--out {out} is no folder any more: it was replaced or removed during the run") from error


def _settle(recorder: Recorder, growing: Path, path: Path) -> None:
    """Raises InputError where the record cannot take its place; it is then where it grew."""
    try:
        recorder.settle(path)
    except OSError as error:
        _require_folder(path.parent, error)
        reason = system_reason(error)
        raise InputError(f"cannot write {path}: {reason}; what was finished is in {growing}") from error


def _ended_early(error: BaseException, growing: Path, recorder: Recorder) -> None:
    """Keep what was finished, make reports of it, and tell where it is; of a run that proves nothing, leave nothing."""
    from hypcheck.record import read
    from hypcheck.record.reader import FILE
    from hypcheck.report.write import write_reports

    if isinstance(error, NothingJudgedError) or (isinstance(error, HypcheckError) and not recorder.goes_on):
        growing.unlink(missing_ok=True)
        return
    out, path = growing.parent, growing.with_name(FILE)
    _settle(recorder, growing, path)
    then = f"with --resume {shlex.quote(str(out))} goes on" if recorder.goes_on else "begins anew"
    try:
        with suppress(HypcheckError, OSError):
            record = read(path)
            write_reports(record, out)
            _tell(record, [])
    finally:  # who interrupts twice is told too
        _say(f"what was finished is in {visible(path)}; the same command {then}")


def _say(sentence: str) -> None:
    """Tell whoever watches, if anybody still does."""
    with suppress(OSError):
        click.echo(f"hypcheck: {visible(sentence)}", err=True)


def report(record: Record, out: Path) -> None:
    """Write the reports of a finished record, and print the summary."""
    from hypcheck.report.terminal import summary_lines
    from hypcheck.report.write import write_reports

    _tell(record, summary_lines(record, write_reports(record, out), **in_lines()))


def _tell(record: Record, lines: Sequence[str]) -> None:
    """Print the summary; on GitHub, with annotations after it and the report in the step's summary."""
    from hypcheck.report import github

    if not github.on_github(os.environ):
        for line in lines:
            click.echo(line)
        return
    for line in [*github.harmless(lines), *github.error_lines(record)]:
        click.echo(line)
    summary = os.environ.get("GITHUB_STEP_SUMMARY")
    trouble = github.append_summary(record, Path(summary)) if summary else None
    if trouble:
        click.echo(f"hypcheck: {printable(trouble)}", err=True)


def _run(parts: Sequence[Part]) -> None:
    """Every part in turn, under a progress bar where a person is watching."""
    with watched(sum(part.steps for part in parts), "", done=sum(part.done for part in parts)) as pace:
        for part in parts:
            pace.name(f"{part.title:28}", part.unit)
            part.run(pace.advance)
