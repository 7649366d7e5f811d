"""The worst answer of each implementation about a sweep: the sweep in the half plane (r, z), where it is curved.

An upright spheroid meets the hyperboloid in the half plane of its centre, so that the half plane shows the truth at
each time. The left panel shows the whole sweep. The right panel shows the place where the spheroid first touches or is
nearest, which is too small to see in a long sweep. Sweeps of tilted spheroids have no picture, because their contact
need not be in this plane.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Ellipse, Patch

from hypcheck.geometry.rows import Floats
from hypcheck.implementations.sweeps import distances
from hypcheck.messages import escaped
from hypcheck.record import Record
from hypcheck.record.fields import numbers_of
from hypcheck.record.lines import WrongAnswer
from hypcheck.report.messages import figure, from_hex
from hypcheck.report.model import drawn_sweep, implementations
from hypcheck.report.plots.planes import Interval, draw_surface
from hypcheck.report.plots.style import WIDTH, Plot, colour, new_figure
from hypcheck.truth.passage_error import SWEEP_ANSWERS, passage_of

BROAD, HEIGHT = 1.6 * WIDTH, 330

AROUND = 2.6
"""The number of the spheroid's semi-axes that the right panel shows on each side of its centre."""

_POINTS, _ZOOMS = 400, 5
_LONGEST_NAME = 40

_ANSWERED_DASHES = (0, (4, 2))

SWEEP, TOUCHES, ANSWERED = "series-1", "series-2", "series-4"
"""The roles of three colours: of the sweep, of the spheroid at first contact, and of it at the answered time."""


@dataclass(frozen=True, slots=True)
class _DrawnSweep:
    """A sweep to be drawn: its row, the time that the right panel shows, and the answered time if that is wrong."""

    row: tuple[float, ...]
    answer: int
    hit: bool
    shown: float
    answered: float | None

    def at(self, times: Floats | float) -> tuple[Floats, Floats]:
        """Distances of the centre from the axis, and heights, at these times."""
        t = np.asarray(times, dtype=np.float64)
        x, y, z = (self.row[4 + i] * (1 - t) + self.row[7 + i] * t for i in range(3))
        return np.hypot(x, y), np.asarray(z)


def plots(record: Record) -> Iterator[Plot]:
    """Yield a plot for each implementation under test that answered wrongly about a sweep of an upright spheroid."""
    for number, implementation in enumerate(implementations(record)):
        case = drawn_sweep(implementation)
        if case is not None:
            yield _plot(f"way-{number}", implementation.name, case)


def _plot(name: str, method: str, case: WrongAnswer) -> Plot:
    """Draw the two panels of a wrong answer about a sweep."""
    sweep = _drawn(case)
    drawn = new_figure(BROAD, HEIGHT)
    whole, near = drawn.subplots(1, 2)
    _whole(whole, sweep)
    _near(near, sweep)
    _legend(drawn, sweep)
    description = f"{escaped(case.case)}: {SWEEP_ANSWERS[int(sweep.hit)]}{_when(sweep)}; answered: {_answer(sweep)}."
    return Plot(name, f"{escaped(method, _LONGEST_NAME)}: {escaped(case.case, _LONGEST_NAME)}", description, drawn)


def _drawn(case: WrongAnswer) -> _DrawnSweep:
    """Decide the sweep of a wrong answer, and choose the time that the right panel shows."""
    row = from_hex(numbers_of(case))
    decided = passage_of(row)
    shown = decided.first_lower if decided.hit else _nearest_time(row)
    return _DrawnSweep(row, int(case.answer), decided.hit, shown, case.time if case.time else None)


def _nearest_time(row: tuple[float, ...]) -> float:
    """Find the approximate time at which the spheroid is nearest to the surface."""
    low, high = 0.0, 1.0
    for _ in range(_ZOOMS):
        times = np.linspace(low, high, _POINTS // _ZOOMS)
        place = int(np.argmin(distances(np.repeat([row], len(times), axis=0), times)))
        low, high = times[max(place - 1, 0)], times[min(place + 1, len(times) - 1)]
    return float((low + high) / 2)


def _when(sweep: _DrawnSweep) -> str:
    """Return the time of the first contact in words; "" if there is no contact."""
    return f", first at {figure(sweep.shown)} of it" if sweep.hit else ""


def _answer(sweep: _DrawnSweep) -> str:
    """Return the given answer in words."""
    return SWEEP_ANSWERS.get(sweep.answer, str(sweep.answer)) + (
        f", first at {figure(sweep.answered)}" if sweep.answered is not None else ""
    )


def _whole(axes: Axes, sweep: _DrawnSweep) -> None:
    """Draw the left panel: the whole sweep, with the spheroid at its start and at its end."""
    b, d = sweep.row[2:4]
    rs, zs = sweep.at(_times(sweep))
    near_r, near_z = _about(sweep)
    r = min(float(rs.min()) - 1.2 * b, near_r[0]), max(float(rs.max()) + 1.2 * b, near_r[1])
    z = min(float(zs.min()) - 1.2 * d, near_z[0]), max(float(zs.max()) + 1.2 * d, near_z[1])
    span = r[1] - r[0]
    r = (0.0 if r[0] < span else r[0]), r[1] + 0.04 * span  # room for the axis, unless far away, and for end marks
    _panel(axes, sweep, r, z, "the whole way")
    for time, marker in ((0.0, "o"), (1.0, "s")):
        axes.plot(*sweep.at(time), marker=marker, markersize=6, color=colour(SWEEP), zorder=4)
        _body(axes, sweep, time, SWEEP)
    _touching(axes, sweep)


def _near(axes: Axes, sweep: _DrawnSweep) -> None:
    """Draw the right panel: the surroundings of the spheroid at the shown time."""
    _panel(axes, sweep, *_about(sweep), "where it first touches" if sweep.hit else "where it comes nearest")
    _touching(axes, sweep)


def _panel(axes: Axes, sweep: _DrawnSweep, r: Interval, z: Interval, title: str) -> None:
    """Draw the sweep and the surface in a part of the half plane."""
    axes.set(xlim=r, ylim=z, xlabel="r, distance from the axis", ylabel="z, height")
    axes.set_title(title, fontsize=10)
    axes.locator_params(nbins=4)
    axes.ticklabel_format(useOffset=False)
    draw_surface(axes, sweep.row[:2], r, z, colour("ink"))
    axes.plot(*sweep.at(_times(sweep)), color=colour(SWEEP), linewidth=1.4, zorder=3)


def _about(sweep: _DrawnSweep) -> tuple[Interval, Interval]:
    """Return the part of the half plane around the spheroid at the shown time."""
    b, d = sweep.row[2:4]
    r, z = (float(coordinate) for coordinate in sweep.at(sweep.shown))
    return (max(0.0, r - AROUND * b), r + AROUND * b), (z - AROUND * d, z + AROUND * d)


def _times(sweep: _DrawnSweep) -> Floats:
    """Return times of the whole sweep, denser around the shown time and around the time nearest to the axis."""
    x, y = sweep.row[4:6]
    u, v = sweep.row[7] - x, sweep.row[8] - y
    turn = -(x * u + y * v) / (u * u + v * v) if u or v else 0.0
    close = np.concatenate([[0.0], np.geomspace(1e-12, 1.0, _POINTS // 4)])
    every = [np.linspace(0.0, 1.0, _POINTS)]
    every += [middle + side * close for middle in (turn, sweep.shown) for side in (-1.0, 1.0)]
    return np.unique(np.clip(np.concatenate(every), 0.0, 1.0))


def _touching(axes: Axes, sweep: _DrawnSweep) -> None:
    """Draw the spheroid at the time that the right panel shows, and at the answered time."""
    role = TOUCHES if sweep.hit else SWEEP
    _body(axes, sweep, sweep.shown, role, filled=sweep.hit)
    axes.plot(*sweep.at(sweep.shown), marker="+", markersize=7, color=colour(role), zorder=5)
    if sweep.answered is not None:
        _body(axes, sweep, sweep.answered, ANSWERED)


def _body(axes: Axes, sweep: _DrawnSweep, time: float, role: str, *, filled: bool = False) -> None:
    """Draw the spheroid at a time, in the colour of this role."""
    b, d = sweep.row[2:4]
    r, z = (float(coordinate) for coordinate in sweep.at(time))
    face = colour(role) if filled else "none"
    axes.add_patch(Ellipse((r, z), 2 * b, 2 * d, facecolor=face, edgecolor="none", alpha=0.25, zorder=2))
    turn = np.linspace(0.0, 2 * math.pi, 121)
    rim = r + b * np.cos(turn), z + d * np.sin(turn)
    axes.plot(
        *rim, color=colour(role), linewidth=1.2, linestyle=_ANSWERED_DASHES if role == ANSWERED else "solid", zorder=3
    )


def _legend(drawn: Figure, sweep: _DrawnSweep) -> None:
    """Draw the legend below the panels."""
    own = colour(SWEEP)
    handles: list[Line2D | Patch] = [
        Line2D([], [], color=colour("ink"), linewidth=0.9, label="hyperboloid"),
        Line2D([], [], color=own, marker="o", markersize=6, label="the sweep, from its start"),
        Line2D([], [], color=own, marker="s", markersize=6, label="to its end"),
    ]
    if sweep.hit:
        handles.append(Patch(facecolor=colour(TOUCHES), alpha=0.4, label="first contact"))
    if sweep.answered is not None:
        handles.append(Line2D([], [], color=colour(ANSWERED), linestyle=_ANSWERED_DASHES, label="at the answered time"))
    drawn.legend(handles=handles, loc="outside lower center", ncols=3)
