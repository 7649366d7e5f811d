"""The stage that decides rows whose axis leans in floats: what its program is, and that its bounds hold."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest

from hypcheck.derivation.evaluation import EXACT, evaluate
from hypcheck.derivation.program import cut
from hypcheck.derivation.rounding import gamma, relative_error_counts
from hypcheck.kernel.programs import tilted
from hypcheck.kernel.programs.certified import SLACK, U
from tests.kernel.test_tilted_integers import small_rows
from tests.support.tilted_fractions import derivative, exact_position, interpolated, matrices, value

EXACTLY = {name: Fraction(each) for name, each in tilted.CONSTANTS.items()}


def in_units_of_b(row):
    b = Fraction(row[2])
    return [*(Fraction(each) / b for each in row[:7]), *map(Fraction, row[7:])]


def found(row, at, constants=EXACTLY):
    return evaluate(
        tilted.TILTED, EXACT, dict(zip(tilted.ROW, map(Fraction, row), strict=True)) | constants | {"l": at}
    )


@pytest.mark.parametrize("row", small_rows(11, 12))
def test_values_of_the_tilted_program_are_those_of_the_determinant_and_the_dual_function(row):
    quartic = interpolated(*matrices(in_units_of_b(row)))
    for at in (Fraction(1, 3), Fraction(-2, 7), Fraction(5)):
        values = found(row, at)
        p, s, t, k0, k1 = (values[name] for name in ("p", "s", "t", "k0", "k1"))
        F = [p * p * s * t * each for each in quartic]
        d = [p * k0, p * k1 + k0, k1 - p * t, -t]
        assert values["F"] == value(F, at)
        assert values["d_l"] == value(d, at)
        assert values["psi"] == value(derivative(F), at) * value(d, at) - value(F, at) * value(derivative(d), at)
        assert values["k0"] + values["B_most"] * (k1 - t * values["B_most"]) <= 0


@pytest.mark.slow
def test_the_tilted_program_decides_rightly_with_any_multiplier():
    draw, seen = random.Random(12), []  # noqa: S311
    for row in small_rows(12, 300):
        for at in (Fraction(draw.randint(-300, 300), 16) or 1, Fraction(draw.randint(-32, 32), 32) or 1):
            values = found(row, at)
            if values["decided"]:
                seen.append(values["exterior"] - values["interior"])
                assert seen[-1] == exact_position(row)
    assert min(seen.count(position) for position in (-1, 0, 1)) > 5


@pytest.mark.parametrize("name", tilted.BOUNDED)
def test_error_bounds_of_the_tilted_program_cover_its_roundings_and_underflow(name):
    counts = tilted.counted()
    allowed = Fraction(tilted.CONSTANTS[f"u_{name}"]) / Fraction(SLACK)
    assert gamma(counts.counts[name], Fraction(U)) + Fraction(U) < allowed
    (step,) = (step for step in tilted.TILTED.steps if step.name == tilted.BOUNDED[name])
    assert step.arguments == (f"u_{name}", counts.magnitudes[name])


def test_rounding_of_the_tilted_error_bounds_is_within_their_slack():
    names = tuple(tilted.BOUNDED.values())
    magnitudes = cut(tilted.TILTED, (*tilted.ROW, "l", *tilted.CONSTANTS), names)
    assert max(relative_error_counts(magnitudes, names, positive=()).counts[name] for name in names) < 100
    assert (1 - Fraction(U)) ** -100 < Fraction(SLACK)
    room = cut(tilted.TILTED, ("minus_F_least", "d_least", "psi", "e_psi", "p", "s_along", "t"), ("room", "width"))
    assert max(relative_error_counts(room, ("room", "width")).counts[name] for name in ("room", "width")) < 4


@pytest.mark.parametrize("row", small_rows(13, 6))
def test_the_tilted_program_decides_nothing_at_the_multiplier_0(row):
    values = found(row, 0)
    assert values["F"] == -values["d_l"] == -values["p"] * values["k"]


def test_the_tilted_program_does_not_overflow_and_its_underflow_is_within_one_unit():
    """Magnitudes at the limits of the range, and what a lost product can do to a value against the least bound."""
    most = {
        name: Fraction(2) ** power for name, power in (("p", 54), ("s", 54), ("t", 54), ("distance", 108), ("l", 60))
    }
    p, s, t, far, at = most.values()
    k = p * s + at * (s * (t + 1) + p * (t + 1) + t * at)
    d, m = (p + at) * k, t * far + (t + 1) * far
    N = at * (t + 1) * (s + p) * far + (p + at) * (s * far + p * far + at * m)
    N_slope = (t + 1) * (s + p) * far + (s * far + p * far + at * m) + (p + at) * m
    psi = d * (N + at * N_slope + d) + at * N * (k + (p + at) * (s * (t + 1) + p * (t + 1) + 2 * t * at))
    assert psi < Fraction(2) ** 530
    assert psi * (p + s * (t + 1) / Fraction(1, 2**54)) < Fraction(2) ** 1000
    least_d = Fraction(2) ** (-54 * 3)
    assert Fraction(2) ** -1021 * Fraction(2) ** (530 + 100) < Fraction(U) * least_d**2
