"""What a walker's step costs against the number of trees."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from hypcheck.record import Record
from hypcheck.record.measurements import Forest
from hypcheck.report.plots.style import WIDTH, log_axis, look, new_figure
from hypcheck.report.plots.svg import Plot
from hypcheck.report.text import figure
from hypcheck.visible import visible

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def plots(record: Record) -> Iterator[Plot]:
    """One plot, a curve for each that was asked."""
    methods: dict[str, list[Forest]] = {}
    for line in sorted(record.of(Forest), key=lambda line: line.trees):
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
        how, gid = look(place), f"forest-{place}"
        xs, ys = [line.trees for line in lines], [line.step_ns for line in lines]
        axes.plot(xs, ys, color=how.colour, linestyle=how.dashes)
        axes.plot(xs, ys, gid=gid, color=how.colour, linestyle="none", marker=how.marker)
        tips[gid] = [_tip(name, line) for line in lines]
    _legend(drawn, list(methods))
    said = "; ".join(_tip(name, lines[-1]) for name, lines in methods.items())
    title = "time of a step against the number of trees"
    yield Plot("forest", title, f"{title.capitalize()}. In the largest forest: {said}.", drawn, tips)


def _legend(drawn: Figure, names: Sequence[str]) -> None:
    from matplotlib.lines import Line2D  # noqa: PLC0415

    handles = []
    for place, name in enumerate(names):
        how, label = look(place), visible(name, 48)
        handles.append(Line2D([], [], color=how.colour, linestyle=how.dashes, marker=how.marker, label=label))
    drawn.legend(handles=handles, loc="outside lower left")


def _tip(name: str, line: Forest) -> str:
    return (
        f"{name}, {line.trees:,} trees: {figure(line.step_ns)} ns a step, built in {figure(line.build_s)} s,"
        f" {line.wrong:,} of {line.asked:,} wrong"
    )
