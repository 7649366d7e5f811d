"""Parts of the float64 boxes, each against the same number from fractions."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from hypcheck.truth.tilted import float_boxes
from tests.truth.tilted.cases import random_rows

ROWS = [
    *random_rows(40, seed=3),
    [1, 2, 1.5, 0.5, 3, 1, 2, 0, 0, 1],  # upright
    [1, 2, 0.5, 1.5, 0.1, 0.2, 0.3, 0, 0, -2],
    [1, 2, 0.5, 1.5, 3, 1, 0, 1, 2, 0],  # level
    [1, 1, 0.9, 0.8, 0.2, 0.1, 0, 1, 0, 1],  # it leans as the asymptote does
    [3, 1, 0.5, 0.5, 4, 0, 1, 1, 1, 1],  # a ball
]


def phi(row, at):
    """min over X of s(X) + λ h(X), by Cramer's rule; None where M + λD is not positive definite."""
    alpha, gamma, b, d, *rest = map(Fraction, row)
    centre, v = rest[:3], rest[3:]
    D = (1 / alpha**2, 1 / alpha**2, -1 / gamma**2)
    square = sum(each * each for each in v)
    M = [[(i == j) / b**2 + (1 / d**2 - 1 / b**2) * v[i] * v[j] / square for j in range(3)] for i in range(3)]
    G = [[M[i][j] + (i == j) * at * D[i] for j in range(3)] for i in range(3)]
    pulled = [sum(M[i][j] * centre[j] for j in range(3)) for i in range(3)]
    whole = determinant(G)
    if not (G[0][0] > 0 and G[0][0] * G[1][1] > G[0][1] ** 2 and whole > 0):
        return None
    nearest = []
    for column in range(3):
        replaced = [[pulled[i] if j == column else G[i][j] for j in range(3)] for i in range(3)]
        nearest.append(determinant(replaced) / whole)
    along = sum(pulled[i] * (centre[i] - nearest[i]) for i in range(3))
    return along - 1 - at


def determinant(m):
    return (
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
        - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
        + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    )


@pytest.mark.parametrize("row", ROWS)
def test_the_multiplier_hinted_at_is_where_phi_is_largest(row):
    columns = np.array([row]).T
    with np.errstate(all="ignore"):
        (found,) = float_boxes._multiplier(columns[:4], columns[4:])
    at = Fraction(found)
    here, beside = phi(row, at), [phi(row, at * share) for share in (Fraction(999, 1000), Fraction(1001, 1000))]
    assert here is not None
    assert all(each is None or each < here for each in beside)
