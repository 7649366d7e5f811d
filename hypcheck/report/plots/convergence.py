"""How a mesh's errors and times change with its triangles."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from hypcheck.record import Record
from hypcheck.record.measurements import Convergence
from hypcheck.report.plots.style import LIMIT, NONE_WRONG, WIDTH, colour, log_axis, look, new_figure
from hypcheck.report.plots.svg import Plot
from hypcheck.report.text import figure
from hypcheck.visible import visible

if TYPE_CHECKING:
    from matplotlib.figure import Figure

QUANTITIES = (
    ("wrong", "share of wrong answers"),
    ("deviation", "deviation of the mesh (radii)"),
    ("query", "time of a query (ns)"),
    ("build", "time of a build (ns)"),
)


def plots(record: Record) -> Iterator[Plot]:
    """A plot for each quantity, a curve a method."""
    methods: dict[str, list[Convergence]] = {}
    for line in sorted(record.of(Convergence), key=lambda line: line.triangles):
        methods.setdefault(line.method, []).append(line)
    if methods:
        for what, label in QUANTITIES:
            yield _plot(what, label, methods)


def _value(line: Convergence, what: str) -> float:
    """What is drawn; of no wrong answer among n the upper limit 3/n."""
    if what == "wrong":
        return float(line.wrong or min(3, line.asked)) / float(max(1, line.asked))
    return float(getattr(line, what if what == "deviation" else f"{what}_ns"))


def _plot(what: str, label: str, methods: dict[str, list[Convergence]]) -> Plot:
    drawn = new_figure(WIDTH, 250 + 15 * len(methods))
    axes = drawn.subplots()
    values = [value for lines in methods.values() for line in lines if (value := _value(line, what)) > 0] or [1.0]
    triangles = [line.triangles for lines in methods.values() for line in lines]
    log_axis(axes, "x", min(triangles) / 1.5, max(triangles) * 1.5)
    log_axis(axes, "y", min(values) / 1.8, max(values) * 1.8)
    axes.set(xlabel="triangles", ylabel=label)
    tips: dict[str, list[str]] = {}
    for place, (name, lines) in enumerate(methods.items()):
        how, shown = look(place), [line for line in lines if _value(line, what) > 0]
        axes.plot(*_xy(shown, what), color=how.colour, linestyle=how.dashes)
        for none in (False, True):
            mine = [line for line in shown if (what == "wrong" and not line.wrong) == none]
            if mine:
                gid = f"convergence-{what}-{place}-{none}"
                marks: dict[str, Any] = dict(LIMIT) if none else {"marker": how.marker}
                axes.plot(*_xy(mine, what), gid=gid, linestyle="none", color=how.colour, **marks)
                tips[gid] = [_tip(name, line) for line in mine]
    _legend(drawn, list(methods), limit=what == "wrong")
    said = "; ".join(_tip(name, lines[-1]) for name, lines in methods.items())
    return Plot(
        f"convergence-{what}", label, f"{label} against the number of triangles. At the most: {said}.", drawn, tips
    )


def _xy(lines: Sequence[Convergence], what: str) -> tuple[list[int], list[float]]:
    return [line.triangles for line in lines], [_value(line, what) for line in lines]


def _legend(drawn: Figure, names: Sequence[str], *, limit: bool) -> None:
    from matplotlib.lines import Line2D  # noqa: PLC0415

    handles = []
    for place, name in enumerate(names):
        how = look(place)
        label = visible(name, 48)
        handles.append(Line2D([], [], color=how.colour, linestyle=how.dashes, marker=how.marker, label=label))
    if limit:
        handles.append(Line2D([], [], label=NONE_WRONG, color=colour("soft"), linestyle="none", **LIMIT))
    drawn.legend(handles=handles, loc="outside lower left")


def _tip(name: str, line: Convergence) -> str:
    return (
        f"{name}, {line.triangles:,} triangles: {line.wrong:,} of {line.asked:,} wrong,"
        f" deviation {figure(line.deviation)} radii, query {figure(line.query_ns)} ns,"
        f" build {figure(line.build_ns)} ns"
    )
