"""The formats of reports: the file of each, and when it is written. Loads nothing heavy; write.py makes the reports."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class ReportFormat:
    """One format of a report.

    file: the name of its file. shows: the type of lines that it shows; if the record has no such line, no file is
    written or expected. sweeps: whether it shows wrong answers about sweeps; if there are none, no file is written or
    expected. compares: whether it shows changes against another record. kept: whether every run writes it; other
    formats are made on demand. by_suffix: whether any file name with its suffix selects it; else only its own name
    does.
    """

    file: str
    shows: str | None = None
    sweeps: bool = False
    compares: bool = False
    kept: bool = True
    by_suffix: bool = True


REPORTS = {
    "terminal": ReportFormat("report.txt", compares=True, kept=False),
    "json": ReportFormat("summary.json"),
    "junit": ReportFormat("junit.xml"),
    "sarif": ReportFormat("results.sarif"),
    "gitlab": ReportFormat("gl-code-quality-report.json", by_suffix=False),
    "badge": ReportFormat("badge.json", by_suffix=False),
    "csv": ReportFormat("measurements.csv"),
    "map": ReportFormat("map.svg", shows="map"),
    "ways": ReportFormat("ways.svg", sweeps=True),
    "errors": ReportFormat("errors.svg", shows="accuracy"),
    "pareto": ReportFormat("pareto.svg", shows="speed"),
    "front": ReportFormat("front.svg", shows="speed"),
    "markdown": ReportFormat("report.md", compares=True),  # after the pictures, to which it refers
    "overview": ReportFormat("overview.md", kept=False),
    "html": ReportFormat("report.html", compares=True),
}
"""Every format by its name, in the order in which they are written."""


def kept_formats() -> list[str]:
    """Return the names of the formats that every run writes."""
    return [name for name, report in REPORTS.items() if report.kept]


@dataclass(frozen=True, slots=True)
class WrittenReport:
    """The path of a report, and the reason if it was not written."""

    path: Path
    skipped: str | None = None
