"""The rows that a domain claims."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hypcheck.errors import InputError
from hypcheck.implementations.description import Description, domain_of
from hypcheck.implementations.domain import Domain, in_regime, representable
from tests.support.pairs import pairs


@given(st.lists(pairs, min_size=1, max_size=10))
def test_in_regime_agrees_with_exact_fractions(some):
    rows = np.array([pair.row for pair in some])
    sizes = [[Fraction(value) for value in pair.row[:4]] for pair in some]
    assert in_regime(rows, "a>=1").tolist() == [alpha >= b for alpha, _, b, _ in sizes]
    assert in_regime(rows, "c2>=a").tolist() == [(g / d) ** 2 >= alpha / b for alpha, g, b, d in sizes]


@pytest.mark.parametrize("ulps", [-1, 0, 1])
def test_in_regime_distinguishes_the_border_of_a_regime_from_the_next_floats(ulps):
    """(γ/d)² = α/b at γ = 3, d = 1, α = 9, b = 1; one ulp of α to either side."""
    row = np.array([[9.0 + ulps * 2.0**-49, 3.0, 1.0, 1.0, 0.0, 0.0, 0.0]])
    assert in_regime(row, "c2>=a").tolist() == [ulps <= 0]


def test_magnitude_range_of_a_domain_includes_its_ends_and_only_semi_axes_must_reach_its_lower_end():
    rows = np.array(
        [
            [1.0, 1.0, 0.5, 1.0, 0.0, 4.0, -1e-9],
            [1.0, 1.0, 0.5, 1.0, 0.0, -4.1, 0.5],
            [1.0, 1.0, 0.4, 1.0, 0.0, 4.0, 0.5],
        ]
    )
    assert Domain(magnitude=(0.5, 4.0)).holds(rows).tolist() == [True, False, False]


LONG_RATIO = [1e6, 1.0, 1e-3, 1.0, 1.0, 0.0, 0.0]
FAR = [1e7, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0]


def test_a_domain_without_ranges_has_default_ranges_except_for_extreme_families():
    rows = np.array([[1.0] * 7, LONG_RATIO, FAR])
    assert Domain().holds(rows).tolist() == [True, False, False]
    assert Domain().holds(rows, extreme=True).all()


def test_a_declared_range_of_a_domain_bounds_extreme_families_too():
    rows = np.array([[1.0] * 7, LONG_RATIO, FAR])
    assert Domain(ratio=(0.5, 1e8)).holds(rows, extreme=True).tolist() == [True, False, True]
    assert Domain(magnitude=(0.1, 1e6)).holds(rows, extreme=True).tolist() == [True, False, False]
    assert Domain(ratio=(1e-8, 1e8), magnitude=(1e-6, 1e6)).holds(rows, extreme=True).tolist() == [True, False, False]
    assert Domain(regimes=("c2>=a",)).holds(rows, extreme=True).tolist() == [True, False, False]


@pytest.mark.parametrize(
    ("value", "precision", "expected"),
    [
        (2.0**-14, "float16", True),
        (2.0**-15, "float16", False),
        (65505.0, "float16", False),
        (1e-40, "float32", False),
        (1e39, "float32", False),
        (1e-40, "float64", True),
        (5e-324, "float64", False),
        (5e-324, "binary128", True),
    ],
)
def test_representable_holds_for_zero_and_normal_numbers_of_the_precision(value, precision, expected):
    row = np.array([[1.0, 1.0, 1.0, 1.0, 0.0, 0.0, value]])
    assert representable(row, precision).tolist() == [expected]


@pytest.mark.parametrize("bad", [{"regimes": ("a>1",)}, {"ratio": (2.0, 1.0)}, {"magnitude": (-1.0, 1.0)}])
def test_domain_refuses_invalid_ranges_and_regimes(bad):
    with pytest.raises(InputError, match="the domain"):
        Domain(**bad)


SIZES = [2.0, 3.0, 0.25, 0.15]


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ([], r"settings is \[\]; it must be a list of mappings with sizes"),
        ("all", "it must be a list of mappings with sizes"),
        ([{"sizes": [1.0, 2.0]}], "it must be four numbers, alpha, gamma, b, d"),
        ([{"sizes": [2.0, 3.0, -0.25, 0.15]}], "sizes: b is -0.25"),
        (
            [{"sizes": SIZES, "z": [1.0, -1.0]}],
            r"z is \[1.0, -1.0\]; it must be two numbers, \[least, greatest\], the least first",
        ),
        ([{"sizes": SIZES, "axis": [1.0, 0.0]}], 'three finite numbers, .*, not all 0, or "free"'),
        ([{"sizes": SIZES, "axis": [0.0, 0.0, 0.0]}], "it must be three finite numbers, .*, not all 0"),
        ([{"sizes": SIZES, "axis": [1.0, 0.0, 1e999]}], "it must be"),
    ],
)
def test_domain_refuses_invalid_settings(settings, message):
    with pytest.raises(InputError, match=message):
        domain_of({"settings": settings})


def test_a_domain_with_an_axis_is_refused_in_a_description_without_tilt():
    domain = domain_of({"settings": [{"sizes": SIZES, "axis": "free"}]})
    assert Description(name="mine", domain=domain, tilt=True).domain is domain
    with pytest.raises(InputError, match='the description must say "tilt": true then'):
        Description(name="mine", domain=domain)
