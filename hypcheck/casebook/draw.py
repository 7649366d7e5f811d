"""Random numbers that are the same to the byte on every machine, for ever.

Raw 64-bit words of Philox (numpy promises its stream; what numpy.random makes of it may change between releases) are
turned into numbers here, by integers, ldexp and + − × ÷ √ alone: IEEE 754 rounds these in one way only, whereas the
exp, log, power, sin and cos of numpy differ between instruction sets. "Log-uniform" is therefore a random exponent
and a random mantissa, and a point of the circle a rational one.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hypcheck.rows import Rows

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Maker = Callable[["Draw", int], Rows]
"""What a generator is: from a draw and a number n, n valid rows."""


class Draw:
    """The stream of one block; each method takes as many words as it returns numbers, unless it says otherwise."""

    __slots__ = ("_bits",)

    def __init__(self, *name: object) -> None:
        digest = hashlib.sha256("/".join(map(str, name)).encode()).digest()
        self._bits = np.random.Philox(key=int.from_bytes(digest[:16], "little"))

    def words(self, n: int) -> NDArray[np.uint64]:
        """Raw 64-bit words."""
        return np.asarray(self._bits.random_raw(n), dtype=np.uint64)

    def integers(self, n: int, low: int, high: int) -> Integers:
        """Integers from low to high, both included; 0 ≤ high − low < 2⁴⁰, so no value is favoured by more than 2⁻²⁴."""
        return low + (self.words(n) % np.uint64(high - low + 1)).astype(np.int64)

    def unit(self, n: int) -> Floats:
        """Multiples of 2⁻⁵³ in [0, 1)."""
        return (self.words(n) >> np.uint64(11)).astype(np.float64) * 2.0**-53

    def between(self, n: int, low: ArrayLike, high: ArrayLike) -> Floats:
        """Uniform from low to high (numbers or arrays)."""
        low, high = np.asarray(low, dtype=np.float64), np.asarray(high, dtype=np.float64)
        return np.asarray(low + (high - low) * self.unit(n))

    def mantissas(self, n: int) -> Floats:
        """Uniform in [1, 2), multiples of 2⁻⁵²."""
        return 1.0 + (self.words(n) >> np.uint64(12)).astype(np.float64) * 2.0**-52

    def log_uniform(self, n: int, low: int, high: int) -> Floats:
        """m 2^e with e an integer, low ≤ e < high, and m uniform in [1, 2); takes 2n words."""
        exponents = self.integers(n, low, high - 1)
        return ldexp(self.mantissas(n), exponents)

    def signs(self, n: int) -> Floats:
        """Each 1 or −1."""
        return 1.0 - 2.0 * (self.words(n) >> np.uint64(63)).astype(np.float64)

    def circle(self, n: int) -> tuple[Floats, Floats]:
        """Points (cosine, sine) of the unit circle in all quadrants, a quarter of them on the axes; takes 2n words."""
        words, half = self.words(n), self.unit(n)
        half = np.where(words >> np.uint64(62) == 0, 0.0, half)
        cosine, sine = circle_at(half)
        swapped = words & np.uint64(1) == 1
        first = np.where(words & np.uint64(2) == 0, 1.0, -1.0)
        second = np.where(words & np.uint64(4) == 0, 1.0, -1.0)
        return first * np.where(swapped, sine, cosine), second * np.where(swapped, cosine, sine)


def circle_at(half: Floats) -> tuple[Floats, Floats]:
    """(cosine, sine) of the angle whose half has the tangent `half`."""
    square = half * half
    return (1 - square) / (1 + square), 2 * half / (1 + square)


def ldexp(values: ArrayLike, exponents: ArrayLike) -> Floats:
    """values · 2^exponents, rounded once where the result is subnormal; the exponents are integers."""
    return np.ldexp(np.asarray(values, dtype=np.float64), np.asarray(exponents).astype(np.int32))


def exponent(values: Floats) -> Integers:
    """The e of values = m 2^e with 1 ≤ |m| < 2, and −1 for a zero."""
    return np.frexp(values)[1].astype(np.int64) - 1


def stepped(values: Floats, steps: Integers) -> Floats:
    """The floats `steps` ulps away from each value, outward from 0 for positive steps; a zero stays 0."""
    moved: Integers = np.ascontiguousarray(values).view(np.int64) + np.where(values == 0, 0, steps)
    return moved.view(np.float64)


def to_bits(values: Floats, bits: int) -> Floats:
    """The values rounded to `bits` significant bits."""
    mantissas, exponents = np.frexp(values)
    return ldexp(np.rint(ldexp(mantissas, np.full(values.shape, bits))), exponents - bits)


def in_turn(*makers: Maker) -> Maker:
    """The generator that takes a row of each maker in turn."""

    def make(draw: Draw, n: int) -> Rows:
        rows = np.empty((n, 7))
        for turn, maker in enumerate(makers):
            own = rows[turn :: len(makers)]
            own[:] = maker(draw, len(own))
        return rows

    return make


def turns(n: int, *values: Any) -> NDArray[Any]:  # noqa: ANN401 - strings or numbers alike
    """The values in turn, n in all."""
    return np.resize(np.asarray(values), n)
