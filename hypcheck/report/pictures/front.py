"""front.svg: error against run time near contact and at its worst, in one picture that stands for a whole run."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hypcheck.errors import UnavailableError
from hypcheck.record import Record
from hypcheck.report.plots.drawn import drawn
from hypcheck.report.plots.svg import together

if TYPE_CHECKING:
    from hypcheck.report.write import Around


def render(record: Record, around: Around | None = None) -> bytes:
    """The plots as one file. Raises UnavailableError where the record has none or matplotlib is missing."""
    plots = drawn("front", record, around.drawings if around else {})
    if not plots:
        raise UnavailableError("the record has no method that was both judged and timed")
    return together("front", "Error against run time", [(plot.title, plot.svg) for plot in plots])
