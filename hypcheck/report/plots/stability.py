"""At which sizes each method of a benchmark errs, for each precision: α/b across, γ/d up, in half decades."""

from __future__ import annotations

from collections.abc import Iterator

from hypcheck.record import Record
from hypcheck.report.plots import heat
from hypcheck.report.plots.svg import Plot

PLANE = heat.Plane("α/b", "γ/d", 0.5)


def plots(record: Record) -> Iterator[Plot]:
    """A small plot for each method and precision of the record."""
    maps = {_title(line["method"], line["precision"]): heat.cells(line["bins"]) for line in record.of("stability")}
    yield from heat.plots("stability", PLANE, maps)


def _title(method: str, precision: str) -> str:
    return method if method.endswith(precision) else f"{method}, {precision}"
