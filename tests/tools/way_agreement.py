"""Whether dense exact sampling and an independent decision agree with what is said of ways: a tool, run by hand.

    python -m tests.tools.way_agreement                      # every frozen way, against its file
    python -m tests.tools.way_agreement --rows 3000 --seed 1 # generated ways, against hypcheck.passage

Nothing of hypcheck's decisions of ways or of positions is used. The coefficients of det(S + λH) come from 4×4
determinants at three times, in fractions (tests/support); they have degree 2 in the time, which a fourth time confirms.
Its discriminant is a polynomial of the time, whose roots sympy isolates. One rational time between each two of them is
decided by tests/support. A root with the same clear position on both sides is a tangency where the spheroid, grown by
2⁻¹⁰⁰, is in contact within 2⁻³⁰⁰ of it, and else it is a ring, which is clear.

Each disagreement is printed with its row, and makes the status 1.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from fractions import Fraction
from itertools import groupby

from sympy import QQ, Poly, symbols

from hypcheck.vectors import frozen
from hypcheck.vectors.families import SWEEP_FAMILIES
from tests.support import fractions_truth, tilted_fractions
from tests.support.inside import passage

T = symbols("t")
BITS = 300
"""A root is enclosed to a width of 2⁻³⁰⁰."""

GROWTH = 1 + Fraction(1, 2**100)
"""A spheroid that touches for an instant is in contact, within 2⁻³⁰⁰ of the instant, where it is as much larger."""


@dataclass(frozen=True, slots=True)
class Said:
    """What is said of a way: bounds of the first contact, or None where it is clear."""

    name: str
    row: tuple[float, ...]
    first: tuple[Fraction, Fraction] | None


def position_at(row, when, growth=1):
    """The exact position at a rational time, the spheroid grown by a factor."""
    alpha, gamma, b, d, *ends = map(Fraction, row[:10])
    centre = [start + when * (end - start) for start, end in zip(ends[:3], ends[3:], strict=True)]
    pair = (alpha, gamma, b * growth, d * growth, *centre)
    if stands(row):
        return fractions_truth.exact_position(pair)
    return tilted_fractions.exact_position((*pair, *row[10:]))


def stands(row):
    """Whether the spheroid is upright, or a ball."""
    return len(row) == 10 or not any(row[10:12]) or row[2] == row[3]


def discriminant(row):
    """The discriminant of det(S + λH) as a polynomial of the time; of an upright spheroid that of a factor of it."""
    values = [coefficients(row, when) for when in (Fraction(0), Fraction(1, 2), Fraction(1))]
    found = [
        polynomial(at_0, -3 * at_0 + 4 * at_half - at_1, 2 * at_0 - 4 * at_half + 2 * at_1)
        for at_0, at_half, at_1 in zip(*values, strict=True)
    ]
    thirds = [QQ(*each.as_integer_ratio()) for each in coefficients(row, Fraction(1, 3))]
    assert [each.eval(QQ(1, 3)) for each in found] == thirds
    if len(found) == 4:
        d, c, b, a = found
        return 18 * a * b * c * d - 4 * b**3 * d + b**2 * c**2 - 4 * a * c**3 - 27 * a**2 * d**2
    e, d, c, b, a = found
    h = 12 * a * e - 3 * b * d + c**2
    j = 72 * a * c * e + 9 * b * c * d - 27 * a * d**2 - 27 * e * b**2 - 2 * c**3
    return 4 * h**3 - j**2


def polynomial(*lowest_first):
    """A polynomial of the time with these coefficients."""
    return Poly([QQ(*each.as_integer_ratio()) for each in reversed(lowest_first)], T, domain=QQ)


def coefficients(row, when):
    """Those of det(S + λH) at a time, lowest first; of an upright spheroid without the factor 1/b² + λ/α²."""
    alpha, gamma, b, d, *ends = map(Fraction, row[:10])
    centre = [start + when * (end - start) for start, end in zip(ends[:3], ends[3:], strict=True)]
    axis = (0, 0, 1) if stands(row) else row[10:]
    quartic = tilted_fractions.interpolated(*tilted_fractions.matrices((alpha, gamma, b, d, *centre, *axis)))
    if not stands(row):
        return quartic
    quotient, rest = [], Fraction(0)
    for each in reversed(quartic):  # by λ + α²/b²
        rest = each - alpha**2 / b**2 * rest
        quotient.append(rest)
    assert quotient.pop() == 0
    return quotient[::-1]


def first_contact(row):
    """Bounds of the first contact, None where the way is clear. Raises ArithmeticError where this cannot be decided."""
    start, end = position_at(row, Fraction(0)), position_at(row, Fraction(1))
    if start == 0:
        return Fraction(0), Fraction(0)
    if row[4:7] == row[7:10]:
        return None
    found = discriminant(row)
    if found.is_zero:
        raise ArithmeticError("the discriminant is 0 all along")
    parts = found.sqf_part()
    roots = [tuple(Fraction(int(each.p), int(each.q)) for each in span) for span, _ in parts.intervals(inf=0, sup=1)]
    spans = [enclosed(parts, low, high) for low, high in sorted(roots)]
    nexts = [*(low for low, _ in spans), Fraction(1)][1:]
    for at, after in zip(spans, nexts, strict=True):
        side = end if at[1] == 1 else position_at(row, (at[1] + after) / 2)
        if side != start or position_at(row, (at[0] + at[1]) / 2, GROWTH if 0 < at[0] else 1) == 0:
            return at
    return None


def enclosed(poly, low, high):
    """The one root between them, or at both, to BITS, by bisection; each of them may be another root."""
    if low == high:
        return low, high
    terms = stretched([Fraction(int(each.p), int(each.q)) for each in poly.all_coeffs()], low, high)

    def sign(place):
        total = 0
        for power, each in enumerate(terms):
            total = total * place + (each << BITS * power)
        return (total > 0) - (total < 0)

    first, last = 0, 1 << BITS
    below = sign(first) or -sign(last)
    if not below:
        raise ArithmeticError("roots at both ends of an interval leave its own root without a change of sign")
    while last - first > 1:
        middle = (first + last) // 2
        side = sign(middle)
        if not side:
            first = last = middle
        elif side == below:
            first = middle
        else:
            last = middle
    return tuple(low + (high - low) * Fraction(each, 1 << BITS) for each in (first, last))


def stretched(terms, low, high):
    """The coefficients, highest first and in whole numbers, of the polynomial over s, at low + (high − low) s."""
    found = []
    for each in terms:  # found · (low + (high − low) s) + each, lowest first
        found = [low * a + (high - low) * b for a, b in zip([*found, 0], [0, *found], strict=True)] if found else [0]
        found[0] += each
    times = math.lcm(*(each.denominator for each in found))
    return [int(each * times) for each in reversed(found)]


def sampled_faults(said, count):
    """A sentence for each sample that contradicts, of `count` on the way and `count` before the first contact.

    Of a spheroid that leans an eighth of these, as each takes a hundred times as long.
    """
    count = count if stands(said.row) else -(-count // 8)
    start = position_at(said.row, Fraction(0))
    earliest = Fraction(2) if said.first is None else said.first[0]
    evenly = [Fraction(number, count) for number in range(count + 1)]
    before = [] if said.first is None else [earliest * each for each in evenly[:-1]]
    for when in sorted({*evenly, *before}):
        position = position_at(said.row, when)
        if (when < earliest and position != start) or (start == 0 and said.first != (0, 0)):
            yield f"at t = {float(when)!r} the position is {position}, at the start {start}"


def faults(said, count=16):
    """A sentence for each contradiction to what is said of a way; an empty list where all agree, None if undecided."""
    found = list(sampled_faults(said, count))
    try:
        first = first_contact(said.row)
    except ArithmeticError:
        return found or None
    one, other = first or (2, 2), said.first or (2, 2)
    if one[0] > other[1] or one[1] < other[0]:
        found.append(f"contact is first at {told(first)}, and is said to be at {told(said.first)}")
    return found


def told(first):
    """Bounds of a time in words."""
    return "no time" if first is None else f"t = {float(first[0])!r} … {float(first[1])!r}"


def frozen_ways(names=frozen.SWEEP_NAMES):
    """What the files say."""
    for name in names:
        for case in frozen.load(name).cases:
            yield Said(case.id, case.row, case.first and tuple(map(Fraction, case.first)))


def generated_ways(count, seed, names=frozen.SWEEP_NAMES):
    """What hypcheck.passage says of so many ways, those of each family in turn."""
    share = -(-count // len(names))
    for name in names:
        family = SWEEP_FAMILIES[name]
        for number, row in enumerate(family.rows(seed, share).tolist()):
            found = passage(row[:4], row[4:7], row[7:10], row[10:] or None)
            yield Said(f"{name}/{family.version}/{seed}/{number}", tuple(row), found.first)


def tell(text):
    """One line, at once."""
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


def main(arguments=None):
    """Compare, and return the status."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--rows", type=int, help="generated ways; without it the frozen ones")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--samples", type=int, default=64, help="times on a way, and before its first contact")
    parser.add_argument("--families", default=",".join(frozen.SWEEP_NAMES), help="names, with commas between")
    parser.add_argument("--jobs", type=int, default=1)
    asked = parser.parse_args(arguments)
    names = asked.families.split(",")
    ways = list(frozen_ways(names) if asked.rows is None else generated_ways(asked.rows, asked.seed, names))
    with ProcessPoolExecutor(asked.jobs) as pool:
        return compared(ways, pool.map(faults, ways, [asked.samples] * len(ways), chunksize=8))


def compared(ways, results):
    """Print each disagreement as it comes, each family as it is done, and return the status."""
    total, disagreed = Counter(), 0
    for family, some in groupby(zip(ways, results, strict=True), key=lambda each: family_of(each[0])):
        counted = Counter()
        for said, found in some:
            counted.update(ways=1, hits=said.first is not None, undecided=found is None)
            disagreed += bool(found)
            for each in found or ():
                tell(f"{said.name}: {each}; row {','.join(map(repr, said.row))}")
        tell(f"{family:26} {table_line(counted)}")
        total += counted
    tell(f"{'together':26} {table_line(total)}, {disagreed} disagreements")
    return 1 if disagreed else 0


def family_of(said):
    """The family of a way, frozen or generated."""
    return said.name.partition("/")[0] if "/" in said.name else said.name.rpartition("-")[0]


def table_line(counted):
    """Counts in words."""
    ways, hits, undecided = (counted[name] for name in ("ways", "hits", "undecided"))
    return f"{ways:6} ways, {hits:6} with contact, {undecided:4} left undecided by the discriminant"


if __name__ == "__main__":
    sys.exit(main())
