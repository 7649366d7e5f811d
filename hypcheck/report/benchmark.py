"""What fails a benchmark, and what it shows where nothing does."""

from __future__ import annotations

from collections.abc import Iterator

from hypcheck.pairs import Position
from hypcheck.record import Line, Record
from hypcheck.report.failure import Failure
from hypcheck.report.measured import Measured, measured
from hypcheck.report.text import classify_command, counted, figure, from_hex, listed

SUBJECT = "measurement"


def failures(record: Record) -> Iterator[Failure]:
    """Promises of exactness that were broken, answers that were other ones while they were timed, slowness, noise."""
    for each in measured(record):
        if each.exact:
            yield from _broken(each)
    for line in record.of("refused"):
        group = f"{line['workload']}, {line['mode']}"
        yield Failure(SUBJECT, line["method"], group, "refused", f"{line['method']} is not timed: {line['reason']}")
    for verdict in ("slower", "inconclusive"):
        for line in record.of("comparison"):
            if line["verdict"] == verdict and line.get("gates", True):
                yield _compared(line)


def _broken(each: Measured) -> Iterator[Failure]:
    for workload, line in each.accuracy.items():
        if line["wrong"] or line["abstained"]:
            message = f"{each.name} promises to be exact, but {_of(line)}"
            case = next(iter(line["worst"]), None)
            if case is None:
                yield Failure(SUBJECT, each.name, workload, "wrong", message)
                continue
            truth = Position(case["truth"]).label
            message += f"; {case['case']} is {truth}, and the answer was {case['answer']}"
            replay = classify_command(from_hex(case["row"]))
            yield Failure(SUBJECT, each.name, workload, "wrong", message, case["case"], replay=replay)


def _of(line: Line) -> str:
    parts = [f"{line[name]:,} {word}" for name, word in (("wrong", "wrong"), ("abstained", "not told")) if line[name]]
    return f"of {counted(line['asked'], 'answer')} {listed(parts)}"


def _compared(line: Line) -> Failure:
    change, allowed = figure(line["change"]), figure(line["allowed"])
    interval = "" if line["ci95"] is None else f" ({' to '.join(figure(each) for each in line['ci95'])})"
    words = "is slower than the baseline allows" if line["verdict"] == "slower" else "was too noisy to compare"
    message = f"{line['method']} {words}: {change} times its former ratio{interval}, allowed {allowed}"
    return Failure(SUBJECT, line["method"], f"{line['workload']}, {line['mode']}", line["verdict"], message)


def clauses(record: Record) -> Iterator[str]:
    """What a benchmark in which nothing failed has shown."""
    found = [each for each in measured(record) if each.asked or each.speed]
    if not found:
        return
    timed = sum(bool(each.speed) for each in found)
    workloads = {name for each in found for name in each.accuracy} | {name for each in found for name, _ in each.speed}
    yield f"{counted(len(found), 'method')} compared on {counted(len(workloads), 'workload')}, {timed:,} of them timed"
    exact = [f"{each.name} ({each.asked:,})" for each in found if each.exact and each.asked]
    if exact:
        yield f"right on every row: {listed(exact)}"
    compared = record.of("comparison")
    if compared:
        slower = sum(line["verdict"] == "slower" for line in compared)
        yield f"{counted(len(compared), 'ratio')} held to the baseline's, {slower:,} of them slower than allowed"
