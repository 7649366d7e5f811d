"""Causes of wrong answers in code that computes the roots of g: wrong decisions from roots, and the roundings of roots.

The signs of some patterns of roots suggest a wrong position (docs/mathematics.md, "Root patterns and relative
position"): a complex pair beside a positive root, a double root beyond a pole, a root exactly at a pole. These patterns
are decided in integers. Rounding errors of the roots limit what code can decide: on which side of a pole a root lies,
and whether two roots are a complex pair. These errors have a bound. A tolerance in the code, which is inferred from the
answers, limits it too.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import Position
from hypcheck.geometry.rows import Floats, Mask
from hypcheck.runs import causes
from hypcheck.truth.kinds import Kind

CONTRADICTED = 0.02
"""A tolerance is read from the answers only where this share of the answers within it, at most, contradicts it."""

LARGEST_TOLERANCE = 1e-2
"""A larger distance between roots is no tolerance."""


def _complex_pair_ignored(answered: causes.AnsweredRows) -> causes.Answers:
    """A complex pair is ignored, and the one real root, which is positive, decides as if all roots were positive.

    A double root, or two roots close together, may be computed as a complex pair.
    """
    n = answered.numbers
    with np.errstate(all="ignore"):
        error = n.delta_error(causes.FLOAT64, roots=True)
        pair, close = n.delta < -error, np.abs(n.delta) <= error
    exterior = answered.answers_at(np.full(len(answered.rows), Position.EXTERIOR, dtype=np.int8))
    return np.where(pair | (close & (answered.given == exterior)), exterior, causes.SILENT).astype(np.int8)


_BEYOND = {
    Kind.CROSSING_THROAT_NODE: Position.INTERIOR,
    Kind.CROSSING_GROOVE_NODE: Position.EXTERIOR,
    Kind.CROSSING_GROOVE_CUSP: Position.EXTERIOR,
    Kind.CROSSING_GROOVE_ISOLATED_POINT: Position.EXTERIOR,
}
"""Contacts with a double root beyond a pole, and what the signs of the roots alone say."""


def _repeated_beyond_a_pole(answered: causes.AnsweredRows) -> causes.Answers:
    """A double root below −A or above B counts as two roots on the side of its sign."""
    at = (answered.truth == Position.CONTACT) & answered.numbers.possible(2.0**-50, printed=True)[:, (0, 2)].any(axis=1)
    answers = causes.silent(answered)
    for kind, position in _BEYOND.items():
        answers = np.minimum(answers, causes.where_kind(at, answered, kind, position))
    return answers


def _at_upper_pole(answered: causes.AnsweredRows) -> causes.Answers:
    """If z = 0, B is a root: the open interval (0, B) does not contain it, so the code counts only one root.

    Rows beside the ring are left out, because there a root close to B is another cause.
    """
    at = (answered.truth == Position.EXTERIOR) & (answered.rows[:, 6] == 0)
    return _contact(answered, at & ~answered.numbers.near_the_ring(2.0**-12))


def _at_lower_pole(answered: causes.AnsweredRows) -> causes.Answers:
    """If x = y = 0, −A is a root: the open interval (−A, 0) does not contain it, so the code counts only one root."""
    at = (answered.truth == Position.INTERIOR) & (answered.rows[:, 4:6] == 0).all(axis=1)
    return _contact(answered, at)


def _contact(answered: causes.AnsweredRows, at: Mask) -> causes.Answers:
    positions = causes.silent(answered)
    positions[at] = Position.CONTACT
    return answered.answers_at(positions)


def _computed_roots(answered: causes.AnsweredRows) -> causes.Answers:
    """The given answers that rounding errors of computed roots can produce."""
    return causes.rounded(answered, max(causes.unit_of(answered), causes.FLOAT64), roots=True)


def _roots(n: causes.Numbers) -> NDArray[np.complex128]:
    """The three roots of g (n, 3) in float64, sorted by their real parts; NaN where g overflows."""
    c2, c1, c0 = n.c2, n.c1, -n.A * n.B
    with np.errstate(all="ignore"):
        finite = np.isfinite(c2) & np.isfinite(c1) & np.isfinite(c0)
    zeros = np.full((len(c2), 3), complex(np.nan, np.nan))
    companions = np.zeros((int(finite.sum()), 3, 3))
    companions[:, 0] = -np.column_stack([c2, c1, c0])[finite]
    companions[:, 1, 0] = companions[:, 2, 1] = 1
    if len(companions):
        zeros[finite] = np.sort_complex(np.linalg.eigvals(companions))
    return zeros


def _within(answered: causes.AnsweredRows, sizes: Floats, answers: causes.Answers) -> causes.Answers:
    """The answers where a size is within the code's tolerance, which is the largest size with such an answer."""
    with np.errstate(invalid="ignore"):
        candidates = (answers != causes.SILENT) & (sizes <= LARGEST_TOLERANCE)
    agree = candidates & (answers == answered.given)
    if not agree.any():
        return np.full(len(sizes), causes.SILENT, dtype=np.int8)
    inside = candidates & (sizes <= sizes[agree].max())
    if (inside & ~agree).sum() > CONTRADICTED * agree.sum():
        return np.full(len(sizes), causes.SILENT, dtype=np.int8)
    return np.where(inside, answers, causes.SILENT).astype(np.int8)


def _imaginary_part(answered: causes.AnsweredRows) -> causes.Answers:
    """A complex pair with a small imaginary part is taken for two real roots on the side of their real part."""
    roots = _roots(answered.numbers)
    apart = np.abs(roots.imag).max(axis=1)
    pair = np.take_along_axis(roots, np.abs(roots.imag).argmax(axis=1)[:, None], axis=1)[:, 0].real
    positions = np.where(pair > 0, Position.EXTERIOR, Position.INTERIOR).astype(np.int8)
    at = (answered.truth == Position.CONTACT) & (apart > 0)
    return _of_either_size(
        answered, apart, pair, np.where(at, answered.answers_at(positions), causes.SILENT).astype(np.int8)
    )


def _separation(answered: causes.AnsweredRows) -> causes.Answers:
    """Two real roots that are close together are taken for one double root."""
    roots = _roots(answered.numbers)
    gaps = np.abs(np.diff(roots, axis=1))
    nearest = gaps.argmin(axis=1)[:, None]
    gap = np.take_along_axis(gaps, nearest, axis=1)[:, 0]
    place = np.take_along_axis(roots, nearest, axis=1)[:, 0].real
    return _of_either_size(answered, gap, place, _contact(answered, answered.truth != Position.CONTACT))


def _of_either_size(
    answered: causes.AnsweredRows, sizes: Floats, roots: Floats, answers: causes.Answers
) -> causes.Answers:
    """The answers for an absolute tolerance or for one relative to the root, whichever explains more."""
    with np.errstate(all="ignore"):
        either = [_within(answered, some, answers) for some in (sizes, sizes / np.abs(roots))]
    return max(either, key=lambda some: int((some == answered.given).sum()))


ROOT_CAUSES: tuple[causes.Cause, ...] = (
    causes.cause("complex-pair-ignored", _complex_pair_ignored, causes.Scope.PLACE),
    causes.cause("repeated-root-beyond-a-pole", _repeated_beyond_a_pole, causes.Scope.PLACE),
    causes.cause("root-at-upper-pole", _at_upper_pole, causes.Scope.PLACE, slack=4),
    causes.cause("root-at-lower-pole", _at_lower_pole, causes.Scope.PLACE, slack=4),
    causes.cause("computed-roots", _computed_roots, causes.Scope.ROUNDING),
    causes.cause("imaginary-part-tolerance", _imaginary_part, causes.Scope.ROUNDING),
    causes.cause("root-separation-tolerance", _separation, causes.Scope.ROUNDING),
)
"""The causes of code that computes roots, those in exact arithmetic first."""
