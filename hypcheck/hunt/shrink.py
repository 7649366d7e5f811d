"""Rows next to a given one that are simpler to read: what minimise asks about."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import suppress
from itertools import product

import numpy as np

from hypcheck.casebook.exactly import AXIAL_COLUMNS, RADIAL_COLUMNS
from hypcheck.hunt.border import MOVERS, border_factors, columns_of
from hypcheck.hunt.simple import Row, characters, complexity, rounded

GROUPS = (RADIAL_COLUMNS, AXIAL_COLUMNS)
COORDINATES = (4, 5, 6)
_SMALL = tuple(map(float, range(1, 7)))


def same_pair(row: Row) -> Iterator[Row]:
    """The pair in other coordinates: no signs, x and y exchanged or turned to one, other units of length."""
    alpha, gamma, b, d, *center = row
    x, y, z = map(abs, center)
    yield (alpha, gamma, b, d, x, y, z)
    yield (alpha, gamma, b, d, y, x, z)
    yield (alpha, gamma, b, d, math.hypot(x, y), 0.0, z)
    for columns in GROUPS:
        for unit in _units([row[column] for column in columns]):
            yield _with(row, {column: row[column] / unit for column in columns})


def _units(lengths: list[float]) -> set[float]:
    """Each length, and the greatest common divisor of all where it is one that float64 holds."""
    numerators, denominators = zip(*(length.as_integer_ratio() for length in lengths), strict=True)
    shared = math.lcm(*denominators)
    whole = [
        numerator * (shared // denominator) for numerator, denominator in zip(numerators, denominators, strict=True)
    ]
    units = {abs(length) for length in lengths}
    with suppress(OverflowError):
        units.add(math.gcd(*whole) / shared)
    return {unit for unit in units if unit}


def one_changed(row: Row) -> Iterator[Row]:
    """One number made 0, 1 or shorter, or equal to another of its unit."""
    for column in range(7):
        for value in {*_simple_values(row, column), *rounded(row[column])}:
            yield _with(row, {column: value})


def brought_back(row: Row) -> Iterator[Row]:
    """One number made simple, and another one moved to the border of contact and rounded to ever more digits."""
    changed = {row, *(_with(row, {column: value}) for column in range(7) for value in _simple_values(row, column))}
    for alpha, gamma, height in product(_SMALL, _SMALL, {0.0, 1.0, row[6]}):
        changed |= {(alpha, gamma, 1.0, 1.0, radius, 0.0, height) for radius in (0.0, 1.0, alpha + 1)}
    limit = complexity(row)[0]
    ways = [
        (each, max(columns, key=lambda column: abs(each[column])), name, far)
        for each, (name, columns), far in product(sorted(changed), MOVERS.items(), (False, True))
    ]
    # Only where the other numbers leave room for one that is not 0.
    ways = [way for way in ways if sum(map(characters, way[0])) - characters(way[0][way[1]]) + 1 < limit]
    rows = np.array([each for each, *_ in ways]).reshape(-1, 7)
    mask = columns_of(np.array([name for _, _, name, _ in ways]))
    factors = border_factors(rows, mask, np.array([far for *_, far in ways], dtype=np.bool_))
    for (each, lead, _, _), factor in zip(ways, factors.tolist(), strict=True):
        if math.isfinite(factor):
            for value in rounded(each[lead] * factor):
                yield _with(each, {lead: value})


def _simple_values(row: Row, column: int) -> set[float]:
    group = next(columns for columns in GROUPS if column in columns)
    values = {1.0, 2.0, 3.0, *(row[other] for other in group if other != column)}
    values |= {float(math.floor(row[column])), float(math.ceil(row[column]))}
    return values | {0.0} if column in COORDINATES else values - {0.0}


def _with(row: Row, values: dict[int, float]) -> Row:
    return tuple(values.get(column, number) for column, number in enumerate(row))
