"""map.svg: exact positions over the half plane (r, z) of a scene, and where a method is wrong."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hypcheck.errors import UnavailableError
from hypcheck.record import Record
from hypcheck.record.lines import Map
from hypcheck.report.plots import scene_map
from hypcheck.report.plots.style import styled
from hypcheck.report.plots.svg import standalone

if TYPE_CHECKING:
    from hypcheck.report.write import Around


def render(record: Record, _around: Around | None = None) -> bytes:
    """The picture as SVG. Raises UnavailableError where the record has no map or matplotlib is missing."""
    if not record.of(Map):
        raise UnavailableError("the record has no map")
    with styled():
        plot = scene_map.together(record)
    return standalone(plot)
