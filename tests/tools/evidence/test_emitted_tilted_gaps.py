"""What reasons of gaps in kernels for tilted movers say of numbers holds for every axis, and for every centre.

M is the spheroid's matrix and D the hyperboloid's. The eigenvalues of M^-1 are b^2 and d^2, so the poles A1 and A2 are
from alpha^2 over the larger to alpha^2 over the smaller of both, and B is from gamma^2 over them. An entry of M^-1
between the level plane and the axis of the hyperboloid is at most half their difference.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import pytest

from hypcheck.geometry.pair import Position
from tests.tools.evidence.test_emitted_gaps import plan_named

TOWERS = ("the tower, one axis", "the tower, any axis", "the tower, any axis, contact")
SLACK = 1 + Fraction(1, 2**18)
"""More than roundings of the kernel's numbers, of its lines' margins and of the slopes that it compares."""

ROUNDINGS = 2.0**-47
"""`more` less `less`: a spread is at least this share of gain and loss, and what is unknown of components besides."""

ENDED = 2.0**-44
"""Of gain and loss, how much they differ where a search has ended: by roundings, its last interval, or its end by 0."""


@dataclass(frozen=True)
class Reach:
    """Bounds of a setting: of the squares b^2 and d^2, of the poles, and of the ways to them."""

    alpha: float
    gamma: float
    least: float
    most: float
    between: float

    @property
    def radial(self):
        """A1 and A2 are between these."""
        return self.alpha**2 / self.most, self.alpha**2 / self.least

    @property
    def axial(self):
        """B is between these."""
        return self.gamma**2 / self.most, self.gamma**2 / self.least


def reach_of(stages):
    alpha, gamma, b, d = map(Fraction, stages.setting.sizes)
    least, most = sorted((b * b, d * d))
    return Reach(alpha, gamma, least, most, (most - least) / 2)


def line_of(stages, side):
    line = next(line for line in stages.lines if line.side is side)
    return [
        Fraction(next(value for key, value in line.constants.items() if key.startswith(name)))
        for name in ("intercept", "slope")
    ]


def growth(of, pole):
    """By how much |C| across the axis is at least larger than that of X, where l is `pole` or more and h(X) > 0."""
    return 1 + pole * (of.least / of.alpha**2 - of.between / (of.alpha * of.gamma))


@pytest.mark.parametrize("name", TOWERS)
def test_outside_a_tower_a_centre_whose_maximum_is_nearer_to_the_pole_is_beyond_the_line(name):
    """With r the radius of X, > alpha, its height is below r gamma/alpha; so C is above growth r across the axis."""
    (stages,) = plan_named(name).settings
    of, (intercept, slope) = reach_of(stages), line_of(stages, Position.EXTERIOR)
    halves = [pole / 2 for pole in of.axial]
    wide = growth(of, halves[0])
    assert wide > 1
    high = max(
        of.gamma / of.alpha * max(abs(1 - half * square / of.gamma**2) for square in (of.least, of.most))
        + half * of.between / of.alpha**2
        for half in halves
    )
    assert (wide**2 - slope * high**2) * of.alpha**2 > intercept * SLACK


@pytest.mark.parametrize("name", TOWERS)
def test_inside_a_tower_a_centre_whose_maximum_is_nearer_to_the_pole_is_beyond_the_line(name):
    """With t the height of X over gamma, its radius is at most alpha √(1 + t²), and 2 t √(1 + t²) <= 1 + 2 t²."""
    (stages,) = plan_named(name).settings
    of, (intercept, slope) = reach_of(stages), line_of(stages, Position.INTERIOR)
    b = Fraction(stages.setting.sizes[2])
    halves = of.radial[0] / 2, of.alpha**2 / b**2 / 2  # the nearer pole is at most A1
    shrink = max(abs(1 - half * square / of.alpha**2) for half in halves for square in (of.least, of.most))
    wide = of.alpha * shrink + max(halves) * of.between / of.gamma
    up, back = of.gamma * (1 + min(halves) * of.least / of.gamma**2), max(halves) * of.between / of.alpha
    assert wide**2 * SLACK < intercept - slope * up * back
    assert wide**2 * SLACK < slope * (up**2 - 2 * up * back)


def share_unknown(of, search, *, to_a, to_b):
    """Of gain and loss, what the errors of components may change, where the ways to the poles are these at least.

    |C| is below `most` squared roots of P1 + P2 + Q; one of gain and loss has its share of those.
    """
    gained = min(of.radial[0] / (of.radial[1] + of.axial[1]) ** 2, 1 / (4 * of.axial[1])) / 2
    error = search.most * 4 * search.omega * (3 * float(of.most) / float(gained)) ** 0.5
    error *= max(float(of.radial[1]) ** 0.5 / to_a, float(of.axial[1]) ** 0.5 / to_b)
    return 12 * error * (1 + error)


def step_over_way(spread, ratio):
    """How long a step is, at most, beside the way to the nearer pole A, where the farther is 1/ratio as far."""
    return 16 * spread * (2 + ENDED) / ratio


def by_zero(of):
    """At the start of the search, where a maximum is between it and 0: how much gain and loss differ, of both."""
    return 2.0**-61 * max(float(of.axial[1] / of.radial[0]), 1)


@pytest.mark.parametrize("name", [*TOWERS, "two trees, one axis"])
def test_where_maxima_are_nearer_to_0_a_step_of_the_proof_is_short_and_turns_the_sign_of_the_slope(name):
    """The slope falls by twice `bend` for each unit of a step, but for four times the step over the nearest way."""
    stages = plan_named(name).settings[0]
    of, search = reach_of(stages), stages.last
    (nearest, farthest), (low, high) = (tuple(map(float, poles)) for poles in (of.radial, of.axial))
    spread = 2 * ROUNDINGS + share_unknown(of, search, to_a=nearest / 2, to_b=low / 2)
    step = step_over_way(spread, (nearest / 2) / (farthest - nearest / 2))
    over_b = step * (farthest + high / 2) / (low / 2)
    assert max(step, over_b) < 2.0**-8
    assert by_zero(of) < ENDED / 2
    assert ENDED + 2 * ROUNDINGS < 32 * ROUNDINGS * (1 - 4 * max(step, over_b))  # all the more for larger spreads


def test_beside_two_trees_a_step_of_the_proof_is_below_half_the_way_to_the_pole_on_the_other_side():
    """Also where the search ends next to the pole B, 2^-62 of it away at least."""
    for stages in plan_named("two trees, one axis").settings:
        of, search = reach_of(stages), stages.last
        nearest, farthest = map(float, of.radial)
        to_b = float(of.axial[0]) * 2.0**-62
        spread = 2 * ROUNDINGS + share_unknown(of, search, to_a=nearest, to_b=to_b)
        assert by_zero(of) < ENDED / 2
        assert step_over_way(spread, nearest / farthest) < 1 / 4


def test_one_pole_of_a_frame_of_one_axis_is_nearer_everywhere():
    for name, a1_is_nearer in (("the tower, one axis", True), ("two trees, one axis", False)):
        for stages in plan_named(name).settings:
            a1, a2 = (sum(map(Fraction, stages.last.constants[key])) for key in ("A1", "A2"))
            assert (a1 < a2) is a1_is_nearer
            assert abs(a1 - a2) > max(reach_of(stages).axial) * Fraction(1, 2**40)


def test_of_the_oak_what_is_not_clear_has_room_that_steps_do_not_use():
    stages = plan_named("two trees, one axis").settings[0]
    of, search, cut = reach_of(stages), stages.last, stages.setting.cut
    intercept, slope = line_of(stages, Position.EXTERIOR)
    tall = Fraction(max(abs(cut.low), abs(cut.high))) ** 2
    wide = intercept + slope * tall
    grown = growth(of, of.axial[0] / 2)
    assert grown > 1
    assert (grown * of.alpha) ** 2 > wide * SLACK  # so no maximum is nearer to the pole

    (nearest, farthest), (low, high) = (tuple(map(float, poles)) for poles in (of.radial, of.axial))
    size = float((wide + tall) / of.least) ** 0.5 * 1.01  # of each component
    error = float(3 * (wide + tall)) ** 0.5 * search.most * 4 * search.omega
    of_phi = 2 * (3 * (2 * size + error) * error + 4 * search.omega * (5 * size**2 + 1 + high))
    assert of_phi < 2.0**-70
    spread = 2 * ROUNDINGS + share_unknown(of, search, to_a=nearest, to_b=low / 2)
    longest = step_over_way(spread, nearest / farthest) * (farthest + high / 2)
    steepest = (ENDED + spread) * 2.1 * (1 + 4 * size**2 / low)
    assert steepest * longest < 2.0**-55 < (1.6e-16 - 2 * of_phi) / 2
