"""Random numbers that are the same to the byte on every machine and in every release.

Raw 64-bit words of Philox (numpy guarantees its stream; the numbers that numpy.random makes from it may change between
releases) are turned into numbers here, only by integers, ldexp and + − × ÷ √: IEEE 754 rounds these in one way only,
whereas the exp, log, power, sin and cos of numpy differ between instruction sets. "Log-uniform" is therefore a random
exponent and a random mantissa, and a point of the circle a rational one.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from typing import Any, cast

import numpy as np
from numpy.random.bit_generator import ISeedSequence
from numpy.typing import ArrayLike, NDArray

from hypcheck.geometry.rows import Floats, Rows

Integers = NDArray[np.int64]
Maker = Callable[["Draw", int], Rows]
"""What a generator is: from a draw and a number n, n valid rows."""

_HIGHEST = np.uint64(1 << 63)


class _Key(ISeedSequence):
    """A key for Philox that does not ask the system for entropy, which would take longer than all other steps."""

    def __init__(self, name: str) -> None:
        self._words = np.frombuffer(hashlib.sha256(name.encode()).digest()[:16], dtype="<u8").astype(np.uint64)

    def generate_state(self, n_words: int, dtype: object = np.uint64) -> NDArray[np.uint64]:  # noqa: ARG002
        """The key: two words of 64 bits, the only words that Philox requests."""
        return self._words


class Draw:
    """The stream of one block. A method takes one word for each number that it returns, unless its docstring differs.

    If there are several blocks (of_blocks), each gives an equal share of the words, one block after the other. So a
    generator that works place by place makes the rows of all blocks in one call, with the same result as separate
    calls.
    """

    __slots__ = ("_streams",)

    def __init__(self, *name: object) -> None:
        self._streams = [_stream(name)]

    @classmethod
    def of_blocks(cls, names: Sequence[Sequence[object]]) -> Draw:
        """The draw that joins a stream for each name; every requested n must be a multiple of the number of names."""
        draw = cls.__new__(cls)
        draw._streams = [_stream(name) for name in names]
        return draw

    def words(self, n: int) -> NDArray[np.uint64]:
        """Raw 64-bit words."""
        share, rest = divmod(n, len(self._streams))
        if rest:
            raise ValueError(f"{n} words cannot be shared by {len(self._streams)} blocks")
        words = np.empty(n, dtype=np.uint64)
        for number, stream in enumerate(self._streams):
            words[number * share : (number + 1) * share] = stream.random_raw(share)
        return words

    def places(self, n: int) -> Integers:
        """The place of each row in its block: 0, 1, 2 …; draws no random words."""
        return np.tile(np.arange(n // len(self._streams)), len(self._streams))

    def integers(self, n: int, low: int, high: int) -> Integers:
        """Integers from low to high, both included; 0 ≤ high − low < 2⁴⁰, so no value is favoured by more than 2⁻²⁴."""
        words, span = self.words(n), np.uint64(high - low + 1)
        words -= words // span * span  # numpy's % with a scalar takes ten times as long
        return low + words.astype(np.int64)

    def unit(self, n: int) -> Floats:
        """Multiples of 2⁻⁵³ in [0, 1)."""
        return unit_of(self.words(n))

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

    def signed(self, n: int, low: int, high: int) -> Floats:
        """As log_uniform, of either sign; takes 3n words."""
        return self.signs(n) * self.log_uniform(n, low, high)

    def circle(self, n: int) -> tuple[Floats, Floats]:
        """Points (cosine, sine) of the unit circle in all quadrants, a quarter of them on the axes; takes 2n words."""
        words, half = self.words(n), self.unit(n)
        cosine, sine = circle_at(_chosen(words >> np.uint64(62) != 0, half, np.zeros(n)))
        swapped = words & np.uint64(1) != 0
        first, second = _chosen(swapped, sine, cosine), _chosen(swapped, cosine, sine)
        return _signed(first, words << np.uint64(62)), _signed(second, words << np.uint64(61))


def unit_of(words: NDArray[np.uint64]) -> Floats:
    """Multiples of 2⁻⁵³ in [0, 1), of the high bits of words."""
    return (words >> np.uint64(11)).astype(np.float64) * 2.0**-53


def _stream(name: Sequence[object]) -> np.random.Philox:
    key = cast("np.random.SeedSequence", _Key("/".join(map(str, name))))  # numpy's types leave its interface out
    return np.random.Philox(key)


def _chosen(which: NDArray[np.bool_], first: Floats, second: Floats) -> Floats:
    """np.where without its branches, which processors cannot predict if `which` is random."""
    one, other = first.view(np.uint64), second.view(np.uint64)
    all_or_none = np.uint64(0) - which.astype(np.uint64)
    return np.asarray(other ^ ((one ^ other) & all_or_none)).view(np.float64)


def _signed(values: Floats, words: NDArray[np.uint64]) -> Floats:
    """The values, their sign turned where the words' highest bit is set."""
    return np.asarray(values.view(np.uint64) ^ (words & _HIGHEST)).view(np.float64)


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
    """The generator that takes rows from the makers in turn."""

    def make(draw: Draw, n: int) -> Rows:
        parts = [maker(draw, len(range(turn, n, len(makers)))) for turn, maker in enumerate(makers)]
        rows = np.empty((n, parts[0].shape[1]))
        for turn, part in enumerate(parts):
            rows[turn :: len(makers)] = part
        return rows

    return make


def turns(n: int, *values: Any) -> NDArray[Any]:  # noqa: ANN401 - strings or numbers alike
    """The values in turn, n in all."""
    return np.tile(np.asarray(values), -(-n // len(values)))[:n]
