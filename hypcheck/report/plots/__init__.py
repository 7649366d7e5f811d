"""Every plot by its name, and the files map.svg, ways.svg, errors.svg, pareto.svg and front.svg."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from hypcheck.errors import UnavailableError
from hypcheck.record import Record
from hypcheck.record.lines import MapLine
from hypcheck.report.plots import curves, pareto, planes, simulations, times, worst_sweep
from hypcheck.report.plots.style import Plot, inline, standalone, styled, together

PLOTS: Mapping[str, Callable[[Record], Iterator[Plot]]] = {
    "map": planes.map_plots,
    "ways": worst_sweep.plots,
    "octaves": curves.octave_plots,
    "sizes": planes.size_plots,
    "fields": planes.field_plots,
    "errors": curves.error_plots,
    "other-errors": curves.other_error_plots,
    "pareto": pareto.pareto_plots,
    "front": pareto.front_plots,
    "speeds": times.speed_plots,
    "stability": planes.stability_plots,
    "places": planes.place_plots,
    "convergence": times.convergence_plots,
    "bounding": times.bounding_plots,
    "forest": times.forest_plots,
}
"""Every plot that a report can have, and the function that draws it."""


_JUDGED_AND_TIMED = "the record has no method that was both judged and timed"

FILES = {
    "ways": ("The worst answers about sweeps", "the record has no wrong answer about a sweep of an upright spheroid"),
    "errors": ("Share of wrong answers against distance", "the record has no errors by distance"),
    "pareto": ("Error against run time", _JUDGED_AND_TIMED),
    "front": ("Error against run time", _JUDGED_AND_TIMED),
}
"""Plots that have a file of their own: its title, and the reason if there is nothing to draw.

The worst answer about a sweep of each implementation; the share of wrong answers, one curve a method; error against run
time, with the front that no method beats; and the same near contact and at its worst, which stands for a whole run.
"""


def draw_plots(name: str, record: Record) -> Iterator[Plot]:
    """Draw the plots of that name in the house style."""
    with styled():
        yield from PLOTS[name](record)


def inline_plots(name: str, record: Record) -> list[tuple[str, str]]:
    """Return the title of each plot of that name, and its element of SVG."""
    return [(plot.title, inline(plot)) for plot in draw_plots(name, record)]


def render_together(name: str, plots: Sequence[tuple[str, str]]) -> bytes:
    """Render plots of that name, each a title and its SVG, as one file. Raises UnavailableError if there are none."""
    title, reason = FILES[name]
    if not plots:
        raise UnavailableError(reason)
    return together(name, title, plots)


def render_map(record: Record) -> bytes:
    """Draw the exact positions over the half plane (r, z) of a scene, and where a method is wrong.

    Raises UnavailableError if the record has no map.
    """
    if not record.of(MapLine):
        raise UnavailableError("the record has no map")
    with styled():
        plot = planes.maps_together(record)
    return standalone(plot)


def simulation_pictures(result: dict[str, Any]) -> dict[str, bytes]:
    """Draw the pictures of a simulation's result; return each as a file, by its name."""
    draw = {"forest": simulations.forest_plots, "tower": simulations.tower_plots}[result["simulation"]]
    with styled():
        return {plot.name: standalone(plot) for plot in draw(result)}
