"""Share of wrong answers against distance: one curve per method, for a verification and for a benchmark.

If none of n answers was wrong, the share is not zero but unknown: at most 3/n at a confidence of 95 % (the rule of
three: (1 − 3/n)ⁿ ≈ e⁻³ ≈ 0.05). That limit is drawn as a hollow triangle that points down.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from hypcheck.messages import counted, escaped
from hypcheck.record import Record
from hypcheck.report.measured import TIERS, MeasuredMethod, measured_methods, principal, workloads
from hypcheck.report.messages import figure
from hypcheck.report.model import ImplementationTotal, implementations
from hypcheck.report.plots import style
from hypcheck.report.plots.style import Plot

TANGENT = -math.inf
AT_MOST = 8
"""The most curves in one plot: so many styles differ in colour, marker and dashes."""

STEP, MANY = 3, 16
"""A curve that would cover more than MANY octaves has one point for STEP octaves."""

_LABEL = 24
"""Characters of a name, at most, in a legend of two columns."""

_DOTS = (0, (1, 2.5))
"""The dashes of a line that is an upper limit."""

_LOG2_10 = math.log2(10)


@dataclass(frozen=True, slots=True)
class Octave:
    """Cases with a distance in [2^exponent, 2^(exponent + width)); with the exponent TANGENT, exact tangencies."""

    exponent: float
    asked: int
    wrong: int
    width: int = 1

    @property
    def middle(self) -> float:
        """The log2 of the distance in the middle of the octave."""
        return self.exponent + self.width / 2

    @property
    def share(self) -> float:
        """The share that is drawn: the measured one, or its upper limit if none was wrong."""
        return self.wrong / self.asked if self.wrong else min(1.0, 3 / self.asked)


@dataclass(frozen=True, slots=True)
class Curve:
    """A method's octaves, ascending, each with cases."""

    name: str
    octaves: tuple[Octave, ...]

    @property
    def asked(self) -> int:
        """The number of all cases."""
        return sum(octave.asked for octave in self.octaves)

    @property
    def wrong(self) -> int:
        """The number of all wrong answers."""
        return sum(octave.wrong for octave in self.octaves)


def curve(name: str, octaves: Mapping[float, tuple[int, int]]) -> Curve:
    """Make a method's curve from [asked, wrong] by octave. If there are many octaves, STEP of them make one point.

    Points with few cases each would scatter and hide the curve.
    """
    finite = [exponent for exponent in octaves if math.isfinite(exponent)]
    width = STEP if finite and max(finite) - min(finite) > MANY else 1
    totals: Counter[float] = Counter()
    wrong: Counter[float] = Counter()
    for exponent, (cases, errors) in octaves.items():
        if exponent == math.inf:  # no change of the inputs changes the answer, so the octave has no place on the axis
            continue
        start = exponent if exponent == TANGENT else exponent // width * width
        totals[start] += cases
        wrong[start] += errors
    points = (Octave(start, totals[start], wrong[start], width) for start in sorted(totals) if totals[start])
    return Curve(name, tuple(points))


def in_parts(curves: Sequence[Curve]) -> Iterator[Sequence[Curve]]:
    """Divide the curves into parts of about equal size, each small enough for a plot."""
    parts = -(-len(curves) // AT_MOST)
    for part in range(parts):
        yield curves[part * len(curves) // parts : (part + 1) * len(curves) // parts]


def curve_plot(name: str, title: str, curves: Sequence[Curve]) -> Plot:
    """Draw a plot of at most AT_MOST curves with their legend below them."""
    columns = 2 if all(len(escaped(curve.name)) <= _LABEL for curve in curves) else 1
    rows = -(-len(curves) // columns) + 1
    drawn = style.new_figure(style.WIDTH, 250 + 15.5 * rows)
    axes = drawn.subplots()
    left = _axes(axes, curves)
    tips: dict[str, list[str]] = {}
    for place, curve in enumerate(curves):
        tips |= _draw_curve(axes, curve, f"{name}-{place}", style.curve_style(place), (place, len(curves)), left)
    _legend(drawn, curves, columns)
    return Plot(name, title, _description(curves), drawn, tips)


def _description(curves: Sequence[Curve]) -> str:
    """Describe the plot in words."""
    counts = [f"{curve.name}: {curve.wrong:,} of {counted(curve.asked, 'answer')} wrong" for curve in curves]
    return f"Share of wrong answers against distance to the other answer, both logarithmic. {'; '.join(counts)}."


def _axes(axes: Axes, curves: Sequence[Curve]) -> float:
    """Name the axes and their powers of ten; return the place of exact tangencies on the axis of distances."""
    octaves = [octave for curve in curves for octave in curve.octaves]
    finite = [octave.exponent for octave in octaves if octave.exponent != TANGENT] or [-1.0]
    low, high = min(finite), max(max(finite) + 1, 0)
    step = max(1, math.ceil((high - low) / _LOG2_10 / 8))
    decades = [k for k in range(math.ceil(low / _LOG2_10), math.floor(high / _LOG2_10) + 1) if k % step == 0]
    ticks = [(k * _LOG2_10, style.power_of_ten(k)) for k in decades]
    left = low - max(1.5, (high - low) / 16)
    if any(octave.exponent == TANGENT for octave in octaves):
        ticks = [(left, "0"), *(tick for tick in ticks if tick[0] > low)]
        axes.axvline((left + low) / 2, color=style.colour("soft"), linewidth=0.8, linestyle=(0, (1, 3)))
    axes.set_xticks([place for place, _ in ticks], [label for _, label in ticks])
    axes.set_xlabel("distance to the other answer (relative change of the inputs)")
    style.log_axis(axes, "y", min((octave.share for octave in octaves), default=0.1) / 1.6, 1.5)
    axes.set_ylabel("share of wrong answers")
    return left


def _draw_curve(
    axes: Axes, curve: Curve, gid: str, how: style.CurveStyle, turn: tuple[int, int], left: float
) -> dict[str, list[str]]:
    """Draw a curve. Octaves with wrong answers have tooltips; curves take turns to have them for other octaves."""
    at = [(left if octave.exponent == TANGENT else octave.middle, octave) for octave in curve.octaves]
    finite = [pair for pair in at if pair[1].exponent != TANGENT]
    for measured, dashes, width in ((True, how.dashes, 1.4), (False, _DOTS, 0.9)):
        axes.plot(*_segments(finite, measured=measured), color=how.colour, linestyle=dashes, linewidth=width)
    place, number = turn
    wrong, none = [], []
    for count, (x, octave) in enumerate(at):
        mark = style.Mark(x, octave.share, _tip(curve.name, octave))
        if octave.wrong:
            wrong.append(mark)
        elif count % number == place or (count and at[count - 1][1].wrong):
            none.append(mark)
    tips = style.draw_marks(axes, f"{gid}-wrong", wrong, **how.marks)
    return tips | style.draw_marks(axes, f"{gid}-none", none, color=how.colour, **style.LIMIT)


def _tip(name: str, octave: Octave) -> str:
    """Return the tooltip of a point; if no answer was wrong, it names the upper limit of the share."""
    distance = "exact tangencies" if octave.exponent == TANGENT else f"about {figure(2.0**octave.middle)}"
    limit = "" if octave.wrong else f", so at most a share of {figure(octave.share)}"
    return f"{name}, {distance}: {octave.wrong:,} of {octave.asked:,} wrong{limit}"


def _segments(finite: Sequence[tuple[float, Octave]], *, measured: bool) -> tuple[list[float], list[float]]:
    """Return the lines between neighbours, separated by nan.

    `measured` selects the lines with a wrong answer at an end, else the other lines.
    """
    xs, ys = [], []
    for (x0, before), (x1, after) in pairwise(finite):
        if bool(before.wrong or after.wrong) == measured:
            xs += [x0, x1, math.nan]
            ys += [before.share, after.share, math.nan]
    return xs, ys


def _legend(drawn: Figure, curves: Sequence[Curve], columns: int) -> None:
    """Draw the legend of the curves below the axes, and that of the upper limit above them."""
    soft = style.colour("soft")
    limit = Line2D([], [], color=soft, linestyle=_DOTS, linewidth=0.9, label=style.NONE_WRONG, **style.LIMIT)
    drawn.legend(handles=[limit], loc="outside upper left", labelcolor=soft)
    drawn.legend(
        handles=style.legend_handles([curve.name for curve in curves]), loc="outside lower left", ncols=columns
    )


NOT_WRONG = ("right", "skipped", "abstained", "refused")
"""Statuses of cases with a right answer, or without an answer."""


def octave_plots(record: Record) -> Iterator[Plot]:
    """Yield a plot for each precision, or several if it has many methods."""
    totals = implementations(record)
    for precision in dict.fromkeys(total.precision for total in totals):
        curves = [one for total in totals if total.precision == precision and (one := _octave_curve(total)).octaves]
        for number, part in enumerate(in_parts(curves)):
            more = f", part {number + 1}" if len(curves) > len(part) else ""
            yield curve_plot(f"octaves-{precision}-{number}", f"Wrong answers by distance, {precision}{more}", part)


def _octave_curve(implementation: ImplementationTotal) -> Curve:
    """Make the curve of an implementation, over all families together."""
    cases: Counter[float] = Counter()
    wrong: Counter[float] = Counter()
    for group in implementation.groups:
        for exponent, counts in group.octaves.items():
            for status, number in counts.items():
                cases[float(exponent)] += number * (status != "skipped")
                wrong[float(exponent)] += number * (status not in NOT_WRONG)
    return curve(implementation.name, {exponent: (cases[exponent], wrong[exponent]) for exponent in cases})


FORMULAS = ("paper", "algebraic", "certified")
"""Kinds of methods in one group if tier and length of float are equal; each other kind is a group of its own."""

SHORT = ("float16", "bfloat16", "float32")
_SHORT, _LONG = "float32 and shorter", "float64 and longer"


def error_plots(record: Record) -> Iterator[Plot]:
    """Yield a plot for each group of methods on the workload near contact, or on the first workload."""
    for number, (group, curves) in enumerate(_groups(measured_methods(record), principal(record))):
        yield curve_plot(f"errors-{number}", group, curves)


def other_error_plots(record: Record) -> Iterator[Plot]:
    """Yield a plot for each other workload, and each group of the methods that are wrong there."""
    methods, known = measured_methods(record), workloads(record)
    for place, workload in enumerate(name for name in known if name != principal(record)):
        wrong = [method for method in methods if workload in method.accuracy and method.accuracy[workload].wrong]
        for number, (group, curves) in enumerate(_groups(wrong, workload)):
            yield curve_plot(f"errors-{place}-{number}", f"{known[workload].title}: {group}", curves)


def _groups(methods: list[MeasuredMethod], workload: str) -> Iterator[tuple[str, list[Curve]]]:
    """Yield the name of each group of methods, and their curves on the workload, in parts that fit into a plot."""
    groups: dict[str, list[Curve]] = {}
    for method in sorted(methods, key=lambda method: TIERS.index(method.tier)):
        line = method.accuracy.get(workload)
        if line is not None and line.asked:
            octaves = {float(exponent): (cases, wrong) for exponent, cases, wrong in line.octaves}
            groups.setdefault(_group(method), []).append(curve(method.label, octaves))
    for name, curves in groups.items():
        parts = list(in_parts(curves))
        for number, part in enumerate(parts, start=1):
            yield (f"{name}, part {number}" if len(parts) > 1 else name), list(part)


def _group(method: MeasuredMethod) -> str:
    """Return the name of a method's group."""
    kind, line = method.line.kind, method.line
    if method.exact:
        return "Exact methods"
    if kind in FORMULAS:
        return f"Formulas in {line.tier}, {_SHORT if line.precision in SHORT else _LONG}"
    return {"mesh": "Meshes", "bounding": "Bounding volumes"}.get(kind, str(kind).capitalize())
