"""Names beside points, where they cover neither each other nor a point; the others have their tooltips alone."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from hypcheck.report.plots.style import colour

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_PLACES = (
    (7, 0, "left", "center"),
    (-7, 0, "right", "center"),
    (0, 7, "center", "bottom"),
    (0, -7, "center", "top"),
    (6, 6, "left", "bottom"),
    (-6, 6, "right", "bottom"),
    (6, -6, "left", "top"),
    (-6, -6, "right", "top"),
    (14, 14, "left", "bottom"),
    (-14, 14, "right", "bottom"),
    (14, -14, "left", "top"),
    (-14, -14, "right", "top"),
    (22, 22, "left", "bottom"),
    (22, -22, "left", "top"),
    (8, 30, "left", "bottom"),
    (8, -30, "left", "top"),
)
"""Where a name may stand: points to the right and up, and which part of it stands there. The first that is free."""

_NEAR = 8
"""The first so many of them, of which nobody doubts whose name it is."""

_MARK = 4.0
"""Half the size of a point's mark, in points."""

_BETWEEN = 1.5
"""Points kept free on each side of a name."""


def place(
    axes: Axes,
    points: Sequence[tuple[float, float]],
    names: Sequence[str | None],
    lines: Sequence[tuple[tuple[float, float], tuple[float, float]]] = (),
    important: int | None = None,
) -> None:
    """Write each point's name, those of None left out, in that order of importance. The limits must be set before.

    `lines` are level or upright and are kept free too. Behind the `important` first a name stands next to its point or
    nowhere.
    """
    from matplotlib.text import Text  # noqa: PLC0415
    from matplotlib.transforms import Bbox  # noqa: PLC0415

    figure: Any = axes.figure
    figure.canvas.draw()  # the layout decides where things are, and stays as it is from here on
    figure.set_layout_engine("none")
    renderer = figure.canvas.get_renderer()
    scale = figure.dpi / 72
    inside = axes.get_window_extent(renderer)
    centres = [axes.transData.transform(point) for point in points]
    half = _MARK * scale
    taken = [Bbox.from_extents(x - half, y - half, x + half, y + half) for x, y in centres]
    for start, end in lines:
        (x0, y0), (x1, y1) = (axes.transData.transform(point) for point in (start, end))
        taken.append(Bbox.from_extents(min(x0, x1) - 1, min(y0, y1) - 1, max(x0, x1) + 1, max(y0, y1) + 1))
    for rank, (point, name) in enumerate(zip(points, names, strict=True)):
        if name is None:
            continue
        near = important is not None and rank >= important
        for number, (right, up, across, upward) in enumerate(_PLACES[: _NEAR if near else None]):
            text = axes.annotate(
                name,
                point,
                xytext=(right, up),
                textcoords="offset points",
                horizontalalignment=across,
                verticalalignment=upward,
                fontsize=9,
                arrowprops=None if number < _NEAR else _leader(across, upward),
            )
            text.update_positions(renderer)
            box = Text.get_window_extent(text, renderer).padded(_BETWEEN * scale, 0)  # without the line to the point
            if _within(box, inside) and not any(box.overlaps(other) for other in taken):
                taken.append(box)
                break
            text.remove()


def _leader(across: str, upward: str) -> dict[str, Any]:
    """The line from the corner of a name that stands farther away to its point."""
    corner = (0.0 if across == "left" else 1.0, 0.0 if upward == "bottom" else 1.0)
    return {"arrowstyle": "-", "relpos": corner, "linewidth": 0.7, "color": colour("soft"), "shrinkA": 0, "shrinkB": 3}


def _within(box: Any, outer: Any) -> bool:  # noqa: ANN401 - matplotlib's boxes
    return bool(box.x0 >= outer.x0 and box.x1 <= outer.x1 and box.y0 >= outer.y0 and box.y1 <= outer.y1)
