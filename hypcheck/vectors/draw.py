"""Random numbers that are the same to the byte on every machine and in every release, and families drawn with them.

Raw 64-bit words of Philox (numpy guarantees its stream; the numbers that numpy.random makes from it may change between
releases) are turned into numbers here, only by integers, ldexp and + − × ÷ √: IEEE 754 rounds these in one way only,
whereas the exp, log, power, sin and cos of numpy differ between instruction sets. "Log-uniform" is therefore a random
exponent and a random mantissa, and a point of the circle a rational one.

The rows of a family depend only on (name, version, seed, index).
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, cast

import numpy as np
from numpy.random.bit_generator import ISeedSequence
from numpy.typing import ArrayLike, NDArray

from hypcheck.errors import InputError
from hypcheck.geometry.pair import COLUMNS, NO_GROUPS, Groups
from hypcheck.geometry.rows import Floats, Layout, Rows, columns_with, layout_with

Integers = NDArray[np.int64]
Row = tuple[float, ...]
Maker = Callable[["Draw", int], Rows]
"""The type of a generator: it makes n valid rows of a Draw and the number n."""

_HIGHEST = np.uint64(1 << 63)


class _Key(ISeedSequence):
    """A key for Philox that does not ask the system for entropy, which would take longer than all other steps."""

    def __init__(self, name: str) -> None:
        self._words = np.frombuffer(hashlib.sha256(name.encode()).digest()[:16], dtype="<u8").astype(np.uint64)

    def generate_state(self, n_words: int, dtype: object = np.uint64) -> NDArray[np.uint64]:  # noqa: ARG002
        """Return the key: two words of 64 bits, the only words that Philox requests."""
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
        """Join a stream for each name to one draw; every requested n must be a multiple of the number of names."""
        draw = cls.__new__(cls)
        draw._streams = [_stream(name) for name in names]
        return draw

    def words(self, n: int) -> NDArray[np.uint64]:
        """Draw raw 64-bit words."""
        share, rest = divmod(n, len(self._streams))
        if rest:
            raise ValueError(f"{n} words cannot be shared by {len(self._streams)} blocks")
        words = np.empty(n, dtype=np.uint64)
        for number, stream in enumerate(self._streams):
            words[number * share : (number + 1) * share] = stream.random_raw(share)
        return words

    def places(self, n: int) -> Integers:
        """Return the index of each row in its block: 0, 1, 2 …; draws no random words."""
        return np.tile(np.arange(n // len(self._streams)), len(self._streams))

    def integers(self, n: int, low: int, high: int) -> Integers:
        """Draw integers from low to high, both included; 0 ≤ high − low < 2⁴⁰: none is favoured by more than 2⁻²⁴."""
        words, span = self.words(n), np.uint64(high - low + 1)
        words -= words // span * span  # numpy's % with a scalar takes ten times as long
        return low + words.astype(np.int64)

    def unit(self, n: int) -> Floats:
        """Draw multiples of 2⁻⁵³, uniform in [0, 1)."""
        return unit_of(self.words(n))

    def between(self, n: int, low: ArrayLike, high: ArrayLike) -> Floats:
        """Draw numbers uniform from low to high, which are numbers or arrays (n,)."""
        low, high = np.asarray(low, dtype=np.float64), np.asarray(high, dtype=np.float64)
        return np.asarray(low + (high - low) * self.unit(n))

    def mantissas(self, n: int) -> Floats:
        """Draw multiples of 2⁻⁵², uniform in [1, 2)."""
        return 1.0 + (self.words(n) >> np.uint64(12)).astype(np.float64) * 2.0**-52

    def log_uniform(self, n: int, low: int, high: int) -> Floats:
        """Draw m 2^e with e an integer, low ≤ e < high, and m uniform in [1, 2); takes 2n words."""
        exponents = self.integers(n, low, high - 1)
        return ldexp(self.mantissas(n), exponents)

    def signs(self, n: int) -> Floats:
        """Draw signs, each 1 or −1."""
        return 1.0 - 2.0 * (self.words(n) >> np.uint64(63)).astype(np.float64)

    def signed(self, n: int, low: int, high: int) -> Floats:
        """Draw numbers as log_uniform does, of either sign; takes 3n words."""
        return self.signs(n) * self.log_uniform(n, low, high)

    def circle(self, n: int) -> tuple[Floats, Floats]:
        """Draw points (cosine, sine) of the unit circle in all quadrants, a quarter on the axes; takes 2n words."""
        words, half = self.words(n), self.unit(n)
        cosine, sine = circle_at(_chosen(words >> np.uint64(62) != 0, half, np.zeros(n)))
        swapped = words & np.uint64(1) != 0
        first, second = _chosen(swapped, sine, cosine), _chosen(swapped, cosine, sine)
        return _signed(first, words << np.uint64(62)), _signed(second, words << np.uint64(61))


def unit_of(words: NDArray[np.uint64]) -> Floats:
    """Turn words into multiples of 2⁻⁵³ in [0, 1), by their high bits."""
    return (words >> np.uint64(11)).astype(np.float64) * 2.0**-53


def _stream(name: Sequence[object]) -> np.random.Philox:
    """Return the stream of 64-bit words that belongs to this name."""
    key = cast("np.random.SeedSequence", _Key("/".join(map(str, name))))  # numpy's types leave its interface out
    return np.random.Philox(key)


def _chosen(which: NDArray[np.bool_], first: Floats, second: Floats) -> Floats:
    """Do as np.where does, without its branches, which processors cannot predict if `which` is random."""
    one, other = first.view(np.uint64), second.view(np.uint64)
    all_or_none = np.uint64(0) - which.astype(np.uint64)
    return np.asarray(other ^ ((one ^ other) & all_or_none)).view(np.float64)


def _signed(values: Floats, words: NDArray[np.uint64]) -> Floats:
    """Turn the sign of the values where the words' highest bit is set."""
    return np.asarray(values.view(np.uint64) ^ (words & _HIGHEST)).view(np.float64)


def circle_at(half: Floats) -> tuple[Floats, Floats]:
    """Return (cosine, sine) of the angle whose half has the tangent `half`."""
    square = half * half
    return (1 - square) / (1 + square), 2 * half / (1 + square)


def ldexp(values: ArrayLike, exponents: ArrayLike) -> Floats:
    """Return values · 2^exponents, rounded once where the result is subnormal; the exponents are integers."""
    return np.ldexp(np.asarray(values, dtype=np.float64), np.asarray(exponents).astype(np.int32))


def exponent(values: Floats) -> Integers:
    """Return the e of each value m 2^e with 1 ≤ |m| < 2, and −1 for a zero."""
    return np.frexp(values)[1].astype(np.int64) - 1


def stepped(values: Floats, steps: Integers) -> Floats:
    """Move each value by `steps` ulps, away from 0 for positive steps; a zero stays 0."""
    moved: Integers = np.ascontiguousarray(values).view(np.int64) + np.where(values == 0, 0, steps)
    return moved.view(np.float64)


def to_bits(values: Floats, bits: int) -> Floats:
    """Round the values to `bits` significant bits."""
    mantissas, exponents = np.frexp(values)
    return ldexp(np.rint(ldexp(mantissas, np.full(values.shape, bits))), exponents - bits)


def in_turn(*makers: Maker) -> Maker:
    """Return the generator that takes rows from these generators in turn."""

    def make(draw: Draw, n: int) -> Rows:
        parts = [maker(draw, len(range(turn, n, len(makers)))) for turn, maker in enumerate(makers)]
        rows = np.empty((n, parts[0].shape[1]))
        for turn, part in enumerate(parts):
            rows[turn :: len(makers)] = part
        return rows

    return make


def turns(n: int, *values: Any) -> NDArray[Any]:  # noqa: ANN401 - strings or numbers alike
    """Repeat the values in turn until there are n."""
    return np.tile(np.asarray(values), -(-n // len(values)))[:n]


MARK = "@"
"""The prefix before the sizes in the name of a family for fixed sizes."""

BLOCK = 1024
"""The number of rows that have a random stream of their own, so that a block can be made without the others."""

TOGETHER = 16
"""The number of blocks that a `by_place` generator makes in one call: less overhead, and all fits the cache."""


@dataclass(frozen=True)
class Family:
    """A generator of rows for one trap, a kind of case on which programs fail; descriptions.toml has its purpose.

    `name`: kebab-case; `version`: of the generator, raised by every change of its output, since both are part of the
    case ids. `frozen`: the number of frozen rows; it is larger for rows with traps, smaller if proofs are long, 0
    if rows matter in their order alone or are made of those of other families.
    `extreme`: lengths are near the limits of a float format, so the family is used only on request. `by_place`: the
    generator works place by place, so that it can make several blocks at one go. `movement`: the number of consecutive
    rows that follow one object from moment to moment; 1 if none do. `groups` are those that an implementation must
    take: an end if rows are sweeps, an axis if spheroids are tilted, heights if hyperboloids end; rows with heights
    also have an axis, which is vertical if "axis" is not among the groups. `times`: a run tests this many rows for each
    row that it tests of other families.
    """

    name: str
    make: Maker = field(repr=False)
    frozen: int = 0
    version: int = 1
    extreme: bool = False
    by_place: bool = False
    movement: int = 1
    groups: Groups = NO_GROUPS
    times: int = 1

    @property
    def columns(self) -> tuple[str, ...]:
        """The names of the numbers of a row."""
        return columns_with(self.groups)

    @property
    def layout(self) -> Layout:
        """The layout of the rows."""
        return layout_with(self.groups)

    def block(self, seed: int, number: int) -> Rows:
        """Make rows number·BLOCK to (number + 1)·BLOCK − 1 of the seed: float64 (BLOCK, len(columns)), all valid."""
        return self._blocks(seed, number, number + 1)

    def columns_between(self, seed: int, start: int, stop: int) -> NDArray[np.float64]:
        """Make rows start to stop − 1 of the seed by columns, (len(columns), stop − start), without earlier blocks."""
        columns = np.empty((len(self.columns), stop - start))
        together = TOGETHER if self.by_place else 1
        for first in range(start // BLOCK, -(-stop // BLOCK), together):
            last = min(first + together, -(-stop // BLOCK))
            by_column = self._blocks(seed, first, last).T
            begin, end = max(start, first * BLOCK), min(stop, last * BLOCK)
            columns[:, begin - start : end - start] = by_column[:, begin - first * BLOCK : end - first * BLOCK]
        return columns

    def row(self, seed: int, index: int) -> Row:
        """Make row `index` of the seed."""
        number, place = divmod(index, BLOCK)
        return tuple(self.block(seed, number)[place].tolist())

    def _blocks(self, seed: int, first: int, last: int) -> Rows:
        names = [(self.name, self.version, seed, number) for number in range(first, last)]
        return self.make(Draw.of_blocks(names), (last - first) * BLOCK)

    def rows(self, seed: int, count: int) -> Rows:
        """Make the first `count` rows of the seed: float64 (count, len(columns)), all valid.

        A call for fewer rows returns the first rows of a call for more. Raises InputError for a negative seed or count.
        """
        if seed < 0 or count < 0:
            raise InputError(f"seed is {seed} and count is {count}; neither may be negative")
        return np.ascontiguousarray(self.columns_between(seed, 0, count).T)


def rows_of(rows: list[Row]) -> Rows:
    """Return the rows as one array, float64 (n, 7)."""
    return np.asarray(rows, dtype=np.float64).reshape(len(rows), len(COLUMNS))
