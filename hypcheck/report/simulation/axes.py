"""What pictures of simulations have in common."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from hypcheck.report.plots.style import colour


def in_space(axes: Any) -> None:  # noqa: ANN401 - axes in space, of a class that matplotlib does not type
    """Walls that are not painted, for light and dark ground alike, and numbers that keep off the axes."""
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_pane_color((1.0, 1.0, 1.0, 0.0))
    axes.tick_params(labelsize=9, pad=1)
    axes.tick_params(axis="z", pad=7)
    axes.zaxis.labelpad = 9


def mark_contacts(axes: Iterable[Any], ways: dict[str, Any] | None) -> None:
    """Where the mover's centre is at first contacts on the way, in axes of the plane or in space; none if not asked."""
    points = [
        [here + contact["first_upper"] * (there - here) for here, there in zip(*_ends(contact), strict=True)]
        for contact in (ways["contacts"] if ways else [])
    ]
    if not points:
        return
    columns = list(zip(*points, strict=True))
    for each in axes:
        each.plot(
            *columns[: 3 if each.name == "3d" else 2],
            linestyle="none",
            marker="P",
            markersize=7,
            color=colour("series-4"),
            label="first contact on the way",
            zorder=5,
        )


def _ends(contact: dict[str, Any]) -> tuple[list[float], list[float]]:
    return contact["start"], contact["end"]
