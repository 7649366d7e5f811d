"""map.svg: exact positions over the half plane (r, z) of a scene, and where a method is wrong.

matplotlib is an extra; it is loaded here, inside, and used through a figure of its own, without its global state.
"""

from __future__ import annotations

import io
import math
import warnings
from collections.abc import Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from hypcheck.errors import UnavailableError
from hypcheck.record import Line, Record
from hypcheck.report.text import listed
from hypcheck.visible import visible

if TYPE_CHECKING:
    from collections.abc import Iterator

    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from hypcheck.report.write import Around

REGIONS = {"e": ("exterior", "#d7e9f7"), "c": ("contact", "#737373"), "i": ("interior", "#ecc767")}
"""The letters of a map line, their names and colours: told apart by lightness alone, so also without colour."""

WRONG = "#b3001b"
SURFACE = "#1a1a1a"

STYLE = {
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "svg.fonttype": "path",
    "svg.hashsalt": "hypcheck",  # element ids: the same picture is the same file
    "text.parse_math": False,  # a name with dollars in it is no formula
}
"""What differs from matplotlib's defaults; nobody's own settings are used."""


def render(record: Record, _around: Around | None = None) -> bytes:
    """The picture as SVG. Raises UnavailableError where the record has no map or matplotlib is missing."""
    lines = record.of("map")
    if not lines:
        raise UnavailableError("the record has no map")
    with _style(), warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph")  # a name in letters that the font has not
        figure = draw(lines)
        stream = io.BytesIO()
        figure.savefig(stream, format="svg", metadata={"Date": None, "Creator": None}, dpi=160)
    return stream.getvalue()


@contextmanager
def _style() -> Iterator[None]:
    try:
        from matplotlib import style  # noqa: PLC0415
    except ImportError as error:
        reason = f"matplotlib cannot be imported ({visible(error)}); pip install 'hypcheck[report]' brings it"
        raise UnavailableError(reason) from None
    with style.context(["default", STYLE]):
        yield


def draw(lines: Sequence[Line]) -> Figure:
    """A panel for each map line, side by side, under one legend."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg  # noqa: PLC0415
    from matplotlib.figure import Figure  # noqa: PLC0415

    figure = Figure(figsize=(5.4 * len(lines), 6.4), layout="compressed")
    FigureCanvasAgg(figure)
    panels = figure.subplots(1, len(lines), squeeze=False)[0]
    for axes, line in zip(panels, lines, strict=True):
        _panel(axes, line)
    _point_out(panels, lines)
    figure.suptitle("\n".join(dict.fromkeys(map(_scene, lines))), fontsize=10)
    methods = ", ".join(dict.fromkeys(visible(line["method"]) for line in lines))
    handles = _legend(methods, lines)
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), frameon=False)
    return figure


def _panel(axes: Axes, line: Line) -> None:
    import numpy as np  # noqa: PLC0415
    from matplotlib.colors import to_rgb  # noqa: PLC0415

    letters = np.array([list(text) for text in line["lines"]])
    wrong = np.char.isupper(letters)
    image = np.ones((*letters.shape, 3))
    for letter, (_, colour) in REGIONS.items():
        image[np.char.lower(letters) == letter] = to_rgb(colour)
    image[wrong] = to_rgb(WRONG)
    lines, columns = letters.shape
    r, z = (np.linspace(low, high, count) for (low, high), count in ((line["r"], columns), (line["z"], lines)))
    half_r, half_z = (r[1] - r[0]) / 2, (z[1] - z[0]) / 2  # a grid point is the middle of its cell
    extent = (r[0] - half_r, r[-1] + half_r, z[0] - half_z, z[-1] + half_z)
    axes.imshow(image, extent=extent, origin="lower", interpolation="nearest", aspect="equal")
    _surface(axes, line)
    across, up = np.nonzero(wrong.T)  # a cell can be smaller than the eye sees, so each is marked as well
    axes.scatter(r[across], z[up], s=4, marker="s", color=WRONG, linewidths=0, rasterized=True, zorder=3)
    axes.set(xlim=extent[:2], ylim=extent[2:], xlabel="r, distance from the axis (m)", ylabel="z, height (m)")
    axes.set_title(f"{visible(line['name'])}\n{_counts(line)}", fontsize=9)
    axes.ticklabel_format(useOffset=False)


def _counts(line: Line) -> str:
    truths = {letter.lower() for text in line["lines"] for letter in text if letter.isupper()}
    names = listed([name for letter, (name, _) in REGIONS.items() if letter in truths], "or")
    where = f", in truth {names}" if names else ""
    return f"{line['wrong']:,} of {line['points']:,} grid points wrong{where}"


def _scene(line: Line) -> str:
    alpha, gamma, b, d = line["sizes"]
    return f"hyperboloid α = {alpha:g} m, γ = {gamma:g} m; spheroid b = {b:g} m, d = {d:g} m, centred at (r, z)"


def _surface(axes: Axes, line: Line) -> None:
    """The hyperboloid's meridian r = α √(1 + z²/γ²), where the panel shows it."""
    alpha, gamma = line["sizes"][:2]
    low, high = line["z"]
    heights = [low + (high - low) * step / 200 for step in range(201)]
    radii = [alpha * math.hypot(1, z / gamma) for z in heights]
    if min(radii) <= line["r"][1] and max(radii) >= line["r"][0]:
        axes.plot(radii, heights, color=SURFACE, linewidth=0.9, zorder=2)


def _point_out(panels: Sequence[Axes], lines: Sequence[Line]) -> None:
    """Show in a large panel where a small one that lies inside it is."""
    for axes, line in zip(panels, lines, strict=True):
        for small in lines:
            if small is not line and _within(small, line):
                centre = (sum(small["r"]) / 2, sum(small["z"]) / 2)
                axes.plot(*centre, marker="o", markersize=9, markerfacecolor="none", markeredgecolor=SURFACE, zorder=4)
                axes.annotate(
                    f"“{visible(small['name'])}”, see the other panel",
                    centre,
                    xytext=(0, 12),
                    textcoords="offset points",
                    horizontalalignment="right" if centre[0] > sum(line["r"]) / 2 else "left",
                )


def _within(small: Line, large: Line) -> bool:
    return all(large[name][0] <= small[name][0] and small[name][1] <= large[name][1] for name in "rz")


def _legend(methods: str, lines: Sequence[Line]) -> list[Any]:
    from matplotlib.lines import Line2D  # noqa: PLC0415
    from matplotlib.patches import Patch  # noqa: PLC0415

    seen = {letter.lower() for line in lines for text in line["lines"] for letter in text}
    regions = [Patch(facecolor=colour, label=name) for letter, (name, colour) in REGIONS.items() if letter in seen]
    surface = Line2D([], [], color=SURFACE, linewidth=0.9, label="hyperboloid")
    wrong = Line2D([], [], color=WRONG, marker="s", linestyle="none", label=f"wrong answer of {methods}")
    return [*regions, surface, wrong]
