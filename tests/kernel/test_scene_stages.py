"""Each stage of a plan against exact decisions: its claims are true, and it decides enough to be worth its cost."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import isqrt

import numpy as np
import pytest

from hypcheck.derivation.evaluation import evaluate, outputs
from hypcheck.derivation.float_arithmetic import FLOAT_FORMATS, float_arithmetic
from hypcheck.geometry.pair import Pair, Position
from hypcheck.geometry.rows import FixedSizes
from hypcheck.implementations.domain import representable
from hypcheck.scene.model import Region, Span
from hypcheck.vectors.fixed_sizes import families_for
from tests.support import inside
from tests.support.inside import (
    FORMATS,
    ScaledSetting,
    Setting,
    backward_bound,
    cubic,
    discriminant,
    entry,
    line_at,
    position_of_box,
    scaled,
    search,
    search_begin,
    thresholds,
)

SIZES = [
    (2.0, 17.8, 0.25, 0.15),
    (1.0, 4.0, 1.0, 1.0),
    (0.5, 3.0, 1.0, 1.0),  # a < 1: the intercept of an interior line is negative for small μ
    (3.0, 1.0, 1.0, 1.0),  # c² < a
    (0.01, 1e4, 10.0, 0.01),
]


def rows_for(sizes, count=400):
    return np.concatenate([family.rows(7, count) for family in families_for((FixedSizes(sizes),))])


def at_entry(sizes, form, rows):
    scale = scaled(sizes, form)
    program, constants = entry(scale)
    x, y, z = rows[:, 4:].T
    values = evaluate(program, float_arithmetic(form.name), {"x": x, "y": y, "z": z, **constants})
    return scale, program, constants, values


@pytest.mark.parametrize("precision", FORMATS)
@pytest.mark.parametrize("sizes", SIZES)
def test_a_centre_beyond_a_line_has_the_position_that_the_line_proves(sizes, precision):
    form, rows = FLOAT_FORMATS[precision], rows_for(sizes)
    rows = rows[representable(rows, precision)]
    scale, _, _, values = at_entry(sizes, form, rows)
    told = 0
    truth = inside.positions(rows)
    for share in (Fraction(1, 64), Fraction(1, 3), Fraction(7, 8)):
        for pole in (-scale.A, scale.B):
            line = line_at(pole * share, scale, form, 1)
            if line is None:
                continue
            inputs = {"R": values["R"], "zz": values["zz"], **line.constants}
            (holds,) = outputs(line.program, float_arithmetic(precision), inputs, (line.holds,))
            assert (truth[holds] == line.side).all(), (line.side, line.multiplier)
            told += int(holds.sum())
    assert told > 100


def test_a_line_without_its_margin_is_wrong_at_its_point_of_tangency():
    """Without the margin a line would claim centres that touch: its constants are at the limit."""
    sizes, form = (1.0, 3.0, 1.0, 1.0), FLOAT_FORMATS["float64"]
    scale = scaled(sizes, form)
    line = line_at(Fraction(1), scale, form, 1)  # √A: the tangent of the waist, R > (a + 1)² at Z = 0
    assert line is not None
    assert 4 < line.constants["intercept_1"] <= 4 * (1 + 20 * 2.0**-53)


@pytest.mark.parametrize("multiplier", [0, 64, -64, 10**6])
def test_line_at_refuses_a_multiplier_outside_the_poles(multiplier):
    with pytest.raises(ValueError, match="is not in"):
        line_at(
            Fraction(multiplier), scaled((8.0, 8.0, 1.0, 1.0), FLOAT_FORMATS["float64"]), FLOAT_FORMATS["float64"], 1
        )


@pytest.mark.parametrize("precision", FORMATS)
@pytest.mark.parametrize("sizes", SIZES[:4])
def test_a_computed_discriminant_larger_than_its_bound_has_the_exact_sign(sizes, precision):
    form, rows = FLOAT_FORMATS[precision], rows_for(sizes, 128)
    alpha, gamma, b, d = map(Fraction, sizes)
    corner = (2 * (alpha + b), 2 * (gamma + d))
    rows = rows[(np.abs(rows[:, 4:6]) <= float(corner[0])).all(axis=1) & (np.abs(rows[:, 6]) <= float(corner[1]))]
    scale, first, constants, values = at_entry(sizes, form, rows)
    stage = discriminant(scale, form, first, constants, corner)
    assert stage is not None
    found = evaluate(stage.program, float_arithmetic(precision), {**values, **stage.constants})["delta_3"]
    certain = np.abs(found) > stage.bound
    assert certain.any()
    for row, value in zip(rows[certain][:120].tolist(), found[certain].tolist(), strict=False):
        n = cubic(Pair.from_row(row).lengths)
        h1, h2, h3 = n.n2**2 - 3 * n.n3 * n.n1, n.n2 * n.n1 - 9 * n.n3 * n.n0, n.n1**2 - 3 * n.n2 * n.n0
        assert (4 * h1 * h3 - h2 * h2 > 0) == (value > 0), row


def test_a_plan_leaves_out_a_discriminant_that_overflows_its_float_format():
    sizes, form = (1e6, 1e6, 1e-6, 1e-6), FLOAT_FORMATS["float32"]
    scale = scaled(sizes, form)
    first, constants = entry(scale)
    assert discriminant(scale, form, first, constants, (Fraction(10**6), Fraction(10**6))) is None


@pytest.mark.parametrize("sizes", SIZES[:4])
@pytest.mark.parametrize("height", [0.0, 0.7, 40.0])
def test_thresholds_of_a_stage_separate_the_exact_positions(sizes, height):
    form = FLOAT_FORMATS["float64"]
    found = thresholds(sizes, height, scaled(sizes, form), form)
    radial = float(scaled(sizes, form).radial)

    def position(square):
        return inside.position(Pair(*sizes, square**0.5 / radial, 0.0, height).lengths)

    assert position(found.outer * (1 + 1e-14)) is Position.EXTERIOR
    assert position(found.outer * (1 - 1e-14)) is Position.CONTACT
    if found.inner is None:
        assert position(0.0) is not Position.INTERIOR
    else:
        assert position(found.inner * (1 - 1e-14)) is Position.INTERIOR
        assert position(found.inner * (1 + 1e-14)) is Position.CONTACT


def test_position_of_box_is_a_position_if_the_whole_region_has_it_and_else_none():
    sizes = (2.0, 17.8, 0.25, 0.15)

    def found(x, z):
        return position_of_box(Setting(sizes, Region(x, x, z), None, ()))

    low = Span(-1.0, 1.0)
    assert found(Span(5.0, 9.0), low) is Position.EXTERIOR
    assert found(Span(-0.5, 0.5), None) is Position.INTERIOR
    assert found(Span(0.0, 5.0), low) is None
    assert found(Span(5.0, 9.0), None) is None
    assert found(None, low) is None


@pytest.mark.parametrize("name", FORMATS)
def test_rounded_gives_the_next_number_of_the_float_format_in_the_given_direction(name):
    form = FLOAT_FORMATS[name]
    dtype = np.dtype(name).type
    for value in (Fraction(1, 3), Fraction(-7, 11), Fraction(10) ** 30, Fraction(1, 3 * 2**100)):
        down, up, nearest = (form.rounded(value, way) for way in ("down", "up", "nearest"))
        assert all(float(dtype(each)) == each for each in (down, up, nearest))
        assert down < value < up
        assert float(np.nextafter(dtype(down), dtype(np.inf))) == up
        assert nearest in (down, up)
        assert abs(Fraction(nearest) - value) <= min(value - Fraction(down), Fraction(up) - value)
    assert form.rounded(Fraction(0)) == 0.0
    for beyond in (Fraction(2) ** (form.greatest + 1), Fraction(2) ** (form.least - 1)):
        with pytest.raises(OverflowError, match="is not a normal number"):
            form.rounded(beyond)


def test_the_bound_of_the_search_is_at_most_the_promised_8_u():
    """The tolerance that verify grants unless told otherwise is 8 units."""
    assert backward_bound() == 8


def test_position_of_box_is_none_for_a_region_around_the_axis_that_is_wider_than_the_waist():
    for span in (None, Span(-3.0, 3.0)):
        assert position_of_box(Setting((0.1, 1.0, 0.1, 0.1), Region(span, span, Span(-0.1, 0.1)), None, ())) is None


@pytest.mark.parametrize("precision", FORMATS)
def test_a_line_whose_constants_are_below_the_root_of_the_least_number_is_left_out(precision):
    """A square that underflows would count beside them."""
    form = FLOAT_FORMATS[precision]
    for share, there in ((Fraction(3, 4), False), (Fraction(1, 4), True)):
        steep = ScaledSetting(*[Fraction(1)] * 6)
        steep = replace(steep, B=Fraction(2) ** round(-form.least * share))
        assert (line_at(Fraction(1), steep, form, 1) is not None) == there


def test_the_error_bound_of_the_discriminant_stage_holds_exactly_up_to_the_given_corner():
    form = FLOAT_FORMATS["float64"]
    scale = scaled((3.0, 1.0, 1.0, 1.0), form)
    for x, z in ((3, 5), (Fraction(1, 2), Fraction(1, 4))):
        found = discriminant(scale, form, *entry(scale), (Fraction(x), Fraction(z)))
        assert (found.widest, found.highest) == (2 * x**2, z**2)


def test_a_search_stage_accepts_a_region_up_to_its_limits_and_refuses_a_larger_one():
    form = FLOAT_FORMATS["float64"]
    scale = scaled((2.0, 17.8, 0.25, 0.15), form)
    ends = search(scale, form, (Fraction(1), Fraction(1)))
    across, up = (Fraction(isqrt(int(each))) for each in (ends.widest / 2, ends.highest))
    near, beyond = 1 - Fraction(1, 2**40), 1 + Fraction(1, 2**40)
    assert search(scale, form, (across * near, up * near)) == ends
    for corner in ((across * beyond, Fraction(1)), (Fraction(1), up * beyond)):
        with pytest.raises(OverflowError, match="products of the lengths in the region"):
            search(scale, form, corner)


def test_a_search_begins_so_near_the_pole_that_the_distance_to_it_is_below_the_rounding():
    """Ten bits beyond the format's of the pole, and no farther than the steepest side allows."""
    form = FLOAT_FORMATS["float64"]
    for pole in (Fraction(1), Fraction(2) ** 70):
        assert search_begin(pole, Fraction(0), form) == min(pole / 2 ** (form.bits + 10), Fraction(1, 2))
    assert search_begin(Fraction(2) ** 70, Fraction(7), form) == Fraction(1, 16)
