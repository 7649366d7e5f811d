"""Sections about errors: by family, distance, workload, size and place; of meshes, bounding volumes and sweeps."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from msgspec import UNSET

from hypcheck.implementations.description import QUESTIONS
from hypcheck.record import Record, measurements
from hypcheck.record.fields import numbers_of
from hypcheck.record.lines import FaultPart, GroupLine, WrongAnswer
from hypcheck.report import document
from hypcheck.report.colours import MISTAKES, STEPS
from hypcheck.report.measured import (
    SweepTotal,
    is_unstable,
    is_wrong_somewhere,
    measured_methods,
    principal,
    reference,
    stability_title,
    sweep_totals,
    workloads,
)
from hypcheck.report.messages import Replays, figure, from_hex, rows_not_asked
from hypcheck.report.model import ImplementationTotal, implementations, worst_u
from hypcheck.runs.judge import Mistake, Status, truth_in_words

MOST_CASES = 12
"""Cases of one implementation that are shown, the worst first; the record keeps up to three for each family."""

HEAT = tuple((f"share-{place}", words) for place, (_, words) in enumerate(STEPS))

_BAD = {status.value for status in Status} - {"right", "skipped", "tolerated", "refused", "excused"}

_FAMILY_DISTANCE = document.prose(
    "The *distance to the other answer* is the least relative change of a case's inputs that leads to another position;"
    " of a tilted spheroid, what it is proved to be at least. A method"
    " whose errors end at a distance can be trusted beyond it. All families together, tolerated answers among the"
    " wrong; a point stands for up to three octaves."
)


def family_sections(record: Record) -> Iterator[document.Section]:
    """Yield sections about every family of every judged method and about the worst cases; only the page has them."""
    totals = [total for total in implementations(record) if total.asked or total.statuses]
    if not totals:
        return
    if any(group.octaves for total in totals for group in total.groups):
        yield document.Section(
            "Wrong answers by distance", (document.Paragraph(_FAMILY_DISTANCE), document.Figures("octaves")), page=True
        )
    size = document.Figures("sizes", small=True, legend=HEAT)
    place = document.Figures("fields", small=True, legend=HEAT)
    blocks = (
        document.Details("By the sizes of the bodies, α/b and γ/d", (size,)),
        document.Details("By the place, r/α and |z|/γ", (place,)),
    )
    yield document.Section("Where the wrong answers lie", blocks, page=True)
    yield document.Section("Family by family", tuple(_families(record, totals)), page=True)


def _families(record: Record, totals: Sequence[ImplementationTotal]) -> Iterator[document.Block]:
    """Yield a folded block for each gated implementation, and two for all built-in methods."""
    replays = Replays.of(record)
    for total in totals:
        if total.gated:
            yield document.Details(total.name, (_family_table([total]), *_cases([total], replays)))
    builtin = [total for total in totals if not total.gated]
    if builtin:
        yield document.Details("All methods and families", (_family_table(builtin),))
        yield document.Details("Their worst cases", tuple(_cases(builtin, replays)))


def _family_table(totals: Sequence[ImplementationTotal]) -> document.TableBlock:
    """Make the table of families, with columns for the statuses that occurred."""
    seen = [status.value for status in Status if any(status.value in total.statuses for total in totals)]
    mistakes, several = _mistakes(totals), len(totals) > 1
    fresh, left_out = any(total.fresh for total in totals), any(total.not_asked for total in totals)
    rows = [
        (
            *([document.Code(total.name)] if several else []),
            *_status_row(group, seen, mistakes, fresh=fresh),
            *([rows_not_asked(group.not_asked or {})] if left_out else []),
        )
        for total in totals
        for group in total.groups
    ]
    numbers = ("asked", *(["fresh"] if fresh else []), *seen, *(name.replace("-", " ") for name in mistakes))
    counted = " | ".join(f"# {name}" for name in numbers)
    why = " | why not asked" if left_out else ""
    return document.table(
        "families", f"{'method | ' if several else ''}family | {counted} | # worst error in u{why}", rows
    )


def _mistakes(totals: Sequence[ImplementationTotal]) -> list[str]:
    """Return the kinds of mistakes that are possible for the questions of these methods."""
    about_sweeps = {QUESTIONS[total.question].layout.has_end for total in totals}
    of_positions = [Mistake.WRONG_SIDE] if False in about_sweeps else []
    of_times = [Mistake.LATE, Mistake.EARLY] if True in about_sweeps else []
    return [mistake.value for mistake in (Mistake.FALSE_CLEAR, Mistake.FALSE_CONTACT, *of_positions, *of_times)]


def _status_row(group: GroupLine, seen: Sequence[str], names: Sequence[str], *, fresh: bool) -> document.Row:
    """Make the row of a family; `seen` and `names` are the statuses and the mistakes that have columns."""
    error = worst_u(group)
    failing = _BAD if group.failing is UNSET else group.failing
    statuses = [document.count(group.counts.get(status, 0), bad=status in failing) for status in seen]
    mistakes = [document.count(group.mistakes.get(name, 0)) for name in names]
    worst = document.TableCell(figure(error) if error else document.NONE, error)
    new = [document.count(group.fresh or 0)] if fresh else []
    return (document.Code(group.family), document.count(group.asked), *new, *statuses, *mistakes, worst)


def _cases(totals: Sequence[ImplementationTotal], replays: Replays) -> Iterator[document.TableBlock]:
    """Yield a table of the worst cases, at most MOST_CASES of a method, and a table of cases without an answer."""
    worst = [(total, group, case) for total in totals for group in total.groups for case in group.worst]
    if worst:
        worst.sort(key=lambda of: -of[2].backward_error_u)
        kept = [of for total in totals for of in [one for one in worst if one[0] is total][:MOST_CASES]]
        columns = "case | method | truth | answer | mistake | # wrong by, u | status | look at it with"
        yield document.table("worst cases", columns, [_case(*of, replays) for of in kept])
    faults = [(total, group, case) for total in totals for group in total.groups for case in group.faults or ()]
    if faults:
        columns = "case | method | ended | because | look at it with"
        yield document.table(
            "cases without an answer", columns, [_fault(*of, replays) for of in faults[: 5 * MOST_CASES]]
        )


def _case(total: ImplementationTotal, group: GroupLine, case: WrongAnswer, replays: Replays) -> document.Row:
    """Make the row of a wrong or tolerated answer."""
    return (
        document.Code(case.case, from_hex(numbers_of(case))),
        document.Code(total.name),
        truth_in_words(case.truth, group.question),
        str(case.answer),
        case.mistake,
        document.measured(case.backward_error_u),
        _status(case),
        document.Code(replays.command(group, case)),
    )


def _fault(total: ImplementationTotal, group: GroupLine, case: FaultPart, replays: Replays) -> document.Row:
    """Make the row of a case without an answer."""
    shown, command = document.Code(case.case, from_hex(numbers_of(case))), document.Code(replays.command(group, case))
    return (shown, document.Code(total.name), _status(case), case.reason, command)


def _status(case: WrongAnswer | FaultPart) -> document.TableCell:
    """Make the cell of a case's status."""
    return document.TableCell(case.status, tone="bad" if case.status in _BAD else "")


_WORKLOAD_DISTANCE = document.prose(
    "The *distance to the other answer* is the least relative change of a case's inputs that leads to another position:"
    " a method whose curve has come down can be trusted to the right of it. A point stands for up to three octaves."
)
_SIZE_DISTANCE = document.prose(
    "The *distance to the other answer* of a sweep is the least relative change of b and d together that leads to it,"
    " estimated in floats: a method whose curve has come down can be trusted to the right of it. A point stands for up"
    " to three octaves."
)
_FRONT = document.prose(
    "Lower is right nearer to contact, farther left is faster; the line joins the methods that no other beats in both."
    " Every mark has a tooltip. The *worst of all workloads* includes those that are only judged, such as the ring."
)
_TABLE = document.prose(
    "*False clear* (dangerous) calls a contact clear, *false contact* is an invisible wall. *Reliable above*:"
    " the distance to the other answer beyond which at most 1 in 1000 answers is wrong; 0 where none is, ∞ where there"
    " is no such distance."
)
FRONT = document.Figures(
    "front", "error against run time near contact, and with the errors of all workloads", "front.svg"
)
PARETO = document.Figures("pareto", "error against run time on the other workloads", "pareto.svg")
ERRORS = document.Figures("errors", "share of wrong answers against distance to the other answer", "errors.svg")

_PLACES = tuple((role, words) for words, role in MISTAKES.values())


def error_sections(record: Record) -> Iterator[document.Section]:
    """Yield sections about the errors of a benchmark's methods: by distance, by workload, by size and by place."""
    if record.of(measurements.AccuracyLine):
        about_sweeps = list(sweep_sections(record))
        yield from about_sweeps
        blocks: tuple[document.Block, ...] = (document.Paragraph(_FRONT), FRONT, PARETO)
        if record.of(measurements.SpeedLine) and not about_sweeps:
            yield document.Section("Error against run time", blocks)
        others = document.Details(
            "On the other workloads, the methods that are wrong there", (document.Figures("other-errors"),)
        )
        distance = _SIZE_DISTANCE if about_sweeps else _WORKLOAD_DISTANCE
        yield document.Section("Wrong answers by distance", (document.Paragraph(distance), ERRORS, others))
        yield document.Section("Wrong answers by workload", (document.Paragraph(_TABLE), _workload_table(record)))
    yield from _maps(record)


def _workload_table(record: Record) -> document.Block:
    """Make the table of wrong answers, with a row for each method and workload."""
    titles = {name: line.title for name, line in workloads(record).items()}
    rows = [
        (document.Code(method.name), titles[name], *_workload_row(line))
        for method in measured_methods(record)
        for name, line in method.accuracy.items()
    ]
    columns = (
        "method | workload | # asked | # wrong | # false clear | # false contact | # wrong side | # abstained"
        " | # reliable above | case farthest from contact"
    )
    return document.table("wrong answers by workload", columns, rows)


def _workload_row(line: measurements.AccuracyLine) -> document.Row:
    """Make the cells about a method's answers on a workload."""
    worst = max(line.worst, key=lambda case: case.flip_distance, default=None)
    reliable = line.reliable_above
    return (
        document.count(line.asked),
        document.count(line.wrong),
        document.count(line.false_clear, bad=True),
        document.count(line.false_contact),
        document.count(line.wrong_side),
        document.count(line.abstained),
        document.TableCell(figure(reliable), reliable, "bad" if reliable == math.inf else ""),
        document.Code(worst.case, from_hex((*worst.row, *(worst.axis or ())))) if worst else "",
    )


def _maps(record: Record) -> Iterator[document.Section]:
    """Yield sections with pictures of errors: over the sizes of the bodies, and over places in the half plane."""
    if record.of(measurements.StabilityLine):
        words = "Share of wrong answers over the sizes of the bodies, α/b across and γ/d up, in half decades."
        figures = document.Figures("stability", small=True, legend=HEAT)
        never = _never_wrong(
            "Wrong nowhere: ",
            [stability_title(line) for line in record.of(measurements.StabilityLine) if not is_unstable(line)],
        )
        yield document.Section("Stability", (document.Paragraph(words), figures, never), page=True)
    places = record.of(measurements.PlacesLine)
    if places:
        wrong = {line.method for line in places if is_wrong_somewhere(line)}
        words = "Grid points of the half plane, distance from the axis across and height up, in metres."
        figures = document.Figures("places", small=True, legend=_PLACES)
        never = _never_wrong(
            "Wrong at none of the grid points: ",
            [name for name in dict.fromkeys(line.method for line in places) if name not in wrong],
        )
        yield document.Section("Where the wrong answers lie", (document.Paragraph(words), figures, never), page=True)


def _never_wrong(words: str, names: Sequence[str]) -> document.Block:
    """Make a list whose only item names these methods; it is empty without names."""
    return document.bullets([(words, document.joined([document.Code(name) for name in names]), ".")] if names else [])


_MESHES = document.prose(
    "A mesh in place of the hyperboloid errs by its deviation; more triangles reduce it, and cost time. A build makes"
    " one mesh, a query decides one position."
)
_BOUNDS = document.prose(
    "Another shape around the spheroid is never clear where the spheroid is not, so a *false clear* would be a fault;"
    " it costs invisible walls: the less the spheroid resembles the shape, the more of them."
)


def peer_sections(record: Record) -> Iterator[document.Section]:
    """Yield sections about meshes and bounding volumes: their errors and their times."""
    if record.of(measurements.ConvergenceLine):
        yield document.Section(
            "Meshes",
            (
                document.Paragraph(_MESHES),
                document.Figures("convergence"),
                document.table_of("meshes", record.of(measurements.ConvergenceLine), _MESH_CELLS),
            ),
        )
    if record.of(measurements.BoundingLine):
        lines = record.of(measurements.BoundingLine)
        yield document.Section(
            "Bounding volumes",
            (
                document.Paragraph(_BOUNDS),
                document.Figures("bounding"),
                document.table_of("bounding volumes", lines, _BOUND_CELLS),
                _overlaps(lines),
            ),
        )


_MESH_CELLS: document.Cells[measurements.ConvergenceLine] = {
    "method": lambda line: document.Code(line.method),
    "# triangles": lambda line: document.count(line.triangles),
    "# deviation, radii": lambda line: document.measured(line.deviation),
    "# asked": lambda line: document.count(line.asked),
    "# wrong": lambda line: document.count(line.wrong),
    "# query, ns": lambda line: document.measured(line.query_ns),
    "# build, ns": lambda line: document.measured(line.build_ns),
}

_BOUND_CELLS: document.Cells[measurements.BoundingLine] = {
    "shape": lambda line: line.shape,
    "workload": lambda line: line.workload,
    "# asked": lambda line: document.count(line.asked),
    "# false contact": lambda line: document.count(line.false_contact),
    "# share": lambda line: document.share(line.false_contact, line.asked),
    "# false clear": lambda line: document.count(line.false_clear, bad=True),
}


def _overlaps(lines: list[measurements.BoundingLine]) -> document.TableBlock:
    """Make the table of false contacts by the ratio d/b of the spheroid."""
    rows = [
        (
            line.shape,
            line.workload,
            document.measured(ratio),
            document.count(int(cases)),
            document.count(int(contacts)),
            document.share(contacts, cases),
            document.measured(excess),
        )
        for line in lines
        for ratio, cases, contacts, excess in line.overlap
    ]
    columns = "shape | workload | # d/b | # asked | # false contact | # share | # median excess clearance, radii"
    return document.table("bounding volumes by shape of the spheroid", columns, rows)


_SWEEPS = document.prose(
    "A *missed contact* (dangerous) is a sweep that was called clear and has contact; a *false contact* closes a"
    " sweep that is clear. Counts are of all workloads together; a slow method is asked fewer sweeps. A wrong answer"
    " is measured by the change of b and d that makes it right: half of the wrong answers need at least what stands"
    " under *wrong by*, about, and *worst* is the greatest that was found (∞: no change below 100 % is enough, as"
    " where the centre goes through the surface). Times are medians of a sweep in a batch."
)
_SWEEP_FRONT = document.Figures("front", "missed contacts and false contacts against the time of a sweep", "front.svg")


def sweep_sections(record: Record) -> Iterator[document.Section]:
    """Yield the section that compares methods for sweeps; nothing if the benchmark is about positions."""
    totals = sweep_totals(record)
    if totals:
        yield document.Section(
            "Missed and false contacts against time",
            (document.Paragraph(_SWEEPS), _SWEEP_FRONT, _sweep_table(record, totals)),
        )


def _sweep_table(record: Record, totals: list[SweepTotal]) -> document.TableBlock:
    """Make the table of missed and false contacts, with a row for each method."""
    where = workloads(record)[principal(record)].title
    mistakes = ("sweeps", "missed contacts", "share", "false contacts", "share", "cannot say", "wrong by", "worst")
    columns = (
        document.Column("method"),
        *map(document.number, mistakes),
        document.number("µs a sweep", hint=f"on the workload: {where}"),
        document.against(reference(record)),
    )
    return document.table("missed and false contacts", columns, [_sweep_row(total) for total in totals])


def _sweep_row(total: SweepTotal) -> document.Row:
    """Make the row of a method for sweeps."""
    return (
        document.Code(total.name),
        document.count(total.asked),
        document.count(total.missed, bad=True),
        document.share(total.missed, total.asked),
        document.count(total.false),
        document.share(total.false, total.asked),
        document.count(total.abstained),
        _size(total, total.typical),
        _size(total, total.worst),
        document.measured(None if total.time_ns is None else total.time_ns / 1000),
        document.paced(total.ratio, total.ratio_ci95),
    )


def _size(total: SweepTotal, size: float) -> document.TableCell:
    """Make the cell of a change of the spheroid's size in per cent; NONE if no answer of the method was wrong."""
    if not total.missed and not total.false:
        return document.TableCell(document.NONE, 0.0)
    return document.TableCell(f"{figure(100 * size)} %" if size < math.inf else "∞", size)
