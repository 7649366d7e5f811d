"""Write reports of a record and results of a simulation: all to temporary files first, then to their places.

jinja2 and matplotlib, which are extras, are loaded for the reports that need them.
"""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from types import ModuleType
from typing import Any

from hypcheck.errors import InputError, UnavailableError, system_reason
from hypcheck.kernel.in_use import kernel
from hypcheck.record import Record
from hypcheck.record.reader import FILE, GROWING
from hypcheck.report import REPORTS, ReportFormat, WrittenReport, csv, junit, kept_formats, markdown, summary, terminal
from hypcheck.report.code_hosts import render_badge, render_gitlab, render_sarif
from hypcheck.report.drawings import ALONE, ReportContext, draw_ahead, drawn_plots, extra, pictures, render_picture
from hypcheck.report.model import drawn_sweep, implementations
from hypcheck.tables.streams import made_folder, remove_file, write_files

FOR_PROGRAMS: Mapping[str, Callable[[Record], bytes]] = {
    "json": summary.render,
    "junit": junit.render,
    "sarif": render_sarif,
    "gitlab": render_gitlab,
    "badge": render_badge,
    "csv": csv.render,
}
"""The renderers of formats that programs read; they need the record alone."""

AS_TEXT: Mapping[str, Callable[[Record, ReportContext], bytes]] = {
    "terminal": terminal.render,
    "markdown": markdown.render,
    "overview": markdown.render_overview,
}
"""The renderers of formats that people read as text."""


def _html() -> ModuleType:
    """Import the module that makes the page. Raises UnavailableError if jinja2, which is an extra, is missing."""
    with extra("jinja2"):
        import jinja2  # noqa: F401, PLC0415

        from hypcheck.report import html  # noqa: PLC0415
    return html


def render(name: str, record: Record, context: ReportContext = ALONE) -> bytes:
    """Render the report of that format. Raises UnavailableError if it cannot be made here."""
    if name in FOR_PROGRAMS:
        return FOR_PROGRAMS[name](record)
    if name in AS_TEXT:
        return AS_TEXT[name](record, context)
    if name == "html":
        return bytes(_html().render(record, context))
    return render_picture(name, record, context.drawings)


def import_all() -> None:
    """Import the modules for reports, and the kernel that explains answers: no file is read after foreign code ran.

    Raises InputError if the environment selects a kernel that is not available.
    """
    kernel()
    for load in (pictures, _html):
        with suppress(UnavailableError):
            load()


def files_of(record: Record) -> list[str]:
    """Return the names of the reports that a run with this record writes, if all of them can be made."""
    every = [REPORTS[name] for name in kept_formats()]
    return [report.file for report in every if _has_content(report, record)]


def _has_content(report: ReportFormat, record: Record) -> bool:
    """Decide whether the record has what the format shows."""
    if report.sweeps:
        return any(drawn_sweep(implementation) is not None for implementation in implementations(record))
    return report.shows is None or any(line.type == report.shows for line in record.lines)


_ON_THE_PAGE = ("ways", "errors", "pareto", "front")
"""Formats whose plots the page shows as well."""

_OF_RUNS = (FILE, GROWING, *(REPORTS[name].file for name in kept_formats()))
"""The files that every run writes."""


def require_writable(directory: Path, names: Iterable[str] = _OF_RUNS) -> None:
    """Raise InputError if a file of one of these names could not be written to the folder.

    This prevents a long run whose result would be lost.
    """
    try:
        with tempfile.TemporaryFile(dir=directory):
            pass
    except OSError as error:
        reason = system_reason(error)
        raise InputError(f"--out {directory}: files cannot be written to it: {reason}") from error
    for name in names:
        if (directory / name).is_dir():
            raise InputError(f"--out {directory} cannot be written: {name} in it is a folder")


def remove_reports(directory: Path) -> None:
    """Remove the reports of an earlier run when a new run has a result that they do not show. Raises InputError."""
    for name in kept_formats():
        remove_file(directory / REPORTS[name].file)


def holds_run(directory: Path) -> bool:
    """Decide whether the folder has a record, finished or not, or a report that every run writes."""
    return any(os.path.lexists(directory / name) for name in _OF_RUNS)


def write_reports(
    record: Record, directory: Path, formats: Sequence[str] | None = None, against: Record | None = None
) -> list[WrittenReport]:
    """Write reports of the formats (default: those that every run writes) into a directory, which is created if needed.

    Either all reports are written or none. A format that cannot be made here is skipped, and its file from an earlier
    run is removed, because it shows another run. Raises InputError if a file cannot be written; the earlier files then
    stay.
    """
    reports: list[WrittenReport] = []
    contents: dict[str, bytes] = {}
    wanted = [name for name in REPORTS if name in (kept_formats() if formats is None else formats)]
    drawings = dict(draw_ahead(record)) if "html" in wanted else {}
    for name in wanted:
        path = directory / REPORTS[name].file
        if not _has_content(REPORTS[name], record):
            continue
        try:
            if name in _ON_THE_PAGE:  # which is written later
                drawings[name] = drawn_plots(name, record, drawings)
            contents[str(path)] = render(
                name, record, ReportContext([*map(os.path.basename, contents)], against, drawings)
            )
            reports.append(WrittenReport(path))
        except UnavailableError as error:
            reports.append(WrittenReport(path, str(error)))
    with made_folder(directory):
        write_files(contents, follow=False)
    for path in (directory / REPORTS[name].file for name in wanted):
        if str(path) not in contents:
            remove_file(path)
    return reports


PICTURES = {
    "forest": ("forest-walk", "forest-space"),
    "tower": ("tower-flights", "tower-table-5", "tower-pitch"),
}
"""The names of all pictures that a simulation may have, by the name of the simulation."""


@contextmanager
def ready_for(kind: str, directory: Path) -> Iterator[None]:
    """Make the folder exist within the block; if the block fails, a folder that was created is removed.

    Raises InputError if a file of the simulation could not be written there.
    """
    with made_folder(directory):
        require_writable(directory, (_json(kind), *map(_svg, PICTURES[kind])))
        yield


def write_simulation(result: dict[str, Any], directory: Path) -> list[str]:
    """Write the files into a folder; return a line for each, and one with the reason if there are no pictures.

    Pictures of an earlier run that are not drawn again are removed, since they show another run. Raises InputError if a
    file cannot be written; an earlier file then stays.
    """
    kind, notes = result["simulation"], []
    try:
        drawn: dict[str, bytes] = pictures().simulation_pictures(result)
    except UnavailableError as error:
        drawn = {}
        notes.append(f"no pictures: {error}")
    text = json.dumps(result, ensure_ascii=False) + "\n"
    files = {_json(kind): text.encode(), **{_svg(name): content for name, content in drawn.items()}}
    write_files({str(directory / name): content for name, content in files.items()}, follow=False)
    for name in PICTURES[kind]:
        if name not in drawn:
            remove_file(directory / _svg(name))
    return [f"wrote {directory / name}" for name in files] + notes


def _json(kind: str) -> str:
    """Return the name of the file with the numbers of a simulation of this kind."""
    return f"simulate-{kind}.json"


def _svg(name: str) -> str:
    """Return the name of the file of a picture."""
    return f"{name}.svg"
