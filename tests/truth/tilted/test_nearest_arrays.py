"""Distances of many tilted spheroids in double-double: certain ones are those of the intervals, digit by digit."""

from __future__ import annotations

from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest

from hypcheck.answer import DisagreementError
from hypcheck.answers import answers
from hypcheck.truth.tilted import nearest_arrays
from hypcheck.truth.tilted.nearest import nearest
from hypcheck.truth.tilted.nearest_arrays import distances
from hypcheck.truth.tilted.pair import TiltedPair
from hypcheck.vectors.families import TILTED_FAMILIES


def by_intervals(rows):
    return [nearest(TiltedPair.from_row(row)) for row in rows.tolist()]


@pytest.mark.slow
@pytest.mark.parametrize("name", TILTED_FAMILIES)
def test_certain_float_clearances_and_positions_equal_those_by_intervals(name):
    rows = TILTED_FAMILIES[name].rows(7, 40)
    found = distances(rows)
    for number, each in enumerate(by_intervals(rows)):
        if found.certain[number]:
            assert (found.clearance[number], found.position[number]) == (each.clearance, each.position)


@pytest.mark.parametrize(("name", "share"), [("tilted-tower", 0.99), ("tilted-uniform", 0.6), ("tilted-ring", 0.9)])
def test_float_stage_is_certain_about_most_tilted_rows_of_ordinary_sizes(name, share):
    assert distances(TILTED_FAMILIES[name].rows(7, 400)).certain.mean() > share


@pytest.mark.parametrize("name", ["tilted-tangent", "extreme-tilted"])
def test_float_stage_is_never_certain_about_tangencies_and_extreme_lengths(name):
    assert not distances(TILTED_FAMILIES[name].rows(7, 400)).certain.any()


@pytest.mark.parametrize(("column", "value"), [(0, 2.0**-101), (4, 2.0**101), (5, 2.0**-101), (8, 2.0**-101)])
def test_float_stage_is_never_certain_about_a_length_or_axis_out_of_range(column, value):
    row = [1.0, 2.0, 0.5, 0.75, 3.0, 1.0, 2.0, 1.0, 0.5, 0.25]
    rows = np.array([row, row, row])
    rows[1, column] = value
    rows[2, column] = value * 4 if value < 1 else value / 4
    certain = distances(rows).certain
    assert certain[0]
    assert not certain[1]
    assert nearest_arrays._inside(rows).tolist() == [True, False, True]


def test_clearance_is_enclosed_even_with_a_poor_multiplier_and_point(monkeypatch):
    rows = TILTED_FAMILIES["tilted-tower"].rows(7, 200)
    right, exact = nearest_arrays._polished, np.array([each.clearance for each in by_intervals(rows[:60])])

    def worse(pairs, X, at):
        (x, y, z), at = right(pairs, X, at)
        return (x * (1 + 1e-6), y, z * (1 - 1e-6)), at * (1 + 1e-6)

    monkeypatch.setattr(nearest_arrays, "_polished", worse)
    found = distances(rows)
    assert not found.certain.any()
    pairs = nearest_arrays._Pairs.of(rows[:60])
    L, below, above = nearest_arrays._enclosed(pairs, *worse(pairs, *nearest_arrays._start(rows[:60], pairs)))
    assert (L[0] - below <= (1 + exact) ** 2 - 1).all()
    assert ((1 + exact) ** 2 - 1 <= L[0] + above).all()


def test_float_stage_bounds_the_least_eigenvalue_from_below():
    rows = TILTED_FAMILIES["tilted-uniform"].rows(7, 500)
    pairs = nearest_arrays._Pairs.of(rows)
    with np.errstate(all="ignore"):
        found = nearest_arrays._start(rows, pairs)[1]
    for share in (0.25, 0.5, 0.999):
        at = share * np.where(np.isfinite(found), found, 0.0)
        half = nearest_arrays._matrix(pairs, at)
        full = np.array([[half[k] for k in line] for line in ((0, 1, 2), (1, 3, 4), (2, 4, 5))]).transpose(2, 0, 1)
        least, bound = np.linalg.eigvalsh(full)[:, 0], nearest_arrays._least_eigenvalue(pairs, at)
        assert (bound <= least).all()
        assert np.median(bound / least) > 0.15


def test_least_eigenvalue_of_a_matrix_that_is_not_definite_has_no_bound():
    rows = TILTED_FAMILIES["tilted-uniform"].rows(7, 200)
    pairs = nearest_arrays._Pairs.of(rows)
    beyond = np.where(np.arange(200) % 2, 1.01 * (rows[:, 1] / rows[:, 2:4].min(axis=1)) ** 2, -1e9)
    assert (nearest_arrays._least_eigenvalue(pairs, beyond) == 0).all()


def test_a_least_eigenvalue_that_is_claimed_of_a_nearly_singular_matrix_is_below_all_of_them(monkeypatch):
    """Two small eigenvalues, one below 0 in half of the matrices; rationals count how many are above the bound."""
    rng, count = np.random.default_rng(6), 1500
    turned = np.array([np.linalg.qr(each)[0] for each in rng.normal(size=(count, 3, 3))])
    least = rng.choice([-1, 1], count) * 2.0 ** rng.uniform(-70, -40, count)
    own = np.stack([least, 2.0 ** rng.uniform(-40, -3, count), np.ones(count)], axis=1) / 4
    matrices = np.einsum("nij,nj,nkj->nik", turned, own, turned)
    half = tuple(matrices[:, i, j] for i in range(3) for j in range(i, 3))
    monkeypatch.setattr(nearest_arrays, "_matrix", lambda *_: half)
    quarter, none = np.full(count, 0.25), np.zeros(count)
    some = SimpleNamespace(thick=quarter, long=quarter, D=(none, none, none))
    bound = nearest_arrays._least_eigenvalue(some, none)
    claimed = np.flatnonzero(bound > 0)
    assert len(claimed) > 10
    for place in claimed.tolist():
        a, b, c, d, e, f = (Fraction(each[place]) for each in half)
        a, d, f = (each - Fraction(bound[place]) for each in (a, d, f))
        determinant = a * (d * f - e * e) - b * (b * f - c * e) + c * (b * e - c * d)
        assert min(a, a * d - b * b, determinant) > 0


def test_no_eigenvalue_is_claimed_where_roundings_of_the_matrix_alone_show_one():
    """Balls, for which M + λD is diagonal: 1/b² + λ/α² twice, here 0 up to roundings of its two parts."""
    rng, count = np.random.default_rng(8), 400
    gamma, alpha, b = np.sort(rng.uniform(0.5, 3, (3, count)), axis=0)[[0, 2, 1]]
    rows = np.stack([alpha, gamma, b, b, *np.ones((6, count))], axis=1)
    at = -((alpha / b) ** 2) * (1 + rng.integers(-6, 7, count) * 2.0**-53)
    with np.errstate(all="ignore"):
        bound = nearest_arrays._least_eigenvalue(nearest_arrays._Pairs.of(rows), at)
    for row, multiplier, found in zip(rows.tolist(), at.tolist(), bound.tolist(), strict=True):
        exact = 1 / Fraction(row[2]) ** 2 + Fraction(multiplier) / Fraction(row[0]) ** 2
        assert found == 0 or found <= exact
    assert (bound == 0).all()


def test_a_table_with_a_certain_row_of_another_position_than_the_kernel_says_is_refused(monkeypatch):
    rows = TILTED_FAMILIES["tilted-tower"].rows(7, 30)
    expected = answers(rows)
    each = by_intervals(rows)
    assert expected.clearance.tolist() == [one.clearance for one in each]
    assert expected.positions.tolist() == [one.position for one in each]
    right = nearest_arrays.distances(rows)
    wrong = nearest_arrays.TiltedDistances(right.clearance, (right.position == 0).astype(np.int8), right.certain)
    monkeypatch.setattr(nearest_arrays, "distances", lambda _rows: wrong)
    with pytest.raises(DisagreementError):
        answers(rows)
