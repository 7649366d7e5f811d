"""Times of all methods by the reference's, with their intervals, and the noise below which nothing is concluded."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from hypcheck.record import Record
from hypcheck.record.measurements import Speed
from hypcheck.report.measured import TIERS, lost, measured, noise_floor, reference, workloads
from hypcheck.report.plots.style import MARKERS, WIDTH, colour, log_axis, new_figure
from hypcheck.report.plots.svg import Plot
from hypcheck.report.text import figure
from hypcheck.visible import visible

_MODES = {"batch": "in a batch", "single": "one query a call", "build": "building a mesh"}


@dataclass(frozen=True, slots=True)
class Row:
    """A method's ratio and its interval."""

    name: str
    tier: str
    ratio: float
    low: float
    high: float
    median_ns: float


def plots(record: Record) -> Iterator[Plot]:
    """A plot for each workload and mode in which there are ratios."""
    found = measured(record)
    keys = dict.fromkeys((line.workload, line.mode) for line in record.of(Speed))
    for number, (workload, mode) in enumerate(keys):
        rows = [_row(each.name, each.tier, line) for each in found if (line := each.speed.get((workload, mode)))]
        kept = sorted((row for row in rows if row is not None and row.ratio > 0), key=lambda row: row.ratio)
        if len(kept) > 1:
            title = f"{workloads(record)[workload].title}, {_MODES[mode]}"
            floor = noise_floor(record, workload, mode)
            yield _plot(f"speeds-{number}", title, kept, floor, reference(record) or "the reference")


def _row(name: str, tier: str, line: Speed) -> Row | None:
    if line.ratio is None or lost(line):
        return None
    low, high = line.ratio_ci95 or (line.ratio, line.ratio)
    return Row(name, tier, float(line.ratio), float(low), float(high), float(line.median_ns))


def _plot(name: str, title: str, rows: Sequence[Row], floor: float | None, against: str) -> Plot:
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
            tips[gid] = [_tip(row) for _, row in mine]
    axes.set_yticks(range(len(rows)), [visible(row.name, 26) for row in rows])
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.tick_params(axis="y", length=0, labelsize=9)
    axes.set_xlabel(f"time by that of {visible(against, 26)}, 95 % interval")
    drawn.legend(loc="outside upper left", ncols=3, handlelength=1.4)
    said = f"Ratios of times, the fastest first: {'; '.join(_tip(row) for row in rows)}."
    return Plot(name, title, said, drawn, tips)


def _tip(row: Row) -> str:
    return f"{row.name}: {figure(row.ratio)} ({figure(row.low)} to {figure(row.high)}), {figure(row.median_ns)} ns"
