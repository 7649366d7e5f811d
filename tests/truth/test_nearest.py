"""The nearest-point oracle against closed forms and against high precision by another route."""

from __future__ import annotations

import math
import subprocess
import sys
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from hypcheck.errors import InputError
from hypcheck.geometry.pair import Pair, Position
from hypcheck.geometry.rows import invalid
from hypcheck.truth.nearest import Dual
from hypcheck.vectors import frozen
from tests.support.examples import examples
from tests.support.inside import NearestStage, clearances, nearest
from tests.support.inside import nearest_rows_positions as positions
from tests.support.nearest_points import nearest_points
from tests.truth.nearest_reference import mismatches, mixed_rows, reference, ulps


def side(row):
    """Whether the centre is outside (1), on (0) or inside (−1) the hyperboloid, exactly."""
    alpha, gamma, _, _, x, y, z = (Fraction(value) for value in row)
    F = (x * x + y * y) / alpha**2 - z * z / gamma**2 - 1
    return (F > 0) - (F < 0)


def check(row):
    found = nearest(Pair.from_row(row))
    truth, rho, zeta = reference(row)
    # Correctly rounded; near an underflow the sign is kept instead, which costs up to 1.
    assert ulps(found.clearance, truth) <= (1 if abs(found.clearance) == 5e-324 else 0.5000001), (row, found, truth)
    assert (found.clearance > 0) == (truth > 0)
    assert found.position == (side(row) if truth > 0 else 0)
    assert found.stage in (NearestStage.PRECISE, NearestStage.EXACT)
    points = nearest_points(Pair.from_row(row))
    with mp.workprec(20000):
        x, y, z = (mpf(value) for value in row[4:])
        r = mp.sqrt(x * x + y * y)
        across = (rho * x / r, rho * y / r) if r else (rho, mpf(0))
        heights = (zeta, -zeta) if z == 0 and zeta != 0 else (mp.sign(z) * zeta,)
        assert len(points) == len(heights)
        for point, height in zip(points, heights, strict=True):
            assert all(ulps(abs(value), abs(true)) <= 1 for value, true in zip(point, (*across, height), strict=True))
    return found


UNIT = st.floats(1, 2, exclude_max=True)
CENTRES = ("free", "near", "on", "axis", "waist", "cusp")


def power(lowest, highest):
    """A float64 of a random binary order between two."""
    return st.builds(math.ldexp, UNIT, st.integers(lowest, highest))


@st.composite
def regime_rows(draw, wide, high, centre):
    """α/b ≥ 1 if wide, (γ/d)² ≥ α/b if high, the centre of one of CENTRES."""
    a = draw(power(0, 12)) if wide else draw(power(-12, -1))
    c = math.sqrt(a) * (draw(power(0, 8)) if high else draw(power(-8, -1)))
    b, d, turn = draw(power(-8, 8)), draw(power(-8, 8)), draw(st.floats(0, 7))
    r, z = _meridian_centre(draw, a, c, centre)
    return (a * b, c * d, b, d, r * b * math.cos(turn), r * b * math.sin(turn), z * d)


def _meridian_centre(draw, a, c, centre):
    tangent = draw(st.sampled_from((-1, 1))) * draw(power(-20, 6))
    rho, zeta = a * math.hypot(1, tangent), c * tangent
    if centre in ("near", "on"):
        length = math.hypot(rho / a**2, zeta / c**2)
        away = 0 if centre == "on" else draw(st.sampled_from((-1, 1))) + draw(power(-52, -2))
        return rho + away * rho / a**2 / length, zeta - away * zeta / c**2 / length
    if centre == "axis":
        return draw(st.sampled_from((0.0, 1.0, 2.0**-60, 2.0**-500))) * draw(power(-4, 0)) * a, zeta
    if centre == "waist":
        return rho, draw(st.sampled_from((0.0, 1.0, 2.0**-60, 2.0**-500))) * draw(power(-4, 0))
    if centre == "cusp":
        near_evolute = 1 + draw(st.sampled_from((-1, 0, 1))) * draw(power(-52, -2))
        return (a + c * c / a) * near_evolute, draw(st.sampled_from((0.0, 1.0))) * draw(power(-80, 0)) * c
    return rho * draw(power(-4, 4)), zeta * draw(power(-4, 4))


ANY_SIZE = st.floats(5e-324, sys.float_info.max)
ANY_COORDINATE = st.floats(allow_nan=False, allow_infinity=False)
ORDERLY = st.floats(0.25, 64)
EXTREME_ROWS = st.tuples(
    *[st.one_of(ANY_SIZE, power(-1074, 1023), ORDERLY)] * 4,
    *[st.one_of(ANY_COORDINATE, power(-1074, 1023), ORDERLY, st.just(0.0))] * 3,
)


@pytest.mark.parametrize("centre", CENTRES)
@pytest.mark.parametrize("wide", [True, False])
@pytest.mark.parametrize("high", [True, False])
@settings(max_examples=25)
@given(data=st.data())
def test_the_clearance_is_rounded_correctly_in_every_regime(data, wide, high, centre):
    check(data.draw(regime_rows(wide, high, centre)))


@examples(60)
@given(EXTREME_ROWS)
@example((5e-324,) * 7)
@example((1e-300, 1e300, 1e300, 1e-300, 1.0, 2.0, 3.0))  # sizes apart by 1e600 each way
@example((1e300, 1e300, 1e-300, 1e-300, 1e300, 1e-300, 1e300))
@example((sys.float_info.max, 5e-324, 5e-324, sys.float_info.max, 5e-324, 0.0, 5e-324))
@example((1.0, 1.0, 3.0, 1.0, 4.0, 1e-160, 0.0))  # clear by 4e-322
@example((4.0, 10.0, 1.0, 1.0, 3.0, 4.0, 1e-160))  # overlapping by 2e-322
def test_the_clearance_is_rounded_correctly_over_all_of_float64(row):
    check(row)


@pytest.mark.parametrize("hair", [1e-170, 1e-230, 1e-250, 1e-300, 5e-324])
def test_a_clearance_too_small_for_float64_keeps_its_sign(hair):
    clear = nearest(Pair(1, 1, 3, 1, 4, hair, 0))  # by hair²/24
    overlapping = nearest(Pair(4, 10, 1, 1, 3, 4, hair))
    assert (clear.clearance, clear.position) == (5e-324, Position.EXTERIOR)
    assert (overlapping.clearance, overlapping.position) == (-5e-324, Position.CONTACT)


def test_a_clearance_too_large_for_float64_is_inf():
    found = nearest(Pair(1, 1, 1e-300, 1e-300, 1e300, 0, 0))
    assert (found.clearance, found.position) == (math.inf, Position.EXTERIOR)
    assert nearest_points(Pair(1, 1, 1e-300, 1e-300, 1e300, 0, 0))[0] == (5e299, 0, 5e299)


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize(("odd", "even"), [(1, 2.0), (3, 2 - 2.0**-51), (5, 2 - 2.0**-51)])
def test_clearance_halfway_between_two_floats_is_rounded_to_even(odd, even, sign):
    """With α = odd·2⁻⁵³, r − a − 1 = 2 − α lies halfway between two float64; no enclosure can show that."""
    assert nearest(Pair(odd * 2.0**-53, 1, 1, 1, sign * 3, 0, 0)).clearance == even


@given(*[st.integers(1, 40)] * 4, st.integers(0, 40))
def test_spheroid_centred_on_the_axis_has_a_circle_of_nearest_points(alpha, gamma, b, d, z):
    found = check((float(alpha), float(gamma), float(b), float(d), 0.0, 0.0, float(z)))
    A, B, Q = Fraction(alpha, b) ** 2, Fraction(gamma, d) ** 2, Fraction(z, d) ** 2
    assert found.clearance == pytest.approx(math.sqrt(A + A * Q / (A + B)) - 1, rel=1e-12, abs=1e-15)
    assert (found.clearance == 0) is (A + A * Q / (A + B) == 1)
    assert (found.stage, found.multiplier) == (NearestStage.EXACT, -A)


@given(*[st.integers(1, 12)] * 4, st.integers(0, 100), st.integers(0, 100))
@example(2, 1, 1, 1, 3, 1)  # tangent in two points: P = (A + B)(B + 1)/B
@example(2, 2, 1, 1, 4, 0)  # on the evolute: a r = A + B
@example(2, 1, 1, 1, 3, 0)
def test_spheroid_centred_in_the_waist_plane_has_one_or_two_nearest_points(alpha, gamma, b, d, x, y):
    row = tuple(map(float, (alpha, gamma, b, d, x, y, 0)))
    a, A, B, P = Fraction(alpha, b), Fraction(alpha, b) ** 2, Fraction(gamma, d) ** 2, Fraction(x * x + y * y, b * b)
    found = check(row) if P else check((*row[:4], 1.0, 0.0, 0.0))
    if P == 0:
        return
    if A * P > (A + B) ** 2:
        squared = B * (P - A - B) / (A + B)
        assert (found.stage, found.multiplier) == (NearestStage.EXACT, B)
        assert len(nearest_points(Pair(*row))) == 2
        assert (found.clearance == 0) is (squared == 1)
    else:
        assert len(nearest_points(Pair(*row))) == 1
        assert (found.clearance == 0) is (P == (a + 1) ** 2 or (a >= 1 and P == (a - 1) ** 2))


def test_a_multiplier_that_is_not_the_maximum_of_the_dual_does_not_count_as_a_tangency():
    """Here g has three roots, the middle one halfway, at λ = −1: D = 1 there, but it rises further towards −A."""
    pair = Pair(3, 1, 2, 2, 0, 0, 0)
    assert not Dual.of(pair.lengths).touches(Fraction(-1))
    assert nearest(pair).clearance == 0.5


def test_a_tangency_whose_optimum_is_a_binary_fraction_has_the_clearance_0():
    """The slope is exactly 0 there, and no wider enclosure has it of one sign."""
    (case,) = (case for case in frozen.load("tangent").cases if case.id == "tangent-0060")
    found = nearest(Pair.from_row(case.row))
    assert (found.position, found.clearance) == (case.position, 0)


TRIPLES = ((3, 4, 5), (4, 3, 5), (5, 12, 13), (12, 5, 13), (8, 15, 17))


def tangent_pair(triple, k, v, sign, distance):
    """Integers that stand for a unit sphere whose centre is `distance` along the normal from a point of H, or None.

    With cosine C and sine S, u = 1/(k²v), a = (u + v)/(2C), c = (v − u)/(2S), the point (a²kC, c²kS) is on H with unit
    normal (C, −S). It is the nearest point up to distance B k outward and A k inward; further on the unit sphere still
    touches there, and crosses elsewhere (with a node or an isolated point).
    """
    C, S = Fraction(triple[0], triple[2]), Fraction(triple[1], triple[2])
    u = 1 / (k * k * v)
    u, v = min(u, v), max(u, v)
    if u == v:
        return None
    a, c = (u + v) / (2 * C), (v - u) / (2 * S)
    nearest_there = distance / k <= (c * c if sign > 0 else a * a)
    radial = (a, Fraction(1), a * a * k * C + sign * distance * C)
    axial = (c, Fraction(1), c * c * k * S - sign * distance * S)
    units = [math.lcm(*(length.denominator for length in group)) for group in (radial, axial)]
    alpha, b, x = (int(length * units[0]) for length in radial)
    gamma, d, z = (int(length * units[1]) for length in axial)
    row = (alpha, gamma, b, d, x, 0, z)
    return (row, nearest_there) if max(map(abs, row)) <= 2**53 and x >= 0 else None


@examples(400)
@given(
    st.sampled_from(TRIPLES),
    st.builds(Fraction, st.integers(1, 6), st.integers(1, 6)),
    st.builds(Fraction, st.integers(1, 9), st.integers(1, 6)),
    st.sampled_from((-1, 1)),
    st.builds(lambda order, up: Fraction(up, 2**order), st.integers(0, 30), st.sampled_from((-1, 0, 1))),
)
def test_clearances_of_rational_tangencies_and_of_pairs_beside_them_are_right(triple, k, v, sign, step):
    built = tangent_pair(triple, k, v, sign, 1 + step)
    if built is None:
        return
    row, nearest_there = built
    found = nearest(Pair(*row))
    if not nearest_there:
        assert found.clearance < step
        return
    assert found.clearance == float(step)
    assert (found.clearance == 0) is (step == 0)
    assert found.position == (sign if step > 0 else 0)
    assert (found.stage is NearestStage.EXACT) or step != 0
    batch = clearances(np.array([row], float))
    assert (batch.clearance[0], batch.position[0]) == (found.clearance, found.position)


def test_clearances_of_a_batch_equal_clearances_of_single_pairs():
    rows = mixed_rows(6000, seed=1)
    batch = clearances(rows)
    assert mismatches(batch, rows) == 0
    counts = np.bincount(batch.stage, minlength=len(NearestStage))
    assert (counts > 0).all(), counts
    assert batch.clearance.dtype == np.float64
    assert batch.position.dtype == np.int8
    assert batch.stage.dtype == np.uint8


def test_positions_computed_without_clearances_agree_and_need_fewer_high_precision_rows():
    rows = mixed_rows(6000, seed=2)
    batch, alone = clearances(rows), positions(rows)
    assert (alone.position == batch.position).all()
    assert (alone.tangent == (batch.clearance == 0)).all()
    assert alone.tangent.any()
    assert (alone.stage == NearestStage.PRECISE).sum() < (batch.stage == NearestStage.PRECISE).sum() / 4


@examples(100)
@given(st.lists(EXTREME_ROWS, min_size=1, max_size=4))
def test_clearances_of_a_batch_equal_those_of_single_pairs_over_all_of_float64(rows):
    table = np.array(rows)
    assert mismatches(clearances(table), table) == 0


@pytest.mark.parametrize("order", [-1000, -1015, -1030, 1000, 1015])
def test_clearances_of_a_batch_equal_those_of_single_pairs_at_the_limits_of_float64(order):
    with np.errstate(over="ignore"):
        rows = mixed_rows(600, seed=9) * 2.0**order
    rows = rows[~invalid(rows)]
    assert len(rows) > 100
    assert mismatches(clearances(rows), rows) == 0


def test_nearest_oracle_returns_nothing_for_no_rows_and_refuses_invalid_rows():
    assert len(clearances(np.empty((0, 7))).clearance) == 0
    rows = mixed_rows(3, seed=4)
    rows[1, 2] = 0.0
    with pytest.raises(InputError, match="row 1: b is 0"):
        clearances(rows)
    with pytest.raises(InputError, match="row 1: b is 0"):
        positions(rows)


def test_nearest_of_one_pair_does_not_load_numpy():
    script = (
        "import sys; from hypcheck.geometry.pair import Pair; from hypcheck.truth.nearest import nearest;"
        "nearest(Pair(1, 2, 1, 1, 2.5, 0, 0)); sys.exit('numpy' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", script], check=False).returncode == 0


def test_clearance_of_a_row_does_not_depend_on_the_other_rows_of_its_batch():
    rows = mixed_rows(5000, seed=3)
    rows[7] = (1e-300, 1e300, 1e300, 1e-300, 1, 2, 3)
    forward, backward = clearances(rows), clearances(rows[::-1])
    assert (forward.clearance == backward.clearance[::-1]).all()
    assert (forward.stage == backward.stage[::-1]).all()
