"""`hypcheck hunt` and `minimise` of implementations that take the heights between which a hyperboloid ends."""

from __future__ import annotations

import re

import pytest

from hypcheck.cli.main import main
from hypcheck.geometry.pair import Pair
from hypcheck.geometry.rows import PAIRS, SWEEPS, invalid
from hypcheck.runs import hunt_search
from hypcheck.runs.hunt_search import Climber, neighbours
from hypcheck.runs.hunt_surfaces import ENDED, place_of, place_of_row
from hypcheck.vectors.cases import read_cases
from hypcheck.vectors.draw import Draw
from hypcheck.vectors.families import ENDED_FAMILIES, ENDED_SWEEP_FAMILIES

CENTRE_ALONE = """
hypcheck = {"takes": ["axis", "heights"]}

def side_of_centre(rows):
    alpha, gamma, _, _, x, y, z, *_, low, high, _ = rows.T
    inside = ((x / alpha) ** 2 + (y / alpha) ** 2 <= 1 + (z / gamma) ** 2) & (low <= z) & (z <= high)
    return 1 - 2 * inside.astype(int)
"""
ENDLESS = """
hypcheck = {"takes": ["heights"]}

def without_its_ends(rows):
    alpha, gamma, b, d, x, y, z, *_ = rows.T
    return ((x / alpha) ** 2 + (y / alpha) ** 2 > 1 + (z / gamma) ** 2).astype(int)
"""
A_LITTLE_SMALLER = """
import numpy, hypcheck as right
hypcheck = {"takes": ["heights"]}

def smaller_beside_one_end(rows):
    rows = rows.copy()
    rows[numpy.isfinite(rows[:, -3]) != numpy.isfinite(rows[:, -2]), 2:4] *= 1 - 1e-9
    return right.classify(rows)
"""
NEVER = """
hypcheck = {"takes": ["end", "axis", "heights"], "question": "passage"}

def never(rows):
    return [0] * len(rows)
"""
PIERCED = (5.0, 5.0, 0.5, 0.5, 0.0, 0.0, 1.2, 0.0, 0.0, 1.0, -3.0, 1.0, 1.0)
LANDING = (2.0, 17.8, 0.25, 0.15, 0.0, 0.0, 18.5, 2.8, 0.0, 17.9, 0.0, 0.0, 1.0, -17.8, 17.8, 0.0)
"""It comes down on the rim."""


def program(folder, text):
    """A SPEC of the text's function."""
    path = folder / "wrong.py"
    path.write_text(text, encoding="utf-8")
    return f"python:{path}:{re.findall('def (.*)[(]', text)[0]}"


@pytest.mark.parametrize(("text", "width", "most"), [(CENTRE_ALONE, 13, 60), (NEVER, 16, 20)])
def test_a_hunt_tests_ends_if_the_implementation_takes_heights_and_keeps_its_findings(
    text, width, most, capsys, tmp_path
):
    spec, out = program(tmp_path, text), tmp_path / "kept.json"
    assert main(["hunt", spec, "--queries", str(most), "--show", "1", "--out", str(out)]) == 1
    said = capsys.readouterr().out
    assert ENDED in said
    (shown,) = re.findall(r"^   row +(\S+)  \(alpha, .*z_min, z_max, solid\)$", said, flags=re.MULTILINE)
    kept = read_cases(str(out)).cases
    assert tuple(map(float, shown.split(","))) in {case.row for case in kept}
    assert {len(case.row) for case in kept} == {width}
    assert main(["cases", "check", str(out)]) == 0
    assert main(["replay", shown, spec]) == 1


@pytest.mark.thorough  # it takes 7,400 rows to get there
def test_hunt_continues_beside_wrong_answers_of_an_implementation_that_takes_heights_but_no_axis(capsys, tmp_path):
    spec = program(tmp_path, A_LITTLE_SMALLER)
    assert main(["hunt", spec, "--queries", "7500", "--show", "1", "--isolate", "off"]) == 1
    assert "7,500 rows asked" in capsys.readouterr().out


@pytest.mark.parametrize("axis_z", [1.0, -1.0, 0.25, -3e300])
def test_an_upright_axis_may_have_any_length_where_heights_are_taken_and_no_axis(axis_z, capsys, tmp_path):
    row = ",".join(map(repr, (*PIERCED[:9], axis_z, *PIERCED[10:])))
    assert main(["replay", row, program(tmp_path, ENDLESS)]) == 0
    capsys.readouterr()
    tilted = ",".join(map(repr, (*PIERCED[:7], 1e-9, *PIERCED[8:])))
    assert main(["replay", tilted, program(tmp_path, ENDLESS)]) == 2
    assert "takes no axis, and not all of the rows are upright" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "row"), [(CENTRE_ALONE, PIERCED), pytest.param(NEVER, LANDING, marks=pytest.mark.thorough)]
)
def test_minimise_takes_rows_with_ends_and_proves_the_right_answer(text, row, capsys, tmp_path):
    assert main(["minimise", program(tmp_path, text), ",".join(map(repr, row))]) == 0
    said = capsys.readouterr().out
    (shown,) = re.findall(r"^   row +(\S+)  \(alpha, .*z_min, z_max, solid\)$", said, flags=re.MULTILINE)
    assert len(shown) < 50
    assert "contact" in said.split("the right answer")[1]


def test_strata_have_the_families_with_ends_where_heights_are_taken():
    for groups, families in (({"axis"}, ENDED_FAMILIES), ({"end", "axis"}, ENDED_SWEEP_FAMILIES)):
        without, all_of_them = (
            {stratum.name for stratum in hunt_search.strata(taken=frozenset(taken))}
            for taken in (groups, {*groups, "heights"})
        )
        assert all_of_them - without == {f"the family {name}" for name in families}
    upright = {stratum.name for stratum in hunt_search.strata(taken=frozenset({"heights"}))}
    assert not any("tilted" in name for name in upright)


@pytest.mark.parametrize(("row", "layout"), [(PIERCED, PAIRS), (LANDING, SWEEPS)])
def test_neighbours_of_a_row_with_ends_are_valid_and_have_other_ends(row, layout, monkeypatch):
    monkeypatch.setattr(hunt_search, "BROUGHT", 1)  # each takes most of a second beside ends
    around = neighbours(Draw("test"), [Climber(row, 1.0, 0.25)], layout)
    assert around.rows.shape[1] == len(layout.ended)
    assert not invalid(around.rows, layout).any()
    low, high, solid = around.rows[:, -3:].T
    assert len(set(low)) > 2
    assert len(set(high)) > 2
    assert set(solid) == {0, 1}


@pytest.mark.parametrize(
    ("row", "kind"),
    [
        ((1, 1, 1, 1, 1.5, 0, 2.2, 0, 0, 1, -1, 1, 0), "clear because it ends"),
        (PIERCED, "contact with a flat end"),
        ((5, 5, 0.5, 0.5, 0, 0, 3, 0, 0, 1, -3, 1, 0), "outside because it ends"),
        ((1, 1, 1, 1, 1, 0, 2, 0, 0, 1, -4, 2, 0), "the centre at an end"),
        ((3, 4, 1, 1, 3, 0, 5, 0, 0, 1, -9, 9, 1), "a solid body"),
        ((3, 4, 1, 1, 3, 0, 5, 0, 0, 1, -9, 9, 0), ENDED),
    ],
)
def test_place_of_a_row_with_ends_names_the_change_of_position_that_the_ends_cause(row, kind):
    place = place_of(Pair.from_row(row))
    assert place.kind == kind
    assert place.words.startswith(ENDED)


def test_place_of_a_sweep_mentions_ends_and_a_tilted_spheroid():
    assert ENDED in place_of_row(LANDING, SWEEPS).words
    assert "tilted" not in place_of_row(LANDING, SWEEPS).words
    assert "tilted" in place_of_row((*LANDING[:10], 1.0, 0.0, 1.0, *LANDING[13:]), SWEEPS).words
