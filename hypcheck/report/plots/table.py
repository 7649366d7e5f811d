"""Every plot that a report can have, by name: the module that draws it, and its function."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module

from hypcheck.record import Record
from hypcheck.report.plots.style import styled
from hypcheck.report.plots.svg import Plot

PLOTS = {
    "map": "scene_map:plots",
    "octaves": "octaves:plots",
    "sizes": "sizes:plots",
    "fields": "fields:plots",
    "errors": "errors:plots",
    "other-errors": "errors:others",
    "pareto": "pareto:plots",
    "front": "pareto:pair",
    "speeds": "speeds:plots",
    "stability": "stability:plots",
    "places": "places:plots",
    "convergence": "convergence:plots",
    "bounding": "bounding:plots",
    "forest": "forest:plots",
}


def draw(name: str, record: Record) -> Iterator[Plot]:
    """The plots of that name in the house style. Raises UnavailableError where matplotlib is missing."""
    module, _, function = PLOTS[name].partition(":")
    with styled():
        yield from getattr(import_module(f"hypcheck.report.plots.{module}"), function)(record)
