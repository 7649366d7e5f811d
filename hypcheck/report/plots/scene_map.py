"""Exact positions over the half plane (r, z) of a scene, and where a method is wrong, in a run of verify."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from hypcheck.record import Record
from hypcheck.record.lines import Map
from hypcheck.report.plots import raster
from hypcheck.report.plots.style import WIDTH, colour, new_figure
from hypcheck.report.plots.svg import Plot
from hypcheck.report.text import listed
from hypcheck.visible import visible

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

REGIONS = {"e": ("exterior", "#d7e9f7"), "c": ("contact", "#737373"), "i": ("interior", "#ecc767")}
"""The letters of a map line, their names and colours: told apart by lightness alone, so also without colour."""

WRONG = "#b3001b"
_LONGEST = 24
"""Characters of a name that a legend shows, and half of those that a title does."""

ON_MAP = "#1a1a1a"
"""Lines and words on the map itself, whose ground is light in both schemes."""


def plots(record: Record) -> Iterator[Plot]:
    """A plot for each map."""
    for number, line in enumerate(record.of(Map)):
        title = f"{line.name}: {line.method}"
        yield Plot(f"map-{number}", title, f"{_scene(line)}. {_counts(line)}.", draw([line], WIDTH, 400))


def together(record: Record) -> Plot:
    """The maps side by side, with what a reader needs who sees no more than the picture."""
    lines = record.of(Map)
    drawn = draw(lines, 390 * len(lines), 470)
    drawn.suptitle("\n".join(dict.fromkeys(map(_scene, lines))), fontsize=11)
    said = " ".join(f"{visible(line.name)}: {_counts(line)}." for line in lines)
    return Plot("map", "Exact positions, and the wrong answers of a method", said, drawn)


def draw(lines: Sequence[Map], width: float, height: float) -> Figure:
    """A panel for each map line, side by side, over one legend."""
    drawn = new_figure(width, height)
    panels = drawn.subplots(1, len(lines), squeeze=False)[0]
    for axes, line in zip(panels, lines, strict=True):
        _panel(axes, line)
    _point_out(panels, lines)
    methods = visible(", ".join(dict.fromkeys(line.method for line in lines)), _LONGEST)
    handles = _legend(methods, lines)
    columns = len(handles) if len(lines) > 1 else 2
    drawn.legend(handles=handles, loc="outside lower center", ncols=columns)
    return drawn


def _panel(axes: Axes, line: Map) -> None:
    colours = {letter: both[1] for letter, both in REGIONS.items()}
    wrong = {letter.upper(): WRONG for letter in REGIONS}
    raster.show(axes, line.lines, {**colours, **wrong}, line.r, line.z)
    raster.surface(axes, line.sizes[:2], line.r, line.z, ON_MAP)
    raster.mark(axes, line.lines, wrong, line.r, line.z)
    axes.set_aspect("equal")
    axes.set(xlabel="r, distance from the axis (m)", ylabel="z, height (m)")
    axes.set_title(f"{visible(line.name, 2 * _LONGEST)}\n{_counts(line)}", fontsize=10)


def _counts(line: Map) -> str:
    truths = {letter.lower() for text in line.lines for letter in text if letter.isupper()}
    names = listed([name for letter, (name, _) in REGIONS.items() if letter in truths], "or")
    where = f", in truth {names}" if names else ""
    return f"{line.wrong:,} of {line.points:,} grid points wrong{where}"


def _scene(line: Map) -> str:
    alpha, gamma, b, d = line.sizes
    return f"hyperboloid α = {alpha:g} m, γ = {gamma:g} m; spheroid b = {b:g} m, d = {d:g} m, centred at (r, z)"


def _point_out(panels: Sequence[Axes], lines: Sequence[Map]) -> None:
    """Show in a large panel where a small one that lies inside it is."""
    for axes, line in zip(panels, lines, strict=True):
        for small in lines:
            if small is not line and _within(small, line):
                centre = (sum(small.r) / 2, sum(small.z) / 2)
                ring: dict[str, Any] = {"marker": "o", "markersize": 9, "markerfacecolor": "none"}
                axes.plot(*centre, **ring, markeredgecolor=ON_MAP, zorder=4)
                axes.annotate(
                    f"“{visible(small.name, _LONGEST)}”, see the other panel",
                    centre,
                    xytext=(0, 12),
                    textcoords="offset points",
                    color=ON_MAP,
                    horizontalalignment="right" if centre[0] > sum(line.r) / 2 else "left",
                )


def _within(small: Map, large: Map) -> bool:
    return all(
        outer[0] <= inner[0] and inner[1] <= outer[1] for inner, outer in ((small.r, large.r), (small.z, large.z))
    )


def _legend(methods: str, lines: Sequence[Map]) -> list[Any]:
    from matplotlib.lines import Line2D  # noqa: PLC0415
    from matplotlib.patches import Patch  # noqa: PLC0415

    seen = {letter.lower() for line in lines for text in line.lines for letter in text}
    regions = [Patch(facecolor=shade, label=name) for letter, (name, shade) in REGIONS.items() if letter in seen]
    meridian = Line2D([], [], color=colour("ink"), linewidth=0.9, label="hyperboloid")
    wrong = Line2D([], [], color=WRONG, marker="s", linestyle="none", label=f"wrong answer of {methods}")
    return [*regions, meridian, wrong]
