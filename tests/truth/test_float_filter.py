"""The batch decides as the single decision does, and its filter never proves a wrong answer."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.errors import InputError
from hypcheck.geometry.pair import Pair
from hypcheck.truth import exact, float_filter
from tests.support.pairs import pairs


@pytest.mark.slow
@given(st.lists(pairs, min_size=1, max_size=40))
def test_float_filter_positions_of_many_rows_equal_those_of_single_pairs(some):
    rows = np.array([pair.row for pair in some])
    expected = [exact.position(pair.lengths) for pair in some]
    assert float_filter.positions(rows).tolist() == expected


@pytest.mark.parametrize("spread", [1, 4, 9, 25])
def test_the_float_filter_decides_most_rows_and_none_wrongly(spread):
    rows = 2.0 ** np.random.default_rng(spread).uniform(-spread, spread, (3000, 7))
    proved = float_filter.filtered(rows)
    expected = np.array([exact.position(Pair.from_row(row).lengths) for row in rows.tolist()])
    decided = proved != float_filter.UNDECIDED
    assert (proved[decided] == expected[decided]).all()
    assert decided.mean() > 0.9


@pytest.mark.parametrize("exponent", [-52, -51, -50, -45, -40, -30])
@pytest.mark.parametrize("sign", [-1, 1])
def test_next_to_a_tangency_the_float_filter_is_undecided_or_right(exponent, sign):
    """r − a = 1 + sign 2^exponent at the waist, for many a: contact below, exterior above."""
    a = np.arange(1.0, 400.0)
    x = a + 1 + sign * 2.0**exponent
    kept = np.abs(x - a - 1) == 2.0**exponent
    rows = np.zeros((kept.sum(), 7))
    rows[:, 0], rows[:, 1], rows[:, 2:4], rows[:, 4] = a[kept], 1000.0, 1.0, x[kept]
    expected = 1 if sign > 0 else 0
    assert set(float_filter.filtered(rows).tolist()) <= {expected, float_filter.UNDECIDED}
    assert set(float_filter.positions(rows).tolist()) <= {expected}


def test_float_filter_refuses_an_invalid_row_naming_row_and_column():
    rows = np.ones((5, 7))
    rows[3, 2] = -1
    with pytest.raises(InputError, match=r"row 3: b is -1\.0"):
        float_filter.positions(rows)


def squares(rows):
    """A, B, P and Q of each row, and its exact position."""
    expected = np.array([exact.position(Pair.from_row(row).lengths) for row in rows.tolist()])
    return float_filter._squares(np.ascontiguousarray(rows.T)), expected


@pytest.mark.parametrize(
    ("witness", "shares"),
    [
        (float_filter._level, (0.95, 0.75, 0.74)),
        (float_filter._maximum, (0.999, 0, 0.999)),
        (float_filter._upright, (0, 0.93, 0)),
        (float_filter._slanted, (0, 0.98, 0)),
        (float_filter._along_the_normal, (0, 0.53, 0)),
    ],
)
def test_each_witness_of_the_float_filter_decides_its_share_of_rows_and_none_wrongly(witness, shares):
    rows = 2.0 ** np.random.default_rng(6).uniform(-2, 2, (4000, 7))
    rows[:, 4:] *= np.random.default_rng(7).choice((-1, 1), (4000, 3))
    found, expected = squares(rows)
    with np.errstate(all="ignore"):
        proved = witness(*found)
    decided = proved != float_filter.UNDECIDED
    assert (proved[decided] == expected[decided]).all()
    for position, share in zip((-1, 0, 1), shares, strict=True):
        assert decided[expected == position].mean() >= share


def test_float_local_maximum_of_the_cubic_is_within_2_to_the_minus_30():
    rows = 2.0 ** np.random.default_rng(8).uniform(-2, 2, (400, 7))
    found, expected = squares(rows)
    with np.errstate(all="ignore"):
        at = float_filter._local_maximum(*found)
    for k in np.flatnonzero(expected):
        g = exact.cubic(Pair.from_row(rows[k].tolist()).lengths)
        slopes = [
            (3 * g.n3 * x + 2 * g.n2) * x + g.n1
            for x in (Fraction(at[k]) * (1 + s * Fraction(1, 2**30)) for s in (-1, 1))
        ]
        assert min(slopes) < 0 < max(slopes)
        assert 6 * g.n3 * Fraction(at[k]) + 2 * g.n2 < 0
