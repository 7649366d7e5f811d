"""The cost of answers: ratios of times, meshes, bounding volumes, and a walker's step in a forest."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from matplotlib.lines import Line2D

from hypcheck.messages import escaped
from hypcheck.record import Record
from hypcheck.record.measurements import BoundingLine, ConvergenceLine, ForestLine, SpeedLine
from hypcheck.report.measured import TIERS, lost, measured_methods, noise_floor, reference, workloads
from hypcheck.report.messages import figure
from hypcheck.report.plots.style import (
    LIMIT,
    MARKERS,
    NONE_WRONG,
    WIDTH,
    colour,
    curve_style,
    legend_handles,
    log_axis,
    new_figure,
)
from hypcheck.report.plots.svg import Plot

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


def speed_plots(record: Record) -> Iterator[Plot]:
    """A plot for each workload and mode in which there are ratios."""
    found = measured_methods(record)
    keys = dict.fromkeys((line.workload, line.mode) for line in record.of(SpeedLine))
    for number, (workload, mode) in enumerate(keys):
        rows = [_speed_row(each.name, each.tier, line) for each in found if (line := each.speed.get((workload, mode)))]
        kept = sorted((row for row in rows if row is not None and row.ratio > 0), key=lambda row: row.ratio)
        if len(kept) > 1:
            title = f"{workloads(record)[workload].title}, {_MODES[mode]}"
            floor = noise_floor(record, workload, mode)
            yield _speed_plot(f"speeds-{number}", title, kept, floor, reference(record) or "the reference")


def _speed_row(name: str, tier: str, line: SpeedLine) -> SpeedRow | None:
    if line.ratio is None or lost(line):
        return None
    low, high = line.ratio_ci95 or (line.ratio, line.ratio)
    return SpeedRow(name, tier, float(line.ratio), float(low), float(high), float(line.median_ns))


def _speed_plot(name: str, title: str, rows: Sequence[SpeedRow], floor: float | None, against: str) -> Plot:
    drawn = new_figure(WIDTH, 80 + 15 * len(rows))
    axes = drawn.subplots()
    log_axis(axes, "x", min(row.low for row in rows) / 1.5, max(row.high for row in rows) * 1.5)
    if floor:
        axes.axvspan(
            1 / (1 + floor), 1 + floor, color=colour("rule"), alpha=0.8, linewidth=0, label="noise of this run"
        )
    axes.axvline(1, color=colour("soft"), linewidth=0.8)
    tips: dict[str, list[str]] = {}
    for number, tier in enumerate(TIERS):
        mine = [(place, row) for place, row in enumerate(rows) if row.tier == tier]
        if mine:
            own, gid = colour(f"series-{number + 1}"), f"{name}-{number}"
            axes.hlines([at for at, _ in mine], [row.low for _, row in mine], [row.high for _, row in mine], color=own)
            look: dict[str, Any] = {"color": own, "marker": MARKERS[number], "linestyle": "none", "markersize": 5}
            axes.plot([row.ratio for _, row in mine], [at for at, _ in mine], gid=gid, label=tier, **look)
            tips[gid] = [_speed_tip(row) for _, row in mine]
    axes.set_yticks(range(len(rows)), [escaped(row.name, 26) for row in rows])
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.tick_params(axis="y", length=0, labelsize=9)
    axes.set_xlabel(f"time by that of {escaped(against, 26)}, 95 % interval")
    drawn.legend(loc="outside upper left", ncols=3, handlelength=1.4)
    said = f"Ratios of times, the fastest first: {'; '.join(_speed_tip(row) for row in rows)}."
    return Plot(name, title, said, drawn, tips)


def _speed_tip(row: SpeedRow) -> str:
    return f"{row.name}: {figure(row.ratio)} ({figure(row.low)} to {figure(row.high)}), {figure(row.median_ns)} ns"


CONVERGENCE_QUANTITIES = (
    ("wrong", "share of wrong answers"),
    ("deviation", "deviation of the mesh (radii)"),
    ("query", "time of a query (ns)"),
    ("build", "time of a build (ns)"),
)


def convergence_plots(record: Record) -> Iterator[Plot]:
    """A plot for each quantity, a curve a method."""
    methods: dict[str, list[ConvergenceLine]] = {}
    for line in sorted(record.of(ConvergenceLine), key=lambda line: line.triangles):
        methods.setdefault(line.method, []).append(line)
    if methods:
        for what, label in CONVERGENCE_QUANTITIES:
            yield _convergence_plot(what, label, methods)


def _value(line: ConvergenceLine, what: str) -> float:
    """What is drawn; of no wrong answer among n the upper limit 3/n."""
    if what == "wrong":
        return float(line.wrong or min(3, line.asked)) / float(max(1, line.asked))
    return float(getattr(line, what if what == "deviation" else f"{what}_ns"))


def _convergence_plot(what: str, label: str, methods: dict[str, list[ConvergenceLine]]) -> Plot:
    drawn = new_figure(WIDTH, 250 + 15 * len(methods))
    axes = drawn.subplots()
    values = [value for lines in methods.values() for line in lines if (value := _value(line, what)) > 0] or [1.0]
    triangles = [line.triangles for lines in methods.values() for line in lines]
    log_axis(axes, "x", min(triangles) / 1.5, max(triangles) * 1.5)
    log_axis(axes, "y", min(values) / 1.8, max(values) * 1.8)
    axes.set(xlabel="triangles", ylabel=label)
    tips: dict[str, list[str]] = {}
    for place, (name, lines) in enumerate(methods.items()):
        how, shown = curve_style(place), [line for line in lines if _value(line, what) > 0]
        axes.plot(*_xy(shown, what), color=how.colour, linestyle=how.dashes)
        for none in (False, True):
            mine = [line for line in shown if (what == "wrong" and not line.wrong) == none]
            if mine:
                gid = f"convergence-{what}-{place}-{none}"
                marks: dict[str, Any] = dict(LIMIT) if none else {"marker": how.marker}
                axes.plot(*_xy(mine, what), gid=gid, linestyle="none", color=how.colour, **marks)
                tips[gid] = [_convergence_tip(name, line) for line in mine]
    handles = legend_handles(methods)
    if what == "wrong":
        handles.append(Line2D([], [], label=NONE_WRONG, color=colour("soft"), linestyle="none", **LIMIT))
    drawn.legend(handles=handles, loc="outside lower left")
    said = "; ".join(_convergence_tip(name, lines[-1]) for name, lines in methods.items())
    return Plot(
        f"convergence-{what}", label, f"{label} against the number of triangles. At the most: {said}.", drawn, tips
    )


def _xy(lines: Sequence[ConvergenceLine], what: str) -> tuple[list[int], list[float]]:
    return [line.triangles for line in lines], [_value(line, what) for line in lines]


def _convergence_tip(name: str, line: ConvergenceLine) -> str:
    return (
        f"{name}, {line.triangles:,} triangles: {line.wrong:,} of {line.asked:,} wrong,"
        f" deviation {figure(line.deviation)} radii, query {figure(line.query_ns)} ns,"
        f" build {figure(line.build_ns)} ns"
    )


BOUNDING_QUANTITIES = (
    ("share", "share of false contacts"),
    ("excess", "median excess clearance (radii)"),
)
"""Of a row [d/b, asked, false contacts, excess]: what is drawn, and the name of its axis."""


def bounding_plots(record: Record) -> Iterator[Plot]:
    """A plot for each quantity, a curve for each shape and workload."""
    shapes = {f"{line.shape}, {line.workload}": line for line in record.of(BoundingLine) if line.overlap}
    for what, label in BOUNDING_QUANTITIES:
        if any(_bounding_points(line, what) for line in shapes.values()):
            yield _bounding_plot(what, label, shapes)


def _bounding_points(line: BoundingLine, what: str) -> list[tuple[float, float, str]]:
    """d/b, what is drawn, and a tooltip; rows that have it."""
    found = []
    for ratio, asked, contacts, excess in line.overlap:
        value = excess if what == "excess" else contacts / asked if asked else None
        if value is not None and asked:
            known = "" if excess is None else f", median excess clearance {figure(excess)} radii"
            tip = f"{line.shape}, d/b {figure(ratio)}: {contacts:,.0f} of {asked:,.0f} false contacts{known}"
            found.append((float(ratio), float(value), tip))
    return sorted(found)


def _bounding_plot(what: str, label: str, shapes: dict[str, BoundingLine]) -> Plot:
    drawn = new_figure(WIDTH, 240 + 15 * len(shapes))
    axes = drawn.subplots()
    curves = {name: _bounding_points(line, what) for name, line in shapes.items()}
    ratios = [ratio for points in curves.values() for ratio, _, _ in points]
    log_axis(axes, "x", min(*ratios, 0.5) / 1.3, max(*ratios, 2.0) * 1.3)
    axes.axvline(1, color=colour("soft"), linewidth=0.8)
    axes.set(xlabel="d/b, half height by radius of the spheroid (1: a sphere)", ylabel=label)
    tips = {}
    for place, points in enumerate(curves.values()):
        how = curve_style(place)
        style = {"color": how.colour, "linestyle": how.dashes}
        if points:
            xs, ys = [ratio for ratio, _, _ in points], [value for _, value, _ in points]
            axes.plot(xs, ys, **style)
            axes.plot(xs, ys, gid=f"bounding-{what}-{place}", color=how.colour, marker=how.marker, linestyle="none")
            tips[f"bounding-{what}-{place}"] = [tip for _, _, tip in points]
    axes.set_ylim(bottom=min(0.0, *(value for points in curves.values() for _, value, _ in points)))
    drawn.legend(handles=legend_handles(curves), loc="outside lower left")
    said = f"{label} against d/b. {'; '.join(points[-1][2] for points in curves.values() if points)}."
    return Plot(f"bounding-{what}", label, said, drawn, tips)


def forest_plots(record: Record) -> Iterator[Plot]:
    """One plot, a curve for each that was asked."""
    methods: dict[str, list[ForestLine]] = {}
    for line in sorted(record.of(ForestLine), key=lambda line: line.trees):
        methods.setdefault(line.method, []).append(line)
    if not methods:
        return
    drawn = new_figure(WIDTH, 250 + 15 * len(methods))
    axes = drawn.subplots()
    times = [line.step_ns for lines in methods.values() for line in lines]
    trees = [line.trees for lines in methods.values() for line in lines]
    log_axis(axes, "x", min(trees) / 1.5, max(trees) * 1.5)
    log_axis(axes, "y", min(times) / 2, max(times) * 2)
    axes.set(xlabel="trees", ylabel="time of a step (ns)")
    tips: dict[str, list[str]] = {}
    for place, (name, lines) in enumerate(methods.items()):
        how, gid = curve_style(place), f"forest-{place}"
        xs, ys = [line.trees for line in lines], [line.step_ns for line in lines]
        axes.plot(xs, ys, color=how.colour, linestyle=how.dashes)
        axes.plot(xs, ys, gid=gid, color=how.colour, linestyle="none", marker=how.marker)
        tips[gid] = [_forest_tip(name, line) for line in lines]
    drawn.legend(handles=legend_handles(methods), loc="outside lower left")
    said = "; ".join(_forest_tip(name, lines[-1]) for name, lines in methods.items())
    title = "time of a step against the number of trees"
    yield Plot("forest", title, f"{title.capitalize()}. In the largest forest: {said}.", drawn, tips)


def _forest_tip(name: str, line: ForestLine) -> str:
    return (
        f"{name}, {line.trees:,} trees: {figure(line.step_ns)} ns a step, built in {figure(line.build_s)} s,"
        f" {line.wrong:,} of {line.asked:,} wrong"
    )
