"""What a run says of its evenness: how wide a slice near contact could have escaped it, and which coincidences met."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from hypcheck.cli.main import main
from hypcheck.record import read
from hypcheck.record.lines import ImplementationLine
from hypcheck.runs.spread import COORDINATES, UPRIGHT, evenness
from hypcheck.vectors.border_lines import lattice, upright_at
from hypcheck.vectors.draw import Draw
from hypcheck.vectors.families import FAMILIES


@pytest.fixture(scope="module")
def rows():
    return FAMILIES["strata"].rows(5, 700)


@pytest.fixture
def line_of(tmp_path, monkeypatch, text_reports):
    """What a run of a right implementation says of itself."""
    monkeypatch.chdir(tmp_path)

    def run(*options, families="strata"):
        words = ("verify", "builtin:fast", "--families", families, "--out", "out", *options)
        assert main([*words]) == 0
        (line,) = read(Path("out")).of(ImplementationLine)
        return line

    return run


def test_slice_of_the_reported_width_holds_three_rows_and_a_slice_of_two_coordinates_one_row(rows):
    found = evenness(rows, UPRIGHT)
    places = {name: COORDINATES[name](rows) for name in UPRIGHT}
    for low in np.linspace(0, 1 - found.one, 997):
        for some in places.values():
            assert ((some >= low) & (some <= low + found.one)).sum() >= 3
    lows = np.linspace(0, 1 - found.two, 23)
    for first in UPRIGHT:
        for second in UPRIGHT:
            for low in lows if first != second else ():
                inside = (places[first] >= low) & (places[first] <= low + found.two)
                assert all(
                    (inside & (places[second] >= other) & (places[second] <= other + found.two)).any() for other in lows
                )


def test_distance_to_contact_is_that_at_which_a_row_was_made(rows):
    off = np.exp2(-40 + 10 * (np.arange(256) + 0.5) / 256)
    points = lattice(Draw("any", 1), 256)
    points[5] = 0.1  # outside, where every spheroid that touches does so in one point
    for made in (upright_at(points, off), upright_at(points, -off)):
        found = COORDINATES["distance to contact"](made)
        assert np.isfinite(found).mean() > 0.9
        known = np.isfinite(found)
        assert np.abs(found - (np.arange(256) + 0.5) / 256)[known].max() < 0.01


def test_rows_deep_in_contact_do_not_count_in_the_slices_near_contact(rows):
    deep = rows.copy()
    deep[:, 2:4] *= 2
    assert evenness(np.concatenate([rows, deep]), UPRIGHT) == evenness(rows, UPRIGHT)


@pytest.mark.parametrize("name", UPRIGHT)
def test_the_widest_range_of_values_without_a_tested_row_is_reported(rows, name):
    places = COORDINATES[name](rows)
    left = evenness(rows[(places < 0.4) | (places > 0.5)], UPRIGHT)
    assert left.one > 0.1 - 1e-12
    assert left.two > 0.1 - 1e-12
    assert evenness(rows, UPRIGHT).one < 0.02


def test_two_rows_leave_slices_as_wide_as_the_whole_range_untested(rows):
    assert (evenness(rows[:2], UPRIGHT).one, evenness(rows[:2], UPRIGHT).two) == (1.0, 1.0)


def test_a_run_reports_how_evenly_it_tested_and_a_thorough_run_tests_ten_times_as_many_rows(line_of, capsys):
    usual = line_of("--count", "8", families="strata,coincidences")
    said = capsys.readouterr().out
    assert re.search(r"every slice of [\d.]+ % of .* or distance to contact was asked 3", said)
    assert "coincidences, three together: 383 of 383 that are possible were asked" in said
    thorough = line_of("--count", "8", "--thorough")
    assert read(Path("out")).header.options["count"] == 80
    assert 220 < usual.slices["strata"].rows <= 240 + 80
    assert 800 < thorough.slices["strata"].rows <= 240 + 800
    assert thorough.slices["strata"].one < usual.slices["strata"].one
    assert thorough.slices["strata"].two < usual.slices["strata"].two


def test_rows_outside_the_domain_do_not_count_in_the_slices_of_a_run(line_of):
    everything = line_of("--count", "3").slices["strata"]
    some = line_of("--count", "3", "--domain", '{"ratio": [0.125, 8]}', families="strata,coincidences").slices["strata"]
    assert some.rows < everything.rows
    assert some.one > everything.one


def test_run_that_gave_the_implementation_up_reports_no_slices_and_no_coincidences(tmp_path, monkeypatch, text_reports):
    (tmp_path / "ends.py").write_text("import os\n\n\ndef f(rows):\n    os._exit(0)\n")
    monkeypatch.chdir(tmp_path)
    words = (
        "python:ends.py:f",
        "--families",
        "strata,coincidences",
        "--count",
        "0",
        "--restarts",
        "0",
        "--out",
        "out",
    )
    assert main(["verify", *words]) == 1
    (line,) = read(Path("out")).of(ImplementationLine)
    assert not line.slices
    assert not line.crossed
