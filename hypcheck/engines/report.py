"""The page of the record: findings, own errors by body, what default settings cost, and the files beside it."""

from __future__ import annotations

import csv
import io
import shutil
from collections import defaultdict
from collections.abc import Iterable, Sequence
from json import dumps
from pathlib import Path

import msgspec

from hypcheck.engines.drawings import chart, drawing, own_worst
from hypcheck.engines.engine import ENGINES
from hypcheck.engines.findings import Finding, read_findings, reproduction, template_of
from hypcheck.engines.measure import EngineRecord, Measured, Reported, read_records
from hypcheck.engines.placing import FAMILIES
from hypcheck.report.markdown import table_lines

READING = """## How to read this

Every number is a length in millimetres at a cooling tower of 2 m radius. A wrong answer's error is how far the body
is from the other answer, proved for each row; 0 means that no answer was wrong, not that none can be.

**A mesh is not the surface, and that is nobody's fault.** All engines here but none of the truth see triangles. Twice
as fine a mesh makes that error four times smaller. So the tables below show an engine's *own* error: its answer is not
that of the very triangles that it was given. It is often far below what any simulation needs.

**Settings.** Each engine is asked at its default settings, and again at the tightest that it offers. Its own errors are
those that stay at the tightest; what the defaults cost has a table of its own. python-fcl offers no tolerance, but a
second solver, which errs more here: so it is judged by its default solver, and both are shown. Many engines are made
for speed and for resting contacts, compute in float32, or keep a margin on purpose, in their own unit of length, which
a scene in kilometres or millimetres turns into something else: the last two columns show that, and no engine promised
otherwise.

**Bodies are not alike.** An engine without an ellipsoid was given the hull of 222 points on the spheroid, which is up
to 2 % of a radius inside it; what that explains is no error here. Engines with different bodies stand in different
tables, and are not ranked against each other.

Rows are drawn near contact, where answers are hard: how many are wrong says nothing about rows drawn elsewhere. Times
are of one busy machine, through the engine's own language, and are there for the order of magnitude.
"""

BODIES = {
    "ellipsoid": ("Engines with an ellipsoid", "The spheroid is the engine's ellipsoid, a ball its own ball."),
    "hull": (
        "Engines given a hull",
        "The spheroid is the convex hull of 222 points on it, a ball the engine's own ball.",
    ),
    "scaled ball": (
        "An engine given a ball in a scaled space",
        "The spheroid is the engine's ball in a space scaled by 1/b, 1/b, 1/d; no spheroid is tilted.",
    ),
}
"""For each shape that represents the spheroid: the heading of its table, and a description."""

MEASURED = "measured.csv"
"""The file of all errors, beside the page."""

HEAD = (
    *("engine", "version", "settings", "family", "triangles"),
    *("own wrong", "own rows", "own worst", "lost", "microseconds"),
    *("false contacts", "clear", "false clears", "contacts", "worst"),
    *("distance worst", "distance median", "depth worst", "depth median", "contact and apart"),
)
"""The columns of measured.csv: an engine's own errors; those against the surface; the distances that it reports."""

NEIGHBOURS = """## Neighbours

Reports of the same kinds in the engines' own trackers, and in one that is not asked here:

- a depth that the bodies do not allow: [newton-physics/newton #3766](https://github.com/newton-physics/newton/pull/3766)
  ("the correct penetration is `0.061719 m`", Newton "returns `58.826744 m`": a small cylinder on a large triangle), and
  the report that it answers, [#3773](https://github.com/newton-physics/newton/issues/3773);
  [fcl #503](https://github.com/flexible-collision-library/fcl/issues/503) (depths of two boxes given as meshes);
  [JoltPhysics #1008](https://github.com/jrouwe/JoltPhysics/issues/1008) (a cylinder at the edge of a mesh);
- libccd, which FCL asks about ellipsoids: [#17](https://github.com/danfis/libccd/issues/17) (the location of a contact
  where one body is much larger than the other), [#71](https://github.com/danfis/libccd/issues/71) (the direction of a
  penetration);
- a contact where there is none: [bullet3 #4318](https://github.com/bulletphysics/bullet3/issues/4318) (two triangles of
  GImpact, one behind the other; GImpact is not asked here);
- named to us, and not read for this record:
  [python-fcl #36](https://github.com/BerkeleyAutomation/python-fcl/issues/36).
"""


def write_page(folder: Path) -> None:
    """Write README.md, measured.csv, and a badge and a chart for each engine, from a folder's records and findings."""
    records = sorted(read_records(folder), key=lambda record: list(ENGINES).index(record.name))
    findings = sorted(read_findings(folder), key=_rank)
    for record in records:
        badge = {"schemaVersion": 1, "label": record.name, "message": _message(record), "color": _colour(record)}
        (folder / f"{record.name}.badge.json").write_text(dumps(badge, ensure_ascii=False) + "\n")
        (folder / f"{record.name}.svg").write_text(chart(record), encoding="utf-8")
    parts = [_head(records), READING, _found(findings), *_tables_of_own(records), _defaults(records)]
    parts += [*_by_distance(records), NEIGHBOURS]
    parts += [_of_engine(record) for record in records]
    (folder / "README.md").write_text("\n".join(parts), encoding="utf-8")
    (folder / MEASURED).write_text(measured_csv(records), encoding="utf-8")


def _rank(finding: Finding) -> tuple[int, float]:
    """Return a key that orders findings: contradictions first, then the greatest error relative to the body."""
    return (not finding.contradicts, -finding.of_body)


def write_findings(folder: Path, findings: Sequence[Finding]) -> list[Finding]:
    """Write findings.json and new files of the findings; return the findings with the names of their files."""
    shutil.rmtree(folder / "findings", ignore_errors=True)
    (folder / "findings").mkdir(parents=True)
    named = []
    for finding in findings:
        stem = f"findings/{finding.engine}-{finding.kind.replace(' ', '-')}"
        file, picture = stem + Path(template_of(ENGINES[finding.engine]).stem).suffix, stem + ".svg"
        (folder / file).write_text(reproduction(finding), encoding="utf-8")
        (folder / picture).write_text(drawing(finding), encoding="utf-8")
        named.append(msgspec.structs.replace(finding, file=file, picture=picture))
    (folder / "findings" / "findings.json").write_bytes(msgspec.json.format(msgspec.json.encode(named)) + b"\n")
    return named


def _head(records: Sequence[EngineRecord]) -> str:
    """Return the head of the page, with the version of hypcheck, the machine, and the engines that are missing."""
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


def _found(findings: Sequence[Finding]) -> str:
    """Return the part of the page about the findings."""
    rows = [
        [
            f"{finding.engine} {finding.version}",
            finding.said,
            finding.proved,
            f"{finding.error_mm:.2g}",
            f"{finding.of_body:.1e}",
            _of_tolerance(finding),
            f"[file]({finding.file}), [picture]({finding.picture})",
        ]
        for finding in findings
    ]
    lines = [
        "## Findings",
        "",
        "An error that stays at the tightest settings that the engine offers and is beyond the tolerance that it",
        "states there, or a contradiction in its own answers. One spheroid and one triangle each, so that no mesh",
        "explains it, with a certificate to be checked by hand. Each file needs the engine alone, asks it at default",
        "and at tightest settings, and ends with 1 while the engine is wrong. rapier3d is built on parry3d: what both",
        "say alike is one error of one code.",
        "",
        *table_lines(
            ["engine", "what it says", "what is proved", "error, mm", "of the body", "of the tolerance", ""], rows
        ),
        "*of the body*: the error as a share of the spheroid's least semi-axis. *of the tolerance*: as a multiple of",
        "the length that the engine states at these settings; – if it states none, or 0.",
        "",
        *table_lines(
            ["finding", "default settings", "what it says", "other settings", "what it says", "one unit, mm"],
            _settings(findings),
        ),
    ]
    return "\n".join(lines)


def _settings(findings: Sequence[Finding]) -> list[list[str]]:
    """Return rows of a table: the settings of each finding's engine, and its answers at them."""
    rows = []
    for finding in findings:
        engine, name, unit = ENGINES[finding.engine], f"{finding.engine}, {finding.kind}", f"{finding.millimetres:g}"
        if not engine.adjustable:
            rows.append([name, engine.default.words, finding.said, "none", "–", unit])
            continue
        at_default, at_other = (finding.at_other, finding.said) if engine.tightens else (finding.said, finding.at_other)
        other = f"{engine.other}: {engine.tightest.words}"
        rows.append([name, engine.default.words, at_default, other, at_other, unit])
    return rows


def _of_tolerance(finding: Finding) -> str:
    """Return a finding's error in units of the tolerance that the engine states, as text."""
    tolerance = ENGINES[finding.engine].judged.tolerance
    return f"{finding.error_mm / (tolerance * finding.millimetres):.1e}" if tolerance else "–"


def _tables_of_own(records: Sequence[EngineRecord]) -> Iterable[str]:
    """Yield a table of own errors for each kind of body, because different kinds are not compared."""
    for body, (heading, text) in BODIES.items():
        chosen = [record for record in records if ENGINES[record.name].body == body]
        if chosen:
            rows = [[_link(record), *(_own_cell(record, name) for name in FAMILIES)] for record in chosen]
            lines = [
                f"## {heading}",
                "",
                text,
                "Own worst error on any mesh, in millimetres, at the tightest settings.",
            ]
            yield "\n".join([*lines, "", *table_lines(["engine", *FAMILIES], rows)])
    yield "\n".join([*(f"- *{name}*: {family.text}" for name, family in FAMILIES.items()), ""])


def _link(record: EngineRecord) -> str:
    """Return a link to the part of the page about an engine."""
    anchor = f"{record.name}-{record.version}".replace(".", "")
    return f"[{record.name}](#{anchor})"


def _own_cell(record: EngineRecord, family: str) -> str:
    """Return the cell of a table with an engine's worst own error in a family, and the number of lost answers."""
    measured = [measurement for measurement in record.best if measurement.family == family]
    faults = sum(sum(measurement.faults.values()) for measurement in measured)
    if not measured:
        return "–"
    return _mm(own_worst(measured, family)) + (f", {faults} lost" if faults else "")


def _defaults(records: Sequence[EngineRecord]) -> str:
    """Return a table of errors of adjustable engines at default and tightest settings, for families in metres."""
    rows = []
    for record in records:
        engine = ENGINES[record.name]
        if not engine.adjustable:
            continue
        for label, setting, measurements in (
            ("default", engine.default, record.default),
            (engine.other, engine.tightest, record.tightest),
        ):
            metres = [measured for measured in measurements if FAMILIES[measured.family].unit == 1]
            wrong = f"{sum(measured.own for measured in metres)} of {sum(measured.own_rows for measured in metres)}"
            worst = _mm(max(measured.own_worst_mm for measured in metres))
            rows.append([record.name, label, setting.words, wrong, worst])
    lines = [
        "## What the defaults cost",
        "",
        "Own errors in the families whose unit is a metre. A default is a choice for speed or stability, not a fault.",
        "",
        *table_lines(["engine", "", "settings", "own wrong", "own worst, mm"], rows),
    ]
    return "\n".join(lines)


def _by_distance(records: Sequence[EngineRecord]) -> Iterable[str]:
    """Yield tables of false contacts and false clears by distance from contact, for all families on finest meshes."""
    powers = sorted(
        {shown.least_mm for record in records for one in _finest(record) for shown in one.decades},
        reverse=True,
    )
    for what in ("false contacts", "false clears"):
        rows = []
        for record in records:
            sums: dict[float, list[int]] = defaultdict(lambda: [0, 0])
            for shown in (decade for one in _finest(record) for decade in one.decades):
                wrong = (
                    (shown.false_contacts, shown.clear)
                    if what == "false contacts"
                    else (shown.false_clears, shown.contacts)
                )
                sums[shown.least_mm] = [old + new for old, new in zip(sums[shown.least_mm], wrong, strict=True)]
            rows.append([record.name, *("{} of {}".format(*sums[power]) for power in powers)])
        yield "\n".join(
            [
                f"## {what.capitalize()} by distance from contact",
                "",
                "Against the surface, on the finest mesh, of how many rows in all families; with the mesh's errors.",
                "",
                *table_lines(["engine, mm", *(f"{power:g}" for power in powers)], rows),
            ]
        )


def _finest(record: EngineRecord) -> list[Measured]:
    """Return the measurements on the mesh with most triangles."""
    most = max(measurement.triangles for measurement in record.best)
    return [measurement for measurement in record.best if measurement.triangles == most]


def _of_engine(record: EngineRecord) -> str:
    """Return the part of the page about one engine."""
    engine = ENGINES[record.name]
    ball = "its own ball, in float32" if engine.single else "its own ball"
    settings = (
        f"{engine.default.words}; {engine.other}: {engine.tightest.words}"
        if engine.adjustable
        else engine.default.words
    )
    lines = [
        f"## {record.name} {record.version}",
        "",
        f"A spheroid is the engine's {engine.body}, a ball {ball}. Settings: {settings}.",
        f"Record: [{record.name}.json]({record.name}.json); its errors by family and mesh: [{MEASURED}]({MEASURED}).",
        "",
        f"![Own worst error of {record.name} in each family]({record.name}.svg)",
        "",
        *_of_the_other_setting(record),
        *(f"Not asked: {name}, as {_skipped(reason)}." for name, reason in record.skipped.items()),
        "",
    ]  # fmt: skip
    return "\n".join(lines)


def _of_the_other_setting(record: EngineRecord) -> list[str]:
    """Return a sentence about the errors of depths at an engine's other setting, if that is not a tighter one."""
    engine = ENGINES[record.name]
    depths: dict[str, float] = {}
    for measurement in record.tightest:
        depths[measurement.family] = max(depths.get(measurement.family, 0.0), measurement.penetration.worst_mm or 0.0)
    if engine.tightens or not depths:
        return []
    worst = max(depths, key=lambda family: depths[family])
    text = f"With its {engine.other} the depths that it reports are wrong by up to {_mm(depths[worst])} mm"
    return [f"{text} (family {worst}).", ""]


def _skipped(reason: str) -> str:
    return reason.rstrip(".")


def measured_csv(records: Iterable[EngineRecord]) -> str:
    """Return the CSV of the errors of each engine in each family on each mesh, in millimetres.

    They are the errors at the settings by which the engine is judged.
    """
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(HEAD)
    for record in records:
        settings = "tightest" if ENGINES[record.name].tightens else "default"
        writer.writerows([record.name, record.version, settings, *_measured_row(one)] for one in record.best)
    return stream.getvalue()


def _measured_row(measured: Measured) -> list[object]:
    """Return the cells of one measurement in measured.csv."""
    own = (measured.own, measured.own_rows, measured.own_worst_mm)
    faults = " ".join(f"{count} {name}" for name, count in measured.faults.items()) or "0"
    clear, contact = sum(one.clear for one in measured.decades), sum(one.contacts for one in measured.decades)
    surface = (measured.false_contacts, clear, measured.false_clears, contact, measured.worst_mm)
    reported = (*_reported(measured.distance), *_reported(measured.penetration))
    contradicted = measured.distance.contradicted + measured.penetration.contradicted
    about = (measured.family, measured.triangles)
    return [*about, *own, faults, measured.microseconds, *surface, *reported, contradicted]


def _reported(reported: Reported) -> tuple[float | None, float | None]:
    return reported.worst_mm, reported.median_mm


def _worst(record: EngineRecord) -> float:
    """Return an engine's worst own error over all families in metres, in millimetres."""
    return max(measured.own_worst_mm for measured in record.best if FAMILIES[measured.family].unit == 1)


def _message(record: EngineRecord) -> str:
    """Return the words of an engine's badge."""
    faults = sum(sum(measured.faults.values()) for measured in record.best)
    return f"own error {_mm(_worst(record))} mm" + (f", {faults} answers lost" if faults else "")


def _colour(record: EngineRecord) -> str:
    """Return the colour of an engine's badge, by its worst own error."""
    worst = _worst(record)
    return "brightgreen" if worst < 0.001 else "yellow" if worst < 1 else "orange"


def _mm(value: float | None) -> str:
    """Return millimetres with two digits as text."""
    return "–" if value is None else "0" if value == 0 else f"{value:.2g}"
