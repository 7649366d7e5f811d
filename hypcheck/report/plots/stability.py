"""At which sizes each method of a benchmark errs, for each precision: α/b across, γ/d up, in half decades."""

from __future__ import annotations

from collections.abc import Iterator

from hypcheck.record import Record
from hypcheck.record.measurements import Stability
from hypcheck.report.plots import heat
from hypcheck.report.plots.svg import Plot

PLANE = heat.Plane("α/b", "γ/d", 0.5)


def plots(record: Record) -> Iterator[Plot]:
    """A small plot for each method and precision that is wrong somewhere."""
    wrong = [line for line in record.of(Stability) if _wrong(line)]
    yield from heat.plots("stability", PLANE, {_title(line): heat.cells(line.bins) for line in wrong})


def right(record: Record) -> list[str]:
    """The methods, with their precisions, that are wrong nowhere."""
    return [_title(line) for line in record.of(Stability) if not _wrong(line)]


def _wrong(line: Stability) -> bool:
    return any(errors for *_, errors in line.bins)


def _title(line: Stability) -> str:
    method, precision = str(line.method), str(line.precision)
    return method if method.endswith(precision) else f"{method}, {precision}"
