"""Sections about cost: times, memory, scenes, and the targets and claims of a benchmark."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from msgspec.structs import astuple, fields

from hypcheck.messages import counted
from hypcheck.record import Record
from hypcheck.record.fields import Interval
from hypcheck.record.measurements import (
    ComparisonLine,
    CostLine,
    ForestLine,
    KernelLine,
    MemoryLine,
    RefusedLine,
    SceneLine,
    Shares,
    SpeedLine,
    UnmeasuredLine,
)
from hypcheck.report.document import (
    Block,
    Code,
    Column,
    Figures,
    Item,
    Paragraph,
    Section,
    Strong,
    TableBlock,
    TableCell,
    bullets,
    count,
    number,
    prose,
    table,
)
from hypcheck.report.measured import lost, measured_methods, noise_floor, workloads
from hypcheck.report.messages import figure, with_interval

_TIMES = prose(
    "Medians over interleaved rounds in fresh processes, with 95 % intervals. A ratio is of times in the same round, to"
    " the run's reference; over 1 is slower. *Noise* is the difference of one method from itself: a smaller difference"
    " means nothing. Absolute times do not carry over to another machine, ratios mostly do."
)
_MEMORY = "The growth of a fresh process's peak resident memory while it answers a batch."


def speed_sections(record: Record) -> Iterator[Section]:
    """The times and the memory of methods, with their intervals and the noise of the run."""
    refused = [
        (Code(line.method), f" on {line.workload}, {line.mode}: {line.reason}") for line in record.of(RefusedLine)
    ]
    unmeasured = [
        (Code(line.method), f" on {line.workload}, {line.mode}: {line.reason}") for line in record.of(UnmeasuredLine)
    ]
    if record.of(SpeedLine) or refused or unmeasured:
        blocks: list[Block] = [Paragraph(_TIMES)]
        if refused:
            blocks += [Paragraph("Not timed, because the answers were wrong:"), bullets(refused)]
        if unmeasured:
            blocks += [
                Paragraph("Could not be timed here, which does not fail the run:"),
                bullets(unmeasured),
            ]
        yield Section("Run times", (*blocks, Figures("speeds"), _speed_table(record)))
    if record.of(MemoryLine):
        yield Section("Memory", (Paragraph(_MEMORY), _memory(record)))


def _speed_table(record: Record) -> TableBlock:
    numbers = map(number, ("ratio", "ns a query", "queries a second", "noise", "rows"))
    titles = {name: str(line.title) for name, line in workloads(record).items()}
    rows = [
        (TableCell(Code(each.name)), TableCell(titles[line.workload]), TableCell(line.mode), *_time(record, line))
        for each in measured_methods(record)
        for line in each.speed.values()
    ]
    return table("run times", ("method", "workload", "mode", *numbers, "timed by"), rows)


def _time(record: Record, line: SpeedLine) -> tuple[TableCell, ...]:
    floor = noise_floor(record, line.workload, line.mode)
    median, ratio = float(line.median_ns), line.ratio
    interval = line.ratio_ci95
    if lost(line):
        return (TableCell("–"), TableCell("no more than an empty call"), TableCell("–"), _noise(floor), *_how(line))
    return (
        TableCell("–") if ratio is None else TableCell(with_interval(ratio, interval), ratio),
        TableCell(with_interval(median, line.ci95_ns), median),
        TableCell(figure(1e9 / median), 1e9 / median) if median > 0 else TableCell("–"),
        _noise(floor),
        *_how(line),
    )


def _noise(floor: float | None) -> TableCell:
    return TableCell("–") if floor is None else TableCell(f"± {figure(100 * floor)} %", floor)


def _how(line: SpeedLine) -> tuple[TableCell, TableCell]:
    dropped = f", {counted(line.dropped, 'impossible sample')} dropped" if line.dropped else ""
    return count(line.rows), TableCell(f"{line.timed_by}{dropped}")


def _memory(record: Record) -> TableBlock:
    rows = [
        (
            TableCell(Code(line.method)),
            count(line.rows),
            TableCell(figure(line.peak_bytes / 1e6), line.peak_bytes),
            TableCell(figure(line.peak_bytes / max(1, line.rows)), line.peak_bytes / max(1, line.rows)),
        )
        for line in record.of(MemoryLine)
    ]
    return table("memory", ("method", number("rows"), number("growth, MB"), number("bytes a row")), rows)


_FOREST = prose(
    "A walker's step from Python, one call each, on the same path among the same trees; *building* is the time from a"
    " list of trees to the first answer. *Wrong* answers are counted against rational arithmetic about every tree."
)
_SCENES = prose(
    "Centres spread evenly over each scene's region; the share that each stage of its kernel (`hypcheck emit`) decides."
    " Then the kernel's time, in C, by that of Table 2 as printed, in C, and of the certified kernel of"
    " `classify_scene`, in one thread, many rows by a call and a call for each: below 1 is faster."
)
_STAGES = tuple(each.name for each in fields(Shares))


def scene_sections(record: Record) -> Iterator[Section]:
    """What scenes leave out and save, and the cost of a walker's step in a forest."""
    scenes, forests = record.of(SceneLine), record.of(ForestLine)
    if scenes:
        yield Section("What scenes leave out", (Paragraph(_SCENES), _shares(scenes), _scene_table(scenes)))
    if forests:
        titles = {line.method: line.title for line in forests}
        methods = bullets([(Code(name), f": {title}") for name, title in titles.items()])
        yield Section("A step in a forest", (Paragraph(_FOREST), Figures("forest"), _forest(forests), methods))


def _forest(lines: list[ForestLine]) -> TableBlock:
    numbers = map(number, ("trees", "ns a step", "by hypcheck.Scene's", "building, s", "steps", "wrong"))
    rows = [
        (
            TableCell(Code(line.method)),
            count(line.trees),
            TableCell(with_interval(line.step_ns, line.ci95_ns), line.step_ns),
            _ratio(line.ratio, line.ratio_ci95),
            TableCell(figure(line.build_s), line.build_s),
            count(line.asked),
            count(line.wrong, bad=bool(line.exact)),
        )
        for line in lines
    ]
    return table("a step in a forest", ("asked", *numbers), rows)


def _ratio(ratio: float | None, interval: Interval | None) -> TableCell:
    return TableCell("–") if ratio is None else TableCell(with_interval(ratio, interval), ratio)


def _shares(lines: list[SceneLine]) -> TableBlock:
    numbers = map(number, ("pairs of sizes", *(f"{stage}, %" for stage in _STAGES), "wrong"))
    rows = [
        (
            TableCell(line.scene),
            TableCell(line.question),
            count(line.settings),
            *(TableCell(figure(100 * share), share) for share in astuple(line.shares)),
            count(line.wrong, bad=True),
        )
        for line in lines
    ]
    return table("what decides in scenes", ("scene", "question", *numbers), rows)


def _scene_table(lines: list[SceneLine]) -> TableBlock:
    columns: tuple[Column | str, ...] = (
        "scene",
        "asked",
        *map(number, ("ns a row", "by Table 2's", "by the certified kernel's")),
    )
    rows = [
        (
            TableCell(line.scene),
            TableCell(how),
            TableCell(figure(times.kernel_ns), times.kernel_ns),
            _ratio(times.by_printed, times.by_printed_ci95),
            _ratio(times.by_certified, times.by_certified_ci95),
        )
        for line in lines
        for times, how in ((line.batch, "many by a call"), (line.single, "a call each"))
    ]
    return table("what scenes save", columns, rows)


_TONES = {"does not hold": "bad", "slower": "bad", "holds": "good", "faster": "good"}
_BASELINE = prose(
    "Ratios to the run's reference, here and in the baseline; *change* is their quotient with its 95 % interval."
    " *Slower* means beyond what is allowed even at the interval's lower end; *inconclusive*, that the noise is too"
    " large to tell. Verdicts in brackets are about methods that the baseline does not gate, and decide nothing."
)


def baseline_sections(record: Record) -> Iterator[Section]:
    """The comparison with the baseline; none if there is no baseline."""
    if record.of(ComparisonLine):
        yield Section("Against the baseline", (Paragraph(_BASELINE), _baseline(record.of(ComparisonLine))))


def target_sections(record: Record) -> Iterator[Section]:
    """The paper's claims of cost, and the targets of the kernels."""
    if record.of(CostLine):
        yield Section("The paper's claims of cost", tuple(_claims(record)))
    if record.of(KernelLine):
        yield Section("The kernels' targets", (_kernels(record.of(KernelLine)),))


def _interval(value: float, ends: Interval | None) -> TableCell:
    return TableCell(with_interval(value, ends), value)


def _baseline(lines: list[ComparisonLine]) -> TableBlock:
    numbers = map(number, ("before", "after", "change", "allowed"))
    order = ["slower", "inconclusive", "faster", "same"]
    ranked = sorted(lines, key=lambda line: (not line.gates, order.index(line.verdict)))
    rows = [
        (
            TableCell(Code(line.method)),
            TableCell(line.workload),
            TableCell(line.mode),
            TableCell(figure(line.before), line.before),
            TableCell(figure(line.after), line.after),
            _interval(line.change, line.ci95),
            TableCell(figure(line.allowed), line.allowed),
            _verdict(line),
        )
        for line in ranked
    ]
    return table("against the baseline", ("method", "workload", "mode", *numbers, "verdict"), rows)


def _verdict(line: ComparisonLine) -> TableCell:
    verdict = line.verdict
    return TableCell(verdict, tone=_TONES.get(verdict, "")) if line.gates else TableCell(f"({verdict})")


def costs_by_claim(record: Record) -> dict[str, list[CostLine]]:
    """The claims of cost with their lines, one for each scene."""
    found: dict[str, list[CostLine]] = {}
    for line in record.of(CostLine):
        found.setdefault(line.claim, []).append(line)
    return found


def claim_sections(record: Record) -> Iterator[Section]:
    """The claims of cost with their verdicts, without the tables."""
    items = [
        Item(claim, tuple((Strong(line.verdict), f", {line.scene}. {line.says}") for line in lines))
        for claim, lines in costs_by_claim(record).items()
    ]
    if items:
        yield Section("The paper's claims of cost", (bullets(items),))


def _claims(record: Record) -> Iterator[Block]:
    for claim, lines in costs_by_claim(record).items():
        yield Paragraph(Strong(claim))
        rows = [
            (TableCell(line.scene), TableCell(Strong(line.verdict), tone=_TONES.get(line.verdict, "")), line.says)
            for line in lines
        ]
        yield table("what was measured of a claim", ("scene", "verdict", "what was measured"), rows)
        columns: tuple[Column | str, ...] = ("scene", "compared", *map(number, ("ratio", "ns")), "operations")
        yield table("what was compared", columns, [row for line in lines for row in _compared(line)])


def _compared(line: CostLine) -> Iterator[tuple[TableCell, ...]]:
    for each in line.compared:
        yield (
            TableCell(line.scene),
            TableCell(each.name),
            TableCell("–") if each.ratio is None else _interval(each.ratio, each.ratio_ci95),
            TableCell("–") if each.median_ns is None else TableCell(figure(each.median_ns), each.median_ns),
            TableCell(_operations(each.operations)),
        )


def _operations(counts: Mapping[str, int] | None) -> str:
    return "" if counts is None else ", ".join(f"{number_} {name}" for name, number_ in counts.items())


def _kernels(lines: list[KernelLine]) -> TableBlock:
    columns: tuple[Column | str, ...] = ("kernel", "target", *map(number, ("wanted", "measured")), "met", "which says")
    rows = [
        (
            TableCell(line.name),
            TableCell(line.target),
            TableCell(figure(line.wanted), line.wanted),
            _interval(line.measured, line.ci95),
            TableCell("yes", tone="good") if line.met else TableCell(Strong("no"), tone="bad"),
            TableCell(line.says),
        )
        for line in sorted(lines, key=lambda line: bool(line.met))
    ]
    return table("targets of the kernels", columns, rows)
