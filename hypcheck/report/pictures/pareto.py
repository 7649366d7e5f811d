"""pareto.svg: error against run time, with the front that no method beats."""

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
    plots = drawn("pareto", record, around.drawings if around else {})
    if not plots:
        raise UnavailableError("the record has no method that was both judged and timed")
    return together("pareto", "Error against run time", [(plot.title, plot.svg) for plot in plots])
