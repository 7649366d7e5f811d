"""Missed and false contacts against time: what methods for ways get wrong, and what a way costs.

Two plots, one for each mistake: a missed contact is dangerous, and a false one closes a way for nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from hypcheck.messages import escaped
from hypcheck.record import Record
from hypcheck.report.measured import TIERS, WayTotal, principal, way_totals, workloads
from hypcheck.report.messages import figure
from hypcheck.report.plots.pareto import RING, mark_style, place_labels
from hypcheck.report.plots.style import WIDTH, log_axis, new_figure
from hypcheck.report.plots.svg import Plot

HEIGHT = 345
_ABOVE = 1.12
"""The axis of shares goes so much beyond the largest, and a part of that below 0, so that marks are whole."""

_LEAST = 0.01
"""The axis of shares goes at least to 1 %."""

Share = Callable[[WayTotal], float]


def plots(record: Record) -> Iterator[Plot]:
    """Missed contacts, then false contacts, of all workloads together; the time is that of the principal one."""
    found = [each for each in way_totals(record) if each.time_ns is not None]
    if found:
        where = str(workloads(record)[principal(record)].title)
        yield _plot("front-missed", "Missed contacts", found, where, lambda each: each.share(each.missed))
        yield _plot("front-false", "False contacts", found, where, lambda each: each.share(each.false))


def _plot(name: str, title: str, found: Sequence[WayTotal], where: str, share: Share) -> Plot:
    drawn = new_figure(WIDTH, HEIGHT)
    axes = drawn.subplots()
    most = max(_LEAST, *map(share, found))
    times = [_time(each) for each in found]
    log_axis(axes, "x", min(times) / 2, max(times) * 3)
    axes.set_ylim(-(_ABOVE - 1) * most, _ABOVE * most)
    axes.yaxis.set_major_formatter(lambda value, _: f"{100 * value:g} %" if value >= 0 else "")
    axes.set_xlabel(f"time of a way in a batch, {escaped(where, 40)} (µs)")
    axes.set_ylabel(f"ways with a {title.lower().removesuffix('s')}")
    tips = _marks(axes, found, share, name)
    _legend(drawn, found)
    by_need = sorted(found, key=lambda each: (share(each), _time(each)))
    place_labels(axes, [(_time(each), share(each)) for each in by_need], [_short(each.name) for each in by_need])
    said = f"{title}, of all ways that a method was asked: {'; '.join(_tip(each, share) for each in by_need)}."
    return Plot(name, title, said, drawn, tips)


def _time(each: WayTotal) -> float:
    return (each.time_ns or 0.0) / 1000


def _short(name: str) -> str:
    return escaped(name.removeprefix("passage-"), 28)


def _marks(axes: Axes, found: Sequence[WayTotal], share: Share, name: str) -> dict[str, list[str]]:
    exact = [each for each in found if each.exact]
    axes.plot([_time(each) for each in exact], [share(each) for each in exact], **RING)
    tips: dict[str, list[str]] = {}
    for number, tier in enumerate(TIERS):
        mine = [each for each in found if each.tier == tier]
        if mine:
            gid = f"{name}-{number}"
            xs, ys = [_time(each) for each in mine], [share(each) for each in mine]
            axes.plot(xs, ys, gid=gid, linestyle="none", **mark_style(number, shown=True))
            tips[gid] = [_tip(each, share) for each in mine]
    return tips


def _legend(drawn: Figure, found: Sequence[WayTotal]) -> None:
    handles = [
        Line2D([], [], linestyle="none", label=tier, **mark_style(number, shown=True))
        for number, tier in enumerate(TIERS)
        if any(each.tier == tier for each in found)
    ]
    drawn.legend(handles=handles, loc="outside upper left", ncols=5, handlelength=1.2)
    if any(each.exact for each in found):
        ringed = Line2D([], [], label="ringed: promises never to be wrong", **RING)
        drawn.legend(handles=[ringed], loc="outside lower left")


def _tip(each: WayTotal, share: Share) -> str:
    return f"{each.name}, {figure(_time(each))} µs, {figure(100 * share(each))} % of {each.asked:,}"
