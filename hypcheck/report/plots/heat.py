"""Shares of wrong answers over the sizes of the bodies, in five steps of colour; empty where nothing was asked."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.collections import PatchCollection
from matplotlib.patches import PathPatch, Rectangle
from matplotlib.path import Path

from hypcheck.record import Record
from hypcheck.record.measurements import StabilityLine
from hypcheck.report.measured import is_unstable, stability_title
from hypcheck.report.messages import figure
from hypcheck.report.model import implementations
from hypcheck.report.plots.colours import STEPS
from hypcheck.report.plots.style import SMALL, colour, decades, new_figure, power_of_ten, share_layout
from hypcheck.report.plots.svg import Plot

GAP = 0.08
"""Between two cells, of the width of a cell."""

Cells = Mapping[tuple[int, int], tuple[int, int]]
"""[asked, wrong] by the numbers of a cell across and up."""


@dataclass(frozen=True, slots=True)
class Plane:
    """The two quantities, and the width of a cell in decades: cell k reaches from 10^(k·width) to 10^((k+1)·width)."""

    across: str
    up: str
    width: float


def step(asked: int, wrong: int) -> str:
    """The role of the colour of a share."""
    place = next(place for place, (end, _) in enumerate(STEPS) if wrong <= end * asked)
    return f"share-{place}"


def cells(bins: Iterable[Sequence[int]], merged: int = 1) -> Cells:
    """The cells of [across, up, asked, wrong], so many of them made one in each direction."""
    asked: Counter[tuple[int, int]] = Counter()
    wrong: Counter[tuple[int, int]] = Counter()
    for across, up, cases, errors in bins:
        asked[across // merged, up // merged] += cases
        wrong[across // merged, up // merged] += errors
    return {place: (asked[place], wrong[place]) for place in sorted(asked) if asked[place]}


def heat_plots(prefix: str, plane: Plane, maps: Mapping[str, Cells]) -> Iterator[Plot]:
    """A small plot for each map, by its title; all over the same part of the plane."""
    places = [place for found in maps.values() for place in found]
    if not places:
        return
    limits = [(min(place[k] for place in places), max(place[k] for place in places) + 1) for k in (0, 1)]
    first = None
    for number, (title, found) in enumerate(maps.items()):
        plot = _heat_plot(f"{prefix}-{number}", title, plane, found, limits)
        first = share_layout(plot.figure, first)
        yield plot


def _heat_plot(name: str, title: str, plane: Plane, found: Cells, limits: Sequence[tuple[int, int]]) -> Plot:
    drawn = new_figure(SMALL, 170)
    axes = drawn.subplots()
    axes.grid(visible=False)
    wrong = {place: counts for place, counts in found.items() if counts[1]}
    _draw_right(axes, [place for place in found if place not in wrong])
    _draw_wrong(axes, wrong, name)
    _axis(axes, "x", plane.across, plane.width, limits[0])
    _axis(axes, "y", plane.up, plane.width, limits[1])
    asked, errors = (sum(counts[k] for counts in found.values()) for k in (0, 1))
    said = f"Share of wrong answers over {plane.across} and {plane.up}: {errors:,} of {asked:,} wrong."
    tips = {name: [_tip(plane, place, counts) for place, counts in wrong.items()]} if wrong else {}
    return Plot(name, title, said, drawn, tips)


def _draw_right(axes: Axes, places: Sequence[tuple[int, int]]) -> None:
    """The cells without a wrong answer as one shape: there are many, and nothing else to say of each."""
    if places:
        squares = [_square(place) for place in places]
        shape = Path.make_compound_path(
            *(square.get_patch_transform().transform_path(square.get_path()) for square in squares)
        )
        axes.add_patch(PathPatch(shape, facecolor=colour("share-0"), linewidth=0, clip_on=False))


def _draw_wrong(axes: Axes, found: Cells, gid: str) -> None:
    if found:
        colours = [colour(step(*counts)) for counts in found.values()]
        squares = [_square(place) for place in found]
        axes.add_collection(PatchCollection(squares, facecolors=colours, linewidths=0, gid=gid, clip_on=False))


def _square(place: tuple[int, int]) -> Rectangle:
    return Rectangle((place[0] + GAP / 2, place[1] + GAP / 2), 1 - GAP, 1 - GAP)


def _axis(axes: Axes, which: str, label: str, width: float, limits: tuple[int, int]) -> None:
    low, high = (limit * width for limit in limits)
    exponents = decades(10.0**low, 10.0**high, 4)
    getattr(axes, f"set_{which}lim")(*limits)
    ticks = [exponent / width for exponent in exponents]
    getattr(axes, f"set_{which}ticks")(ticks, [power_of_ten(exponent) for exponent in exponents])
    getattr(axes, f"set_{which}label")(label)


def _tip(plane: Plane, place: tuple[int, int], counts: tuple[int, int]) -> str:
    middles = (
        f"{name} ≈ {figure(10.0 ** ((k + 0.5) * plane.width))}"
        for name, k in zip((plane.across, plane.up), place, strict=True)
    )
    return f"{', '.join(middles)}: {counts[1]:,} of {counts[0]:,} wrong"


OCTAVES = 3
"""Octaves of the record that make one cell."""

SIZE_PLANE = Plane("α/b", "γ/d", OCTAVES * math.log10(2))


def size_plots(record: Record) -> Iterator[Plot]:
    """A small plot for each method that erred."""
    maps = {
        each.name: cells((row for group in each.groups for row in group.size_bins), OCTAVES)
        for each in implementations(record)
        if any(row[3] for group in each.groups for row in group.size_bins)
    }
    yield from heat_plots("sizes", SIZE_PLANE, maps)


STABILITY_PLANE = Plane("α/b", "γ/d", 0.5)


def stability_plots(record: Record) -> Iterator[Plot]:
    """A small plot for each method and precision that is wrong somewhere."""
    wrong = [line for line in record.of(StabilityLine) if is_unstable(line)]
    yield from heat_plots("stability", STABILITY_PLANE, {stability_title(line): cells(line.bins) for line in wrong})
