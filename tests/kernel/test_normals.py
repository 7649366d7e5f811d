"""Unit normals at nearest points, and ties: what hypcheck.clearance says beside the proved distances."""

from __future__ import annotations

import numpy as np
import pytest

import hypcheck

SIZES = (2.0, 17.8, 0.25, 0.15)


def nearest_on_the_wall(alpha, gamma, centre):
    """By the least over a dense curve in the plane of the axis and the centre, and over a denser one about it."""
    near, turn = 0.0, np.arctan2(centre[1], centre[0])
    for width in (12 * gamma, gamma / 100, gamma / 10_000):
        height = near + np.linspace(-width, width, 20_001)
        wall = alpha * np.sqrt(1 + (height / gamma) ** 2)
        place = int(np.hypot(wall - np.hypot(*centre[:2]), height - centre[2]).argmin())
        near = height[place]
    return np.array([wall[place] * np.cos(turn), wall[place] * np.sin(turn), near])


@pytest.mark.parametrize("centre", [(3.0, 4.0, 5.0), (0.5, -0.4, -3.0), (2.9, 0.0, 9.0)])
def test_the_normal_of_a_sphere_points_from_the_nearest_point_to_its_centre(centre):
    near = hypcheck.clearance(2.0, 17.8, 0.25, 0.25, centre)
    way = np.array(centre) - nearest_on_the_wall(2.0, 17.8, centre)
    assert np.abs(near.normal - way / np.linalg.norm(way)).max() < 2e-4


def middle(near):
    return (near.distance_lower + near.distance_upper) / 2


@pytest.mark.parametrize(
    "more",
    [
        {},
        {"axis": (0.3, 0.1, 0.9)},
        {"axis": (1.0, -2.0, 0.0)},
        {"z_min": -4.0, "z_max": 6.0},
        {"z_min": -4.0, "z_max": 6.0, "solid": True, "axis": (0.0, 1.0, 1.0)},
    ],
)
def test_the_normal_is_the_gradient_of_the_distance(more):
    points = np.array([[3.0, 1.0, 2.0], [0.3, 0.2, 1.0], [1.0, 0.5, 9.0], [0.2, 5.0, -5.0]])
    near = hypcheck.clearance((2.0, 4.0, 0.5, 0.3), points, **more)
    assert np.abs(np.linalg.norm(near.normal, axis=1)[~near.contact] - 1).max() < 1e-12
    step, gradient = 1e-3, np.empty((len(points), 3))
    for number, way in enumerate(np.eye(3)):
        there, back = (
            middle(hypcheck.clearance((2.0, 4.0, 0.5, 0.3), points + sign * step * way, **more)) for sign in (1, -1)
        )
        gradient[:, number] = (there - back) / (2 * step)
    clear = ~near.contact
    assert clear.sum() >= 3
    assert np.abs(gradient - near.normal)[clear].max() < 2e-4


ON_AXIS = [
    {"axis": (3.0, 4.0, 0.0)},
    {"axis": (0.3, 0.0, 1.0)},
    {"axis": (-1.0, 1.3, 1.1)},
    {"axis": (0.9, 0.3, 0.003), "z_min": -4.0, "z_max": 30.0},
]
"""Of spheroids about the hyperboloid's axis, where two points of it may be nearest, and multipliers are at a pole."""


@pytest.mark.parametrize("x", [0.0, 1e-13, 1e-9])
@pytest.mark.parametrize("more", ON_AXIS)
@pytest.mark.parametrize(("sizes", "z"), [(SIZES, 5.0), ((0.8, 0.4, 0.13, 0.16), 0.0), ((0.4, 0.45, 0.2, 0.1), -2.0)])
def test_the_distance_along_the_normal_leads_from_the_nearest_point_to_a_spheroid_on_the_axis(sizes, z, more, x):
    alpha, gamma, b, d = sizes
    near = hypcheck.clearance(sizes, (x, 0.0, z), **more)
    height = near.nearest[2] / gamma
    assert abs(np.hypot(*near.nearest[:2]) / alpha - np.hypot(1, height)) < 1e-9
    assert near.distance_upper - near.distance_lower < 1e-8
    unit = np.array(more["axis"]) / np.linalg.norm(more["axis"])
    for place, reach in ((near.nearest + near.distance_upper * near.normal, 1), (near.touch, 1 + near.upper)):
        offset = place - (x, 0.0, z)
        along = offset @ unit
        across = np.linalg.norm(offset - along * unit)
        assert abs(np.hypot(across / b, along / d) - reach) < 1e-7 * reach


@pytest.mark.parametrize("exponent", [-150, -60, -12, 12, 60, 150])
def test_the_distance_from_the_axis_is_bounded_for_sizes_far_apart(exponent):
    near = hypcheck.clearance((1, 2, 10.0**exponent, 1e-3), (0, 0, 0.5), axis=[(1, 2, 3), (0, 1, 0), (1e-150, 0, 1)])
    clear = ~near.contact
    assert clear.any() == (exponent < 0)
    assert (near.distance_lower[clear] <= 1.04).all()
    assert (near.distance_upper[clear] >= 1.0).all()


def test_of_two_mirrored_nearest_points_clearance_reports_the_one_with_positive_x_or_else_positive_z():
    found = hypcheck.clearance((1, 2, 0.1, 0.2), (0, 0, 0), axis=[(3, 4, 0), (-3, 4, 0), (4, -3, 0), (0, 1, 0)])
    assert np.allclose(found.touch, [(0.6, 0.8, 0), (0.6, -0.8, 0), (0.8, -0.6, 0), (0, 1, 0)], atol=1e-6)
    assert np.allclose(found.nearest, found.touch, atol=1e-6)
    assert found.tie.all()


def test_the_nearest_point_of_a_wall_that_ends_is_as_far_away_as_the_reported_distance():
    near = hypcheck.clearance((0.75, 0.4, 0.56, 0.4), (0, 0, 0), z_min=-2.5, z_max=5.4)
    assert abs(near.nearest[2]) < 1e-6
    assert abs(np.linalg.norm(near.nearest) - 0.56 - near.distance_upper) < 1e-12


def test_in_contact_the_distance_is_0_the_normal_is_nan_and_contact_is_true():
    near = hypcheck.clearance(SIZES, [[2.0, 0.0, 0.0], [3.0, 0.0, 0.0], [2.25, 0.0, 0.0]])
    assert near.contact.tolist() == [True, False, True]
    assert near.distance_lower.tolist()[::2] == near.distance_upper.tolist()[::2] == [0.0, 0.0]
    assert np.isnan(near.normal[::2]).all()
    assert not near.tie.any()


TIES = [
    ((0.0, 0.0, 1.0), {}, True),
    ((0.0, 0.0, 0.0), {}, True),
    ((0.5, 0.2, 1.0), {}, False),
    ((0.5, 0.2, 0.0), {}, False),
    ((5.0, 0.0, 0.0), {}, False),
    ((9.0, 0.0, 0.0), {}, True),
    ((0.0, 0.0, 1.0), {"axis": (1.0, 0.0, 0.0)}, True),
    ((0.0, 0.0, 0.0), {"axis": (1.0, 0.0, 2.0)}, True),
    ((0.0, 0.0, 1.0), {"axis": (1.0, 0.0, 2.0)}, False),
    ((0.0, 0.0, 9.0), {"z_max": 5.0}, True),
    ((3.0, 1.0, 9.0), {"z_max": 5.0}, False),
    ((0.0, 0.0, 9.0), {"z_max": 5.0, "solid": True}, False),
    ((3.0, 0.0, 2.0), {"axis": (1.0, 1.0, 0.0)}, False),
    ((3.0, 0.0, 2.0), {"axis": (0.0, 1.0, 1.0)}, False),
]


@pytest.mark.parametrize(("centre", "more", "expected"), TIES)
def test_tie_is_true_if_a_symmetry_gives_a_second_nearest_point(centre, more, expected):
    near = hypcheck.clearance(2, 3, 0.25, 0.5, centre, **more)
    assert near.tie == expected
    assert abs(np.linalg.norm(near.normal) - 1) < 1e-12


def test_a_spheroid_far_out_at_the_waist_has_two_nearest_points_above_and_below():
    """Farther out than α + γ²/α, the radius of the wall's curve at the waist."""
    near = hypcheck.clearance(1.0, 0.5, 0.1, 0.1, [9.0, 0.0, 0.0])
    assert abs(near.nearest[2]) > 1
    assert near.tie
    assert abs(near.nearest[2]) == pytest.approx(abs(nearest_on_the_wall(1.0, 0.5, (9.0, 0.0, 0.0))[2]), abs=1e-3)


def test_clearance_of_a_tilted_spheroid_on_the_axis_reports_one_of_several_nearest_points_and_a_tie():
    near = hypcheck.clearance(2, 3, 0.25, 0.5, [[0.0, 0.0, 1.0], [0.0, 0.0, 0.0]], axis=[[1, 0, 0], [1, 0, 2]])
    x, _, z = near.nearest.T
    assert np.abs(x**2 / 4 + near.nearest[:, 1] ** 2 / 4 - z**2 / 9 - 1).max() < 1e-9
    assert (near.distance_lower <= near.distance_upper).all()
    assert (near.distance_upper - near.distance_lower < 0.2).all()
    points = np.linalg.norm(near.nearest - [[0, 0, 1], [0, 0, 0]], axis=1)
    assert (near.distance_upper > points - 0.5).all()
    assert near.tie.all()


def test_clearance_of_one_pair_gives_numbers_and_of_many_pairs_arrays():
    one = hypcheck.clearance(*SIZES, 3, 4, 0)
    many = hypcheck.clearance(SIZES, [[3, 4, 0]])
    assert isinstance(one.distance_lower, float)
    assert one.position == 1
    assert isinstance(one.position, int)
    assert one.nearest.shape == one.normal.shape == (3,)
    for name in ("position", "distance_lower", "distance_upper", "lower", "upper", "touch_error"):
        assert getattr(many, name).tolist() == [getattr(one, name)]
    assert many.normal.tolist() == [one.normal.tolist()]
    assert many.nearest.shape == many.touch.shape == (1, 3)


def test_the_text_of_a_clearance_shows_the_distance_first():
    said = repr(hypcheck.clearance(*SIZES, 3, 4, 0))
    assert said.index("distance_lower") < said.index("nearest") < said.index(" lower=")


def test_a_tilted_spheroid_whose_squares_overflow_is_reported_in_contact_with_distance_0():
    near = hypcheck.clearance((1, 2, 1e100, 1e180), (0, 0, 0.5), axis=(1, 2, 3))
    assert near.contact
    assert near.distance_upper == 0


@pytest.mark.parametrize("turn", [0, 1])
def test_tie_is_true_for_a_bar_across_a_plane_of_symmetry_with_its_centre_beside_the_axis(turn):
    """Its centre is beside the hyperboloid's axis, on a coordinate axis."""
    centre, axis = ((0.125, 0.0, 0.0), (0.0, 1.0, 0.0)) if turn == 0 else ((0.0, 0.125, 0.0), (1.0, 0.0, 0.0))
    near = hypcheck.clearance(1.0, 2.0, 0.0625, 0.75, centre, axis=axis)
    assert near.position == -1
    assert abs(near.nearest[1 - turn]) > 0.5
    assert near.tie
    assert not hypcheck.clearance(1.0, 2.0, 0.0625, 0.0625, centre).tie


@pytest.mark.parametrize(("b", "d"), [(1.0, 1e-150), (1e-150, 1.0)])
def test_the_normal_of_a_very_thin_disc_or_needle_far_away_points_to_its_centre(b, d):
    near = hypcheck.clearance(3.0, 3.0, b, d, (1e12, 0.0, 0.0))
    assert near.position == 1
    assert near.normal * (1, 1, 0) == pytest.approx((np.hypot(*near.normal[:2]), 0.0, 0.0))
    assert np.linalg.norm(near.normal) == pytest.approx(1.0)


@pytest.mark.parametrize("length", [2.0**700, 2.0**-700])
def test_clearance_does_not_depend_on_the_length_of_the_axis(length):
    one = hypcheck.clearance(2.0, 3.0, 0.25, 0.75, (3.5, 0.25, 1.0), axis=(0.5, 0.25, 0.75))
    other = hypcheck.clearance(
        2.0, 3.0, 0.25, 0.75, (3.5, 0.25, 1.0), axis=(0.5 * length, 0.25 * length, 0.75 * length)
    )
    for name in ("distance_lower", "distance_upper", "nearest", "lower", "upper", "touch", "touch_error"):
        assert np.array_equal(getattr(one, name), getattr(other, name)), name


def test_the_distance_of_a_tiny_spheroid_on_the_axis_is_that_of_its_centre_within_2_to_the_minus_30():
    """Of the wall's points the nearest to (0, 0, 1/2) are at z = 2/5: their squared distance is 1 + 1/25 + 1/100."""
    near = hypcheck.clearance((1.0, 2.0, 1e-80, 1e-85), (0.0, 0.0, 0.5), axis=(0.0, 1.0, 0.0))
    assert 1.05**0.5 - 2.0**-30 < near.distance_lower <= 1.05**0.5 <= near.distance_upper < 1.05**0.5 + 2.0**-34


def test_clearance_with_a_vertical_axis_given_agrees_with_clearance_without_an_axis():
    for centre in ((3.0, 4.0, 1.0), (1.9, 0.0, 0.0)):
        one, other = hypcheck.clearance(*SIZES, *centre), hypcheck.clearance(*SIZES, *centre, axis=(0.0, 0.0, 1.0))
        assert other.position == one.position
        assert max(one.lower, other.lower) <= min(one.upper, other.upper)
        assert max(one.distance_lower, other.distance_lower) <= min(one.distance_upper, other.distance_upper)
