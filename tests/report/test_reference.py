"""The committed reference run is complete and large, and its reports equal those made from its record."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from hypcheck.record import SCHEMA, read
from hypcheck.record.lines import OracleLine
from hypcheck.report import junit, markdown, summary
from hypcheck.report.drawings import ReportContext
from hypcheck.vectors.families import select
from hypcheck.version import VERSION

REFERENCE = Path(__file__).resolve().parents[2] / "reports" / "reference"


@pytest.fixture(scope="module")
def record():
    return read(REFERENCE / "record.jsonl")


def test_reference_run_is_complete_of_this_version_and_without_failures(record):
    assert record.header.hypcheck == VERSION
    assert record.header.schema.partition(".")[0] == SCHEMA.partition(".")[0]
    assert record.footer.exit_code == 0


def test_reference_run_asked_the_oracles_many_cases_of_every_family(record):
    asked = {}
    for line in record.of(OracleLine):
        asked.setdefault(line.oracle, {})[line.family] = line.asked
        assert line.disagreeing == 0
    newer = {"coincidences", "strata"}  # families made after the reference run
    families = {family.name for family in select()} - newer
    for oracle, least in {"exact": 1_000_000, "nearest": 1_000_000, "roots": 20_000, "mesh": 20_000}.items():
        assert set(asked[oracle]) == families
        assert sum(asked[oracle].values()) >= least


def test_reference_reports_equal_those_rendered_from_its_record(record):
    assert json.loads((REFERENCE / "summary.json").read_bytes()) == json.loads(summary.render(record))
    assert (REFERENCE / "junit.xml").read_bytes() == junit.render(record)
    assert (REFERENCE / "report.md").read_bytes() == markdown.render(record, ReportContext(["map.svg"]))
