"""The style of all plots: lines that differ without colour, sizes for a telephone, axes.

Widths are in points of the picture, which a page scales: 380 of them are legible across a telephone and across half a
screen. Each curve has its own marker and dashes besides its colour.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, NamedTuple

import matplotlib.style
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from hypcheck.messages import escaped
from hypcheck.report.plots.colours import ROLES

WIDTH = 380.0
SMALL = 178.0
"""Widths of a plot that stands alone, and of one of many that stand side by side."""

MARKERS = "osD^vPX*"
DASHES: tuple[Any, ...] = (
    "-",
    (0, (5, 2)),
    (0, (2, 1.5)),
    (0, (6, 2, 1.5, 2)),
    (0, (8, 2)),
    (0, (1, 1.2)),
    (0, (4, 4)),
    (0, (10, 2, 1, 2)),
)

LIMIT: dict[str, Any] = {"marker": "v", "markerfacecolor": "none", "markersize": 5.5}
"""The mark of an upper limit: none of n was wrong."""

NONE_WRONG = "none of n wrong: at most 3/n (95 %)"
"""Its text in a legend."""

SETTINGS = {
    "figure.facecolor": "none",  # the page's own ground, light or dark
    "axes.facecolor": "none",
    "font.family": "DejaVu Sans",  # wider than what a page uses in its place, so that what fits here fits there
    "font.size": 10.5,
    "axes.titlesize": 10.5,
    "axes.labelsize": 10.5,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.edgecolor": ROLES["soft"][0],
    "axes.labelcolor": ROLES["ink"][0],
    "axes.titlecolor": ROLES["ink"][0],
    "grid.color": ROLES["rule"][0],
    "grid.linewidth": 0.6,
    "text.color": ROLES["ink"][0],
    "xtick.color": ROLES["soft"][0],
    "ytick.color": ROLES["soft"][0],
    "xtick.labelcolor": ROLES["ink"][0],
    "ytick.labelcolor": ROLES["ink"][0],
    "xtick.minor.visible": False,
    "ytick.minor.visible": False,
    "legend.frameon": False,
    "legend.fontsize": 10,
    "legend.handlelength": 2.6,
    "legend.columnspacing": 1.2,
    "lines.linewidth": 1.4,
    "lines.markersize": 4.5,
    "svg.fonttype": "none",  # text stays text: it can be read aloud, found and copied
    "svg.hashsalt": "hypcheck",  # element ids: the same picture is the same file
    "text.parse_math": False,  # a name with dollars in it is not a formula
}
"""The differences from matplotlib's defaults; settings of users are not read."""


class CurveStyle(NamedTuple):
    """The look of one curve of several."""

    colour: str
    marker: str
    dashes: Any

    @property
    def line(self) -> dict[str, Any]:
        """The look of its line, as arguments of matplotlib."""
        return {"color": self.colour, "linestyle": self.dashes}

    @property
    def marks(self) -> dict[str, Any]:
        """The look of its marks without a line, as arguments of matplotlib."""
        return {"color": self.colour, "marker": self.marker, "linestyle": "none"}


def colour(role: str) -> str:
    """The colour that stands for a role while a plot is drawn (svg.py makes it a class)."""
    return ROLES[role][0]


def curve_style(place: int) -> CurveStyle:
    """The look of the curve at a place; after eight, markers and dashes are combined differently."""
    number = len(MARKERS)
    turn = place // number
    return CurveStyle(
        colour(f"series-{place % number + 1}"), MARKERS[(place + turn) % number], DASHES[(place + turn) % number]
    )


def legend_handles(names: Iterable[str]) -> list[Line2D]:
    """The entries of a legend for curves with these names, in order."""
    looks = [(curve_style(place), escaped(name, 48)) for place, name in enumerate(names)]
    return [Line2D([], [], **look.line, marker=look.marker, label=label) for look, label in looks]


class Mark(NamedTuple):
    """A place of a plot and the tooltip of its mark; `limit`: it is only an upper limit."""

    x: float
    y: float
    tip: str
    limit: bool = False


def draw_marks(axes: Axes, gid: str, marks: Sequence[Mark], **look: Any) -> dict[str, list[str]]:  # noqa: ANN401
    """Draw marks of one look without a line. Returns their tooltips by the gid; nothing if there are no marks."""
    if not marks:
        return {}
    xs, ys = [mark.x for mark in marks], [mark.y for mark in marks]
    axes.plot(xs, ys, gid=gid, **{**look, "linestyle": "none"})
    return {gid: [mark.tip for mark in marks]}


@contextmanager
def styled() -> Iterator[None]:
    """Within the block, matplotlib draws in the house style."""
    with matplotlib.style.context(["default", SETTINGS]):
        yield


def new_figure(width: float, height: float) -> Figure:
    """A figure of so many points, with a layout that makes room for labels."""
    made = Figure(figsize=(width / 72, height / 72), layout="constrained")
    FigureCanvasAgg(made)  # it measures texts
    return made


def share_layout(figure: Figure, first: Figure | None) -> Figure:
    """Give the axes of a figure the places that they have in the `first` of equal ones; return the first.

    To find a layout takes half of the time of drawing a small plot.
    """
    if first is None:
        figure.draw_without_rendering()
    else:
        for axes, model in zip(figure.axes, first.axes, strict=True):
            axes.set_position(model.get_position())
    figure.set_layout_engine("none")
    return first or figure


_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def power_of_ten(exponent: int) -> str:
    """A power of ten as an axis shows it: 0.01, 0.1, 1, 10, 100, else 10⁻¹²."""
    if -2 <= exponent <= 2:
        return f"{10.0**exponent:g}"
    return f"10{str(exponent).translate(_SUPERSCRIPTS)}"


def _axis_number(value: float) -> str:
    """A number as an axis shows it, of one digit: 0.02, 5, 2·10⁻⁴."""
    exponent = math.floor(math.log10(value) + 1e-9)
    digit = round(value / 10.0**exponent)
    if digit == 1:
        return power_of_ten(exponent)
    return f"{digit * 10.0**exponent:g}" if -3 <= exponent <= 2 else f"{digit}·{power_of_ten(exponent)}"


def ticks(low: float, high: float) -> list[tuple[float, str]]:
    """Places and names on a logarithmic axis: powers of ten, with twos and fives if those are few."""
    powers = [10.0**exponent for exponent in decades(low, high)]
    if len(powers) < 2:
        first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
        for digits in ((1, 2, 5), (1, 2, 3, 4, 5, 6, 8)):
            finer = [digit * 10.0**exponent for exponent in range(first, last + 1) for digit in digits]
            powers = [value for value in finer if low <= value <= high]
            if len(powers) > 1:
                break
    return [(value, _axis_number(value)) for value in powers]


def decades(low: float, high: float, most: int = 7) -> list[int]:
    """Exponents of the powers of ten from `low` to `high`, both positive, at most about `most` of them."""
    first, last = math.ceil(math.log10(low) - 1e-9), math.floor(math.log10(high) + 1e-9)
    step = max(1, -(-(last - first) // most))
    return [exponent for exponent in range(first, last + 1) if exponent % step == 0]


def log_axis(axes: Axes, name: str, low: float, high: float) -> None:
    """Make the axis "x" or "y" logarithmic, with named marks."""
    marks = ticks(low, high)
    getattr(axes, f"set_{name}scale")("log")
    getattr(axes, f"set_{name}lim")(low, high)
    axis = getattr(axes, f"{name}axis")
    axis.set_ticks([value for value, _ in marks], [label for _, label in marks])
    axis.set_ticks([], minor=True)
