"""The picture that says what the question is: both bodies in a plane through the axis, their sizes, three positions."""

from __future__ import annotations

import math

from matplotlib.axes import Axes
from matplotlib.patches import Ellipse, Rectangle

from hypcheck.geometry.pair import Position
from hypcheck.report.plots.planes import ON_MAP, REGIONS
from hypcheck.report.plots.style import Plot, new_figure
from tests.support.inside import scalar_position as position

ALPHA, GAMMA, B, D = 1.0, 1.5, 0.55, 0.35

CENTRES = ((2.5, 0.55), (1.5, -0.9), (-0.6, -1.35))
"""Centres (x, z) of the three spheroids."""

ASIDE = (0.0, 0.4, 0.0)
"""How far to the right of them their names stand, so that no line crosses one."""

Z_MAX = 1.85
"""Where the wall ends; an open end."""

TOP, SIDE = 2.1, 3.2
"""How far the picture goes, up and to the side."""

GROUND = "#fefefe"
"""Light in both schemes of colours, as the bodies are; pure white would follow the scheme."""

_FILLS = {Position.EXTERIOR: REGIONS["e"][1], Position.CONTACT: "#bdbdbd", Position.INTERIOR: REGIONS["i"][1]}


def plot() -> Plot:
    """The picture; what each spheroid is called, the exact decision says."""
    figure = new_figure(620, 410)
    axes = figure.subplots()
    axes.set(xlim=(-SIDE, SIDE), ylim=(-TOP, TOP), xticks=[], yticks=[], aspect="equal")
    axes.grid(visible=False)
    axes.add_patch(Rectangle((-SIDE, -TOP), 2 * SIDE, 2 * TOP, facecolor=GROUND, zorder=0))
    axes.spines[:].set_visible(False)
    _hyperboloid(axes)
    answers = [Position(position(ALPHA, GAMMA, B, D, x, 0.0, z, z_max=Z_MAX)) for x, z in CENTRES]
    for (x, z), answer, aside in zip(CENTRES, answers, ASIDE, strict=True):
        axes.add_patch(Ellipse((x, z), 2 * B, 2 * D, facecolor=_FILLS[answer], edgecolor=ON_MAP, linewidth=1.4))
        axes.plot([x], [z], marker="o", markersize=3, color=ON_MAP)
        axes.text(x + aside, z - D - 0.07, answer.label, ha="center", va="top", weight="bold", color=ON_MAP)
    _sizes(axes)
    said = (
        f"A plane through the axis of a hyperboloid of one sheet: its waist has the radius α, and at the height γ its "
        f"radius is α√2. Spheroids with the semi-axes b (across) and d (along the axis) stand in three positions: "
        f"{', '.join(answer.label for answer in answers)}. The wall ends at the height z_max. "
        f"Here α = {ALPHA:g}, γ = {GAMMA:g}, b = {B:g}, d = {D:g}, "
        f"z_max = {Z_MAX:g}."
    )
    return Plot("bodies", "A spheroid and a hyperboloid of one sheet", said, figure)


def _hyperboloid(axes: Axes) -> None:
    """Both branches of the meridian up to the end, the inside between them, and the axis."""
    heights = [-TOP + (Z_MAX + TOP) * step / 120 for step in range(121)]
    radii = [ALPHA * math.hypot(1, height / GAMMA) for height in heights]
    axes.fill_betweenx(heights, [-each for each in radii], radii, color="#f7edd3", linewidth=0)
    for side in (-1, 1):
        axes.plot([side * each for each in radii], heights, color=ON_MAP, linewidth=1.8)
    rim = ALPHA * math.hypot(1, Z_MAX / GAMMA)
    axes.plot([-rim, rim], [Z_MAX, Z_MAX], color=ON_MAP, linewidth=0.8, linestyle=(0, (2, 2)))
    axes.text(rim + 0.12, Z_MAX, "z_max, where it may end", ha="left", va="center", color=ON_MAP)
    axes.plot([0, 0], [-TOP, TOP], color=ON_MAP, linewidth=0.8, linestyle=(0, (8, 3, 1, 3)))
    axes.text(-0.06, TOP - 0.08, "axis, z", ha="right", va="top", color=ON_MAP)
    axes.text(-2.0, 1.25, "hyperboloid\nof one sheet", ha="right", va="center", color=ON_MAP)
    axes.plot([-1.95, -ALPHA * math.hypot(1, 1.25 / GAMMA)], [1.25, 1.25], color=ON_MAP, linewidth=0.7)


def _sizes(axes: Axes) -> None:
    """α, γ, b and d as arrows, and the waist."""
    axes.plot([-ALPHA, ALPHA], [0, 0], color=ON_MAP, linewidth=0.8, linestyle=(0, (2, 2)))
    axes.text(-1.95, 0, "waist, z = 0", ha="right", va="center", color=ON_MAP)
    axes.plot([-1.9, -ALPHA], [0, 0], color=ON_MAP, linewidth=0.7)
    axes.plot([0, ALPHA * math.sqrt(2)], [GAMMA, GAMMA], color=ON_MAP, linewidth=0.8, linestyle=(0, (2, 2)))
    axes.text(0.62, GAMMA + 0.06, "radius α√2", ha="center", va="bottom", color=ON_MAP)
    (x, z), *_ = CENTRES
    for start, end, name, offset in (
        ((0, 0), (ALPHA, 0), "α", (0.5, 0.12)),
        ((0, 0), (0, GAMMA), "γ", (-0.13, 0.75)),
        ((x, z), (x + B, z), "b", (x + 0.27, z - 0.13)),
        ((x, z), (x, z + D), "d", (x - 0.1, z + 0.16)),
    ):
        arrow = {"arrowstyle": "-|>", "color": ON_MAP, "linewidth": 1.2, "shrinkA": 0, "shrinkB": 0}
        axes.annotate("", xy=end, xytext=start, arrowprops=arrow)
        axes.text(*offset, name, ha="center", va="center", style="italic", size=13, color=ON_MAP)
    axes.text(x, z + D + 0.09, "spheroid", ha="center", va="bottom", color=ON_MAP)
