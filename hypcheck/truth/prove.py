"""The search for the witness that certificate.py checks, rational and as short as the case allows.

A witness always exists (docs/mathematics.md, "A certificate for every answer"), and every search below doubles its
precision until the claim holds exactly, so each one ends. λ of a clear pair is near the maximum of the cubic g of an
upright pair, and of φ(λ) of a tilted one, which is concave between −ℓ′ and ℓ (exact.py) and whose maximum is found by
bisection with exact signs. Points of a crossing are looked for in crossing.py. Where the hyperboloid ends,
ended_prove.py takes this search for the whole one, and cuts the heights into pieces where that is not enough.
"""

from __future__ import annotations

from fractions import Fraction

from hypcheck.geometry.pair import Lengths, Pair, Position
from hypcheck.truth import crossing, exact
from hypcheck.truth.certificate import Certificate
from hypcheck.truth.exact import Decision
from hypcheck.truth.pencil import Cubic, Quartic, cubic, inside, local_maximum, quartic, sign_at, toward_maximum
from hypcheck.truth.rationals import precisions, rounded


def prove(pair: Pair, decision: Decision | None = None) -> Certificate:
    """A certificate for the exact answer about a pair (`decision`, where the caller has it already)."""
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
    """The local maximum of g, rounded to the fewest bits (a power of two of them) at which g is still positive."""
    for bits in precisions():
        at = rounded(Fraction(*local_maximum(g, bits)), bits)
        u, v = at.numerator, at.denominator
        inside = u < 0 or u * g.t < v * g.s  # below 0, g > 0 means λ > −A: g(−A) ≤ 0, and g rises up to there
        if inside and ((g.n3 * u + g.n2 * v) * u + g.n1 * v * v) * u + g.n0 * v**3 > 0:
            return at
    raise AssertionError("unreachable: the precisions do not end")


def _quartic_multiplier(F: Quartic) -> Fraction:
    """A λ at which F is positive between 0 and ℓ, rounded to the fewest bits (a power of two of them) that will do."""
    multiplier = next(at for at in toward_maximum(F) if inside(F, at) and sign_at(F.coefficients, at) > 0)
    for bits in precisions():
        at = rounded(multiplier, bits)
        if inside(F, at) and sign_at(F.coefficients, at) > 0:
            return at * F.side
    raise AssertionError("unreachable: the precisions do not end")
