"""The principal figure of a benchmark: the share of wrong answers against flip distance, one curve a method."""

from __future__ import annotations

from collections.abc import Iterator

from hypcheck.record import Record
from hypcheck.record.measurements import Accuracy
from hypcheck.report.measured import TIERS, Measured, measured, principal, workloads
from hypcheck.report.plots.curves import Curve, curve, in_parts, plot
from hypcheck.report.plots.svg import Plot

FORMULAS = ("paper", "algebraic", "certified")
"""Kinds that are compared within a tier and a length of float; other kinds are each a group."""

SHORT = ("float16", "bfloat16", "float32")
_SHORT, _LONG = "float32 and shorter", "float64 and longer"


def plots(record: Record) -> Iterator[Plot]:
    """For the workload near contact, or the first, a plot for each group of methods."""
    for number, (group, curves) in enumerate(_groups(measured(record), principal(record))):
        yield plot(f"errors-{number}", group, curves)


def others(record: Record) -> Iterator[Plot]:
    """The same for every other workload, of the methods that are wrong there."""
    found, known = measured(record), workloads(record)
    for place, workload in enumerate(name for name in known if name != principal(record)):
        wrong = [each for each in found if workload in each.accuracy and each.accuracy[workload].wrong]
        for number, (group, curves) in enumerate(_groups(wrong, workload)):
            yield plot(f"errors-{place}-{number}", f"{known[workload].title}: {group}", curves)


def _groups(found: list[Measured], workload: str) -> Iterator[tuple[str, list[Curve]]]:
    groups: dict[str, list[Curve]] = {}
    for each in sorted(found, key=lambda each: TIERS.index(each.tier)):
        line = each.accuracy.get(workload)
        if line is not None and line.asked:
            groups.setdefault(_group(each), []).append(_curve(each.name, line))
    for name, curves in groups.items():
        parts = list(in_parts(curves))
        for number, part in enumerate(parts, start=1):
            yield (f"{name}, part {number}" if len(parts) > 1 else name), list(part)


def _group(each: Measured) -> str:
    kind, line = each.line.kind, each.line
    if each.exact:
        return "Exact methods"
    if kind in FORMULAS:
        return f"Formulas in {line.tier}, {_SHORT if line.precision in SHORT else _LONG}"
    return {"mesh": "Meshes", "bounding": "Bounding volumes"}.get(kind, str(kind).capitalize())


def _curve(name: str, line: Accuracy) -> Curve:
    return curve(name, {float(exponent): (asked, wrong) for exponent, asked, wrong in line.octaves})
