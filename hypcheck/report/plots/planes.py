"""Pictures over a plane: shares of wrong answers over sizes and places, and maps of the half plane (r, z).

Shares have five steps of colour; cells without a tested row stay empty. In the half plane a dot is a grid point, r is
drawn across and z up; the fields of a verification are in semi-axes of the hyperboloid, r/α and |z|/γ.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path
from msgspec.structs import asdict

from hypcheck.geometry.rows import Floats
from hypcheck.messages import escaped
from hypcheck.record import Record
from hypcheck.record.lines import MapLine
from hypcheck.record.measurements import PlacesLine, StabilityLine
from hypcheck.report.colours import MISTAKES, STEPS
from hypcheck.report.measured import is_unstable, is_wrong_somewhere, stability_title
from hypcheck.report.messages import figure, listed
from hypcheck.report.model import ImplementationTotal, implementations
from hypcheck.report.plots import style

GAP = 0.08
"""The gap between two cells, as a part of a cell's width."""

Cells = Mapping[tuple[int, int], tuple[int, int]]
"""The counts [asked, wrong] of each cell; a cell is named by its number across and its number up."""


SIZES = ("α/b", "γ/d")
"""The quantities that are drawn across and up."""


def step(cases: int, wrong: int) -> str:
    """Return the role of the colour that shows the share of wrong answers."""
    place = next(place for place, (end, _) in enumerate(STEPS) if wrong <= end * cases)
    return f"share-{place}"


def cells(bins: Iterable[Sequence[int]], merged: int = 1) -> Cells:
    """Add up bins [across, up, asked, wrong]; `merged` bins in each direction become one cell."""
    totals: Counter[tuple[int, int]] = Counter()
    wrong: Counter[tuple[int, int]] = Counter()
    for across, up, cases, errors in bins:
        totals[across // merged, up // merged] += cases
        wrong[across // merged, up // merged] += errors
    return {place: (totals[place], wrong[place]) for place in sorted(totals) if totals[place]}


def _heat_plots(prefix: str, width: float, maps: Mapping[str, Cells]) -> Iterator[style.Plot]:
    """Yield a small plot over the sizes for each map, by its title; all show the same part of the plane.

    A cell has `width` decades: cell k reaches from 10^(k·width) to 10^((k+1)·width).
    """
    places = [place for bins in maps.values() for place in bins]
    if not places:
        return
    limits = [(min(place[k] for place in places), max(place[k] for place in places) + 1) for k in (0, 1)]
    named = enumerate(maps.items())
    yield from style.with_one_layout(
        _heat_plot(f"{prefix}-{number}", title, width, bins, limits) for number, (title, bins) in named
    )


def _heat_plot(name: str, title: str, width: float, bins: Cells, limits: Sequence[tuple[int, int]]) -> style.Plot:
    """Draw the cells of one map; `limits` are the first and the one after the last cell, across and up."""
    drawn = style.new_figure(style.SMALL, 170)
    axes = drawn.subplots()
    axes.grid(visible=False)
    wrong = {place: counts for place, counts in bins.items() if counts[1]}
    right = [place for place in bins if place not in wrong]
    if right:  # as one shape, because there are many and none has a tooltip
        shape = Path.make_compound_path_from_polys(_squares(right))
        axes.add_patch(PathPatch(shape, facecolor=style.colour("share-0"), linewidth=0, clip_on=False))
    if wrong:
        squares, colours = _squares(wrong), [style.colour(step(*counts)) for counts in wrong.values()]
        axes.add_collection(PolyCollection(list(squares), facecolors=colours, linewidths=0, gid=name, clip_on=False))
    for axis, label, ends in zip("xy", SIZES, limits, strict=True):
        exponents = style.decades(10.0 ** (ends[0] * width), 10.0 ** (ends[1] * width), 4)
        ticks = [exponent / width for exponent in exponents]
        getattr(axes, f"set_{axis}lim")(*ends)
        getattr(axes, f"set_{axis}ticks")(ticks, [style.power_of_ten(exponent) for exponent in exponents])
        getattr(axes, f"set_{axis}label")(label)
    cases, errors = (sum(counts[k] for counts in bins.values()) for k in (0, 1))
    description = f"Share of wrong answers over {SIZES[0]} and {SIZES[1]}: {errors:,} of {cases:,} wrong."
    tips = {name: [_tip(width, place, counts) for place, counts in wrong.items()]} if wrong else {}
    return style.Plot(name, title, description, drawn, tips)


def _squares(places: Iterable[tuple[int, int]]) -> Floats:
    """Compute the corners of these cells' squares, (n, 4, 2)."""
    near, far = GAP / 2, 1 - GAP / 2
    corners: Floats = np.array([[near, near], [far, near], [far, far], [near, far]])
    return np.asarray(np.array(list(places), dtype=np.float64)[:, np.newaxis] + corners)


def _tip(width: float, place: tuple[int, int], counts: tuple[int, int]) -> str:
    """Return the tooltip of a cell: the sizes at its middle, and its counts."""
    middles = [f"{name} ≈ {figure(10.0 ** ((k + 0.5) * width))}" for name, k in zip(SIZES, place, strict=True)]
    return f"{', '.join(middles)}: {counts[1]:,} of {counts[0]:,} wrong"


OCTAVES = 3
"""The number of the record's octaves, in each direction, that make one cell."""


def size_plots(record: Record) -> Iterator[style.Plot]:
    """Yield a small plot over the sizes for each method that erred."""
    maps = {
        implementation.name: cells((row for group in implementation.groups for row in group.size_bins), OCTAVES)
        for implementation in implementations(record)
        if any(row[3] for group in implementation.groups for row in group.size_bins)
    }
    yield from _heat_plots("sizes", OCTAVES * math.log10(2), maps)


def stability_plots(record: Record) -> Iterator[style.Plot]:
    """Yield a small plot for each method and precision that is wrong somewhere; a cell has half a decade."""
    wrong = [line for line in record.of(StabilityLine) if is_unstable(line)]
    yield from _heat_plots("stability", 0.5, {stability_title(line): cells(line.bins) for line in wrong})


Interval = tuple[float, float]

FAINT = "#8a94a066"
"""The colour where nothing is wrong; it shows on light and on dark ground."""


def paint_letters(axes: Axes, letters: Sequence[str], colours: Mapping[str, str], r: Interval, z: Interval) -> None:
    """Paint a cell for each letter, the first text lowest; a grid point is the middle of its cell.

    Letters without a colour stay empty.
    """
    grid = np.array([list(text) for text in letters])
    image = np.zeros((*grid.shape, 4))
    for letter, name in colours.items():
        image[grid == letter] = to_rgba(name)
    extent = picture_limits(r, z, grid.shape)
    axes.imshow(image, extent=extent, origin="lower", interpolation="nearest", aspect="auto")
    axes.set(xlim=extent[:2], ylim=extent[2:])
    axes.grid(visible=False)
    axes.ticklabel_format(useOffset=False)


def picture_limits(r: Interval, z: Interval, shape: tuple[int, ...]) -> Any:  # noqa: ANN401 - what matplotlib takes
    """Compute the limits of the picture: half a cell beyond the first and the last grid points."""
    up, across = shape
    half_r, half_z = ((high - low) / max(1, count - 1) / 2 or 0.5 for (low, high), count in ((r, across), (z, up)))
    return (r[0] - half_r, r[1] + half_r, z[0] - half_z, z[1] + half_z)


def mark_grid_points(axes: Axes, letters: Sequence[str], colours: Mapping[str, str], r: Interval, z: Interval) -> None:
    """Draw the grid points of these letters also as dots, because some cells are too small to be seen."""
    grid = np.array([list(text) for text in letters])
    rs, zs = np.linspace(*r, grid.shape[1]), np.linspace(*z, grid.shape[0])
    for letter, name in colours.items():
        across, up = np.nonzero((grid == letter).T)
        if len(across):
            axes.scatter(rs[across], zs[up], s=3, marker="s", color=name, linewidths=0, rasterized=True, zorder=3)


def draw_surface(axes: Axes, sizes: Sequence[float], r: Interval, z: Interval, line: str) -> None:
    """Draw the hyperboloid's meridian r = α √(1 + z²/γ²), if it is within the picture."""
    alpha, gamma = sizes
    heights = [z[0] + (z[1] - z[0]) * step / 200 for step in range(201)]
    radii = [alpha * math.hypot(1, height / gamma) for height in heights]
    if min(radii) <= r[1] and max(radii) >= r[0]:
        axes.plot(radii, heights, color=line, linewidth=0.9, zorder=2)


CELLS, PER_UNIT = 64, 8
"""The number of the record's cells in each direction, and in one semi-axis; the last cell includes all beyond it."""


def field_plots(record: Record) -> Iterator[style.Plot]:
    """Yield a small plot over places for each method that erred."""
    fields = [
        (f"fields-{number}", implementation, cells(row for group in implementation.groups for row in group.place_bins))
        for number, implementation in enumerate(implementations(record))
    ]
    return style.with_one_layout(
        _field_plot(*field) for field in fields if any(wrong for _, wrong in field[-1].values())
    )


def _field_plot(name: str, implementation: ImplementationTotal, bins: Cells) -> style.Plot:
    """Draw the share of a method's wrong answers over r/α and |z|/γ."""
    drawn = style.new_figure(style.SMALL, 170)
    axes = drawn.subplots()
    image = np.zeros((CELLS, CELLS, 4))
    steps: Counter[str] = Counter()
    for (across, up), (cases, wrong) in bins.items():
        role = step(cases, wrong)
        steps[role] += 1
        image[min(up, CELLS - 1), min(across, CELLS - 1)] = to_rgba(FAINT if role == "share-0" else style.colour(role))
    end = CELLS / PER_UNIT
    axes.imshow(image, extent=(0, end, 0, end), origin="lower", interpolation="nearest", aspect="auto")
    axes.grid(visible=False)
    axes.set(xlabel="r/α", ylabel="|z|/γ")
    axes.set_xticks(range(0, 9, 2))
    axes.set_yticks(range(0, 9, 2))
    cases, wrong = (sum(counts[k] for counts in bins.values()) for k in (0, 1))
    some = sum(number for role, number in steps.items() if role != "share-0")
    description = (
        f"Share of wrong answers over r/α and |z|/γ: {wrong:,} of {cases:,} wrong, in {some:,} of {len(bins):,} cells."
    )
    return style.Plot(name, implementation.name, description, drawn)


def place_plots(record: Record) -> Iterator[style.Plot]:
    """Yield a small plot for each method, scene and region in which it is wrong."""
    for number, line in enumerate(record.of(PlacesLine)):
        if is_wrong_somewhere(line):
            yield _place_plot(f"places-{number}", line)


def _place_plot(name: str, line: PlacesLine) -> style.Plot:
    """Draw the wrong answers of a places line."""
    drawn = style.new_figure(style.SMALL, 185)
    axes = drawn.subplots()
    r, z = (line.r[0], line.r[1]), (line.z[0], line.z[1])
    colours = {letter: style.colour(role) for letter, (_, role) in MISTAKES.items()}
    paint_letters(axes, line.wrong, {".": FAINT, **colours}, r, z)
    draw_surface(axes, (line.scene.alpha, line.scene.gamma), r, z, style.colour("ink"))
    mark_grid_points(axes, line.wrong, colours, r, z)
    axes.set(xlabel="r (m)", ylabel="z (m)")
    axes.locator_params(nbins=4)
    counts = Counter(letter for text in line.wrong for letter in text)
    mistakes = [f"{counts[letter]:,} {what}" for letter, (what, _) in MISTAKES.items() if counts[letter]]
    where = "near the ring" if line.region == "ring" else "around the scene"
    scene = ", ".join(f"{size} {value:g}" for size, value in asdict(line.scene).items())
    description = f"Wrong answers {where} ({scene}) at {sum(counts.values()):,} grid points: {listed(mistakes)}."
    return style.Plot(name, f"{line.method}, {where}", description, drawn)


REGIONS = {"e": ("exterior", "#d7e9f7"), "c": ("contact", "#737373"), "i": ("interior", "#ecc767")}
"""The letters of a map line, their names and colours: they differ in lightness, so also without colour."""

WRONG = "#b3001b"
_LONGEST_NAME = 24
"""Characters of a name that a legend shows, and half of those that a title does."""

ON_MAP = "#1a1a1a"
"""The colour of lines and words on the map, whose ground is light in both schemes."""


def map_plots(record: Record) -> Iterator[style.Plot]:
    """Yield a plot for each map."""
    for number, line in enumerate(record.of(MapLine)):
        title = f"{line.name}: {line.method}"
        yield style.Plot(
            f"map-{number}", title, f"{_scene(line)}. {_counts(line)}.", draw_maps([line], style.WIDTH, 400)
        )


def maps_together(record: Record) -> style.Plot:
    """Draw the maps side by side, with a title that explains the picture if it is seen without a report."""
    lines = record.of(MapLine)
    drawn = draw_maps(lines, 390 * len(lines), 470)
    drawn.suptitle("\n".join(dict.fromkeys(map(_scene, lines))), fontsize=11)
    description = " ".join(f"{escaped(line.name)}: {_counts(line)}." for line in lines)
    return style.Plot("map", "Exact positions, and the wrong answers of a method", description, drawn)


def draw_maps(lines: Sequence[MapLine], width: float, height: float) -> Figure:
    """Draw a panel for each map line, side by side, over one legend."""
    drawn = style.new_figure(width, height)
    panels = drawn.subplots(1, len(lines), squeeze=False)[0]
    for axes, line in zip(panels, lines, strict=True):
        _panel(axes, line)
    _point_out(panels, lines)
    methods = escaped(", ".join(dict.fromkeys(line.method for line in lines)), _LONGEST_NAME)
    handles = _legend(methods, lines)
    columns = len(handles) if len(lines) > 1 else 2
    drawn.legend(handles=handles, loc="outside lower center", ncols=columns)
    return drawn


def _panel(axes: Axes, line: MapLine) -> None:
    """Draw one map line: exact positions, wrong answers and the hyperboloid."""
    colours = {letter: both[1] for letter, both in REGIONS.items()}
    wrong = {letter.upper(): WRONG for letter in REGIONS}
    paint_letters(axes, line.lines, {**colours, **wrong}, line.r, line.z)
    draw_surface(axes, line.sizes[:2], line.r, line.z, ON_MAP)
    mark_grid_points(axes, line.lines, wrong, line.r, line.z)
    axes.set_aspect("equal")
    axes.set(xlabel="r, distance from the axis (m)", ylabel="z, height (m)")
    axes.set_title(f"{escaped(line.name, 2 * _LONGEST_NAME)}\n{_counts(line)}", fontsize=10)


def _counts(line: MapLine) -> str:
    """Return a sentence about the wrong grid points and the true positions there."""
    truths = {letter.lower() for text in line.lines for letter in text if letter.isupper()}
    names = listed([name for letter, (name, _) in REGIONS.items() if letter in truths], "or")
    where = f", in truth {names}" if names else ""
    return f"{line.wrong:,} of {line.points:,} grid points wrong{where}"


def _scene(line: MapLine) -> str:
    """Return the sizes of a map's bodies in words."""
    alpha, gamma, b, d = line.sizes
    return f"hyperboloid α = {alpha:g} m, γ = {gamma:g} m; spheroid b = {b:g} m, d = {d:g} m, centred at (r, z)"


def _point_out(panels: Sequence[Axes], lines: Sequence[MapLine]) -> None:
    """Mark in a large panel the region of a small panel that lies inside it."""
    for axes, line in zip(panels, lines, strict=True):
        for small in lines:
            if small is not line and _within(small, line):
                centre = (sum(small.r) / 2, sum(small.z) / 2)
                ring: dict[str, Any] = {"marker": "o", "markersize": 9, "markerfacecolor": "none"}
                axes.plot(*centre, **ring, markeredgecolor=ON_MAP, zorder=4)
                axes.annotate(
                    f"“{escaped(small.name, _LONGEST_NAME)}”, see the other panel",
                    centre,
                    xytext=(0, 12),
                    textcoords="offset points",
                    color=ON_MAP,
                    horizontalalignment="right" if centre[0] > sum(line.r) / 2 else "left",
                )


def _within(small: MapLine, large: MapLine) -> bool:
    """Decide whether the region of a map lies within that of another one."""
    return all(
        outer[0] <= inner[0] and inner[1] <= outer[1] for inner, outer in ((small.r, large.r), (small.z, large.z))
    )


def _legend(methods: str, lines: Sequence[MapLine]) -> list[Any]:
    """Return the entries of the legend; `methods` are the names of the methods that are wrong."""
    seen = {letter.lower() for line in lines for text in line.lines for letter in text}
    regions = [Patch(facecolor=shade, label=name) for letter, (name, shade) in REGIONS.items() if letter in seen]
    meridian = Line2D([], [], color=style.colour("ink"), linewidth=0.9, label="hyperboloid")
    wrong = Line2D([], [], color=WRONG, marker="s", linestyle="none", label=f"wrong answer of {methods}")
    return [*regions, meridian, wrong]
