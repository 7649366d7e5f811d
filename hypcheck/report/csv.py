"""measurements.csv: every measurement of a record, one on each line, for spreadsheets and statistics.

A line is [kind, method, workload, detail, quantity, value, low, high]: the type of the record's line, the method, the
workload or family, a detail that tells it from similar ones, and the value, with an interval if there is one.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from msgspec import UNSET
from msgspec.structs import asdict

from hypcheck.messages import escaped
from hypcheck.record import Record, RecordLine
from hypcheck.record.lines import FindingLine, GroupLine, MapLine, OracleLine, TimingLine
from hypcheck.record.measurements import (
    AccuracyLine,
    BoundingLine,
    ComparisonLine,
    ConvergenceLine,
    CostLine,
    ForestLine,
    KernelLine,
    MemoryLine,
    NoiseLine,
    PlacesLine,
    SceneLine,
    SpeedLine,
    StabilityLine,
)

HEAD = ("kind", "method", "workload", "detail", "quantity", "value", "low", "high")

Measurement = tuple[Any, ...]
"""Method, workload, detail, quantity and value, and the two ends of its interval if it has one."""


def render(record: Record) -> bytes:
    """The measurements as CSV (RFC 4180) in UTF-8, in the order of the record."""
    stream = io.StringIO()
    writer = csv.writer(stream)
    writer.writerow(HEAD)
    for line in record.lines:
        measurements = MEASUREMENTS.get(type(line))
        for method, workload, detail, quantity, *figures in measurements(line) if measurements else ():
            value, low, high = figures if len(figures) > 1 else (*figures, None, None)
            names = map(_harmless, (method, workload, detail, quantity))
            writer.writerow([line.type, *names, *map(_number, (value, low, high))])
    return stream.getvalue().encode("utf-8", "replace")


def _harmless(text: str) -> str:
    """Foreign text, changed so that no spreadsheet reads it as a formula."""
    shown = escaped(text)
    return f"'{shown}" if shown[:1] in ("=", "+", "-", "@") else shown


def _number(value: object) -> str:
    return "" if value is None else str(value)


def _fields(line: object, method: str, workload: str, detail: str, *fields: str) -> Iterator[Measurement]:
    """A measurement for each of these fields of a line or of a part of it."""
    for name in fields:
        yield method, workload, detail, name, getattr(line, name)


def _named(
    *fields: str, method: str = "method", workload: str = "workload", detail: str = ""
) -> Callable[[RecordLine], Iterator[Measurement]]:
    """Measurements of fields of a line whose method, workload and detail are the fields of these names."""

    def measurements(line: RecordLine) -> Iterator[Measurement]:
        names = [str(getattr(line, key, "")) for key in (method, workload, detail)]
        return _fields(line, *names, *fields)

    return measurements


def _group(line: GroupLine) -> Iterator[Measurement]:
    if line.fresh is not UNSET:
        yield line.method, line.family, line.spec or "", "fresh", line.fresh
    for reason, number in (line.not_asked or {}).items():
        yield line.method, line.family, line.spec or "", f"not asked: {reason}", number
    for counts in (line.counts, line.mistakes):
        for name, number in counts.items():
            yield line.method, line.family, line.spec or "", name, number
    for exponent, counts in line.octaves.items():
        for status, number in counts.items():
            yield line.method, line.family, f"octave {exponent}", status, number


def _timing(line: TimingLine) -> Iterator[Measurement]:
    yield line.name, line.workload, "batch", "median_ns", line.median_ns
    for number, sample in enumerate(line.samples_ns):
        yield line.name, line.workload, f"round {number}", "ns", sample


def _accuracy(line: AccuracyLine) -> Iterator[Measurement]:
    names = ("asked", "wrong", "false_clear", "false_contact", "wrong_side", "abstained", "reliable_above")
    yield from _fields(line, line.method, line.workload, "", *names)
    for exponent, asked, wrong in line.octaves:
        for quantity, number in (("asked", asked), ("wrong", wrong)):
            yield line.method, line.workload, f"octave {exponent}", quantity, number


def _speed(line: SpeedLine) -> Iterator[Measurement]:
    yield line.method, line.workload, line.mode, "ns", line.median_ns, *line.ci95_ns
    yield line.method, line.workload, line.mode, "ratio", line.ratio, *(line.ratio_ci95 or ())
    for process, rounds in enumerate(line.samples_ns):
        for number, sample in enumerate(rounds):
            yield line.method, line.workload, f"{line.mode}, process {process}, round {number}", "ns", sample


def _noise(line: NoiseLine) -> Iterator[Measurement]:
    yield "", line.workload, line.mode, "ratio", line.ratio, *(line.ratio_ci95 or ())
    yield "", line.workload, line.mode, "floor", line.floor


def _stability(line: StabilityLine) -> Iterator[Measurement]:
    for across, up, asked, wrong in line.bins:
        for quantity, number in (("asked", asked), ("wrong", wrong)):
            yield line.method, line.precision, f"bin {across} {up}", quantity, number


def _places(line: PlacesLine) -> Iterator[Measurement]:
    letters = "".join(line.wrong)
    for letter, name in ((".", "right"), ("c", "false_clear"), ("w", "false_contact"), ("s", "wrong_side")):
        yield line.method, "", line.region, name, letters.count(letter)


def _convergence(line: ConvergenceLine) -> Iterator[Measurement]:
    detail = f"{line.triangles} triangles"
    return _fields(line, line.method, "", detail, "build_ns", "query_ns", "deviation", "asked", "wrong")


def _bounding(line: BoundingLine) -> Iterator[Measurement]:
    yield from _fields(line, line.shape, line.workload, "", "asked", "false_contact", "false_clear")
    for ratio, *values in line.overlap:
        for name, value in zip(("asked", "false_contact", "excess_clearance"), values, strict=True):
            yield line.shape, line.workload, f"d/b {ratio}", name, value


def _cost(line: CostLine) -> Iterator[Measurement]:
    for each in line.compared:
        yield each.name, line.scene, line.claim, "ratio", each.ratio, *(each.ratio_ci95 or ())
        yield each.name, line.scene, line.claim, "ns", each.median_ns
        for operation, number in (each.operations or {}).items():
            yield each.name, line.scene, line.claim, f"operations {operation}", number


def _kernel(line: KernelLine) -> Iterator[Measurement]:
    yield line.name, "", line.target, "wanted", line.wanted
    yield line.name, "", line.target, "measured", line.measured, *(line.ci95 or ())


def _forest(line: ForestLine) -> Iterator[Measurement]:
    detail = f"{line.trees} trees"
    yield line.method, "", detail, "step_ns", line.step_ns, *(line.ci95_ns or ())
    yield line.method, "", detail, "ratio", line.ratio, *(line.ratio_ci95 or ())
    yield from _fields(line, line.method, "", detail, "build_s", "asked", "wrong")


def _scene(line: SceneLine) -> Iterator[Measurement]:
    for name, share in asdict(line.shares).items():
        yield "kernel", line.scene, name, "share", share
    yield from _fields(line, "kernel", line.scene, "", "rows", "wrong")
    for mode, times in (("batch", line.batch), ("single", line.single)):
        yield from _fields(times, "kernel", line.scene, mode, "kernel_ns", "printed_ns", "certified_ns")
        yield "kernel", line.scene, mode, "by_printed", times.by_printed, *(times.by_printed_ci95 or ())
        yield "kernel", line.scene, mode, "by_certified", times.by_certified, *(times.by_certified_ci95 or ())


def _comparison(line: ComparisonLine) -> Iterator[Measurement]:
    yield line.method, line.workload, line.mode, "change", line.change, *(line.ci95 or ())
    yield from _fields(line, line.method, line.workload, line.mode, "before", "after", "allowed")


MEASUREMENTS: dict[type[RecordLine], Callable[[Any], Iterable[Measurement]]] = {
    OracleLine: _named("asked", "undecided", "disagreeing", "seconds", method="oracle", workload="family"),
    FindingLine: _named("asked", "wrong", method="formula", workload="family", detail="cause"),
    GroupLine: _group,
    MapLine: _named("points", "wrong", workload="name"),
    TimingLine: _timing,
    AccuracyLine: _accuracy,
    SpeedLine: _speed,
    NoiseLine: _noise,
    MemoryLine: _named("peak_bytes", detail="rows"),
    StabilityLine: _stability,
    PlacesLine: _places,
    ConvergenceLine: _convergence,
    BoundingLine: _bounding,
    CostLine: _cost,
    KernelLine: _kernel,
    ForestLine: _forest,
    SceneLine: _scene,
    ComparisonLine: _comparison,
}
"""The measurements in each type of line; other types have none."""
