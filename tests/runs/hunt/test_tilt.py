"""`hypcheck hunt` and `minimise` of implementations that take tilted spheroids."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from hypcheck.cli.main import main
from hypcheck.geometry.pair import Pair
from hypcheck.geometry.rows import PAIRS
from hypcheck.runs.hunt_search import Climber, neighbours, strata
from hypcheck.runs.hunt_surfaces import TILTED, place_of
from hypcheck.runs.minimise import same_query
from hypcheck.vectors.cases import read_cases
from hypcheck.vectors.draw import Draw
from hypcheck.vectors.families import FAMILIES, TILTED_FAMILIES
from tests.support.tilted_fractions import exact_position

UPRIGHT = "python:tests.runs.leaning:upright"
CALLS_US = ("--isolate", "off")
"""It answers by hypcheck, which an isolated program does not see."""
ROW = (2.0, 5.0, 1.0, 0.5, 2.5, -1.0, 0.5, 1.0, 0.25, -1.0)


@pytest.mark.thorough
@pytest.mark.slow
def test_a_hunt_finds_wrong_answers_about_tilted_spheroids_and_shows_their_rows_with_the_axis(capsys, tmp_path):
    out = tmp_path / "kept.json"
    assert main(["hunt", UPRIGHT, "--queries", "160", "--show", "1", "--out", str(out), *CALLS_US]) == 1
    said = capsys.readouterr().out
    (shown,) = re.findall(r"^   row +(\S+)  \(alpha, .*axis_z\)$", said, flags=re.MULTILINE)
    row = tuple(map(float, shown.split(",")))
    assert len(row) == 10
    assert exact_position(row) != exact_position((*row[:7], 0.0, 0.0, 1.0))
    kept = read_cases(str(out))
    assert f"{len(kept.cases)} rows added" in said
    assert row in {case.row for case in kept.cases}
    assert all(exact_position(case.row) == case.position for case in kept.cases)
    assert main(["cases", "check", str(out)]) == 0
    assert main(["replay", shown, UPRIGHT, *CALLS_US]) == 1


def test_strata_have_tilted_families_where_the_implementation_takes_tilt():
    upright, both = ({stratum.name for stratum in strata(taken=taken)} for taken in (frozenset(), frozenset({"axis"})))
    assert both - upright == {f"the family {name}" for name in TILTED_FAMILIES}


def test_neighbours_of_upright_and_tilted_rows_are_tested_together_and_are_all_valid():
    climbers = [Climber(ROW, 1.0, 0.25), Climber(tuple(FAMILIES["uniform"].rows(1, 1)[0].tolist()), 1.0, 0.25)]
    around = neighbours(Draw("test"), climbers)
    assert around.rows.shape[1] == 10
    assert set(around.owners.tolist()) == {0, 1}
    assert (around.rows[around.owners == 1][:, 7:] == (0, 0, 1)).all()
    assert len(np.unique(around.rows[around.owners == 0][:, 7:], axis=0)) > 4


@pytest.mark.thorough
@pytest.mark.slow
def test_minimised_row_of_a_tilted_failure_is_tilted_and_short(capsys):
    assert main(["minimise", UPRIGHT, "tilted-uniform/1/1/5", *CALLS_US]) == 0
    said = capsys.readouterr().out
    (shown,) = re.findall(r"^   row +(\S+)  \(alpha, .*axis_z\)$", said, flags=re.MULTILINE)
    row = tuple(map(float, shown.split(",")))
    assert len(shown) < 40
    assert (exact_position(row), exact_position((*row[:7], 0.0, 0.0, 1.0))) == (0, -1)
    assert "the right answer: contact" in said


def test_the_same_tilted_pair_in_other_coordinates_has_the_same_position():
    for row in TILTED_FAMILIES["tilted-uniform"].rows(4, 6).tolist():
        position = exact_position(row)
        for other in same_query(tuple(row), PAIRS):
            if all(math.isclose(abs(a), abs(b), rel_tol=1e-9) for a, b in zip(row, other, strict=True)):
                assert exact_position(other) == position


@pytest.mark.parametrize(
    ("change", "kind"),
    [
        ({}, TILTED),
        ({9: 0.0}, "a horizontal axis"),
        ({9: 1000.0}, "a nearly upright axis"),
        ({9: 1e-4}, "a nearly horizontal axis"),
        ({7: 2.5, 8: -1.0}, "the axis in the plane of the centre"),
        ({4: 0.0, 5: 0.0}, "r = 0"),
        ({6: 0.0}, "z = 0"),
    ],
)
def test_the_place_of_a_tilted_spheroid_names_what_is_special_about_its_axis_and_centre(change, kind):
    place = place_of(Pair.from_row([change.get(column, value) for column, value in enumerate(ROW)]))
    assert place.kind == place.cause == kind
    assert place.words.startswith(TILTED)
