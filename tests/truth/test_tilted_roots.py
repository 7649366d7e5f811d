"""The roots oracle for tilted spheroids: its table is complete, and its answers are those of the matrices."""

from __future__ import annotations

import itertools
from fractions import Fraction

import pytest
import sympy

from hypcheck.geometry.pair import Pair, Position
from hypcheck.paper.ledger.checks import sides_by_signs
from hypcheck.truth import roots
from hypcheck.truth.roots import MEANING, SIDES, classify_by_roots, word_of
from hypcheck.vectors import frozen
from tests.support.tilted_fractions import interpolated, matrices, value
from tests.tools.oracle_agreement import rows
from tests.truth.tilted_cases import SYMMETRIC

X = sympy.Symbol("x")
EXTERIOR, CONTACT, INTERIOR = Position.EXTERIOR, Position.CONTACT, Position.INTERIOR


def test_the_table_lists_every_pattern_that_the_signs_allow_once_and_no_other():
    listed = [word for words in SIDES.values() for word in words]
    assert len(set(listed)) == len(listed)
    assert set(listed) == set(map(word_of, sides_by_signs(0, 1, 2, 3))) == set(MEANING)


def test_the_quartic_is_the_determinant_of_the_pencil():
    for _, row in rows(["uniform", "grid"], 10, seed=2):
        pair = Pair.from_row(row)
        if pair.is_upright:
            continue
        ours, lengths = roots.characteristic(pair.lengths), pair.lengths
        # The oracle counts λ in units of α² γ²/(b² d² v·v).
        square = sum(each * each for each in lengths.axis)
        unit = Fraction((lengths.alpha * lengths.gamma) ** 2, lengths.b**2 * lengths.d**2 * square)
        theirs = interpolated(*matrices(row))
        for at in (1, -2, 3):
            one, other = value(ours[::-1], at), value(theirs, at * unit)
            assert (one > 0) == (other > 0)


def outward(f, g, side):
    """The word for the roots of f on one side of 0, beside the root of g next to 0 there, by sympy's isolation."""
    f, g = (sympy.Poly([sympy.Rational(*number.as_integer_ratio()) for number in h], X) for h in (f, g))
    if side < 0:
        f, g = f.compose(sympy.Poly(-X)), g.compose(sympy.Poly(-X))

    def holds_root(h, low, high):
        """Of a closed interval that is a point, or of an open one."""
        return h.count_roots(low, high) > len({end for end in (low, high) if low != high and h.eval(end) == 0})

    places, place = [], "(0,R)"
    for between in (f * g).sqf_part().intervals(inf=0, sqf=True):
        at_end = place == "(0,R)" and holds_root(g, *between)
        places += [("R" if at_end else place, times) for h, times in f.sqf_list()[1] if holds_root(h, *between)]
        place = ">R" if at_end else place
    return word_of(places)


@pytest.mark.parametrize("family", ["uniform", "twins", "ring", "tangent", "stiff", "slight"])
def test_places_of_roots_of_a_tilted_pair_equal_those_of_interpolated_determinants(family):
    tilted = [case for case in frozen.load(f"tilted-{family}").cases if not Pair.from_row(case.row).is_upright]
    for case in tilted[::110]:
        f, centred = (interpolated(*matrices(row))[::-1] for row in (case.row, [*case.row[:4], 0, 0, 0, *case.row[7:]]))
        # centred = −(1 + λ) det(M + λD)
        g = list(itertools.accumulate(centred[:-1], lambda before, number: number - before))
        report = classify_by_roots(Pair.from_row(case.row))
        assert (report.below, report.above) == (outward(f, g, -1), outward(f, g, 1)), case.id


@pytest.mark.parametrize(("row", "position", "limit_of"), SYMMETRIC)
def test_rings_and_double_tangencies_are_distinguished_by_their_double_root_at_a_pole(row, position, limit_of):
    found = classify_by_roots(Pair.from_row(row))
    assert (found.position, found.tangent) == (position, limit_of is not None)
    side = found.above if EXTERIOR in (position, limit_of) else found.below
    assert side in ("(0,R) R²", "R² >R", "R³", "(0,R) R >R")


def test_tilted_roots_oracle_raises_an_error_for_a_pattern_not_in_its_table(monkeypatch):
    monkeypatch.setattr(roots, "MEANING", {})
    with pytest.raises(AssertionError, match="a pattern that is not possible"):
        classify_by_roots(Pair.from_row([1, 2, 3, 4, 5, 6, 7, 8, 9, 10]))
