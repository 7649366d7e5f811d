"""Error against run time: the distance above which a method is reliable, its cost, and the front of unbeaten methods.

For methods for sweeps, the share of missed and of false contacts is drawn instead of the distance. The methods of the
front and the user's methods have names; the other points have tooltips.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from hypcheck.messages import escaped
from hypcheck.record import Record
from hypcheck.report import measured
from hypcheck.report.messages import figure
from hypcheck.report.plots import style

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
"""The places of a name, the first free one is taken: points to the right and up, and the alignment there."""

_NEAR = 8
"""The number of the first places that are so near that the name clearly belongs to the point."""

_MARK = 4.0
"""Half the size of a point's mark, in points."""

_BETWEEN = 1.5
"""Points kept free on each side of a name."""


Coordinates = tuple[float, float]


def place_labels(
    axes: Axes,
    points: Sequence[Coordinates],
    names: Sequence[str | None],
    lines: Sequence[tuple[Coordinates, Coordinates]] = (),
    important: int | None = None,
) -> None:
    """Write the name of each point (None: no name), the most important first. The axes' limits must be set before.

    `lines` are horizontal or vertical; names do not cover them. After the first `important` names, a name is placed
    next to its point or left out.
    """
    figure: Any = axes.figure
    figure.draw_without_rendering()  # computes the layout, which must not change later
    figure.set_layout_engine("none")
    renderer = figure.canvas.get_renderer()
    scale = figure.dpi / 72
    inside = axes.get_window_extent(renderer)
    centres = [axes.transData.transform(point) for point in points]
    half = _MARK * scale
    occupied = [Bbox.from_extents(x - half, y - half, x + half, y + half) for x, y in centres]
    for start, end in lines:
        (x0, y0), (x1, y1) = (axes.transData.transform(point) for point in (start, end))
        occupied.append(Bbox.from_extents(min(x0, x1) - 1, min(y0, y1) - 1, max(x0, x1) + 1, max(y0, y1) + 1))
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
            if _within(box, inside) and not any(box.overlaps(other) for other in occupied):
                occupied.append(box)
                break
            text.remove()


def _leader(across: str, upward: str) -> dict[str, Any]:
    """Return the style of the line to the point, from the corner of a name that is not next to it."""
    corner = (0.0 if across == "left" else 1.0, 0.0 if upward == "bottom" else 1.0)
    return {
        "arrowstyle": "-",
        "relpos": corner,
        "linewidth": 0.7,
        "color": style.colour("soft"),
        "shrinkA": 0,
        "shrinkB": 3,
    }


def _within(box: Any, outer: Any) -> bool:  # noqa: ANN401 - matplotlib's boxes
    """Decide whether a box lies within another one."""
    return bool(box.x0 >= outer.x0 and box.x1 <= outer.x1 and box.y0 >= outer.y0 and box.y1 <= outer.y1)


ENOUGH = 3000
"""The number n of right answers without a wrong one that shows, at 95 %, that at most 1 in 1000 is wrong: 3/n."""


@dataclass(frozen=True, slots=True)
class MethodMark:
    """The mark of a method; `shown`: enough answers were judged."""

    name: str
    tier: str
    exact: bool
    mark: style.Mark
    shown: bool = True


def _draw_methods(axes: Axes, name: str, methods: Sequence[MethodMark]) -> dict[str, list[str]]:
    """Draw the marks, the fastest tier on top, with a ring around marks of exact methods; return the tooltips."""
    exact = [method.mark for method in methods if method.exact]
    axes.plot([mark.x for mark in exact], [mark.y for mark in exact], **RING)
    tips: dict[str, list[str]] = {}
    for number, tier in reversed(list(enumerate(measured.TIERS))):
        for shown in (True, False):
            mine = [method.mark for method in methods if (method.tier, method.shown) == (tier, shown)]
            tips |= style.draw_marks(axes, f"{name}-{number}-{shown}", mine, **_mark_style(number, shown=shown))
    return tips


def _mark_style(number: int, *, shown: bool) -> dict[str, Any]:
    """Return the style of a tier's mark; it is hollow if too few answers were judged to show 1 wrong in 1000."""
    own = style.colour(f"series-{number + 1}")
    face = own if shown else style.colour("surface")
    return {"marker": style.MARKERS[number], "markersize": 6, "markeredgecolor": own, "markerfacecolor": face}


RING: dict[str, Any] = {
    "marker": "o",
    "markersize": 10.5,
    "markerfacecolor": "none",
    "markeredgecolor": style.colour("ink"),
    "markeredgewidth": 0.9,
    "linestyle": "none",
}
"""The style of the ring around the mark of a method that promises never to be wrong."""


def _legend(drawn: Figure, methods: Sequence[MethodMark], *others: Line2D) -> None:
    """Draw the legend: the tiers above the axes; below them other entries, the ring and the hollow marks."""
    handles = [
        Line2D([], [], linestyle="none", label=tier, **_mark_style(number, shown=True))
        for number, tier in enumerate(measured.TIERS)
        if any(method.tier == tier for method in methods)
    ]
    drawn.legend(handles=handles, loc="outside upper left", ncols=5, handlelength=1.2)
    below = [*others]
    if any(method.exact for method in methods):
        below.append(Line2D([], [], label="ringed: promises never to be wrong", **RING))
    if not all(method.shown for method in methods):
        soft: dict[str, Any] = {"markeredgecolor": style.colour("soft"), "markerfacecolor": style.colour("surface")}
        few = f"hollow: under {ENOUGH:,} answers judged, too few to show 1 in 1000"
        below.append(Line2D([], [], linestyle="none", marker="o", markersize=6, label=few, **soft))
    if below:
        drawn.legend(handles=below, loc="outside lower left")


@dataclass(frozen=True, slots=True)
class ParetoPoint:
    """A method: nanoseconds a row, and the distance above which at most 1 answer in 1000 is wrong (0: none)."""

    name: str
    tier: str
    time_ns: float
    reliable_above: float
    asked: int
    exact: bool
    label: str = ""
    foreign: bool = False

    @property
    def shown(self) -> bool:
        """Whether enough answers were judged to show 1 wrong in 1000 (3/n ≤ 1/1000)."""
        return self.asked >= ENOUGH

    @property
    def tip(self) -> str:
        """The tooltip of its mark."""
        reliable = {0.0: "none wrong", math.inf: "reliable at no distance"}.get(
            self.reliable_above, f"at most 1 in 1000 wrong above {figure(self.reliable_above)}"
        )
        return f"{self.name}, {figure(self.time_ns)} ns, {reliable} (of {self.asked:,})"


def points(record: Record, workload: str, *, everywhere: bool = False) -> list[ParetoPoint]:
    """Return the methods that were judged and timed on the workload; `everywhere`: with the errors of all workloads."""
    marks = []
    for method in measured.measured_methods(record):
        speed, here = method.speed.get((workload, measured.BATCH)), method.accuracy.get(workload)
        if speed is None or measured.lost(speed) or here is None:
            continue
        errors = method if everywhere else here
        reliable_above, time_ns = errors.reliable_above, speed.median_ns
        place = (time_ns, reliable_above, errors.asked)
        marks.append(ParetoPoint(method.name, method.tier, *place, method.exact, method.label, method.foreign))
    return marks


def front(candidates: Sequence[ParetoPoint]) -> list[ParetoPoint]:
    """Return the points that no other point beats: from the fastest on, each is more reliable than all faster ones."""
    best, kept = math.inf, []
    for point in sorted(candidates, key=lambda point: (point.time_ns, point.reliable_above)):
        if point.reliable_above < best:
            best = point.reliable_above
            kept.append(point)
    return kept


def pareto_plots(record: Record) -> Iterator[style.Plot]:
    """Yield a plot for each timed workload; if there are several, without the workload of `front_plots`."""
    found_on = {name: methods for name in measured.workloads(record) if (methods := points(record, name))}
    for place, (name, line) in enumerate(measured.workloads(record).items()):
        methods = found_on.get(name, [])
        if methods and (name != measured.principal(record) or len(found_on) == 1):
            yield _plot(f"pareto-{place}", f"Error against run time, {line.title}", methods)


def front_plots(record: Record) -> Iterator[style.Plot]:
    """Yield two plots: for the workload near contact, and for the worst of all workloads.

    For a benchmark of sweeps: missed contacts, and false contacts.
    """
    if measured.sweep_totals(record):
        yield from _sweep_plots(record)
        return
    known, name = measured.workloads(record), measured.principal(record)
    near, everywhere = points(record, name), points(record, name, everywhere=True)
    if near:
        where = known[name].title
        yield _plot("front-near", where.capitalize(), near, 400, timed=where)
        yield _plot("front-all", f"On the worst of {len(known)} workloads", everywhere, 400, timed=where)


def _plot(name: str, title: str, methods: Sequence[ParetoPoint], height: float = 375, timed: str = "") -> style.Plot:
    """Draw a plot with names of the front's and the user's methods, or of all if they are few; others have tooltips.

    `timed` names the workload of the times if the title does not.
    """
    drawn = style.new_figure(style.WIDTH, height)
    axes = drawn.subplots()
    best = front(methods)
    heights = _axes(axes, methods, timed)
    steps = _steps(best, heights, axes.get_xlim()[1])
    for (x0, y0), (x1, y1) in steps:
        axes.plot((x0, x1), (y0, y1), color=style.colour("soft"), linewidth=1.2, linestyle=style.DASHES[1], zorder=1.5)
    marks = [
        MethodMark(
            method.name,
            method.tier,
            method.exact,
            style.Mark(method.time_ns, heights[method.reliable_above], method.tip),
            method.shown,
        )
        for method in methods
    ]
    tips = _draw_methods(axes, name, marks)
    _legend(drawn, marks, Line2D([], [], color=style.colour("soft"), linestyle=style.DASHES[1], label=_UNBEATEN))
    important = sorted(methods, key=lambda point: (not point.foreign, point not in best, point.time_ns))
    first = sum(point.foreign or point in best for point in methods)
    names = [point.label if place < first or len(methods) <= _FEW else None for place, point in enumerate(important)]
    places = [(point.time_ns, heights[point.reliable_above]) for point in important]
    place_labels(axes, places, names, steps, first)
    description = f"The front, from the fastest: {'; '.join(point.tip for point in best)}."
    return style.Plot(name, title, description, drawn, tips)


_FEW = 10
"""The most methods of which a plot names all."""

_UNBEATEN = "no method is faster and more reliable"


def _axes(axes: Axes, methods: Sequence[ParetoPoint], timed: str) -> dict[float, float]:
    """Name the axes; return the height of each reliability: its log10, with separate heights for 0 and infinity."""
    finite = [math.log10(point.reliable_above) for point in methods if 0 < point.reliable_above < math.inf] or [-1.0]
    low, high = math.floor(min(finite)), math.ceil(max(finite))
    span = max(high - low, 4)
    never, always = low - 0.1 * span, high + 0.1 * span
    heights = {0.0: never, math.inf: always}
    heights |= {p.reliable_above: math.log10(p.reliable_above) for p in methods if 0 < p.reliable_above < math.inf}
    ticks = [(float(k), style.power_of_ten(k)) for k in style.decades(10.0**low, 10.0**high)]
    if any(point.reliable_above == 0 for point in methods):
        ticks.insert(0, (never, "none wrong"))
        axes.axhspan(never - 0.06 * span, never + 0.05 * span, color=style.colour("rule"), alpha=0.45, linewidth=0)
    if any(point.reliable_above == math.inf for point in methods):
        ticks.append((always, "at no distance"))
        axes.axhspan(always - 0.05 * span, always + 0.06 * span, color=style.colour("rule"), alpha=0.45, linewidth=0)
    axes.set_yticks([height for height, _ in ticks], [label for _, label in ticks])
    axes.set_ylim(ticks[0][0] - 0.08 * span, ticks[-1][0] + 0.08 * span)
    axes.set_ylabel("reliable beyond this distance (share of the size)")
    times = [point.time_ns for point in methods]
    least, most = min(times) / 2, max(times) * 3
    style.log_axis(axes, "x", least, most)
    axes.set_xlabel(f"nanoseconds a query in a batch{', ' if timed else ''}{escaped(timed, 18)}")
    return heights


def _steps(
    best: Sequence[ParetoPoint], heights: dict[float, float], end: float
) -> list[tuple[Coordinates, Coordinates]]:
    """Return the front's line: horizontal from each point to the next point's time, then down to that point."""
    steps: list[tuple[Coordinates, Coordinates]] = []
    for before, after in pairwise(best):
        corner = (after.time_ns, heights[before.reliable_above])
        steps.append(((before.time_ns, corner[1]), corner))
        steps.append((corner, (after.time_ns, heights[after.reliable_above])))
    last = (best[-1].time_ns, heights[best[-1].reliable_above])
    return [*steps, (last, (end, last[1]))]


HEIGHT = 345
_ABOVE = 1.12
"""The axis of shares ends at 1.12 times the largest share and begins at −0.12 times it, so that marks are whole."""

_LEAST = 0.01
"""The largest share that the axis shows is at least 1 %."""


def _sweep_plots(record: Record) -> Iterator[style.Plot]:
    """Yield plots of missed contacts and of false contacts on all workloads; the time is that of the principal one."""
    timed = [(total, total.time_ns / 1000) for total in measured.sweep_totals(record) if total.time_ns is not None]
    if timed:
        where = str(measured.workloads(record)[measured.principal(record)].title)
        yield _sweep_plot("front-missed", "Missed contacts", timed, where, lambda total: total.missed)
        yield _sweep_plot("front-false", "False contacts", timed, where, lambda total: total.false)


def _sweep_plot(
    name: str,
    title: str,
    timed: Sequence[tuple[measured.SweepTotal, float]],
    where: str,
    mistakes: Callable[[measured.SweepTotal], int],
) -> style.Plot:
    """Draw a plot of the share of these mistakes against microseconds."""
    drawn = style.new_figure(style.WIDTH, HEIGHT)
    axes = drawn.subplots()
    marks = []
    for method, time in timed:
        share = method.share(mistakes(method))
        tip = f"{method.name}, {figure(time)} µs, {figure(100 * share)} % of {method.asked:,}"
        marks.append(MethodMark(method.name, method.tier, method.exact, style.Mark(time, share, tip)))
    most = max(_LEAST, *(method.mark.y for method in marks))
    times = [method.mark.x for method in marks]
    style.log_axis(axes, "x", min(times) / 2, max(times) * 3)
    axes.set_ylim(-(_ABOVE - 1) * most, _ABOVE * most)
    axes.yaxis.set_major_formatter(lambda value, _: f"{100 * value:g} %" if value >= 0 else "")
    axes.set_xlabel(f"µs a sweep in a batch, {escaped(where, 40)}")
    axes.set_ylabel(f"sweeps with a {title.lower().removesuffix('s')}")
    tips = _draw_methods(axes, name, marks)
    _legend(drawn, marks)
    by_need = sorted(marks, key=lambda method: (method.mark.y, method.mark.x))
    names = [escaped(method.name.removeprefix("passage-"), 28) for method in by_need]
    place_labels(axes, [method.mark[:2] for method in by_need], names)
    description = f"{title}, of all sweeps that a method was asked: {'; '.join(method.mark.tip for method in by_need)}."
    return style.Plot(name, title, description, drawn, tips)
