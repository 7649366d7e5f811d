"""Files as their readers read them: the content must be consistent, and be written again if that is possible."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Callable
from functools import cache
from random import Random
from unittest.mock import patch

from hypcheck.answers import classify_table
from hypcheck.cli.scene import asked_scene
from hypcheck.cli.settings import read_settings
from hypcheck.record.integrity import check, repair
from hypcheck.record.reader import notes, read, recorded_cases
from hypcheck.report import code_hosts, html
from hypcheck.report.drawings import DrawnPlot, ReportContext, drawn_plots
from hypcheck.report.plots import PLOTS
from hypcheck.report.write import render as render_report
from hypcheck.runs.known_failures import read_known_failures, render
from hypcheck.scene.reading import read_scene
from hypcheck.tables import Route
from hypcheck.vectors.cases import read_cases
from hypcheck.vectors.checking import examine
from tests.support.inside import emitted, plan_as_json, plan_lines, plan_of
from tests.support.records import resealed
from tests.tools.fuzz.judging import require_sentence
from tests.tools.fuzz.tables import require_agreement
from tests.tools.fuzz.workplace import folder, kept

LANGUAGES = ("c", "cpp", "rust", "javascript", "python")


def vectors(data: bytes) -> None:
    """A file of cases."""
    file = read_cases(str(kept(data, "cases.json")))
    assert len(file.rows) == len(file.positions)


def refusals(data: bytes) -> None:
    """A file of rows that must be refused."""
    file = read_cases(str(kept(data, "cases.json")))
    assert len(file.rows) == len(file.cases)


def proofs(data: bytes) -> None:
    """A file of cases whose every label is put to the proof."""
    for report in examine([str(kept(data, "cases.json"))]):
        for fault in (*report.head, *report.faults):
            require_sentence(fault.sentence)


def record(data: bytes) -> None:
    """A record; what can be read needs no repair."""
    path, saved = kept(data, "record.jsonl"), folder() / "saved.jsonl"
    found = read(path)
    recorded_cases(found)
    repair(path, saved)
    assert read(saved) == found
    assert check(saved).lost_bytes == 0


def repaired(data: bytes) -> None:
    """A record that is repaired; what comes of it can be read."""
    saved = folder() / "saved.jsonl"
    repair(kept(data, "record.jsonl"), saved)
    read(saved)


def reports(data: bytes) -> None:
    """A record of which every report in text is made."""
    found = read(kept(data, "record.jsonl"))
    notes(found)
    for name in ("terminal", "json", "markdown", "junit", "sarif", "gitlab", "badge"):
        render_report(name, found)
    code_hosts.error_lines(found)


def page(data: bytes) -> None:
    """A record of which the page is made, with the same little picture in the place of each plot.

    Drawing takes 97 % of a page's time, and reading jinja2's templates most of the rest.
    """
    found = read(kept(data, "record.jsonl"))
    with patch.object(html, "_environment", _environment):
        render_report("html", found, ReportContext(drawings=UNDRAWN))


def plots(data: bytes) -> None:
    """A record of which one of the plots is drawn."""
    found = read(kept(data, "record.jsonl"))
    names = sorted(PLOTS)
    drawn_plots(names[len(data) % len(names)], found, {})


UNDRAWN = {name: (DrawnPlot("a plot", "<svg/>"),) for name in PLOTS}
_environment = cache(html._environment)


def with_checksums(data: bytes, random: Random) -> bytes:
    """Half of the records with checksums that fit what they say, so that what stands behind those is reached."""
    if random.random() < 0.5:
        return data
    lines = []
    for text in data.split(b"\n")[:200]:
        with contextlib.suppress(ValueError, RecursionError):
            line = json.loads(text)
            if isinstance(line, dict):
                lines.append(line)
    if lines and lines[-1].get("type") == "footer" and random.random() < 0.9:
        lines[-1]["lines"] = len(lines)
    try:
        return resealed(lines)
    except (ValueError, RecursionError):
        return data


def scene(data: bytes) -> None:
    """A scene."""
    read_scene(str(kept(data, "scene.toml")))


def plan(data: bytes) -> None:
    """A scene that is planned, told and emitted."""
    found = plan_of(asked_scene(str(kept(data, "scene.toml")), None), "float32" if len(data) % 2 else "float64")
    json.dumps(plan_as_json(found), allow_nan=False)
    list(plan_lines(found))
    emitted(found, LANGUAGES[len(data) % len(LANGUAGES)], ["hypcheck", "emit"])


def known_failures(data: bytes) -> None:
    """Known failures; as they are written they are read again."""
    entries = read_known_failures(kept(data, "known.toml"))
    assert read_known_failures(kept(render(entries).encode(), "again.toml")) == entries


def settings(data: bytes) -> None:
    """A project's settings."""
    found = read_settings(kept(data, "hypcheck.toml"))
    assert found is not None
    assert found.default_map


def table(kind: str) -> Callable[[bytes], None]:
    """A table that is classified, invalid rows refused or marked; what is written of it is what it says."""

    def classified(data: bytes) -> None:
        source, target = kept(data, f"table.{kind}"), folder() / f"answers.{kind}"
        classify_table(Route(str(source), kind, str(target), kind), mark=len(data) % 2 == 0)
        require_agreement(kind, data, target.read_bytes())
        target.unlink()

    return classified
