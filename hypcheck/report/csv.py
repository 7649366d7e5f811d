"""measurements.csv: every measurement of a record, one on each line, for spreadsheets and statistics.

A line is [kind, method, workload, detail, quantity, value, low, high]: the type of the record's line, the method, the
workload or family, a detail that tells it from similar ones, and the value, with an interval if there is one.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

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

Measurement = tuple[str, str, str, str, Any, Any, Any]
"""Everything after the kind."""


def render(record: Record) -> bytes:
    """The measurements as CSV (RFC 4180) in UTF-8, in the order of the record."""
    stream = io.StringIO()
    writer = csv.writer(stream)
    writer.writerow(HEAD)
    for line in record.lines:
        for measurement in MEASUREMENTS.get(type(line), _none)(line):
            *names, value, low, high = measurement
            writer.writerow([line.type, *map(_harmless, names), *map(_number, (value, low, high))])
    return stream.getvalue().encode("utf-8", "replace")


def _harmless(text: str) -> str:
    """Foreign text, changed so that no spreadsheet reads it as a formula."""
    shown = escaped(text)
    return f"'{shown}" if shown[:1] in ("=", "+", "-", "@") else shown


def _number(value: object) -> str:
    return "" if value is None else str(value)


def _none(_line: RecordLine) -> Iterator[Measurement]:
    return iter(())


def _plain(method: str, workload: str, detail: str, quantity: str, value: object) -> Measurement:
    return method, workload, detail, quantity, value, None, None


def _named(
    *fields: str, method: str = "method", workload: str = "workload", detail: str = ""
) -> Callable[[RecordLine], Any]:
    """Measurements of the named fields of a line."""

    def measurements(line: RecordLine) -> Iterator[Measurement]:
        for name in fields:
            names = (str(getattr(line, key, "")) for key in (method, workload, detail))
            yield (*names, name, getattr(line, name), None, None)

    return measurements


def _group(line: GroupLine) -> Iterator[Measurement]:
    for status, number in line.counts.items():
        yield _plain(line.method, line.family, line.spec or "", status, number)
    for mistake, number in line.mistakes.items():
        yield _plain(line.method, line.family, line.spec or "", mistake, number)
    for exponent, counts in line.octaves.items():
        for status, number in counts.items():
            yield _plain(line.method, line.family, f"octave {exponent}", status, number)


def _timing(line: TimingLine) -> Iterator[Measurement]:
    yield _plain(line.name, line.workload, "batch", "median_ns", line.median_ns)
    for number, sample in enumerate(line.samples_ns):
        yield _plain(line.name, line.workload, f"round {number}", "ns", sample)


def _accuracy(line: AccuracyLine) -> Iterator[Measurement]:
    names = ("asked", "wrong", "false_clear", "false_contact", "wrong_side", "abstained", "reliable_above")
    yield from _named(*names)(line)
    for exponent, asked, wrong in line.octaves:
        for quantity, number in (("asked", asked), ("wrong", wrong)):
            yield _plain(line.method, line.workload, f"octave {exponent}", quantity, number)


def _speed(line: SpeedLine) -> Iterator[Measurement]:
    names = (line.method, line.workload)
    yield (*names, line.mode, "ns", line.median_ns, *line.ci95_ns)
    yield (*names, line.mode, "ratio", line.ratio, *_ends(line.ratio_ci95))
    for process, rounds in enumerate(line.samples_ns):
        for number, sample in enumerate(rounds):
            yield _plain(*names, f"{line.mode}, process {process}, round {number}", "ns", sample)


def _noise(line: NoiseLine) -> Iterator[Measurement]:
    yield ("", line.workload, line.mode, "ratio", line.ratio, *_ends(line.ratio_ci95))
    yield _plain("", line.workload, line.mode, "floor", line.floor)


def _stability(line: StabilityLine) -> Iterator[Measurement]:
    for across, up, asked, wrong in line.bins:
        for quantity, number in (("asked", asked), ("wrong", wrong)):
            yield _plain(line.method, line.precision, f"bin {across} {up}", quantity, number)


def _places(line: PlacesLine) -> Iterator[Measurement]:
    letters = "".join(line.wrong)
    for letter, name in ((".", "right"), ("c", "false_clear"), ("w", "false_contact"), ("s", "wrong_side")):
        yield _plain(line.method, "", line.region, name, letters.count(letter))


def _convergence(line: ConvergenceLine) -> Iterator[Measurement]:
    for name in ("build_ns", "query_ns", "deviation", "asked", "wrong"):
        yield _plain(line.method, "", f"{line.triangles} triangles", name, getattr(line, name))


def _bounding(line: BoundingLine) -> Iterator[Measurement]:
    yield from _named("asked", "false_contact", "false_clear", method="shape")(line)
    for ratio, *values in line.overlap:
        for name, value in zip(("asked", "false_contact", "excess_clearance"), values, strict=True):
            yield _plain(line.shape, line.workload, f"d/b {ratio}", name, value)


def _cost(line: CostLine) -> Iterator[Measurement]:
    for each in line.compared:
        yield (each.name, line.scene, line.claim, "ratio", each.ratio, *_ends(each.ratio_ci95))
        yield _plain(each.name, line.scene, line.claim, "ns", each.median_ns)
        for operation, number in (each.operations or {}).items():
            yield _plain(each.name, line.scene, line.claim, f"operations {operation}", number)


def _kernel(line: KernelLine) -> Iterator[Measurement]:
    yield _plain(line.name, "", line.target, "wanted", line.wanted)
    yield (line.name, "", line.target, "measured", line.measured, *_ends(line.ci95))


def _forest(line: ForestLine) -> Iterator[Measurement]:
    detail = f"{line.trees} trees"
    yield (line.method, "", detail, "step_ns", line.step_ns, *_ends(line.ci95_ns))
    yield (line.method, "", detail, "ratio", line.ratio, *_ends(line.ratio_ci95))
    for name in ("build_s", "asked", "wrong"):
        yield _plain(line.method, "", detail, name, getattr(line, name))


def _scene(line: SceneLine) -> Iterator[Measurement]:
    for name, share in asdict(line.shares).items():
        yield _plain("kernel", line.scene, name, "share", share)
    for name in ("rows", "wrong"):
        yield _plain("kernel", line.scene, "", name, getattr(line, name))
    for mode, times in (("batch", line.batch), ("single", line.single)):
        for name in ("kernel_ns", "printed_ns", "certified_ns"):
            yield _plain("kernel", line.scene, mode, name, getattr(times, name))
        yield ("kernel", line.scene, mode, "by_printed", times.by_printed, *_ends(times.by_printed_ci95))
        yield ("kernel", line.scene, mode, "by_certified", times.by_certified, *_ends(times.by_certified_ci95))


def _comparison(line: ComparisonLine) -> Iterator[Measurement]:
    yield (line.method, line.workload, line.mode, "change", line.change, *_ends(line.ci95))
    for name in ("before", "after", "allowed"):
        yield _plain(line.method, line.workload, line.mode, name, getattr(line, name))


def _ends(interval: Sequence[float] | None) -> tuple[Any, Any]:
    return (None, None) if interval is None else (interval[0], interval[1])


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
