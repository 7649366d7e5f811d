"""The output of a command during long work: a progress bar, the record, and reports at the end.

A bar has the rate and the time left on a terminal; in a pipe there is none. If the terminal is closed, the work goes on
without a bar. A run with a record has stages under a bar. An interrupted run leaves a record that `--resume` continues;
if that record is finished, nothing is left to do.
"""

from __future__ import annotations

import io
import os
import shlex
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from itertools import repeat
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO, cast

import click

from hypcheck.errors import Exit, HypcheckError, InputError, system_reason
from hypcheck.messages import escaped, printable
from hypcheck.tables.streams import made_folder, same_file

if TYPE_CHECKING:
    from click._termui_impl import ProgressBar

    from hypcheck.processes import Stage
    from hypcheck.record import Record, Recorder, RecordLine
    from hypcheck.record.writer import Provenance
    from hypcheck.report import WrittenReport
    from hypcheck.runs.plan import ConformancePlan
    from hypcheck.runs.resume import ResumedRun


class DetachableTerminal(io.TextIOBase):
    """Writes to a terminal; once that is closed, writes are dropped and raise no error."""

    def __init__(self, terminal: TextIO) -> None:
        super().__init__()
        self._terminal = terminal

    def isatty(self) -> bool:
        """Return whether the stream is a terminal."""
        return self._terminal.isatty()

    def write(self, text: str) -> int:
        """Write the text, or drop it if the terminal is closed."""
        try:
            return self._terminal.write(text)
        except OSError:
            self._escape()
            return len(text)

    def flush(self) -> None:
        """Write buffered output, or drop it if the terminal is closed."""
        try:
            self._terminal.flush()
        except OSError:
            self._escape()

    def _escape(self) -> None:
        """Send buffered output to the null device, because Python would try to write it again at its end."""
        with suppress(OSError):
            null = os.open(os.devnull, os.O_WRONLY)
            os.dup2(null, self._terminal.fileno())
            os.close(null)


_UPDATE_SECONDS, _FIRST_RATE_SECONDS = 0.1, 1.0
"""Seconds between two updates of a bar, and seconds until it shows a rate."""


def is_terminal(stream: TextIO | None) -> bool:
    """Return whether a stream is a terminal; a stream whose descriptor was closed is None."""
    return stream is not None and stream.isatty()


def in_colour() -> bool:
    """Return whether standard output is a terminal with colours that are not switched off (https://no-color.org)."""
    return is_terminal(sys.stdout) and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"


def summary_options() -> dict[str, Any]:
    """Return arguments for summary_lines: on a terminal, lines are cut to its width and coloured; in a pipe neither."""
    from hypcheck.report.terminal import WIDTH

    return {"colour": in_colour(), "width": WIDTH if is_terminal(sys.stdout) else None}


@contextmanager
def watched(length: int | None, label: str, unit: str = "", done: int = 0) -> Iterator[ShownPace]:
    """Show a bar of `length` steps (None if unknown), `done` of them done before; `unit` is what a rate counts."""
    if length == 0 or not is_terminal(sys.stderr):
        yield ShownPace(None, unit)
        return
    with click.progressbar(
        map(str, repeat("")) if length is None else None,  # click asks it for a length, and it has none
        length=length,
        label=label,
        file=cast("TextIO", DetachableTerminal(sys.stderr)),
        show_eta=False,
        item_show_func=lambda text: text,
    ) as bar:
        bar.update(done)
        yield ShownPace(bar, unit)


class ShownPace:
    """Updates a bar ten times a second, and shows the rate beside it, and the time left at that rate.

    Without a bar nothing is shown.
    """

    def __init__(self, bar: ProgressBar[Any] | None, unit: str) -> None:
        self._bar = bar
        self.unit = unit
        self._begun = self._shown = time.monotonic()
        self._steps = self._units = self._waiting = 0

    def name(self, label: str, unit: str) -> None:
        """Begin another stage of the progress line, with its label and the unit that it counts."""
        self.unit = unit
        if self._bar is not None:
            self._bar.label = label

    def expect(self, more: int) -> None:
        """Make the bar longer by this number of steps, or shorter if it is negative."""
        if self._bar is not None and self._bar.length is not None:
            self._bar.length += more

    def advance(self, steps: int, units: int | None = None) -> None:
        """Take note of steps that are done, and of how many `units`, if a step is not one unit."""
        if self._bar is None:
            return
        self._waiting += steps
        self._units += steps if units is None else units
        now, length = time.monotonic(), self._bar.length
        last = length is not None and self._bar.pos + self._waiting >= length
        if now < self._shown + _UPDATE_SECONDS and not last:
            return
        self._shown = now
        self._steps += self._waiting
        elapsed, waiting, self._waiting = now - self._begun, self._waiting, 0
        if elapsed < _FIRST_RATE_SECONDS and not last:
            self._bar.update(waiting)
            return
        text = [f"{_per_second(self._units / max(elapsed, 1e-9))} {self.unit} a second"] if self.unit else []
        if length is not None and not last and self._steps:
            left = length - self._bar.pos - waiting
            text.append(f"{_clock(left * elapsed / self._steps)} left")
        self._bar.update(waiting, ", ".join(text))


def _per_second(rate: float) -> str:
    """Return a rate as text."""
    return f"{rate / 1e6:.1f} million" if rate >= 1e6 else f"{rate:,.0f}"


def _clock(seconds: float) -> str:
    """Return a time as hours:minutes:seconds."""
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes // 60}:{minutes % 60:02}:{rest:02}"


@dataclass
class Recording:
    """A run with a record.

    recorder: takes the lines of the run.
    exit_code: the exit code of the run, which the run sets.
    record: the complete record, once the run has ended.
    """

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
    """Write the record of a run to `out` while the block lasts; then write the reports, and print the summary.

    When the run begins, its `title` and how implementations are isolated are printed. Its first result
    removes reports of an earlier run, whose record stays until the new one is complete. A run that ends without any
    result leaves an earlier run as it was. An interrupted run leaves a truncated record with reports. `carried` are
    lines of the run that this one resumes; its record may be the one in `out`. Raises InputError if `out` cannot be
    written, or another run is writing there.
    """
    from hypcheck.record import Recorder
    from hypcheck.record.reader import FILE, GROWING
    from hypcheck.record.writer import GrowingFile, folder_locked
    from hypcheck.report.write import holds_run, remove_reports, require_writable

    growing = out / GROWING
    with ExitStack() as stack:
        try:
            stack.enter_context(made_folder(out))
            require_writable(out)
            stack.enter_context(folder_locked(out))
        except OSError as error:
            raise InputError(f"--out {out} cannot be written: {system_reason(error)}") from None
        file = stack.enter_context(GrowingFile(growing))
        recorder = Recorder(file, options, provenance, carried, begins=lambda: remove_reports(out))
        running = Recording(recorder)
        try:
            _print_beginning(title, provenance)
            yield running
            running.record = recorder.close(running.exit_code)
        except BaseException as error:
            if isinstance(error, OSError):
                _require_folder(out, error)
            _ended_early(growing, recorder)
            if isinstance(error, OSError) and error.filename == str(growing):
                raise InputError(f"cannot write {growing}: {system_reason(error)}") from error
            raise
        if not recorder.has_results and holds_run(out):
            _print_summary(running.record, _summary(running.record))
            _print_note(f"nothing was judged; the earlier run in {escaped(out)} stays as it was")
            return
        _settle(recorder, growing, out / FILE)
        try:
            report(running.record, out)
        except BaseException:
            place = shlex.quote(str(out))
            then = f"hypcheck report {place} --out {place} makes its reports"
            _print_note(f"the record in {escaped(out / FILE)} is complete; {then}")
            raise


def _print_beginning(title: str, provenance: Provenance | None) -> None:
    """Print the title of a run and the isolation of its implementations; the summary prints the settings."""
    if provenance is not None and provenance.isolation is not None:
        from hypcheck.isolation.launch import isolation_text

        title += f"; {isolation_text(provenance.isolation.means, provenance.isolation.missing)}"
    if title:
        _print_note(title)


def run_stages(stages: Sequence[Stage]) -> None:
    """Run the stages one after the other, under a progress bar."""
    with watched(sum(stage.steps for stage in stages), "") as pace:
        for stage in stages:
            pace.name(label(stage.title), "")
            stage.run(pace.advance)


def label(title: str) -> str:
    """Return the title of a stage as the bar shows it: all titles have the same width."""
    return f"{title:28}"


def _require_folder(out: Path, error: OSError) -> None:
    """Raise InputError if the folder that a run writes to has gone, and `error` came of that."""
    if not out.is_dir():
        raise InputError(f"--out {out} is not a folder any more; it was replaced or removed during the run") from error


def _settle(recorder: Recorder, growing: Path, path: Path) -> None:
    """Move the complete record to its place. Raises InputError if that fails; the record is then still in `growing`."""
    try:
        recorder.settle(path)
    except OSError as error:
        _require_folder(path.parent, error)
        reason = system_reason(error)
        raise InputError(f"cannot write {path}: {reason}; the finished part is in {growing}") from error


def _ended_early(growing: Path, recorder: Recorder) -> None:
    """Keep the finished part with reports, and print its place; a run without a result leaves nothing."""
    from hypcheck.record import read
    from hypcheck.record.reader import FILE
    from hypcheck.report.write import write_reports

    if not recorder.begun:
        return
    out, path = growing.parent, growing.with_name(FILE)
    _settle(recorder, growing, path)
    then = f"with --resume {shlex.quote(str(out))} continues" if recorder.goes_on else "starts again"
    try:
        with suppress(HypcheckError, OSError):
            record = read(path)
            write_reports(record, out)
            _print_summary(record, [])
    finally:  # after a second interrupt too
        _print_note(f"the finished part is in {escaped(path)}; the same command {then}")


def _print_note(sentence: str) -> None:
    """Print a sentence to standard error, if that is still open."""
    with suppress(OSError):
        click.echo(f"hypcheck: {escaped(sentence)}", err=True)


def report(record: Record, out: Path) -> None:
    """Write the reports of a finished record, and print the summary."""
    from hypcheck.report.write import write_reports

    _print_summary(record, _summary(record, write_reports(record, out)))


def _summary(record: Record, written: Sequence[WrittenReport] = ()) -> Sequence[str]:
    """Return the lines of the summary of a record."""
    from hypcheck.report.terminal import summary_lines

    return list(summary_lines(record, written, **summary_options()))


def _print_summary(record: Record, lines: Sequence[str]) -> None:
    """Print the summary; on GitHub also annotations, and the report in the summary of the step."""
    from hypcheck.report import code_hosts

    if not code_hosts.on_github(os.environ):
        for line in lines:
            click.echo(line)
        return
    for line in [*code_hosts.harmless(lines), *code_hosts.error_lines(record)]:
        click.echo(line)
    summary = os.environ.get("GITHUB_STEP_SUMMARY")
    fault = code_hosts.append_summary(record, Path(summary)) if summary else None
    if fault:
        click.echo(f"hypcheck: {printable(fault)}", err=True)


def resumed(
    path: Path, out: Path, plan: ConformancePlan, options: Mapping[str, Any], files: Mapping[str, str], cases: int
) -> ResumedRun | int:
    """Return the finished part of an interrupted run; for a finished run, write its reports and return its exit code.

    `path` is a record, or the folder of a run. Raises InputError if the record cannot be read, is being written, or is
    of another run, naming what differs.
    """
    from hypcheck.record.reader import GROWING, interrupted_in, read
    from hypcheck.record.writer import folder_locked
    from hypcheck.runs.resume import require_same_run, resume

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
    """Make the reports of a finished record in `out`, if its run was interrupted before they were written."""
    from hypcheck.record.reader import FILE, GROWING, read
    from hypcheck.report.write import files_of

    path = out / FILE
    if same_file(str(file), str(out / GROWING)):
        file.replace(path)
    elif not same_file(str(file), str(path)) or _has_newer_reports(out, files_of(record), path):
        return
    report(read(path), out)


def _has_newer_reports(out: Path, names: Sequence[str], record: Path) -> bool:
    """Return whether all of these reports were written after the record."""
    written = record.stat().st_mtime_ns
    return all((out / name).is_file() and (out / name).stat().st_mtime_ns >= written for name in names)
