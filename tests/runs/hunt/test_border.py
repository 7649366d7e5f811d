"""The border of contact is where the exact position changes, and strata have the rows that they promise."""

from __future__ import annotations

import math

import numpy as np
import pytest

from hypcheck.geometry.rows import invalid
from hypcheck.runs import hunt_search, hunt_surfaces
from hypcheck.runs.hunt_surfaces import MOVERS
from hypcheck.vectors.draw import Draw
from hypcheck.vectors.families import FAMILIES
from tests.support.fractions_truth import exact_position
from tests.support.inside import flip_exponents

ROWS = FAMILIES["uniform"].rows(5, 24)


@pytest.mark.parametrize("mover", MOVERS)
@pytest.mark.parametrize("far", [False, True])
def test_border_factor_is_the_last_before_the_position_changes(mover, far):
    mask = hunt_surfaces.columns_of(np.full(len(ROWS), mover))
    factors = hunt_surfaces.border_factors(ROWS, mask, np.full(len(ROWS), far))
    found = np.flatnonzero(np.isfinite(factors))
    assert len(found) >= len(ROWS) / 4
    before = hunt_surfaces.moved(ROWS, mask, factors)[found]
    after = hunt_surfaces.moved(ROWS, mask, np.nextafter(factors, np.inf))[found]
    for row, next_row in zip(before.tolist(), after.tolist(), strict=True):
        assert exact_position(row) != exact_position(next_row)
        assert [a == b for a, b in zip(row, next_row, strict=True)].count(False) <= len(MOVERS[mover])


def test_far_border_of_a_row_lies_beyond_its_near_border():
    """Out along a radius of the tower: interior, contact between 1 and 3, exterior."""
    rows = np.array([[2.0, 20.0, 1.0, 1.0, 0.5, 0.0, 0.0]] * 2)
    mask = hunt_surfaces.columns_of(np.array(["radius", "radius"]))
    near, far = hunt_surfaces.border_factors(rows, mask, np.array([False, True]))
    assert near * 0.5 == pytest.approx(1, abs=1e-15)
    assert far * 0.5 == pytest.approx(3, abs=1e-15)


def test_row_whose_position_never_changes_has_no_border():
    rows = np.array([[2.0, 20.0, 1.0, 1.0, 0.0, 0.0, 3.0], [2.0, 20.0, 1.0, 1e-300, 0.0, 0.0, 1e308]])
    mask = hunt_surfaces.columns_of(np.array(["radius", "height"]))
    assert np.isnan(hunt_surfaces.border_factors(rows, mask, np.zeros(2, dtype=bool))).all()


def test_hunt_ladders_lead_away_from_the_border_on_both_sides():
    rows = ROWS[:3]
    mask = hunt_surfaces.columns_of(np.full(3, "radius"))
    rungs, numbers = hunt_search.ladders(rows, mask, hunt_surfaces.border_factors(rows, mask, np.ones(3, dtype=bool)))
    assert np.bincount(numbers).tolist() == [len(hunt_search.RUNGS)] * 6
    for place, row in enumerate(rows.tolist()):
        out, back = rungs[numbers == 2 * place].tolist(), rungs[numbers == 2 * place + 1].tolist()
        radii = [math.hypot(each[4], each[5]) for each in (*reversed(back), *out)]
        assert radii == sorted(radii)
        assert {exact_position(each) for each in out} == {1}
        assert all(exact_position(each) < 1 for each in back)
        assert all(each[:4] + each[6:] == row[:4] + row[6:] for each in (*out, *back))


SURFACES = {
    "z = 0": lambda row: abs(row[6] / row[3]),
    "r = 0": lambda row: math.hypot(row[4], row[5]) / row[2],
    "a = 1": lambda row: abs(row[0] / row[2] - 1),
    "c² = a": lambda row: abs((row[1] / row[3]) ** 2 / (row[0] / row[2]) - 1),
}


@pytest.mark.parametrize("stratum", [each for each in hunt_search.strata() if each.name.startswith("contact")])
def test_rows_of_a_crossing_are_on_or_next_to_its_surfaces_and_near_contact(stratum):
    rows = stratum.rows(1, 0)
    assert not invalid(rows).any()
    assert len(rows) > 15
    for name in stratum.name.removeprefix("contact beside ").split(" and "):
        off = np.array([SURFACES[name](row) for row in rows.tolist()])
        scale = (
            np.maximum(1, 3 * rows[:, 1] / rows[:, 3]) if name == "z = 0" else np.maximum(1, rows[:, 0] / rows[:, 2])
        )
        assert (off <= 2 * scale).all()
        assert (off <= 2.0**-20 * scale).mean() > 0.3
        assert (off <= 4e-16).any()
    octaves = flip_exponents(rows)
    assert (octaves < -8).mean() > 0.5


def test_hunt_strata_are_reproducible_and_differ_by_seed_and_number():
    stratum = hunt_search.strata()[-1]
    assert stratum.rows(1, 0).tobytes() == stratum.rows(1, 0).tobytes()
    assert len({stratum.rows(*which).tobytes() for which in ((1, 0), (1, 1), (2, 0))}) == 3


def test_hunt_has_a_stratum_for_every_family_and_every_crossing_of_surfaces_with_a_free_length():
    names = [stratum.name for stratum in hunt_search.strata()]
    assert len(set(names)) == len(names)
    assert {f"the family {name}" for name in FAMILIES} < set(names)
    assert "contact beside z = 0 and a = 1 and c² = a" in names
    assert "contact beside z = 0 and r = 0 and c² = a" not in names  # nothing is left there that could be moved


def test_beside_border_returns_rows_next_to_the_border():
    rows = hunt_surfaces.beside_border(Draw("test", 1), ROWS, np.full(len(ROWS), "radius"))
    assert 0 < len(rows) <= len(ROWS)
    assert np.median(flip_exponents(rows)) < -15
