"""The reports of a record, by name, and how they are written: each beside its place, then into it."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass
from pathlib import Path

from hypcheck.errors import InputError, UnavailableError
from hypcheck.record import Record
from hypcheck.report import junit, markdown, picture, summary
from hypcheck.tables.streams import writing


@dataclass(frozen=True, slots=True)
class Report:
    """One format: its file's name, and its bytes from the record and the names of the files written before it.

    `shows` is the kind of line without which there is nothing to show, so that no file is written and none is missed.
    """

    file: str
    render: Callable[[Record, Collection[str]], bytes]
    shows: str | None = None


REPORTS = {
    "summary": Report("summary.json", lambda record, _: summary.render(record)),
    "junit": Report("junit.xml", lambda record, _: junit.render(record)),
    "picture": Report("map.svg", lambda record, _: picture.render(record), shows="map"),
    "markdown": Report("report.md", markdown.render),  # after the picture, to which it refers
}
"""Every format by its name, in the order in which they are written."""


@dataclass(frozen=True, slots=True)
class Written:
    """A report's path, and the reason where it was not written."""

    path: Path
    skipped: str | None = None


def write_reports(record: Record, directory: Path) -> list[Written]:
    """Every report into a directory, which is made where it is not there.

    A format that cannot be made here is skipped, and its file of an earlier run removed: it would show another run.
    Raises InputError where a file cannot be written; what stood in its place then still does.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"cannot make the folder {directory}: {(error.strerror or str(error)).lower()}") from error
    done: list[Written] = []
    for report in REPORTS.values():
        if report.shows and not record.of(report.shows):
            _remove(directory / report.file)
            continue
        beside = {each.path.name for each in done if each.skipped is None}
        done.append(_write(report, record, directory / report.file, beside))
    return done


def _write(report: Report, record: Record, path: Path, beside: Collection[str]) -> Written:
    try:
        content = report.render(record, beside)
    except UnavailableError as error:
        _remove(path)
        return Written(path, str(error))
    with writing(str(path)) as file:
        file.write(content)
    return Written(path)


def _remove(path: Path) -> None:
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        raise InputError(f"cannot remove {path}: {(error.strerror or str(error)).lower()}") from error
