"""Extreme families are asked only on request, and then of implementations without declared ranges."""

from __future__ import annotations

import pytest

from hypcheck.cli.main import main
from hypcheck.record import read
from hypcheck.record.lines import GroupLine

pytestmark = pytest.mark.usefixtures("text_reports")

FAMILY = "extreme-magnitude"


def counts(tmp_path, spec, *options, families=FAMILY):
    out = tmp_path / "out"
    code = main(["verify", spec, "--out", str(out), "--count", "40", "--families", families, *options])
    return code, read(out / "record.jsonl").of(GroupLine)[0].counts


def test_implementation_without_declared_ranges_gets_every_extreme_row(tmp_path):
    code, counted = counts(tmp_path, "python:tests.runs.faulty:exact")
    assert code == 0
    assert counted == {"right": 160}


def test_plain_formula_overflows_on_extreme_rows(tmp_path):
    code, counted = counts(tmp_path, "builtin:dual-float64")
    assert code == 1
    assert counted["wrong"] > 50


@pytest.mark.parametrize("domain", ['{"ratio": [1e-8, 1e8], "magnitude": [1e-6, 1e6]}', '{"magnitude": [1e-6, 1e6]}'])
def test_declared_range_limits_extreme_rows(tmp_path, capsys, domain):
    out = tmp_path / "out"
    options = ["--families", FAMILY, "--domain", domain]
    assert main(["verify", "builtin:dual-float64", "--out", str(out), *options]) == 2
    said = capsys.readouterr().err
    assert f"--families names {FAMILY}, and dual-float64 can be tested on none of its rows: " in said
    assert " of magnitudes outside its domain; leave it out, or set --precision or --domain" in said


def test_families_that_are_not_extreme_skip_rows_outside_ordinary_ranges(tmp_path):
    code, counted = counts(tmp_path, "builtin:dual-float64", families="stiff-both,extreme-hair")
    assert code == 0 or counted.keys() <= {"right", "tolerated", "skipped"}
    assert counted["skipped"] > 50


def test_extreme_case_that_verify_tested_can_be_replayed_and_minimised(capsys):
    assert main(["replay", "extreme-magnitude-0000", "python:tests.runs.faulty:contact_everywhere"]) == 1
    assert "verify skips this case" not in capsys.readouterr().out
    assert main(["minimise", "python:tests.runs.faulty:contact_everywhere", "extreme-magnitude-0000"]) == 0
    assert "the right answer" in capsys.readouterr().out
