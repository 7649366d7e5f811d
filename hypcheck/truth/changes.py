"""Relative changes of a pair's ten numbers: whether a change up to a given size makes a wrong answer right.

Positions are monotone in the four sizes (a larger spheroid contains the smaller one; {h > 0} grows when α falls or γ
grows), so that among their changes one corner of the box of changes is best. For an upright pair the same holds of the
centre: the exterior positions are an up-set (a pair stays exterior when α falls, γ grows, b or d falls, |x| or |y|
grows, |z| falls), the interior ones likewise with α, γ, x, y, z the other way round (docs/mathematics.md, "Monotone in
every input"). So one exact decision at one corner is enough. A sphere is an upright pair: its b and d have the same
change.

For any other pair positions are not monotone in centre and axis:

- a change is proved to be enough by a corner of the box of changes at which an exact decision finds the answer right;
- a size of change is proved not to be enough by certificates for the whole box (box_certificate.py), with the sizes at
  their best corner.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import ClassVar

from hypcheck.geometry.arithmetic import fraction, rounded
from hypcheck.geometry.pair import COLUMNS, SIZES, Lengths, Pair, Position
from hypcheck.truth import exact
from hypcheck.truth.box_proofs import Goal, Margin, Signs

Row = tuple[Fraction, ...]

CUTS = 3
"""How often a box may be cut along any line from the whole to its smallest part, where one certificate fails."""


BITS = 12
"""Changes are cut to so many bits: float64 holds them, where they are not too small for that."""


def goal_of(truth: Position, answer: Position) -> Goal:
    """Return the goal that makes a wrong answer right; for "contact" it is enough to leave the clear position."""
    return Goal(truth, leave=True) if answer is Position.CONTACT else Goal(answer, leave=False)


def corner(lengths: Lengths, change: Fraction, toward: Position) -> Lengths:
    """Return the corner of the box of changes up to `change` that is nearest to `toward`; farthest if `change` < 0.

    The pair is upright; |change| < 1; `toward` is EXTERIOR or INTERIOR. Lengths are scaled by the denominator of
    `change`, which does not change the ratios.
    """
    grown, shrunk = change.denominator + change.numerator, change.denominator - change.numerator
    wide, tall = (shrunk, grown) if toward is Position.EXTERIOR else (grown, shrunk)
    return Lengths(
        alpha=lengths.alpha * wide,
        b=lengths.b * shrunk,
        x=lengths.x * tall,
        y=lengths.y * tall,
        gamma=lengths.gamma * tall,
        d=lengths.d * shrunk,
        z=lengths.z * wide,
    )


@dataclass(frozen=True, slots=True)
class Flip:
    """A pair, and the goal of its change.

    `sharp` flips decide every change: what is not reached is excluded.
    """

    pair: Pair
    goal: Goal
    sharp: ClassVar[bool] = False

    @property
    def row(self) -> Row:
        """The pair's ten numbers."""
        return tuple(map(Fraction, (*self.pair.row[: len(COLUMNS)], *self.pair.axis)))

    def reached(self, change: Fraction) -> bool:
        """Decide whether a corner of the box of changes up to `change` (< 1) is found that attains the goal."""
        return self._attained(change, self._signs(change))

    def excluded(self, change: Fraction, cuts: int = CUTS) -> bool:
        """Decide whether certificates are found that no change up to `change` (< 1) attains the goal."""
        from hypcheck.truth.box_certificate import certified  # noqa: PLC0415 - loads mpmath

        box = [(number - abs(number) * change, number + abs(number) * change) for number in self.row[len(SIZES) :]]
        return certified(self._sizes(change), box, self.goal, cuts)

    def reached_above(self, low: Fraction, ratio: Fraction) -> Fraction:
        """Return a reached change above `low`, nearly the least one; 1 if none is found."""
        high = rounded(low * Fraction(17, 16), BITS)
        patterns = tuple(self._pointed(high))
        while high < 1 and not self._attained(high, patterns):
            high = rounded(high * Fraction(9, 8), BITS)
        high, change = min(high, Fraction(1)), rounded(low * ratio, BITS)
        while change < high and not self._attained(change, _PATTERNS):
            change = rounded(change * ratio, BITS)
        return min(high, change)

    def estimate(self) -> Fraction:
        """Return the change that is enough by the derivatives at the row, an estimate in (0, 1/2]."""
        margin = self._margin(self.row[: len(SIZES)], self.row[len(SIZES) :])
        value = abs(fraction(margin.value()))
        derivatives = (*margin.derivatives(), *margin.size_derivatives())
        factors = (*self.row[len(SIZES) :], *[Fraction(1)] * len(SIZES))
        rate = sum((abs(a * fraction(b)) for a, b in zip(factors, derivatives, strict=True)), Fraction(0))
        estimate = value / rate if rate else Fraction(1)
        return min(estimate, Fraction(1, 2)) if estimate else Fraction(1, 1 << 10_000)

    def _margin(self, sizes: Row, rest: Row) -> Margin:
        """Return the margin on the goal's side for these sizes, centre and axis."""
        from hypcheck.truth.box_certificate import margin_at  # noqa: PLC0415 - loads mpmath

        return margin_at(sizes, rest, self.goal)

    def _sizes(self, change: Fraction) -> Row:
        """Return the sizes at their best corner."""
        return _moved(self.row[: len(SIZES)], self.goal.sizes, change)

    def _attained(self, change: Fraction, patterns: Iterable[Signs]) -> bool:
        """Decide whether a corner of these signs of centre and axis attains the goal, by exact decisions."""
        sizes, rest = self._sizes(change), self.row[len(SIZES) :]
        corners = (Lengths.of((*sizes, *_moved(rest, signs, change))) for signs in patterns)
        return any(self._is_attained_at(lengths) for lengths in corners)

    def _is_attained_at(self, lengths: Lengths) -> bool:
        """Decide exactly whether a pair attains the goal."""
        return (exact.position(lengths) is self.goal.side) is not self.goal.leave

    def _signs(self, change: Fraction) -> Iterator[Signs]:
        """Yield signs of changes of centre and axis: first the signs of derivatives, then all others."""
        tried = set()
        for pattern in itertools.chain(self._pointed(change), _PATTERNS):
            signs = tuple(sign if number else 0 for sign, number in zip(pattern, self.row[len(SIZES) :], strict=True))
            if signs not in tried:
                tried.add(signs)
                yield signs

    def _pointed(self, change: Fraction) -> Iterator[Signs]:
        """Yield the signs of the derivatives of φ at the row, then at the corner that these signs give."""
        signs: Signs = (0,) * 6
        for _ in range(2):
            margin = self._margin(self._sizes(change), _moved(self.row[len(SIZES) :], signs, change))
            signs = tuple(self.goal.sign * (1 if slope > 0 else -1) for slope in margin.derivatives())
            yield signs


class UprightFlip(Flip):
    """The flip of an upright pair: one exact decision about one corner decides a change."""

    __slots__ = ()
    sharp: ClassVar[bool] = True

    def reached(self, change: Fraction) -> bool:
        """Decide whether the best corner of the box of changes up to `change` (< 1) attains the goal."""
        # "Equals contact" is not monotone (a corner can pass right through), "is no longer the truth" is. From exterior
        # the corner opposite to the exterior one has α, b, d and z grown, γ, x and y shrunk.
        best = corner(_lengths(self.pair), -change if self.goal.leave else change, self.goal.side)
        return self._is_attained_at(best)

    def excluded(self, change: Fraction, cuts: int = CUTS) -> bool:  # noqa: ARG002 - as Flip has it
        """Decide whether no change up to `change` (< 1) attains the goal."""
        return not self.reached(change)


@lru_cache(64)
def _lengths(pair: Pair) -> Lengths:
    """Return the lengths of a pair, cached: several questions about the same pair follow each other."""
    return pair.lengths


_PATTERNS = tuple(itertools.product((1, -1), repeat=6))


def _moved(numbers: Row, signs: Signs, change: Fraction) -> Row:
    """Change each number by the relative sign · change."""
    return tuple(number * (1 + sign * change) for number, sign in zip(numbers, signs, strict=True))
