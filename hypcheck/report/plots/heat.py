"""Shares of wrong answers over a plane of two quantities, in five steps of colour; empty where nothing was asked."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from hypcheck.report.plots.style import SMALL, colour, decades, new_figure, power_of_ten
from hypcheck.report.plots.svg import Plot
from hypcheck.report.text import figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

STEPS = ((0.0, "none wrong"), (0.01, "up to 1 %"), (0.1, "up to 10 %"), (0.5, "up to 50 %"), (1.0, "more"))
"""The shares at which the steps of colour end, and what a legend says of them."""

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


def plots(prefix: str, plane: Plane, maps: Mapping[str, Cells]) -> Iterator[Plot]:
    """A small plot for each map, by its title; all over the same part of the plane."""
    places = [place for found in maps.values() for place in found]
    if not places:
        return
    limits = [(min(place[k] for place in places), max(place[k] for place in places) + 1) for k in (0, 1)]
    for number, (title, found) in enumerate(maps.items()):
        yield _plot(f"{prefix}-{number}", title, plane, found, limits)


def _plot(name: str, title: str, plane: Plane, found: Cells, limits: Sequence[tuple[int, int]]) -> Plot:
    from matplotlib.collections import PatchCollection  # noqa: PLC0415
    from matplotlib.patches import Rectangle  # noqa: PLC0415

    drawn = new_figure(SMALL, 170)
    axes = drawn.subplots()
    axes.grid(visible=False)
    patches = [Rectangle((across + GAP / 2, up + GAP / 2), 1 - GAP, 1 - GAP) for across, up in found]
    colours = [colour(step(*counts)) for counts in found.values()]
    axes.add_collection(PatchCollection(patches, facecolors=colours, linewidths=0, gid=name, clip_on=False))
    _axis(axes, "x", plane.across, plane.width, limits[0])
    _axis(axes, "y", plane.up, plane.width, limits[1])
    asked, wrong = (sum(counts[k] for counts in found.values()) for k in (0, 1))
    said = f"Share of wrong answers over {plane.across} and {plane.up}: {wrong:,} of {asked:,} wrong."
    tips = [_tip(plane, place, counts) for place, counts in found.items()]
    return Plot(name, title, said, drawn, {name: tips})


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
