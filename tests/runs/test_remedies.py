"""The remedies that a run prints, applied as they are printed to formulas that have the fault.

All is decided in exact rationals, so no rounding hides what a remedy does. Rows are frozen vectors of every regime, the
places of all faults among them, and what the sizes of other places make of these: small whole numbers in all regimes.
"""

from __future__ import annotations

from functools import cache
from itertools import combinations, product

import numpy as np
import pytest

from hypcheck import classify
from hypcheck.geometry.pair import trouble_with_row
from hypcheck.runs.diagnosis import CAUSES
from hypcheck.vectors.frozen import load
from tests.support.remedies import EVERYWHERE, TABLE_2, applied, mended, positions

BY_NAME = {cause.name: cause for cause in CAUSES}
FAMILIES = (
    *("ring", "out-of-regime", "coefficient-zero", "degenerate-crossing", "tangent", "axis", "waist", "osculation"),
    *("regime-borders", "degenerate-neighbourhood", "on-surface", "small-integers", "symmetric-images"),
)


@cache
def rows_of_every_regime():
    """Rows, and their positions."""
    frozen = np.vstack([load(name).rows[::12] for name in FAMILIES])
    sizes, places = (1, 2, 5), (0, 1, 3, 4)
    small = [[a, c, b, 1, x, 0, z] for a, c, b, x, z in product(sizes, sizes, (1, 3), places, places)]
    ring = [[1, 2, 1, 1, 2.5, 0, 0], [7, 7, 1, 1, 10, 0, 0], [2, 0.5, 1, 1, 4, 0, 0]]
    rows = np.vstack([frozen, small, ring]).astype(np.float64)
    return tuple(map(tuple, rows.tolist())), classify(rows)


PRINTED = {
    **TABLE_2,
    "interior": "delta > 0 and ((c2 > 0 and c1 != 0) or (c2 < 0 and c1 < 0))",
}
"""Propositions 3 and 5 as printed."""

PLACES = {
    "ring": {**EVERYWHERE, "exterior_also": "False"},
    "groove": {**EVERYWHERE, "exterior": "delta > 0 and positive"},
    "throat": {**EVERYWHERE, "interior": "delta > 0 and not positive"},
    "zero-coefficient": {
        **EVERYWHERE,
        "interior": f"({EVERYWHERE['interior']}) and c1 != 0 and c2 != 0",
    },
    "complex-pair-ignored": {**EVERYWHERE, "exterior": f"({EVERYWHERE['exterior']}) or delta < 0"},
    "repeated-root-beyond-a-pole": {
        **EVERYWHERE,
        "exterior": f"({EVERYWHERE['exterior']}) or (delta == 0 and positive)",
        "interior": f"({EVERYWHERE['interior']}) or (delta == 0 and not positive)",
    },
    "root-at-upper-pole": {
        **EVERYWHERE,
        "exterior": f"({EVERYWHERE['exterior']}) and z != 0",
        "exterior_also": "False",
    },
    "root-at-lower-pole": {**EVERYWHERE, "interior": f"({EVERYWHERE['interior']}) and not (x == 0 and y == 0)"},
    "imaginary-part-tolerance": {
        **EVERYWHERE,
        **{name: EVERYWHERE[name].replace("delta > 0", "delta > -1") for name in ("exterior", "interior")},
    },
    **{
        cause.name: {
            **EVERYWHERE,
            "exterior": EVERYWHERE["exterior"].replace("delta > 0", "delta >= 0"),
            "interior": "delta >= 0 and not positive and c2 <= 3*A and (3*A - 2*c2)*A + c1 >= 0",
        }
        for cause in CAUSES
        if "tangent" in cause.name
    },
}
"""Formulas that are right but for one fault, by the cause."""


def wrong(formula, every=1):
    """The places of wrong answers to every row, or to every so many-th."""
    rows, truth = rows_of_every_regime()
    return np.flatnonzero(np.array(positions(formula, rows[::every])) != truth[::every])


def false_clear(formula):
    rows, truth = rows_of_every_regime()
    return set(np.flatnonzero((truth == 0) & (np.array(positions(formula, rows)) != 0)).tolist())


def test_coefficient_form_for_all_regimes_is_right_on_all_rows_of_these_tests():
    assert wrong(EVERYWHERE).size == 0
    assert (np.bincount(rows_of_every_regime()[1] + 1) > 50).all()


@pytest.mark.parametrize("name", PLACES)
def test_remedy_of_a_place_leaves_no_wrong_answer_of_a_formula_with_only_that_fault(name):
    assert wrong(PLACES[name]).size > 0
    assert wrong(mended(PLACES[name], [BY_NAME[name]])).size == 0


@pytest.mark.parametrize("name", PLACES)
def test_remedies_of_places_are_right_in_pairs_and_all_together(name):
    own, others = BY_NAME[name], [BY_NAME[other] for other in PLACES if other != name]
    for other in others:
        for pair in ([own, other], [other, own]):
            assert wrong(mended(PLACES[name], pair)).size == 0, other.name
    assert wrong(mended(PLACES[name], [own, *others])).size == 0
    assert wrong(mended(PLACES[name], [*others[::-1], own])).size == 0


@pytest.mark.parametrize("base", [PRINTED, TABLE_2], ids=["printed", "signs alone"])
def test_no_remedy_and_no_pair_of_remedies_adds_a_false_clear_answer(base):
    before = false_clear(base)
    causes = [BY_NAME[name] for name in PLACES]
    for some in [[each] for each in causes] + [list(pair) for pair in combinations(causes, 2)]:
        assert false_clear(mended(base, some)) <= before, [each.name for each in some]


def test_printed_formula_is_right_everywhere_after_the_remedies_of_its_causes():
    causes = [BY_NAME[name] for name in ("ring", "groove", "throat", "zero-coefficient")]
    assert wrong(PRINTED).size > 50
    for some in (causes, causes[::-1]):
        assert wrong(mended(PRINTED, some)).size == 0


def test_remedy_of_the_ring_without_its_condition_on_the_sizes_would_make_false_clear_answers():
    cause = BY_NAME["ring"]
    unsafe = cause.remedy.replace("A < B², ", "")
    assert unsafe != cause.remedy
    assert false_clear(applied(EVERYWHERE, unsafe))
    assert not false_clear(applied(EVERYWHERE, cause.remedy))


FORMULA_ERRORS = {
    cause.name: {**EVERYWHERE, **change}
    for cause, change in (
        (cause, change)
        for cause in CAUSES
        for change in [
            {
                "alpha-gamma": {"columns": "gamma, alpha, b, d, x, y, z"},
                "b-d": {"columns": "alpha, gamma, d, b, x, y, z"},
                "alpha-b": {"columns": "b, gamma, alpha, d, x, y, z"},
                "gamma-d": {"columns": "alpha, d, b, gamma, x, y, z"},
                "x-z": {"columns": "alpha, gamma, b, d, z, y, x"},
                "y-z": {"columns": "alpha, gamma, b, d, x, z, y"},
                "sides-exchanged": {"answers": "-1, 1"},
                "x-ignored": {"P": "y**2/b**2"},
                "y-ignored": {"P": "x**2/b**2"},
                "z-ignored": {"Q": "0*z"},
                "x-for-y": {"P": "(x**2 + x**2)/b**2"},
                "city-block": {"P": "(abs(x) + abs(y))**2/b**2"},
                "chessboard": {"P": "max(abs(x), abs(y))**2/b**2"},
                "z-below": {"Q": "(max(z, 0)/d)**2"},
                "x-below": {"P": "(max(x, 0)**2 + y**2)/b**2"},
                "z-from-the-bottom": {"Q": "((z - gamma)/d)**2"},
                "ball-of-b": {"B": "(gamma/b)**2", "Q": "(z/b)**2"},
                "ball-of-d": {"A": "(alpha/d)**2", "P": "(x**2 + y**2)/d**2"},
                "half-waist": {"A": "(alpha/2/b)**2"},
                "gamma-is-alpha": {"B": "(alpha/d)**2"},
                "A-not-squared": {"A": "alpha/b"},
                "B-not-squared": {"B": "gamma/d"},
                "Q-not-squared": {"Q": "abs(z)/d"},
                "P-not-squared": {"P": "(abs(x) + abs(y))/b"},
                "delta-negative": {"delta": f"-({TABLE_2['delta']})"},
                "decision-c1": {"positive": "c2 < 0 and c1 < 0"},
                "decision-c2": {"positive": "c2 > 0 and c1 > 0"},
                **{
                    name: {
                        "A": f"(alpha/({b}))**2",
                        "P": f"(x**2 + y**2)/({b})**2",
                        "B": f"(gamma/({d}))**2",
                        "Q": f"(z/({d}))**2",
                    }
                    for name, b, d in (
                        ("ball-around", "max(b, d)", "max(b, d)"),
                        ("ball-within", "min(b, d)", "min(b, d)"),
                        ("half-spheroid", "b/2", "d/2"),
                        ("double-spheroid", "2*b", "2*d"),
                    )
                },
            }.get(cause.name)
        ]
        if change is not None
    )
}


def coefficient_errors():
    """A sign turned, or a term left out, of c0, c1, c2 or Δ, as their causes name them."""
    terms = {
        "c0": ("-A*B",),
        "c1": ("-A*B", "+A", "-B", "+B*P", "-A*Q"),
        "c2": ("+A", "-B", "+1", "-P", "-Q"),
        "delta": ("-4*c2**3*c0", "+c2**2*c1**2", "+18*c2*c1*c0", "-4*c1**3", "-27*c0**2"),
    }
    for name, parts in terms.items():
        for place, part in enumerate(parts):
            called = str(place + 1) if name == "delta" else part[1:].replace("*", "")
            for what, other in (("sign", {"+": "-", "-": "+"}[part[0]] + part[1:]), ("without", "+0*A")):
                cause = f"{name}-{what}-{called}"
                if cause in BY_NAME:
                    yield cause, {**EVERYWHERE, name: "".join((*parts[:place], other, *parts[place + 1 :]))}


FORMULA_ERRORS |= dict(coefficient_errors())


@pytest.mark.parametrize("name", FORMULA_ERRORS)
def test_remedy_of_a_formula_error_leaves_no_wrong_answer_of_a_formula_with_that_error(name):
    # Half of the rows: a formula that errs does so in every regime.
    assert wrong(FORMULA_ERRORS[name], 2).size > 0
    assert wrong(applied(FORMULA_ERRORS[name], BY_NAME[name].remedy), 2).size == 0


def test_remedies_of_all_formula_errors_and_places_together_do_no_harm_to_a_right_formula():
    assert wrong(mended(EVERYWHERE, [BY_NAME[name] for name in (*PLACES, *FORMULA_ERRORS)])).size == 0


def test_rows_of_these_tests_are_valid():
    assert all(trouble_with_row(row) is None for row in rows_of_every_regime()[0])
