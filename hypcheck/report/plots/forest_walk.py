"""Pictures of `simulate forest`: the walk from above with its phantoms, an invisible wall, the forest in space."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Patch

from hypcheck.report.plots import half_plane
from hypcheck.report.plots.style import colour, in_space, mark_contacts, new_figure
from hypcheck.report.plots.svg import Plot

TRUNKS = {1: ("trunk wider than the walker", "series-3"), 2: ("trunk narrower than the walker", "share-1")}
"""The labels of the two types of trees, and their colours, which differ in lightness too."""

_MARKED = "A"
"""The letter of the place that is enlarged."""

_MARKS = {
    "contact": ("rightly refused", "x", 11, "ink"),
    "phantom": ("stopped by a phantom", "*", 100, "clear"),
}
"""The label, the marker, its size and its colour for each kind of stop."""

_RING: dict[str, Any] = {"color": colour("series-1"), "linewidth": 0.9, "linestyle": (0, (5, 2))}
_RING_LABEL = "ring of a tree that stopped her"
_ELEVATION, _AZIMUTH = 34, -58
"""The direction from which the forest in space is seen, in degrees."""

_AROUND = [2 * math.pi * step / 48 for step in range(49)]
_FACETS = 14
_LEVELS = 7


def plots(result: dict[str, Any]) -> Iterator[Plot]:
    """The walk from above, and the forest in space."""
    yield _walk(result)
    yield _space(result)


def _walk(result: dict[str, Any]) -> Plot:
    wall = result["wall"]
    figure = new_figure(760 if wall else 520, 520)
    panels = figure.subplots(1, 2, width_ratios=[1.75, 1]) if wall else [figure.subplots()]
    _above(panels[0], result)
    if wall:
        _wall(panels[1], panels[0], wall)
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=4 if wall else 3)
    steps = result["steps"]
    said = (
        f"{steps['tried']:,} steps of a walker among {len(result['trees'])} trees who obeys Procedure 1 in float32: "
        f"{steps['contact']:,} rightly refused, {steps['phantom']:,} stopped by phantoms, that is, on rings where Δ "
        "vanishes though nothing is near."
    )
    return Plot("forest-walk", "A walk in the forest, and its invisible walls", said, figure)


def _above(axes: Axes, result: dict[str, Any]) -> None:
    level = result["path"][0][2]
    for kind, (label, name) in TRUNKS.items():
        some = [tree for tree in result["trees"] if tree["type"] == kind]
        for place, tree in enumerate(some):
            x, y, z = tree["center"]
            radius = tree["alpha"] * math.hypot(1, (level - z) / tree["gamma"])
            outline = [(x + radius * math.cos(angle), y + radius * math.sin(angle)) for angle in _AROUND]
            xs, ys = zip(*outline, strict=True)
            paint = {"facecolor": colour(name), "edgecolor": colour("ink"), "linewidth": 0.5}
            axes.fill(xs, ys, label="" if place else label, **paint)
    x, y, _ = zip(*result["path"], strict=True)
    axes.plot(x, y, color=colour("soft"), linewidth=0.45, label="walk", zorder=1.5)
    _rings(axes, result["trees"])
    _stops(axes, result["stops"])
    mark_contacts([axes], result["ways"])
    axes.set_aspect("equal")
    axes.set(xlabel="x (m)", ylabel="y (m)")
    axes.grid(visible=False)
    axes.set_title("from above")


def _rings(axes: Axes, trees: list[dict[str, Any]]) -> None:
    """The rings of trees that stopped the walker; each is as thin as a few millimetres."""
    limits = axes.get_xlim(), axes.get_ylim()
    for place, ring in enumerate(_guilty_rings(trees)):
        axes.plot(*ring, **_RING, label="" if place else _RING_LABEL)
    axes.set(xlim=limits[0], ylim=limits[1])


def _guilty_rings(trees: list[dict[str, Any]]) -> Iterator[tuple[list[float], list[float]]]:
    """The rings of the trees that stopped the walker, as x and y."""
    for tree in trees:
        if tree["phantom"] and tree["ring"] is not None:
            x, y, _ = tree["center"]
            yield (
                [x + tree["ring"] * math.cos(angle) for angle in _AROUND],
                [y + tree["ring"] * math.sin(angle) for angle in _AROUND],
            )


def _stops(axes: Axes, stops: list[dict[str, Any]]) -> None:
    for kind, (label, marker, size, paint) in _MARKS.items():
        tried = [stop["tried"][:2] for stop in stops if stop["kind"] == kind]
        if tried:
            x, y = zip(*tried, strict=True)
            axes.scatter(x, y, label=label, marker=marker, s=size, color=colour(paint), linewidths=0.7, zorder=3)


def _wall(axes: Axes, whole: Axes, wall: dict[str, Any]) -> None:
    """The surroundings of a phantom, in millimetres from it, and its place in the whole picture."""
    millimetres = 1000 * wall["half"]
    span = (-millimetres, millimetres)
    colours = {"e": half_plane.FAINT, "E": colour("clear"), "c": colour("ink"), "C": colour("contact")}
    half_plane.paint_letters(axes, wall["lines"], colours, span, span)
    axes.set_aspect("equal")
    axes.set(xlabel=f"x from {_MARKED} (mm)", ylabel=f"y from {_MARKED} (mm)")
    axes.set_title(f"the invisible wall at {_MARKED}")
    paints = {
        "e": (half_plane.FAINT, "free, and float32 says so"),
        "E": (colour("clear"), "free, but float32 says contact"),
    }
    seen = {letter for line in wall["lines"] for letter in line}
    handles = [Patch(facecolor=paint, label=label) for letter, (paint, label) in paints.items() if letter in seen]
    axes.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, -0.24), fontsize=9)
    x, y, _ = wall["center"]
    whole.annotate(
        _MARKED,
        (x, y),
        xytext=(9, 6),
        textcoords="offset points",
        fontweight="bold",
        bbox={"facecolor": colour("surface"), "edgecolor": "none", "pad": 1},
        zorder=4,
    )


def _space(result: dict[str, Any]) -> Plot:
    figure = new_figure(760, 480)
    whole: Any = figure.subfigures()
    axes = whole.add_axes((-0.12, -0.16, 1.22, 1.42), projection="3d")  # wider than what is drawn in it
    axes.patch.set_visible(False)
    axes.computed_zorder = False  # by parts it would hide marks behind trunks
    axes.view_init(elev=_ELEVATION, azim=_AZIMUTH)
    for tree in sorted(result["trees"], key=_nearness):
        _trunk(axes, tree, colour(TRUNKS[tree["type"]][1]))
    foot = result["path"][0][2] - result["walker"]["d"]
    x, y, _ = zip(*result["path"], strict=True)
    axes.plot(x, y, [foot] * len(x), color=colour("soft"), linewidth=0.45, label="walk, on the ground")
    for kind, (label, marker, size, paint) in _MARKS.items():
        tried = [stop["tried"] for stop in result["stops"] if stop["kind"] == kind]
        if tried:
            columns = zip(*tried, strict=True)
            axes.scatter(*columns, marker=marker, s=size, color=colour(paint), depthshade=False, label=label, zorder=5)
    for place, ring in enumerate(_guilty_rings(result["trees"])):
        axes.plot(*ring, result["path"][0][2], **_RING, label="" if place else _RING_LABEL)
    mark_contacts([axes], result["ways"])
    axes.set_box_aspect((1, 1, 0.32), zoom=0.84)
    axes.set(xlabel="x (m)", ylabel="y (m)", zlabel="z (m)")
    in_space(axes)
    trunks = [Patch(facecolor=colour(paint), edgecolor=colour("ink"), label=label) for label, paint in TRUNKS.values()]
    handles, _ = axes.get_legend_handles_labels()
    figure.legend(handles=[*trunks, *handles], loc="outside lower center", ncols=3)
    said = f"{len(result['trees'])} trunks as hyperboloids of one sheet, the walk on the ground, and where it stopped."
    return Plot("forest-space", "The forest in space", said, figure)


def _nearness(tree: dict[str, Any]) -> float:
    """How near a tree is to the viewer of the forest in space; trees that are drawn later hide earlier ones."""
    angle = math.radians(_AZIMUTH)
    return float(tree["center"][0]) * math.cos(angle) + float(tree["center"][1]) * math.sin(angle)


def _trunk(axes: Any, tree: dict[str, Any], paint: str) -> None:  # noqa: ANN401 - axes in space
    x, y, z = tree["center"]
    low, high = tree["height"] or (-tree["gamma"], tree["gamma"])
    height, angle = np.meshgrid(np.linspace(low, high, _LEVELS), np.linspace(0, 2 * np.pi, _FACETS), indexing="ij")
    radius = tree["alpha"] * np.hypot(1, height / tree["gamma"])
    surface = axes.plot_surface(
        x + radius * np.cos(angle),
        y + radius * np.sin(angle),
        z + height,
        color=paint,
        linewidth=0,
        rcount=_LEVELS,
        zorder=3,
    )
    surface.set_rasterized(True)  # thousands of facets are smaller as a picture
