"""The search for the witness that certificate.py checks, in rational numbers as short as the case allows.

A witness always exists (docs/mathematics.md, "A certificate for every answer"), and every search below doubles its
precision until the claim holds exactly, so each one ends. For a clear pair λ is near a maximum: of the cubic g if the
pair is upright, of φ(λ) if it is tilted. φ is concave between −ℓ′ and ℓ (exact.py), and bisection with exact signs
finds its maximum. crossing.py finds points of a crossing.

**Where the hyperboloid ends**, the λ of the hyperboloid without ends is tried first. If it is not enough, the wall is
cut into pieces, each with a λ and a μ: λ is that of the middle height (sections.py), and then the best μ is known. With
A w² + B w + C the least e + λ h at a height w, the form with μ (w − l)(w − u) is positive definite if A + μ > 0 and
4 (A + μ)(C + μ l u) > (B − μ (l + u))². The difference of both sides is greatest at
μ = 2 (C + A l u + B (l + u)/2)/(u − l)². Where the spheroid does not reach, λ is 0. A piece that cannot be proved is
halved; this ends, since the pair is clear.

Two points of a contact lie beside a point of the wall within the spheroid, which floats find (least.py): it is made
rational, moved a little outward and inward, and checked exactly.

The proof about a sweep has clear pieces of it, and a time of contact with short points. Bounds of the first contact are
neighbouring float64 numbers, or 0 twice if the sweep begins in contact. A sweep whose only contact is a touch at an
irrational time has no such proof.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from fractions import Fraction

from hypcheck.geometry.arithmetic import precisions, root_of, rounded, rounded_toward, shortened
from hypcheck.geometry.pair import Lengths, Pair, Position
from hypcheck.truth import crossing, exact
from hypcheck.truth.certificate import (
    Certificate,
    Matrix,
    PassageCertificate,
    Piece,
    Point,
    check_certificate,
    is_positive,
    pencil,
    place,
    surfaces,
)
from hypcheck.truth.exact import Decision
from hypcheck.truth.pencil import Cubic, Quartic, cubic, inside, local_maximum, quartic, toward_maximum
from hypcheck.truth.polynomials import sign_at, value
from hypcheck.truth.sections import Sections
from hypcheck.truth.sweep import StraightSweep, piece
from hypcheck.truth.swept import Passage, by_roots, by_steps, reach, sweep_of_row


def prove(pair: Pair, decision: Decision | None = None) -> Certificate:
    """Make a certificate for the exact answer about a pair; `decision` is this answer, if the caller has it."""
    lengths = pair.lengths
    decision = decision or exact.decide(lengths)
    if pair.has_ends:
        return _prove_beside_ends(pair, decision.position)
    if decision.tangent:
        return Certificate(decision.position, double_root=double_root(lengths))
    if decision.position is Position.CONTACT:
        return Certificate(decision.position, points=crossing.points(pair, lengths))
    at = _cubic_multiplier(cubic(lengths)) if lengths.is_upright else _quartic_multiplier(quartic(lengths))
    return Certificate(decision.position, multiplier=at)


def double_root(lengths: Lengths) -> Fraction:
    """Return the double root of det(S + λH) of a tangency."""
    if not lengths.is_upright:
        F = quartic(lengths)
        return exact.double_root(F) * F.side
    g = cubic(lengths)
    h = g.n2 * g.n2 - 3 * g.n3 * g.n1
    return Fraction(9 * g.n3 * g.n0 - g.n1 * g.n2, 2 * h) if h else Fraction(-g.n2, 3 * g.n3)


def _cubic_multiplier(g: Cubic) -> Fraction:
    """Round the local maximum of g to the fewest bits at which g stays positive; their number is a power of two."""
    for bits in precisions():
        at = rounded(Fraction(*local_maximum(g, bits)), bits)
        # Below 0, g > 0 means λ > −A: g(−A) ≤ 0, and g rises up to there.
        if (at < 0 or at * g.t < g.s) and sign_at(g.coefficients, at) > 0:
            return at
    raise AssertionError("unreachable: the precisions do not end")


def _quartic_multiplier(F: Quartic) -> Fraction:
    """Return a λ between 0 and ℓ at which F is positive, rounded to the fewest bits; their number is a power of two."""
    multiplier = next(at for at in toward_maximum(F) if inside(F, at) and sign_at(F.coefficients, at) > 0)
    for bits in precisions():
        at = rounded(multiplier, bits)
        if inside(F, at) and sign_at(F.coefficients, at) > 0:
            return at * F.side
    raise AssertionError("unreachable: the precisions do not end")


_WALL_BITS = (8, 24, 64, 160)


def _prove_beside_ends(pair: Pair, position: Position) -> Certificate:
    """Return a certificate for this position, the exact one, beside a hyperboloid that ends.

    For a touch, and for a crossing that floats do not find, it has only the position: see certificate.py.
    """
    if position is Position.CONTACT:
        candidates = (Certificate(position, points=points) for points in _crossings(pair))
    else:
        whole = prove(pair.without_ends).multiplier
        candidates = (Certificate(position, multiplier=at) for at in (whole,) if at is not None)
    for certificate in candidates:
        if check_certificate(pair, certificate):
            return certificate
    return Certificate(position, pieces=() if position is Position.CONTACT else tuple(_wall_pieces(pair)))


def _wall_pieces(pair: Pair) -> Iterator[Piece]:
    """Yield pieces of [z_min, z_max] that prove that the wall, or a solid body, is missed."""
    S, H = surfaces(pair)
    sections = Sections.of(pair.lengths)
    unit = Fraction(pair.lengths.d) / Fraction(pair.d)
    bottom, top = _beyond_reach(pair)
    low, high = max(Fraction(bottom), _end(pair.z_min, bottom)), min(Fraction(top), _end(pair.z_max, top))
    if pair.z_min < bottom:
        yield _outside(pair, None, bottom)
    pending = [(low, high)] if low < high else []
    while pending:
        low, high = pending.pop()
        middle = (low + high) / 2
        tried = _tried(S, H, (low, high), sections.multiplier(middle * unit), solid=bool(pair.solid))
        piece = next(tried, None)
        if piece is None:
            pending += [(middle, high), (low, middle)]
        else:
            yield piece
    if pair.z_max > top:
        yield _outside(pair, top, None)


def _end(height: float, otherwise: Fraction) -> Fraction:
    """Return a finite height as a fraction, else `otherwise`."""
    return Fraction(height) if math.isfinite(height) else otherwise


def _half_height_squared(pair: Pair) -> Fraction:
    """Return the square of the spheroid's half height."""
    b, d, v = Fraction(pair.b), Fraction(pair.d), [Fraction(part) for part in pair.axis]
    return b * b + (d * d - b * b) * v[2] * v[2] / sum((part * part for part in v), Fraction(0))


def _beyond_reach(pair: Pair) -> tuple[Fraction, Fraction]:
    """Return heights below the lowest and above the highest point of the spheroid."""
    half = rounded(root_of(_half_height_squared(pair), 16, upward=True) * Fraction(9, 8), 8)
    return Fraction(pair.z) - half, Fraction(pair.z) + half


def _outside(pair: Pair, low: Fraction | None, high: Fraction | None) -> Piece:
    """Return the piece above `low`, or below `high`, which the spheroid does not reach: λ is 0."""
    z = Fraction(pair.z)
    away = z - high if high is not None else (low or Fraction(0)) - z
    return Piece(low, high, Fraction(0), rounded(2 * away / _half_height_squared(pair), 16))


def _tried(S: Matrix, H: Matrix, heights: tuple[Fraction, Fraction], at: Fraction, *, solid: bool) -> Iterator[Piece]:
    """Yield the proved pieces with this λ, rounded to more and more bits."""
    low, high = heights
    for bits in _WALL_BITS:
        multiplier = rounded(at, bits) if at else at
        if solid and multiplier < 0:
            multiplier = Fraction(0)
        quadratic = _least_at_height(S, H, multiplier)
        if quadratic is None:
            continue
        A, B, C = quadratic
        best = 2 * (C + A * low * high + B * (low + high) / 2) / (high - low) ** 2
        piece = Piece(low, high, multiplier, rounded(best, bits + 8) if best > 0 else Fraction(0))
        if is_positive(S, H, piece):
            yield piece


def _least_at_height(S: Matrix, H: Matrix, at: Fraction) -> tuple[Fraction, Fraction, Fraction] | None:
    """Return A, B, C of the module's docstring; None if e + λh is not convex in horizontal planes."""
    rows = pencil(S, H, at)
    for i in (0, 1):
        if rows[i][i] <= 0:
            return None
        for other in rows[i + 1 :]:
            factor = other[i] / rows[i][i]
            other[:] = [a - factor * b for a, b in zip(other, rows[i], strict=True)]
    return rows[2][2], 2 * rows[2][3], rows[3][3]


def _crossings(pair: Pair) -> Iterator[tuple[Point, Point]]:
    """Yield pairs of points that may prove a contact."""
    from hypcheck.truth import least  # noqa: PLC0415 - it loads numpy, which other proofs do without

    center = (Fraction(pair.x), Fraction(pair.y), Fraction(pair.z))
    low, high = (Fraction(end) if math.isfinite(end) else None for end in (pair.z_min, pair.z_max))
    nearest = least.to_border(pair).point
    if not all(map(math.isfinite, nearest)):
        return
    place = tuple(map(Fraction, nearest))
    for shrink in (Fraction(0), Fraction(1, 1 << 30), Fraction(1, 1 << 10), Fraction(1, 16)):
        x, y, w = (p + shrink * (c - p) for p, c in zip(place, center, strict=True))
        w = w if low is None else max(w, low)
        w = w if high is None else min(w, high)
        for step in (40, 30, 20, 10, 4):
            near = Fraction(1, 1 << step)
            yield (x * (1 + near), y * (1 + near), w), (x * (1 - near), y * (1 - near), w)
    if pair.solid:
        yield (place[0], place[1], place[2]), center


Bounds = tuple[float, float]

_STEP_BITS = 12
_FEW = 6
"""The most multipliers, each of twice as many bits, that are tried after the first that proves a time clear."""
_MOST_BITS = 1 << 12


def prove_passage(row: Sequence[float]) -> tuple[Passage, Bounds | None, PassageCertificate]:
    """Prove the passage of a row's sweep: return it, bounds of the first contact (None without one), and the proof.

    Raises ValueError if the only contact is at an irrational time.
    """
    sweep = sweep_of_row(row)
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
    """Return a rational time of contact up to first_upper; if the sweep only touches, the simplest possible number."""
    low, high = passage.first or (Fraction(0), Fraction(0))
    upper = Fraction(passage.first_upper)
    for time in (upper, high, low, simplest(low, high)):
        if time <= 1 and not sweep.position(time):
            return time
    raise ValueError("the sweep touches the surface at an irrational time alone")


def simplest(low: Fraction, high: Fraction) -> Fraction:
    """Return the fraction with the least denominator from low to high, both ≥ 0, by continued fractions."""
    whole = math.floor(low)
    if whole == low:
        return low
    if whole + 1 <= high:
        return Fraction(whole + 1)
    return whole + 1 / simplest(1 / (high - whole), 1 / (low - whole))


def _pieces(sweep: StraightSweep, until: Fraction) -> tuple[tuple[Fraction, Fraction], ...]:
    """Return pieces of a sweep that is clear up to a time, that time included."""
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
    """Return the first multiplier that proves a time clear, or the next if it reaches farther; and how far it does."""
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
    """Return the centre and a point of the spheroid strictly on the other side, cut to as few bits as possible."""
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
