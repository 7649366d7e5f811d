"""Constants of a specialised kernel: each against its definition, from the sizes as fractions."""

from __future__ import annotations

import math
import random
from fractions import Fraction

import numpy as np
import pytest

from hypcheck.derivation.evaluation import EXACT, evaluate
from hypcheck.derivation.float_arithmetic import FLOAT_FORMATS
from hypcheck.geometry.pair import Position
from hypcheck.scene.model import Region, Span
from tests.support.inside import (
    FORMATS,
    Setting,
    centres,
    exact_constants,
    last_stages,
    line_at,
    position_of_box,
    scaled,
    search,
)

SIZES = [(2.0, 17.8, 0.25, 0.15), (1.0, 4.0, 1.0, 1.0), (0.01, 1e4, 10.0, 0.01), (3.0, 1.0, 2.0**60, 1.0)]
CORNER = (Fraction(40), Fraction(50))


def drawn_sizes(count):
    draw = random.Random(2)  # noqa: S311
    return [tuple(math.exp(draw.gauss(0, 2)) for _ in range(4)) for _ in range(count)]


@pytest.mark.parametrize("sizes", [*SIZES, *drawn_sizes(6)])
def test_coefficients_of_the_discriminant_stage_are_those_of_the_scaled_cubic(sizes):
    form = FLOAT_FORMATS["float64"]
    s, constants = exact_constants(scaled(sizes, form))
    assert math.log2(s).is_integer()
    across, along = ((Fraction(a) / Fraction(b)) ** 2 for a, b in (sizes[:3:2], sizes[1::2]))
    assert Fraction(1, 4) <= s**3 / (across * along) <= 4
    x, z = Fraction(3, 7), Fraction(-11, 5)
    scale = scaled(sizes, form)
    values = {"R": (x * scale.radial) ** 2, "zz": (z * scale.axial) ** 2}
    program = last_stages.program_of("some", ("R", "zz", *constants), last_stages.COEFFICIENTS)
    found = evaluate(program, EXACT, {**values, **constants})
    b, d = Fraction(sizes[2]), Fraction(sizes[3])
    P, Q = (x / b) ** 2, (z / d) ** 2
    c2 = across - along + 1 - P - Q
    c1 = across - along - across * along + along * P - across * Q
    assert (found["c2"], found["c1"], constants["c0"]) == (c2 / s, c1 / s**2, -across * along / s**3)


@pytest.mark.parametrize("precision", FORMATS)
@pytest.mark.parametrize("sizes", SIZES[:2])
def test_constants_of_the_search_stage_are_its_exact_quotients_rounded(sizes, precision):
    form, scale = FLOAT_FORMATS[precision], scaled(sizes, FLOAT_FORMATS[precision])
    found = search(scale, form, CORNER)
    alpha, gamma, b, d = (Fraction(each) for each in sizes)
    A, B, bb, dd = (alpha / b) ** 2, (gamma / d) ** 2, (b * scale.radial) ** 2, (d * scale.axial) ** 2
    wanted = {"A": A, "B": B, "PR": 1 / bb, "QZ": 1 / dd}
    for name, value in wanted.items():
        assert abs(Fraction(found.constants[name]) - value) <= value * form.unit
    for name, square in (("AR", A / bb), ("CZ", B / dd)):
        root = Fraction(found.constants[name])
        assert (root * (1 - 2 * form.unit)) ** 2 < square < (root * (1 + 2 * form.unit)) ** 2
    most = Fraction(2) ** (form.greatest - 2)
    for end, unit, own in ((found.widest, bb, A), (found.highest, dd, B)):
        share = Fraction(end) / unit
        assert Fraction(end) <= most
        assert max(share, share * A, share * B, share * 2**8 / own) <= most
        assert max(Fraction(end), *(2 * share * factor for factor in (1, A, B, Fraction(2**8) / own))) >= most / 2
    for low, pole, steepest in (
        (found.constants["low_a"], A, Fraction(found.highest) / dd / B),
        (found.constants["low_b"], B, Fraction(found.widest) / bb / A),
    ):
        assert 0 < low <= pole * form.unit / 512
        assert low <= 1 / (2 + 2 * steepest)
        assert low >= min(pole * form.unit / 4096, 1 / (4 + 4 * steepest))


def test_the_search_stage_is_refused_if_the_region_or_the_spheroid_is_too_large():
    form = FLOAT_FORMATS["float32"]
    scale = scaled((1.0, 4.0, 1.0, 1.0), form)
    far = Fraction(2) ** 63
    search(scale, form, (Fraction(10), Fraction(10)))
    for corner in ((far, Fraction(1)), (Fraction(1), far)):
        with pytest.raises(OverflowError, match="products of the lengths in the region leave float32"):
            search(scale, form, corner)
    with pytest.raises(OverflowError, match="so much larger than the hyperboloid"):
        search(scaled((2.0**-60, 4.0, 1.0, 1.0), form), form, CORNER)


@pytest.mark.parametrize("sizes", SIZES[:3])
def test_each_line_of_a_scene_is_tangent_to_the_border_between_two_positions(sizes):
    """It proves the rows a little beyond it, and at its point of tangency the position changes."""
    form = FLOAT_FORMATS["float64"]
    scale = scaled(sizes, form)
    for share in (Fraction(1, 64), Fraction(1, 3)):
        for pole, side in ((-scale.A, Position.INTERIOR), (scale.B, Position.EXTERIOR)):
            line = line_at(pole * share, scale, form, 1)
            if line is None or "intercept_1" not in line.constants:
                continue
            at = pole * share
            assert line.side is side
            expected = scale.bb * (scale.A + at) * (1 + 1 / at)
            slope = scale.bb / scale.dd * (scale.A + at) / (scale.B - at)
            for name, value in (("intercept_1", expected), ("slope_1", slope)):
                off = (Fraction(line.constants[name]) / value - 1) * side
                assert 15 * form.unit < off < 20 * form.unit


@pytest.mark.parametrize("sizes", SIZES[:3])
def test_centres_for_stage_shares_fill_the_box_evenly_and_an_open_box_around_the_surface(sizes):
    alpha, gamma, b, d = sizes
    x, y, z = centres(Setting(sizes, Region(None, Span(-3.0, 5.0), None), None, ()))
    for values, low, high in (
        (x, -2 * (alpha + b), 2 * (alpha + b)),
        (y, -3.0, 5.0),
        (z, -2 * (gamma + d), 2 * (gamma + d)),
    ):
        assert len(values) == 4096
        counts, _ = np.histogram(values, bins=16, range=(low, high))
        assert counts.sum() == 4096
        assert abs(counts / 256 - 1).max() < 0.05
    for one, other in ((x, y), (y, z), (x, z)):
        counts, _, _ = np.histogram2d(one, other, bins=8)
        assert abs(counts / 64 - 1).max() < 0.35


def test_scaled_uses_powers_of_two_that_bring_the_size_of_the_spheroid_near_1():
    form = FLOAT_FORMATS["float64"]
    usual = scaled((2.0, 17.8, 0.25, 0.15), form)
    assert (usual.radial, usual.axial, usual.bb) == (1, 1, Fraction(1, 16))
    small = scaled((2.0**-300, 17.8, 3 * 2.0**-290, 0.15), form)
    assert math.log2(small.radial).is_integer()
    assert small.axial == 1
    assert Fraction(1, 4) < small.bb < 16
    tall = scaled((2.0, 2.0**300, 0.25, 5.0), form)
    assert tall.radial == 1
    assert Fraction(1, 4) < tall.dd < 100
    assert math.log2(tall.axial).is_integer()
    assert (tall.A, tall.B) == (64, (Fraction(2) ** 300 / 5) ** 2)


def test_position_of_box_measures_a_box_that_contains_the_axis_from_the_axis():
    sizes = (2.0, 17.8, 0.25, 0.15)
    wide = Span(-1.0, 1.0)

    def found(x, y, z):
        return position_of_box(Setting(sizes, Region(x, y, z), None, ()))

    assert found(Span(-1.2, 1.2), Span(-1.2, 1.2), wide) is Position.INTERIOR
    assert found(Span(-1.8, 1.2), Span(-1.2, 1.2), wide) is None
    assert found(Span(2.5, 9.0), None, wide) is Position.EXTERIOR
    assert found(Span(-9.0, 2.0), Span(-9.0, 9.0), wide) is None
    assert found(Span(-9.0, -2.5), Span(-9.0, 9.0), wide) is Position.EXTERIOR
    assert found(Span(2.2, 9.0), None, Span(-90.0, 1.0)) is None
