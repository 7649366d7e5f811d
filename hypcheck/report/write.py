"""The reports of a record, by name, and how they are written: each beside its place, then into it.

A format's module is imported when a report of it is made.
"""

from __future__ import annotations

import pkgutil
from collections.abc import Collection, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from hypcheck.errors import InputError, UnavailableError, system_reason
from hypcheck.tables.streams import writing

if TYPE_CHECKING:
    from hypcheck.record import Record
    from hypcheck.report.plots.pictures import Drawings


@dataclass(frozen=True, slots=True)
class ReportContext:
    """What a report is made with beside its record: the names of the files that stand beside it, and another record.

    The other is what the report says the changes against; formats for programs leave it aside. `drawings` are plots
    that were drawn already.
    """

    beside: Collection[str] = ()
    against: Record | None = None
    drawings: Drawings = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class ReportFormat:
    """One format: its file's name, and the `module` (or module:function) whose `render` makes its bytes from a record.

    `shows` is the kind of line without which there is nothing to show, so that no file is written and none is missed;
    `compares` says whether it shows changes against another record; one that is not `kept` is made on demand alone.
    """

    file: str
    module: str
    shows: str | None = None
    compares: bool = False
    kept: bool = True

    def render(self, record: Record, around: ReportContext | None = None) -> bytes:
        """The report. Raises UnavailableError where it cannot be made here."""
        module, _, function = self.module.partition(":")
        make = getattr(import_module(f"hypcheck.report.{module}"), function or "render")
        return bytes(make(record, around or ReportContext()))


REPORTS = {
    "terminal": ReportFormat("report.txt", "terminal", compares=True, kept=False),
    "json": ReportFormat("summary.json", "summary"),
    "junit": ReportFormat("junit.xml", "junit"),
    "csv": ReportFormat("measurements.csv", "csv"),
    "map": ReportFormat("map.svg", "plots.pictures:render_map", shows="map"),
    "errors": ReportFormat("errors.svg", "plots.pictures:render_errors", shows="accuracy"),
    "pareto": ReportFormat("pareto.svg", "plots.pictures:render_pareto", shows="speed"),
    "front": ReportFormat("front.svg", "plots.pictures:render_front", shows="speed"),
    "markdown": ReportFormat("report.md", "markdown", compares=True),  # after the pictures, to which it refers
    "overview": ReportFormat("overview.md", "markdown:render_overview", kept=False),
    "html": ReportFormat("report.html", "html", compares=True),
}
"""Every format by its name, in the order in which they are written."""


@dataclass(frozen=True, slots=True)
class WrittenReport:
    """A report's path, and the reason where it was not written."""

    path: Path
    skipped: str | None = None


def import_all() -> None:
    """Import every module that makes a report, so that none is read from the disk after foreign code has run."""
    package = import_module("hypcheck.report")
    for each in pkgutil.walk_packages(package.__path__, "hypcheck.report."):
        with suppress(ImportError):  # of an extra that is not installed
            import_module(each.name)


def kept_formats() -> list[str]:
    """The formats that every run writes."""
    return [name for name, report in REPORTS.items() if report.kept]


def files_of(record: Record) -> list[str]:
    """The names of the reports that a run with this record writes, where all of them can be made."""
    every = [REPORTS[name] for name in kept_formats()]
    return [each.file for each in every if _has_content(each, record)]


def _has_content(report: ReportFormat, record: Record) -> bool:
    return report.shows is None or any(line.type == report.shows for line in record.lines)


def remove_reports(directory: Path) -> None:
    """Remove the reports that every run writes, so that none is taken for one of the run that begins.

    Raises InputError where one cannot be removed.
    """
    for name in kept_formats():
        _remove(directory / REPORTS[name].file)


def write_reports(
    record: Record, directory: Path, formats: Sequence[str] | None = None, against: Record | None = None
) -> list[WrittenReport]:
    """Reports of the formats (by default those that every run writes) into a directory, made where it is not there.

    A format that cannot be made here is skipped, and its file of an earlier run removed: it would show another run.
    Raises InputError where a file cannot be written; what stood in its place then still does.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"cannot make the folder {directory}: {system_reason(error)}") from error
    done: list[WrittenReport] = []
    wanted = [name for name in REPORTS if name in (kept_formats() if formats is None else formats)]
    drawings = _drawn_ahead(record) if "html" in wanted else {}
    for name in wanted:
        report = REPORTS[name]
        if not _has_content(report, record):
            _remove(directory / report.file)
            continue
        beside = {each.path.name for each in done if each.skipped is None}
        done.append(_write(report, record, directory / report.file, ReportContext(beside, against, drawings)))
    return done


def _drawn_ahead(record: Record) -> Drawings:
    """The plots that several reports show."""
    from hypcheck.report.plots.pictures import draw_ahead  # noqa: PLC0415

    return draw_ahead(record)


def _write(report: ReportFormat, record: Record, path: Path, around: ReportContext) -> WrittenReport:
    try:
        content = report.render(record, around)
    except UnavailableError as error:
        _remove(path)
        return WrittenReport(path, str(error))
    with writing(str(path), follow=False) as file:
        file.write(content)
    return WrittenReport(path)


def _remove(path: Path) -> None:
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        raise InputError(f"cannot remove {path}: {system_reason(error)}") from error
