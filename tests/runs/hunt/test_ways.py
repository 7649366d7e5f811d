"""`hypcheck hunt` and `minimise` of implementations that answer about ways."""

from __future__ import annotations

import re
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from hypcheck.cli.main import main
from hypcheck.geometry.rows import SWEEPS, invalid
from hypcheck.runs.hunt_search import Climber, neighbours
from hypcheck.runs.hunt_surfaces import ORDINARY_SWEEP, TILTED, sweep_place
from hypcheck.runs.minimise import same_query, small_sweeps
from hypcheck.vectors.cases import read_cases
from hypcheck.vectors.draw import Draw
from hypcheck.vectors.families import SWEEP_FAMILIES
from tests.support.inside import hits_at_size, passage_of_row
from tests.tools.way_agreement import Said, faults

THROUGH = (1.0, 2.0, 1.0, 1.0, 6.0, 0.5, 0.25, -10.0, 0.5, 0.0)
BESIDE = (1.0, 2.0, 1.0, 1.0, 3.0, -3.0, 0.25, 3.0, 3.0, 0.0)
MISSED = "8.25,8,0.25,0.25,20,0,0,-20,0,0"
"""Four samples meet the wall nowhere."""


def test_a_hunt_finds_wrong_answers_and_late_times_and_keeps_their_sweeps(capsys, tmp_path):
    out = tmp_path / "kept.json"
    hunt = ("hunt", "builtin:passage-sampled-4", "--queries", "20", "--out", str(out))
    assert main([*hunt]) == 1
    said = capsys.readouterr().out
    assert re.search(r"^\d\. false-clear, \S+ u", said, flags=re.MULTILINE)
    assert re.search(r"^\d\. late, \S+ spheroid radii, contact between two clear ends", said, flags=re.MULTILINE)
    assert re.search(r"^   time +answered: 0\.\d+; first contact between 0\.", said, flags=re.MULTILINE)
    shown = re.findall(r"^   row +(\S+)  \(alpha, .*, x1, y1, z1\)$", said, flags=re.MULTILINE)
    rows = {tuple(map(float, each.split(","))) for each in shown}
    kept = read_cases(str(out))
    assert rows == {case.row for case in kept.cases}
    assert f"{len(rows)} rows added" in said
    for case in kept.cases:
        assert faults(Said(case.id, case.row, case.first and tuple(map(Fraction, case.first))), 4) == []
    assert main(["replay", shown[0], "builtin:passage-sampled-4"]) == 1
    capsys.readouterr()
    assert main([*hunt]) == 1
    assert "0 rows added, the others were there already" in capsys.readouterr().out


def test_hunt_finds_nothing_in_the_exact_passage(capsys):
    assert main(["hunt", "builtin:passage-exact", "--queries", "30", "--tolerance", "0"]) == 0
    assert "0 answers were wrong" in capsys.readouterr().out


@pytest.mark.thorough  # test_ends.py hunts for tilted sweeps, and beside ends
def test_sweeps_of_tilted_spheroids_are_tested_if_the_implementation_takes_tilt(capsys, tmp_path):
    out = tmp_path / "kept.json"
    words = ("hunt", "python:tests.runs.moving:upright", "--queries", "600", "--show", "1", "--out", str(out))
    assert main([*words, "--isolate", "off"]) == 1  # the implementation answers by hypcheck
    assert "axis_x, axis_y, axis_z)" in capsys.readouterr().out
    assert all(len(case.row) == 13 for case in read_cases(str(out)).cases)
    assert main(["hunt", "builtin:passage-sampled-4", "--queries", "8", "--out", str(out)]) == 2
    assert "content is 'tilted-ways'; here it must be 'ways', rows of 10 numbers" in capsys.readouterr().err


def test_neighbours_of_a_sweep_are_valid_and_brought_to_the_border_of_contact():
    around = neighbours(Draw("test"), [Climber(BESIDE, 1.0, 0.25)], SWEEPS)
    assert not invalid(around.rows, SWEEPS).any()
    numbers, counts = np.unique(around.ladders, return_counts=True)
    longest = numbers[np.argmax(counts)]
    ladder = around.rows[around.ladders == longest]
    others = around.rows[around.ladders == longest + 1]
    assert hits_at_size(ladder[0].tolist()) != hits_at_size(others[0].tolist())
    assert (np.diff(ladder[:, 2]) > 0).all()
    images = around.rows[: (counts == 1).sum()]
    assert (images[:, 4:7] == images[:, 7:10]).all(axis=1).any()


@pytest.mark.slow
def test_minimised_sweep_is_short_and_its_right_answer_is_proved(capsys):
    assert main(["minimise", "builtin:passage-sampled-4", MISSED]) == 0
    said = capsys.readouterr().out
    (shown,) = re.findall(r"^   row +(\S+)  \(alpha, .*, x1, y1, z1\)$", said, flags=re.MULTILINE)
    row = tuple(map(float, shown.split(",")))
    assert len(shown) <= 26
    found = passage_of_row(row)
    assert found.hit
    assert 0 not in (found.start, found.end)
    assert "the right answer: contact" in said
    assert "at the time " in said


def test_sweep_in_other_coordinates_has_the_same_answer():
    for row in [THROUGH, *map(tuple, SWEEP_FAMILIES["tilted-way-uniform"].rows(4, 2).tolist())]:
        hit = hits_at_size(row)
        for other in list(same_query(row, SWEEPS))[:8]:  # units are rounded
            assert hits_at_size(other) == hit
    assert len(set(small_sweeps())) == len(small_sweeps())


@pytest.mark.parametrize(
    ("changes", "kind"),
    [
        ({}, "contact between two clear ends"),
        ({7: 0.0}, "contact towards the end"),
        ({4: 0.0}, "begun in contact"),
        ({4: 12.0, 7: 9.0}, ORDINARY_SWEEP),
        ({7: 6.0, 8: 0.5, 9: 0.25}, "nothing moves"),
        ({4: 2.0, 5: -3.0, 6: 0.0, 7: 2.0, 8: 3.0}, "contact for an instant"),
        ({4: 4.0, 5: 0.0, 6: 0.0, 7: 2.25, 8: 0.0}, "across the ring"),
        ({0: 9.0, 4: 1.0, 7: 0.0}, "clear inside"),
        ({4: 9.0, 7: 9.0, 9: 5.0}, "a vertical sweep"),
        ({4: 9.0, 7: 99999.0}, "a long sweep"),
    ],
)
def test_place_of_a_sweep_names_what_happens_on_it(changes, kind):
    row = tuple(changes.get(place, value) for place, value in enumerate(THROUGH))
    place = sweep_place(row)
    assert place.kind == place.cause == kind


def test_the_place_of_a_sweep_says_that_the_spheroid_is_tilted():
    row = (*THROUGH[:3], 0.5, *THROUGH[4:], 1.0, 0.0, 1.0)
    assert TILTED in sweep_place(row).words
    assert TILTED not in sweep_place((*row[:10], 0.0, 0.0, 2.0)).words
    assert replace(sweep_place(row), words="").cause == "contact between two clear ends"
