"""The facts of a whole run, in sentences without a full stop: each fact about several lines, stated once.

The facts of one line are in facts.py and benchmark_facts.py, the advice of a benchmark in advice.py, and the changes
between two runs in changes.py.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from hypcheck.messages import counted
from hypcheck.record import Record
from hypcheck.record.lines import FindingLine, ProofLine
from hypcheck.record.measurements import BoundingLine, SpeedLine, UnmeasuredLine
from hypcheck.report import model
from hypcheck.report.advice import IN_FLOATS
from hypcheck.report.benchmark_facts import facts_of, sentences_of
from hypcheck.report.measured import NEAREST, MeasuredMethod, SweepTotal, measured_methods, sweep_totals, workloads
from hypcheck.report.messages import figure, implementation_claims, listed, pace, tolerance_of


def oracle_facts(record: Record, *, held: bool = False) -> Iterator[str]:
    """Yield a sentence about the used oracles, and one about the unavailable oracles.

    `held`: the verdict says already that no used oracle disagreed.
    """
    totals = model.oracle_totals(record)
    agreements = [f"{total.name} {total.agreed:,} of {total.asked:,}" for total in totals if total.unavailable is None]
    if agreements and not held:
        yield f"oracles in agreement: {', '.join(agreements)}"
    missing = [f"{total.name} ({total.unavailable})" for total in totals if total.unavailable is not None]
    if missing:
        yield f"oracles not available: {'; '.join(missing)}"


def paper_facts(record: Record, *, held: bool = False) -> Iterator[str]:
    """Yield sentences about the paper's equations, the proofs and the mathematical findings.

    `held`: the verdict says already that all proofs hold.
    """
    equations = {name: [f"({number})" for number in numbers] for name, numbers in model.equations(record).items()}
    total, holding = sum(map(len, equations.values())), len(equations.pop("holds"))
    if total:
        wrong = "".join(f"; {name}: {listed(numbers)}" for name, numbers in equations.items() if numbers)
        yield f"equations of the paper: {holding} of {total} hold{wrong}"
    proofs = record.of(ProofLine)
    if proofs and not held:
        yield f"proofs: {sum(line.holds for line in proofs)} of {len(proofs)} hold"
    findings = record.of(FindingLine)
    if findings:
        inside = [line.family for line in findings if line.inside]
        named = f" ({', '.join(dict.fromkeys(inside))})" if inside else ""
        outside = len(findings) - len(inside)
        yield f"wrong in exact arithmetic: {len(inside)} inside the stated regimes{named}, {outside} outside"


def method_facts(record: Record) -> Iterator[str]:
    """Yield a sentence for each precision: how many methods err beyond the tolerance, and the greatest error."""
    tolerance = tolerance_of(record.header.options)
    beyond = "the tolerance" if tolerance is None else f"the tolerance of {figure(tolerance)} u"
    totals = [total for total in model.implementations(record) if total.asked and not total.gated]
    for precision in dict.fromkeys(total.precision for total in totals if not total.exact):
        methods = [total for total in totals if total.precision == precision and not total.exact]
        wrong = sum(total.statuses.get("wrong", 0) > 0 for total in methods)
        yield f"{precision}: {wrong} of {counted(len(methods), 'method')} beyond {beyond}; {_farthest(methods)}"


_REMARKS = {"wrong": "", "tolerated": " (tolerated)", "excused": " (excused as a known failure)"}
"""Remarks about the worst answer by its status: why it may not count as beyond the tolerance."""


def _farthest(methods: Sequence[model.ImplementationTotal]) -> str:
    """Return a clause about the answer with the greatest backward error; else whether any answer was judged."""
    method = max(methods, key=lambda total: model.worst_error_u(total.worst))
    worst = method.worst
    if worst is not None:
        also = _REMARKS.get(worst.status, f" ({worst.status})")
        return f"farthest off: {method.name}, {figure(model.worst_error_u(worst))} u at {worst.case}{also}"
    judged = any(total.statuses.get(status) for total in methods for status in ("right", *_REMARKS))
    return "no answer is wrong" if judged else "no answer was judged"


def benchmark_facts(record: Record) -> Iterator[str]:
    """Yield sentences about a benchmark: the cost of other shapes, and the distances at which errors end."""
    yield from sentences_of(record, BoundingLine)
    for method in sweep_totals(record):
        yield _sweep_fact(method)
    methods = [method for method in measured_methods(record) if method.line.kind in IN_FLOATS]
    for name, workload in workloads(record).items():
        yield from _endings(workload.title, name, [method for method in methods if name in method.accuracy])


def _sweep_fact(total: SweepTotal) -> str:
    """Return a sentence about the errors of a method for sweeps, and its cost per sweep."""
    missed, false = (figure(100 * total.share(part)) for part in (total.missed, total.false))
    silent = f", {figure(100 * total.share(total.abstained))} % cannot say" if total.abstained else ""
    time = "" if total.time_ns is None else f", {figure(total.time_ns / 1000)} µs a sweep"
    ratio = "" if total.ratio is None else f" ({pace(total.ratio, 'the reference')})"
    wrong = f"{missed} % missed contacts, {false} % false contacts{silent}, of {total.asked:,} sweeps"
    return f"{total.name}: {wrong}{time}{ratio}"


def _endings(title: str, workload: str, methods: Sequence[MeasuredMethod]) -> Iterator[str]:
    """Yield where the errors of methods in floats end on a workload, and which methods err at any distance."""
    ends = {method: float(method.accuracy[workload].reliable_above) for method in methods}
    most = max((method.accuracy[workload].asked for method in methods), default=0)
    for precision in ("float64", "float32"):
        mine = {method: end for method, end in ends.items() if method.line.precision == precision and end < math.inf}
        # A method that answered only a few rows would seem to err less.
        mine = {method: end for method, end in mine.items() if 2 * method.accuracy[workload].asked >= most}
        if mine and max(mine.values()):
            best, worst = min(mine, key=mine.__getitem__), max(mine, key=mine.__getitem__)
            if mine[best] == mine[worst]:
                yield f"{title}, {precision}: {_end(mine[best])}"
                continue
            yield (
                f"{title}, {precision}, the best and the worst: {best.name}, {_end(mine[best])};"
                f" {worst.name}, {_end(mine[worst])}"
            )
    never, others = ([method.name for method in methods if (ends[method] == math.inf) == bad] for bad in (True, False))
    if never and len(never) <= len(others):
        yield f"{title}: at no distance reliable: {listed(never)}"
    elif never:
        but = f", all but {listed(others)}" if others else ""
        yield f"{title}: at no distance reliable: {len(never)} of {counted(len(methods), 'method')} in floats{but}"


def _end(distance: float) -> str:
    """Return in words the distance at which errors end; "none" if no answer is wrong."""
    if not distance:
        return "none"
    return "at exact tangencies alone" if distance <= NEAREST else f"errors end at {figure(distance)}"


def tested_facts(record: Record, *, held: bool) -> Iterator[str]:
    """Yield what gated implementations declare, and how they were tested.

    `held`: the verdict says already which rows were skipped, how many were fresh and, if --families chose among the
    families, which were left out.
    """
    left_out = not (held and record.header.options.get("families"))
    for tested in model.under_test(record):
        if tested.started is None:
            continue
        claims = implementation_claims(tested.started, {} if held else tested.not_asked, left_out=left_out)
        yield from (f"{tested.name}: {claim}" for claim in claims)
        if tested.fresh and not held:
            yield f"{tested.name}: {counted(tested.fresh, 'fresh row')}"


def timing_facts(record: Record) -> Iterator[str]:
    """Yield one sentence with the median time of each contender; nothing if none was timed."""
    totals = [f"{total.name} {figure(total.median_ns)}" for total in model.timing_totals(record)]
    if totals:
        yield f"ns a row: {', '.join(totals)}"


def unmeasured_facts(record: Record) -> Iterator[str]:
    """Yield sentences about the measurements without a time, and about samples dropped as impossible."""
    for facts in facts_of(record, UnmeasuredLine):
        yield f"not measured: {facts.name}: {facts.line.reason}"
    dropped = [(speed, speed.dropped) for speed in record.of(SpeedLine) if speed.dropped]
    if dropped:
        number = sum(samples for _, samples in dropped)
        where = listed([f"{speed.method} ({speed.workload}, {speed.mode})" for speed, _ in dropped])
        yield f"{counted(number, 'sample')} dropped, no longer than the empty call that is taken off: {where}"
