"""What reasons of gaps in emitted code say of numbers holds for every setting that they are about."""

from __future__ import annotations

from fractions import Fraction
from functools import cache

import numpy as np
import pytest

from hypcheck.geometry.pair import Position
from hypcheck.scene.model import FREE
from tests.support.inside import ONE_SIDED, plan_of, scaled, whole_plan
from tests.tools.evidence.emitted_kernels import _scenes, _whole_scenes

UPRIGHT = {name: (scene, precision) for name, scene, precision in _scenes()}
WHOLE = dict(_whole_scenes())
LINES_FIRST = [name for name in UPRIGHT if name.startswith(("forest", "tower"))]
LINES_FIRST += ["whole, parts", "whole, exterior, everywhere"]


@cache
def plan_named(name):
    """The plan of a scene, made when a test first asks for it."""
    return plan_of(*UPRIGHT[name]) if name in UPRIGHT else whole_plan(WHOLE[name])


def line_of(stages, side):
    """The intercept and the slope of the first line of a side in P and Q, as real numbers."""
    line = next(line for line in stages.lines if line.side is side)
    of, where = scaled(stages.setting.sizes, plan_named("tower float64").format), line.multiplier
    return (of.A + where) * (1 + 1 / where), (of.A + where) / (of.B - where)


@pytest.mark.parametrize("name", LINES_FIRST)
def test_every_centre_whose_maximum_is_nearer_to_a_pole_is_beyond_a_line(name):
    """In P and Q, 2⁻¹⁸ apart at least: more than the roundings of float32 and the lines' own margin together."""
    plan, slack = plan_named(name), 1 + Fraction(1, 2**18)
    asked = [stages for stages in plan.settings if stages.searches]
    assert asked
    for stages in asked:
        of = scaled(stages.setting.sizes, plan.format)
        if plan.question != "interior":
            intercept, slope = line_of(stages, Position.EXTERIOR)
            half = (of.A + of.B / 2) ** 2 / of.A
            assert half > intercept * slack
            assert half * 4 / of.B > slope * slack
        if plan.question != "exterior":
            intercept, slope = line_of(stages, Position.INTERIOR)
            assert of.A / 4 * slack < intercept
            assert of.A / 4 * of.B / (of.B + of.A / 2) ** 2 * slack < slope
        assert plan.question not in ONE_SIDED or stages.centre


@pytest.mark.parametrize(
    "name",
    [
        "a hill",
        "two trees, any axis",
        "two trees, one axis",
        "whole, contact",
        "whole, parts",
        "whole, exterior, everywhere",
    ],
)
def test_within_a_modelled_height_the_line_for_exterior_begins_before_the_box_of_the_discriminant_ends(name):
    cut = [stages for stages in plan_named(name).settings if stages.setting.cut is not None]
    assert cut
    for stages in cut:
        (line,) = (line for line in stages.lines if line.side is Position.EXTERIOR)
        (intercept,) = (value for key, value in line.constants.items() if key.startswith("intercept"))
        (slope,) = (value for key, value in line.constants.items() if key.startswith("slope"))
        tallest = max(abs(stages.setting.cut.low), abs(stages.setting.cut.high)) ** 2
        assert intercept + slope * tallest < stages.discriminant.widest
        rounded_down = 1 + 2.0**-50
        highest = stages.discriminant.highest * rounded_down
        assert tallest <= highest or name == "a hill"  # whose zz is seen on both sides


def enclosed(discriminant, R, zz):
    """Enclosures of what float64 may compute for three times the discriminant: rounding to nearest keeps the order."""
    values = {name: (value, value) for name, value in discriminant.constants.items()} | {"R": R, "zz": zz}
    for step in discriminant.program.steps:
        (low, high), (least, most) = (
            values[name] if isinstance(name, str) else (name, name) for name in step.arguments
        )
        if step.operation == "mul":
            products = np.broadcast_arrays(low * least, low * most, high * least, high * most)
            values[step.name] = np.min(products, axis=0), np.max(products, axis=0)
        else:
            more = {"add": (least, most), "sub": (-most, -least)}[step.operation]
            values[step.name] = low + more[0], high + more[1]
    return values["delta_3"]


def cells(marks):
    """The intervals between these numbers, as their lower and their upper ends."""
    return marks[:-1], marks[1:]


def test_between_the_surface_and_the_line_the_discriminant_of_the_first_oak_is_not_above_its_bound():
    stages = plan_named("forest float64").settings[0]
    discriminant, (line,) = stages.discriminant, stages.lines
    most = []
    for low, high in zip(*cells(np.linspace(0, discriminant.highest, 33)), strict=True):
        border = line.constants["intercept_1"] + line.constants["slope_1"] * high
        assert border < discriminant.widest
        marks = np.linspace(stages.centre["waist"], border * (1 + 2.0**-50), 20_000)
        most.append(enclosed(discriminant, cells(marks), (low, high))[1].max())
    assert 0 < max(most) <= discriminant.bound


def test_the_discriminant_of_a_birch_is_nowhere_below_its_bound():
    """Of this one the many at once are asked beyond the line too, up to the corner of the box."""
    discriminant = plan_named("forest float64").settings[14].discriminant
    marks = np.concatenate([np.linspace(0, 1, 20_000), np.geomspace(1, discriminant.widest, 200_000)[1:]])
    heights = zip(*cells(np.linspace(0, discriminant.highest, 9)), strict=True)
    least = min(enclosed(discriminant, cells(marks), height)[0].min() for height in heights)
    assert -discriminant.bound <= least < 0


def test_the_larger_term_of_a_frame_has_the_same_sign_at_every_axis_of_the_scenes_for_any_axis():
    plans = [plan_named(name) for name in (*UPRIGHT, *WHOLE)]
    free = [stages.setting.sizes for plan in plans if plan.axis == FREE for stages in plan.settings]
    assert len(free) == 4
    for alpha, gamma, b, d in free:
        p, s, t = ((each / b) ** 2 for each in (alpha, gamma, d))
        assert s * min(t, 1) > 1.01 * p * max(t, 1)
