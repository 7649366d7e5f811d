"""The stage that decides tilted rows in floats: what its program is, and that its bounds hold."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest

from hypcheck.derivation.evaluation import EXACT, evaluate
from hypcheck.derivation.program import cut
from hypcheck.derivation.rounding import gamma, relative_error_counts
from tests.kernel.test_tilted_integers import small_rows
from tests.support.inside import CONSTANTS, SLACK, TILTED, U, tilted
from tests.support.tilted_fractions import derivative, exact_position, interpolated, matrices, value

EXACTLY = {name: Fraction(each) for name, each in CONSTANTS.items()}


def in_units_of_b(row):
    b = Fraction(row[2])
    return [*(Fraction(each) / b for each in row[:7]), *map(Fraction, row[7:])]


def found(row, at, constants=EXACTLY):
    return evaluate(TILTED, EXACT, dict(zip(tilted.ROW, map(Fraction, row), strict=True)) | constants | {"l": at})


@pytest.mark.parametrize("row", small_rows(11, 12))
def test_values_of_the_tilted_program_are_multiples_of_the_determinant_and_of_the_dual_function(row):
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
    allowed = Fraction(CONSTANTS[f"u_{name}"]) / Fraction(SLACK)
    assert gamma(counts.counts[name], Fraction(U)) + Fraction(U) < allowed
    (step,) = (step for step in TILTED.steps if step.name == tilted.BOUNDED[name])
    assert step.arguments == (f"u_{name}", counts.magnitudes[name])


def test_rounding_of_the_tilted_error_bounds_is_within_their_slack():
    names = tuple(tilted.BOUNDED.values())
    magnitudes = cut(TILTED, (*tilted.ROW, "l", *CONSTANTS), names)
    assert max(relative_error_counts(magnitudes, names, positive=()).counts[name] for name in names) < 100
    assert (1 - Fraction(U)) ** -100 < Fraction(SLACK)
    room = cut(TILTED, ("minus_F_least", "d_least", "psi", "e_psi", "p", "s_along", "t"), ("room", "width"))
    assert max(relative_error_counts(room, ("room", "width")).counts[name] for name in ("room", "width")) < 4


@pytest.mark.parametrize("row", small_rows(13, 6))
def test_the_tilted_program_decides_nothing_at_the_multiplier_0(row):
    values = found(row, 0)
    assert values["F"] == -values["d_l"] == -values["p"] * values["k"]
