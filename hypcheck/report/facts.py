"""What a run found, in a few sentences without a full stop, for reports that are short."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from hypcheck.record import Record
from hypcheck.record.lines import Equation, Finding, Proof
from hypcheck.record.measurements import Bounding, Cost, Kernel
from hypcheck.report.choice import IN_FLOATS
from hypcheck.report.digest import Implementation, implementations, oracle_totals, worst_error_u
from hypcheck.report.measured import NEAREST, Measured, measured, workloads
from hypcheck.report.replays import tolerance_of
from hypcheck.report.text import counted, figure, listed


def oracle_facts(record: Record) -> Iterator[str]:
    """One line for the oracles that were asked, one for those that could not be."""
    totals = oracle_totals(record)
    asked = [f"{total.name} {total.agreed:,} of {total.asked:,}" for total in totals if total.unavailable is None]
    if asked:
        yield f"oracles in agreement: {', '.join(asked)}"
    missing = [f"{total.name} ({total.unavailable})" for total in totals if total.unavailable is not None]
    if missing:
        yield f"oracles not available: {'; '.join(missing)}"


def paper_facts(record: Record) -> Iterator[str]:
    """The paper's equations, the proofs and the mathematical findings."""
    equations = record.of(Equation)
    if equations:
        numbers: dict[str, list[str]] = {}
        for line in equations:
            numbers.setdefault(line.verdict, []).append(f"({line.number})")
        holding = len(numbers.pop("holds", []))
        wrong = "".join(f"; {name}: {listed(those)}" for name, those in numbers.items())
        yield f"equations of the paper: {holding} of {len(equations)} hold{wrong}"
    proofs = record.of(Proof)
    if proofs:
        yield f"proofs: {sum(line.holds for line in proofs)} of {len(proofs)} hold"
    findings = record.of(Finding)
    if findings:
        inside = [line.family for line in findings if line.inside]
        named = f" ({', '.join(dict.fromkeys(inside))})" if inside else ""
        outside = len(findings) - len(inside)
        yield f"wrong in exact arithmetic: {len(inside)} inside the stated regimes{named}, {outside} outside"


def method_facts(record: Record) -> Iterator[str]:
    """For each precision how many methods err beyond the tolerance, and the answer that is farthest from right."""
    tolerance = tolerance_of(record.header.options)
    beyond = "the tolerance" if tolerance is None else f"the tolerance of {figure(tolerance)} u"
    found = [each for each in implementations(record) if each.asked]
    for precision in dict.fromkeys(each.precision for each in found if not each.exact):
        methods = [each for each in found if each.precision == precision and not each.exact]
        wrong = sum(each.statuses.get("wrong", 0) > 0 for each in methods)
        yield f"{precision}: {wrong} of {counted(len(methods), 'method')} beyond {beyond}; {_farthest(methods)}"


_ALSO = {"wrong": "", "tolerated": " (tolerated)", "excused": " (excused as a known failure)"}
"""What is said of the answer farthest off by its status: why it may not count as beyond the tolerance."""


def _farthest(methods: Sequence[Implementation]) -> str:
    """The answer with the greatest backward error; that none is wrong is said only where one was judged."""
    method = max(methods, key=lambda each: worst_error_u(each.worst))
    worst = method.worst
    if worst is not None:
        also = _ALSO.get(worst.status, f" ({worst.status})")
        return f"farthest off: {method.name}, {figure(worst_error_u(worst))} u at {worst.case}{also}"
    judged = any(each.statuses.get(status) for each in methods for status in ("right", *_ALSO))
    return "no answer is wrong" if judged else "no answer was judged"


def claim_facts(record: Record) -> Iterator[str]:
    """What the paper's claims of cost came to."""
    for line in record.of(Cost):
        yield f"claim {line.verdict}, {line.scene}: {line.claim}"


def benchmark_facts(record: Record) -> Iterator[str]:
    """What targets came to, what other shapes cost, where errors end and where they do not."""
    kernels = record.of(Kernel)
    if kernels:
        missed = [str(line.name) for line in kernels if not line.met]
        named = f"; not met: {listed(missed)}" if missed else ""
        yield f"targets of the kernels: {len(kernels) - len(missed)} of {len(kernels)} met{named}"
    for line in record.of(Bounding):
        if line.asked:
            share = figure(100 * line.false_contact / line.asked)
            yield f"a bounding {line.shape} in the spheroid's place, {line.workload}: {share} % false contacts"
    found = [each for each in measured(record) if each.line.kind in IN_FLOATS]
    for name, workload in workloads(record).items():
        yield from _endings(workload.title, name, [each for each in found if name in each.accuracy])


def _endings(title: str, workload: str, found: Sequence[Measured]) -> Iterator[str]:
    """Where the errors of methods in floats end on a workload; who errs at any distance, or who does not, by name."""
    ends = {each: float(each.accuracy[workload].reliable_above) for each in found}
    most = max((each.accuracy[workload].asked for each in found), default=0)
    for precision in ("float64", "float32"):
        mine = {each: end for each, end in ends.items() if each.line.precision == precision and end < math.inf}
        # Who was asked a few rows alone would seem to err less.
        mine = {each: end for each, end in mine.items() if 2 * each.accuracy[workload].asked >= most}
        if mine and max(mine.values()):
            best, worst = min(mine, key=mine.__getitem__), max(mine, key=mine.__getitem__)
            if mine[best] == mine[worst]:
                yield f"{title}, {precision}: {_end(mine[best])}"
                continue
            yield (
                f"{title}, {precision}, the best and the worst: {best.name}, {_end(mine[best])};"
                f" {worst.name}, {_end(mine[worst])}"
            )
    never, others = ([each.name for each in found if (ends[each] == math.inf) == bad] for bad in (True, False))
    if never and len(never) <= len(others):
        yield f"{title}: at no distance reliable: {listed(never)}"
    elif never:
        but = f", all but {listed(others)}" if others else ""
        yield f"{title}: at no distance reliable: {len(never)} of {counted(len(found), 'method')} in floats{but}"


def _end(distance: float) -> str:
    if not distance:
        return "none"
    return "at exact tangencies alone" if distance <= NEAREST else f"errors end at {figure(distance)}"
