"""Causes limited to some places: regions where a rule errs in exact arithmetic, and rows where rounding decides.

Rules of the paper err on the ring, outside their regimes, and where a coefficient is 0; other rules err at a tangency.
Roundings of a plain evaluation leave a sign open near contact.

Code that computes the roots of g has causes of its own. The signs of some patterns of roots suggest a wrong position
(docs/mathematics.md, "Root patterns and relative position"): a complex pair beside a positive root, a double root
beyond a pole, a root exactly at a pole. These patterns are decided in integers. Rounding errors of the roots limit what
code can decide: on which side of a pole a root lies, and whether two roots are a complex pair. These errors have a
bound. A tolerance in the code, which is inferred from the answers, limits it too.

A = (α/b)², B = (γ/d)², P, Q, c1, c2 and Δ are those of causes.Numbers; −A and B are the poles, a = √A and c = √B. Each
function from AnsweredRows to Answers is a rule: it returns the answers of code with this fault, and SILENT (causes.py)
at rows where the fault has no effect. A docstring that begins with "Answer" says what such code answers.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hypcheck.geometry.pair import COLUMNS, Pair, Position
from hypcheck.geometry.rows import Floats, Mask
from hypcheck.implementations.domain import UNIT_ROUNDOFF
from hypcheck.runs import judge
from hypcheck.runs.causes import (
    SILENT,
    AnsweredRows,
    Answers,
    Cause,
    Numbers,
    Rule,
    Scope,
    cause,
    greatest_of,
    silent,
    where_kind,
)
from hypcheck.truth.kinds import Kind
from hypcheck.truth.pencil import cubic


def _ring(answered: AnsweredRows) -> Answers:
    """Answer as Proposition 3 does on the ring: contact, because Δ = 0."""
    at = (answered.truth == Position.EXTERIOR) & (answered.rows[:, 6] == 0) & answered.numbers.near_the_ring(2.0**-30)
    return where_kind(at, answered, Kind.EXTERIOR_RING, Position.CONTACT)


def _unless_rounded(answered: AnsweredRows, answers: Answers) -> Answers:
    """Return these answers, but SILENT where the given answer is right and may be right by a lucky rounding."""
    luck = answered.numbers.possible(2 * max(unit_of(answered), FLOAT64), printed=True)[:, 1]
    right = answered.given == answered.answers_at(answered.truth)
    return np.where(right & luck, SILENT, answers).astype(np.int8)


def _groove(answered: AnsweredRows) -> Answers:
    """Answer as Proposition 3 does where c² < a: exterior, for three positive roots, though all are at B or beyond."""
    n = answered.numbers
    with np.errstate(all="ignore"):
        at = (answered.truth == Position.CONTACT) & (n.B**2 <= n.A * (1 + 2.0**-40)) & (n.c2 <= 0) & (n.c1 >= 0)
    return _unless_rounded(answered, where_kind(at, answered, Kind.CROSSING_GROOVE_TWO_CURVES, Position.EXTERIOR))


def _throat(answered: AnsweredRows) -> Answers:
    """Answer as Proposition 5 does where a < 1: interior, for two negative roots, though both are at −A or below."""
    at = (answered.truth == Position.CONTACT) & (answered.numbers.A < 1)
    return _unless_rounded(answered, where_kind(at, answered, Kind.CROSSING_THROAT_TWO_CURVES, Position.INTERIOR))


def _zero_coefficient(answered: AnsweredRows) -> Answers:
    """Answer as Proposition 5 does where c1 or c2 is 0: contact instead of interior."""
    n = answered.numbers
    with np.errstate(all="ignore"):
        small = (np.abs(n.c1) <= 2.0**-40 * (1 + n.A * n.B + n.A + n.B + n.B * n.P + n.A * n.Q)) | (
            np.abs(n.c2) <= 2.0**-40 * (1 + n.A + n.B + n.P + n.Q)
        )

    positions = silent(answered)
    for place in np.flatnonzero((answered.truth == Position.INTERIOR) & small).tolist():
        g = cubic(Pair.from_row(answered.rows[place].tolist()).lengths)
        if g.n1 == 0 or g.n2 == 0:
            positions[place] = Position.CONTACT
    return answered.answers_at(positions)


def _coefficients_are_exact(answered: AnsweredRows) -> Mask:
    """Mark the rows where any order of operations computes c1 and c2 without a rounding (_on_a_grid)."""
    n = answered.numbers
    with np.errstate(all="ignore"):
        size = n.A * n.B + n.A + n.B + n.B * n.P + n.A * n.Q
        return _on_a_grid(answered, 16 * (1 + size), 4)


def _delta_is_exact(answered: AnsweredRows) -> Mask:
    """Mark the rows where any form of Δ and any order of operations computes it without a rounding."""
    n = answered.numbers
    with np.errstate(all="ignore"):
        m0, m1, m2 = n.A * n.B, n.A * n.B + n.A + n.B + n.B * n.P + n.A * n.Q, 1 + n.A + n.B + n.P + n.Q
        return _on_a_grid(answered, 128 * (m2**3 * m0 + m2**2 * m1**2 + m1**3 + m0**2), 12)


def _on_a_grid(answered: AnsweredRows, size: Floats, power: int) -> Mask:
    """Mark the rows where the declared precision represents numbers up to this size exactly.

    The numbers are polynomials of degree `power` in the lengths. After a division by powers of two, the lengths are
    multiples of 1, ½, ¼ or 1/64.
    """
    alpha, gamma, b, d, x, y, z = answered.rows[:, : len(COLUMNS)].T
    lengths = np.column_stack([alpha / b, gamma / d, x / b, y / b, z / d])
    halved = (np.frexp(b)[0] == 0.5) & (np.frexp(d)[0] == 0.5)
    exactly = np.zeros(len(answered.rows), dtype=bool)
    for digits in (0, 1, 2, 6):
        on_grid = (np.ldexp(lengths, digits) % 1 == 0).all(axis=1)
        exactly |= halved & on_grid & (np.ldexp(size, power * digits) < 1 / max(unit_of(answered), FLOAT64))
    return exactly


def _tangency(kind: Kind, clear: Position) -> Rule:
    """Return the rule that answers a tangency of this kind with the clear position of which it is the limit."""

    def rule(answered: AnsweredRows) -> Answers:
        at = (answered.truth == Position.CONTACT) & answered.numbers.possible(2.0**-50)[:, 1]
        return where_kind(at, answered, kind, clear)

    return rule


FLOAT64 = 2.0**-53
"""The unit of float64."""


def unit_of(answered: AnsweredRows) -> float:
    """Return the unit u of the declared precision; 0 if no rounding is tolerated."""
    return float(UNIT_ROUNDOFF[answered.criterion.precision])


def rounded(
    answered: AnsweredRows, unit: float, at: Mask | bool = True, *, printed: bool = False, roots: bool = False
) -> Answers:
    """Return the given answers at those of the rows `at` where roundings of this unit can produce them.

    The answer is SILENT elsewhere. Numbers.possible decides whether they can; `printed` and `roots` have their meaning
    there.
    """
    answers = judge.expected(np.array([-1, 0, 1], dtype=np.int8), answered.criterion.question)
    possible = answered.numbers.possible(unit, printed=printed, roots=roots)
    agrees = (possible & (answers[None, :] == answered.given[:, None])).any(axis=1)
    return np.where(agrees & at, answered.given, SILENT).astype(np.int8)


def _lost_beside_the_ring(answered: AnsweredRows) -> Answers:
    """Return the given answers beside the ring where roundings can produce them: Δ has no reliable sign there."""
    at = (answered.truth == Position.EXTERIOR) & answered.numbers.near_the_ring(2.0**-12)
    return rounded(answered, 2 * max(unit_of(answered), FLOAT64), at)


def _lost(answered: AnsweredRows) -> Answers:
    """Return the given answers where roundings of a plain evaluation can produce them, in float64 or less precise."""
    unit = unit_of(answered)
    return rounded(answered, 2 * unit) if unit >= FLOAT64 else silent(answered)


def _lost_outside(answered: AnsweredRows) -> Answers:
    """Return the given answers that roundings of the printed rules can produce, at contacts outside their regimes."""
    n = answered.numbers
    with np.errstate(all="ignore"):
        outside = (answered.truth == Position.CONTACT) & ((n.A < 1) | (n.B**2 < n.A))
    return rounded(answered, 2 * max(unit_of(answered), FLOAT64), outside, printed=True)


def _lost_in_float64(answered: AnsweredRows) -> Answers:
    """Return the given answers that roundings of float64 can produce, if the declared precision is higher."""
    return rounded(answered, 2 * FLOAT64) if unit_of(answered) < FLOAT64 else silent(answered)


def _half_lost(answered: AnsweredRows) -> Answers:
    """Return the given answers that roundings to half the digits of the precision can produce."""
    return rounded(answered, 2 * max(unit_of(answered), FLOAT64) ** 0.5)


_RANGES = {"float16": (-14, 16), "bfloat16": (-126, 128), "float32": (-126, 128), "float64": (-1022, 1024)}
"""The binary exponents of the least normal number and of the greatest, plus one."""


def _out_of_range(answered: AnsweredRows) -> Answers:
    """Return the given answers where a square or a product of the plain formula overflows or underflows in the format.

    Δ has no reliable sign there, so any answer may come out.
    """
    if answered.criterion.precision not in _RANGES:
        return silent(answered)
    least, greatest = _RANGES[answered.criterion.precision]
    with np.errstate(all="ignore"):
        alpha, gamma, b, d, x, y, z = np.log2(np.abs(answered.rows[:, : len(COLUMNS)].T))
        r = np.maximum(x, y)
        A, B, P, Q = 2 * (alpha - b), 2 * (gamma - d), 2 * (r - b), 2 * (z - d)
        M2, M1 = greatest_of(A, B, P, Q, 0 * A), greatest_of(A + B, A, B, B + P, A + Q)
        squares = [2 * b, A, B, 2 * (A + B), P, Q, 2 * x, 2 * y]
        too_small = np.any([(exponent < least) & np.isfinite(exponent) for exponent in squares], axis=0)
        too_large = np.any(
            [exponent >= greatest for exponent in (*squares, 3 * M1, 3 * M2 + A + B, 2 * (M1 + M2))], axis=0
        )
    return np.where(too_small | too_large, answered.given, SILENT).astype(np.int8)


CONTRADICTED = 0.02
"""A tolerance is inferred only if the answers within it that contradict it are at most this share of those that
agree."""


LARGEST_TOLERANCE = 1e-2
"""The largest tolerance of distances between roots that is inferred."""


def _complex_pair_ignored(answered: AnsweredRows) -> Answers:
    """Answer exterior at a complex pair of roots: the code ignores the pair, and the one real root is positive.

    A double root, or two roots close together, may be computed as a complex pair.
    """
    n = answered.numbers
    with np.errstate(all="ignore"):
        error = n.delta_error(FLOAT64, roots=True)
        pair, close = n.delta < -error, np.abs(n.delta) <= error
    exterior = answered.answers_at(np.full(len(answered.rows), Position.EXTERIOR, dtype=np.int8))
    return np.where(pair | (close & (answered.given == exterior)), exterior, SILENT).astype(np.int8)


_BEYOND = {
    Kind.CROSSING_THROAT_NODE: Position.INTERIOR,
    Kind.CROSSING_GROOVE_NODE: Position.EXTERIOR,
    Kind.CROSSING_GROOVE_CUSP: Position.EXTERIOR,
    Kind.CROSSING_GROOVE_ISOLATED_POINT: Position.EXTERIOR,
}
"""Contacts with a double root beyond a pole, and what the signs of the roots alone say."""


def _repeated_beyond_a_pole(answered: AnsweredRows) -> Answers:
    """Answer as code that counts a double root below −A or above B as two roots on the side of its sign."""
    at = (answered.truth == Position.CONTACT) & answered.numbers.possible(2.0**-50, printed=True)[:, (0, 2)].any(axis=1)
    answers = silent(answered)
    for kind, position in _BEYOND.items():
        answers = np.minimum(answers, where_kind(at, answered, kind, position))
    return answers


def _at_upper_pole(answered: AnsweredRows) -> Answers:
    """Answer contact at exterior rows with z = 0: B is a root that the open interval (0, B) does not contain.

    Rows beside the ring are left out, because there a root close to B is another cause.
    """
    at = (answered.truth == Position.EXTERIOR) & (answered.rows[:, 6] == 0)
    return _contact(answered, at & ~answered.numbers.near_the_ring(2.0**-12))


def _at_lower_pole(answered: AnsweredRows) -> Answers:
    """Answer contact at interior rows on the axis: −A is a root that the open interval (−A, 0) does not contain."""
    at = (answered.truth == Position.INTERIOR) & (answered.rows[:, 4:6] == 0).all(axis=1)
    return _contact(answered, at)


def _contact(answered: AnsweredRows, at: Mask) -> Answers:
    """Answer contact at the rows `at`; SILENT elsewhere."""
    positions = silent(answered)
    positions[at] = Position.CONTACT
    return answered.answers_at(positions)


def _computed_roots(answered: AnsweredRows) -> Answers:
    """Return the given answers that rounding errors of computed roots can produce."""
    return rounded(answered, max(unit_of(answered), FLOAT64), roots=True)


def _roots(n: Numbers) -> NDArray[np.complex128]:
    """Return the three roots of g (n, 3) in float64, sorted by their real parts; NaN where g overflows."""
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


def _within(answered: AnsweredRows, sizes: Floats, answers: Answers) -> Answers:
    """Return these answers where a size is within the code's tolerance; SILENT elsewhere.

    The tolerance is inferred: it is the largest size at which the given answer is one of these. It must be at most
    LARGEST_TOLERANCE, and hardly any answer within it may contradict it (CONTRADICTED).
    """
    with np.errstate(invalid="ignore"):
        candidates = (answers != SILENT) & (sizes <= LARGEST_TOLERANCE)
    agree = candidates & (answers == answered.given)
    if not agree.any():
        return np.full(len(sizes), SILENT, dtype=np.int8)
    inside = candidates & (sizes <= sizes[agree].max())
    if (inside & ~agree).sum() > CONTRADICTED * agree.sum():
        return np.full(len(sizes), SILENT, dtype=np.int8)
    return np.where(inside, answers, SILENT).astype(np.int8)


def _imaginary_part(answered: AnsweredRows) -> Answers:
    """Answer as code that takes a complex pair with a small imaginary part for two real roots."""
    roots = _roots(answered.numbers)
    apart = np.abs(roots.imag).max(axis=1)
    pair = np.take_along_axis(roots, np.abs(roots.imag).argmax(axis=1)[:, None], axis=1)[:, 0].real
    positions = np.where(pair > 0, Position.EXTERIOR, Position.INTERIOR).astype(np.int8)
    at = (answered.truth == Position.CONTACT) & (apart > 0)
    return _of_either_size(answered, apart, pair, np.where(at, answered.answers_at(positions), SILENT).astype(np.int8))


def _separation(answered: AnsweredRows) -> Answers:
    """Answer contact, as code does that takes two real roots close together for one double root."""
    roots = _roots(answered.numbers)
    gaps = np.abs(np.diff(roots, axis=1))
    nearest = gaps.argmin(axis=1)[:, None]
    gap = np.take_along_axis(gaps, nearest, axis=1)[:, 0]
    place = np.take_along_axis(roots, nearest, axis=1)[:, 0].real
    return _of_either_size(answered, gap, place, _contact(answered, answered.truth != Position.CONTACT))


def _of_either_size(answered: AnsweredRows, sizes: Floats, roots: Floats, answers: Answers) -> Answers:
    """Return these answers within an absolute tolerance or one relative to the root, whichever explains more."""
    with np.errstate(all="ignore"):
        either = [_within(answered, some, answers) for some in (sizes, sizes / np.abs(roots))]
    return max(either, key=lambda some: int((some == answered.given).sum()))


ROOT_CAUSES: tuple[Cause, ...] = (
    cause("complex-pair-ignored", _complex_pair_ignored, Scope.PLACE),
    cause("repeated-root-beyond-a-pole", _repeated_beyond_a_pole, Scope.PLACE),
    cause("root-at-upper-pole", _at_upper_pole, Scope.PLACE, slack=4),
    cause("root-at-lower-pole", _at_lower_pole, Scope.PLACE, slack=4),
    cause("computed-roots", _computed_roots, Scope.ROUNDING),
    cause("imaginary-part-tolerance", _imaginary_part, Scope.ROUNDING),
    cause("root-separation-tolerance", _separation, Scope.ROUNDING),
)
"""The causes of code that computes roots, those in exact arithmetic first."""


PLACES: tuple[Cause, ...] = (
    cause("ring", _ring, Scope.PLACE, slack=4, certain=_delta_is_exact),
    cause("groove", _groove, Scope.PLACE),
    cause("throat", _throat, Scope.PLACE),
    cause("zero-coefficient", _zero_coefficient, Scope.PLACE, slack=4, certain=_coefficients_are_exact),
    *(
        Cause(
            name=kind.value,
            sentence=f"it takes a tangency for clear ({kind.contact_set} in common, {kind.value})",
            why=f"{kind.description} There Δ = 0, as the roots of g are: {kind.roots}. Touching is contact",
            remedy="a tangency is contact: exterior and interior must also require: Δ > 0",
            rule=_tangency(kind, kind.limit_of),
            scope=Scope.PLACE,
        )
        for kind in Kind
        if kind.limit_of is not None
    ),
    cause("out-of-range", _out_of_range, Scope.ROUNDING),
    cause("lost-beside-the-ring", _lost_beside_the_ring, Scope.ROUNDING),
    cause("lost-to-rounding", _lost, Scope.ROUNDING),
    cause("lost-outside-the-regime", _lost_outside, Scope.ROUNDING),
)
"""The causes about places, those in exact arithmetic first."""


WIDER_ROUNDINGS: tuple[Cause, ...] = (
    cause("float64-for-more", _lost_in_float64, Scope.ROUNDING),
    cause("half-the-digits", _half_lost, Scope.ROUNDING),
)
"""Roundings of a narrower format than the declared one, which explain what no other rounding does."""
