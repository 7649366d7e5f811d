"""What a spheroid that leans changes: the simplest pairs whose answer is another once the axis is not vertical."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from math import gcd

from hypcheck.geometry.pair import Pair, Position
from hypcheck.truth import certificate as upright
from hypcheck.truth import exact as upright_exact
from hypcheck.truth import prove as upright_prove
from hypcheck.truth.tilted import certificate as tilted
from hypcheck.truth.tilted import exact, prove
from hypcheck.truth.tilted.pair import TiltedPair

LARGEST = 6
"""Sizes and coordinates of the pairs that are tried are whole numbers up to this one."""

AXES = tuple(
    (float(x), 0.0, float(z))
    for total in range(2, 8)
    for x, z in ((sign * x, total - x) for x in range(1, total) for sign in (1, -1))
    if abs(x) <= z and gcd(x, z) == 1
)
"""Axes that lean by 45 degrees at most, towards the hyperboloid's axis or away from it, the simplest first."""


@dataclass(frozen=True, slots=True)
class LeaningWitness:
    """A pair with the certificates of two positions: as it leans, and upright; `shows` says what it shows."""

    pair: TiltedPair
    certificate: upright.Certificate
    vertical: upright.Certificate
    shows: str

    @property
    def upright(self) -> Pair:
        """The same pair with a vertical axis."""
        return Pair(*self.pair.row[:7])

    @property
    def holds(self) -> bool:
        """Whether both certificates prove their positions, by rational arithmetic of their own, and these differ."""
        differ = self.certificate.position is not self.vertical.position
        proved = tilted.check_certificate(self.pair, self.certificate)
        return differ and proved and upright.check_certificate(self.upright, self.vertical)

    @property
    def text(self) -> str:
        """The pair and its positions: "α = 2, γ = 1, b = 2, d = 1, C = (1, 0, 2): interior; with the axis …"."""
        alpha, gamma, b, d, *center = (f"{each:g}" for each in self.pair.row[:7])
        axis = ", ".join(f"{each:g}" for each in self.pair.axis)
        said = (
            f"α = {alpha}, γ = {gamma}, b = {b}, d = {d}, C = ({', '.join(center)}): {self.vertical.position.label} "
            f"upright, {self.certificate.position.label} with the axis ({axis})"
        )
        return said.replace("-", "−")


@dataclass(frozen=True, slots=True)
class FirstChange:
    """How many pairs with an axis were tried, and the first that was looked for, if any."""

    tried: int
    found: LeaningWitness | None


def first_change(before: Position, after: Position, shows: str) -> FirstChange:
    """The simplest pair that is `before` upright and `after` as it leans, both proved."""
    tried = 0
    for numbers in _pairs():
        vertical = Pair.from_row(numbers)
        if upright_exact.position(vertical.lengths) is not before:
            continue
        for axis in AXES:
            tried += 1
            pair = TiltedPair.from_row((*numbers, *axis))
            if exact.position(pair.lengths) is after:
                return FirstChange(tried, LeaningWitness(pair, prove.prove(pair), upright_prove.prove(vertical), shows))
    return FirstChange(tried, None)


def _pairs() -> Iterator[tuple[float, ...]]:
    """Sizes and centres (x, 0, z) with α ≥ b, the regime of Procedures 2.a and 2.b, and b > d, as a quadcopter has."""
    sizes = range(1, LARGEST + 1)
    whole = (each for each in product(sizes, repeat=6) if each[0] >= each[2] > each[3])
    for alpha, gamma, b, d, x, z in sorted(whole, key=lambda each: (sum(each), max(each), each)):
        yield (*map(float, (alpha, gamma, b, d, x)), 0.0, float(z))
