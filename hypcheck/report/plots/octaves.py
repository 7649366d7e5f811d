"""How wrong answers depend on the distance to the nearest other position, for each judged method of a verification."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from hypcheck.record import Record
from hypcheck.report.digest import Implementation, implementations
from hypcheck.report.plots.curves import Curve, curve, in_parts, plot
from hypcheck.report.plots.svg import Plot

NOT_WRONG = ("right", "skipped", "abstained", "refused")
"""Statuses of cases that were answered rightly, or not answered."""


def plots(record: Record) -> Iterator[Plot]:
    """A plot for each precision, more of them where the methods are many."""
    found = implementations(record)
    for precision in dict.fromkeys(each.precision for each in found):
        curves = [one for each in found if each.precision == precision and (one := _curve(each)).octaves]
        for number, part in enumerate(in_parts(curves)):
            more = f", part {number + 1}" if len(curves) > len(part) else ""
            yield plot(f"octaves-{precision}-{number}", f"Wrong answers by distance, {precision}{more}", part)


def _curve(each: Implementation) -> Curve:
    """The octaves of all families together; exact ones promise nothing less, and are shown alike."""
    asked: Counter[float] = Counter()
    wrong: Counter[float] = Counter()
    for group in each.groups:
        for exponent, counts in group.octaves.items():
            asked[float(exponent)] += sum(number for status, number in counts.items() if status != "skipped")
            wrong[float(exponent)] += sum(number for status, number in counts.items() if status not in NOT_WRONG)
    return curve(each.name, {exponent: (asked[exponent], wrong[exponent]) for exponent in asked})
