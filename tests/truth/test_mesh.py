"""The mesh oracle against exact decisions in fractions, and against pairs whose distance is known."""

from __future__ import annotations

import math
import sys
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.errors import UnavailableError
from hypcheck.geometry.pair import Pair
from tests.support.examples import examples
from tests.support.fractions_truth import (
    everyday,
    exact_position,
    grown,
    rows_of,
    steps_at,
    tangent_rows,
)
from tests.support.inside import MeshOutcome, availability, verdict

pytest.importorskip("fcl", reason="python-fcl has no wheel here")


@pytest.mark.parametrize(
    "row",
    [
        (4, 2, 1, 1, 5, 0, 0),
        (2, 1, 1, 1, 1, 0, 0),
        (1, 1, 1, 1, 0, 0, 0),
        (1, 1, 3, 1, 4, 1e-160, 0),
        (4, 10, 1, 1, 3, 4, 1e-160),
    ],
)
def test_mesh_oracle_leaves_tangencies_and_pairs_within_7e_minus_15_radii_of_one_undecided(row):
    found = verdict(Pair(*row))
    assert found.outcome is MeshOutcome.UNDECIDED
    assert found.position is None
    assert "within 7.1e-15 radii" in found.reason
    assert found.lower <= 1 <= found.upper <= found.lower + 2**-46


@examples(60)
@given(tangent_rows(steps_at(st.integers(3, 26))))
def test_mesh_oracle_decides_known_clearances_down_to_one_in_a_hundred_million(known):
    row, position = known
    assert verdict(Pair(*row)).position == position


@examples(40)
@given(tangent_rows(st.sampled_from([Fraction(1), Fraction(-1)])))
def test_mesh_oracle_calls_no_tangency_clear(known):
    found = verdict(Pair(*known[0]))
    assert found.outcome is not MeshOutcome.CLEAR
    assert found.lower <= 1


TILTED, ENDS = (2, -1, 3), (-9, 9, 0)
KINDS = {
    "upright": ((0, 0, 1), ()),
    "tilted": (TILTED, ()),
    "ended": ((0, 0, 1), ENDS),
    "tilted, ended": (TILTED, ENDS),
}


@pytest.mark.parametrize(("axis", "ends"), KINDS.values(), ids=KINDS)
def test_mesh_oracle_is_right_beside_the_wall_at_all_angles_and_far_above_and_below_the_waist(axis, ends):
    """A small spheroid on the wall, whose radius is 2 √(1 + (z/3)²), and clear of it on either side."""
    for turn in range(8):
        for z in (-7.5, -0.5, 2.5):
            r = 2 * math.hypot(1, z / 3)
            for share, position in ((1, 0), (1.25, 1), (0.75, -1)):
                x, y = (share * r * part(turn * math.pi / 4 + 0.1) for part in (math.cos, math.sin))
                row = (2.0, 3.0, 0.25, 0.375, x, y, z, *axis, *ends)
                assert verdict(Pair.from_row(row)).position == position, row


def check_against_exact(row):
    """The verdict is right or undecided, its bounds hold, and undecided means within 2⁻⁴⁶ of touching."""
    row = Pair(*row).row
    found = verdict(Pair(*row))
    if found.outcome is MeshOutcome.UNDECIDED:
        assert exact_position(grown(row, 1 + Fraction(1, 2**46))) == 0
        assert exact_position(grown(row, 1 - Fraction(1, 2**46))) != 0
    else:
        assert found.position == exact_position(row)
    if found.lower > 0:
        assert exact_position(grown(row, Fraction(found.lower) * (1 - Fraction(1, 2**60)))) != 0
    if math.isfinite(found.upper):
        assert exact_position(grown(row, Fraction(found.upper) * (1 + Fraction(1, 2**60)))) == 0


@examples(80)
@given(rows_of(*everyday()) | rows_of(*everyday(-1, 1)))
def test_the_mesh_oracle_is_right_on_everyday_rows(row):
    check_against_exact(row)


@examples(60)
@given(
    rows_of(
        st.floats(min_value=5e-324, allow_infinity=False, allow_nan=False),
        st.floats(allow_infinity=False, allow_nan=False),
    )
)
def test_the_mesh_oracle_is_right_or_undecided_on_any_valid_row(row):
    check_against_exact(row)


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ((1, 1, 1, 1, 2.125, 0, 0), 0.5),
        ((1, 1, 1, 1, 2.125, 0, 0), 1.0),
        ((1, 1, 1, 1, 1.5, 0, 0), 1.5),
        ((1, 1, 1, 1, 1.5, 0, 0), math.nan),
    ],
)
def test_mesh_oracle_is_undecided_if_fcl_contradicts_it(row, said):
    assert verdict(Pair(*row)).outcome is not MeshOutcome.UNDECIDED
    found = verdict(Pair(*row), measure=lambda *_: said)
    assert found.outcome is MeshOutcome.UNDECIDED
    assert "FCL" in found.reason
    assert found.triangles > 0


def test_mesh_oracle_calls_a_pair_far_apart_clear_without_making_a_mesh():
    found = verdict(Pair(1, 1, 1, 1, 100, 0, 0))
    assert (found.position, found.levels, found.triangles, found.lower, found.upper) == (1, 0, 0, 1.25, math.inf)


def test_without_fcl_the_mesh_oracle_raises_an_error_that_says_why(monkeypatch):
    assert availability() is None
    monkeypatch.setitem(sys.modules, "fcl", None)
    assert "python-fcl cannot be imported" in availability()
    with pytest.raises(UnavailableError, match="not available: python-fcl"):
        verdict(Pair(1, 1, 1, 1, 0, 0, 0))
