"""Sections about cost: times, memory, scenes, and the targets and claims of a benchmark."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from msgspec.structs import astuple, fields

from hypcheck.messages import counted
from hypcheck.record import Record, measurements
from hypcheck.report import document
from hypcheck.report.measured import lost, measured_methods, noise_floor, reference, workloads
from hypcheck.report.messages import figure

_TIMES = document.prose(
    "Medians over interleaved rounds in fresh processes, with 95 % intervals. A method is set *against* the run's"
    " reference in the same rounds. *Noise* is the difference of one method from itself: a smaller difference"
    " means nothing. Times do not carry over to another machine; one method against another mostly does."
)
_MEMORY = "The growth of a fresh process's peak resident memory while it answers a batch."


def speed_sections(record: Record) -> Iterator[document.Section]:
    """Yield sections about the times and the memory of methods."""
    blocks = [
        *_untimed("Not timed, because the answers were wrong:", record.of(measurements.RefusedLine)),
        *_untimed("Could not be timed here, which does not fail the run:", record.of(measurements.UnmeasuredLine)),
    ]
    if record.of(measurements.SpeedLine) or blocks:
        yield document.Section(
            "Run times", (document.Paragraph(_TIMES), *blocks, document.Figures("speeds"), _speed_table(record))
        )
    if record.of(measurements.MemoryLine):
        yield document.Section(
            "Memory",
            (
                document.Paragraph(_MEMORY),
                document.table_of("memory", record.of(measurements.MemoryLine), _MEMORY_CELLS),
            ),
        )


def _untimed(
    words: str, lines: Sequence[measurements.RefusedLine | measurements.UnmeasuredLine]
) -> list[document.Block]:
    """Return an introduction and a list of these lines; nothing if there is no line."""
    items = [(document.Code(line.method), f" on {line.workload}, {line.mode}: {line.reason}") for line in lines]
    return [document.Paragraph(words), document.bullets(items)] if items else []


def _speed_table(record: Record) -> document.TableBlock:
    """Make the table of times, with a row for each method, workload and mode."""
    titles = {name: line.title for name, line in workloads(record).items()}
    rows = [
        (document.Code(method.name), titles[line.workload], line.mode, *_time(record, line))
        for method in measured_methods(record)
        for line in method.speed.values()
    ]
    after = "# ns a query | # queries a second | # noise | # rows | timed by"
    heads = (
        *document.columns("method | workload | mode"),
        document.against(reference(record)),
        *document.columns(after),
    )
    return document.table("run times", heads, rows)


def _time(record: Record, line: measurements.SpeedLine) -> document.Row:
    """Make the cells about a time."""
    floor = noise_floor(record, line.workload, line.mode)
    noise = document.MISSING if floor is None else document.TableCell(f"± {figure(100 * floor)} %", floor)
    dropped = f", {counted(line.dropped, 'impossible sample')} dropped" if line.dropped else ""
    ends = (noise, document.count(line.rows), f"{line.timed_by}{dropped}")
    if lost(line):
        return (document.MISSING, "no more than an empty call", document.MISSING, *ends)
    median = line.median_ns
    rate = document.measured(1e9 / median if median > 0 else None)
    return (document.paced(line.ratio, line.ratio_ci95), document.measured(median, line.ci95_ns), rate, *ends)


_MEMORY_CELLS: document.Cells[measurements.MemoryLine] = {
    "method": lambda line: document.Code(line.method),
    "# rows": lambda line: document.count(line.rows),
    "# growth, MB": lambda line: document.TableCell(figure(line.peak_bytes / 1e6), line.peak_bytes),
    "# bytes a row": lambda line: document.measured(line.peak_bytes / max(1, line.rows)),
}


_FOREST = document.prose(
    "A walker's step from Python, one call each, on the same path among the same trees; *building* is the time from a"
    " list of trees to the first answer. *Wrong* answers are counted against rational arithmetic about every tree."
)
_SCENES = document.prose(
    "Centres spread evenly over each scene's region; the share that each stage of its kernel (`hypcheck emit`) decides."
    " Then the kernel's time, in C, against Table 2 as printed, in C, and against the certified kernel of"
    " `classify_scene`, in one thread, many rows by a call and a call for each."
)


def scene_sections(record: Record) -> Iterator[document.Section]:
    """Yield sections about the stages and times of scenes' kernels, and about a walker's step in a forest."""
    scenes, forests = record.of(measurements.SceneLine), record.of(measurements.ForestLine)
    if scenes:
        yield document.Section(
            "What scenes leave out", (document.Paragraph(_SCENES), _shares(scenes), _scene_table(scenes))
        )
    if forests:
        titles = {line.method: line.title for line in forests}
        methods = document.terms((document.Code(name), title) for name, title in titles.items())
        steps = document.table_of("a step in a forest", forests, _FOREST_CELLS)
        yield document.Section(
            "A step in a forest", (document.Paragraph(_FOREST), document.Figures("forest"), steps, methods)
        )


_FOREST_CELLS: document.Cells[measurements.ForestLine] = {
    "asked": lambda line: document.Code(line.method),
    "# trees": lambda line: document.count(line.trees),
    "# ns a step": lambda line: document.measured(line.step_ns, line.ci95_ns),
    "# against hypcheck.Scene": lambda line: document.paced(line.ratio, line.ratio_ci95),
    "# building, s": lambda line: document.measured(line.build_s),
    "# steps": lambda line: document.count(line.asked),
    "# wrong": lambda line: document.count(line.wrong, bad=line.exact),
}


def _shares(lines: list[measurements.SceneLine]) -> document.TableBlock:
    """Make the table of the shares of rows that each stage of a scene's kernel decides."""
    rows: list[document.Row] = [
        (
            line.scene,
            line.question,
            document.count(line.settings),
            *(document.TableCell(figure(100 * part), part) for part in astuple(line.shares)),
            document.count(line.wrong, bad=True),
        )
        for line in lines
    ]
    stages = " | ".join(f"# {field.name}, %" for field in fields(measurements.Shares))
    return document.table("what decides in scenes", f"scene | question | # pairs of sizes | {stages} | # wrong", rows)


def _scene_table(lines: list[measurements.SceneLine]) -> document.TableBlock:
    """Make the table of the times of scenes' kernels."""
    rows = [
        (
            line.scene,
            how,
            document.measured(times.kernel_ns),
            document.paced(times.by_printed, times.by_printed_ci95),
            document.paced(times.by_certified, times.by_certified_ci95),
        )
        for line in lines
        for times, how in ((line.batch, "many by a call"), (line.single, "a call each"))
    ]
    heads = "scene | asked | # ns a row | # against Table 2 | # against the certified kernel"
    return document.table("what scenes save", heads, rows)


_TONES = {"does not hold": "bad", "slower": "bad", "holds": "good", "faster": "good"}
_BASELINE = document.prose(
    "Times by that of the run's reference, here and in the baseline; *change* is their quotient with its 95 % interval."
    " *Slower* means beyond what is allowed even at the interval's lower end; *inconclusive*, that the noise is too"
    " large to tell. Verdicts in brackets are about methods that the baseline does not gate, and decide nothing."
)


def baseline_sections(record: Record) -> Iterator[document.Section]:
    """Yield the section that compares the run with a baseline; nothing if there is no baseline."""
    if record.of(measurements.ComparisonLine):
        order = ["slower", "inconclusive", "faster", "same"]
        lines = sorted(
            record.of(measurements.ComparisonLine), key=lambda line: (not line.gates, order.index(line.verdict))
        )
        compared = document.table_of("against the baseline", lines, _BASELINE_CELLS)
        yield document.Section("Against the baseline", (document.Paragraph(_BASELINE), compared))


def target_sections(record: Record) -> Iterator[document.Section]:
    """Yield sections about the paper's claims of cost, and about the targets of the kernels."""
    if record.of(measurements.CostLine):
        yield document.Section("The paper's claims of cost", tuple(_claims(record)))
    if record.of(measurements.KernelLine):
        lines = sorted(record.of(measurements.KernelLine), key=lambda line: line.met)
        yield document.Section(
            "The kernels' targets", (document.table_of("targets of the kernels", lines, _TARGET_CELLS),)
        )


def _verdict(line: measurements.ComparisonLine) -> document.TableCell:
    """Make the cell of a verdict; it is in brackets if the baseline does not gate the method."""
    verdict = line.verdict
    return (
        document.TableCell(verdict, tone=_TONES.get(verdict, "")) if line.gates else document.TableCell(f"({verdict})")
    )


_BASELINE_CELLS: document.Cells[measurements.ComparisonLine] = {
    "method": lambda line: document.Code(line.method),
    "workload": lambda line: line.workload,
    "mode": lambda line: line.mode,
    "# before": lambda line: document.paced(line.before),
    "# after": lambda line: document.paced(line.after),
    "# change": lambda line: document.measured(line.change, line.ci95),
    "# allowed": lambda line: document.measured(line.allowed),
    "verdict": _verdict,
}


def costs_by_claim(record: Record) -> dict[str, list[measurements.CostLine]]:
    """Return the lines of each claim of cost, one for each scene."""
    claims: dict[str, list[measurements.CostLine]] = {}
    for line in record.of(measurements.CostLine):
        claims.setdefault(line.claim, []).append(line)
    return claims


def claim_sections(record: Record) -> Iterator[document.Section]:
    """Yield the section about the claims of cost with their verdicts, without tables."""
    items = [
        document.Item(claim, tuple((document.Strong(line.verdict), f", {line.scene}. {line.says}") for line in lines))
        for claim, lines in costs_by_claim(record).items()
    ]
    if items:
        yield document.Section("The paper's claims of cost", (document.bullets(items),))


def _claims(record: Record) -> Iterator[document.Block]:
    """Yield each claim of cost with a table of its verdicts and a table of the compared alternatives."""
    for claim, lines in costs_by_claim(record).items():
        yield document.Paragraph(document.Strong(claim))
        verdicts: list[document.Row] = [
            (
                line.scene,
                document.TableCell(document.Strong(line.verdict), tone=_TONES.get(line.verdict, "")),
                line.says,
            )
            for line in lines
        ]
        yield document.table("what was measured of a claim", "scene | verdict | what was measured", verdicts)
        compared = [row for line in lines for row in _compared(line)]
        yield document.table(
            "what was compared", "scene | compared | # against the first | # ns | operations", compared
        )


def _compared(line: measurements.CostLine) -> Iterator[document.Row]:
    """Yield a row for each compared alternative."""
    for alternative in line.compared:
        operations = ", ".join(f"{amount} {name}" for name, amount in (alternative.operations or {}).items())
        yield (
            line.scene,
            alternative.name,
            document.paced(alternative.ratio, alternative.ratio_ci95),
            document.measured(alternative.median_ns),
            operations,
        )


_MET, _MISSED = document.TableCell("yes", tone="good"), document.TableCell(document.Strong("no"), tone="bad")

_TARGET_CELLS: document.Cells[measurements.KernelLine] = {
    "kernel": lambda line: line.name,
    "target": lambda line: line.target,
    "# wanted": lambda line: document.measured(line.wanted),
    "# measured": lambda line: document.measured(line.measured, line.ci95),
    "met": lambda line: _MET if line.met else _MISSED,
    "which says": lambda line: line.says,
}
