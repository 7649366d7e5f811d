"""The picture of a landing on the rim: two trees that end, and a drone that sinks onto the top of the lower one."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.patches import Ellipse, Polygon, Rectangle

from hypcheck import passage, position
from hypcheck.geometry.pair import Position
from hypcheck.report.plots.planes import ON_MAP, REGIONS
from hypcheck.report.plots.style import Plot, new_figure
from hypcheck.scene.model import Hyperboloid, SceneModel
from hypcheck.scene.reading import read_scene

SCENE = Path(__file__).resolve().parents[3] / "docs" / "simulate" / "two-trees.toml"
FROM, TO = 3.2, 2.01
"""Heights of the drone's centre at both ends of its way, which is above the rim."""

LEFT, RIGHT, BOTTOM, TOP = -1.7, 4.9, -1.35, 4.6
GROUND = "#fefefe"
_FILLS = {Position.EXTERIOR: REGIONS["e"][1], Position.CONTACT: "#bdbdbd", Position.INTERIOR: REGIONS["i"][1]}


@cache
def scene() -> SceneModel:
    """The two trees and the drone."""
    return read_scene(str(SCENE))


def low_tree() -> tuple[tuple[float, float, float, float], dict[str, Any]]:
    """The sizes of the lower tree and the drone, and where the tree ends."""
    tree, mover = scene().hyperboloids[0], scene().mover
    assert tree.height is not None
    ends = {"z_min": tree.height.low, "z_max": tree.height.high, "solid": tree.solid}
    return (tree.alpha, tree.gamma, mover.b, mover.d), ends


def landing() -> tuple[float, float]:
    """The radius of the lower tree's rim, above which the way is, and the height of the centre at the first contact."""
    sizes, ends = low_tree()
    x = sizes[0] * math.hypot(1, ends["z_max"] / sizes[1])
    way = passage(sizes, (x, 0.0, FROM), (x, 0.0, TO), **ends)
    assert way.hit
    return x, FROM + way.first_lower * (TO - FROM)


def answer(x: float, z: float) -> Position:
    """The drone's exact position beside the lower tree."""
    sizes, ends = low_tree()
    return Position(position(*sizes, x, 0.0, z, **ends))


def plot() -> Plot:
    """The picture; what is said of the drone, the exact decisions say."""
    figure = new_figure(620, 480)
    axes = figure.subplots()
    axes.set(xlim=(LEFT, RIGHT), ylim=(BOTTOM, TOP), xticks=[], yticks=[], aspect="equal")
    axes.grid(visible=False)
    axes.add_patch(Rectangle((LEFT, BOTTOM), RIGHT - LEFT, TOP - BOTTOM, facecolor=GROUND, zorder=0))
    axes.spines[:].set_visible(False)
    for tree in scene().hyperboloids:
        _trunk(axes, tree)
    x, first = landing()
    _drone(axes, (x, FROM), answer(x, FROM), f"z = {FROM:g}: {answer(x, FROM).label}")
    _drone(axes, (x, first), Position.CONTACT, f"first contact, z = {first:.2f}")
    _drone(axes, (x, TO), answer(x, TO), f"z = {TO:g}: {answer(x, TO).label}")
    arrow = {"arrowstyle": "-|>", "color": ON_MAP, "linewidth": 1.2, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", xy=(x, TO), xytext=(x, FROM), arrowprops=arrow)
    end = low_tree()[1]["z_max"]
    axes.text(-0.6, end + 0.04, f"z_max = {end:g}", ha="right", va="bottom", color=ON_MAP)
    axes.plot([-1.6, 0], [end, end], color=ON_MAP, linewidth=0.8, linestyle=(0, (2, 2)))
    high = scene().hyperboloids[1].height
    assert high is not None
    said = (
        f"Two trees of one shape that end at z = {end:g} and z = {high.high:g}, and a drone that sinks onto the rim of "
        f"the lower one: it touches first where its centre is at z = {first:.2f}, and at z = {TO:g} it is in contact. "
        f"Its centre is above the tree all the way, so the height of the centre alone would not ask about it."
    )
    return Plot("landing", "A drone that lands on the rim of a tree", said, figure)


def _trunk(axes: Axes, tree: Hyperboloid) -> None:
    """The trunk between its heights, or as far as the picture goes."""
    assert tree.height is not None
    low, high = max(tree.height.low, BOTTOM), min(tree.height.high, TOP)
    heights = [low + (high - low) * step / 80 for step in range(81)]
    radii = [tree.alpha * math.hypot(1, height / tree.gamma) for height in heights]
    center = tree.center[0]
    right = [(center + radius, height) for radius, height in zip(radii, heights, strict=True)]
    left = [(center - radius, height) for radius, height in zip(radii, heights, strict=True)]
    outline = [*right, *reversed(left)]
    axes.add_patch(Polygon(outline, closed=True, facecolor="#f7edd3", edgecolor=ON_MAP, linewidth=1.6))
    axes.text(center, low - 0.05, tree.name, ha="center", va="top", color=ON_MAP)


def _drone(axes: Axes, at: tuple[float, float], its: Position, words: str) -> None:
    (x, z), mover = at, scene().mover
    axes.add_patch(Ellipse(at, 2 * mover.b, 2 * mover.d, facecolor=_FILLS[its], edgecolor=ON_MAP, linewidth=1.2))
    axes.plot([x], [z], marker="o", markersize=3, color=ON_MAP)
    axes.text(x + mover.b + 0.08, z, words, ha="left", va="center", color=ON_MAP)
