"""The cost of answers: ratios of times, meshes, bounding volumes, and a walker's step in a forest."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from hypcheck.messages import escaped
from hypcheck.record import Record
from hypcheck.record.measurements import BoundingLine, ConvergenceLine, ForestLine, SpeedLine
from hypcheck.report.measured import TIERS, measured_methods, noise_floor, reference, workloads
from hypcheck.report.messages import figure
from hypcheck.report.plots import style
from hypcheck.report.plots.style import Plot

_MODES = {"batch": "in a batch", "single": "one query a call", "build": "building a mesh"}


@dataclass(frozen=True, slots=True)
class SpeedRow:
    """A method's ratio and its interval."""

    name: str
    tier: str
    ratio: float
    low: float
    high: float
    median_ns: float

    @property
    def tip(self) -> str:
        """The tooltip of its mark."""
        ends = f"{figure(self.low)} to {figure(self.high)}"
        return f"{self.name}: {figure(self.ratio)} ({ends}), {figure(self.median_ns)} ns"


def speed_plots(record: Record) -> Iterator[Plot]:
    """Yield a plot for each workload and mode that has at least two ratios."""
    methods = measured_methods(record)
    keys = dict.fromkeys((line.workload, line.mode) for line in record.of(SpeedLine))
    for number, (workload, mode) in enumerate(keys):
        rows = []
        for method in methods:
            ratio = method.ratio(workload, mode)
            if ratio:
                ends, time = method.ratio_interval(workload, mode), method.speed[workload, mode].median_ns
                rows.append(SpeedRow(method.label, method.tier, ratio, *ends, time))
        if len(rows) > 1:
            rows.sort(key=lambda row: row.ratio)
            title = f"{workloads(record)[workload].title}, {_MODES[mode]}"
            floor = noise_floor(record, workload, mode)
            yield _speed_plot(f"speeds-{number}", title, rows, floor, reference(record) or "the reference")


def _speed_plot(name: str, title: str, rows: Sequence[SpeedRow], floor: float | None, against: str) -> Plot:
    """Draw the ratios with their intervals; `floor` is the noise of the run, None if it was not measured."""
    drawn = style.new_figure(style.WIDTH, 80 + 15 * len(rows))
    axes = drawn.subplots()
    style.log_axis(axes, "x", min(row.low for row in rows) / 1.5, max(row.high for row in rows) * 1.5)
    if floor:
        axes.axvspan(
            1 / (1 + floor), 1 + floor, color=style.colour("rule"), alpha=0.8, linewidth=0, label="noise of this run"
        )
    axes.axvline(1, color=style.colour("soft"), linewidth=0.8)
    tips: dict[str, list[str]] = {}
    for number, tier in enumerate(TIERS):
        mine = [(place, row) for place, row in enumerate(rows) if row.tier == tier]
        if mine:
            own = style.colour(f"series-{number + 1}")
            axes.hlines([at for at, _ in mine], [row.low for _, row in mine], [row.high for _, row in mine], color=own)
            marks = [style.Mark(row.ratio, at, row.tip) for at, row in mine]
            look: dict[str, Any] = {"color": own, "marker": style.MARKERS[number], "markersize": 5, "label": tier}
            tips |= style.draw_marks(axes, f"{name}-{number}", marks, **look)
    axes.set_yticks(range(len(rows)), [escaped(row.name, 36) for row in rows])
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.tick_params(axis="y", length=0, labelsize=9)
    axes.set_xlabel(f"time by that of {escaped(against, 26)}, 95 % interval")
    drawn.legend(loc="outside upper left", ncols=3, handlelength=1.4)
    description = f"Ratios of times, the fastest first: {'; '.join(row.tip for row in rows)}."
    return Plot(name, title, description, drawn, tips)


def _draw_curves(axes: Axes, name: str, curves: Mapping[str, Sequence[style.Mark]]) -> dict[str, list[str]]:
    """Draw a line with marks for each name; return the tooltips of the marks."""
    tips: dict[str, list[str]] = {}
    for place, marks in enumerate(curves.values()):
        how = style.curve_style(place)
        axes.plot([mark.x for mark in marks], [mark.y for mark in marks], **how.line)
        tips |= style.draw_marks(axes, f"{name}-{place}", [mark for mark in marks if not mark.limit], **how.marks)
        limits = [mark for mark in marks if mark.limit]
        tips |= style.draw_marks(axes, f"{name}-{place}-limit", limits, color=how.colour, **style.LIMIT)
    return tips


CONVERGENCE_QUANTITIES = (
    ("wrong", "share of wrong answers"),
    ("deviation", "deviation of the mesh (radii)"),
    ("query", "time of a query (ns)"),
    ("build", "time of a build (ns)"),
)


def convergence_plots(record: Record) -> Iterator[Plot]:
    """Yield a plot for each of CONVERGENCE_QUANTITIES, with a curve for each method."""
    methods: dict[str, list[ConvergenceLine]] = {}
    for line in sorted(record.of(ConvergenceLine), key=lambda line: line.triangles):
        methods.setdefault(line.method, []).append(line)
    if methods:
        for what, label in CONVERGENCE_QUANTITIES:
            yield _convergence_plot(what, label, methods)


def _convergence_mark(line: ConvergenceLine, what: str) -> style.Mark:
    """Make the mark of a line; `what` is "wrong", "deviation", "query" or "build" (CONVERGENCE_QUANTITIES).

    The mark of "wrong" is the share of wrong answers. If none of n answers is wrong, it is at 3/n, the upper limit of
    the share at a confidence of 95 % (the rule of three, see curves.py).
    """
    tip = (
        f"{line.method}, {line.triangles:,} triangles: {line.wrong:,} of {line.asked:,} wrong,"
        f" deviation {figure(line.deviation)} radii, query {figure(line.query_ns)} ns,"
        f" build {figure(line.build_ns)} ns"
    )
    if what == "wrong":
        share = (line.wrong or min(3, line.asked)) / max(1, line.asked)
        return style.Mark(line.triangles, share, tip, limit=not line.wrong)
    return style.Mark(line.triangles, getattr(line, what if what == "deviation" else f"{what}_ns"), tip)


def _convergence_plot(what: str, label: str, methods: Mapping[str, Sequence[ConvergenceLine]]) -> Plot:
    """Draw a quantity against the number of triangles, with a curve for each method."""
    drawn = style.new_figure(style.WIDTH, 250 + 15 * len(methods))
    axes = drawn.subplots()
    curves = {name: [_convergence_mark(line, what) for line in lines] for name, lines in methods.items()}
    shown = {name: [mark for mark in marks if mark.y > 0] for name, marks in curves.items()}
    values = [mark.y for marks in shown.values() for mark in marks] or [1.0]
    triangles = [mark.x for marks in curves.values() for mark in marks]
    style.log_axis(axes, "x", min(triangles) / 1.5, max(triangles) * 1.5)
    style.log_axis(axes, "y", min(values) / 1.8, max(values) * 1.8)
    axes.set(xlabel="triangles", ylabel=label)
    tips = _draw_curves(axes, f"convergence-{what}", shown)
    handles = style.legend_handles(methods)
    if what == "wrong":
        handles.append(
            Line2D([], [], label=style.NONE_WRONG, color=style.colour("soft"), linestyle="none", **style.LIMIT)
        )
    drawn.legend(handles=handles, loc="outside lower left")
    description = f"{label} against the number of triangles. At the most: {_last_tips(curves)}."
    return Plot(f"convergence-{what}", label, description, drawn, tips)


def _last_tips(curves: Mapping[str, Sequence[style.Mark]]) -> str:
    """Return the tooltips of the curves' last marks."""
    return "; ".join(marks[-1].tip for marks in curves.values() if marks)


BOUNDING_QUANTITIES = (
    ("share", "share of false contacts"),
    ("excess", "median excess clearance (radii)"),
)
"""The quantities that are drawn of a row [d/b, asked, false contacts, excess], and the names of their axes."""


def bounding_plots(record: Record) -> Iterator[Plot]:
    """Yield a plot for each of BOUNDING_QUANTITIES, with a curve for each shape and workload."""
    lines = [line for line in record.of(BoundingLine) if line.overlap]
    for what, label in BOUNDING_QUANTITIES:
        curves = {f"{line.shape}, {line.workload}": _bounding_marks(line, what) for line in lines}
        if any(curves.values()):
            yield _bounding_plot(what, label, curves)


def _bounding_marks(line: BoundingLine, what: str) -> list[style.Mark]:
    """Return the marks over d/b, for the rows that have the quantity `what` (BOUNDING_QUANTITIES)."""
    marks = []
    for ratio, cases, contacts, excess in line.overlap:
        value = excess if what == "excess" else contacts / cases if cases else None
        if value is not None and cases:
            known = "" if excess is None else f", median excess clearance {figure(excess)} radii"
            tip = f"{line.shape}, d/b {figure(ratio)}: {contacts:,.0f} of {cases:,.0f} false contacts{known}"
            marks.append(style.Mark(float(ratio), float(value), tip))
    return sorted(marks)


def _bounding_plot(what: str, label: str, curves: Mapping[str, Sequence[style.Mark]]) -> Plot:
    """Draw a quantity against d/b."""
    drawn = style.new_figure(style.WIDTH, 240 + 15 * len(curves))
    axes = drawn.subplots()
    marks = [mark for drawn_marks in curves.values() for mark in drawn_marks]
    ratios = [mark.x for mark in marks]
    style.log_axis(axes, "x", min(*ratios, 0.5) / 1.3, max(*ratios, 2.0) * 1.3)
    axes.axvline(1, color=style.colour("soft"), linewidth=0.8)
    axes.set(xlabel="d/b, half height by radius of the spheroid (1: a sphere)", ylabel=label)
    tips = _draw_curves(axes, f"bounding-{what}", curves)
    axes.set_ylim(bottom=min(0.0, *(mark.y for mark in marks)))
    drawn.legend(handles=style.legend_handles(curves), loc="outside lower left")
    return Plot(f"bounding-{what}", label, f"{label} against d/b. {_last_tips(curves)}.", drawn, tips)


def forest_plots(record: Record) -> Iterator[Plot]:
    """Yield one plot of a step's time against the number of trees, with a curve for each method."""
    curves: dict[str, list[style.Mark]] = {}
    for line in sorted(record.of(ForestLine), key=lambda line: line.trees):
        tip = (
            f"{line.method}, {line.trees:,} trees: {figure(line.step_ns)} ns a step, built in {figure(line.build_s)} s,"
            f" {line.wrong:,} of {line.asked:,} wrong"
        )
        curves.setdefault(line.method, []).append(style.Mark(line.trees, line.step_ns, tip))
    if not curves:
        return
    drawn = style.new_figure(style.WIDTH, 250 + 15 * len(curves))
    axes = drawn.subplots()
    trees, times, _, _ = zip(*(mark for marks in curves.values() for mark in marks), strict=True)
    style.log_axis(axes, "x", min(trees) / 1.5, max(trees) * 1.5)
    style.log_axis(axes, "y", min(times) / 2, max(times) * 2)
    axes.set(xlabel="trees", ylabel="time of a step (ns)")
    tips = _draw_curves(axes, "forest", curves)
    drawn.legend(handles=style.legend_handles(curves), loc="outside lower left")
    title = "time of a step against the number of trees"
    description = f"{title.capitalize()}. In the largest forest: {_last_tips(curves)}."
    yield Plot("forest", title, description, drawn, tips)
