"""Reports of a record and results of a simulation, made and written: each beside its place, then into it.

jinja2 and matplotlib, which are extras, are loaded for the reports that need them.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from types import ModuleType
from typing import Any

from hypcheck.errors import InputError, UnavailableError, system_reason
from hypcheck.kernel.classify import kernel
from hypcheck.messages import escaped
from hypcheck.record import Record
from hypcheck.report import csv, junit, markdown, summary, terminal
from hypcheck.report.code_hosts import render_badge, render_gitlab, render_sarif
from hypcheck.report.drawings import ALONE, ReportContext, draw_ahead, pictures, render_picture
from hypcheck.report.formats import REPORTS, ReportFormat, WrittenReport, kept_formats
from hypcheck.report.model import drawn_way, implementations
from hypcheck.tables.streams import remove_file, writing

FOR_PROGRAMS: Mapping[str, Callable[[Record], bytes]] = {
    "json": summary.render,
    "junit": junit.render,
    "sarif": render_sarif,
    "gitlab": render_gitlab,
    "badge": render_badge,
    "csv": csv.render,
}
"""What programs read: made of the record alone, whatever other reports there are."""

AS_TEXT: Mapping[str, Callable[[Record, ReportContext], bytes]] = {
    "terminal": terminal.render,
    "markdown": markdown.render,
    "overview": markdown.render_overview,
}
"""What people read as text."""


def _html() -> ModuleType:
    """The module that makes the page. Raises UnavailableError if jinja2, which is an extra, is missing."""
    try:
        import jinja2  # noqa: F401, PLC0415

        from hypcheck.report import html  # noqa: PLC0415
    except ImportError as error:
        reason = f"jinja2 cannot be imported ({escaped(error)}); pip install 'hypcheck[report]' brings it"
        raise UnavailableError(reason) from None
    return html


def render(name: str, record: Record, context: ReportContext = ALONE) -> bytes:
    """The report of that format. Raises UnavailableError if it cannot be made here."""
    if name in FOR_PROGRAMS:
        return FOR_PROGRAMS[name](record)
    if name in AS_TEXT:
        return AS_TEXT[name](record, context)
    if name == "html":
        return bytes(_html().render(record, context))
    return render_picture(name, record, context.drawings)


def import_all() -> None:
    """Import what makes reports, and the kernel that explains answers, which nothing reads after foreign code has run.

    Raises InputError where the environment asks for a kernel that is not there.
    """
    kernel()
    for load in (pictures, _html):
        with suppress(UnavailableError):
            load()


def files_of(record: Record) -> list[str]:
    """The names of the reports that a run with this record writes, if all of them can be made."""
    every = [REPORTS[name] for name in kept_formats()]
    return [each.file for each in every if _has_content(each, record)]


def _has_content(report: ReportFormat, record: Record) -> bool:
    if report.ways:
        return any(drawn_way(each) is not None for each in implementations(record))
    return report.shows is None or any(line.type == report.shows for line in record.lines)


def remove_reports(directory: Path) -> None:
    """Remove the reports of an earlier run, which do not show the run that begins. Raises InputError."""
    for name in kept_formats():
        remove_file(directory / REPORTS[name].file)


def write_reports(
    record: Record, directory: Path, formats: Sequence[str] | None = None, against: Record | None = None
) -> list[WrittenReport]:
    """Write reports of the formats (by default those that every run writes) into a directory, which is made if needed.

    A format that cannot be made here is skipped, and its file of an earlier run removed, since it shows another run.
    Raises InputError if a file cannot be written; an earlier file then stays.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"cannot make the folder {directory}: {system_reason(error)}") from error
    done: list[WrittenReport] = []
    wanted = [name for name in REPORTS if name in (kept_formats() if formats is None else formats)]
    drawings = draw_ahead(record) if "html" in wanted else {}
    for name in wanted:
        report = REPORTS[name]
        if not _has_content(report, record):
            remove_file(directory / report.file)
            continue
        beside = {each.path.name for each in done if each.skipped is None}
        done.append(_write(name, record, directory / report.file, ReportContext(beside, against, drawings)))
    return done


def _write(name: str, record: Record, path: Path, context: ReportContext) -> WrittenReport:
    try:
        content = render(name, record, context)
    except UnavailableError as error:
        remove_file(path)
        return WrittenReport(path, str(error))
    _write_file(path, content)
    return WrittenReport(path)


def _write_file(path: Path, content: bytes) -> None:
    with writing(str(path), follow=False) as file:
        file.write(content)


PICTURES = {
    "forest": ("forest-walk", "forest-space"),
    "tower": ("tower-flights", "tower-table-5", "tower-pitch"),
}
"""The names of all pictures that a simulation may have, by its name."""


def make_ready(kind: str, directory: Path) -> None:
    """Make the folder. Raises InputError if a file of the simulation could not be written there.

    So no long run starts whose result would be lost.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=directory):
            pass
    except OSError as error:
        reason = system_reason(error)
        raise InputError(f"--out {directory}: files cannot be written to it: {reason}") from error
    for name in (_json(kind), *map(_svg, PICTURES[kind])):
        if (directory / name).is_dir():
            raise InputError(f"--out {directory}: {name} cannot be written: it is a folder")


def write_simulation(result: dict[str, Any], directory: Path) -> list[str]:
    """Write the files into a folder; returns a line for each, and one with the reason if there are no pictures.

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
    for name in PICTURES[kind]:
        if name not in drawn:
            remove_file(directory / _svg(name))
    for name, content in files.items():
        _write_file(directory / name, content)
    return [f"wrote {directory / name}" for name in files] + notes


def _json(kind: str) -> str:
    return f"simulate-{kind}.json"


def _svg(name: str) -> str:
    return f"{name}.svg"
