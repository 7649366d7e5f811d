"""The way of a spheroid that leans: steps against roots, exact decisions on the way, its tangencies and rings."""

from __future__ import annotations

from fractions import Fraction

import pytest
import sympy
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import hypcheck
from hypcheck.errors import InputError
from hypcheck.geometry.pair import Lengths, Pair, Position
from hypcheck.truth import polynomials
from hypcheck.truth.sweep import _ring_between
from hypcheck.vectors import frozen
from hypcheck.vectors.tilted import listed
from tests.support.examples import examples
from tests.support.inside import (
    by_roots,
    by_steps,
    exact,
    hits_at_size,
    is_tolerated,
    passage,
    quartic,
    sign_at_root,
    size_error,
    surfaces,
    sweep_of,
    tolerance,
)
from tests.support.inside import position as exact_position

RINGS, TWO_POINTS = (list(map(tuple, listed(name).tolist())) for name in ("rings", "tangent-in-two-points"))

CONTACT = Position.CONTACT

_sizes = st.tuples(*[st.integers(32, 1024).map(lambda n: n / 256)] * 4)
_centers = st.tuples(*[st.integers(-1536, 1536).map(lambda n: n / 256)] * 3)
_axes = st.tuples(*[st.integers(-3, 3)] * 3).filter(lambda axis: any(axis[:2]))


def position(sizes, start, end, axis, time):
    centre = (Fraction(a) + time * (Fraction(b) - Fraction(a)) for a, b in zip(start, end, strict=True))
    return exact_position(Lengths.of((*map(Fraction, sizes), *centre, *map(Fraction, axis))))


@examples(50)
@given(_sizes, _centers, _centers, _axes)
def test_answer_about_a_tilted_sweep_agrees_with_exact_positions_on_it(sizes, start, end, axis):
    found = passage(sizes, start, end, axis)
    assert found.start == position(sizes, start, end, axis, Fraction(0))
    assert found.end == position(sizes, start, end, axis, Fraction(1))
    for number in range(33):
        time = Fraction(number, 32)
        there = position(sizes, start, end, axis, time)
        if found.clear or time < found.first[0]:
            assert there == found.start
        elif there == 0:
            assert found.first[0] <= time
        elif there != found.start:
            assert found.first[1] < time


@pytest.mark.parametrize("number", ["0018", "0032", "0036"])
def test_a_tilted_sweep_through_the_ring_is_clear_by_its_roots(number):
    """Its double root is at a pole, between clear times; the height of an upright one would tell whether it touches."""
    (case,) = (case for case in frozen.load("tilted-way-ring").cases if case.id.endswith(number))
    row = case.row
    assert case.hit == 0
    assert by_roots(sweep_of(row[:4], row[4:7], row[7:10], row[10:])).clear


@settings(max_examples=8, deadline=None)
@given(_sizes, _centers, _centers, st.one_of(st.none(), _axes))
def test_passage_by_steps_and_by_roots_agree_about_a_tilted_sweep(sizes, start, end, axis):
    sweep = sweep_of(sizes, start, end, axis)
    steps, roots = by_steps(sweep), by_roots(sweep)
    assume(steps is not None)
    assert (steps.start, steps.end, steps.hit, steps.grazes) == (roots.start, roots.end, roots.hit, roots.grazes)
    if steps.hit:
        assert steps.first[0] <= roots.first[1]
        assert roots.first[0] <= steps.first[1]


def beside(row):
    """The direction in the plane of y = 0 that keeps the centre at the same place beside the pole, and one across it.

    The double root is the pole: towards exterior that of a direction k in that plane, and the first keeps kᵀ M C at 0;
    towards interior that of y, and the first goes along the level of φ.
    """
    F = quartic(Lengths.of(row))
    pole = exact.double_root(F) * F.side
    S, H = surfaces(Pair.from_row(row))
    (m, _, n), (_, _, w) = S[0][:3], S[2][:3]
    if F.side > 0:
        k = (-n, m + pole * H[0][0])
        along = (m * k[0] + n * k[1], n * k[0] + w * k[1])
    else:
        a, c = m + pole * H[0][0], w + pole * H[2][2]
        centre = Fraction(row[4]), Fraction(row[6])
        x, z = (m * centre[0] + n * centre[1], n * centre[0] + w * centre[1])
        along = ((c * x - n * z) * H[0][0], (a * z - n * x) * H[2][2])
    size = max(map(abs, along))
    return (-along[1] / size, Fraction(0), along[0] / size), (along[0] / size, Fraction(0), along[1] / size)


def way_through(row, direction, reach):
    centre = tuple(map(Fraction, row[4:7]))
    start, end = (tuple(c + n * w * reach for c, w in zip(centre, direction, strict=True)) for n in (-1, 2))
    return row[:4], start, end, row[7:]


@pytest.mark.parametrize("row", RINGS)
def test_tilted_sweep_that_passes_the_ring_is_clear(row):
    """Every way through the centre is short enough to stay clear, and the discriminant is 0 there."""
    ways = [beside(row)[0], (0, 1, 0)]
    for way in ways:
        sweep = sweep_of(*way_through(row, way, Fraction(1, 2**20)))
        assert by_roots(sweep).clear
        assert by_steps(sweep).clear


@pytest.mark.parametrize(
    "row", [pytest.param(row, marks=[pytest.mark.thorough] * (place % 3 > 0)) for place, row in enumerate(TWO_POINTS)]
)
def test_a_sweep_through_a_tangency_in_two_points_grazes_at_that_time_only(row):
    found = passage(*way_through(row, beside(row)[0], Fraction(1, 2**20)))
    assert found.hit
    assert found.grazes
    assert found.first[0] <= Fraction(1, 3) <= found.first[1]
    assert found.first[1] - found.first[0] < Fraction(1, 2**50)
    assert found.start is found.end is not CONTACT


@pytest.mark.parametrize("row", TWO_POINTS)
def test_a_sweep_into_a_tangency_in_two_points_meets_it(row):
    for way in (beside(row)[1], (0, 1, 0), (1, 2, -1)):
        found = passage(*way_through(row, way, Fraction(1, 2**20)))
        assert found.hit
        assert found.first[0] <= Fraction(1, 3)


def test_a_sweep_along_which_every_position_has_a_multiple_root_is_decided():
    """b = α, and the centre on a line through the origin: tangent near the origin, interior far from it.

    With λ = −1 the form S + λH has two zero directions at every time; −1 is the pole of the direction n.
    """
    way = ((3, 1, 3, 1), (0, 0, 0), (Fraction(128, 9), 0, 64), (1, 0, 2))
    sweep = sweep_of(*way)
    found = passage(*way)
    positions = [position(*way, Fraction(n, 16)) for n in range(17)]
    assert {*positions} == {CONTACT, Position.INTERIOR}
    assert all(sweep.tangent(Fraction(n, 16)) for n in range(17) if positions[n] is CONTACT)
    assert found.first == (0, 0)
    assert found.grazes
    back = by_roots(sweep_of(way[0], way[2], way[1], way[3]))
    last = Fraction(positions.count(CONTACT) - 1, 16)
    assert 1 - last - Fraction(1, 16) <= back.first[0] <= back.first[1] <= 1 - last
    ended = passage(way[0], way[2], way[1], way[3], z_min=-30)
    assert ended.first[0] <= back.first[1]
    assert back.first[0] <= ended.first[1] <= ended.first[0] + Fraction(1, 2**60)
    assert ended.grazes
    assert passage(way[0], way[2], way[1], way[3], z_min=40).clear
    for short, clear in ((-Fraction(1, 2**55), True), (Fraction(1, 2**55), False)):
        until = [there + (back.first[0] + short) * (here - there) for here, there in zip(*way[1:3], strict=True)]
        assert passage(way[0], way[2], until, way[3], z_min=-30).clear is clear


@settings(max_examples=15, deadline=None)
@given(
    _sizes,
    _centers,
    _centers,
    _axes,
    st.sampled_from([Fraction(1, 2**n) for n in (3, 6, 12)]),
    st.lists(st.sampled_from([-1, 0, 1]), min_size=13, max_size=13),
)
def test_an_answer_that_is_right_for_changed_inputs_of_a_tilted_sweep_is_tolerated(
    sizes, start, end, axis, change, signs
):
    row = tuple(map(Fraction, (*sizes, *start, *end, *axis)))
    moved = tuple(each * (1 + sign * change) for each, sign in zip(row, signs, strict=True))
    assert is_tolerated(row, hits_at_size(moved), tolerance(row, 1, change))


def test_a_tilted_size_error_is_bracketed_by_exact_decisions():
    row = (2.0, 3.0, 1.0, 0.5, -4.0, 3.5, 0.0, 4.0, 3.5, 0.0, 1.0, 0.0, 1.0)
    assert not hits_at_size(row)
    found = size_error(row, True)
    assert not hits_at_size(row, 1 + Fraction(found.lower))
    assert hits_at_size(row, 1 + Fraction(found.upper))


def test_tilted_passage_refuses_an_axis_without_direction():
    with pytest.raises(InputError, match="an axis must have a direction"):
        hypcheck.passage((2, 3, 1, 0.5), (0, 0, 0), (1, 0, 0), (0, 0, 0))
    with pytest.raises(InputError, match=r"the axis: 2 numbers in .*; there must be 3: axis_x, axis_y, axis_z"):
        hypcheck.passage((2, 3, 1, 0.5), (0, 0, 0), (1, 0, 0), (0, 1))


def rationals(*numbers):
    return [Fraction(each) for each in numbers]


@pytest.mark.parametrize("roots", [(Fraction(1, 3), 2), (-2, Fraction(1, 3)), (Fraction(1, 3),) * 2, (Fraction(1, 3),)])
@pytest.mark.parametrize("g", [(1, -1, 0), (0, 3, 2), (-5, 4, 1), (2, 1, -1), (0, 0, -3), (3, -7, 2)])
def test_sign_at_the_only_root_between_two_times_equals_that_of_the_exact_value_at_the_root(roots, g):
    """f has the root 1/3, once or twice, alone or with another; where no root is between, the sign is 0."""
    total = (1, -sum(roots), roots[0] * roots[1]) if len(roots) > 1 else (0, 1, -roots[0])
    time = Fraction(1, 3)
    there = (g[0] * time + g[1]) * time + g[2]
    expected = (there > 0) - (there < 0)
    for sign in (1, -1):
        f = rationals(*(sign * each for each in total))
        for low, high in (
            (Fraction(0), Fraction(1)),
            (Fraction(3, 10), Fraction(1, 2)),
            (Fraction(-1), Fraction(3, 4)),
        ):
            assert sign_at_root(f, rationals(*g), low, high) == expected
        for low, high in ((Fraction(1, 2), Fraction(1)), (Fraction(0), Fraction(1, 4))):
            assert sign_at_root(f, rationals(*g), low, high) == 0


@pytest.mark.parametrize(
    ("low", "high", "ring"), [(0, 1, True), (Fraction(1, 2), 1, False), (-1, Fraction(1, 4), False)]
)
def test_ring_between_two_times_is_found_only_if_its_time_lies_between_them(low, high, ring):
    """F(ℓ) = (3 t − 1)², F′(ℓ) = 3 t − 1 and F″(ℓ) = 1 > 0: the ring at 1/3."""
    at_pole, slope, curvature = rationals(9, -6, 1), rationals(0, 3, -1), rationals(0, 0, 1)
    assert _ring_between(at_pole, slope, curvature, Fraction(low), Fraction(high)) is ring


def test_a_sweep_grazes_if_it_touches_at_its_start_and_stays_there_or_moves_away():
    touching, away = (2.0, 0.0, 0.0), (5.0, 0.0, 0.0)
    for end in (touching, away):
        found = passage((1, 1, 1, 1), touching, end)
        assert (found.first, found.grazes) == ((0, 0), True)
    assert not passage((1, 1, 1, 1), (1.5, 0.0, 0.0), (1.5, 0.0, 0.0)).grazes
    late = by_roots(sweep_of((1, 1, 1, 1), (11.0, 0.0, 0.0), (1.0, 0.0, 0.0)))
    assert late.first[0] <= Fraction(9, 10) <= late.first[1]
    assert not late.grazes


@pytest.mark.parametrize("axis", [None, (1.0, 0.0, 2.0)])
def test_passage_through_the_mouth_of_a_tower_reports_the_positions_at_its_start_and_end(axis):
    """From above the mouth into the body, and back."""
    above, within = (0.5, 0.0, 9.0), (0.5, 0.0, 1.0)
    for start, end in ((above, within), (within, above)):
        found = passage((3, 4, 0.25, 0.5), start, end, axis, z_min=-3, z_max=5)
        assert (found.start, found.end) == tuple(1 if place is above else -1 for place in (start, end))


def test_the_next_subresultant_replaces_a_discriminant_that_is_always_0():
    sweep = sweep_of((3, 1, 3, 1), (0, 0, 0), (Fraction(128, 9), 0, 64), (1, 0, 2))
    assert not sweep.discriminant()
    ratios = set()
    for time in range(1, 7):
        F = [polynomials.value(f, Fraction(time)) for f in sweep.pencil]
        shifts = [[0] * k + F for k in range(2)] + [[0] * k + [*polynomials.derivative(F)] for k in range(3)]
        determinant = sympy.Matrix([[*row, *[0] * 5][:5] for row in shifts]).det()
        ratios.add(determinant / polynomials.value(sweep.root_changes(), Fraction(time)))
    assert len(ratios) == 1
    assert 0 not in ratios


def test_a_disc_on_its_edge_that_passes_the_throat_with_exact_fit_grazes_it_at_one_time():
    """It stands across x, 2 in radius, its centre at y = 1: at the height 0 it reaches y = 3, where the throat ends."""
    found = passage((3, 2, 2, 1), (0, 1, -3), (0, 1, 3), (1, 0, 0))
    assert (found.hit, found.first, found.grazes) == (True, (Fraction(1, 2), Fraction(1, 2)), True)
    assert not passage((3, 2, 2, 1), (0, Fraction(999, 1000), -3), (0, Fraction(999, 1000), 3), (1, 0, 0)).hit


def test_a_polynomial_whose_first_coefficient_the_prime_of_the_quick_test_divides_is_made_squarefree():
    """Modulo that prime, 2⁶¹ − 1, (p x − 1)² (x + 1) is x + 1, and has no double root."""
    p = 2**61 - 1
    found = polynomials.squarefree((p * p, p * p - 2 * p, 1 - 2 * p, 1))
    assert found in {(p, p - 1, -1), (-p, 1 - p, 1)}  # (p x − 1) (x + 1), or its opposite
    assert polynomials.squarefree((p, 0, -1)) == (p, 0, -1)
