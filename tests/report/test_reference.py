"""The committed reference run is complete and large, and its reports equal those made from its record."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from hypcheck.record import SCHEMA, read
from hypcheck.record.lines import GroupLine, OracleLine
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


def test_reference_run_tested_many_cases_of_every_family_with_the_oracles(record):
    asked = {}
    for line in record.of(OracleLine):
        asked.setdefault(line.oracle, {})[line.family] = line.asked
        assert line.disagreeing == 0
    upright = select()  # of tilted ones and those with ends the frozen rows are asked
    families = [family for family in select(taken=frozenset({"axis", "heights"})) if family.frozen or family in upright]
    for oracle, least in {"exact": 1_000_000, "nearest": 1_000_000, "roots": 20_000, "mesh": 20_000}.items():
        assert set(asked[oracle]) == {
            family.name for family in families if oracle != "roots" or "heights" not in family.groups
        }
        assert sum(asked[oracle].values()) >= least


def test_reference_reports_equal_those_rendered_from_its_record(record):
    assert json.loads((REFERENCE / "summary.json").read_bytes()) == json.loads(summary.render(record))
    assert (REFERENCE / "junit.xml").read_bytes() == junit.render(record)
    assert (REFERENCE / "report.md").read_bytes() == markdown.render(record, ReportContext(["map.svg"]))


def test_the_page_about_the_reference_run_has_its_numbers(record):
    text = " ".join((REFERENCE / "README.md").read_text(encoding="utf-8").split())
    lines = record.of(OracleLine)
    asked = {name: sum(line.asked for line in lines if line.oracle == name) for name in ("exact", "roots", "mesh")}
    families = len({line.family for line in lines})
    undecided = sum(line.undecided for line in lines if line.oracle == "mesh")
    judged = sum(sum(line.counts.values()) for line in record.of(GroupLine) if line.method == "fast")
    assert f"{asked['exact']:,} cases from {families} families were decided in integers" in text
    assert f"{asked['roots']:,} of them by the pattern of the roots, and {asked['mesh']:,} by FCL" in text
    assert f"FCL leaves {undecided:,} cases undecided" in text
    assert f"on all {judged:,} cases it was judged by" in text
