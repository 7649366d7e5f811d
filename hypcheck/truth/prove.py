"""The search for the witness that certificate.py checks, in rational numbers as short as the case allows.

A witness always exists (docs/mathematics.md, "A certificate for every answer"), and every search below doubles its
precision until the claim holds exactly, so each one ends. For a clear pair λ is near a maximum: of the cubic g if the
pair is upright, of φ(λ) if it is tilted. φ is concave between −ℓ′ and ℓ (exact.py), and bisection with exact signs
finds its maximum. crossing.py finds points of a crossing. If the hyperboloid ends, ended_prove.py uses this search for
the hyperboloid without ends, and cuts the heights into pieces if that is not enough.

The proof about a sweep has clear pieces of it, and a time of contact with short points. Bounds of the first contact are
neighbouring float64 numbers, or 0 twice if the sweep begins in contact. A sweep whose only contact is a touch at an
irrational time has no such proof.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction

from hypcheck.geometry.arithmetic import rounded_toward
from hypcheck.geometry.pair import SWEEP_COLUMNS, Lengths, Pair, Position
from hypcheck.truth import crossing, exact
from hypcheck.truth.certificate import Certificate, PassageCertificate, Point, place
from hypcheck.truth.exact import Decision
from hypcheck.truth.pencil import Cubic, Quartic, cubic, inside, local_maximum, quartic, toward_maximum
from hypcheck.truth.polynomials import sign_at, value
from hypcheck.truth.rationals import precisions, rounded, shortened
from hypcheck.truth.sweep import StraightSweep, piece
from hypcheck.truth.swept import Passage, by_roots, by_steps, reach, sweep_of


def prove(pair: Pair, decision: Decision | None = None) -> Certificate:
    """A certificate for the exact answer about a pair; `decision` is this answer, if the caller already has it."""
    lengths = pair.lengths
    decision = decision or exact.decide(lengths)
    if pair.has_ends:
        from hypcheck.truth import ended_prove  # noqa: PLC0415 - it loads numpy, which other proofs do without

        touched = decision.position is Position.CONTACT
        return ended_prove.prove(pair, decision, None if touched else prove(pair.without_ends).multiplier)
    if decision.tangent:
        return Certificate(decision.position, double_root=double_root(lengths))
    if decision.position is Position.CONTACT:
        return Certificate(decision.position, points=crossing.points(pair, lengths))
    at = _cubic_multiplier(cubic(lengths)) if lengths.is_upright else _quartic_multiplier(quartic(lengths))
    return Certificate(decision.position, multiplier=at)


def double_root(lengths: Lengths) -> Fraction:
    """The double root of det(S + λH) of a tangency."""
    if not lengths.is_upright:
        F = quartic(lengths)
        return exact.double_root(F) * F.side
    g = cubic(lengths)
    h = g.n2 * g.n2 - 3 * g.n3 * g.n1
    return Fraction(9 * g.n3 * g.n0 - g.n1 * g.n2, 2 * h) if h else Fraction(-g.n2, 3 * g.n3)


def _cubic_multiplier(g: Cubic) -> Fraction:
    """The local maximum of g, rounded to the fewest bits at which g stays positive; their number is a power of two."""
    for bits in precisions():
        at = rounded(Fraction(*local_maximum(g, bits)), bits)
        # Below 0, g > 0 means λ > −A: g(−A) ≤ 0, and g rises up to there.
        if (at < 0 or at * g.t < g.s) and sign_at(g.coefficients, at) > 0:
            return at
    raise AssertionError("unreachable: the precisions do not end")


def _quartic_multiplier(F: Quartic) -> Fraction:
    """A λ between 0 and ℓ at which F is positive, rounded to the fewest bits; their number is a power of two."""
    multiplier = next(at for at in toward_maximum(F) if inside(F, at) and sign_at(F.coefficients, at) > 0)
    for bits in precisions():
        at = rounded(multiplier, bits)
        if inside(F, at) and sign_at(F.coefficients, at) > 0:
            return at * F.side
    raise AssertionError("unreachable: the precisions do not end")


Bounds = tuple[float, float]

_STEP_BITS = 12
_FEW = 6
"""The most multipliers, each of twice as many bits, that are tried after the first that proves a time clear."""
_MOST_BITS = 1 << 12


def prove_passage(row: Sequence[float]) -> tuple[Passage, Bounds | None, PassageCertificate]:
    """The passage of the row's sweep, bounds of the first contact (None if there is none), and the proof of both.

    Raises ValueError if the only contact is at an irrational time.
    """
    sweep = sweep_of(row[:4], row[4:7], row[7:10], row[len(SWEEP_COLUMNS) :] or None)
    passage = by_steps(sweep) or by_roots(sweep)
    if passage.first is None:
        return passage, None, PassageCertificate(_pieces(sweep, Fraction(1)))
    time = _time_of_contact(sweep, passage)
    low, high = (time, time) if passage.grazes else passage.first
    bounds = rounded_toward(low, -math.inf), rounded_toward(high, math.inf)
    if bounds[0] and Fraction(bounds[0]) >= low:
        bounds = math.nextafter(bounds[0], 0.0), bounds[1]
    pieces = _pieces(sweep, Fraction(bounds[0])) if bounds[0] else ()
    if sweep.tangent(time):
        return passage, bounds, PassageCertificate(pieces, time, double_root=double_root(sweep.at(time)))
    return passage, bounds, PassageCertificate(pieces, time, points=_points(row, sweep, time))


def _time_of_contact(sweep: StraightSweep, passage: Passage) -> Fraction:
    """A rational time of contact up to first_upper; if the sweep only touches, the simplest possible number."""
    low, high = passage.first or (Fraction(0), Fraction(0))
    upper = Fraction(passage.first_upper)
    for time in (upper, high, low, simplest(low, high)):
        if time <= 1 and not sweep.position(time):
            return time
    raise ValueError("the sweep touches the surface at an irrational time alone")


def simplest(low: Fraction, high: Fraction) -> Fraction:
    """The fraction with the least denominator from low to high, both ≥ 0, by continued fractions."""
    whole = math.floor(low)
    if whole == low:
        return low
    if whole + 1 <= high:
        return Fraction(whole + 1)
    return whole + 1 / simplest(1 / (high - whole), 1 / (low - whole))


def _pieces(sweep: StraightSweep, until: Fraction) -> tuple[tuple[Fraction, Fraction], ...]:
    """Pieces of a sweep that is clear up to a time, that time included."""
    time = Fraction(0)
    pieces: list[tuple[Fraction, Fraction]] = []
    while time < until:
        multiplier, step = _multiplier(sweep, time)
        end = until
        if step is not None and time + step <= until:
            end = time + shortened(step.numerator, step.denominator, _STEP_BITS)
        pieces.append((multiplier, end))
        time = end
    return tuple(pieces)


def _multiplier(sweep: StraightSweep, time: Fraction) -> tuple[Fraction, Fraction | None]:
    """The first multiplier that proves a time clear, or the next one if it reaches farther; and the time it reaches."""
    best: tuple[Fraction, Fraction | None] | None = None
    for number, multiplier in enumerate(sweep.multipliers(time)):
        if best is not None and number >= _FEW:
            break
        proof = piece(sweep.pencil, multiplier)
        if value(proof, time) <= 0 or (best is not None and multiplier == best[0]):
            continue
        step = reach(proof, time)
        if step is None or time + step > 1:
            return multiplier, step
        if best is not None:
            farther = best[1] is not None and step > best[1] * Fraction(9, 8)
            return (multiplier, step) if farther else best
        best = multiplier, step
    if best is None:
        raise AssertionError("unreachable: the multipliers do not end")
    return best


def _points(row: Sequence[float], sweep: StraightSweep, time: Fraction) -> tuple[Point, ...]:
    """The centre and a point of the spheroid strictly on the other side, cut to as few bits as possible."""
    here = place(row, time)
    points = crossing.points(here, sweep.at(time))
    if len(points) == 1:
        return points
    centre, far = points
    forms = crossing.Forms(here)
    side = forms.hyperboloid(forms.homogeneous(centre))
    out = [(a - c) / here.row[2] for a, c in zip(far, centre, strict=True)]
    for offset in crossing.shortened(out, 2, _MOST_BITS):
        x, y, z = (c + here.row[2] * part for c, part in zip(centre, offset, strict=True))
        point = forms.homogeneous((x, y, z))
        if forms.in_spheroid(point) and forms.hyperboloid(point) * side < 0:
            return centre, (x, y, z)
    return points
