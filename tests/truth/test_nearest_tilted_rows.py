"""Distances of many tilted spheroids in double-double: certain ones are those of exact enclosures, digit by digit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hypcheck.answer import DisagreementError
from hypcheck.answers import answers
from hypcheck.geometry.pair import Pair
from hypcheck.truth import nearest_tilted
from hypcheck.vectors.families import TILTED_FAMILIES
from tests.support.inside import nearest


def one_by_one(rows):
    return [nearest(Pair.from_row(row)) for row in rows.tolist()]


@pytest.mark.slow
@pytest.mark.parametrize("name", TILTED_FAMILIES)
def test_float_clearances_and_positions_marked_as_certain_equal_those_of_exact_enclosures(name):
    rows = TILTED_FAMILIES[name].rows(7, 40)
    found = nearest_tilted.decide(rows)
    for number, each in enumerate(one_by_one(rows)):
        if found.clearance_certain[number]:
            assert (found.clearance[number], found.position[number]) == (each.clearance, each.position)


@pytest.mark.parametrize(
    ("name", "least", "most"),
    [
        ("tilted-tower", 0.99, 1),
        ("tilted-uniform", 0.6, 1),
        ("tilted-ring", 0.9, 1),
        ("tilted-tangent", 0, 0),
        ("extreme-tilted", 0, 0),
    ],
)
def test_float_stage_is_certain_about_most_tilted_rows_of_ordinary_sizes_and_no_tangency(name, least, most):
    assert least <= nearest_tilted.decide(TILTED_FAMILIES[name].rows(7, 400)).clearance_certain.mean() <= most


@pytest.mark.parametrize(("column", "value"), [(0, 2.0**-101), (4, 2.0**101), (5, 2.0**-101), (8, 2.0**-101)])
def test_float_stage_is_never_certain_about_a_length_or_axis_out_of_range(column, value):
    row = [1.0, 2.0, 0.5, 0.75, 3.0, 1.0, 2.0, 1.0, 0.5, 0.25]
    rows = np.array([row, row, row])
    rows[1, column] = value
    rows[2, column] = value * 4 if value < 1 else value / 4
    certain = nearest_tilted.decide(rows).clearance_certain
    assert certain[0]
    assert not certain[1]


def test_answers_are_refused_if_the_kernel_and_the_nearest_point_disagree_about_a_position(monkeypatch):
    rows = TILTED_FAMILIES["tilted-tower"].rows(7, 30)
    expected = answers(rows)
    each = one_by_one(rows)
    assert expected.clearance.tolist() == [one.clearance for one in each]
    assert expected.positions.tolist() == [one.position for one in each]
    right = nearest_tilted.decide(rows)
    wrong = replace(right, position=(right.position == 0).astype(np.int8))
    monkeypatch.setattr(nearest_tilted, "decide", lambda _rows: wrong)
    with pytest.raises(DisagreementError):
        answers(rows)


def test_the_lower_bound_of_the_eigenvalues_of_the_pencil_holds_and_is_positive_if_they_are_large():
    """A step of the proof: it is what the bound of the nearest point's error is divided by."""
    draw = np.random.default_rng(3)
    for name in ("tilted-uniform", "tilted-stiff", "tilted-slight"):
        rows = TILTED_FAMILIES[name].rows(3, 2000)
        pairs = nearest_tilted._Pairs.of(rows)
        end = 1 / np.max(np.abs(np.stack(pairs.D)), axis=0) * np.maximum(pairs.thick, pairs.long)
        at = end * draw.uniform(-1.5, 1.5, len(rows))
        found = nearest_tilted._least_eigenvalue(pairs, at)
        upper = nearest_tilted._matrix(pairs, at)
        full = np.stack([upper[k] for k in (0, 1, 2, 1, 3, 4, 2, 4, 5)], axis=1).reshape(-1, 3, 3)
        values = np.linalg.eigvalsh(full)
        scale = np.abs(values).max(axis=1)
        assert (values[:, 0] + 1e-13 * scale >= found)[found > 0].all()
        assert (found[values[:, 0] > 1e-9 * scale] > 0).all()
        assert (found >= values[:, 0] / 64)[values[:, 0] > 1e-9 * scale].all()
        assert (values[:, 0] > 1e-9 * scale).sum() > 300
        assert (values[:, 0] < 0).sum() > 300
