"""Touches and gaps of the numpy kernel: against the exact nearest point, and by what makes a gap the shortest."""

from __future__ import annotations

import math
from fractions import Fraction
from functools import cache

import numpy as np
import pytest

import hypcheck
from hypcheck.geometry.pair import Lengths, Pair
from hypcheck.kernel import clearance_points
from tests.support import inside
from tests.support.inside import nearest, numpy_kernel
from tests.support.nearest_points import nearest_points
from tests.truth.tilted_cases import phi


def drawn(count, width, seed=3):
    """Rows with sizes of one order and centres at any side of the surface."""
    draw = np.random.default_rng(seed)
    parts = [np.exp(draw.normal(0, 0.7, (count, 4))), draw.normal(0, 3, (count, 3)), draw.normal(0, 1, (count, 3))]
    return np.concatenate(parts, axis=1)[:, :width]


UPRIGHT, TILTED = drawn(160, 7), drawn(60, 10)


@pytest.fixture(autouse=True)
def quiet():
    with np.errstate(all="ignore"):
        yield


def off_the_surface(rows, points):
    """The hyperboloid's equation at points, beside the size of its terms."""
    squares = (points / rows[:, [0, 0, 1]]) ** 2
    return np.abs(squares[:, 0] + squares[:, 1] - squares[:, 2] - 1) / (squares.sum(axis=1) + 1)


def metric(rows):
    """M of each spheroid, (n, 3, 3): its points have (X − C)ᵀM(X − C) ≤ 1."""
    axis = rows[:, 7:] if rows.shape[1] > 7 else np.tile((0.0, 0.0, 1.0), (len(rows), 1))
    unit = axis / np.linalg.norm(axis, axis=1, keepdims=True)
    b, d = (rows[:, k, None, None] for k in (2, 3))
    return np.eye(3) / b**2 + (1 / d**2 - 1 / b**2) * unit[:, :, None] * unit[:, None, :]


def test_a_tilted_touch_is_the_exact_nearest_point_within_a_small_error():
    found = clearance_points.tilted_touches(TILTED)
    for k, row in enumerate(TILTED.tolist()):
        true = nearest(Pair.from_row(row))
        assert found.factor[k] == pytest.approx(1 + true.clearance, rel=1e-12), row
    assert (off_the_surface(TILTED, found.point) < 1e-14).all()
    size = np.abs(found.point).sum(axis=1)
    assert (found.error > 0).all()
    assert np.median(found.error / size) < 1e-11
    # M (X − C) = −λ D X at the nearest point alone.
    normals = normal_to_spheroid(TILTED, found.point), normal_to_hyperboloid(TILTED, found.point)
    assert (np.abs(np.cross(*normals)) < 1e-12).all()


def normal_to_spheroid(rows, points):
    """The unit normal of the spheroid, grown to a point, there."""
    normal = np.einsum("nij,nj->ni", metric(rows), points - rows[:, 4:7])
    return normal / np.linalg.norm(normal, axis=1, keepdims=True)


def normal_to_hyperboloid(rows, points):
    normal = points / rows[:, [0, 0, 1]] ** 2 * (1, 1, -1)
    return normal / np.linalg.norm(normal, axis=1, keepdims=True)


def test_the_multiplier_of_the_numpy_kernel_maximises_phi_or_is_next_to_a_pole():
    """It turns Newton's method; towards a pole it stops a thousandth before."""
    rows = np.concatenate([TILTED, stretched(TILTED)])
    inner = 0
    for row, at in zip(rows.tolist(), map(Fraction, numpy_kernel.multipliers(rows)), strict=True):
        before, here, beyond = (phi(row, at * (1 + way * Fraction(1, 10**4))) for way in (-1, 0, 1))
        assert here is not None
        if beyond is not None and beyond < here:
            assert before < here
            inner += 1
        else:
            assert phi(row, at * Fraction(1002, 1000)) is None
    assert inner > 0.9 * len(rows)


def gaps_of(rows, gaps, touches):
    position = np.array(
        [inside.position(Lengths.of(row if len(row) == 10 else [*row, 0, 0, 1])) for row in rows.tolist()]
    )
    clear = np.flatnonzero(position)
    rows, position = rows[clear], position[clear].astype(np.int8)
    return rows, position, gaps(rows, position, touches(rows).point)


@pytest.mark.parametrize(
    ("rows", "gaps", "touches"),
    [
        (UPRIGHT, clearance_points.upright_gaps, clearance_points.upright_touches),
        (TILTED, clearance_points.tilted_gaps, clearance_points.tilted_touches),
    ],
)
def test_a_gap_ends_on_both_bodies_and_is_normal_to_both(rows, gaps, touches):
    rows, position, found = gaps_of(rows, gaps, touches)
    assert len(rows) > 15
    assert set(position.tolist()) == {-1, 1}
    way, out = found.there - found.here, found.here - rows[:, 4:7]
    assert (off_the_surface(rows, found.there) < 1e-14).all()
    assert np.einsum("ni,nij,nj->n", out, metric(rows), out) == pytest.approx(np.ones(len(rows)), rel=1e-12)
    assert np.linalg.norm(way, axis=1) == pytest.approx(found.length, rel=1e-12)
    along = way / found.length[:, None]
    assert (normal_to_spheroid(rows, found.here) * along).sum(axis=1) == pytest.approx(np.ones(len(rows)), abs=1e-12)
    normal = normal_to_hyperboloid(rows, found.there)
    assert (normal * along).sum(axis=1) == pytest.approx(-position, abs=1e-12)
    half_width = np.sqrt(np.einsum("ni,nij,nj->n", normal, np.linalg.inv(metric(rows)), normal))
    assert found.support == pytest.approx(half_width, rel=1e-12)


def test_the_error_of_an_upright_touch_is_infinite_for_lengths_beyond_the_proved_range():
    row = [2.0, 3.0, 0.5, 0.7, 4.0, 1.0, 2.0]
    rows = np.array([row] * 9)
    rows[1, 2] = 0.7 * 2.0**-21
    rows[2, 3] = 0.5 * 2.0**-21
    rows[3, 0] = 2.0**-101
    rows[4, 4] = 2.0**101
    rows[5, 2:4] = 2.0**-99
    rows[6, 4:6] = 1e-200
    rows[7, 4] = 2.0**100
    rows[8, 0] = 2.0**-100
    assert np.isfinite(clearance_points.upright_touches(rows).error).tolist() == [True, *[False] * 4, *[True] * 4]


def stretched(rows, seed=5):
    """The rows with sizes of several orders, centres with them."""
    found = rows.copy()
    found[:, :4] = np.exp(np.random.default_rng(seed).normal(0, 2, (len(rows), 4)))
    found[:, 4:7] *= found[:, :1]
    return found


def moved_poles(wrong):
    """The poles of an upright pair with that relative error; of the smaller one, λ is taken."""
    poles = clearance_points.poles

    def moved(A, B, p, q):
        tau, sigma = poles(A, B, p, q)
        return tau * (1 + wrong), sigma * (1 + wrong)

    return moved


@pytest.mark.parametrize("wrong", [0.4, -0.4, 1e-3, -1e-3, 1e-6, -1e-9])
def test_the_error_bound_of_an_upright_touch_holds_for_a_wrong_multiplier(wrong):
    rows = np.concatenate([UPRIGHT, stretched(UPRIGHT)])
    found = clearance_points.upright_touches(rows, poles_of=moved_poles(wrong))
    off = np.array([nearest_off(row, point) for row, point in zip(rows.tolist(), found.point, strict=True)])
    assert (off <= found.error).all()
    if abs(wrong) < 1e-2:
        assert np.median(found.error / off) < 8
        assert np.median(off / np.abs(found.point).sum(axis=1)) > abs(wrong) / 1000


@cache
def nearest_of(row):
    return [np.array(each) for each in nearest_points(Pair.from_row(row))]


def nearest_off(row, point):
    return min(np.linalg.norm(each - point) for each in nearest_of(tuple(row)))


@pytest.mark.parametrize("wrong", [1e-9, 1e-6, -1e-3, 0.2, 40.0, -2.0])
def test_the_error_bound_of_a_tilted_touch_holds_for_a_wrong_multiplier(wrong):
    rows = np.concatenate([TILTED, stretched(TILTED)])
    near = clearance_points.tilted_touches(rows)
    found = clearance_points.tilted_touches(rows, numpy_kernel.multipliers(rows) * (1 + wrong))
    off = np.linalg.norm(found.point - near.point, axis=1)
    assert (off <= found.error + near.error).all()
    if abs(wrong) < 1e-2:
        known = np.isfinite(found.error)
        assert known.mean() > 0.9
        assert np.median(found.error[known] / off[known]) < 1000


@pytest.mark.parametrize("wrong", [-0.4, -1e-3, 0.0])
@pytest.mark.parametrize("rounded", [2.0**-8, 2.0**-46])
def test_the_error_bound_of_an_upright_touch_equals_the_formulas_of_its_derivation(wrong, rounded):
    """√(Γ A/τ) and √(Γ B/σ), and what the hyperboloid makes of them; each coordinate rounds by a share of itself."""
    rows, moved = np.concatenate([UPRIGHT, stretched(UPRIGHT)]), moved_poles(wrong)
    found = clearance_points.upright_touches(rows, poles_of=moved, rounding=rounded)
    for k, row in enumerate(rows):
        written = written_error(row, rounded, [each[0] for each in moved(*poles_asked(row))], found.point[k])
        assert found.error[k] == pytest.approx(written, rel=1e-6)


def poles_asked(row):
    alpha, gamma, b, d, x, y, z = row
    return [np.array([each]) for each in ((alpha / b) ** 2, (gamma / d) ** 2)] + [
        np.array([each]) for each in (alpha / b * np.hypot(x, y) / b, gamma / d * abs(z) / d)
    ]


def written_error(row, rounded, poles, point):
    """In units of b and d, by the docstring of clearance_points."""
    alpha, gamma, b, d, x, y, z = row
    A, B, r, h = (alpha / b) ** 2, (gamma / d) ** 2, np.hypot(x, y) / b, abs(z) / d
    tau, sigma = (poles[0], A + B - poles[0]) if poles[0] < poles[1] else (A + B - poles[1], poles[1])
    rho, zeta = A * r / tau, B * h / sigma
    at_zeta, at_rho = np.sqrt(A * (1 + zeta**2 / B)), np.sqrt(max(B * (rho**2 / A - 1), 0))
    square = B * rho**2 / A  # what at_rho² is the difference of
    slack = rounded * square / at_rho if at_rho else np.inf
    gammas = (
        (abs(at_zeta - rho) + rounded * (at_zeta + rho)) ** 2 * tau / A,
        (abs(at_rho - zeta) + rounded * (at_rho + zeta) + slack) ** 2 * sigma / B,
    )
    across, up = np.sqrt(min(gammas) * A / tau), np.sqrt(min(gammas) * B / sigma)
    by_zeta = d * up + b * A * (zeta + up) / (B * at_zeta) * up
    by_rho = b * across + d * (B / A * ((rho + across) ** 2 - rho**2) / at_rho + slack) if at_rho else np.inf
    return min(by_zeta, by_rho) + rounded * np.abs(point).sum()


@pytest.mark.parametrize("wrong", [0.0, 1e-9, 1e-3, -0.3, 0.5, 2.0, 40.0, -2.0, -5.0])
def test_the_error_bound_of_a_tilted_touch_is_not_below_the_formulas_of_its_derivation(wrong):
    """In units of b: |r|/μ + √(tr G/μ) (|h|/|n| + |r|/μ), with the least eigenvalue μ of G; else nothing is known."""
    rows = np.concatenate([TILTED, stretched(TILTED), stretched(TILTED, seed=6)])
    at = numpy_kernel.multipliers(rows) * (1 + wrong)
    found = clearance_points.tilted_touches(rows, at)
    b = rows[:, 2]
    form = np.stack([(b / rows[:, 0]) ** 2, (b / rows[:, 0]) ** 2, -((b / rows[:, 1]) ** 2)], axis=1)
    spheroid = metric(rows) * (b * b)[:, None, None]
    whole = spheroid + at[:, None, None] * form[:, :, None] * np.eye(3)
    centre = rows[:, 4:7] / b[:, None]
    own = np.einsum("nij,nj->ni", spheroid, centre)
    place = np.linalg.solve(whole, own[:, :, None])[:, :, 0]
    least = np.linalg.eigvalsh(whole)[:, 0]
    squares, normal = form * place * place, np.linalg.norm(form * place, axis=1)
    sizes = np.abs(spheroid).sum(axis=(1, 2)), np.abs(at) * np.abs(form).sum(axis=1)
    terms = sizes[0] / 3 * (np.abs(place) + np.abs(centre)).sum(axis=1) / 3 + np.abs(at) * np.abs(form * place).sum(
        axis=1
    )
    left = 2.0**-46 * terms / least
    beside = (np.abs(squares.sum(axis=1) - 1) + 2.0**-46 * np.abs(squares).sum(axis=1)) / normal
    written = left + np.sqrt(np.trace(whole, axis1=1, axis2=2) / least) * (beside + left)
    shown = (least > 0) & (beside * np.abs(form).max(axis=1) < normal)
    known = np.isfinite(found.error)
    assert known.any() == shown.any()
    assert shown[known].all()
    assert (found.error[known] >= (b * written)[known] * (1 - 1e-6)).all()


def test_the_error_of_a_tilted_touch_is_infinite_for_a_disc_too_thin_for_elimination():
    """Eight roundings of the terms of G, 3 (b/d)² at least, are then more than half of an eigenvalue of 1."""
    rows = np.array([[2.0, 3.0, 0.5, 0.5 * 2.0**-k, 4.0, 1.0, 2.0, 1.0, 0.5, 0.25] for k in (12, 20)])
    assert np.isfinite(clearance_points.tilted_touches(rows).error).tolist() == [True, False]


@pytest.mark.parametrize(
    ("row", "square", "point"),
    [
        ((1.0, 0.5, 0.1, 0.2, 9.0, 0.0, 0.0, 1.0, 0.0, 0.0), 987.5, (4.5, 0.0, 4.8125**0.5)),
        ((1.0, 0.5, 0.1, 0.2, 2.4, 0.0, 0.0, 1.0, 0.0, 0.0), 47.0, (1.2, 0.0, 0.11**0.5)),
        ((1.0, 1.0, 1.2, 0.8, 0.0, 0.0, 1.0, 1.0, 0.0, 2.0), 1.5 / 1.44, (1.0, 0.5, 0.5)),
        ((1.0, 1.0, 1.2, 0.8, 0.0, 0.0, 1.0, 3.0, 0.0, 6.0), 1.5 / 1.44, (1.0, 0.5, 0.5)),
    ],
)
def test_a_tilted_touch_at_a_pole_of_the_multiplier_is_the_point_worked_out_by_hand(row, square, point):
    """The touch X solves M (X − C) = −λ D X.

    Of the first two rows λ is γ²/b², which leaves z free: x (1/d² + γ²/(α b)²) = c/d², and z² = γ² (x² − 1). Of the
    others it is −1/b², and X − C is at right angles to the axis: z − 1 = −z, x + 2 (z − 1) = 0, and y² = 1 + z² − x².
    """
    found = clearance_points.tilted_touches(np.array([row]))
    assert found.factor[0] ** 2 == pytest.approx(square, rel=1e-12)
    assert found.point[0] == pytest.approx(point, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("length", [2.0**700, 2.0**-700])
def test_a_tilted_touch_does_not_depend_on_the_length_of_the_axis(length):
    rows = TILTED[:4].copy()
    rows[:, 7:] *= length
    one, other = (clearance_points.tilted_touches(some) for some in (TILTED[:4], rows))
    assert np.array_equal(one.factor, other.factor)
    assert np.array_equal(one.point, other.point)


def test_a_tilted_spheroid_centred_on_the_axis_touches_where_its_clearance_says():
    """There the multiplier lies at a pole, and the point is found otherwise."""
    turns = np.arange(16) * (math.pi / 8) + 0.1
    axes = [(lean * math.cos(turn), lean * math.sin(turn), 1.0) for turn in turns for lean in (0.3, 1.0, 3.0)]
    rows = np.array([(2, 5, b, 0.75 - b, 0, 0, z, *axis) for axis in axes for b in (0.5, 0.25) for z in (0, 0.5, -1)])
    found = hypcheck.clearance(rows)
    offset, axis = found.touch - rows[:, 4:7], rows[:, 7:] / np.linalg.norm(rows[:, 7:], axis=1)[:, None]
    along = (offset * axis).sum(axis=1)
    across = np.linalg.norm(offset - along[:, None] * axis, axis=1)
    factor = np.hypot(across / rows[:, 2], along / rows[:, 3])
    assert (np.abs(factor - 1 - (found.lower + found.upper) / 2) <= 1e-8).all()
    assert np.allclose((found.touch**2 / (4, 4, -25)).sum(axis=1), 1, rtol=0, atol=1e-9)
