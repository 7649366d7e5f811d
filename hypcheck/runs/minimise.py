"""Minimisation: from a wrong answer to the simplest row nearby that is answered wrongly in the same way."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from decimal import Decimal
from functools import cache, lru_cache
from itertools import product

import numpy as np

from hypcheck.errors import InputError
from hypcheck.geometry.pair import SIZES, Groups, Pair, trouble_with_row
from hypcheck.geometry.rows import PAIRS, SWEEPS, Layout, Row, Rows
from hypcheck.messages import counted
from hypcheck.runs import hunt
from hypcheck.runs.hunt_surfaces import MOVERS, border_factors, columns_of, place_of_row
from hypcheck.runs.judge import Status, WrongCase
from hypcheck.runs.replay import ReplayCase, of_question, require_taken
from hypcheck.runs.score import Score
from hypcheck.runs.tally import STATUSES
from hypcheck.tables.numbers import decimals_of
from hypcheck.vectors.double_roots import AXIAL_COLUMNS, RADIAL_COLUMNS

Complexity = tuple[int, int, int]

DIGITS = range(1, 17)
"""The numbers of significant digits to which a number is rounded; with 17 it would stay as it is."""

LARGEST_SUM = 1e15
"""Two sums of sizes above this number count as equal."""


@lru_cache(maxsize=1 << 16)
def characters(value: float) -> int:
    """Count the characters of the shortest decimal text that reads back as `value`, such as 2, 0.5, 1e-7 or 3e6.

    The result is 0 for zero and for infinity.
    """
    if value == 0 or math.isinf(value):
        return 0
    number = Decimal(repr(value)).normalize()
    digits, leading = len(number.as_tuple().digits), number.adjusted()
    last = leading - digits + 1  # the power of ten of the last digit
    plain = max(leading, 0) + 1 + (1 - last if last < 0 else 0)
    scientific = digits + (digits > 1) + len(f"e{leading}")
    return (value < 0) + min(plain, scientific)


@lru_cache(maxsize=1 << 17)
def complexity(row: Row) -> Complexity:
    """Return a key that is less for a simpler row.

    It has the number of characters of all numbers, that of the longest number, and the sum of all absolute values.
    """
    lengths = [characters(value) for value in row]
    return sum(lengths), max(lengths), int(min(sum(map(abs, row)), LARGEST_SUM))


def simpler_than(rows: Iterable[Row], limit: Complexity, layout: Layout = PAIRS) -> Rows:
    """Return the distinct valid rows of a layout below a complexity, float64 (n, its columns), the simplest first."""
    complexities = {row: complexity(row) for row in set(rows) if _valid(row, layout)}
    chosen = sorted(
        (row for row in complexities if complexities[row] < limit), key=lambda row: (complexities[row], row)
    )
    return np.array(chosen, dtype=np.float64).reshape(len(chosen), len(chosen[0]) if chosen else len(layout.upright))


def rounded(value: float) -> Iterator[float]:
    """Round `value` to 1, 2, 3 … significant digits; yield the nearest number each time, and its two neighbours."""
    for digits in DIGITS:
        text = f"{value:.{digits - 1}e}"
        unit = float(f"1{text[text.index('e') :]}") / 10 ** (digits - 1)
        for steps in (0, 1, -1):
            yield float(f"{float(text) + steps * unit:.{digits - 1}e}")


@cache
def small_pairs() -> tuple[Row, ...]:
    """Return rows of small whole numbers and halves.

    Radial lengths (α, b, x, y) and axial lengths (γ, d, z) have units of their own, in which α or b is 1, and γ or d.
    """
    sizes = [(1.0, 1.0), *((float(size), 1.0) for size in range(2, 7)), *((1.0, float(size)) for size in range(2, 7))]
    far, near = [half / 2 for half in range(17)], [0.0, 0.5, 1.0, 1.5, 2.0, 3.0]
    return tuple(
        (alpha, gamma, b, d, x, y, z)
        for (alpha, b), (gamma, d), x, y, z in product(sizes, sizes, far, near, near)
        if y <= x
    )


@cache
def small_sweeps() -> tuple[Row, ...]:
    """Return sweeps of upright spheroids in the plane y = 0, in small whole numbers."""
    sizes = [(alpha, gamma, 1.0, 1.0) for alpha in (1.0, 2.0, 3.0) for gamma in (1.0, 2.0, 3.0)]
    starts, ends = product((0.0, 1.0, 2.0, 3.0, 4.0), (0.0, 1.0, 2.0)), product(range(-4, 5), range(-2, 3))
    return tuple(
        (*size, x, 0.0, z, float(end_x), 0.0, float(end_z))
        for size, (x, z), (end_x, end_z) in product(sizes, starts, ends)
    )


def _valid(row: Row, layout: Layout) -> bool:
    """Return whether the row is valid."""
    return trouble_with_row(row, layout.upright) is None


GROUPS: dict[Layout, tuple[list[int], ...]] = {
    PAIRS: (RADIAL_COLUMNS, AXIAL_COLUMNS, [7, 8, 9]),
    SWEEPS: ([*RADIAL_COLUMNS, 7, 8], [*AXIAL_COLUMNS, 9], [10, 11, 12]),
}
"""Columns whose numbers share a unit; the last are those of an axis."""

_SMALL = tuple(map(float, range(1, 7)))


def same_query(row: Row, layout: Layout) -> Iterator[Row]:
    """Yield rows that mean the same as this one in other coordinates.

    They have fewer minus signs, x and y exchanged, a reversed sweep, or other units. An upright pair is also turned so
    that y is 0.
    """
    width = len(layout.upright)
    sizes, axis = row[: len(SIZES)], row[width:]
    ends = [row[start : start + 3] for start in range(len(SIZES), width, 3)]
    signs = [math.copysign(1.0, next(filter(None, place), 1.0)) for place in zip(*ends, strict=True)]
    mirrored = [_times(signs, end) for end in ends]
    for points, turn in product((mirrored, mirrored[::-1]), (1.0, -1.0)):
        vectors = [*points, *([_times([turn * sign for sign in signs], axis)] if axis else [])]
        for order in ((0, 1, 2), (1, 0, 2)):
            yield (*sizes, *(vector[place] for vector in vectors for place in order))
    if not PAIRS.has_axis(row):
        yield (*sizes, math.hypot(row[4], row[5]), 0.0, row[6])
    for columns in (range(width), range(width, len(row))) if axis else GROUPS[layout][:2]:
        for unit in _units([row[column] for column in columns]):
            yield _with(row, {column: row[column] / unit for column in columns})


def _times(signs: Sequence[float], vector: Sequence[float]) -> list[float]:
    """Return the vector with each number multiplied by its sign."""
    return [sign * number for sign, number in zip(signs, vector, strict=True)]


def _units(lengths: list[float]) -> set[float]:
    """Return units of length to try: each length, and the greatest common divisor of all if float64 can hold it."""
    numerators, denominators = zip(*(length.as_integer_ratio() for length in lengths), strict=True)
    shared = math.lcm(*denominators)
    whole = [
        numerator * (shared // denominator) for numerator, denominator in zip(numerators, denominators, strict=True)
    ]
    units = {abs(length) for length in lengths}
    with suppress(OverflowError):
        units.add(math.gcd(*whole) / shared)
    return {unit for unit in units if unit}


def one_changed(row: Row, layout: Layout) -> Iterator[Row]:
    """Yield rows in which one number is changed: to 0, 1 or another simple one, a shorter one, or one of its unit."""
    for column in range(len(row)):
        for value in {*_simple_values(row, column, layout), *rounded(row[column])}:
            yield _with(row, {column: value})


def one_changed_between_ends(row: Row, _layout: Layout) -> Iterator[Row]:
    """Yield rows with heights in which one number is changed: to a simple or shorter one, another one, or no end."""
    numbers = [value for value in row[:-1] if math.isfinite(value)]
    for column, number in enumerate(row):
        simple = {0.0, 1.0, 2.0, 3.0, *numbers}
        if math.isfinite(number):
            simple |= {float(math.floor(number)), float(math.ceil(number)), *rounded(number)}
        for value in simple | {-math.inf, math.inf}:
            yield _with(row, {column: value})
    across = math.hypot(row[4], row[5])
    yield _with(row, {4: across, 5: 0.0})


def brought_back(row: Row, layout: Layout) -> Iterator[Row]:
    """Yield pairs in which one number is simple, and another is moved to the border of contact.

    That number is rounded to more and more digits. All numbers may also be replaced by those of a simple pair.
    """
    simple = ((column, value) for column in range(7) for value in _simple_values(row, column, layout))
    changed = {row, *(_with(row, {column: value}) for column, value in simple)}
    for alpha, gamma, height in product(_SMALL, _SMALL, {0.0, 1.0, row[6]}):
        changed |= {(alpha, gamma, 1.0, 1.0, radius, 0.0, height) for radius in (0.0, 1.0, alpha + 1)}
    limit = complexity(row)[0]
    moves = [
        (other, max(columns, key=lambda column: abs(other[column])), name, far)
        for other, (name, columns), far in product(sorted(changed), MOVERS.items(), (False, True))
    ]
    # Only if the limit allows one more number that is not 0.
    moves = [move for move in moves if sum(map(characters, move[0])) - characters(move[0][move[1]]) + 1 < limit]
    rows = np.array([other for other, *_ in moves]).reshape(-1, 7)
    mask = columns_of(np.array([name for _, _, name, _ in moves]))
    factors = border_factors(rows, mask, np.array([far for *_, far in moves], dtype=np.bool_))
    for (other, lead, _, _), factor in zip(moves, factors.tolist(), strict=True):
        if math.isfinite(factor):
            for value in rounded(other[lead] * factor):
                yield _with(other, {lead: value})


def _simple_values(row: Row, column: int, layout: Layout) -> set[float]:
    """Return the values to try in a column: 1, 2, 3, those of its unit, the whole numbers beside it; 0 if allowed."""
    group = next(columns for columns in GROUPS[layout] if column in columns)
    values = {1.0, 2.0, 3.0, *(row[other] for other in group if other != column)}
    values |= {float(math.floor(row[column])), float(math.ceil(row[column]))}
    return values - {0.0} if column < len(SIZES) else values | {0.0}


def _with(row: Row, values: dict[int, float]) -> Row:
    """Return the row with other values in some columns."""
    return tuple(values.get(column, number) for column, number in enumerate(row))


PIECE = {PAIRS: 2048, SWEEPS: 64}
"""The number of rows that are tested at a time. There are fewer sweeps, because one takes milliseconds to decide."""

MAX_ROWS = 30_000
"""The most rows that one step tests; the simplest ones come first."""


Variants = Callable[[Row, Layout], Iterable[Row]]
"""A function from a row to rows that could replace it."""

_VARIANTS: dict[Groups, tuple[Variants, ...]] = {
    frozenset(): (same_query, one_changed, lambda *_: small_pairs(), brought_back),
    frozenset({"axis"}): (same_query, one_changed),
    frozenset({"axis", "heights"}): (one_changed_between_ends,),
    frozenset({"end"}): (same_query, one_changed, lambda *_: small_sweeps()),
    frozenset({"end", "axis"}): (same_query, one_changed),
    frozenset({"end", "axis", "heights"}): (one_changed_between_ends,),
}
"""The variants of a row by its groups, cheap ones first: later ones are tried only if these give no simpler row."""


@dataclass
class Minimised:
    """The state of a minimisation: the given row, and each simpler row that replaced it; the last is the result."""

    target: hunt.HuntTarget
    steps: list[hunt.HuntFinding] = field(default_factory=list)
    asked: int = 0

    @property
    def first(self) -> hunt.HuntFinding:
        """The finding of the given row."""
        return self.steps[0]

    @property
    def last(self) -> hunt.HuntFinding:
        """The finding of the simplest row so far."""
        return self.steps[-1]


def minimise(target: hunt.HuntTarget, case: ReplayCase) -> Minimised:
    """Simplify until no simpler row fails in the same way.

    Raises InputError if the answer is not wrong, or the row has not the question's layout.

    A row fails in the same way if it has the same answer, the same truth, an error beyond the tolerance, and the same
    cause (RowPlace.cause).
    """
    run = Minimised(target)
    row = _row_of(target, case)
    require_taken(replace(case, row=row), target.implementation.description)
    run.steps.append(_start(run, row))
    while any(_improve(run, variant) for variant in _VARIANTS[target.layout.groups(row)]):
        pass
    return run


def _row_of(target: hunt.HuntTarget, case: ReplayCase) -> Row:
    """Return the row of a case, without its axis if that is vertical. Raises InputError if the row is not valid."""
    case = of_question(case, target.implementation.description)
    trouble = trouble_with_row(case.row, target.layout.upright)
    if trouble is not None:
        raise InputError(f"{case.name}: {trouble}")
    return tuple(np.add(case.row, 0.0).tolist()) if target.layout.has_end else Pair.from_row(case.row).row


def _start(run: Minimised, row: Row) -> hunt.HuntFinding:
    """Test the given row, and return its finding. Raises InputError if the answer is not wrong."""
    rows, layout = np.array([row]), run.target.layout
    if not len(run.target.claimed(rows)):
        raise InputError("the implementation does not claim to answer this row; --regimes any asks it anyway")
    scored = _ask(run, rows)
    for index, reason in scored.reasons.items():
        status = STATUSES[scored.status[index]]
        raise InputError(f"the implementation gives no answer to this row: {status.value}: {reason}")
    case = next(scored.judged(), None)
    if case is None:
        raise InputError("the implementation's answer to this row is not wrong; there is nothing to simplify")
    if case.status is not Status.WRONG:
        raise InputError("the implementation's answer to this row is wrong within tolerance; see --tolerance")
    return hunt.HuntFinding.of(case, run.target.criterion, place_of_row(row, layout), "given")


def _improve(run: Minimised, variants: Variants) -> bool:
    """Test these variants, the simplest first, and keep the first that fails in the same way; False if none does."""
    row = run.last.case.row
    layout = run.target.layout
    candidates = simpler_than(variants(row, layout), complexity(row), layout)[:MAX_ROWS]
    piece = PIECE[layout]
    for start in range(0, len(candidates), piece):
        rows = candidates[start : start + piece]
        rows = rows[run.target.claimed(rows)]
        for case in _ask(run, rows).judged():
            place = place_of_row(case.row, layout) if _alike(case, run.first.case) else None
            if place is not None and place.cause == run.first.place.cause:
                run.steps.append(hunt.HuntFinding.of(case, run.target.criterion, place, f"step {len(run.steps)}"))
                return True
    return False


def _alike(case: WrongCase, first: WrongCase) -> bool:
    """Return whether a case is wrong beyond the tolerance with the same mistake, truth and answer as the first one."""
    return case.status is Status.WRONG and (case.mistake, case.truth, case.answer) == (
        first.mistake,
        first.truth,
        first.answer,
    )


def _ask(run: Minimised, rows: Rows) -> Score:
    """Test rows, and count them."""
    run.asked += len(rows)
    return run.target.ask(rows)


def minimised_lines(run: Minimised) -> Iterator[str]:
    """Yield the report of a minimisation."""
    steps = len(run.steps) - 1
    yield f"{hunt.name_of_target(run.target)}: {counted(steps, 'step')}, {counted(run.asked, 'row')} asked"
    yield hunt.titled("given", f"{decimals_of(run.first.case.row)}, {hunt.how_wrong(run.first)}")
    yield hunt.titled("where", run.last.place.words)
    yield from hunt.finding_lines(run.last, run.target)
