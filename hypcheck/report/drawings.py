"""Plots as text, each drawn once for all the reports that show it. matplotlib is loaded when a plot is drawn.

matplotlib takes a tenth of a second for a plot, and a benchmark has a hundred plots. Therefore all processors draw the
plots of a large record in advance.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from concurrent.futures import BrokenExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field
from types import ModuleType
from typing import NamedTuple

from hypcheck.errors import UnavailableError
from hypcheck.messages import escaped
from hypcheck.processes import perform, processes, usable_processors
from hypcheck.record import Record
from hypcheck.record.measurements import AccuracyLine, PlacesLine, StabilityLine

MANY = 100
"""The least number of lines with plots for which processes are started: to start one takes a second."""


class DrawnPlot(NamedTuple):
    """A plot's title and its element of SVG."""

    title: str
    svg: str


Drawings = Mapping[str, tuple[DrawnPlot, ...]]
"""Plots that were drawn already, by their names in plots.PLOTS."""


@dataclass(frozen=True, slots=True)
class ReportContext:
    """The inputs of a report besides its record.

    beside: the names of the files in the report's folder; the report refers to pictures among them. against: another
    record; reports that compare show the changes from it. drawings: the plots that were drawn in advance.
    """

    beside: Collection[str] = ()
    against: Record | None = None
    drawings: Drawings = field(default_factory=dict)


ALONE = ReportContext()
"""The context of a report that is made of its record alone."""


def drawn_plots(name: str, record: Record, drawings: Drawings) -> tuple[DrawnPlot, ...]:
    """Return the plots of that name; they are drawn now if `drawings` does not have them.

    Raises UnavailableError if matplotlib is missing.
    """
    return drawings[name] if name in drawings else _draw((name, record))


def draw_ahead(record: Record, least: int = MANY, names: Collection[str] | None = None) -> Drawings:
    """Draw all plots, or those of these `names`, if the record has at least `least` lines with plots.

    Returns no plots for a smaller record, if plots cannot be drawn here, or if a process was killed.
    """
    if sum(len(record.of(kind)) for kind in (AccuracyLine, PlacesLine, StabilityLine)) < least:
        return {}
    try:
        slowest_first = sorted(
            names or pictures().PLOTS, key=lambda name: name not in ("other-errors", "errors", "places")
        )
        with processes(usable_processors()) as executor:
            drawn = perform(_draw, [(name, record) for name in slowest_first], executor)
            return {name: plots for (name, _), plots in drawn}
    except (UnavailableError, BrokenExecutor):
        return {}


def _draw(task: tuple[str, Record]) -> tuple[DrawnPlot, ...]:
    """Draw the plots of a task, which is a name and a record."""
    return tuple(DrawnPlot(*plot) for plot in pictures().inline_plots(*task))


def render_picture(name: str, record: Record, drawings: Drawings) -> bytes:
    """Render the plots of that name as one file.

    Raises UnavailableError if there are none, or if matplotlib is missing.
    """
    module = pictures()
    if name == "map":
        return bytes(module.render_map(record))
    return bytes(module.render_together(name, drawn_plots(name, record, drawings)))


def pictures() -> ModuleType:
    """Import the module that draws.

    Raises UnavailableError if matplotlib, which is an extra, is missing.
    """
    with extra("matplotlib"):
        import matplotlib  # noqa: F401, PLC0415

        from hypcheck.report import plots  # noqa: PLC0415
    return plots


@contextmanager
def extra(library: str) -> Iterator[None]:
    """Turn a failed import within the block, of a library of the extra [report], into UnavailableError."""
    try:
        yield
    except ImportError as error:
        reason = f"{library} cannot be imported ({escaped(error)}); pip install 'hypcheck[report]' brings it"
        raise UnavailableError(reason) from None
