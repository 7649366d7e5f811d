"""Stages run under a progress bar, with a record that `--resume` continues, and reports at the end.

Running stages under a progress bar, with a record that keeps what was finished, and reports at the end.

`--resume`: what the record of an interrupted run has to go on with, or that there is nothing left to do.
"""

from __future__ import annotations

import os
import shlex
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hypcheck.cli.progress import in_lines, watched
from hypcheck.cli.settings import announce
from hypcheck.errors import Exit, HypcheckError, InputError, NothingJudgedError, system_reason
from hypcheck.messages import escaped, printable
from hypcheck.tables.streams import STREAM, same_file

if TYPE_CHECKING:
    from hypcheck.processes import Stage
    from hypcheck.record import Record, Recorder, RecordLine
    from hypcheck.record.writer import Provenance
    from hypcheck.runs.plan import ConformancePlan
    from hypcheck.runs.resume import ResumedRun


@dataclass
class Recording:
    """A run whose record is kept: its recorder, the code that it ends with, and its record once it has ended."""

    recorder: Recorder
    exit_code: int = Exit.HELD
    record: Record | None = None


@contextmanager
def recording(
    out: Path,
    options: Mapping[str, Any],
    title: str = "",
    provenance: Provenance | None = None,
    carried: Sequence[RecordLine] = (),
) -> Iterator[Recording]:
    """Keep the record of a run in `out` while it lasts; then write the reports beside it, and print the summary.

    An interrupted run leaves what it finished, reported as truncated, on GitHub too. When the run begins, its `title`
    is told, if it has one, and its settings; reports of an earlier run are removed, and its record stays until the new
    one takes its place.
    `carried` are lines of a run that is gone on with, whose record may be the one in `out`. Raises InputError where
    `out` cannot be written, or another run is writing there.
    """
    from hypcheck.record import Recorder
    from hypcheck.record.reader import FILE, GROWING
    from hypcheck.record.writer import GrowingFile, folder_locked
    from hypcheck.report.write import remove_reports

    growing = out / GROWING
    with ExitStack() as stack:
        try:
            out.mkdir(parents=True, exist_ok=True)
            _require_no_folder(out / FILE, growing)
            stack.enter_context(folder_locked(out))
            recorder = Recorder(stack.enter_context(GrowingFile(growing)), options, provenance, carried)
        except OSError as error:
            raise InputError(f"--out {out} cannot be written: {system_reason(error)}") from None
        running = Recording(recorder)
        try:
            remove_reports(out)
            if title:
                _say(title)
            announce(None if provenance is None else provenance.settings)
            yield running
            running.record = recorder.close(running.exit_code)
        except BaseException as error:
            if isinstance(error, OSError):
                _require_folder(out, error)
            _ended_early(error, growing, recorder)
            raise
        _settle(recorder, growing, out / FILE)
        _report_whole(running.record, out)


def run_stages(stages: Sequence[Stage]) -> None:
    """Every stage in turn, under a progress bar where a person is watching."""
    with watched(sum(stage.steps for stage in stages), "") as pace:
        for stage in stages:
            pace.name(label(stage.title), "")
            stage.run(pace.advance)


def label(title: str) -> str:
    """The title of a stage, as wide as all are beside the bar."""
    return f"{title:28}"


def _report_whole(record: Record, out: Path) -> None:
    """Report, and tell where the record is should that be interrupted."""
    from hypcheck.record.reader import FILE

    try:
        report(record, out)
    except BaseException:
        place = shlex.quote(str(out))
        _say(f"the record in {escaped(out / FILE)} is whole; hypcheck report {place} --out {place} makes its reports")
        raise


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
        _say(f"what was finished is in {escaped(path)}; the same command {then}")


def _say(sentence: str) -> None:
    """Tell whoever watches, if anybody still does."""
    with suppress(OSError):
        click.echo(f"hypcheck: {escaped(sentence)}", err=True)


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


def folder_of(path: Path) -> Path:
    """Where a run goes on whose record or folder this is."""
    return path if path.is_dir() else path.parent


def resumed(
    path: Path, out: Path, plan: ConformancePlan, options: Mapping[str, Any], files: Mapping[str, str], cases: int
) -> ResumedRun | int:
    """What the plan's run goes on with; of a finished run the code it ended with, which is told. Nothing is changed.

    `path` is a record, or the folder of a run. Raises InputError where the record cannot be read, is being written, or
    is not one of just this run, saying what differs.
    """
    from hypcheck.record.reader import GROWING, interrupted_in, read
    from hypcheck.record.writer import folder_locked
    from hypcheck.runs.resume import require_same_run, resume

    if str(path) == STREAM:
        raise InputError(f"--resume {STREAM} is no file; name a record, or the folder of a run")
    file = interrupted_in(path)
    if file.name == GROWING:
        with folder_locked(file.parent):
            record = read(file)
    else:
        record = read(file)
    require_same_run(record, file, plan, options, files)
    if record.footer is None:
        return resume(record, file, plan, cases)
    code = record.footer.exit_code
    click.echo(f"{escaped(file)} is the record of a finished run, which ended with {code}")
    _make_reports(record, file, out)
    return code


def _make_reports(record: Record, file: Path, out: Path) -> None:
    """Make the reports of a finished record in `out` that its run had no time, or no room, for."""
    from hypcheck.record.reader import FILE, GROWING, read
    from hypcheck.report.write import files_of

    path = out / FILE
    if same_file(str(file), str(out / GROWING)):
        file.replace(path)
    elif not same_file(str(file), str(path)) or all(
        map(_is_newer_than(path), (out / name for name in files_of(record)))
    ):
        return
    report(read(path), out)


def _is_newer_than(record: Path) -> Callable[[Path], bool]:
    """Whether a report was written after the record."""
    return lambda file: file.is_file() and file.stat().st_mtime_ns >= record.stat().st_mtime_ns
