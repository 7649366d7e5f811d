"""Running stages under a progress bar, with a record that keeps what was finished, and reports at the end."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from hypcheck.errors import HypcheckError, InputError

if TYPE_CHECKING:
    from hypcheck.record import Record, Recorder


class Part(NamedTuple):
    """A part of a run: its title for the progress bar, how many steps it has, and what does them."""

    title: str
    steps: int
    run: Callable[[Callable[[int], object]], None]


def record_and_report(
    out: Path, options: Mapping[str, Any], parts: Callable[[Recorder], Sequence[Part]], exit_code: Callable[[], int]
) -> Record:
    """Run the parts, keep their record in `out` with reports beside it, and print the summary.

    An interrupted run leaves what it finished, reported as truncated. Raises InputError where `out` cannot be written.
    """
    from hypcheck.record import Recorder, read
    from hypcheck.report.terminal import summary_lines
    from hypcheck.report.write import write_reports

    growing, path = out / "record.jsonl.part", out / "record.jsonl"
    try:
        out.mkdir(parents=True, exist_ok=True)
        stream = growing.open("w", encoding="utf-8", errors="backslashreplace")
    except OSError as error:
        raise InputError(f"--out {out}: cannot be written: {error.strerror}") from None
    with stream:
        recorder = Recorder(stream, options)
        try:
            _run(parts(recorder))
            record = recorder.close(exit_code())
        except HypcheckError:
            growing.unlink()
            raise
        except BaseException:
            growing.replace(path)
            with suppress(HypcheckError):
                write_reports(read(path), out)
            raise
    growing.replace(path)
    _tell(record, summary_lines(record, write_reports(record, out), colour=sys.stdout.isatty()))
    return record


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
        click.echo(f"hypcheck: {trouble}", err=True)


def _run(parts: Sequence[Part]) -> None:
    """Every part in turn, under a progress bar where a person is watching."""
    if not sys.stderr.isatty():
        for part in parts:
            part.run(lambda _: None)
        return
    with click.progressbar(length=sum(part.steps for part in parts), file=sys.stderr, show_pos=False) as bar:
        for part in parts:
            bar.label = f"{part.title:28}"
            part.run(bar.update)
