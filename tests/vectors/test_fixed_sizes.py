"""Names of families for fixed sizes: each names the family that it is the name of, and other texts are refused."""

from __future__ import annotations

import numpy as np
import pytest

from hypcheck.errors import InputError
from hypcheck.geometry.rows import PAIRS, FixedSizes
from hypcheck.vectors.fixed_sizes import families_for, family_at

UPRIGHT_AXIS = (0.0, 0.0, 1.0)
UPRIGHT = FixedSizes((2.0, 3.0, 0.25, 0.15), x=(-1.0, 4.0))
LEANING = FixedSizes((2.0, 3.0, 0.25, 0.15), axis=(1.0, 0.0, 1.0))


@pytest.mark.parametrize("setting", [UPRIGHT, LEANING, FixedSizes((2.0, 3.0, 0.25, 0.15), axis="free")])
def test_a_family_for_fixed_sizes_found_by_its_name_has_the_same_rows_with_these_sizes(setting):
    families = list(families_for((setting,)))
    assert len(families) >= 3
    for family in families:
        rows = family.block(3, 0)[:64]
        assert np.array_equal(rows, family_at(family.name).block(3, 0)[:64])
        assert (rows[:, :4] == setting.sizes).all()
        inside = setting.holds(rows, PAIRS)
        expected = [
            (setting.x is None or setting.x[0] <= row[4] <= setting.x[1])
            and (setting.axis == "free" or tuple(row[7:] or UPRIGHT_AXIS) == (setting.axis or UPRIGHT_AXIS))
            for row in rows.tolist()
        ]
        assert inside.tolist() == expected
        assert inside.any()


NAME = next(iter(families_for((UPRIGHT,)))).name
LEANS = next(iter(families_for((LEANING,)))).name


@pytest.mark.parametrize(
    ("name", "message"),
    [
        (f"other{NAME[NAME.index('@') :]}", "there is no family 'other' for fixed sizes; there are "),
        (f"{LEANS.partition('@')[0]}{NAME[NAME.index('@') :]}", "is not a family of fixed sizes: .* takes an axis"),
        (f"{NAME.partition('@')[0]}{LEANS[LEANS.index('@') :]}", "is not a family of fixed sizes: .* takes no axis"),
        (NAME.replace("@2.0", "@-2.0"), "is not a family of fixed sizes: alpha is -2"),
        (NAME.replace("-1.0:4.0", "4.0:-1.0"), "is not a family of fixed sizes"),
        (NAME.replace("-1.0:4.0", "-1.0"), "is not a family of fixed sizes"),
        (LEANS.replace("1.0:0.0:1.0", "0.0:0.0:0.0"), "is not a family of fixed sizes"),
        (LEANS.replace("1.0:0.0:1.0", "inf:0.0:1.0"), "is not a family of fixed sizes"),
    ],
)
def test_invalid_name_of_a_family_for_fixed_sizes_is_refused(name, message):
    assert name not in (NAME, LEANS)
    with pytest.raises(InputError, match=message):
        family_at(name)


@pytest.mark.parametrize("axis", [None, (1.0, 0.0, 1.0)])
def test_a_family_for_fixed_sizes_whose_wall_is_beyond_float64_has_finite_rows(axis):
    """At the height 1 the wall is 1e310 from the axis: a centre there is inside at every float."""
    setting = FixedSizes((1e300, 1e-10, 1.0, 1.0), axis=axis)
    for family in families_for((setting,)):
        rows = family.block(3, 0)[:64]
        assert np.isfinite(rows).all()
        assert setting.holds(rows, PAIRS).all()


def test_families_for_fixed_sizes_refuse_sizes_that_leave_no_room_in_float64():
    with pytest.raises(InputError, match="leave no room in float64 for the centres about them"):
        list(families_for((FixedSizes((1e308, 1e308, 1e308, 1e308)),)))
