"""The page of the record: the matrix of engines and families, what each got wrong by distance, and a badge for each."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from json import dumps
from pathlib import Path

from hypcheck.engines.engine import ENGINES
from hypcheck.engines.findings import Finding, read_findings
from hypcheck.engines.measure import EngineRecord, Measured, Reported, read_records
from hypcheck.engines.placing import FAMILIES

READING = """## How to read this

Every number is a length in millimetres at a cooling tower of 2 m radius. A wrong answer's error is how far the body
is from the other answer, proved for each row; 0 means that no answer was wrong, not that none can be.

**A mesh is not the surface, and that is nobody's fault.** All engines here but none of the truth see triangles, and
the first number of a cell is mostly the mesh's: the row *an exact answer about the mesh* shows what the best possible
engine would have in its place. Twice as fine a mesh makes it four times smaller. An engine without an ellipsoid was
given the hull of 222 points on the spheroid, which is up to 2 % of a radius inside it; its first number has that in
it, too. The second number is the engine's *own* error: its answer is not that of the very triangles it was given. It
is the one to look at, and it is often far below what any simulation needs. Many engines are made for speed and for
resting contacts, compute in float32, or keep a margin on purpose, in metres, which a scene in kilometres or
millimetres turns into something else: the last two columns show that, and no engine promised otherwise.

Rows are drawn near contact, where answers are hard: how many are wrong says nothing about rows drawn elsewhere. Times
are of one busy machine, through the engine's own language, and are there for the order of magnitude.
"""


def write_page(folder: Path) -> None:
    """Write README.md and a badge for each engine, from the records and findings in a folder."""
    records = sorted(read_records(folder), key=lambda record: list(ENGINES).index(record.name))
    findings = read_findings(folder)
    for record in records:
        badge = {"schemaVersion": 1, "label": record.name, "message": _message(record), "color": _colour(record)}
        (folder / f"{record.name}.badge.json").write_text(dumps(badge, ensure_ascii=False) + "\n")
    parts = [_head(records), READING, _matrix(records), _found(findings), _by_distance(records)]
    parts += [_of_engine(record) for record in records]
    (folder / "README.md").write_text("\n".join(parts), encoding="utf-8")


def _head(records: Sequence[EngineRecord]) -> str:
    missing = [name for name in ENGINES if name not in {record.name for record in records}]
    lines = [
        "# What collision engines get wrong",
        "",
        "Made by `make engines`, engine by engine.",
        "[docs/engines.md](../../docs/engines.md) says what is asked and how it is judged.",
        f"Made by hypcheck {records[0].hypcheck} on {records[0].machine}.",
    ]
    lines += ["", f"Not in this run: {', '.join(missing)}."] if missing else []
    return "\n".join([*lines, ""])


def _matrix(records: Sequence[EngineRecord]) -> str:
    exact = {each.family: each.mesh_worst_mm for each in records[0].measured}
    rows = [["*an exact answer about the mesh*", *(f"{_mm(exact.get(name))} / 0" for name in FAMILIES)]]
    for record in records:
        cells = [_cell([each for each in record.measured if each.family == name]) for name in FAMILIES]
        anchor = f"{record.name}-{record.version}".replace(".", "")
        rows.append([f"[{record.name}](#{anchor}) {record.version}", *cells])
    lines = [
        "## Worst error in millimetres",
        "",
        "*on the finest mesh, against the surface* / *own, on any mesh*; – was not asked.",
        "",
        *_table(["engine", *FAMILIES], rows),
        "",
        *(f"- *{name}*: {family.text}" for name, family in FAMILIES.items()),
        "",
    ]
    return "\n".join(lines)


def _cell(measured: Sequence[Measured]) -> str:
    if not measured:
        return "–"
    finest = max(measured, key=lambda each: each.triangles)
    faults = sum(sum(each.faults.values()) for each in measured)
    lost = f", {faults} lost" if faults else ""
    return f"{_mm(finest.worst_mm)} / {_mm(max(each.own_worst_mm for each in measured))}{lost}"


def _found(findings: Sequence[Finding]) -> str:
    rows = [
        [
            each.engine,
            each.said,
            each.proved,
            _mm(each.error_mm),
            f"[{each.file}]({each.file}), [picture]({each.picture})",
        ]
        for each in findings
    ]
    lines = [
        "## Findings",
        "",
        "One spheroid and one triangle each, so that no mesh explains it, with a certificate to be checked by hand.",
        "Each file needs the engine alone, and ends with 1 while the engine is wrong.",
        "",
        *_table(["engine", "what it says", "what is proved", "wrong by, mm", "file"], rows),
        "",
    ]
    return "\n".join(lines)


def _by_distance(records: Sequence[EngineRecord]) -> str:
    """False contacts and false clears by distance from contact, of all families on the finest meshes."""
    powers = sorted(
        {each.least_mm for record in records for one in _finest(record) for each in one.decades}, reverse=True
    )
    rows = []
    for record in records:
        sums: dict[float, list[int]] = defaultdict(lambda: [0, 0, 0, 0])
        for each in (decade for one in _finest(record) for decade in one.decades):
            values = (each.false_contacts, each.clear, each.false_clears, each.contacts)
            sums[each.least_mm] = [old + new for old, new in zip(sums[each.least_mm], values, strict=True)]
        rows.append([record.name, *("{}/{} + {}/{}".format(*sums[power]) for power in powers)])
    lines = [
        "## Wrong answers by distance from contact",
        "",
        "*false contacts* + *false clears* of all families on the finest mesh, each of how many rows.",
        "",
        *_table(["engine", *(f"{power:.0e} mm" for power in powers)], rows),
        "",
    ]
    return "\n".join(lines)


def _finest(record: EngineRecord) -> list[Measured]:
    most = max(each.triangles for each in record.measured)
    return [each for each in record.measured if each.triangles == most]


def _of_engine(record: EngineRecord) -> str:
    engine = ENGINES[record.name]
    ball = "its own ball, in float32" if engine.single else "its own ball"
    lines = [
        f"## {record.name} {record.version}",
        "",
        f"A spheroid is the engine's {engine.body}, a ball {ball}. Reported distances are compared with the surface's.",
        f"Record: [{record.name}.json]({record.name}.json).",
        "",
        *_table(
            ["family", "triangles", "false contacts", "false clears", "worst", "own wrong", "own worst", "lost",
             "clear: distance", "contact: depth", "µs"],
            map(_measured_row, record.measured),
        ),
        "",
        *(f"Not asked: {name}, as no spheroid leans." for name in record.skipped),
        "",
    ]  # fmt: skip
    return "\n".join(lines)


def _measured_row(each: Measured) -> list[str]:
    clear, contact = sum(one.clear for one in each.decades), sum(one.contacts for one in each.decades)
    return [
        each.family,
        str(each.triangles),
        f"{each.false_contacts} of {clear}",
        f"{each.false_clears} of {contact}",
        _mm(each.worst_mm),
        f"{each.own} of {each.own_rows}",
        _mm(each.own_worst_mm),
        ", ".join(f"{count} {name}" for name, count in each.faults.items()) or "0",
        _shown(each.distance),
        _shown(each.penetration),
        "–" if each.microseconds is None else f"{each.microseconds:.3g}",
    ]


def _shown(reported: Reported) -> str:
    return "–" if reported.worst_mm is None else f"{_mm(reported.worst_mm)} (median {_mm(reported.median_mm)})"


def _worst(record: EngineRecord) -> float:
    return max(each.own_worst_mm for each in record.measured if FAMILIES[each.family].unit == 1)


def _message(record: EngineRecord) -> str:
    faults = sum(sum(each.faults.values()) for each in record.measured)
    return f"own error {_mm(_worst(record))} mm" + (f", {faults} answers lost" if faults else "")


def _colour(record: EngineRecord) -> str:
    worst = _worst(record)
    return "brightgreen" if worst < 0.001 else "yellow" if worst < 1 else "orange"


def _mm(value: float | None) -> str:
    return "–" if value is None else "0" if value == 0 else f"{value:.2g}"


def _table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    """The lines of a table in Markdown."""
    return [f"| {' | '.join(cells)} |" for cells in (header, ["---"] * len(header), *rows)]
