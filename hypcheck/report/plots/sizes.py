"""At which sizes each judged method of a verification errs: α/b across, γ/d up."""

from __future__ import annotations

import math
from collections.abc import Iterator

from hypcheck.record import Record
from hypcheck.report.digest import implementations
from hypcheck.report.plots import heat
from hypcheck.report.plots.svg import Plot

OCTAVES = 3
"""Octaves of the record that make one cell."""

PLANE = heat.Plane("α/b", "γ/d", OCTAVES * math.log10(2))


def plots(record: Record) -> Iterator[Plot]:
    """A small plot for each method that erred."""
    maps = {
        each.name: heat.cells((row for group in each.groups for row in group.size_bins), OCTAVES)
        for each in implementations(record)
        if any(row[3] for group in each.groups for row in group.size_bins)
    }
    yield from heat.plots("sizes", PLANE, maps)
