"""Plots as text, each drawn once for all the reports that show it; those of a large record by all processors.

matplotlib takes a tenth of a second for a plot, and a benchmark has a hundred of them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from hypcheck.errors import UnavailableError
from hypcheck.processes import perform, processes, usable_processors
from hypcheck.record import Record
from hypcheck.record.measurements import Accuracy, Places, Stability
from hypcheck.report.plots.svg import inline
from hypcheck.report.plots.table import PLOTS, draw

MANY = 100
"""Lines that are drawn, from which on the second that a process takes to start is won back."""


@dataclass(frozen=True, slots=True)
class Drawn:
    """A plot's title and its element of SVG."""

    title: str
    svg: str


Drawings = Mapping[str, tuple[Drawn, ...]]
"""What was drawn already, by the names of PLOTS."""


def drawn(name: str, record: Record, drawings: Drawings) -> tuple[Drawn, ...]:
    """The plots of that name, drawn now where they are not yet. Raises UnavailableError where matplotlib is missing."""
    return drawings[name] if name in drawings else _drawn((name, record))


def ahead(record: Record) -> Drawings:
    """All plots of a large record; none of a small one, or where they cannot be drawn here."""
    if sum(isinstance(line, (Accuracy, Places, Stability)) for line in record.lines) < MANY:
        return {}
    try:
        with processes(usable_processors()) as executor:
            return dict(_named(perform(_drawn, [(name, record) for name in _SLOWEST_FIRST], executor)))
    except UnavailableError:
        return {}


def _named(found: Iterable[tuple[tuple[str, Record], tuple[Drawn, ...]]]) -> Iterable[tuple[str, tuple[Drawn, ...]]]:
    return ((name, plots) for (name, _), plots in found)


_SLOWEST_FIRST = sorted(PLOTS, key=lambda name: name not in ("other-errors", "errors", "places"))
"""The others fill up what time is left at the end."""


def _drawn(task: tuple[str, Record]) -> tuple[Drawn, ...]:
    return tuple(Drawn(plot.title, inline(plot)) for plot in draw(*task))
