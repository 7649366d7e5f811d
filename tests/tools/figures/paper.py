"""The paper's Figures 1 to 3 redrawn from the results of the two simulations.

Figure 4 is the picture of flights that `hypcheck simulate tower` draws.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Patch

from hypcheck.report.plots.simulations import TRUNKS, axes_in_space
from hypcheck.report.plots.style import Plot, colour, new_figure

SIGHT = 4.2
"""How far from the walker trees are drawn in Figure 1, in metres."""

APART = 0.1415
"""An arm with which the paper's rotors are apart and inside the body, in metres."""

TOURISTIC: dict[str, Any] = {"alpha": 4.0, "gamma": 11.0, "height": (-14.0, 9.0)}
"""The second tower of Figure 2; the paper gives no size of it, so these are ours."""


def plots(forest: dict[str, Any], tower: dict[str, Any]) -> Iterator[Plot]:
    """Figures 1, 2 and 3."""
    yield _walker(forest)
    yield _towers(tower["assumptions"])
    yield _quadcopter(tower["assumptions"])


def _walker(forest: dict[str, Any]) -> Plot:
    figure = new_figure(560, 360)
    whole: Any = figure.subfigures()
    axes: Any = axes_in_space(whole, (-0.12, -0.02, 1.18, 1.16), 16, -60)
    axes.computed_zorder = False
    at = _busiest(forest)
    near = [tree for tree in forest["trees"] if math.dist(tree["center"][:2], at[:2]) < SIGHT]
    nearness = sorted(near, key=lambda tree: tree["center"][0] * math.cos(1.05) - tree["center"][1] * math.sin(1.05))
    low, high = at[2] - forest["walker"]["d"], at[2] + 2.2
    for tree in nearness:
        _revolved(axes, _hyperboloid(tree, low, high), tree["center"][:2], colour(TRUNKS[tree["type"]][1]), alpha=0.9)
    _spheroid(axes, at, forest["walker"]["b"], forest["walker"]["d"], colour("contact"))
    _person(axes, at, forest["walker"]["d"])
    axes.set(xlim=(at[0] - 4, at[0] + 4), ylim=(at[1] - 4, at[1] + 4), zlim=(low, high))
    axes.set_box_aspect((8, 8, high - low), zoom=1.08)
    handles = [Patch(facecolor=colour(paint), edgecolor=colour("ink"), label=label) for label, paint in TRUNKS.values()]
    handles.append(Patch(facecolor="none", edgecolor=colour("contact"), label="her spheroid"))
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    kinds = sorted({tree["type"] for tree in near})
    said = (
        f"A walker in her spheroid (b = {forest['walker']['b']:g} m, d = {forest['walker']['d']:g} m) among "
        f"{len(near)} trunks of types {' and '.join(map(str, kinds))}: wider than she is (α/b ≥ 1), and narrower. She "
        "stands where the shipped forest has most trees of both types about a place of her walk."
    )
    return Plot("figure-1", "The paper's Figure 1: a walker among trees", said, figure)


def _busiest(forest: dict[str, Any]) -> list[float]:
    """The place of the walk with most trees in sight, of the rarer type first."""

    def seen(place: list[float]) -> tuple[int, int]:
        types = [tree["type"] for tree in forest["trees"] if math.dist(tree["center"][:2], place[:2]) < SIGHT * 0.9]
        return min(types.count(1), types.count(2)), len(types)

    return max(forest["path"], key=seen)


def _towers(assumptions: dict[str, Any]) -> Plot:
    figure = new_figure(600, 420)
    whole: Any = figure.subfigures()
    low, high = assumptions["height"] or (-assumptions["gamma"], assumptions["gamma"])
    cooling = {"alpha": assumptions["alpha"], "gamma": assumptions["gamma"], "center": (0, 0, 0)}
    touristic = {**TOURISTIC, "center": (0, 0, 0)}
    for place, (title, tower, span, scale) in enumerate(
        (
            ("cooling tower (section 4's sizes)", cooling, (low, high), (3.0, 3.0, 2 * 17.8 / 3)),
            ("touristic tower (sizes are ours)", touristic, TOURISTIC["height"], None),
        )
    ):
        axes: Any = axes_in_space(whole, (0.5 * place - 0.02, -0.04, 0.54, 1.08), 12, -60)
        solid = _hyperboloid(tower, span[0], span[1])
        inside = [(radius * 0.92, height) for radius, height in solid]
        _revolved(axes, inside, (0, 0), colour("share-0"), alpha=1.0)
        _wires(axes, solid)
        widest = max(radius for radius, _ in solid)
        axes.set_box_aspect((1, 1, 2.2) if scale else (2 * widest, 2 * widest, span[1] - span[0]), zoom=0.95)
        axes.set_xticks([-int(widest), 0, int(widest)])
        axes.set_yticks([-int(widest), 0, int(widest)])
        figure.text(0.25 + 0.5 * place, 0.975, title, ha="center", va="top")
    said = (
        f"Two towers in their bounding hyperboloids of one sheet. Left: α = {assumptions['alpha']:g} m, γ = "
        f"{assumptions['gamma']:g} m as in section 4, z drawn shorter. Right: a touristic tower, to scale; the paper "
        f"gives no sizes of it, and these are ours: α = {TOURISTIC['alpha']:g} m, γ = {TOURISTIC['gamma']:g} m."
    )
    return Plot("figure-2", "The paper's Figure 2: hyperboloid structures", said, figure)


def _quadcopter(assumptions: dict[str, Any]) -> Plot:
    figure = new_figure(760, 400)
    halves: Any = figure.subfigures(1, 2, width_ratios=[1, 1.15])
    axes: Any = axes_in_space(halves[0], (0.0, 0.06, 0.86, 0.92), 24, -50)
    b, d, small_b, small_d, arm = (assumptions[name] for name in ("b", "d", "b_s", "d_s", "l"))
    for x, y in _rotors(arm):
        _spheroid(axes, (x, y, 0.0), small_b, small_d, colour("series-3"), solid=True)
        axes.plot([0, x], [0, y], [0, 0], color=colour("ink"), linewidth=1.6)
    _spheroid(axes, (0.0, 0.0, 0.0), b, d, colour("contact"))
    axes.set_box_aspect((2 * b, 2 * b, 2 * d), zoom=0.95)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_ticks([-0.2, 0.0, 0.2] if axis is not axes.zaxis else [-0.1, 0.0, 0.1])
    halves[0].text(0.44, 0.9, f"in space, to scale, l = {arm:g} m", ha="center", va="top")
    panels = halves[1].subplots(1, 2, sharey=True)
    for panel, length in zip(panels, (arm, APART), strict=True):
        _from_above(panel, assumptions, length)
    panels[0].set_ylabel("y (m)")
    handles = [
        Patch(facecolor="none", edgecolor=colour("contact"), label="the body's spheroid"),
        Patch(facecolor=colour("series-3"), alpha=0.35, label="a rotor's"),
        Patch(facecolor=colour("side"), label="where two rotors overlap"),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    said = (
        f"A body (b = {b:g} m, d = {d:g} m) and four rotors (b_s = {small_b:g} m, d_s = {small_d:g} m) to scale, in "
        f"space and from above. With l = {arm:g} m, which is fitted to Table 5, neighbours are "
        f"{arm * math.sqrt(2):.3f} m apart and overlap; "
        f"with l = {APART:g} m they are {APART * math.sqrt(2):.4f} m apart, more than 2 b_s."
    )
    return Plot("figure-3", "The paper's Figure 3: a quadcopter in five spheroids", said, figure)


def _rotors(arm: float) -> list[tuple[float, float]]:
    return [(arm * math.cos(turn * math.pi / 2), arm * math.sin(turn * math.pi / 2)) for turn in range(4)]


def _from_above(axes: Axes, assumptions: dict[str, Any], arm: float) -> None:
    small = assumptions["b_s"]
    axes.add_patch(Circle((0, 0), assumptions["b"], facecolor="none", edgecolor=colour("contact"), linewidth=1.4))
    rotors = _rotors(arm)
    for place, centre in enumerate(rotors):
        axes.add_patch(Circle(centre, small, facecolor=colour("series-3"), alpha=0.35))
        axes.add_patch(Circle(centre, small, facecolor="none", edgecolor=colour("series-3"), linewidth=1.2))
        axes.plot(*zip((0, 0), centre, strict=True), color=colour("ink"), linewidth=1.2)
        lens = _lens(centre, rotors[(place + 1) % len(rotors)], small)
        if lens:
            axes.fill(*zip(*lens, strict=True), facecolor=colour("side"), edgecolor="none", zorder=3)
    axes.set_aspect("equal")
    axes.set(xlim=(-0.27, 0.27), ylim=(-0.27, 0.27), xlabel="x (m)", xticks=[-0.2, 0, 0.2], yticks=[-0.2, 0, 0.2])
    gap = arm * math.sqrt(2) - 2 * small
    axes.set_title(f"l = {arm:g} m: {'overlap' if gap < 0 else 'apart'}, {1000 * gap:+.1f} mm".replace("-", "−"))


def _lens(one: tuple[float, float], other: tuple[float, float], radius: float) -> list[tuple[float, float]]:
    """The outline of what two equal discs have in common; empty where that is nothing."""
    distance = math.dist(one, other)
    if distance >= 2 * radius:
        return []
    half = math.acos(distance / (2 * radius))
    outline = []
    for centre, toward in ((one, other), (other, one)):
        middle = math.atan2(toward[1] - centre[1], toward[0] - centre[0])
        angles = [middle + half * (step / 10 - 1) for step in range(21)]
        outline += [(centre[0] + radius * math.cos(each), centre[1] + radius * math.sin(each)) for each in angles]
    return outline


def _hyperboloid(body: dict[str, Any], low: float, high: float) -> list[tuple[float, float]]:
    """Radii and heights of the surface between two heights, 21 of them."""
    heights = [low + (high - low) * step / 20 for step in range(21)]
    middle = body["center"][2]
    return [(body["alpha"] * math.hypot(1, (height - middle) / body["gamma"]), height) for height in heights]


def _revolved(axes: Any, profile: list[tuple[float, float]], centre: Any, paint: str, alpha: float) -> None:
    radius, height = (np.array(column)[:, None] for column in zip(*profile, strict=True))
    angle = np.linspace(0, 2 * np.pi, 33)[None, :]
    surface = axes.plot_surface(
        centre[0] + radius * np.cos(angle),
        centre[1] + radius * np.sin(angle),
        height + 0 * angle,
        color=paint,
        alpha=alpha,
        linewidth=0,
    )
    surface.set_rasterized(True)


def _wires(axes: Any, profile: list[tuple[float, float]]) -> None:
    radius, height = (np.array(column)[:, None] for column in zip(*profile, strict=True))
    angle = np.linspace(0, 2 * np.pi, 25)[None, :]
    axes.plot_wireframe(
        radius * np.cos(angle),
        radius * np.sin(angle),
        height + 0 * angle,
        color=colour("contact"),
        linewidth=0.5,
        rstride=2,
        cstride=1,
    )


def _spheroid(axes: Any, centre: Any, b: float, d: float, paint: str, *, solid: bool = False) -> None:
    up, angle = np.meshgrid(np.linspace(-np.pi / 2, np.pi / 2, 13), np.linspace(0, 2 * np.pi, 25), indexing="ij")
    x, y = centre[0] + b * np.cos(up) * np.cos(angle), centre[1] + b * np.cos(up) * np.sin(angle)
    z = centre[2] + d * np.sin(up)
    if solid:
        axes.plot_surface(x, y, z, color=paint, alpha=0.85, linewidth=0).set_rasterized(True)
    else:
        axes.plot_wireframe(x, y, z, color=paint, linewidth=0.6, zorder=5)


def _person(axes: Any, at: list[float], d: float) -> None:
    """A figure of lines in her spheroid: it says who the spheroid stands for."""
    x, y, z = at
    ink = {"color": colour("ink"), "linewidth": 2, "zorder": 4}
    for start, end in (
        ((0, -0.1), (0, 0.5)),
        ((0, -0.1), (-0.11, -0.75)),
        ((0, -0.1), (0.11, -0.75)),
        ((0, 0.4), (-0.18, 0.0)),
        ((0, 0.4), (0.18, 0.0)),
    ):
        axes.plot([x + start[0], x + end[0]], [y, y], [z + start[1] * d, z + end[1] * d], **ink)
    axes.scatter([x], [y], [z + 0.64 * d], s=42, color=colour("ink"), depthshade=False, zorder=4)
