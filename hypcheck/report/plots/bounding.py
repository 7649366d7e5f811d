"""What a bounding volume costs in invisible walls: false contacts and excess clearance against d/b."""

from __future__ import annotations

from collections.abc import Iterator

from hypcheck.record import Record
from hypcheck.record.measurements import Bounding
from hypcheck.report.plots.style import WIDTH, colour, log_axis, look, new_figure
from hypcheck.report.plots.svg import Plot
from hypcheck.report.text import figure
from hypcheck.visible import visible

QUANTITIES = (
    ("share", "share of false contacts"),
    ("excess", "median excess clearance (radii)"),
)
"""Of a row [d/b, asked, false contacts, excess]: what is drawn, and the name of its axis."""


def plots(record: Record) -> Iterator[Plot]:
    """A plot for each quantity, a curve for each shape and workload."""
    shapes = {f"{line.shape}, {line.workload}": line for line in record.of(Bounding) if line.overlap}
    for what, label in QUANTITIES:
        if any(_points(line, what) for line in shapes.values()):
            yield _plot(what, label, shapes)


def _points(line: Bounding, what: str) -> list[tuple[float, float, str]]:
    """d/b, what is drawn, and a tooltip; rows that have it."""
    found = []
    for ratio, asked, contacts, excess in line.overlap:
        value = excess if what == "excess" else contacts / asked if asked else None
        if value is not None and asked:
            known = "" if excess is None else f", median excess clearance {figure(excess)} radii"
            tip = f"{line.shape}, d/b {figure(ratio)}: {contacts:,.0f} of {asked:,.0f} false contacts{known}"
            found.append((float(ratio), float(value), tip))
    return sorted(found)


def _plot(what: str, label: str, shapes: dict[str, Bounding]) -> Plot:
    from matplotlib.lines import Line2D  # noqa: PLC0415

    drawn = new_figure(WIDTH, 240 + 15 * len(shapes))
    axes = drawn.subplots()
    curves = {name: _points(line, what) for name, line in shapes.items()}
    ratios = [ratio for points in curves.values() for ratio, _, _ in points]
    log_axis(axes, "x", min(*ratios, 0.5) / 1.3, max(*ratios, 2.0) * 1.3)
    axes.axvline(1, color=colour("soft"), linewidth=0.8)
    axes.set(xlabel="d/b, half height by radius of the spheroid (1: a sphere)", ylabel=label)
    tips, handles = {}, []
    for place, (name, points) in enumerate(curves.items()):
        how = look(place)
        style = {"color": how.colour, "linestyle": how.dashes}
        handles.append(Line2D([], [], marker=how.marker, label=visible(name, 48), **style))
        if points:
            xs, ys = [ratio for ratio, _, _ in points], [value for _, value, _ in points]
            axes.plot(xs, ys, **style)
            axes.plot(xs, ys, gid=f"bounding-{what}-{place}", color=how.colour, marker=how.marker, linestyle="none")
            tips[f"bounding-{what}-{place}"] = [tip for _, _, tip in points]
    axes.set_ylim(bottom=min(0.0, *(value for points in curves.values() for _, value, _ in points)))
    drawn.legend(handles=handles, loc="outside lower left")
    said = f"{label} against d/b. {'; '.join(points[-1][2] for points in curves.values() if points)}."
    return Plot(f"bounding-{what}", label, said, drawn, tips)
