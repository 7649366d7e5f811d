"""Every plot by its name, drawn once for all reports; and the files map.svg, errors.svg, pareto.svg and front.svg.

Every plot that a report can have, by name: the module that draws it, and its function.

Plots as text, each drawn once for all the reports that show it; those of a large record by all processors.

matplotlib takes a tenth of a second for a plot, and a benchmark has a hundred of them.

map.svg: exact positions over the half plane (r, z) of a scene, and where a method is wrong.

errors.svg: the share of wrong answers against flip distance, one curve a method.

pareto.svg: error against run time, with the front that no method beats.

front.svg: error against run time near contact and at its worst, in one picture that stands for a whole run.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from hypcheck.errors import UnavailableError
from hypcheck.processes import perform, processes, usable_processors
from hypcheck.record import Record
from hypcheck.record.lines import MapLine
from hypcheck.record.measurements import AccuracyLine, PlacesLine, StabilityLine
from hypcheck.report.plots import curves, half_plane, heat, pareto, times
from hypcheck.report.plots.style import styled
from hypcheck.report.plots.svg import Plot, inline, standalone, together

if TYPE_CHECKING:
    from hypcheck.report.write import ReportContext


PLOTS: Mapping[str, Callable[[Record], Iterator[Plot]]] = {
    "map": half_plane.map_plots,
    "octaves": curves.octave_plots,
    "sizes": heat.size_plots,
    "fields": half_plane.field_plots,
    "errors": curves.error_plots,
    "other-errors": curves.other_error_plots,
    "pareto": pareto.pareto_plots,
    "front": pareto.front_plots,
    "speeds": times.speed_plots,
    "stability": heat.stability_plots,
    "places": half_plane.place_plots,
    "convergence": times.convergence_plots,
    "bounding": times.bounding_plots,
    "forest": times.forest_plots,
}
"""Every plot that a report can have: the function that draws it."""


def draw_plots(name: str, record: Record) -> Iterator[Plot]:
    """The plots of that name in the house style. Raises UnavailableError where matplotlib is missing."""
    with styled():
        yield from PLOTS[name](record)


MANY = 100
"""Lines that are drawn, from which on the second that a process takes to start is won back."""


@dataclass(frozen=True, slots=True)
class DrawnPlot:
    """A plot's title and its element of SVG."""

    title: str
    svg: str


Drawings = Mapping[str, tuple[DrawnPlot, ...]]
"""What was drawn already, by the names of PLOTS."""


def drawn_plots(name: str, record: Record, drawings: Drawings) -> tuple[DrawnPlot, ...]:
    """The plots of that name, drawn now where they are not yet. Raises UnavailableError where matplotlib is missing."""
    return drawings[name] if name in drawings else _draw_task((name, record))


def draw_ahead(record: Record) -> Drawings:
    """All plots of a large record; none of a small one, or where they cannot be drawn here."""
    if sum(isinstance(line, (AccuracyLine, PlacesLine, StabilityLine)) for line in record.lines) < MANY:
        return {}
    try:
        with processes(usable_processors()) as executor:
            return dict(_by_name(perform(_draw_task, [(name, record) for name in _SLOWEST_FIRST], executor)))
    except UnavailableError:
        return {}


def _by_name(
    found: Iterable[tuple[tuple[str, Record], tuple[DrawnPlot, ...]]],
) -> Iterable[tuple[str, tuple[DrawnPlot, ...]]]:
    return ((name, plots) for (name, _), plots in found)


_SLOWEST_FIRST = sorted(PLOTS, key=lambda name: name not in ("other-errors", "errors", "places"))
"""The others fill up what time is left at the end."""


def _draw_task(task: tuple[str, Record]) -> tuple[DrawnPlot, ...]:
    return tuple(DrawnPlot(plot.title, inline(plot)) for plot in draw_plots(*task))


def render_map(record: Record, _around: ReportContext | None = None) -> bytes:
    """The picture as SVG. Raises UnavailableError where the record has no map or matplotlib is missing."""
    if not record.of(MapLine):
        raise UnavailableError("the record has no map")
    with styled():
        plot = half_plane.maps_together(record)
    return standalone(plot)


def render_errors(record: Record, around: ReportContext | None = None) -> bytes:
    """The plots as one file. Raises UnavailableError where the record has none or matplotlib is missing."""
    plots = drawn_plots("errors", record, around.drawings if around else {})
    if not plots:
        raise UnavailableError("the record has no errors by distance")
    return together(
        "errors", "Share of wrong answers against flip distance", [(plot.title, plot.svg) for plot in plots]
    )


def render_pareto(record: Record, around: ReportContext | None = None) -> bytes:
    """The plots as one file. Raises UnavailableError where the record has none or matplotlib is missing."""
    plots = drawn_plots("pareto", record, around.drawings if around else {})
    if not plots:
        raise UnavailableError("the record has no method that was both judged and timed")
    return together("pareto", "Error against run time", [(plot.title, plot.svg) for plot in plots])


def render_front(record: Record, around: ReportContext | None = None) -> bytes:
    """The plots as one file. Raises UnavailableError where the record has none or matplotlib is missing."""
    plots = drawn_plots("front", record, around.drawings if around else {})
    if not plots:
        raise UnavailableError("the record has no method that was both judged and timed")
    return together("front", "Error against run time", [(plot.title, plot.svg) for plot in plots])
